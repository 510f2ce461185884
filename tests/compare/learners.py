"""The learners that labels.py compares with JointBoost: each has fit(x, y, weight) and scores(x), rows x labels."""

import numpy
from scipy.linalg import solve_triangular
from sklearn.ensemble import RandomForestClassifier
from sklearn.linear_model import LogisticRegression, Ridge
from sklearn.neighbors import KNeighborsClassifier
from sklearn.svm import LinearSVC
from sklearn.tree import DecisionTreeClassifier
from xgboost import XGBClassifier

# Standardized features count as no further out than this.
LIMIT = 5.0


class Scaled:
    """A learner of standardized features; those that do not vary are left out, and what is far outside counts as at the
    limit."""

    def __init__(self, model):
        self.model = model

    def prepare(self, x):
        return numpy.clip((x[:, self.varies] - self.mean) / self.deviation, -LIMIT, LIMIT)

    def fit(self, x, y, weight):
        deviation = x.std(axis=0, dtype=float)
        self.varies = deviation > 1e-9
        self.mean, self.deviation = x.mean(axis=0, dtype=float)[self.varies].astype("f"), deviation[self.varies].astype("f")
        if isinstance(self.model, KNeighborsClassifier):
            self.model.fit(self.prepare(x), y)
        else:
            self.model.fit(self.prepare(x), y, sample_weight=weight)
        return self

    def scores(self, x):
        """Logarithms of probabilities where the learner has them, else the values that it compares."""
        if hasattr(self.model, "predict_proba"):
            return as_scores(self.model.predict_proba(self.prepare(x)))
        values = self.model.decision_function(self.prepare(x))
        return numpy.stack([-values, values], axis=1) if values.ndim == 1 else values


class LeastSquares(Scaled):
    """A linear function per label, fitted to 1 where a face has the label and 0 elsewhere."""

    def __init__(self, alpha):
        super().__init__(Ridge(alpha=alpha))

    def fit(self, x, y, weight):
        return super().fit(x, numpy.eye(y.max() + 1)[y], weight)

    def scores(self, x):
        return self.model.predict(self.prepare(x))


class GaussianBayes:
    """A normal distribution of the features for each label (thesis Eqs. 2.46 to 2.51): `smoothing` (lambda) mixes the covariance of
    a label with the one that all labels share, `prior` (mu) is added to the number of faces of each label. Weights count as faces."""

    RIDGE = 1e-4  # of the shared variance: features depend on each other, so that covariances are singular

    def __init__(self, smoothing, prior):
        self.smoothing, self.prior = smoothing, prior

    def fit(self, x, y, sample_weight):
        x, weight = x.astype(float), sample_weight * len(y) / sample_weight.sum()
        count = numpy.bincount(y, weight)
        means = numpy.stack([weight[y == c] @ x[y == c] / count[c] for c in range(len(count))])
        own = [self.covariance(x[y == c] - means[c], weight[y == c]) for c in range(len(count))]
        shared = sum(share * covariance for share, covariance in zip(count / len(y), own))
        shared += self.RIDGE * numpy.trace(shared) / len(shared) * numpy.eye(len(shared))
        self.log_prior = numpy.log((count + self.prior) / (len(y) + len(count) * self.prior))
        self.densities = [(mean, numpy.linalg.cholesky((1 - self.smoothing) * covariance + self.smoothing * shared))
                          for mean, covariance in zip(means, own)]
        return self

    @staticmethod
    def covariance(centered, weight):
        return (centered * weight[:, None]).T @ centered / weight.sum()

    def decision_function(self, x):
        """Logarithms of prior times density, but for a constant."""
        scores = []
        for log_prior, (mean, root) in zip(self.log_prior, self.densities):
            z = solve_triangular(root, (x - mean).T, lower=True)
            scores.append(log_prior - numpy.log(numpy.diag(root)).sum() - (z * z).sum(axis=0) / 2)
        return numpy.stack(scores, axis=1)


class Plain:
    """A learner to which scales do not matter."""

    def __init__(self, model):
        self.model = model

    def fit(self, x, y, weight):
        self.model.fit(x, y, sample_weight=weight)
        return self

    def scores(self, x):
        return as_scores(self.model.predict_proba(x))


def as_scores(probability):
    return numpy.log(numpy.maximum(probability, 1e-6))


class Known:
    """A learner of those labels that occur in its rows; of the others it says that they are the least likely."""

    def __init__(self, model, labels):
        self.model, self.labels = model, labels

    def fit(self, x, y, weight):
        self.known, y = numpy.unique(y, return_inverse=True)
        self.model.fit(x, y, weight)
        return self

    def scores(self, x):
        found = self.model.scores(x)
        scores = numpy.repeat(found.min(axis=1, keepdims=True), self.labels, axis=1)
        scores[:, self.known] = found
        return scores


# Sums of losses grow with the rows, so C is in units of one over their number.
PEERS = {
    "least squares": (lambda rows: LeastSquares(1e-6), {}),
    "ridge": (lambda rows, alpha: LeastSquares(alpha * rows), {"alpha": [1e-4, 1e-3, 1e-2, 1e-1]}),
    "decision tree": (lambda rows, **grid: Plain(DecisionTreeClassifier(random_state=1, max_features=0.5, **grid)),
                      {"min_samples_leaf": [1, 5, 20, 80]}),
    "linear SVM": (lambda rows, C: Scaled(LinearSVC(C=C / rows, dual=False, tol=1e-3, max_iter=200)), {"C": [0.3, 1, 10, 100]}),
    "Gaussian Bayes, full": (lambda rows, **grid: Scaled(GaussianBayes(**grid)), {"smoothing": [0.1, 0.5, 0.9, 1], "prior": [0, 100]}),
    "logistic, L1": (lambda rows, C: Scaled(LogisticRegression(C=C / rows, penalty="l1", solver="liblinear", tol=1e-3,
                                                               random_state=1, max_iter=50)), {"C": [100, 300, 1000, 3000]}),
    "nearest neighbors": (lambda rows, **grid: Scaled(KNeighborsClassifier(**grid)), {"n_neighbors": [1, 5, 25]}),
    "random forest": (lambda rows, **grid: Plain(RandomForestClassifier(100, random_state=1, **grid)),
                      {"max_features": [0.03, 0.1]}),
    "XGBoost": (lambda rows, **grid: Plain(XGBClassifier(n_estimators=100, learning_rate=0.3, tree_method="hist", n_jobs=1,
                                                         colsample_bynode=0.06, random_state=1, **grid)),
                {"max_depth": [1, 2, 4, 6]}),
}

#!/usr/bin/env python3
"""Compares classifiers of faces with Exemplar's JointBoost on the same features (thesis Fig. 2.4).

    tests/compare/labels.py --work FOLDER                            # generated shapes
    EXEMPLAR_DATA=psb tests/compare/labels.py --work FOLDER --cut    # the Princeton Segmentation Benchmark

Every learner gets the same faces of six training meshes of a category, with the same features and weights, and says which
label each face of four unseen meshes has. Parameters are chosen by leaving out two training meshes at a time, by the share
of the surface that is labeled wrong. Printed are, per category, the share of the surface of the unseen meshes that is
labeled wrong, in percent, mean over meshes, before any graph cut; with --cut also after the cut of the model that 'exemplar
label train' learns from these meshes. Times are seconds of one thread. FOLDER keeps features and results for the next call. Needs
scikit-learn and XGBoost (Debian: python3-sklearn, python3-xgboost), for the picture matplotlib (python3-matplotlib)."""

import os

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")  # before numpy: all learners have one thread

import argparse
import json
import pathlib
import subprocess
import sys
import time
import warnings

import numpy
from scipy.linalg import LinAlgWarning, solve_triangular
from sklearn.ensemble import RandomForestClassifier
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression, Ridge
from sklearn.model_selection import ParameterGrid
from sklearn.neighbors import KNeighborsClassifier
from sklearn.svm import LinearSVC
from sklearn.tree import DecisionTreeClassifier
from xgboost import XGBClassifier

import programs

# The training meshes of the first table of docs/results/labeling.md; every fourth of the other fourteen is tested on.
TRAINING = {
    "Human": (3, 5, 9, 10, 13, 15), "Cup": (27, 32, 34, 35, 38, 40), "Glasses": (41, 43, 50, 51, 58, 60),
    "Ant": (84, 88, 89, 91, 96, 100), "Octopus": (125, 127, 133, 134, 135, 140), "Table": (145, 146, 148, 154, 158, 160),
    "Teddy": (162, 164, 168, 171, 177, 179), "Fish": (221, 228, 235, 237, 238, 240), "Bust": (306, 309, 310, 314, 316, 319),
    "Bearing": (346, 352, 353, 355, 356, 357), "Vase": (363, 364, 365, 368, 369, 379),
    "FourLeg": (383, 384, 385, 388, 390, 391),
}
TESTED = 4
GENERATED = ("human", "fourleg", "cup", "chair", "table", "octopus", "glasses")
HELD_OUT_FOLDS, BOOSTING_FOLDS = 3, 5
CUT_ROWS = 3000
# Standardized features count as no further out than this.
LIMIT = 5.0
# One label in so many is taken to be noise when probabilities are judged.
NOISE = 0.01


class Mesh:
    """Label names and areas of the faces of a mesh, and their features."""

    def __init__(self, path, features):
        self.path = path
        self.area = face_areas(path)
        self.label = face_labels(path.with_name(path.stem + "_labels.txt"), len(self.area))
        self.features = numpy.load(features)


def face_areas(path):
    numbers = path.read_text().split()
    vertices, faces = int(numbers[1]), int(numbers[2])
    points = numpy.array(numbers[4:4 + 3 * vertices], float).reshape(-1, 3)
    corners = points[numpy.array(numbers[4 + 3 * vertices:4 + 3 * vertices + 4 * faces], int).reshape(-1, 4)[:, 1:]]
    return numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


def face_labels(path, faces):
    """From pairs of lines: a name, then the 1-based numbers of its faces."""
    labels = numpy.full(faces, "", dtype=object)
    lines = [line.strip() for line in path.read_text().splitlines() if line.strip()]
    for name, numbers in zip(lines[::2], lines[1::2]):
        labels[numpy.array(numbers.split(), int) - 1] = name
    return labels


def scaled_to_one(weight):
    """Weights whose mean is one."""
    return weight * len(weight) / weight.sum()


class Category:
    """Training and test meshes, and the rows that are learned from."""

    def __init__(self, name, train, test, work, rows):
        self.name, self.train_paths, self.test_paths = name, train, test
        self.folder = work / name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.export([path for path in train + test if not self.features_of(path).exists()])
        self.test = [Mesh(path, self.features_of(path)) for path in test]
        self.collect([Mesh(path, self.features_of(path)) for path in train], rows)

    def results(self, cv_rows):
        """The folder of what was learned from so many rows."""
        return self.folder / f"results-{len(self.y)}-{cv_rows}"

    def features_of(self, path):
        return self.folder / f"{path.stem}.npy"

    def export(self, meshes):
        for mesh in meshes:
            subprocess.run([programs.program("compare_faces"), "features", self.folder.parent / "cache", self.folder, mesh],
                           check=True)

    def collect(self, meshes, rows):
        """Some faces of each mesh, drawn at random; x, y, weight, area and mesh of each."""
        self.labels = sorted({name for mesh in meshes for name in mesh.label} - {""})
        random = numpy.random.RandomState(1)
        chosen = [random.permutation(numpy.flatnonzero(mesh.label != ""))[:rows] for mesh in meshes]
        together = lambda values: numpy.concatenate([value[faces] for value, faces in zip(values, chosen)])
        self.x = together([mesh.features for mesh in meshes])
        self.y = numpy.searchsorted(self.labels, together([mesh.label for mesh in meshes]).astype(str))
        self.area = together([mesh.area / mesh.area.sum() for mesh in meshes])
        self.mesh = numpy.repeat(numpy.arange(len(meshes)), [len(faces) for faces in chosen])
        # As Exemplar weighs them: meshes count the same, and a label as the root of its area.
        share = numpy.bincount(self.y, self.area, len(self.labels))
        self.weight = scaled_to_one(self.area / numpy.sqrt(share[self.y]))
        self.equal_weight = scaled_to_one(self.area / share[self.y])

    def fold(self, folds):
        """Which fold holds a row out: all of a mesh together."""
        return self.mesh % folds

    def cv_rows(self, rows):
        """The first so many rows of each mesh; they are in random order."""
        return numpy.concatenate([numpy.flatnonzero(self.mesh == mesh)[:rows] for mesh in numpy.unique(self.mesh)])

    def wrong(self, mesh, label):
        """Share of the surface that is not labeled as the truth, and the mean over labels of the same."""
        right = numpy.array(self.labels, dtype=object)[label] == mesh.label
        parts = [mesh.label == name for name in set(mesh.label) - {""}]
        return (1 - mesh.area[right].sum() / mesh.area.sum(),
                1 - numpy.mean([mesh.area[right & part].sum() / mesh.area[part].sum() for part in parts]))


def benchmark_categories(names, work, rows):
    """Of EXEMPLAR_DATA; the meshes are read one category after the other."""
    for name in names or TRAINING:
        folder = pathlib.Path(os.environ["EXEMPLAR_DATA"]) / "labeled" / name
        paths = sorted(folder.glob("*.off"), key=lambda path: int(path.stem))
        train = [path for path in paths if int(path.stem) in TRAINING[name]]
        yield Category(name, train, [path for path in paths if path not in train][1::4][:TESTED], work, rows)


def generated_categories(names, work, rows, train=6, faces=5000):
    for name in names or GENERATED:
        folder = work / name / "shapes"
        if not folder.exists():
            subprocess.run([programs.program("exemplar"), "synth", name, "--count", str(train + TESTED), "--seed", "1", "--faces",
                            str(faces), "--out", folder, "--threads", "1", "--quiet"], check=True, stdout=subprocess.DEVNULL)
        paths = sorted(folder.glob("*.off"))
        yield Category(name, paths[:train], paths[train:], work, rows)


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
# Folds 1: a single classifier. Pooled is what 'exemplar label train' does, with a linear classifier, the next is that without it;
# plain is as in the thesis but for the number of rounds, which it chooses on held-out meshes.
OURS = {
    "JointBoost, pooled": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06, "linear": 1},
    "JointBoost": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, 1000 rounds": {"folds": BOOSTING_FOLDS, "rounds": 1000, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, equal labels": {"folds": BOOSTING_FOLDS, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06,
                                 "equal labels": True},
    "JointBoost, single": {"folds": 1, "rounds": 300, "shrinkage": 0.5, "feature_fraction": 0.06},
    "JointBoost, plain": {"folds": 1, "rounds": 300, "shrinkage": 1, "feature_fraction": 1},
}


class Result:
    """What a learner says of the test meshes: scores per mesh; and what it took."""

    def __init__(self, scores, train_seconds, score_seconds, parameters, scale):
        self.scores, self.train_seconds, self.score_seconds = scores, train_seconds, score_seconds
        self.parameters, self.scale = parameters, scale

    def save(self, path):
        path.parent.mkdir(exist_ok=True)
        known = json.dumps([self.train_seconds, self.score_seconds, self.parameters, self.scale])
        numpy.savez(path, *(scores.astype("f4") for scores in self.scores), known=known)

    @staticmethod
    def load(path):
        arrays = numpy.load(path)
        return Result([arrays[f"arr_{m}"] for m in range(len(arrays.files) - 1)], *json.loads(str(arrays["known"])))

    def probabilities(self, mesh):
        return softmax(self.scale * self.scores[mesh])

    def errors(self, category):
        """Of the surface and of labels, in percent; and the mean of -log of the truth's probability, by area."""
        both = [category.wrong(mesh, scores.argmax(axis=1)) for mesh, scores in zip(category.test, self.scores)]
        surface, label = 100 * numpy.mean(both, axis=0)
        return {"surface": surface, "label": label,
                "log loss": float(numpy.mean([self.log_loss(category, m) for m in range(len(category.test))]))}

    def log_loss(self, category, number):
        mesh = category.test[number]
        known = numpy.isin(mesh.label, category.labels)
        y = numpy.searchsorted(category.labels, mesh.label[known].astype(str))
        return log_loss(self.probabilities(number)[known], y, mesh.area[known])


def softmax(scores):
    scores = numpy.exp(scores - scores.max(axis=1, keepdims=True))
    return scores / scores.sum(axis=1, keepdims=True)


def log_loss(probability, y, weight):
    truth = (1 - NOISE) * probability[numpy.arange(len(y)), y] + NOISE / probability.shape[1]
    return -(weight * numpy.log(truth)).sum() / weight.sum()


def best_scale(scores, y, weight):
    """What held-out scores are multiplied with before the softmax."""
    return min(numpy.logspace(-1.5, 2, 36), key=lambda scale: log_loss(softmax(scale * scores), y, weight))


def held_out_scores(category, make, rows):
    """Of some of the training rows, each from the learner of the meshes of the other folds."""
    fold, labels = category.fold(HELD_OUT_FOLDS)[rows], len(category.labels)
    scores = numpy.zeros((len(rows), labels))
    for held_out in range(HELD_OUT_FOLDS):
        seen = rows[fold != held_out]
        model = Known(make(len(seen)), labels).fit(category.x[seen], category.y[seen], category.weight[seen])
        scores[fold == held_out] = model.scores(category.x[rows[fold == held_out]])
    return scores


def choose(category, factory, grid, rows):
    """The parameters with which the least of the surface is wrong, and the scale of the scores then."""
    best = None
    for parameters in ParameterGrid(grid):
        scores = held_out_scores(category, lambda count: factory(count, **parameters), rows)
        wrong = category.area[rows] @ (scores.argmax(axis=1) != category.y[rows]) / category.area[rows].sum()
        if best is None or wrong < best[0]:
            best = wrong, parameters, best_scale(scores, category.y[rows], category.weight[rows])
    return best[1:]


def by_peer(category, name, cv_rows):
    factory, grid = PEERS[name]
    parameters, scale = choose(category, factory, grid, category.cv_rows(cv_rows))
    start = time.process_time()
    model = Known(factory(len(category.y), **parameters), len(category.labels))
    model.fit(category.x, category.y, category.weight)
    trained = time.process_time()
    scores = [model.scores(mesh.features) for mesh in category.test]
    return Result(scores, trained - start, time.process_time() - trained, parameters, scale)


def held_out_errors(category, label):
    """Of the training rows, in percent: how much of the surface is wrong, and of each label in the mean."""
    right = category.area * (label == category.y)
    count = len(category.labels)
    of_label = numpy.bincount(category.y, right, count) / numpy.bincount(category.y, category.area, count)
    return {"held out, surface": round(100 * (1 - right.sum() / category.area.sum()), 1),
            "held out, labels": round(100 * (1 - of_label.mean()), 1)}


def by_ours(category, name):
    settings = {"classes": len(category.labels), "threads": 1, "linear": 0, **OURS[name]}
    weight = category.equal_weight if settings.pop("equal labels", False) else category.weight
    arrays = {"x": category.x.T, "label": category.y.astype("<i4"), "weight": weight.astype("<f4"),
              "fold": category.fold(BOOSTING_FOLDS).astype("u1"),
              "test": numpy.concatenate([mesh.features for mesh in category.test]).T}
    found, seconds = programs.run("compare_boost", [], arrays, settings, scratch=category.folder)
    ends = numpy.cumsum([len(mesh.area) for mesh in category.test])[:-1]
    known = held_out_errors(category, found["held_out"].argmax(axis=1)) if "held_out" in found else {}
    return Result(numpy.split(as_scores(found["probability"]), ends), float(seconds["train_seconds"]),
                  float(seconds["score_seconds"]), known, 1)


def compare(category, learners, cv_rows):
    """Results by learner; those that an earlier call found with as many rows are taken over."""
    results = {}
    for name in learners:
        kept = category.results(cv_rows) / f"{name}.npz"
        if kept.exists():
            results[name] = Result.load(kept)
            continue
        results[name] = by_ours(category, name) if name in OURS else by_peer(category, name, cv_rows)
        results[name].save(kept)
        errors = results[name].errors(category)
        print(f"{category.name:>10} {name:>20} {errors['surface']:5.1f} % of the surface, {errors['label']:5.1f} % of labels, "
              f"log loss {errors['log loss']:.3f}, {results[name].train_seconds:6.1f} s to train, "
              f"{results[name].score_seconds:5.1f} s to score {results[name].parameters or ''}", file=sys.stderr, flush=True)
    return results


def trained_model(category):
    """The model of 'exemplar label train' of these meshes; only its cut is used."""
    model = category.folder / "model.safetensors"
    if not model.exists():
        names = category.folder / "train.txt"
        names.write_text("".join(f"{path.resolve()}\n" for path in category.train_paths))
        subprocess.run([programs.program("exemplar"), "label", "train", names, "--out", model, "--stages", "1", "--rows",
                        str(CUT_ROWS), "--threads", "1", "--cache", category.folder.parent / "cache", "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
    return model


def cut_errors(category, results):
    """Share of the surface that is wrong after the graph cut, in percent, per learner."""
    given = {f"{mesh.path.stem}/{name}": result.probabilities(number).astype("<f4")
             for number, mesh in enumerate(category.test) for name, result in results.items()}
    found = programs.run("compare_faces", ["cut", category.folder.parent / "cache", trained_model(category)], given,
                         scratch=category.folder, behind=category.test_paths)[0]
    return {name: 100 * float(numpy.mean([category.wrong(mesh, found[f"{mesh.path.stem}/{name}"])[0] for mesh in category.test]))
            for name in results}


def kept_cut_errors(category, results, cv_rows):
    """The same; those that an earlier call found are taken over."""
    kept = category.results(cv_rows) / "cut.json"
    known = json.loads(kept.read_text()) if kept.exists() else {}
    missing = {name: result for name, result in results.items() if name not in known}
    if missing:
        known.update(cut_errors(category, missing))
        kept.write_text(json.dumps(known))
    return known


def mean_over(by_category, name):
    return numpy.mean([of_learner[name] for of_learner in by_category.values()])


def print_table(title, learners, by_category):
    """A row per learner: its value in each category, and the mean."""
    rows = [(name, [f"{of_learner[name]:.1f}" for of_learner in by_category.values()] + [f"**{mean_over(by_category, name):.1f}**"])
            for name in learners]
    print("\n" + programs.table(title, [*by_category, "mean"], rows), flush=True)


def print_means(title, learners, tables):
    """A row per learner: the mean over categories of each table."""
    rows = [(name, [f"{mean_over(by_category, name):.2f}" for by_category in tables.values()]) for name in learners]
    print("\n" + programs.table(title, list(tables), rows), flush=True)


def draw(path, learners, surface, cut):
    """Bars of the mean errors, falling, before and after the cut."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.rcParams.update({"font.size": 8, "svg.hashsalt": "exemplar"})
    order = sorted(learners, key=lambda name: -mean_over(surface, name))
    figure, axes = pyplot.subplots(figsize=(7, 0.3 * len(order) + 0.6), layout="constrained")
    colors = ["tab:blue" if name in OURS else "silver" for name in order]
    axes.barh(order, [mean_over(surface, name) for name in order], color=colors)
    for row, name in enumerate(order):
        points = [of_learner[name] for of_learner in surface.values()]
        axes.plot(points, [row] * len(points), "k.", markersize=2)
    if cut:
        axes.plot([mean_over(cut, name) for name in order], order, "|", color="tab:red", markersize=12, label="after the graph cut")
        axes.legend(frameon=False)
    axes.set_xlabel("surface labeled wrong, %: mean, and each category (dots)")
    figure.savefig(path, metadata={"Date": None} if str(path).endswith(".svg") else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("categories", nargs="*", help="only these")
    parser.add_argument("--work", type=pathlib.Path, required=True, metavar="FOLDER", help="keeps features and results")
    parser.add_argument("--learners", nargs="*", default=[*OURS, *PEERS], help="only these")
    parser.add_argument("--rows", type=int, default=1000, help="faces of each training mesh")
    parser.add_argument("--cv-rows", type=int, default=300, help="of these, for choosing parameters")
    parser.add_argument("--cut", action="store_true", help="also cut by the model of 'exemplar label train'")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all figures")
    parser.add_argument("--picture", metavar="FILE", help="also draw the errors")
    options = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    warnings.simplefilter("ignore", LinAlgWarning)  # of least squares, whose features depend on each other
    source = benchmark_categories if "EXEMPLAR_DATA" in os.environ else generated_categories
    tables = {what: {} for what in ("surface", "label", "log loss", "train", "score", "cut", "parameters")}
    for category in source(options.categories, options.work.resolve(), options.rows):
        results = compare(category, options.learners, options.cv_rows)
        errors = {name: result.errors(category) for name, result in results.items()}
        for what in ("surface", "label", "log loss"):
            tables[what][category.name] = {name: errors[name][what] for name in results}
        tables["train"][category.name] = {name: result.train_seconds for name, result in results.items()}
        tables["score"][category.name] = {name: result.score_seconds for name, result in results.items()}
        tables["parameters"][category.name] = {name: result.parameters for name, result in results.items()}
        if options.cut:
            tables["cut"][category.name] = kept_cut_errors(category, results, options.cv_rows)
        if options.json:
            options.json.write_text(json.dumps(tables, indent=1))
    print_table("surface wrong, %", options.learners, tables["surface"])
    print_table("labels wrong, %", options.learners, tables["label"])
    if options.cut:
        print_table("surface wrong after the cut, %", options.learners, tables["cut"])
    print_means("means", options.learners, {"log loss": tables["log loss"], "seconds to train": tables["train"],
                                            "seconds to score four meshes": tables["score"]})
    if options.picture:
        draw(options.picture, options.learners, tables["surface"], tables["cut"])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares regressions on data whose truth is known (thesis Fig. 2.2 and Sec. 2.4.3).

    tests/compare/regressions.py [--sets 30] [--picture docs/results/compare_regressions.png]

Three truths, each learned from noisy samples by Exemplar's regressions and by those of scikit-learn and XGBoost:
  curve       a sine by powers of x up to the tenth
  irrelevant  a parabola from x^2, x and inputs that tell nothing
  product     a product of two functions of single inputs, among others that tell nothing
It prints the error against the truth without noise, root mean square over unseen points and median over data sets, in
percent of the truth's standard deviation. Parameters of the peers are chosen by cross-validation. Needs scikit-learn and
XGBoost (Debian: python3-sklearn, python3-xgboost), for the picture matplotlib (python3-matplotlib)."""

import argparse
import warnings

import numpy
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LassoCV, LinearRegression, RidgeCV
from sklearn.model_selection import GridSearchCV
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer, StandardScaler
from xgboost import XGBRegressor

import programs

POWERS = {1: "x", 2: "x, x²", 10: "x to x¹⁰"}
OURS = {"least squares, here": "least_squares", "ridge, here": "ridge", "network, here": "network"}
TEST_ROWS = 200


def with_powers(x):
    """Inputs, their powers as the product takes them, and their logarithms."""
    return numpy.concatenate([x, x ** 2, 1 / x, 1 / x ** 2, numpy.log(x)], axis=1)


def boosted(depth):
    """Gradient boosting of trees of this depth; 1 are stumps."""
    search = {"n_estimators": [10, 30, 100]}
    return GridSearchCV(XGBRegressor(max_depth=depth, learning_rate=0.1, n_jobs=1), search, cv=3, scoring="neg_mean_squared_error")


def lasso(least=1e-4):
    """`least`: of the weights of the penalty that are tried, as a share of the greatest."""
    return LassoCV(cv=5, eps=least, n_alphas=50, max_iter=5000, random_state=1)


def peers():
    return {
        "least squares": LinearRegression(),
        "ridge": make_pipeline(StandardScaler(), RidgeCV(alphas=numpy.logspace(-5, 3, 17))),
        "lasso": make_pipeline(StandardScaler(), lasso()),
        "boosted stumps": boosted(1),
        "boosted trees": boosted(3),
    }


class DataSets:
    """Inputs and noisy targets of some data sets, and unseen inputs with the truth."""

    def __init__(self, x, y, test, truth):
        self.x, self.y, self.test, self.truth = (numpy.asarray(a, "<f4") for a in (x, y, test, truth))

    def errors(self, predicted):
        """Per set, relative to the truth's deviation."""
        return numpy.sqrt(((predicted - self.truth) ** 2).mean(axis=1)) / self.truth.std(axis=1)

    def by_ours(self, method):
        return programs.run("compare_regress", [method], {"x": self.x, "y": self.y, "test": self.test})[0]["y"]

    def by_peer(self, model):
        in_double = (array.astype(float) for array in (self.x, self.y, self.test))
        return numpy.stack([model.fit(x, y).predict(test) for x, y, test in zip(*in_double)])


def curve_sets(sets, rows, noise, powers, seed=1):
    """A sine over half a period, as powers of x in [-1, 1]."""
    random = numpy.random.RandomState(seed)
    x = random.uniform(-1, 1, (sets, rows))
    test = numpy.tile(numpy.linspace(-1, 1, TEST_ROWS), (sets, 1))
    as_powers = lambda values: numpy.stack([values ** p for p in range(1, powers + 1)], axis=2)
    sine = lambda values: numpy.sin(numpy.pi * (values + 1) / 2)
    return DataSets(as_powers(x), sine(x) + noise * random.normal(size=x.shape), as_powers(test), sine(test))


def irrelevant_sets(sets, rows, noise, irrelevant, seed=1):
    """A parabola of x; the inputs are x^2, x and normal numbers that have nothing to do with it."""
    random = numpy.random.RandomState(seed)

    def inputs(x):
        return numpy.concatenate([numpy.stack([x ** 2, x], axis=2), random.normal(size=x.shape + (irrelevant,))], axis=2)

    parabola = lambda values: 1 - values ** 2 + 0.3 * values
    x, test = random.uniform(-1, 1, (sets, rows)), random.uniform(-1, 1, (sets, TEST_ROWS))
    return DataSets(inputs(x), parabola(x) + noise * random.normal(size=x.shape), inputs(test), parabola(test))


def product_sets(sets, rows, noise, irrelevant, seed=1):
    """(1 + 3 x0) sqrt(x1), with noise in proportion; inputs are uniform, the others tell nothing."""
    random = numpy.random.RandomState(seed)
    x, test = (random.uniform(0.05, 1, (sets, count, 2 + irrelevant)) for count in (rows, TEST_ROWS))
    product = lambda values: (1 + 3 * values[..., 0]) * numpy.sqrt(values[..., 1])
    return DataSets(x, product(x) * numpy.exp(noise * random.normal(size=x.shape[:2])), test, product(test))


class Logarithm:
    """Learns the logarithm of positive targets."""

    def __init__(self, model):
        self.model = model

    def fit(self, x, y):
        self.model.fit(x, numpy.log(y))
        return self

    def predict(self, x):
        return numpy.exp(self.model.predict(x))


def median_errors(data, ours, others):
    """Of each learner, the median error over the data sets, in percent."""
    predicted = {name: data.by_ours(method) for name, method in ours.items()}
    predicted.update({name: data.by_peer(model) for name, model in others.items()})
    return {name: 100 * float(numpy.median(data.errors(values))) for name, values in predicted.items()}


def curve_errors(sets):
    """Columns: the power up to which x is given, the noise, the samples."""
    columns = {}
    for powers, noise, rows in [(1, 0.2, 20), (2, 0.2, 20), (10, 0.2, 20), (10, 0.05, 20), (10, 0.2, 100)]:
        data = curve_sets(sets, rows, noise, powers)
        columns[f"{POWERS[powers]}, noise {noise}, {rows} samples"] = median_errors(data, OURS, peers())
    return columns


def irrelevant_errors(sets):
    columns = {}
    for irrelevant, noise, rows in [(0, 0.2, 20), (3, 0.2, 20), (15, 0.2, 20), (60, 0.2, 20), (15, 0.05, 20), (15, 0.2, 100)]:
        data = irrelevant_sets(sets, rows, noise, irrelevant)
        columns[f"{irrelevant} irrelevant, noise {noise}, {rows} samples"] = median_errors(data, OURS, peers())
    return columns


def product_errors(sets):
    """All peers learn the logarithm of the target, as the product does."""
    columns = {}
    for irrelevant, noise, rows in [(3, 0.1, 200), (30, 0.1, 200), (30, 0.4, 200), (30, 0.1, 2000)]:
        data = product_sets(sets, rows, noise, irrelevant)
        others = {name: Logarithm(model) for name, model in peers().items()}
        others["lasso of powers and logarithms"] = Logarithm(
            make_pipeline(FunctionTransformer(with_powers), StandardScaler(), lasso(1e-2)))
        columns[f"{irrelevant} irrelevant, noise {noise}, {rows} samples"] = median_errors(
            data, {"product, here": "product"}, others)
    return columns


def print_columns(title, columns):
    names = list(next(iter(columns.values())))
    rows = [(name, [f"{errors[name]:.1f}" for errors in columns.values()]) for name in names]
    print("\n" + programs.table(title, list(columns), rows), flush=True)


def draw(path):
    """One data set each of the two parts of Fig. 2.2: samples, truth and what was learned."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.rcParams.update({"font.size": 8, "svg.hashsalt": "exemplar"})
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.2), layout="constrained")
    for powers, color in zip(POWERS, ["tab:red", "tab:green", "tab:purple"]):
        data = curve_sets(1, 20, 0.2, powers, seed=4)
        left.plot(data.test[0, :, 0], data.by_ours("least_squares")[0], color=color, label=f"least squares, {POWERS[powers]}")
    left.plot(data.test[0, :, 0], data.by_ours("ridge")[0], color="tab:purple", linestyle="--", label="ridge, x to x¹⁰")
    left.plot(data.test[0, :, 0], data.truth[0], color="tab:cyan", linestyle=":", label="truth")
    left.plot(data.x[0, :, 0], data.y[0], "k.")
    left.set_ylim(-0.7, 1.7)
    data = irrelevant_sets(1, 20, 0.2, 10, seed=4)
    order = numpy.argsort(data.test[0, :, 1])
    lines = {"least squares": data.by_ours("least_squares"), "ridge": data.by_ours("ridge"),
             "lasso (scikit-learn)": data.by_peer(peers()["lasso"])}
    for (name, values), color in zip(lines.items(), ["tab:red", "tab:orange", "tab:green"]):
        right.plot(data.test[0, order, 1], values[0, order], color=color, linewidth=0.8, label=f"{name}, 10 irrelevant inputs")
    right.plot(data.test[0, order, 1], data.truth[0, order], color="tab:cyan", linestyle=":", linewidth=2, label="truth")
    right.plot(data.x[0, :, 1], data.y[0], "k.")
    right.set_ylim(-1.4, 1.5)  # room for the legend
    for axes in (left, right):
        axes.legend(frameon=False)
    figure.savefig(path, metadata={"Date": None} if str(path).endswith(".svg") else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=30, help="data sets per setting")
    parser.add_argument("--picture", metavar="FILE", help="also draw a data set of each of the first two truths")
    options = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    if options.picture:
        draw(options.picture)
    print_columns("curve", curve_errors(options.sets))
    print_columns("irrelevant inputs", irrelevant_errors(options.sets))
    print_columns("product", product_errors(max(options.sets // 3, 1)))


if __name__ == "__main__":
    main()

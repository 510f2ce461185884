#!/usr/bin/env python3
"""Compares learned hatching with other methods of learning on the same rows (thesis Figs. 4.4 and 4.5).

    exemplar hatch evaluate cow.obj spot.obj --export rows
    hatching_peers.py rows --pictures figures

learns the hatching level and, as logarithms, the properties of strokes from one drawing, and prints the share of levels
that are right, and the median relative error of each property, in percent: on the drawing's own view ("seen"), and
the mean over all other pictures ("unseen"). With --pictures, it writes STYLE_level.png and STYLE_spacing.png: what each method
predicts at the pixels of the drawing's own view (above) and of the first other mesh (below), in the same colors as the truth.

- All methods learn from as many rows as Exemplar does: levels from 16,000 pixels of the object, properties from up to
  16,000 pixels of center lines, lengths without strokes that cross others.
- "boosting" is Exemplar without its graph cut. "majority" guesses the drawing's most common level everywhere.
- Parameters are chosen by cross-validation over four folds of rectangles of the drawing, so that no neighbor of
  a held-out pixel is learned from.
- Least squares and linear regression have no regularization.
- To keep it to an hour on two idle cores, logistic regression uses L-BFGS with at most 300 iterations, the support
  vector machine solves its primal problem, and forests have 100 trees for levels and 50 for properties, which search
  a tenth of the features at each split.

Needs scikit-learn (Debian: python3-sklearn), and takes ten times as long without OpenBLAS (libopenblas0). Pictures need Pillow
(python3-pil)."""

import argparse
import pathlib
import sys
import warnings

import numpy
from sklearn.dummy import DummyClassifier
from sklearn.ensemble import HistGradientBoostingRegressor, RandomForestClassifier, RandomForestRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.feature_selection import VarianceThreshold
from sklearn.linear_model import LassoCV, LinearRegression, LogisticRegression, Ridge, RidgeClassifier
from sklearn.model_selection import GridSearchCV, PredefinedSplit
from sklearn.naive_bayes import GaussianNB
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import LinearSVC
from sklearn.tree import DecisionTreeClassifier

PROPERTIES = ("thickness", "intensity", "spacing", "length")
PROPERTY_ROWS = 16000
BLOCKS, FOLDS = 6, 4
# What is standardized may be far outside in another drawing.
LIMIT = 5.0
# Of the logarithm of a property; without regularization, predictions have no bounds.
LIMIT_OF_LOG = 20.0


def folds(pixels):
    """Splits rows by the block of the picture that they lie in: BLOCKS x BLOCKS rectangles, dealt to FOLDS folds."""
    low, high = pixels.min(axis=0), pixels.max(axis=0) + 1
    cell = ((pixels - low) * BLOCKS // (high - low)).astype(int)
    blocks, block = numpy.unique(cell @ [1, BLOCKS], return_inverse=True)
    return PredefinedSplit(numpy.random.default_rng(1).permutation(len(blocks))[block] % FOLDS)


def classifiers(split):
    def chosen(model, **grid):
        return GridSearchCV(model, grid, cv=split, n_jobs=-1)

    return {
        "majority": DummyClassifier(),
        "least squares": RidgeClassifier(alpha=0, solver="svd"),
        "naive Bayes": chosen(GaussianNB(), var_smoothing=[1e-9, 1e-6, 1e-3, 1e-1, 1e1]),
        "nearest neighbor": chosen(KNeighborsClassifier(), n_neighbors=[1, 5, 25, 125]),
        "logistic regression": chosen(LogisticRegression(max_iter=300), C=[0.001, 0.01, 0.1, 1.0]),
        "linear SVM": chosen(LinearSVC(dual=False, max_iter=300, tol=1e-3), C=[0.0001, 0.001, 0.01, 0.1, 1.0]),
        "decision tree": chosen(DecisionTreeClassifier(random_state=1), min_samples_leaf=[20, 80, 320, 1280]),
        "random forest": chosen(RandomForestClassifier(100, random_state=1), min_samples_leaf=[5, 20, 80, 320]),
    }


def regressions(split):
    def chosen(model, **grid):
        return GridSearchCV(model, grid, cv=split, scoring="neg_mean_squared_error", n_jobs=-1)

    return {
        "linear regression": LinearRegression(),
        "ridge": chosen(Ridge(), alpha=numpy.logspace(-1, 7, 17)),
        "lasso": LassoCV(n_alphas=30, eps=1e-3, max_iter=2000, random_state=1, cv=split, n_jobs=-1),
        "gradient boosting": chosen(HistGradientBoostingRegressor(early_stopping=False, random_state=1), max_iter=[50, 200]),
        "random forest": chosen(RandomForestRegressor(50, max_features=0.1, random_state=1), min_samples_leaf=[5, 20, 80]),
    }


class Scaling:
    """Standardized features; what is far outside counts as at the limit."""

    def __init__(self, rows):
        self.pipeline = make_pipeline(VarianceThreshold(), StandardScaler()).fit(rows)

    def __call__(self, rows):
        return numpy.clip(self.pipeline.transform(rows), -LIMIT, LIMIT)


class Rows:
    """Rows of a picture, `name`: features `x`, targets `y`, `pixel` coordinates, and of tests what was `learned` and `boosted`."""

    def __init__(self, stem, name=""):
        self.name = name
        for file in stem.parent.glob(f"{stem.name}_*.npy"):
            setattr(self, file.stem[len(stem.name) + 1:], numpy.load(file).astype(float))


def tests_of(folder, style, kind):
    stems = (file.name[:-len("_x.npy")] for file in sorted(folder.glob(f"{style}_{kind}_*_x.npy")))
    return [Rows(folder / stem, stem[len(f"{style}_{kind}_"):]) for stem in stems]


class Figure:
    """A table of pictures: a column for each method, a row for each of some tests. Values are drawn from light (`low` or less)
    to dark (`high` or more), on white where there is no object."""

    LIGHT, DARK = numpy.array([222, 235, 247]), numpy.array([8, 48, 107])
    GAP, TITLE = 8, 16

    def __init__(self, tests, low, high):
        self.tests, self.low, self.high, self.columns = tests, low, high, {}

    def add(self, method, values):
        """`values`: of a test, one per row of it."""
        self.columns[method] = [self.picture(test, values(test)) for test in self.tests]

    def picture(self, test, values):
        """Rows of a test are pixels on a square grid; a picture has one pixel for each."""
        x, y = test.pixel.T
        step = min(numpy.diff(numpy.unique(x)).min(), numpy.diff(numpy.unique(y)).min())
        x, y = ((at - at.min()).astype(int) // int(step) for at in (x, y))
        picture = numpy.full((y.max() + 1, x.max() + 1, 3), 255, numpy.uint8)
        share = numpy.clip((values - self.low) / (self.high - self.low), 0, 1)[:, None]
        picture[y, x] = numpy.round(self.LIGHT + share * (self.DARK - self.LIGHT))
        return picture

    def save(self, path):
        from PIL import Image, ImageDraw  # Only pictures need it.

        pictures = list(self.columns.values())
        width = max(picture.shape[1] for column in pictures for picture in column) + self.GAP
        heights = [max(column[row].shape[0] for column in pictures) + self.GAP for row in range(len(self.tests))]
        page = Image.new("RGB", (width * len(pictures), self.TITLE + sum(heights)), "white")
        for k, (method, column) in enumerate(self.columns.items()):
            ImageDraw.Draw(page).text((k * width + 2, 2), method, fill="black")
            for row, picture in enumerate(column):
                page.paste(Image.fromarray(picture), (k * width, self.TITLE + sum(heights[:row])))
        page.save(path)


class Style:
    """What is learned from one drawing, and the pictures to test on."""

    def __init__(self, folder, name, pictures):
        self.name, self.pictures = name, pictures
        self.levels, self.strokes = Rows(folder / f"{name}_train"), Rows(folder / f"{name}_strokes")
        self.tests = {"seen": tests_of(folder, name, "seen"), "unseen": tests_of(folder, name, "test")}
        seen = self.tests["seen"][:1]
        mesh = seen[0].name.rsplit("_", 1)[0] if seen else ""
        self.shown = seen + [test for test in self.tests["unseen"] if test.name.rsplit("_", 1)[0] != mesh][:1]

    def compare_levels(self):
        figure = Figure(self.shown, 0, 2)
        right = lambda test, values: numpy.mean(values == test.y[:, 0])
        figure.add("truth", lambda test: test.y[:, 0])
        self.report("level", "here", lambda test: test.learned[:, 0], right, figure)
        self.report("level", "boosting", lambda test: test.boosted[:, 0], right, figure)
        scaling, levels = Scaling(self.levels.x), self.levels.y[:, 0].astype(int)
        for method, model in classifiers(folds(self.levels.pixel)).items():
            # A drawing of one level leaves nothing to learn.
            model = model if len(set(levels)) > 1 else DummyClassifier()
            model.fit(scaling(self.levels.x), levels)
            self.report("level", method, lambda test: model.predict(scaling(test.x)), right, figure, model)
        self.save(figure, "level")

    def compare_property(self, column):
        """Compares where the rule has strokes."""
        what, truths = PROPERTIES[column - 1], [test.y[test.y[:, 0] > 0, column] for test in self.shown]
        low, high = numpy.percentile(numpy.concatenate(truths), [1, 99]) if truths else (0, 1)
        figure = Figure(self.shown, low, max(high, 1.01 * low))

        def error(test, values):
            return numpy.median(numpy.abs(values / test.y[:, column] - 1)[test.y[:, 0] > 0])

        figure.add("truth", lambda test: test.y[:, column])
        self.report(what, "here", lambda test: test.learned[:, column], error, figure)
        rows = numpy.flatnonzero(self.strokes.y[:, column] > 0)[:PROPERTY_ROWS]
        x, targets = self.strokes.x[rows], numpy.log(self.strokes.y[rows, column])
        scaling = Scaling(x)
        for method, model in regressions(folds(self.strokes.pixel[rows])).items():
            model.fit(scaling(x), targets)
            self.report(what, method, lambda test: numpy.exp(numpy.clip(model.predict(scaling(test.x)), -LIMIT_OF_LOG, LIMIT_OF_LOG)), error, figure, model)
        if what == "spacing":
            self.save(figure, what)

    def report(self, what, method, predict, measure, figure, model=None):
        """Prints the means over the tests, and the parameters that were chosen; adds pictures to the figure."""
        values = {test.name: predict(test) for tests in self.tests.values() for test in tests}
        figure.add(method, lambda test: values[test.name])
        means = (f"{kind} {100 * numpy.mean([measure(test, values[test.name]) for test in tests]):5.1f}"
                 for kind, tests in self.tests.items() if tests)
        chosen = getattr(model, "best_params_", "") or getattr(model, "alpha_", "")
        print(f"{self.name:>10} {what:>10} {method:>20}  {'  '.join(means)}  {chosen}".rstrip(), flush=True)

    def save(self, figure, what):
        if self.pictures and self.shown:
            figure.save(self.pictures / f"{self.name}_{what}.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER", help="of 'exemplar hatch evaluate --export'")
    parser.add_argument("--pictures", type=pathlib.Path, metavar="FOLDER", help="where to write pictures of what is predicted")
    arguments = parser.parse_args()
    folder = arguments.folder
    names = sorted(file.name[: -len("_train_x.npy")] for file in folder.glob("*_train_x.npy"))
    if not names:
        sys.exit(f"error: {folder}: has no rows; write some with 'exemplar hatch evaluate --export {folder}'")
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore", ConvergenceWarning)
    for name in names:
        style = Style(folder, name, arguments.pictures)
        style.compare_levels()
        for column in range(1, len(PROPERTIES) + 1):
            style.compare_property(column)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares learned hatching with other methods of learning on the same rows (thesis Figs. 4.4 and 4.5).

    exemplar hatch evaluate cow.obj spot.obj --export rows
    hatching_peers.py rows

learns the hatching level and, as logarithms, the properties of strokes from one drawing, and prints the share of levels
that are right, and the median relative error of each property, in percent: on the drawing's own view ("seen"), and
the mean over all other pictures ("unseen").

- All methods learn from as many rows as Exemplar does: levels from 16,000 pixels of the object, properties from up to
  16,000 pixels of center lines, lengths without strokes that cross others.
- "boosting" is Exemplar without its graph cut. "majority" guesses the drawing's most common level everywhere.
- Parameters are chosen by cross-validation over four folds of rectangles of the drawing, so that no neighbor of
  a held-out pixel is learned from.
- To keep it to an hour on two idle cores, logistic regression uses L-BFGS with at most 300 iterations, the support
  vector machine solves its primal problem, and forests have 100 trees for levels and 50 for properties, which search
  a tenth of the features at each split.

Needs scikit-learn (Debian: python3-sklearn), and takes ten times as long without OpenBLAS (libopenblas0)."""

import argparse
import pathlib
import sys
import warnings

import numpy
from sklearn.dummy import DummyClassifier
from sklearn.ensemble import RandomForestClassifier, RandomForestRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.feature_selection import VarianceThreshold
from sklearn.linear_model import LassoCV, LogisticRegression, Ridge
from sklearn.model_selection import GridSearchCV, PredefinedSplit
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
        "ridge": chosen(Ridge(), alpha=numpy.logspace(-1, 7, 17)),
        "lasso": LassoCV(n_alphas=30, eps=1e-3, max_iter=2000, random_state=1, cv=split, n_jobs=-1),
        "random forest": chosen(RandomForestRegressor(50, max_features=0.1, random_state=1), min_samples_leaf=[5, 20, 80]),
    }


class Scaling:
    """Standardized features; what is far outside counts as at the limit."""

    def __init__(self, rows):
        self.pipeline = make_pipeline(VarianceThreshold(), StandardScaler()).fit(rows)

    def __call__(self, rows):
        return numpy.clip(self.pipeline.transform(rows), -LIMIT, LIMIT)


class Rows:
    """Rows of a picture: features `x`, targets `y`, `pixel` coordinates, and of tests what was `learned` and `boosted`."""

    def __init__(self, stem):
        for file in stem.parent.glob(f"{stem.name}_*.npy"):
            setattr(self, file.stem[len(stem.name) + 1:], numpy.load(file).astype(float))


def tests_of(folder, style, kind):
    return [Rows(file.with_name(file.name[:-len("_x.npy")])) for file in sorted(folder.glob(f"{style}_{kind}_*_x.npy"))]


class Style:
    """What is learned from one drawing, and the pictures to test on."""

    def __init__(self, folder, name):
        self.name = name
        self.levels, self.strokes = Rows(folder / f"{name}_train"), Rows(folder / f"{name}_strokes")
        self.tests = {"seen": tests_of(folder, name, "seen"), "unseen": tests_of(folder, name, "test")}

    def compare_levels(self):
        self.report("level", "here", lambda test: numpy.mean(test.learned[:, 0] == test.y[:, 0]))
        self.report("level", "boosting", lambda test: numpy.mean(test.boosted[:, 0] == test.y[:, 0]))
        scaling, levels = Scaling(self.levels.x), self.levels.y[:, 0].astype(int)
        for method, model in classifiers(folds(self.levels.pixel)).items():
            # A drawing of one level leaves nothing to learn.
            model = model if len(set(levels)) > 1 else DummyClassifier()
            model.fit(scaling(self.levels.x), levels)
            self.report("level", method, lambda test: model.score(scaling(test.x), test.y[:, 0].astype(int)), model)

    def compare_property(self, column):
        """Compares where the rule has strokes."""
        def error(test, values):
            return numpy.median(numpy.abs(values / test.y[:, column] - 1)[test.y[:, 0] > 0])

        what = PROPERTIES[column - 1]
        self.report(what, "here", lambda test: error(test, test.learned[:, column]))
        rows = numpy.flatnonzero(self.strokes.y[:, column] > 0)[:PROPERTY_ROWS]
        x, targets = self.strokes.x[rows], numpy.log(self.strokes.y[rows, column])
        scaling = Scaling(x)
        for method, model in regressions(folds(self.strokes.pixel[rows])).items():
            model.fit(scaling(x), targets)
            self.report(what, method, lambda test: error(test, numpy.exp(model.predict(scaling(test.x)))), model)

    def report(self, what, method, measure, model=None):
        """Prints the means over the tests, and the parameters that were chosen."""
        means = (f"{kind} {100 * numpy.mean([measure(test) for test in tests]):5.1f}" for kind, tests in self.tests.items() if tests)
        chosen = getattr(model, "best_params_", "") or getattr(model, "alpha_", "")
        print(f"{self.name:>10} {what:>10} {method:>20}  {'  '.join(means)}  {chosen}".rstrip(), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER", help="of 'exemplar hatch evaluate --export'")
    folder = parser.parse_args().folder
    names = sorted(file.name[: -len("_train_x.npy")] for file in folder.glob("*_train_x.npy"))
    if not names:
        sys.exit(f"error: {folder}: has no rows; write some with 'exemplar hatch evaluate --export {folder}'")
    warnings.simplefilter("ignore", ConvergenceWarning)
    for name in names:
        style = Style(folder, name)
        style.compare_levels()
        for column in range(1, len(PROPERTIES) + 1):
            style.compare_property(column)


if __name__ == "__main__":
    main()

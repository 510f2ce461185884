#!/usr/bin/env python3
"""Compares learned hatching with other methods of learning on the same rows (thesis Figs. 4.4 and 4.5).

    exemplar hatch evaluate cow.obj spot.obj --export rows
    hatching_peers.py rows

learns the hatching level by nearest neighbor, logistic regression, a linear support vector machine and a decision tree,
and the properties of strokes, as logarithms, by ridge and lasso regression, from the rows of each drawing. It prints the
mean over test drawings of the share of levels that are right, and of the median relative error of each property, in
percent. Parameters of the methods are chosen by cross-validation on the training rows. Needs scikit-learn
(Debian: python3-sklearn)."""

import argparse
import pathlib
import sys
import warnings

import numpy
from sklearn.exceptions import ConvergenceWarning
from sklearn.feature_selection import VarianceThreshold
from sklearn.linear_model import LassoCV, LogisticRegression, RidgeCV
from sklearn.model_selection import GridSearchCV
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import LinearSVC
from sklearn.tree import DecisionTreeClassifier

PROPERTIES = ("thickness", "intensity", "spacing", "length")
CLASSIFIER_ROWS, REGRESSION_ROWS = 6000, 8000
# Every training row is about as likely as another: what is standardized may still be far outside in another drawing.
LIMIT = 5.0


def classifiers():
    weights = [0.001, 0.01, 0.1, 1.0]
    return {
        "nearest neighbor": GridSearchCV(KNeighborsClassifier(), {"n_neighbors": [1, 5, 25]}),
        "logistic regression": GridSearchCV(LogisticRegression(max_iter=300), {"C": weights}),
        "linear SVM": GridSearchCV(LinearSVC(dual=False, max_iter=300), {"C": weights}),
        "decision tree": GridSearchCV(DecisionTreeClassifier(random_state=1), {"min_samples_leaf": [1, 5, 20, 80]}),
    }


def regressions():
    return {
        "ridge": RidgeCV(alphas=numpy.logspace(-1, 5, 13)),
        "lasso": LassoCV(n_alphas=30, eps=1e-3, max_iter=2000, random_state=1),
    }


class Scaling:
    """Standardized features; what is far outside counts as at the limit."""

    def __init__(self, rows):
        self.pipeline = make_pipeline(VarianceThreshold(), StandardScaler()).fit(rows)

    def __call__(self, rows):
        return numpy.clip(self.pipeline.transform(rows), -LIMIT, LIMIT)


def relative_error(values, truth):
    return float(numpy.median(numpy.abs(values / truth - 1)))


class Style:
    """Rows of a training drawing, and of drawings to test on."""

    def __init__(self, folder, name):
        self.name = name
        self.x, self.y = (numpy.load(folder / f"{name}_train_{part}.npy").astype(float) for part in "xy")
        self.tests = []
        for file in sorted(folder.glob(f"{name}_test_*_x.npy")):
            stem = str(file)[: -len("_x.npy")]
            self.tests.append([numpy.load(f"{stem}_{part}.npy").astype(float) for part in ("x", "y", "learned")])
        self.scaling = Scaling(self.x)

    def level_accuracies(self):
        levels = self.y[:, 0].astype(int)
        result = {"here": numpy.mean([numpy.mean(learned[:, 0] == y[:, 0]) for _, y, learned in self.tests])}
        rows = self.scaling(self.x)[:CLASSIFIER_ROWS]
        for method, model in classifiers().items():
            if len(set(levels[:CLASSIFIER_ROWS])) < 2:
                result[method] = numpy.mean([numpy.mean(y[:, 0] == levels[0]) for _, y, _ in self.tests])
                continue
            model.fit(rows, levels[:CLASSIFIER_ROWS])
            result[method] = numpy.mean([model.score(self.scaling(x), y[:, 0].astype(int)) for x, y, _ in self.tests])
        return result

    def property_errors(self, column):
        """Only where the drawing, or the truth, has strokes."""
        result = {"here": numpy.mean([relative_error(learned[both, column], y[both, column])
                                      for _, y, learned in self.tests
                                      for both in [(y[:, 0] > 0) & (learned[:, 0] > 0)]])}
        hatched = (self.y[:, 0] > 0) & (self.y[:, column] > 0)
        rows = self.scaling(self.x[hatched])[:REGRESSION_ROWS]
        targets = numpy.log(self.y[hatched, column])[:REGRESSION_ROWS]
        for method, model in regressions().items():
            model.fit(rows, targets)
            result[method] = numpy.mean([relative_error(numpy.exp(model.predict(self.scaling(x[both]))), y[both, column])
                                         for x, y, learned in self.tests
                                         for both in [(y[:, 0] > 0) & (learned[:, 0] > 0)]])
        return result


def print_row(style, what, values):
    print(f"{style:>10} {what:>10}  " + "  ".join(f"{name} {100 * value:.1f}" for name, value in values.items()), flush=True)


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
        print_row(name, "level", style.level_accuracies())
        for column, what in enumerate(PROPERTIES, start=1):
            print_row(name, what, style.property_errors(column))


if __name__ == "__main__":
    main()

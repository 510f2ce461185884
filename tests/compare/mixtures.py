#!/usr/bin/env python3
"""Compares mixtures of regressions on data whose truth is known (thesis Secs. 2.2.4 and 2.2.5, Fig. 2.3).

    tests/compare/mixtures.py [--sets 10] [--picture docs/results/compare_mixtures.png]

  parabolas   samples of two parabolas at once, as in the figure. Exemplar has no mixture of such: one fit by its least squares
              beside the thesis' expectation maximization (EM, Eqs. 2.26-2.32)
  directions  strokes that follow one of two rules, each a combination of a few of 38 fields of directions: in a half of the
              picture each (apart), or both everywhere (crossed). Here Exemplar's mixture, which hatching learns, is beside EM,
              EM with a gate by place (mixture of experts) and clusters, all of which are told that there are two rules
It prints medians over data sets of the error against the truth without noise; of directions also which share of the samples is
given to the right rule. Needs scikit-learn (Debian: python3-sklearn), for the picture matplotlib (python3-matplotlib)."""

import argparse
import itertools

import numpy
from scipy.optimize import linear_sum_assignment
from scipy.special import logsumexp
from sklearn.linear_model import LogisticRegression, RidgeCV
from sklearn.mixture import GaussianMixture

import programs

FIELDS, DENSITY, SPACING = 38, 0.156, 5
PARABOLAS = (1.0, -0.5)


class Fit:
    """Regressions of a mixture, components x inputs, and how likely each sample is of each, samples x components."""

    def __init__(self, weights, posterior, likelihood):
        self.weights, self.posterior, self.likelihood = weights, posterior, likelihood


def constant_gate(posterior):
    """Eq. 2.30."""
    return numpy.log(posterior.mean(axis=0, keepdims=True))


class PlaceGate:
    """Logarithms of the probability of a component given the place (thesis Sec. 2.2.5)."""

    def __init__(self, place):
        x, y = (2 * place / place.max(axis=0) - 1).T
        self.inputs = numpy.stack([x, y, x * x, x * y, y * y], axis=1)

    def __call__(self, posterior):
        count = posterior.shape[1]
        labels = numpy.repeat(numpy.arange(count), len(posterior))
        model = LogisticRegression().fit(numpy.tile(self.inputs, (count, 1)), labels, posterior.T.ravel())
        return model.predict_log_proba(self.inputs)


def maximize_expectation(inputs, targets, weights, gate=constant_gate, iterations=200):
    """EM from given weights. Inputs are samples x inputs x dimensions of the target: each dimension has the same weights."""
    samples, count, dimensions = inputs.shape
    rows, flat = inputs.transpose(0, 2, 1).reshape(-1, count), targets.ravel()
    log_prior = numpy.full((1, len(weights)), -numpy.log(len(weights)))
    variance, last = targets.var(), -numpy.inf
    for iteration in range(iterations + 1):
        squares = ((targets[:, None] - numpy.einsum("nit,ki->nkt", inputs, weights)) ** 2).sum(axis=2)
        log = log_prior - squares / (2 * variance) - dimensions / 2 * numpy.log(2 * numpy.pi * variance)
        likelihood = logsumexp(log, axis=1)
        posterior = numpy.exp(log - likelihood[:, None])
        if iteration == iterations or likelihood.mean() - last < 1e-6:
            return Fit(weights, posterior, likelihood.mean())
        last = likelihood.mean()
        # What one component alone explains must not make the variance vanish.
        variance = max((posterior * squares).sum() / (samples * dimensions), 1e-6) if iteration else variance
        weights = numpy.stack([weighted_least_squares(rows, flat, numpy.repeat(p, dimensions)) for p in posterior.T])
        log_prior = gate(posterior)
    return None


def weighted_least_squares(rows, targets, weight):
    """Eq. 2.31; a trace of a ridge where a component has hardly any samples."""
    normal = rows.T @ (weight[:, None] * rows)
    return numpy.linalg.solve(normal + 1e-9 * numpy.eye(len(normal)), rows.T @ (weight * targets))


def best_start(inputs, targets, starts, **how):
    """The likeliest of EM from each of these weights."""
    return max((maximize_expectation(inputs, targets, start, **how) for start in starts), key=lambda fit: fit.likelihood)


# Two parabolas, as in Fig. 2.3

class Parabolas:
    """Samples y, each of one of two parabolas a x^2 at random, and noise."""

    def __init__(self, rows, noise, seed):
        random = numpy.random.RandomState(seed)
        self.x = random.uniform(-1, 1, rows)
        self.y = numpy.array(PARABOLAS)[random.randint(2, size=rows)] * self.x ** 2 + noise * random.normal(size=rows)
        self.test = numpy.linspace(-1, 1, 101)
        self.truth = numpy.outer(PARABOLAS, self.test ** 2)

    def by_em(self, starts, rounds=200):
        """The two curves that EM finds, the upper one first; the starts are random."""
        inputs, targets = (self.x ** 2)[:, None, None], self.y[:, None]
        weights = numpy.random.RandomState(1).normal(size=(starts, 2, 1))
        found = best_start(inputs, targets, weights, iterations=rounds).weights
        return numpy.sort(found, axis=0)[::-1] * self.test ** 2

    def by_ours(self):
        """The one curve of Exemplar's least squares, twice."""
        arrays = {"x": self.x[None, :, None] ** 2, "y": self.y[None], "test": self.test[None, :, None] ** 2}
        found = programs.run("compare_regress", ["least_squares"], {name: a.astype("<f4") for name, a in arrays.items()})[0]["y"]
        return numpy.repeat(found, 2, axis=0)

    def error(self, curves):
        """Of both curves, in percent of the true ones' root mean square."""
        return 100 * numpy.sqrt(((curves - self.truth) ** 2).mean() / (self.truth ** 2).mean())


PARABOLA_LEARNERS = {
    "one curve, least squares, here": lambda data: data.by_ours(),
    "EM, one start, 5 rounds": lambda data: data.by_em(1, rounds=5),
    "EM, one start": lambda data: data.by_em(1),
    "EM, ten starts": lambda data: data.by_em(10),
}


def parabola_errors(sets):
    """Columns: samples and noise."""
    columns = {}
    for rows, noise in [(100, 0.02), (100, 0.1), (100, 0.2), (1000, 0.2)]:
        data = [Parabolas(rows, noise, seed) for seed in range(1, sets + 1)]
        columns[f"noise {noise}, {rows} samples"] = {
            name: f"{numpy.median([d.error(learner(d)) for d in data]):.1f}" for name, learner in PARABOLA_LEARNERS.items()}
    return columns


# Two rules of directions. Directions have no sign: a vector is (cos 2 angle, sin 2 angle).

def doubled(angle):
    return numpy.stack([numpy.cos(2 * angle), numpy.sin(2 * angle)], axis=-1)


def unit(vectors):
    return vectors / numpy.maximum(numpy.linalg.norm(vectors, axis=-1, keepdims=True), 1e-6)


def degrees_between(a, b):
    return numpy.degrees(numpy.arccos(numpy.clip((unit(a) * unit(b)).sum(axis=-1), -1, 1)) / 2)


class Strokes:
    """Samples of strokes; the picture's area is in proportion to their number. `noise` is in degrees, and so is by how much
    fields turn over the picture."""

    def __init__(self, rows, noise, crossed, turn, seed):
        random = numpy.random.RandomState(seed)
        size = numpy.sqrt(rows / DENSITY * numpy.array([1.5, 1 / 1.5]))
        self.place = numpy.floor(random.uniform(0, size, (rows, 2))).astype("<i4")
        self.fields = self.smooth_fields(self.place / size, numpy.radians(turn), random)
        self.rules = self.two_rules(random)
        self.truth = random.binomial(1, 0.4, rows) if crossed else (self.place[:, 0] > size[0] / 2).astype(int)
        self.ideal = self.rules[self.truth, numpy.arange(rows)]
        angle = numpy.arctan2(self.ideal[:, 1], self.ideal[:, 0]) / 2
        self.direction = doubled(angle + numpy.radians(noise) * random.normal(size=rows))
        self.level = numpy.full(rows, 2 if crossed else 1, "u1")

    @staticmethod
    def smooth_fields(place, turn, random):
        """FIELDS x samples: each turns over the picture along a direction of its own, and in a wave."""
        angle, wave = random.uniform(0, numpy.pi, FIELDS), random.uniform(0, 0.3, FIELDS)
        along = turn * doubled(random.uniform(0, numpy.pi, FIELDS)).T * random.uniform(0, 1, FIELDS)
        return doubled((angle + place @ along + wave * numpy.sin(6 * place.sum(axis=1))[:, None]).T)

    def two_rules(self, random):
        """2 x samples: one field; and of two others a sum, turned so that it lies across the first in the mean."""
        first, second, third = self.fields[random.permutation(FIELDS)[:3]]
        # Fields may also be turned by 90 degrees, which negates them.
        others = [unit(0.7 * a * second + 0.3 * b * third) for a in (1, -1) for b in (1, -1)]
        return numpy.stack([first, min(others, key=lambda other: (first * other).sum())])

    def inputs(self):
        return self.fields.transpose(1, 0, 2)

    def starts(self, count):
        """Random sums of the fields."""
        return numpy.random.RandomState(1).normal(size=(count, 2, FIELDS)) / numpy.sqrt(FIELDS)

    def directions(self, weights):
        """Of each regression: components x samples x 2."""
        return unit(numpy.einsum("fnt,cf->cnt", self.fields, weights))

    def quality(self, predicted, rule):
        """Mean degrees that the rules given to the samples are off, and the percentage of samples given the right rule."""
        table = numpy.zeros((2, len(predicted)))
        numpy.add.at(table, (self.truth, rule), 1)
        off = degrees_between(predicted[rule, numpy.arange(len(rule))], self.ideal).mean()
        return off, 100 * table[linear_sum_assignment(-table)].sum() / len(rule)


def by_ours(data):
    found = programs.run("compare_mixture", [], {
        "fields": data.fields.astype("<f4"), "direction": data.direction.astype("<f4"), "place": data.place,
        "level": data.level, "spacing": numpy.full(len(data.level), SPACING, "<f4")})[0]
    return found["predicted"], found["rule"]


def by_em(data, gate=constant_gate):
    fit = best_start(data.inputs(), data.direction, data.starts(10), gate=gate)
    return data.directions(fit.weights), fit.posterior.argmax(axis=1)


def ridge_of(data, chosen):
    """One regression of some of the samples; both parts of the vectors have the same weights."""
    rows = data.inputs()[chosen].transpose(0, 2, 1).reshape(-1, FIELDS)
    return RidgeCV(alphas=numpy.logspace(-5, 3, 17), fit_intercept=False).fit(rows, data.direction[chosen].ravel()).coef_


def by_one_ridge(data):
    everything = numpy.ones(len(data.level), bool)
    return data.directions(ridge_of(data, everything)[None]), numpy.zeros(len(data.level), int)


def by_clusters(data):
    """Gaussian clusters of directions and places first, then a ridge in each."""
    values = numpy.concatenate([data.direction, data.place / data.place.std(axis=0)], axis=1)
    rule = GaussianMixture(2, n_init=5, random_state=1).fit_predict(values)
    return data.directions(numpy.stack([ridge_of(data, rule == c) for c in (0, 1)])), rule


STROKE_LEARNERS = {
    "mixture, here": by_ours,
    "EM": by_em,
    "EM, gate by place": lambda data: by_em(data, PlaceGate(data.place)),
    "clusters, then ridge": by_clusters,
    "one ridge": by_one_ridge,
}


def stroke_errors(sets):
    """Columns: apart or crossed, and by how much fields turn; each of 1000 samples, with 10 degrees of noise."""
    columns = {}
    for crossed, turn in itertools.product((False, True), (40, 120)):
        data = [Strokes(1000, 10, crossed, turn, seed) for seed in range(1, sets + 1)]
        columns[f"{'crossed' if crossed else 'apart'}, turning by {turn}°"] = {
            name: "{:.1f}° / {:.1f}".format(*numpy.median([d.quality(*learner(d)) for d in data], axis=0))
            for name, learner in STROKE_LEARNERS.items()}
    return columns


def print_columns(title, columns):
    names = list(next(iter(columns.values())))
    print("\n" + programs.table(title, list(columns), [(name, [c[name] for c in columns.values()]) for name in names]), flush=True)


def draw_parabolas(axes):
    """The three parts of Fig. 2.3."""
    data = Parabolas(100, 0.05, seed=1)
    lines = [("one curve (least squares, here)", data.by_ours()[:1], "tab:green"),
             ("two at random", data.by_em(1, rounds=0), "tab:red"), ("two after 5 rounds of EM", data.by_em(1, rounds=5), "tab:red")]
    for cell, (name, curves, color) in zip(axes, lines):
        cell.plot(data.x, data.y, "k.", markersize=2)
        cell.plot(data.test, data.truth.T, color="tab:cyan", linestyle=":")
        cell.plot(data.test, curves.T, color=color)
        cell.set_title(name, fontsize=8, loc="left")
        cell.set_ylim(-1, 1.5)


def draw_strokes(axes):
    """Strokes apart, as they are, and by the mixture here and by EM; the color is the rule that a sample is given to."""
    data = Strokes(1000, 10, False, 120, seed=1)
    answers = {"two rules and noise": (data.direction, data.truth)}
    for name in ("mixture, here", "EM"):
        predicted, rule = STROKE_LEARNERS[name](data)
        answers[name] = predicted[rule, numpy.arange(len(rule))], rule
    for cell, (name, (direction, rule)) in zip(axes, answers.items()):
        half = numpy.arctan2(direction[:, 1], direction[:, 0]) / 2
        cell.quiver(*data.place.T, numpy.cos(half), numpy.sin(half), rule, cmap="coolwarm", pivot="mid", headwidth=0,
                    headlength=0, headaxislength=0, scale=45, width=0.004)
        cell.set_title(name, fontsize=8, loc="left")
        cell.set_xticks([])
        cell.set_yticks([])
        cell.set_aspect("equal")


def draw(path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.rcParams.update({"font.size": 8})
    figure, (above, below) = pyplot.subplots(2, 3, figsize=(9, 5), layout="constrained")
    draw_parabolas(above)
    draw_strokes(below)
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=10, help="data sets per setting")
    parser.add_argument("--picture", metavar="FILE", help="also draw a data set of each truth")
    options = parser.parse_args()
    if options.picture:
        draw(options.picture)
    print_columns("parabolas", parabola_errors(options.sets))
    print_columns("directions: off / right rule, %", stroke_errors(options.sets))


if __name__ == "__main__":
    main()

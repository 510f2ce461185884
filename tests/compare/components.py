#!/usr/bin/env python3
"""Compares principal and independent components on samples whose sources are known (thesis Sec. 2.5, Fig. 2.6).

    tests/compare/components.py [--sets 10] [--picture docs/results/compare_components.png]

Samples are sums of known bases times independent sources, and noise. The bases are bumps on a grid, as folds of a cloth
are local, and some of them overlap. Printed are, as means over data sets, how well each true basis is matched by one that
was found (the cosine between them, means over the true ones), and the Amari distance (0: every source found apart, 1:
none), of Exemplar's components and of scikit-learn's. Needs scikit-learn (Debian: python3-sklearn), for the picture
matplotlib (python3-matplotlib)."""

import argparse
import warnings

import numpy
from scipy.optimize import linear_sum_assignment
from sklearn.decomposition import PCA, FastICA
from sklearn.exceptions import ConvergenceWarning

import programs

GRID, BASES = 16, 8
SOURCES = {
    "sparse": lambda random, shape: random.laplace(size=shape),
    "uniform": lambda random, shape: random.uniform(-1, 1, shape),
    "one-sided": lambda random, shape: random.exponential(size=shape),
    "Gaussian": lambda random, shape: random.normal(size=shape),
}


def bumps(random):
    """Bases, values x BASES: Gaussian bumps at random places of a grid."""
    across = numpy.arange(GRID)
    x, y = numpy.meshgrid(across, across)
    places = random.uniform(2, GRID - 3, (BASES, 2))
    widths = random.uniform(1.2, 2.2, BASES)
    return numpy.stack([numpy.exp(-((x - px) ** 2 + (y - py) ** 2) / (2 * w * w)).ravel()
                        for (px, py), w in zip(places, widths)], axis=1)


class Mixture:
    """Samples, rows x values, and the bases that they are made of."""

    def __init__(self, rows, kind, noise, seed):
        random = numpy.random.RandomState(seed)
        self.bases = bumps(random)
        sources = SOURCES[kind](random, (rows, BASES))
        samples = sources / sources.std(axis=0) @ self.bases.T
        self.samples = (samples + noise * samples.std() * random.normal(size=samples.shape)).astype("<f4")


def match(found, bases):
    """The mean over the true bases of |cosine| with the found one that is theirs, each given once; and which that is."""
    cosines = numpy.abs((found / numpy.linalg.norm(found, axis=0)).T @ (bases / numpy.linalg.norm(bases, axis=0)))
    mine, theirs = linear_sum_assignment(-cosines)
    return cosines[mine, theirs].mean(), mine[numpy.argsort(theirs)]


def amari_distance(found, bases):
    """0 if what undoes `found` takes the bases apart, at most 1."""
    p = numpy.abs(numpy.linalg.pinv(found) @ bases)
    excess = (p.sum(axis=1) / p.max(axis=1) - 1).sum() + (p.sum(axis=0) / p.max(axis=0) - 1).sum()
    return excess / (2 * len(p) * (len(p) - 1))


def ours(method):
    return lambda samples: programs.run("compare_components", [method, BASES], {"samples": samples})[0]["basis"]


def peer_ica(samples):
    model = FastICA(BASES, whiten="unit-variance", max_iter=1000, tol=1e-5, random_state=0)
    return model.fit(samples.astype(float)).mixing_


def peer_ica_of_bases(samples):
    """The bases are what is independent over the values; the samples' own mean has no part in it."""
    centered = (samples - samples.mean(axis=0)).astype(float)
    return FastICA(BASES, whiten="unit-variance", max_iter=1000, tol=1e-5, random_state=0).fit_transform(centered.T)


LEARNERS = {
    "PCA, here": ours("pca"),
    "PCA, scikit-learn": lambda samples: PCA(BASES).fit(samples).components_.T,
    "ICA, here": ours("ica"),
    "ICA, scikit-learn": peer_ica,
    "ICA of the bases, here": ours("spatial_ica"),
    "ICA of the bases, scikit-learn": peer_ica_of_bases,
}


def quality(learner, rows, kind, noise, sets):
    """Means over data sets of match and Amari distance."""
    both = []
    for seed in range(1, sets + 1):
        mixture = Mixture(rows, kind, noise, seed)
        found = LEARNERS[learner](mixture.samples)
        # A basis without length matches nothing.
        found = found + 1e-12 * numpy.random.RandomState(0).normal(size=found.shape)
        both.append((match(found, mixture.bases)[0], amari_distance(found, mixture.bases)))
    return numpy.mean(both, axis=0)


SETTINGS = [(1000, "sparse", 0), (1000, "sparse", 0.5), (200, "sparse", 0), (50, "sparse", 0), (1000, "uniform", 0),
            (1000, "one-sided", 0), (1000, "Gaussian", 0)]


def print_table(sets):
    columns = [f"{kind}, {rows} samples" + (f", noise {noise}" if noise else "") for rows, kind, noise in SETTINGS]
    rows = []
    for learner in LEARNERS:
        found = [quality(learner, *setting, sets) for setting in SETTINGS]
        rows.append((learner, [f"{matched:.3f} / {apart:.3f}" for matched, apart in found]))
    print(programs.table("match / Amari distance", columns, rows), flush=True)


def draw(path):
    """True bases of one mixture, and those found, in the same order; white is zero, red the largest magnitude."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    mixture = Mixture(1000, "sparse", 0.5, 1)
    rows = {"truth": mixture.bases}
    rows.update({name: LEARNERS[name](mixture.samples) for name in ("PCA, here", "ICA, here", "ICA of the bases, here")})
    figure, axes = pyplot.subplots(len(rows), BASES, figsize=(BASES, len(rows) * 1.12), layout="constrained")
    for line, (name, bases) in zip(axes, rows.items()):
        bases = bases[:, match(bases, mixture.bases)[1]]
        for cell, basis in zip(line, bases.T):
            cell.imshow(numpy.abs(basis).reshape(GRID, GRID), cmap="Reds", vmin=0)
            cell.set_xticks([])
            cell.set_yticks([])
        line[0].set_title(name, fontsize=8, loc="left")
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=10, help="data sets per setting")
    parser.add_argument("--picture", metavar="FILE", help="also draw the bases of a data set")
    options = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    if options.picture:
        draw(options.picture)
    print_table(options.sets)


if __name__ == "__main__":
    main()

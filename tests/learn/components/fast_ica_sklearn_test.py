#!/usr/bin/env python3
"""Compares FastICA with that of scikit-learn on the same data.

    fast_ica_sklearn_test.py UNMIX

UNMIX is the program of programs/unmix.cpp. Exit code 77 says that the test was skipped, and why."""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

SKIPPED = 77
UNMIX = None
SCHEMES = {"symmetric": "parallel", "deflation": "deflation"}
CONTRASTS = {"log_cosh": "logcosh", "gauss": "exp", "kurtosis": "cube"}


def mixed_samples(count, values, seed):
    """Two sources with lighter tails than a Gaussian, two with heavier ones, mixed; and the mixing matrix."""
    random = numpy.random.RandomState(seed)
    sources = numpy.stack([random.uniform(-1, 1, count), numpy.sin(0.37 * numpy.arange(count)),
                           random.laplace(size=count), random.exponential(size=count)], axis=1)
    mixing = random.normal(size=(values, sources.shape[1]))
    return (sources / sources.std(axis=0) @ mixing.T + 3).astype("<f4"), mixing


def amari_index(product):
    """0 if `product` is a permutation with signs and scales, at most 1."""
    p = numpy.abs(product)
    excess = (p.sum(axis=1) / p.max(axis=1) - 1).sum() + (p.sum(axis=0) / p.max(axis=0) - 1).sum()
    return excess / (2 * len(p) * (len(p) - 1))


def our_unmixing(samples, components, scheme, contrast):
    with tempfile.TemporaryDirectory(prefix="exemplar-ica-") as folder:
        given, found = pathlib.Path(folder) / "samples", pathlib.Path(folder) / "unmixing"
        samples.tofile(given)
        rows, columns = samples.shape
        subprocess.run([UNMIX, str(rows), str(columns), str(components), scheme, contrast, given, found], check=True,
                       timeout=60)
        return numpy.fromfile(found, "<f4").reshape(components, columns)


class ParityTest(unittest.TestCase):
    def compare(self, rows, columns, scheme, contrast):
        samples, mixing = mixed_samples(rows, columns, seed=rows)
        theirs = FastICA(4, algorithm=SCHEMES[scheme], fun=CONTRASTS[contrast], whiten="unit-variance", tol=1e-6,
                         max_iter=1000, random_state=0).fit(samples.astype(float))
        ours = our_unmixing(samples, 4, scheme, contrast)
        between = amari_index(ours @ theirs.mixing_)
        print(f"{rows} x {columns} {scheme} {contrast}: {between:.5f} apart, from the truth "
              f"{amari_index(ours @ mixing):.5f} and {amari_index(theirs.components_ @ mixing):.5f}")
        return between

    def test_finds_the_components_that_scikit_learn_finds(self):
        for scheme in SCHEMES:
            for contrast in CONTRASTS:
                with self.subTest(scheme=scheme, contrast=contrast):
                    # Which component deflation finds first depends on where it starts, and with it the errors of all.
                    self.assertLess(self.compare(5000, 12, scheme, contrast), 0.001 if scheme == "symmetric" else 0.05)

    def test_finds_them_in_fewer_samples_than_values(self):
        self.assertLess(self.compare(500, 600, "symmetric", "log_cosh"), 0.001)


if __name__ == "__main__":
    try:
        import numpy
        from sklearn.decomposition import FastICA
    except ImportError as error:
        print(f"skipped: {sys.executable} has no scikit-learn (Debian: python3-sklearn): {error}")
        sys.exit(SKIPPED)
    UNMIX = sys.argv.pop(1)
    warnings.simplefilter("error")  # scikit-learn says by a warning that it did not converge
    unittest.main()

#!/usr/bin/env python3
"""Principal and independent components beside those of scikit-learn, on few data sets; see components.py.

    components_test.py

Exit code 77 says that the test was skipped, and why."""

import unittest
import warnings

import programs

SETS = 3


class ComponentsTest(unittest.TestCase):
    def test_principal_components_are_those_of_scikit_learn(self):
        samples = components.Mixture(300, "sparse", 0.5, seed=1).samples
        ours, theirs = (components.LEARNERS[name](samples) for name in ("PCA, here", "PCA, scikit-learn"))
        self.assertGreater(components.match(ours, theirs)[0], 0.9999)

    def test_independent_components_find_sources_that_principal_ones_mix(self):
        for kind in ("sparse", "uniform", "one-sided"):
            with self.subTest(kind=kind):
                pca, ica, theirs = (components.quality(name, 1000, kind, 0, SETS)
                                    for name in ("PCA, here", "ICA, here", "ICA, scikit-learn"))
                self.assertGreater(ica[0], 0.97)
                self.assertLess(ica[1], 0.5 * pca[1])
                self.assertLess(ica[1], theirs[1] + 0.005)

    def test_gaussian_sources_cannot_be_told_apart(self):
        self.assertGreater(components.quality("ICA, here", 1000, "Gaussian", 0, SETS)[1],
                           4 * components.quality("ICA, here", 1000, "sparse", 0, SETS)[1])

    def test_bases_that_are_local_are_found_by_components_of_the_bases_whatever_the_sources(self):
        pca, spatial = (components.quality(name, 1000, "Gaussian", 0, SETS) for name in ("PCA, here", "ICA of the bases, here"))
        self.assertGreater(spatial[0], pca[0] + 0.05)


if __name__ == "__main__":
    programs.require_compare()
    import components
    warnings.simplefilter("ignore", components.ConvergenceWarning)
    unittest.main()

#!/usr/bin/env python3
"""Regressions beside those of other programs, on few data sets; see regressions.py.

    regressions_test.py

Exit code 77 says that the test was skipped, and why."""

import unittest
import warnings

import programs

SETS = 8


class RegressionTest(unittest.TestCase):
    def test_least_squares_are_those_of_scikit_learn(self):
        data = regressions.curve_sets(SETS, 20, 0.2, powers=4)
        ours, theirs = data.by_ours("least_squares"), data.by_peer(regressions.LinearRegression())
        self.assertLess(numpy.abs(ours - theirs).max(), 1e-3)

    def test_a_ridge_that_is_chosen_keeps_high_powers_from_following_the_noise(self):
        errors = regressions.median_errors(regressions.curve_sets(SETS, 20, 0.2, powers=10), regressions.OURS,
                                           {"ridge": regressions.peers()["ridge"]})
        self.assertLess(errors["ridge, here"], 0.6 * errors["least squares, here"])
        self.assertLess(errors["ridge, here"], 1.3 * errors["ridge"])

    def test_inputs_that_tell_nothing_cost_least_squares_more_than_a_ridge(self):
        errors = regressions.median_errors(regressions.irrelevant_sets(SETS, 20, 0.2, irrelevant=15), regressions.OURS, {})
        self.assertLess(errors["ridge, here"], 0.7 * errors["least squares, here"])

    def test_a_product_of_functions_is_found_among_inputs_that_tell_nothing(self):
        others = {name: regressions.Logarithm(regressions.peers()[name]) for name in ("ridge", "lasso")}
        errors = regressions.median_errors(regressions.product_sets(2, 400, 0.1, irrelevant=20),
                                           {"product, here": "product"}, others)
        self.assertLess(errors["product, here"], 0.7 * min(errors["ridge"], errors["lasso"]))


if __name__ == "__main__":
    programs.require_compare()
    import numpy
    import regressions
    warnings.simplefilter("ignore", regressions.ConvergenceWarning)
    unittest.main()

#!/usr/bin/env python3
"""Mixtures of regressions on few data sets; see mixtures.py.

    mixtures_test.py

Exit code 77 says that the test was skipped, and why."""

import unittest

import programs


class ParabolasTest(unittest.TestCase):
    def test_expectation_maximization_finds_both_where_one_curve_is_neither(self):
        data = mixtures.Parabolas(200, 0.1, seed=1)
        self.assertGreater(data.error(data.by_ours()), 80)
        self.assertLess(data.error(data.by_em(10)), 8)


class StrokesTest(unittest.TestCase):
    def quality(self, learner, crossed, turn, noise=3):
        """Means over two data sets."""
        data = [mixtures.Strokes(1000, noise, crossed, turn, seed) for seed in (1, 2)]
        return numpy.mean([d.quality(*mixtures.STROKE_LEARNERS[learner](d)) for d in data], axis=0)

    def test_what_is_off_is_counted(self):
        data = mixtures.Strokes(500, 0, True, 40, seed=1)
        self.assertLess(data.quality(data.rules, data.truth)[0], 0.1)
        self.assertEqual(100, data.quality(data.rules, data.truth)[1])
        self.assertEqual(100, data.quality(data.rules[::-1], 1 - data.truth)[1])
        self.assertGreater(data.quality(data.rules, 1 - data.truth)[0], 30)

    def test_strokes_that_cross_are_told_apart_as_by_expectation_maximization(self):
        for turn in (40, 120):
            with self.subTest(turn=turn):
                (off, right), (peer_off, peer_right) = (self.quality(name, True, turn) for name in ("mixture, here", "EM"))
                self.assertLess(off, peer_off + 0.3)
                self.assertGreater(right, peer_right - 1)

    def test_rules_of_two_halves_are_found_where_expectation_maximization_mixes_them(self):
        (off, right), (peer_off, peer_right) = (self.quality(name, False, 40, noise=10)
                                                for name in ("mixture, here", "EM"))
        self.assertLess(off, 0.6 * peer_off)
        self.assertGreater(right, 98)
        self.assertGreater(right, peer_right)


if __name__ == "__main__":
    programs.require_compare()
    import mixtures
    import numpy
    unittest.main()

#!/usr/bin/env python3
"""Labels of generated shapes by JointBoost beside those by other classifiers, on few rows; see labels.py.

    labels_test.py

Exit code 77 says that the test was skipped, and why."""

import pathlib
import tempfile
import unittest
import warnings

import programs

LEARNERS = ("JointBoost", "JointBoost, pooled", "JointBoost, single", "decision tree", "linear SVM", "XGBoost")
ROWS = 300


class MeasureTest(unittest.TestCase):
    """What counts as wrong, on two triangles of which one is three times as large."""

    def test_counts_the_surface_and_every_label(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "pair.off"
            path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 0\n3 0 1 2\n3 0 2 3\n")
            path.with_name("pair_labels.txt").write_text("leg\n1\ntail\n2\n")
            numpy.save(path.with_suffix(".npy"), numpy.zeros((2, 1)))
            mesh = labels.Mesh(path, path.with_suffix(".npy"))
        category = labels.Category.__new__(labels.Category)
        category.labels = ["leg", "tail"]
        self.assertEqual([1.0, 3.0], list(mesh.area / mesh.area[0]))
        self.assertEqual((0, 0), category.wrong(mesh, numpy.array([0, 1])))
        self.assertEqual((0.75, 0.5), category.wrong(mesh, numpy.array([0, 0])))
        category.labels = ["leg", "wing"]  # a label that was not learned is wrong
        self.assertEqual((0.75, 0.5), category.wrong(mesh, numpy.array([0, 1])))


class GaussianBayesTest(unittest.TestCase):
    """Two labels whose features have equal means and deviations, but rise together or against each other."""

    def test_covariances_tell_labels_apart_that_means_and_deviations_do_not(self):
        random = numpy.random.RandomState(1)
        label = random.randint(0, 2, 4000)
        common, own = random.normal(size=(2, 4000))
        x = numpy.stack([common, numpy.where(label == 1, common, -common) + 0.5 * own], axis=1)
        right = {}
        for smoothing in (0.1, 1):
            bayes = learners.GaussianBayes(smoothing, 0).fit(x[:2000], label[:2000], numpy.ones(2000))
            right[smoothing] = numpy.mean(bayes.decision_function(x[2000:]).argmax(axis=1) == label[2000:])
        self.assertGreater(right[0.1], 0.8)
        self.assertLess(right[1], 0.6)

    def test_scores_are_those_of_the_formula(self):
        x, label = numpy.array([[0.0], [2], [10], [14]]), numpy.array([0, 0, 1, 1])
        bayes = learners.GaussianBayes(0, 1).fit(x, label, numpy.ones(4))  # means 1 and 12, variances 1 and 4, even priors
        score = bayes.decision_function(numpy.array([[3.0]]))[0]
        self.assertAlmostEqual(numpy.log(0.5) - 2, score[0], 3)
        self.assertAlmostEqual(numpy.log(0.5) - numpy.log(2) - 81 / 8, score[1], 3)

    def test_faces_of_more_weight_count_more(self):
        x, label = numpy.array([[0.0], [1], [5], [6], [7]]), numpy.array([0, 0, 1, 1, 1])
        once = learners.GaussianBayes(0.5, 2).fit(x[[0, 0, 0, 1, 2, 3, 4]], label[[0, 0, 0, 1, 2, 3, 4]], numpy.ones(7))
        weighted = learners.GaussianBayes(0.5, 2 * 5 / 7).fit(x, label, numpy.array([3.0, 1, 1, 1, 1]))
        place = numpy.array([[2.0], [4]])
        self.assertTrue(numpy.allclose(once.decision_function(place), weighted.decision_function(place), atol=1e-6))


class LabelsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="exemplar-compare-")
        cls.category = next(labels.generated_categories(["fourleg"], pathlib.Path(cls.folder.name), ROWS, faces=2000))
        cls.results = labels.compare(cls.category, LEARNERS, ROWS)
        cls.errors = {name: result.errors(cls.category) for name, result in cls.results.items()}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_meshes_weigh_the_same_but_for_their_labels(self):
        category = self.category
        self.assertEqual(6 * ROWS, len(category.y))
        share = numpy.bincount(category.y, category.area)
        area = numpy.bincount(category.mesh, category.weight * numpy.sqrt(share[category.y]))
        self.assertLess(area.max() / area.min(), 1.5)

    def test_jointboost_labels_no_less_than_the_best_of_the_others(self):
        best = min(self.errors[name]["surface"] for name in labels.PEERS if name in LEARNERS)
        self.assertLess(self.errors["JointBoost"]["surface"], best + 2)
        self.assertLess(self.errors["JointBoost"]["surface"], 0.8 * self.errors["decision tree"]["surface"])

    def test_pooling_labels_more_of_what_is_held_out(self):
        held_out = {name: self.results[name].parameters["held out, surface"] for name in ("JointBoost", "JointBoost, pooled")}
        self.assertLess(held_out["JointBoost, pooled"], held_out["JointBoost"])

    def test_probabilities_of_jointboost_tell_more_than_shares_of_labels(self):
        shares = numpy.bincount(self.category.y, self.category.area)
        guessed = [labels.log_loss(numpy.tile(shares / shares.sum(), (len(mesh.area), 1)),
                                   numpy.searchsorted(self.category.labels, mesh.label.astype(str)), mesh.area)
                   for mesh in self.category.test]
        self.assertLess(self.errors["JointBoost"]["log loss"], 0.5 * numpy.mean(guessed))

    def test_results_are_taken_over_from_an_earlier_call(self):
        again = labels.compare(self.category, ["XGBoost"], ROWS)["XGBoost"]
        self.assertEqual(self.results["XGBoost"].train_seconds, again.train_seconds)
        self.assertLess(abs(self.errors["XGBoost"]["surface"] - again.errors(self.category)["surface"]), 1e-3)


class CutTest(unittest.TestCase):
    def test_the_graph_cut_takes_probabilities_of_any_learner(self):
        with tempfile.TemporaryDirectory(prefix="exemplar-compare-") as folder:
            category = next(labels.generated_categories(["cup"], pathlib.Path(folder), ROWS, train=3, faces=1000))
            known = labels.compare(category, ["decision tree"], ROWS)["decision tree"]
            random = numpy.random.RandomState(1)
            doubtful = [numpy.where(random.uniform(size=(len(scores), 1)) < 0.2, scores[:, ::-1], scores)
                        for scores in known.scores]
            noisy = labels.Result(doubtful, 0, 0, {}, scale=0.3)
            before = noisy.errors(category)["surface"]
            after = labels.cut_errors(category, {"noisy": noisy})["noisy"]
        self.assertGreater(before, 15)
        self.assertLess(after, 0.5 * before)


if __name__ == "__main__":
    programs.require_compare()
    import labels  # before numpy: it sets the number of threads
    import learners
    import numpy
    warnings.simplefilter("ignore", labels.ConvergenceWarning)
    unittest.main()

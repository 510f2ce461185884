#!/usr/bin/env python3
"""XGBoost in a cascade: its rows, context, and labels of generated shapes; see tree_cascade.py.

    tree_cascade_test.py

Exit code 77 says that the test was skipped, and why."""

import contextlib
import io
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import programs

KIND, FACES, TRAINING, TESTED = "table", 500, 4, 2
DEPTHS, ROUNDS = (2, 3), (10, 20)
CONTEXT_COLUMNS = 35  # per label: five ranges of seven distances


def exemplar(*arguments):
    subprocess.run([programs.program("exemplar"), *arguments, "--threads", "1", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)


class Shapes:
    """Generated shapes, the report of an evaluation with them, and its model."""

    def __init__(self, folder):
        self.folder = folder
        exemplar("synth", KIND, "--count", str(TRAINING + TESTED), "--faces", str(FACES), "--out", folder / "shapes")
        meshes = sorted((folder / "shapes").glob("*.off"))
        self.train, self.test = meshes[:TRAINING], meshes[TRAINING:]
        self.cache, self.report, self.models = folder / "cache", folder / "report.json", folder / "models"
        self.model = self.models / "Table" / "sb6-0" / "model.safetensors"
        self.model.parent.mkdir(parents=True)
        self.train_model(self.model, self.train)
        self.write_report(self.report, [mesh.stem for mesh in self.train])

    def train_model(self, model, meshes):
        exemplar("label", "train", *meshes, "--out", model, "--rounds", "20", "--stages", "1", "--cache", self.cache)

    def write_report(self, path, train):
        path.write_text(json.dumps({"categories": [{"category": "Table", "splits": [
            {"split": "sb6-0", "train": train, "meshes": [{"path": str(mesh)} for mesh in self.test]}]}]}))

    def context(self, mesh, probabilities):
        """Returns what 'compare_faces context' makes of probabilities of the faces of a mesh."""
        found = programs.run("compare_faces", ["context", self.cache, probabilities.shape[1]], {mesh.stem: probabilities},
                             behind=[mesh])[0]
        return found[mesh.stem]


def setUpModule():
    global shapes
    folder = tempfile.TemporaryDirectory(prefix="exemplar-compare-")
    unittest.addModuleCleanup(folder.cleanup)
    patch = unittest.mock.patch.multiple(tree_cascade, DEPTHS=DEPTHS, ROUNDS=ROUNDS)
    patch.start()
    unittest.addModuleCleanup(patch.stop)
    shapes = Shapes(pathlib.Path(folder.name))


class RowsTest(unittest.TestCase):
    """Five meshes; the third has one face of the last label, which no other has."""

    def setUp(self):
        random = numpy.random.RandomState(1)
        self.targets = [random.randint(-1, 2, 60 + 20 * mesh) for mesh in range(5)]
        self.targets[2][7] = 2
        self.areas = [random.uniform(0.5, 1 + mesh, len(target)) for mesh, target in enumerate(self.targets)]
        self.rows = tree_cascade.Rows(self.targets, self.areas, 3, 1)

    def test_only_labeled_faces_are_drawn_and_none_twice(self):
        with unittest.mock.patch.object(tree_cascade, "ROWS", 30):
            rows = tree_cascade.Rows(self.targets, self.areas, 3, 1)
        for faces, target in zip(rows.faces, self.targets):
            self.assertEqual(30, len(set(faces)))
            self.assertTrue((target[faces] >= 0).all())

    def test_meshes_weigh_the_same_but_for_their_labels(self):
        share = [area[faces] / area[faces].sum() for area, faces in zip(self.areas, self.rows.faces)]
        of_label = numpy.bincount(self.rows.label, numpy.concatenate(share))
        expected = numpy.concatenate(share) / numpy.sqrt(of_label[self.rows.label])
        self.assertTrue(numpy.allclose(expected / expected.mean(), self.rows.weight))

    def test_every_fold_holds_out_whole_meshes(self):
        self.assertEqual(list(range(5)), sorted(self.rows.fold_of_mesh))
        for faces, fold, mesh in zip(self.rows.faces, self.rows.fold_of_mesh, range(5)):
            of_mesh = numpy.repeat(numpy.arange(5), [len(faces) for faces in self.rows.faces]) == mesh
            self.assertEqual({fold}, set(self.rows.fold[of_mesh]))

    def test_loss_is_that_of_the_formula_without_labels_of_one_fold(self):
        sure = numpy.eye(3)[self.rows.label]
        self.assertAlmostEqual(0, self.rows.loss(sure))
        sure[self.rows.label == 2] = [1, 0, 0]
        self.assertAlmostEqual(0, self.rows.loss(sure))
        self.assertAlmostEqual(numpy.log(3), self.rows.loss(numpy.full((len(sure), 3), 1 / 3)))
        sure[self.rows.label == 0] = [0, 1, 0]
        of_first = self.rows.weight[self.rows.label == 0].sum() / self.rows.weight[self.rows.label < 2].sum()
        self.assertAlmostEqual(of_first * -numpy.log(tree_cascade.LEAST_PROBABILITY), self.rows.loss(sure))


class ContextTest(unittest.TestCase):
    def setUp(self):
        self.mesh = shapes.test[0]
        self.faces = len(surfaces.read_off(self.mesh)[1])
        probabilities = numpy.random.RandomState(1).uniform(size=(self.faces, 3))
        self.probabilities = (probabilities / probabilities.sum(axis=1, keepdims=True)).astype("f4")

    def by_label(self, probabilities):
        """Returns the histograms: faces x distances x ranges x labels."""
        return shapes.context(self.mesh, probabilities).reshape(self.faces, 7, 5, -1)

    def test_the_histograms_of_a_distance_hold_the_whole_surface(self):
        context = shapes.context(self.mesh, self.probabilities)
        self.assertEqual((self.faces, 3 * CONTEXT_COLUMNS), context.shape)
        self.assertTrue(numpy.allclose(1, self.by_label(self.probabilities).sum(axis=(2, 3)), atol=1e-4))
        self.assertGreaterEqual(context.min(), 0)

    def test_labels_change_places_as_in_the_probabilities(self):
        order = [2, 0, 1]
        moved = self.by_label(self.probabilities[:, order])
        self.assertTrue(numpy.array_equal(self.by_label(self.probabilities)[..., order], moved))

    def test_a_label_that_is_near_is_in_the_first_range(self):
        positions, faces = surfaces.read_off(self.mesh)
        centers = positions[faces].mean(axis=1)
        order = numpy.linalg.norm(centers - centers[0], axis=1).argsort()
        is_near = numpy.isin(numpy.arange(self.faces), order[:3])
        geodesic = self.by_label(numpy.stack([is_near, ~is_near], axis=1).astype("f4"))[:, 0, :, 0]
        self.assertEqual(0, geodesic[0].argmax())
        self.assertEqual(0, geodesic[order[-1], 0])

    def test_sizes_that_do_not_fit_are_refused(self):
        for probabilities in (self.probabilities[:-1], self.probabilities[:, :0]):
            given = self.folder_with(probabilities)
            called = subprocess.run([programs.program("compare_faces"), "context", shapes.cache, "3", given,
                                     given.with_name("out"), self.mesh], capture_output=True, text=True)
            self.assertEqual(1, called.returncode)
            self.assertRegex(called.stderr, "^error: .*\n$")

    def folder_with(self, probabilities):
        folder = tempfile.TemporaryDirectory(prefix="exemplar-compare-")
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name) / "in"
        programs.write_tensors(path, {self.mesh.stem: probabilities})
        return path


class LabelingTest(unittest.TestCase):
    """Four tables to learn from, two to label."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="exemplar-compare-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *options, out="peer", report=None, models=None):
        """Returns what the program prints."""
        with contextlib.redirect_stderr(io.StringIO()) as said:
            tree_cascade.main([str(report or shapes.report), "--models", str(models or shapes.models),
                               "--cache", str(shapes.cache), "--out", str(self.folder / out), *options])
        return said.getvalue()

    def label_file(self, mesh, out="peer"):
        return self.folder / out / "Table" / surfaces.labels_path(mesh).name

    def record(self, out="peer"):
        return json.loads((self.folder / out / "Table" / "training.json").read_text())

    def right(self, mesh, out="peer"):
        """Returns the share of the surface that is labeled as the truth."""
        areas = surfaces.face_areas(*surfaces.read_off(mesh))
        truth = surfaces.read_labels(surfaces.labels_path(mesh), len(areas))
        found = surfaces.read_labels(self.label_file(mesh, out), len(areas))
        return areas[truth == found].sum() / areas.sum()

    def failure(self, *options, **arguments):
        with self.assertRaises(SystemExit) as raised:
            self.call(*options, **arguments)
        message = str(raised.exception.code)
        self.assertRegex(message, "^error: ")
        self.assertNotIn("\n", message)
        return message

    def test_generated_shapes_are_learned(self):
        self.call()
        for out in ("peer", "peer_uncut"):
            for mesh in shapes.test:
                self.assertGreater(self.right(mesh, out), 0.9)
        self.assertEqual(3, len(self.record()["loss"]))
        self.assertLess(self.record()["loss"][1], self.record()["loss"][0])

    def test_equal_seeds_give_equal_files(self):
        for out, seed in (("one", 1), ("two", 1), ("three", 2)):
            self.call("--stages", "2", "--seed", str(seed), out=out)
        for mesh in shapes.test:
            self.assertEqual(self.label_file(mesh, "one").read_bytes(), self.label_file(mesh, "two").read_bytes())
        self.assertEqual(self.record("one")["loss"], self.record("two")["loss"])
        self.assertNotEqual(self.record("one")["loss"], self.record("three")["loss"])

    def test_what_is_there_is_not_learned_again(self):
        options = ("--stages", "1")
        self.assertIn("labeled now: 1 of 1", self.call(*options))
        file = self.label_file(shapes.test[0], "peer_uncut")
        content, before = file.read_bytes(), self.label_file(shapes.test[0]).stat().st_mtime_ns
        self.assertIn("labeled now: 0 of 1", self.call(*options))
        self.assertEqual(before, self.label_file(shapes.test[0]).stat().st_mtime_ns)
        file.unlink()
        self.assertIn("labeled now: 1 of 1", self.call(*options))
        self.assertEqual(content, file.read_bytes())
        self.assertIn("other options", self.failure("--stages", "2"))
        self.assertEqual(sorted([*(surfaces.labels_path(mesh).name for mesh in shapes.test), "training.json"]),
                         sorted(path.name for path in file.parent.iterdir()))

    def test_test_labels_are_not_looked_at(self):
        self.call("--stages", "1", out="with")
        hidden = [(surfaces.labels_path(mesh), surfaces.labels_path(mesh).with_suffix(".hidden")) for mesh in shapes.test]
        for path, place in hidden:
            path.rename(place)
            self.addCleanup(place.rename, path)
        self.call("--stages", "1", out="without")
        for mesh in shapes.test:
            self.assertEqual(self.label_file(mesh, "with").read_bytes(), self.label_file(mesh, "without").read_bytes())

    def test_a_stage_of_more_loss_is_dropped(self):
        self.call("--stages", "1", out="one")
        with unittest.mock.patch.object(tree_cascade, "MOST_LOSS_RATIO", 0):
            self.call(out="dropped")
        for mesh in shapes.test:
            self.assertEqual(self.label_file(mesh, "one").read_bytes(), self.label_file(mesh, "dropped").read_bytes())
        self.assertEqual(2, len(self.record("dropped")["loss"]))

    def test_a_broken_report_gives_one_line(self):
        report = self.folder / "report.json"
        for train, problem in ((shapes.train[:1], "held-out"), (shapes.train[:3], "other meshes"),
                               (shapes.test, "other meshes")):
            shapes.write_report(report, [mesh.stem for mesh in train])
            self.assertIn(problem, self.failure(report=report))
        self.assertIn("no category Cup", self.failure("--category", "Cup"))
        report.write_text("{}")
        self.assertIn("not a report", self.failure(report=report))

    def test_a_broken_model_gives_one_line(self):
        models = self.folder / "models"
        self.assertIn("No such file", self.failure(models=models))
        model = models / shapes.model.relative_to(shapes.models)
        model.parent.mkdir(parents=True)
        for content in (b"", shapes.model.read_bytes()[:200], b"\x08" + bytes(7) + b"[1, 2  ]"):
            model.write_bytes(content)
            self.assertIn("not a model", self.failure(models=models))

    def test_broken_meshes_give_one_line(self):
        labels = surfaces.labels_path(shapes.train[0])
        content = labels.read_text()
        self.addCleanup(labels.write_text, content)
        for broken, problem in (("wing\n" + content.split("\n", 1)[1], "label wing"), ("leg\n", "pairs of lines"),
                                ("", "no surface")):
            labels.write_text(broken)
            self.assertIn(problem, self.failure())

    def test_what_a_program_refuses_is_said_once(self):
        copy = self.folder / "shapes"
        shutil.copytree(shapes.folder / "shapes", copy)
        report = self.folder / "report.json"
        report.write_text(shapes.report.read_text().replace(str(shapes.folder / "shapes"), str(copy)))
        (copy / shapes.test[1].name).write_text("OFF\n")
        called = subprocess.run([sys.executable, "-B", tree_cascade.__file__, report, "--models", shapes.models, "--cache",
                                 shapes.cache, "--out", self.folder / "peer"], capture_output=True, text=True)
        self.assertEqual(1, called.returncode)
        self.assertEqual(1, called.stderr.count("error: "))
        self.assertNotIn("Traceback", called.stderr)


if __name__ == "__main__":
    programs.require_compare()
    import tree_cascade  # before numpy: it sets the number of threads
    import numpy
    import surfaces
    unittest.main()

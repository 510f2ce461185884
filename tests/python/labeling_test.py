"""Labeling: models and labels are those of the program."""

import unittest

import numpy as np

import exemplar
from shapes import CUBE, CUBE_FACES, QUICK, PackageTest


class LabelingTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cups = [exemplar.make_shape("cup", seed, faces=500) for seed in (1, 2, 3)]
        cls.unseen = exemplar.make_shape("cup", 4, faces=500)
        cls.model = exemplar.train_labeling(cls.cups, **QUICK)

    def test_the_model_is_that_of_the_program(self):
        options = [word for name, value in QUICK.items() for word in ("--" + name.replace("_", "-"), value)]
        self.program("synth", "cup", "--count", 3, "--faces", 500, "--out", "cups")
        self.program("label", "train", "cups", "--out", "program.safetensors", *options)
        exemplar.train_labeling(exemplar.read_labeled(self.folder / "cups"), **QUICK).save(self.folder / "mine.safetensors")
        mine, program = ((self.folder / name).read_bytes() for name in ("mine.safetensors", "program.safetensors"))
        self.assertEqual(mine, program)

        self.unseen.write(self.folder / "unseen.off")
        self.program("label", "apply", "program.safetensors", "unseen.off", "--out", "labeled")
        theirs = exemplar.read_mesh(self.folder / "labeled/unseen.ply")
        labeling = exemplar.LabelingModel.load(self.folder / "mine.safetensors").label(
            exemplar.read_mesh(self.folder / "unseen.off"))
        np.testing.assert_array_equal(labeling.labels, theirs.labels)
        # The program's is a mean over the triangles of each polygon, though there is but one.
        np.testing.assert_allclose(labeling.confidence, theirs.confidence, rtol=1e-6)

    def test_labels_most_of_an_unseen_shape(self):
        labeling = self.model.label(self.unseen)
        names = np.array(labeling.label_names)
        self.assertEqual(labeling.label_names, ["body", "handle"])
        right = names[labeling.labels] == np.array(self.unseen.label_names)[self.unseen.labels]
        self.assertGreater(np.average(right, weights=self.unseen.face_areas()), 0.85)

    def test_probabilities(self):
        labeling = self.model.label(self.unseen)
        faces = self.unseen.face_count
        self.assertEqual((labeling.labels.shape, labeling.labels.dtype), ((faces,), np.int32))
        self.assertEqual((labeling.probabilities.shape, labeling.probabilities.dtype), ((faces, 2), np.float32))
        np.testing.assert_allclose(labeling.probabilities.sum(axis=1), 1, atol=1e-5)
        np.testing.assert_allclose(labeling.confidence, labeling.probabilities[np.arange(faces), labeling.labels])
        self.assertIn("features", labeling.seconds)
        with self.assertRaises(ValueError):
            labeling.labels[0] = 1

    def test_the_result_goes_back_to_the_mesh(self):
        labeling = self.model.label(self.unseen)
        labeled = self.unseen.with_labels(labeling.labels, labeling.label_names, labeling.confidence)
        labeled.write(self.folder / "labeled.ply")
        np.testing.assert_array_equal(exemplar.read_mesh(self.folder / "labeled.ply").labels, labeling.labels)

    def test_seeds(self):
        for name, seed in (("a", 1), ("b", 1), ("c", 2)):
            exemplar.train_labeling(self.cups, seed=seed, **QUICK).save(self.folder / name)
        a, b, c = ((self.folder / name).read_bytes() for name in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)

    def test_labels_of_equal_names_are_one(self):
        second = self.cups[1].with_labels(1 - self.cups[1].labels, self.cups[1].label_names[::-1])
        model = exemplar.train_labeling([self.cups[0], second, self.cups[2]], **QUICK)
        np.testing.assert_array_equal(model.label(self.unseen).labels, self.model.label(self.unseen).labels)

    def test_the_model_tells_of_itself(self):
        self.assertEqual(self.model.label_names, ["body", "handle"])
        self.assertEqual((len(self.model.provenance), self.model.seed, len(self.model.feature_names)), (3, 1, 678))

    def test_refusals(self):
        plain = exemplar.Mesh(CUBE, CUBE_FACES, name="plain")
        self.raises(exemplar.UsageError, ["number 1", "'plain'", "no labels"], exemplar.train_labeling,
                    [self.cups[0], plain])
        self.raises(exemplar.DataError, "", exemplar.train_labeling, [])
        self.raises(exemplar.DataError, "", exemplar.train_labeling, [plain.with_labels([-1] * 12, ["none"])])
        self.raises(exemplar.UsageError, "rounds: 0", exemplar.train_labeling, self.cups, rounds=0)
        self.raises(exemplar.UsageError, "feature_fraction: 2", exemplar.train_labeling, self.cups, feature_fraction=2)
        self.raises(exemplar.MeshError, "no faces", self.model.label, exemplar.Mesh([], []))
        self.raises(exemplar.NoDeviceError, "abacus", self.model.label, self.unseen, device="abacus")
        broken = self.folder / "broken.safetensors"
        broken.write_bytes(b"no model at all")
        self.raises(exemplar.ModelError, "broken.safetensors", exemplar.LabelingModel.load, broken)
        with self.assertRaises(TypeError):
            exemplar.train_labeling([CUBE])


if __name__ == "__main__":
    unittest.main()

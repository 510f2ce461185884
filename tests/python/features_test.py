"""Features as arrays: those of the program, without copies."""

import unittest

import numpy as np

import exemplar
from shapes import CUBE, CUBE_FACES, PackageTest


class FeaturesTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mesh = exemplar.make_shape("cup", faces=600)
        cls.features = exemplar.features(cls.mesh, samples=60)

    def test_are_those_of_the_program(self):
        self.mesh.write(self.folder / "cup.off")
        self.program("features", "cup.off", "--samples", 60, "--out", "faces.npy")
        self.program("features", "cup.off", "--samples", 60, "--out", "edges.npy", "--pairwise")
        read = exemplar.features(exemplar.read_mesh(self.folder / "cup.off"), samples=60)
        np.testing.assert_array_equal(read.values, np.load(self.folder / "faces.npy"))
        np.testing.assert_array_equal(read.pairwise, np.load(self.folder / "edges.npy"))

    def test_shapes_and_names(self):
        values, pairwise = self.features.values, self.features.pairwise
        self.assertEqual(values.shape, (self.mesh.face_count, len(self.features.names)))
        self.assertEqual((values.dtype, len(self.features.names)), (np.float32, 678))
        self.assertTrue(np.isfinite(values).all())
        self.assertIn("curvature.k1@0.05", self.features.names)
        edges = self.features.edges
        self.assertEqual(len(edges), 3 * self.mesh.face_count // 2)  # closed
        self.assertEqual(pairwise.shape, (len(edges), len(self.features.pairwise_names)))
        self.assertEqual(self.features.edge_length.shape, (len(edges),))
        self.assertAlmostEqual(float(np.median(self.features.edge_length)), 1, places=3)
        self.assertTrue(((self.features.dihedral >= 0) & (self.features.dihedral <= 1)).all())
        np.testing.assert_array_equal(self.features.face_of, np.arange(self.mesh.face_count))
        self.assertGreater(self.features.seconds["diameter"], 0)

    def test_are_views(self):
        self.assertTrue(np.shares_memory(self.features.values, self.features.values))
        self.assertTrue(self.features.values[:, 3].flags.c_contiguous)
        values = exemplar.features(self.mesh, samples=60).values  # what it is a view of has no other owner
        np.testing.assert_array_equal(values, self.features.values)
        with self.assertRaises(ValueError):
            values[0, 0] = 1

    def test_orientation_adds_coordinates(self):
        features = exemplar.features(self.mesh, samples=60, orientation=True)
        self.assertEqual(features.values.shape[1], 681)

    def test_cache_remembers(self):
        folder = self.folder / "remembered"
        first = exemplar.features(self.mesh, samples=60, cache=folder)
        self.assertEqual(len(list(folder.iterdir())), 1)
        again = exemplar.features(self.mesh, samples=60, cache=str(folder))
        np.testing.assert_array_equal(first.values, again.values)
        self.assertEqual(first.seconds, again.seconds)  # of the first time

    def test_nothing_is_remembered_unasked(self):
        before = sorted(self.folder.rglob("*"))
        exemplar.features(exemplar.Mesh(CUBE, CUBE_FACES))
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_refusals(self):
        self.raises(exemplar.UsageError, "samples: 0", exemplar.features, self.mesh, samples=0)
        self.raises(exemplar.MeshError, ["hole:", "no faces"], exemplar.features, exemplar.Mesh([], [], name="hole"))
        broken = CUBE.copy()
        broken[2, 1] = np.inf
        self.raises(exemplar.MeshError, "not finite", exemplar.features, exemplar.Mesh(broken, CUBE_FACES))
        with self.assertRaises(TypeError):
            exemplar.features(CUBE)


if __name__ == "__main__":
    unittest.main()

"""Meshes that are too large to be worked on face by face."""

import unittest

import numpy as np

import exemplar
from shapes import PackageTest


class LargeTest(PackageTest):
    def test_a_large_mesh_is_simplified(self):
        mesh = exemplar.make_shape("cup", faces=45000)
        features = exemplar.features(mesh, samples=20)
        self.assertEqual(features.values.shape, (mesh.face_count, 678))
        rows = features.face_of == features.face_of[0]
        np.testing.assert_array_equal(features.values[rows], np.repeat(features.values[:1], rows.sum(), axis=0))
        self.raises(exemplar.UsageError, "simplify it first", lambda: features.pairwise)


if __name__ == "__main__":
    unittest.main()

"""Curvature, measured and learned, and animations."""

import unittest

import numpy as np

import exemplar
from shapes import CUBE, CUBE_FACES, PackageTest, sphere


class MeasuredTest(PackageTest):
    def test_of_a_sphere(self):
        vertices, faces = sphere(40, radius=2.0)
        curvature = exemplar.curvature(exemplar.Mesh(vertices, faces))
        middle = np.abs(vertices[:, 2]) < 1.5  # triangles are slender at the poles
        for k in (curvature.k1, curvature.k2):
            self.assertEqual((k.shape, k.dtype), ((len(vertices),), np.float32))
            np.testing.assert_allclose(k[middle], 0.5, atol=0.01)
        self.assertTrue((curvature.k1 >= curvature.k2).all())
        normals = np.cross(curvature.e1, curvature.e2)
        np.testing.assert_allclose(normals[middle], vertices[middle] / 2, atol=0.02)
        self.assertEqual(curvature.derivative.shape, (len(vertices), 4))
        self.assertLess(np.abs(curvature.derivative[middle]).max(), 0.1)

    def test_options(self):
        mesh = exemplar.make_shape("cup", faces=2000)
        plain, smooth = exemplar.curvature(mesh), exemplar.curvature(mesh, smoothing=3)
        self.assertLess(smooth.k1.std(), 0.9 * plain.k1.std())
        self.assertIsNone(exemplar.curvature(mesh, derivatives=False).derivative)
        self.assertEqual(exemplar.curvature(mesh, robust="cauchy").k1.shape, plain.k1.shape)
        self.raises(exemplar.UsageError, ["'couchy'", "'cauchy'"], exemplar.curvature, mesh, robust="couchy")
        self.raises(exemplar.UsageError, "smoothing: -1", exemplar.curvature, mesh, smoothing=-1)
        self.raises(exemplar.UsageError, "smoothing: nan", exemplar.curvature, mesh, smoothing=float("nan"))
        self.raises(exemplar.MeshError, "no faces", exemplar.curvature, exemplar.Mesh([], []))

    def test_of_a_point(self):
        curvature = exemplar.curvature(exemplar.Mesh(0 * CUBE, CUBE_FACES), smoothing=1)
        self.assertTrue(np.isfinite(curvature.k1).all())


class AnimationTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.figure = exemplar.make_animation("figure", vertices=600, frames=5)

    def test_frames(self):
        self.assertEqual((self.figure.kind, self.figure.frame_count), ("skeleton", 5))
        self.assertEqual(self.figure.clips, [("motion_1", 5)])
        first, last = self.figure.vertices(0), self.figure.vertices(4)
        self.assertEqual(first.shape, (self.figure.vertex_count, 3))
        self.assertGreater(np.abs(first - last).max(), 0.01)
        mesh = self.figure.mesh(4)
        np.testing.assert_array_equal(mesh.vertices, last)
        np.testing.assert_array_equal(mesh.faces, self.figure.faces)
        for frame in (5, -1):
            self.raises(exemplar.UsageError, [f"frame: {frame}", "0 to 4"], self.figure.vertices, frame)

    def test_files_come_back(self):
        self.figure.write(self.folder / "figure.glb")
        again = exemplar.read_animation(self.folder / "figure.glb")
        self.assertEqual((again.kind, again.frame_count), ("skeleton", 5))
        np.testing.assert_allclose(again.vertices(3), self.figure.vertices(3), atol=1e-4)
        self.figure.write(self.folder / "figure")
        self.assertEqual(exemplar.read_animation(self.folder / "figure").kind, "mesh sequence")
        self.raises(exemplar.MeshError, "nothing.glb", exemplar.read_animation, self.folder / "nothing.glb")
        self.raises(exemplar.UsageError, "frames_per_second", exemplar.read_animation, self.folder / "figure.glb",
                    frames_per_second=0)

    def test_from_arrays(self):
        frames = np.stack([CUBE, CUBE * [1, 1, 2]])
        made = exemplar.Animation(frames, CUBE_FACES, name="growing")
        self.assertEqual((made.kind, made.name, made.frame_count), ("mesh sequence", "growing", 2))
        np.testing.assert_array_equal(made.vertices(1), frames[1])
        self.raises(exemplar.UsageError, "frames", exemplar.Animation, CUBE, CUBE_FACES)
        self.raises(exemplar.UsageError, "frames", exemplar.Animation, [], CUBE_FACES)
        self.raises(exemplar.UsageError, "faces: row", exemplar.Animation, frames, CUBE_FACES + 1)
        self.raises(TypeError, "frames", exemplar.Animation, "frames", CUBE_FACES)
        self.raises(exemplar.MeshError, "finite", exemplar.Animation, frames * np.nan, CUBE_FACES)


class LearnedTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Figures of seeds 1 and 2 are one surface in two motions.
        cls.seen = exemplar.make_animation("figure", seed=1, vertices=800, frames=60)
        cls.unseen = exemplar.make_animation("figure", seed=2, vertices=800, frames=8)
        cls.model = exemplar.train_curvature(cls.seen)

    def test_predicts_poses_that_it_never_saw(self):
        measured = [self.model.measure(self.unseen, frame) for frame in range(8)]
        learned = [self.model.predict(self.unseen, frame) for frame in range(8)]
        mean = np.mean([self.model.measure(self.seen, frame).k1 for frame in range(0, 60, 6)], axis=0)
        error = np.mean([np.abs(a.k1 - b.k1).mean() for a, b in zip(measured, learned)])
        zero_order = np.mean([np.abs(a.k1 - mean).mean() for a in measured])
        self.assertLess(error, 0.6 * zero_order)
        self.assertEqual(learned[0].derivative.shape, (self.unseen.vertex_count, 4))

    def test_files_come_back(self):
        path = self.folder / "figure.safetensors"
        self.model.save(path)
        again = exemplar.CurvatureModel.load(path)
        np.testing.assert_array_equal(again.predict(self.unseen, 3).k2, self.model.predict(self.unseen, 3).k2)
        self.assertEqual(again.training["poses"], "60")
        self.assertEqual(again.vertex_count, self.seen.vertex_count)
        self.raises(exemplar.ModelError, "figure.safetensors", exemplar.LabelingModel.load, path)
        self.raises(exemplar.ModelError, "none.safetensors", exemplar.CurvatureModel.load, self.folder / "none.safetensors")

    def test_refusals(self):
        self.raises(exemplar.UsageError, "20", exemplar.train_curvature, self.seen, frames=range(5))
        self.raises(exemplar.UsageError, "frame: 60", exemplar.train_curvature, self.seen, frames=[60] * 30)
        self.raises(exemplar.UsageError, "'locale'", exemplar.train_curvature, self.seen, learner="locale")
        self.raises(exemplar.UsageError, "variance", exemplar.train_curvature, self.seen, variance=2)
        other = exemplar.make_animation("figure", shape_seed=2, vertices=900, frames=2)
        self.raises(exemplar.ModelError, "", self.model.predict, other, 0)
        self.raises(exemplar.UsageError, "frame: 8", self.model.predict, self.unseen, 8)


if __name__ == "__main__":
    unittest.main()

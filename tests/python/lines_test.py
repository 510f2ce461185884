"""Line drawings: those of the program, and arrays of points."""

import unittest
import xml.etree.ElementTree

import numpy as np

import exemplar
from shapes import CUBE, CUBE_FACES, PackageTest, sphere


class LinesTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mesh = exemplar.make_shape("cup", faces=2000)
        cls.mesh.write(cls.folder / "cup.off")
        cls.cup = exemplar.read_mesh(cls.folder / "cup.off")

    def test_svg_is_that_of_the_program(self):
        self.program("lines", "cup.off", "--out", "program.svg")
        drawing = exemplar.draw_lines(self.cup)
        self.assertEqual(drawing.svg(), (self.folder / "program.svg").read_text())
        self.assertEqual(drawing._repr_svg_(), drawing.svg())

    def test_options_are_those_of_the_program(self):
        self.program("lines", "cup.off", "--out", "options.svg", "--types", "creases,ridges,contours", "--style",
                     "technical", "--eye", "2,3,1", "--target", "0,0.1,0", "--up", "0,0,1", "--fov", 40, "--size",
                     "300x200", "--threshold", "ridges=0.05,creases=20", "--smoothing", 2, "--form", "outlines",
                     "--no-background", "--tolerance", 0.3)
        drawing = exemplar.draw_lines(self.cup, types=["creases", "ridges", "contours"], style="technical",
                                      eye=(2, 3, 1), target=[0, 0.1, 0], up=np.array([0, 0, 1]), field_of_view=40,
                                      size=(300, 200), thresholds={"ridges": 0.05, "creases": 20}, smoothing=2)
        drawing.write(self.folder / "mine.svg", outlines=True, background=False, tolerance=0.3)
        mine, program = ((self.folder / name).read_text() for name in ("mine.svg", "options.svg"))
        self.assertEqual(mine, program)

    def test_polylines(self):
        vertices, faces = sphere(40)
        drawing = exemplar.draw_lines(exemplar.Mesh(vertices, faces), types=["contours"], field_of_view=0,
                                      size=(400, 300), view="front")
        self.assertEqual((drawing.types, drawing.size), (["contours"], (400, 300)))
        points = np.concatenate(drawing.polylines("contours"))
        self.assertEqual((points.shape[1], points.dtype), (4, np.float32))
        radius = np.hypot(points[:, 0] - 200, points[:, 1] - 150)
        np.testing.assert_allclose(radius, radius.mean(), rtol=0.01)  # a circle around the middle
        self.assertLess(abs(radius.mean() - 0.95 * 150), 2)
        self.assertTrue((points[:, 2] > 0).all() and (points[:, 3] == 1).all())
        self.assertEqual(len(drawing.polylines()), len(drawing.polylines("contours")))
        self.assertEqual(drawing.polylines("creases"), [])

    def test_the_camera_is_where_points_are(self):
        drawing = exemplar.draw_lines(exemplar.Mesh(CUBE, CUBE_FACES), types=["creases"], size=(400, 300))
        self.assertEqual(drawing.view_projection.shape, (4, 4))
        projected = np.c_[CUBE, np.ones(8)] @ drawing.view_projection.T
        pixels = (projected[:, :2] / projected[:, 3:] + 1) / 2 * [400, 300]
        ends = np.concatenate([line[[0, -1], :2] for line in drawing.polylines()])
        nearest = np.linalg.norm(ends[:, None] - pixels, axis=2).min(axis=1)
        self.assertLess(nearest.max(), 0.5)  # edges of a cube end at its corners

    def test_given_curvature(self):
        curvature = exemplar.curvature(self.cup, smoothing=1)
        own = exemplar.draw_lines(self.cup, types=["ridges"])
        given = exemplar.draw_lines(self.cup, types=["ridges"], curvature=curvature)
        self.assertGreater(sum(map(len, own.polylines())), 100)
        for a, b in zip(own.polylines(), given.polylines()):
            np.testing.assert_allclose(a, b, atol=0.01)
        self.assertEqual(exemplar.draw_lines(self.cup, feature_size=0.5).feature_size, 0.5)
        flat = exemplar.curvature(self.cup, derivatives=False)
        self.raises(exemplar.UsageError, "derivatives", exemplar.draw_lines, self.cup, types=["ridges"], curvature=flat)
        other = exemplar.curvature(exemplar.Mesh(CUBE, CUBE_FACES))
        self.raises(exemplar.UsageError, "8 vertices", exemplar.draw_lines, self.cup, curvature=other)

    def test_svg_forms(self):
        drawing = exemplar.draw_lines(self.cup)
        texts = {drawing.svg(**options) for options in ({}, {"outlines": True}, {"curves": True}, {"background": False},
                                                        {"tolerance": 2})}
        self.assertEqual(len(texts), 5)
        for text in texts:
            xml.etree.ElementTree.fromstring(text)

    def test_refusals(self):
        def refused(says, error=exemplar.UsageError, mesh=self.cup, **options):
            self.raises(error, says, exemplar.draw_lines, mesh, **options)

        refused(["'frnt'", "'front'"], view="frnt")
        refused(["'rigdes'", "'ridges'"], types=["rigdes"])
        refused("eye", eye=(1, 2))
        refused("eye", eye=(1, 2, np.nan))
        refused("target", target=(0, 0, 0))
        refused("same point", eye=(1, 2, 3), target=(1, 2, 3))
        refused("up: is zero", up=(0, 0, 0))
        refused("field_of_view: 171", field_of_view=171)
        refused("size: 0", size=(0, 10))
        refused("size", size=(10, 10**12))
        refused("smoothing", smoothing=-1)
        refused("valleys", thresholds={"valleys": -1})
        refused("contours", thresholds={"contours": 1})
        refused("feature_size", feature_size=0)
        refused("inkk", error=exemplar.DataError, style="inkk")
        refused("no faces", error=exemplar.MeshError, mesh=exemplar.Mesh([], []))
        refused("every face has two corners", error=exemplar.MeshError, mesh=exemplar.Mesh(0 * CUBE, CUBE_FACES))
        self.raises(exemplar.UsageError, "'hills'", exemplar.draw_lines(self.cup).polylines, "hills")
        self.raises(exemplar.DataError, "/proc", exemplar.draw_lines(self.cup).write, "/proc/none/a.svg")


if __name__ == "__main__":
    unittest.main()

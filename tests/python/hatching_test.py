"""Hatching: styles and drawings are those of the program."""

import unittest

import numpy as np

import exemplar
from shapes import PackageTest

SIZE = 200


class HatchingTest(PackageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        exemplar.make_shape("cup", faces=1000).write(cls.folder / "cup.off")
        cls.cup = exemplar.read_mesh(cls.folder / "cup.off")
        cls.scene = exemplar.HatchingScene(cls.cup, size=(SIZE, SIZE))
        cls.drawing = cls.scene.example("contour")
        cls.style = cls.scene.train(cls.drawing)

    def test_all_is_as_the_program_has_it(self):
        view = ["--size", f"{SIZE}x{SIZE}"]
        self.program("hatch", "example", "contour", "cup.off", "--out", "drawing.png", *view)
        self.program("hatch", "train", "cup.off", "drawing.png", "--out", "program.safetensors", *view)
        self.program("hatch", "draw", "program.safetensors", "cup.off", "--out", "program.svg", *view)
        style = self.scene.train(self.folder / "drawing.png")
        style.save(self.folder / "mine.safetensors")
        mine, program = ((self.folder / name).read_bytes() for name in ("mine.safetensors", "program.safetensors"))
        self.assertEqual(mine, program)
        self.assertEqual(self.scene.draw(style).svg(), (self.folder / "program.svg").read_text())

    def test_pictures(self):
        for picture in (self.drawing, self.scene.template()):
            self.assertEqual((picture.shape, picture.dtype), ((SIZE, SIZE), np.uint8))
            self.assertGreater(np.ptp(picture), 100)
        self.assertEqual(self.scene.size, (SIZE, SIZE))
        self.assertIn("contour", exemplar.hatching_rules())

    def test_a_drawing_in_a_style(self):
        drawn = self.scene.draw(self.style)
        self.assertGreater(len(drawn.strokes), 20)
        points = np.concatenate(drawn.strokes)
        self.assertEqual((points.shape[1], points.dtype), (3, np.float32))
        self.assertTrue(((points[:, :2] > -2) & (points[:, :2] < SIZE + 2)).all())
        self.assertTrue((points[:, 2] >= 0).all())
        self.assertEqual(drawn.layers.shape, (len(drawn.strokes),))
        self.assertTrue(((drawn.darkness > 0) & (drawn.darkness <= 1)).all())
        self.assertEqual(drawn.image().shape[:2], (SIZE, SIZE))
        self.assertEqual(drawn.image(scale=0.5).shape[:2], (SIZE // 2, SIZE // 2))
        self.assertNotEqual(drawn.svg(), drawn.svg(outlines=True))
        drawn.write(self.folder / "drawn.png")
        drawn.write(self.folder / "drawn.svg")
        self.assertEqual((self.folder / "drawn.svg").read_text(), drawn.svg())
        self.assertEqual((self.folder / "drawn.png").read_bytes()[:4], b"\x89PNG")

    def test_styles_come_back(self):
        self.style.save(self.folder / "style.safetensors")
        again = exemplar.HatchingStyle.load(self.folder / "style.safetensors")
        self.assertEqual(again.describe(), self.style.describe())
        self.assertEqual(self.scene.draw(again).svg(), self.scene.draw(self.style).svg())
        self.raises(exemplar.ModelError, "style.safetensors", exemplar.LabelingModel.load,
                    self.folder / "style.safetensors")

    def test_refusals(self):
        train, draw = self.scene.train, self.scene.draw
        self.raises(exemplar.UsageError, "contuor", self.scene.example, "contuor")
        self.raises(TypeError, "drawing", train, self.drawing.astype(float))
        self.raises(TypeError, "drawing", train, None)
        self.raises(exemplar.UsageError, "drawing", train, self.drawing[0])
        self.raises(exemplar.UsageError, "2 channels", train, np.stack([self.drawing] * 2, axis=2))
        self.raises(exemplar.DataError, "", train, np.full((SIZE, SIZE), 255, np.uint8))
        self.raises(exemplar.DataError, "none.png", train, self.folder / "none.png")
        self.raises(exemplar.UsageError, "'hills'", draw, self.style, curves=["hills"])
        self.raises(exemplar.UsageError, "taper", draw, self.style, taper=-1)
        self.raises(exemplar.UsageError, "light: is zero", exemplar.HatchingScene, self.cup, light=(0, 0, 0))
        self.raises(exemplar.MeshError, "no faces", exemplar.HatchingScene, exemplar.Mesh([], []))
        self.raises(exemplar.NoDeviceError, "abacus", exemplar.HatchingScene, self.cup, device="abacus")
        self.raises(exemplar.UsageError, "a.jpg", self.scene.draw(self.style).write, "a.jpg")


if __name__ == "__main__":
    unittest.main()

"""Hatching on paper, as a newcomer does it: a sheet to print, a drawing on it by a program that knows nothing of Exemplar, a
photograph of the sheet, the style learned from that, and another mesh drawn in it."""

import importlib.util
import json
import pathlib
import subprocess
import sys
import unittest

from program import DOCS, ProgramTest

HERE = pathlib.Path(__file__).parent
MESH = "shapes/fourleg_001.off"
VIEW = ["--size", "400x340"]


class HatchOnPaper(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "fourleg", "--faces", "2500", "--count", "2", "--out", "shapes")

    def script(self, path, *arguments):
        subprocess.run([sys.executable, "-B", str(path), *map(str, arguments)], cwd=self.folder, check=True)

    def test_from_the_printer_to_another_mesh(self):
        self.call("hatch", "template", MESH, *VIEW, "--sheet", "a4", "--out", "sheet.png")
        self.script(DOCS / "examples" / "hatch_template.py", "sheet.png", "drawn.png")
        self.script(HERE / "photographed_sheet.py", "drawn.png", "photo.jpg", 100)
        self.call("hatch", "extract", MESH, "photo.jpg", "--template", "sheet.png", "--out", "read", "--json", "read.json")
        measured = json.loads((self.folder / "read.json").read_text())
        self.assertGreater(measured["crossings"], 50)
        self.call("hatch", "train", MESH, "photo.jpg", "--template", "sheet.png", "--out", "style.safetensors")
        self.call("hatch", "draw", "style.safetensors", MESH, "--template", "sheet.png", "--out", "again.png")
        # The same drawing read without paper is the truth; the photograph must say the same.
        self.call("hatch", "template", MESH, *VIEW, "--out", "view.png")
        said = self.call("hatch", "compare", MESH, "photo.jpg", "again.png", "--template", "sheet.png", "--json", "compare.json")
        again, = json.loads((self.folder / "compare.json").read_text())
        self.assertLess(again["direction_median"], 10, said.stdout)
        self.assertGreater(again["region_overlap"], 0.6, said.stdout)
        self.call("hatch", "draw", "style.safetensors", "shapes/fourleg_002.off", *VIEW, "--out", "other.svg")
        self.assertIn("hatching", (self.folder / "other.svg").read_text())
        # A picture without the marks.
        self.refused("hatch", "extract", MESH, "again.png", "--template", "sheet.png", "--out", "no", code=1,
                     says="again.png: the four rings in the corners of the sheet are not all seen")
        self.assert_no_leftovers()

    def test_a_drawing_on_screen(self):
        self.call("hatch", "template", MESH, *VIEW, "--out", "view.png")
        self.script(DOCS / "examples" / "hatch_template.py", "view.png", "traced.png")
        self.call("hatch", "extract", MESH, "traced.png", "--template", "view.png", "--out", "traced", "--json", "traced.json")
        self.assertGreater(json.loads((self.folder / "traced.json").read_text())["median_spacing"], 3)


if __name__ == "__main__":
    if not importlib.util.find_spec("PIL") or not importlib.util.find_spec("numpy"):
        print("skipped: Python has no Pillow or no numpy (Debian: python3-pil, python3-numpy)")
        sys.exit(77)
    unittest.main()

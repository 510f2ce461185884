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

    def test_a_page_of_a_scanned_file(self):
        self.call("hatch", "template", MESH, *VIEW, "--out", "over.png")
        self.script(DOCS / "examples" / "hatch_template.py", "over.png", "lines.png")
        convert = ("from PIL import Image; p = Image.open('lines.png').convert('L'); b = p.point(lambda v: 255 * (v > 128)).convert('1');"
                   "Image.new('1', p.size, 1).save('scan.tif', compression='group4', save_all=True, append_images=[b, b]); b.save('lines_1.png');"
                   "m = Image.new('L', p.size, 255); m.paste(0, (0, 0, p.size[0] // 2, p.size[1])); m.save('mask.tif', compression='tiff_lzw')")
        subprocess.run([sys.executable, "-c", convert], cwd=self.folder, check=True)
        extract = ["hatch", "extract", MESH, "scan.tif", "--template", "over.png", "--out"]
        self.refused(*extract, "no", code=1, says="scan.tif: has 3 pages; say which with --page 1 to 3")
        self.refused(*extract, "no", "--page", "4", code=1, says="scan.tif: has 3 pages, so there is no page 4")
        self.call(*extract, "page", "--page", "2", "--json", "page.json")
        self.call("hatch", "extract", MESH, "lines_1.png", "--template", "over.png", "--out", "png", "--json", "png.json")
        read = {name: json.loads((self.folder / f"{name}.json").read_text()) | {"drawing": ""} for name in ("page", "png")}
        self.assertEqual(read["page"], read["png"])
        said = self.call("hatch", "compare", MESH, "scan.tif", "scan.tif", "--page", "2", "--page", "3", "--template", "over.png")
        self.assertIn("region     1.00", said.stdout)
        self.refused("hatch", "train", MESH, "scan.tif", "--page", "2", "--page", "3", "--template", "over.png", "--out", "no.safetensors",
                     code=2, says="--page is given 2 times, for 1 drawing")
        # The mask hides the left half.
        self.call(*extract, "masked", "--page", "2", "--mask", "mask.tif", "--json", "masked.json")
        masked = json.loads((self.folder / "masked.json").read_text())
        self.assertLess(masked["crossings"], read["page"]["crossings"])
        self.assertNotEqual((self.folder / "masked" / "skeleton.png").read_bytes(), (self.folder / "page" / "skeleton.png").read_bytes())


if __name__ == "__main__":
    if not importlib.util.find_spec("PIL") or not importlib.util.find_spec("numpy"):
        print("skipped: Python has no Pillow or no numpy (Debian: python3-pil, python3-numpy)")
        sys.exit(77)
    unittest.main()

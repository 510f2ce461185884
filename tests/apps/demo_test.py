"""exemplar demo: that its page has all it promises, of one kind of shapes."""

import base64
import json
import re
import unittest
import xml.etree.ElementTree as ElementTree

from program import ProgramTest

SVG = "{http://www.w3.org/2000/svg}"


class Demo(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.result = cls.call("demo", "--kinds", "cup", "--train", "2", "--test", "1", "--faces", "500", "--out", "demo",
                              "--json", "demo.json")
        cls.report = json.loads((cls.folder / "demo.json").read_text())
        cls.page = (cls.folder / "demo" / "index.html").read_text()

    def test_the_labeled_shapes(self):
        self.assertEqual([category["category"] for category in self.report["categories"]], ["cup"])
        self.assertIn("cup:", self.result.stdout)
        self.assertIn('id="mesh-0-0"', self.page)
        self.assert_no_leftovers()

    def test_the_lines_of_a_figure(self):
        lines = self.report["lines"]
        self.assertGreater(lines["faces_with_line"], 0)
        self.assertLess(lines["misclassified"], lines["zero_order_misclassified"] / 2)
        share = f"{100 * lines['misclassified']:.2f} %"
        self.assertIn(share, self.result.stdout)
        section = re.search(r'<section class="wide drawing">.*?</section>', self.page, re.S)[0]
        self.assertIn(share, section)
        svg = base64.b64decode(re.search(r'src="data:image/svg\+xml;base64,([^"]*)"', section)[1])
        self.assertEqual(svg, (self.folder / "demo" / "lines" / "figure.svg").read_bytes())
        root = ElementTree.fromstring(svg)
        self.assertEqual(len(list(root.iter(SVG + "animate"))), lines["frames"])
        frames = [group for group in root if group.find(SVG + "animate") is not None]
        width = float(root.get("viewBox").split()[2])
        for frame in frames:  # lines in both halves
            starts = [float(path.get("d")[1:].split()[0]) for path in frame.iter(SVG + "path")]
            self.assertLess(min(starts), 0.4 * width)
            self.assertGreater(max(starts), 0.6 * width)

    def test_what_it_leaves_can_be_used(self):
        self.call("lines", "demo/lines/figure.glb", "--model", "demo/lines/figure.safetensors", "--frames", "80",
                  "--out", "frame.svg")


if __name__ == "__main__":
    unittest.main()

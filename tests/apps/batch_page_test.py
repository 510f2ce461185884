"""The page that 'label batch' writes about a run."""

import json
import re
import shutil
import unittest

from program import WithModel

HOSTILE = ["<script>alert(1)</script>.off", "<img src=x onerror=alert(1)>.off", "--><!--.off"]
COPIES = 12


def report_of(page):
    """What the page's script reads."""
    return json.loads(re.search(r'<script type="application/json" id="report">(.*?)</script>', page.read_text(),
                                re.DOTALL).group(1))


def rows(group, title):
    return next(table["rows"] for table in group["tables"] if table["title"] == title)


class BatchPage(WithModel):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        shapes = cls.folder / "shapes"
        for number in range(COPIES):
            name = HOSTILE[number] if number < len(HOSTILE) else f"cup {number}.off"
            (shapes / name).parent.mkdir(parents=True, exist_ok=True)
            # Each another shape, so that each is labeled.
            lines = cls.cup.read_text().splitlines()
            lines[2] = " ".join(str(float(x) + 0.001 * number) for x in lines[2].split())
            (shapes / name).write_text("\n".join(lines) + "\n")
        (shapes / "broken<b>.off").write_text("OFF\n3 1 0\n0 0 0\n")
        cls.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "out")
        cls.page = cls.folder / "out" / "index.html"
        cls.group = report_of(cls.page)["groups"][0]

    def test_all_shapes_are_counted(self):
        figures = dict(self.group["summary"])
        self.assertEqual(figures["labeled"], str(COPIES))
        self.assertEqual((figures["failed"], figures["unusable"], figures["to do"]), ("0", "1", "0"))
        self.assertTrue(any(name.startswith(f"a second, {COPIES} shapes in ") for name in figures), figures)
        (category,) = rows(self.group, "Categories")
        self.assertEqual(category[1:6], ["cup", str(COPIES), "0", "0", "0"])
        self.assertEqual({row[0] for row in rows(self.group, "Stages")},
                         {"read", "features", "scores", "cuts", "writing"})
        ((file, why),) = rows(self.group, "Unusable files")
        self.assertTrue(file.endswith("broken<b>.off"))
        self.assertTrue(why)

    def test_labels_share_the_area(self):
        labels = rows(self.group, "Labels")
        self.assertEqual({row[0] for row in labels}, {"body", "handle"})
        self.assertAlmostEqual(sum(float(row[1].removesuffix(" %")) for row in labels), 100, delta=0.2)

    def test_some_shapes_can_be_turned(self):
        self.assertEqual(len(self.group["meshes"]), 6)
        self.assertEqual(self.group["labels"][:2], ["body", "handle"])
        self.assertTrue(all(mesh["faces"] <= 5000 for mesh in self.group["meshes"]))

    def test_the_least_sure_come_first(self):
        sure = [float(row[1].removesuffix(" %")) for row in rows(self.group, "Least sure")]
        self.assertEqual(len(sure), COPIES)
        self.assertEqual(sure, sorted(sure))

    def test_names_of_files_stay_names(self):
        text = self.page.read_text()
        for name in ("<script>alert", "<img src=x", "--><!--", "broken<b>"):
            self.assertNotIn(name, text)
        names = {row[0] for row in rows(self.group, "Least sure")}
        self.assertTrue({name.removesuffix(".off") for name in HOSTILE} <= names, names)

    def test_a_call_that_finds_nothing_to_do_writes_it_again(self):
        self.page.unlink()
        self.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "out")
        again = report_of(self.page)["groups"][0]
        self.assertEqual(dict(again["summary"])["labeled"], str(COPIES))
        self.assertFalse([name for name, _ in again["summary"] if name.startswith("a second")])
        self.assertEqual(again["meshes"], self.group["meshes"])

    def test_shapes_whose_labels_are_gone_are_left_out(self):
        out = self.folder / "gone"
        shutil.copytree(self.folder / "cups", self.folder / "few")
        self.call("label", "batch", "few", "--model", "cup.safetensors", "--out", out)
        for path in (out / "labeled").glob("*.ply"):
            path.write_text("ply\nnothing\n")
        self.call("label", "batch", "few", "--model", "cup.safetensors", "--out", out)
        group = report_of(out / "index.html")["groups"][0]
        self.assertEqual(group["meshes"], [])
        self.assertEqual(dict(group["summary"])["labeled"], "3")


if __name__ == "__main__":
    unittest.main()

"""Batch labeling of several categories, which a model recognizes: each shape takes the model of its own."""

import json
import os
import shutil
import unittest

from batch_page_test import report_of, rows
from program import ProgramTest, QUICK, read_labels

LABELS = {"cup": {"body", "handle"}, "table": {"top", "leg"}}
# Four categories of eight meshes: of two or three, or with half as many meshes, some strangers pass for tables and some
# cups for strangers. So chosen, cups and tables are recognized with a confidence of 0.8 and more, glasses of 0.02.
LEARNED = ("cup", "table", "human", "octopus")
MESHES = 8
# What is to be labeled. People are recognized, but no model labels them.
SHAPES = {"cup": 3, "table": 3, "human": 1, "glasses": 2}


class BatchOfCategories(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for kind in LEARNED:
            cls.call("synth", kind, "--count", str(MESHES), "--faces", "500", "--seed", "50", "--out", f"learned/{kind}")
        for kind, count in SHAPES.items():
            cls.call("synth", kind, "--count", str(count), "--faces", "500", "--seed", "2", "--out", f"shapes/{kind}")
        # A name of meshes that is no UTF-8 goes into both models.
        for end in (".off", "_labels.txt"):
            name = os.fsdecode(b"cup \xff" + os.fsencode(end))
            os.rename(cls.folder / f"learned/cup/cup_050{end}", cls.folder / "learned/cup" / name)
        cls.train("models")
        cls.said = cls.batch("shapes", "out").stdout
        cls.call("catalog", "export", "out/catalog.db", "--out", "out.json")
        cls.rows = {row["name"]: row for row in json.loads((cls.folder / "out.json").read_text())}

    @classmethod
    def train(cls, models, *options):
        """Models of cups and tables, and a recognizer."""
        for kind, first in (("cup", os.fsdecode(b"cup \xff.off")), ("table", "table_050.off")):
            cls.call("label", "train", f"learned/{kind}/{first}", f"learned/{kind}/{kind}_051.off", "--out",
                     f"{models}/{kind}.safetensors", *QUICK, *options)
        cls.call("category", "train", "learned", "--out", f"{models}/kinds.safetensors", "--samples", "60", *options)

    @classmethod
    def batch(cls, source, out, *options, models="models"):
        return cls.call("label", "batch", source, "--models", models, "--out", out, "--json", f"{out}-report.json",
                        *options)

    def of_kind(self, kind):
        """Rows of the catalog."""
        found = [row for name, row in self.rows.items() if name.split("/")[-2] == kind]
        self.assertEqual(len(found), SHAPES[kind])
        return found

    def files(self, row, out="out"):
        """Endings of what was written of a shape."""
        path = self.folder / out / "labeled" / row["name"]
        return {str(file).removeprefix(str(path)) for file in path.parent.glob(path.name + "*")}

    def counts(self, catalog):
        self.call("catalog", "status", catalog, "--json", "status.json")
        (run,) = json.loads((self.folder / "status.json").read_text())["runs"]
        return run["done"], run["unknown"], run["failed"], run["open"]

    def test_each_shape_is_labeled_by_the_model_of_its_category(self):
        for kind, labels in LABELS.items():
            for row in self.of_kind(kind):
                self.assertEqual((row["state"], row["recognized"], row["model"], row["error"]), ("done", kind, kind, ""))
                self.assertGreaterEqual(row["category_probability"], 0.5)
                self.assertIn("_labels.txt", self.files(row))
                written = read_labels(self.folder / "out/labeled" / (row["name"] + "_labels.txt"))
                self.assertLessEqual(set(written), labels)
                self.assertTrue(written)

    def test_strangers_are_unknown_and_not_labeled(self):
        for row in self.of_kind("glasses"):
            self.assertEqual((row["state"], row["recognized"], row["model"]), ("unknown", "unknown", ""))
            self.assertLess(row["category_probability"], 0.5)
            self.assertRegex(row["error"], "^of no category that is known; most like '(cup|table|human|octopus)'")
            self.assertEqual(self.files(row), {".json"})

    def test_a_category_without_a_model_fails(self):
        (row,) = self.of_kind("human")
        self.assertEqual((row["state"], row["error"]), ("failed", "there is no model of the category 'human'"))
        self.assertEqual(self.files(row), {".json"})

    def test_the_counts_agree(self):
        self.assertIn("6 shapes labeled, 2 of unknown category, 1 failed", self.said)
        report = json.loads((self.folder / "out-report.json").read_text())
        self.assertEqual((report["labeled"], report["unknown"], report["failed"]), (6, 2, 1))
        self.assertEqual(self.counts("out/catalog.db"), (6, 2, 1, 0))
        overview, *groups = report_of(self.folder / "out/index.html")["groups"]
        figures = dict(overview["summary"])
        self.assertEqual([figures[name] for name in ("labeled", "of unknown category", "failed", "to do")],
                         ["6", "2", "1", "0"])
        # Labeled, recognized, unknown, failed.
        counts = {row[0]: tuple(map(int, row[2:6])) for row in rows(overview, "Categories")}
        self.assertEqual((counts["cup"][:3], counts["table"][:3]), ((3, 3, 0), (3, 3, 0)))
        self.assertEqual([sum(row[k] for row in counts.values()) for k in (0, 2, 3)], [6, 2, 1])
        self.assertEqual({group["title"] for group in groups}, {"cup", "table"})
        self.assertEqual({name.split("/")[-2] for name, why in rows(overview, "Not labeled")}, {"glasses", "human"})

    def test_the_unknown_are_tried_again_when_told_to(self):
        self.batch("shapes", "again")
        self.assertIn("0 shapes labeled, 0 of unknown category, 0 failed", self.batch("shapes", "again").stdout)
        self.assertIn("0 shapes labeled, 2 of unknown category, 1 failed", self.batch("shapes", "again", "--retry").stdout)
        self.assertEqual(self.counts("again/catalog.db"), (6, 2, 1, 0))

    def test_a_given_category_overrules_the_recognizer(self):
        self.call("catalog", "add", "given.db", "shapes/table", "shapes/glasses", "--category", "cup")
        self.assertIn("5 shapes labeled, 0 of unknown category, 0 failed", self.batch("given.db", "out-given").stdout)
        self.call("catalog", "export", "given.db", "--out", "given.json")
        for row in json.loads((self.folder / "given.json").read_text()):
            self.assertEqual((row["state"], row["category"], row["model"]), ("done", "cup", "cup"))
            self.assertFalse(row["category_probability"])
            written = read_labels(self.folder / "out-given/labeled" / (row["name"] + "_labels.txt"))
            self.assertLessEqual(set(written), LABELS["cup"])

    def test_a_recognizer_that_does_not_fit_is_refused(self):
        def refused(name, says, *recognizer):
            shutil.copytree(self.folder / "models", self.folder / name)
            self.call("category", "train", "learned/cup", "learned/table", *recognizer)
            self.refused("label", "batch", "shapes", "--models", name, "--out", f"out-{name}", code=1, says=says)
            self.assertFalse((self.folder / f"out-{name}").exists())
        refused("two", ["two/more.safetensors", "second model that recognizes categories"], "--out",
                "two/more.safetensors", "--samples", "60")
        refused("samples", "--samples", "--out", "samples/kinds.safetensors", "--samples", "61")

    def test_a_recognizer_with_another_least_confidence(self):
        shutil.copytree(self.folder / "models", self.folder / "sure")
        self.call("category", "train", "learned", "--out", "sure/kinds.safetensors", "--samples", "60",
                  "--least-confidence", "1")
        self.assertIn("0 shapes labeled, 9 of unknown category, 0 failed",
                      self.batch("shapes", "out-sure", models="sure").stdout)
        self.call("category", "train", "learned", "--out", "sure/kinds.safetensors", "--samples", "60",
                  "--least-confidence", "0")
        self.assertIn(" 0 of unknown category, ", self.batch("shapes", "out-sure", models="sure").stdout)


if __name__ == "__main__":
    unittest.main()

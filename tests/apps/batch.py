"""What the tests of batch labeling share: shapes, a model, and checks of an output folder."""

import json
import os

from program import ProgramTest, QUICK, read_labels, read_off


class BatchTest(ProgramTest):
    """Some small cups, and a model of cups that takes no time."""

    SHAPES = 8
    FACES = 500

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "cup", "--count", "3", "--faces", str(cls.FACES), "--out", "train", "--seed", "99")
        cls.call("label", "train", "train", "--out", "cup.safetensors", *QUICK)
        cls.call("synth", "cup", "--count", str(cls.SHAPES), "--faces", str(cls.FACES), "--out", "shapes")

    def records(self, out):
        """The records in an output folder."""
        return sorted((self.folder / out / "labeled").rglob("*.json"))

    def assert_labeled(self, record):
        """Everything that a record says is there, and whole."""
        told = json.loads(record.read_text())
        self.assertEqual(told["error"], "")
        stem = str(record).removesuffix(".json")
        source = self.folder / "shapes" / (record.stem + ".off")
        faces = len(read_off(source)[1])
        labels = read_labels(record.with_name(record.stem + "_labels.txt"))
        self.assertEqual(sorted(face for numbers in labels.values() for face in numbers), list(range(1, faces + 1)))
        with open(stem + ".seg") as segments:
            self.assertEqual(len(segments.read().split()), faces)
        self.assertGreater(os.path.getsize(stem + ".ply"), 13 * faces)
        return told

    def status(self, catalog):
        self.call("catalog", "status", catalog, "--json", "status.json")
        return json.loads((self.folder / "status.json").read_text())

    def assert_all_labeled(self, out, count):
        """Each shape is labeled, once, in the folder and in the catalog."""
        records = self.records(out)
        self.assertEqual(len(records), count)
        for record in records:
            self.assert_labeled(record)
        run = self.status(f"{out}/catalog.db")["runs"]
        self.assertEqual([(r["done"], r["failed"], r["open"], r["claimed"]) for r in run], [(count, 0, 0, 0)])

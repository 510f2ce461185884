"""exemplar bench: that what it prints is measured and complete, not how fast anything is."""

import json
import unittest

from program import ProgramTest


class Bench(ProgramTest):
    def bench(self, *options):
        """The printed table and its rows, for programs."""
        text = self.call("bench", "--quick", "--quiet", "--json", "r.json", *options).stdout
        return text, json.loads((self.folder / "r.json").read_text())["rows"]

    def test_single_operations(self):
        text, rows = self.bench("--only", "scoring", "cut")
        self.assertEqual([row["name"] for row in rows], ["scoring", "cut", "cut"])  # the table's order
        for row in rows:
            self.assertIn(row["what"], text)
            self.assertIn(row["goal"], text)
            for cost in [row["measured"], row["single_thread"]]:
                self.assertGreater(cost["wall_seconds"], 0)
                self.assertGreater(cost["cpu_seconds"], 0)
                self.assertGreater(cost.get("peak_bytes", 1e7), 1e6)
        self.assertGreater(rows[0]["numbers"]["cpu_over_plain"], 0)
        for row in rows[1:]:
            self.assertLess(row["numbers"]["energy"], row["numbers"]["energy_of_conditional_modes"])

    def test_own_meshes(self):
        self.call("synth", "table", "--count", "2", "--faces", "600", "--out", "shapes", "--quiet")
        _, rows = self.bench("--only", "label", "features", "--meshes", "shapes")
        self.assertEqual([row["name"] for row in rows], ["features", "label", "label"])
        for row in rows:
            self.assertIn("table_00", row["what"])
        self.assertGreater(sum(rows[0]["numbers"]["seconds_per_family"].values()), 0)

    def test_line_drawings(self):
        _, rows = self.bench("--only", "lines")
        self.assertEqual([row["name"] for row in rows], ["lines", "lines"])
        self.assertIn("learned", rows[0]["what"])
        for row in rows:
            self.assertAlmostEqual(row["numbers"]["frames_per_second"] * row["measured"]["wall_seconds"], 1, places=6)

    def test_wrong_arguments_are_refused_before_the_work(self):
        self.refused("bench", "--only", "ctu", code=2, says=["'ctu'", "'cut'"])
        self.refused("bench", "--meshes", "nowhere", code=1, says="nowhere")


if __name__ == "__main__":
    unittest.main()

"""Learned curvature of tiny generated animations, as a user trains and evaluates it."""

import json
import unittest

from program import ProgramTest


class Curvature(ProgramTest):
    SIZE = ["--vertices", "800", "--frames", "24"]

    def setUp(self):
        super().setUp()
        for seed in ("1", "2"):
            self.call("synth", "figure", *self.SIZE, "--seed", seed, "--out", ".")

    def train(self, out, *options):
        self.call("curvature", "train", "figure_001.glb", "--out", out, "--augment", "60", *options)
        return (self.folder / out).read_bytes()

    def test_learns_what_zero_order_does_not_know(self):
        model = self.train("m.safetensors", "--json", "train.json")
        self.call("curvature", "evaluate", "m.safetensors", "figure_002.glb", "--json", "errors.json",
                  "--pictures", "pictures")
        pictures = sorted(path.name for path in (self.folder / "pictures").iterdir())
        self.assertEqual(len(pictures), 3 * 6)
        self.assertIn("motion_2_0012_ridges.png", pictures)
        training = json.loads((self.folder / "train.json").read_text())
        errors = json.loads((self.folder / "errors.json").read_text())
        self.assertEqual(training["bytes"], len(model))
        self.assertEqual(errors["frames"], 24)
        k1 = errors["attributes"]["k1"]
        self.assertLess(k1["percentile_95"], k1["zero_order_percentile_95"])
        line = errors["lines"]["suggestive_contours"]
        self.assertLess(line["misclassified"], line["zero_order_misclassified"])
        self.assertGreater(line["faces_with_line"], 0)

    def test_equal_seeds_give_equal_models_for_any_number_of_threads(self):
        first = self.train("a.safetensors", "--threads", "1")
        self.assertEqual(self.train("b.safetensors"), first)
        self.assertNotEqual(self.train("c.safetensors", "--seed", "2"), first)

    def test_all_kinds_of_animations_and_all_learners(self):
        self.call("synth", "face", *self.SIZE, "--out", ".")
        self.call("synth", "curtain", *self.SIZE, "--out", ".")
        for source, options in [("face_001.glb", ["--learner", "network", "--augment", "20"]),
                                ("face_001.glb", ["--attributes", "principal", "--augment", "20"]),
                                ("curtain_001", ["--learner", "global", "--bases", "pca"]),
                                ("curtain_001", []),
                                ("figure_001.glb", ["--learner", "averaged", "--robust", "cauchy", "--augment", "0"])]:
            with self.subTest(source=source, options=options):
                self.call("curvature", "train", source, "--out", "k.safetensors", *options)
                done = self.call("curvature", "evaluate", "k.safetensors", source, "--poses", "3")
                self.assertIn("suggestive_contours", done.stdout)

    def test_study_varies_one_thing_at_a_time(self):
        done = self.call("curvature", "study", "figure_001.glb", "--test", "figure_002.glb", "--test-poses", "4",
                         "--augment", "20", "--learner", "additive", "--json", "study.json")
        rows = json.loads((self.folder / "study.json").read_text())["rows"]
        self.assertEqual({row["what"] for row in rows},
                         {"as given", "poses", "variance", "bases", "sparsity", "attributes"})
        self.assertIn("zero order", done.stdout)
        bytes_of = {(row["what"], row["value"]): row["training"]["tile_bytes"] for row in rows}
        self.assertLess(bytes_of["variance", "0.8"], bytes_of["variance", "0.999"])
        self.assertLess(bytes_of["sparsity", "0.05"], bytes_of["sparsity", "0"])
        self.assertTrue(all(row["evaluation"]["frames"] == 4 for row in rows))

    def test_study_tests_on_nothing_it_has_learned_from(self):
        self.call("curvature", "study", "figure_001.glb", "--frames", ":20", "--augment", "0", "--json", "study.json")
        study = json.loads((self.folder / "study.json").read_text())
        self.assertEqual((study["poses"], study["test_frames"]), (20, 4))
        self.refused("curvature", "study", "figure_001.glb", code=2, says="--test")

    def test_wrong_input_is_one_line(self):
        self.train("m.safetensors")
        self.call("synth", "face", *self.SIZE, "--out", ".")
        refused = self.refused
        refused("curvature", "train", "figure_001.glb", "--frames", ":10", "--out", "x", code=2, says=["20", "poses"])
        refused("curvature", "train", "figure_001.glb", "--frames", "9:3", "--out", "x", code=2, says="9:3")
        refused("curvature", "train", "figure_001.glb", "--clips", "motoin_1", "--out", "x", code=2, says="motion_1")
        refused("curvature", "train", "figure.glb", "--out", "x", code=1, says="figure.glb")
        refused("curvature", "train", "m.safetensors", "--out", "x", code=1, says="m.safetensors")
        refused("curvature", "evaluate", "m.safetensors", "face_001.glb", code=1, says="skeleton")
        refused("curvature", "evaluate", "figure_001.glb", "figure_001.glb", code=1, says="figure_001.glb")
        self.assertFalse((self.folder / "x").exists())


if __name__ == "__main__":
    unittest.main()

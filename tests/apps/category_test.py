"""Recognizing categories of generated shapes. Needs no Vulkan device."""

import json
import os
import shutil
import unittest

from program import ProgramTest, CUBE, CUBE_QUADS, write_off

FEW = ("--samples", "200", "--quiet")


class Categories(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for kind in ["cup", "human", "octopus"]:
            cls.call("synth", kind, "--count", "5", "--faces", "500", "--out", f"shapes/{kind}")
        (cls.folder / "new").mkdir()
        for kind in ["cup", "human", "octopus"]:
            shutil.move(cls.folder / "shapes" / kind / f"{kind}_005.off", cls.folder / "new")
        cls.call("synth", "glasses", "--count", "1", "--faces", "500", "--out", "other")
        cls.trained = cls.call("category", "train", "shapes", "--out", "kinds.safetensors", "--json", "train.json", *FEW)

    def json(self, name):
        return json.loads((self.folder / name).read_text())

    def description(self, model):
        """What the model file says of itself."""
        content = (self.folder / model).read_bytes()
        return json.loads(json.loads(content[8:8 + int.from_bytes(content[:8], "little")])["__metadata__"]["model"])

    def refused_early(self, *arguments, says):
        """Before any features are computed."""
        self.refused(*arguments, "--cache", "early", *FEW, code=2, says=says)
        self.assertEqual([str(path) for path in self.folder.glob("early/*")], [])

    def test_training_says_how_well_held_out_shapes_were_recognized(self):
        self.assertIn("held-out shapes:", self.trained.stdout)
        self.assertIn("3 categories of 12 meshes", self.trained.stdout)
        report = self.json("train.json")
        self.assertEqual(report["categories"],
                         [{"category": kind, "meshes": 4} for kind in ["cup", "human", "octopus"]])
        self.assertEqual(len(report["training_meshes"]), 12)
        self.assertGreater(report["held_out"]["nearest_right"], 0.8)

    def test_equal_calls_give_equal_files_from_any_form_of_sources(self):
        self.call("category", "train", "shapes/cup", "human=shapes/human", "shapes/octopus/", "--out", "b.safetensors",
                  "--threads", "1", "--cache", "", *FEW)
        self.assertEqual((self.folder / "b.safetensors").read_bytes(), (self.folder / "kinds.safetensors").read_bytes())

    def test_unseen_shapes_are_recognized_and_strangers_are_unknown(self):
        output = self.call("category", "apply", "kinds.safetensors", "new", "other", "--json", "apply.json",
                           "--quiet").stdout.splitlines()
        called = [mesh["category"] for mesh in self.json("apply.json")["meshes"]]
        self.assertEqual(called, ["cup", "human", "octopus", None])
        self.assertEqual([line.split()[1] for line in output], ["cup", "human", "octopus", "unknown"])
        for mesh in self.json("apply.json")["meshes"]:
            self.assertAlmostEqual(sum(mesh["probabilities"].values()), 1, places=4)
            self.assertEqual(mesh["category"] is not None, mesh["confidence"] >= 0.5)

    def test_the_least_confidence_is_the_users(self):
        for least, known in [("0", True), ("1", False)]:
            self.call("category", "apply", "kinds.safetensors", "other", "--least-confidence", least, "--json",
                      "least.json", "--quiet")
            self.assertEqual(self.json("least.json")["meshes"][0]["category"] is not None, known)
        self.refused("category", "apply", "kinds.safetensors", "other", "--least-confidence", "2", code=2,
                     says="--least-confidence")

    def test_a_model_has_its_own_least_confidence(self):
        self.assertEqual(self.description("kinds.safetensors")["least_confidence"], 0.5)
        self.call("category", "train", "shapes", "--out", "own.safetensors", "--least-confidence", "1", "--json",
                  "own.json", *FEW)
        self.assertEqual(self.description("own.safetensors")["least_confidence"], 1)
        self.assertEqual(self.json("own.json")["least_confidence"], 1)
        self.assertEqual(self.json("own.json")["held_out"]["called_unknown"], 1)
        self.call("category", "apply", "own.safetensors", "new", "--json", "strict.json", "--quiet")
        self.assertEqual({mesh["category"] for mesh in self.json("strict.json")["meshes"]}, {None})
        self.call("category", "apply", "own.safetensors", "new", "--least-confidence", "0.5", "--json", "usual.json",
                  "--quiet")
        self.assertEqual([mesh["category"] for mesh in self.json("usual.json")["meshes"]], ["cup", "human", "octopus"])
        self.call("category", "evaluate", "shapes", "--train-count", "3", "--least-confidence", "1", "--json",
                  "strict.json", *FEW)
        strict = self.json("strict.json")
        self.assertEqual((strict["called_unknown"], strict["least_confidence"]), (1, 1))
        for bad in ["-0.1", "2", "nan", "much"]:
            self.refused_early("category", "train", "shapes", "--out", "x", "--least-confidence", bad, says="least")
            self.refused_early("category", "evaluate", "shapes", "--least-confidence", bad, says="least")

    def test_names_of_meshes_may_be_in_any_encoding(self):
        for number in "12":
            name = os.fsdecode(b"cup \xff " + number.encode() + b".off")
            (self.folder / "encoding").mkdir(exist_ok=True)
            shutil.copy(self.folder / "shapes" / "cup" / f"cup_00{number}.off", self.folder / "encoding" / name)
        self.call("category", "train", "cup=encoding", "shapes/human", "--out", "e.safetensors", "--json", "e.json", *FEW)
        self.assertIn("cup cup \ufffd 1", self.description("e.safetensors")["provenance"][0])
        self.assertIn("cup cup \ufffd 1", self.json("e.json")["training_meshes"][0])
        output = self.call("category", "apply", "e.safetensors", "new/cup_005.off", "--quiet").stdout
        self.assertIn(" cup ", output)

    def test_bad_meshes_are_reported_and_the_others_recognized(self):
        (self.folder / "bad.off").write_text("OFF\n1 1 0\n0 0 0\n")
        result = self.call("category", "apply", "kinds.safetensors", "bad.off", "new", "--json", "bad.json", "--quiet",
                           code=1)
        self.assertEqual(len(result.stdout.splitlines()), 3)
        self.assertIn("error: bad.off", result.stderr)
        self.assertIn("1 of 4 meshes", result.stderr.splitlines()[-1])
        self.assertIn("bad.off", self.json("bad.json")["meshes"][0]["error"])
        self.refused("category", "apply", "kinds.safetensors", "bad.off", code=1, says="bad.off")

    def test_evaluation_counts_what_shapes_are_called(self):
        output = self.call("category", "evaluate", "shapes", "--train-count", "3", "--splits", "2", "--json",
                           "evaluate.json", *FEW).stdout
        report = self.json("evaluate.json")
        self.assertEqual([sum(row) for row in report["confusion"]], [2, 2, 2])
        self.assertEqual(report["shapes"], 6)
        right = sum(report["confusion"][c][c] for c in range(3))
        self.assertAlmostEqual(report["right"], right / 6)
        self.assertEqual(sum(row[3] for row in report["confusion"]), round(6 * report["called_unknown"]))
        self.assertEqual(set(report["not_learned_unknown"]), {"cup", "human", "octopus"})
        self.assertEqual(len(report["splits"]), 2)
        for split in report["splits"]:
            self.assertEqual((len(split["train"]), len(split["meshes"]), len(split["not_learned"])), (9, 3, 3))
            self.assertFalse(set(split["train"]) & {mesh["mesh"] for mesh in split["meshes"]})
        self.assertIn("6 shapes tested", output)

    def test_evaluation_of_given_meshes(self):
        self.call("category", "evaluate", "--train", "shapes", "--test", "cup=new/cup_005.off", "--json",
                  "given.json", *FEW)
        self.assertEqual([sum(row) for row in self.json("given.json")["confusion"]], [1, 0, 0])
        self.refused("category", "evaluate", "--train", "shapes", "--test", "shapes/cup", code=2, says="training meshes")
        self.refused("category", "evaluate", "--train", "shapes", "--test", "mug=new", code=2, says="mug")

    def test_shapes_that_were_trained_on_test_nothing(self):
        (self.folder / "copies").mkdir()
        shutil.copy(self.folder / "shapes/human/human_001.off", self.folder / "copies/copy.off")
        shutil.copy(self.folder / "new/cup_005.off", self.folder / "copies/other.off")
        self.refused_early("category", "evaluate", "--train", "shapes", "--test", "cup=shapes/human/human_001.off",
                           says=["shapes/human/human_001.off", "training meshes"])
        self.call("category", "evaluate", "--train", "shapes", "--test", "cup=copies", "--json", "copies.json", *FEW)
        copies = self.json("copies.json")
        self.assertEqual(copies["shapes"], 1)
        self.assertRegex(copies["remarks"][-1], "copies/copy.off: not tested .*shapes/human/human_001.off")
        (self.folder / "copies/other.off").unlink()
        shutil.copytree(self.folder / "shapes", self.folder / "twins")
        shutil.move(self.folder / "copies/copy.off", self.folder / "twins/cup/cup_004.off")
        # Of four meshes three are learned from, so each is tested in one of four splits.
        said = self.call("category", "evaluate", "twins", "--train-count", "3", "--splits", "4", "--json", "twins.json",
                         "--samples", "200").stderr
        twins = self.json("twins.json")
        self.assertEqual((twins["shapes"], [sum(row) for row in twins["confusion"]]), (10, [3, 3, 4]))
        self.assertEqual(len(twins["remarks"]), 2)
        for remark, names in zip(twins["remarks"], (["cup/cup_004", "human/human_001"], ["human/human_001", "cup/cup_004"])):
            self.assertRegex(remark, f"{names[0]}.off: not tested in 1 of 4 splits, .*{names[1]}.off$")
            self.assertIn("warning: " + remark, said)

    def test_a_category_that_the_others_need_is_not_left_out(self):
        self.call("category", "evaluate", "--train", "shapes/cup", "human=shapes/human/human_001.off",
                  "octopus=shapes/octopus/octopus_001.off", "--test", "cup=new/cup_005.off", "human=new/human_005.off",
                  "--json", "needed.json", *FEW)
        needed = self.json("needed.json")
        self.assertEqual((needed["shapes"], list(needed["not_learned_unknown"])), (2, ["human"]))
        (remark,) = needed["remarks"]
        self.assertIn("not learned: cup;", remark)
        said = self.call("category", "evaluate", "shapes/cup", "shapes/human", "--train-count", "2", "--json", "two.json",
                         "--samples", "200").stderr
        self.assertIn("not learned: cup, human;", said)
        self.assertIsNone(self.json("two.json")["not_learned_unknown"])

    def test_what_cannot_be_learned_is_refused_before_the_work(self):
        shutil.copytree(self.folder / "shapes/human", self.folder / "odd/unknown")
        for command in (["train", "--out", "x"], ["evaluate", "--train-count", "2"]):
            self.refused_early("category", *command, "shapes/cup", says="two at least")
            self.refused_early("category", *command, "shapes/cup", "odd/unknown", says="rename")
        self.refused_early("category", "train", "a=new/cup_005.off", "b=other", "--out", "x", says="give two of one")
        self.refused_early("category", "evaluate", "shapes", "--train-count", "1", says="--train-count")
        self.refused_early("category", "evaluate", "--train", "a=new/cup_005.off", "b=other", "--test", "a=shapes/cup",
                           says="give two of one")

    def test_wrong_usage_says_the_mend(self):
        self.refused("category", "train", "shapes/cup", "--out", "x", code=2, says="two at least")
        self.refused("category", "train", "a=new/cup_005.off", "b=other", "--out", "x", *FEW, code=2,
                     says="give two of one")
        self.refused("category", "train", "shapes/cup", "unknown=other", "--out", "x", code=2, says="rename")
        self.refused("category", "train", "shapes/cup", "mug=shapes/cup", "--out", "x", code=2, says="two categories")
        self.refused("category", "train", "new/cup_005.off", "--out", "x", code=2, says="NAME=")
        self.refused("category", "train", "shapes/cpu", "shapes/human", "--out", "x", code=1, says="shapes/cup")
        self.refused("category", "evaluate", code=2, says="--train")
        self.refused("category", "evaluate", "shapes", "--train", "shapes", "--test", "new", code=2, says="--t")
        self.refused("category", "evaluate", "shapes", "--train-count", "4", code=2, says="--train-count")
        self.assertFalse((self.folder / "x").exists())

    def test_what_is_no_model_is_refused(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        self.refused("category", "apply", "cube.off", "new", code=1, says="cube.off")
        self.refused("category", "apply", "shapes", "new", code=1, says="model")
        content = (self.folder / "kinds.safetensors").read_bytes()
        (self.folder / "cut.safetensors").write_bytes(content[:-9])
        self.refused("category", "apply", "cut.safetensors", "new", code=1, says="cut.safetensors")
        self.refused("label", "apply", "kinds.safetensors", "new", "--out", "y", code=1, says="no mesh labeling model")
        self.assert_no_leftovers()


if __name__ == "__main__":
    unittest.main()

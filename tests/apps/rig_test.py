"""Rigs of labeled meshes, from outside: what is written goes into the other commands. Needs a Vulkan device (a software one will do)."""

import json
import unittest

from program import ProgramTest, read_off, write_off


class Rig(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "human", "--count", "1", "--seed", "3", "--out", "humans")
        cls.mesh = cls.folder / "humans" / "human_003.off"
        cls.call("label", "rig", cls.mesh, "--out", "rig.glb", "--json", "rig.json", "--root", "torso")
        cls.report = json.loads((cls.folder / "rig.json").read_text())

    def test_a_human_has_two_sides_and_one_root(self):
        joints = {joint["joint"]: joint for joint in self.report["joints"]}
        self.assertEqual([name for name, joint in joints.items() if joint["parent"] is None], ["torso"])
        self.assertIsNotNone(self.report["mirror_normal"])
        for name, joint in joints.items():
            if name.endswith("_left"):
                mirrored = joints[name.replace("_left", "_right")]
                self.assertGreater(joint["head"][0], mirrored["head"][0])
        self.assertIn("upper_arm_left", joints)
        self.assertEqual(joints["hand_left"]["parent"], "lower_arm_left")

    def test_lines_and_curvature_take_it_without_a_detour(self):
        self.call("lines", "rig.glb", "--frames", "4", "--out", "bent.svg")
        self.call("curvature", "train", "rig.glb", "--poses", "24", "--out", "curvature.safetensors")
        self.call("lines", "rig.glb", "--model", "curvature.safetensors", "--frames", "4", "--out", "learned.svg")

    def test_poses_move_what_they_name(self):
        (self.folder / "pose.json").write_text(json.dumps({"upper_arm_left": [0, 0, 40], "head": [0, 30, 0]}))
        self.call("label", "rig", self.mesh, "--pose", "pose.json", "--out", "posed.glb", "--json", "posed.json")
        report = json.loads((self.folder / "posed.json").read_text())
        self.assertEqual((report["clip"], report["frames"]), ("pose", 16))
        for text, says in [('{"upper_arm_lefd": [0, 0, 1]}', "did you mean 'upper_arm_left'"), ("[", "no JSON"), ('{"head": 3}', "three angles")]:
            (self.folder / "wrong.json").write_text(text)
            self.refused("label", "rig", self.mesh, "--pose", "wrong.json", "--out", "x.glb", code=1, says=["wrong.json", says])

    def test_true_labels_have_no_error(self):
        self.call("label", "rig", self.mesh, "--truth", self.mesh.with_name("human_003_labels.txt"), "--out", "t.glb", "--json", "t.json")
        truth = json.loads((self.folder / "t.json").read_text())["truth"]
        self.assertEqual(truth["within_5_percent"], len(truth["joints"]))
        self.assertEqual({joint["distance"] for joint in truth["joints"]}, {0})

    def test_wrong_arguments(self):
        write_off(self.folder / "bare.off", *read_off(self.mesh))
        self.refused("label", "rig", "bare.off", "--out", "x.glb", code=1, says=["bare.off", "no labels", "--labels"])
        self.refused("label", "rig", self.mesh, "--out", "x.obj", code=2, says=["x.obj", ".glb"])
        self.refused("label", "rig", self.mesh, self.mesh, self.mesh, "--out", "x.glb", code=2, says="one model and one mesh")
        self.refused("label", "rig", self.mesh, "--root", "tosro", "--out", "x.glb", code=1, says=["tosro", "torso"])
        self.call("label", "rig", "bare.off", "--labels", self.mesh.with_name("human_003_labels.txt"), "--out", "l.glb")


if __name__ == "__main__":
    unittest.main()

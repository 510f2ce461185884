"""What --json writes is what docs/formats.md says. Needs a Vulkan device (a software one will do)."""

import re
import shutil
import unittest

from program import (WithModel, DOCS, QUICK)


class Reports(WithModel):
    """docs/formats.md says all keys of every report, and no others."""

    OPEN = {"stumps_per_family", "share_per_family", "seconds_per_family"}  # their keys are names of families
    OPTIONAL = {"error", "unusable_because", "copy_gb_per_s", "fma_gflop_per_s", "shared_gb_per_s", "texel_gb_per_s", "atomic_gop_per_s",
                "launch_us", "driver_statistics", "subgroup_size", "thesis"}

    def keys(self, value):
        if isinstance(value, dict):
            for key, inner in value.items():
                yield key
                if key not in self.OPEN:
                    yield from self.keys(inner)
        elif isinstance(value, list):
            for inner in value:
                yield from self.keys(inner)

    def documented(self, command):
        text = (DOCS / "formats.md").read_text()
        section = re.search(rf"^### `{command}`\n(.*?)(?=^##|\Z)", text, re.M | re.S)[1]
        return set(re.findall(r"`(\w+)`", section))

    def check(self, command, report):
        found, documented = set(self.keys(report)), self.documented(command)
        self.assertEqual(found - documented, set(), "not in docs/formats.md")
        self.assertEqual(documented - found - self.OPTIONAL, set(), "in docs/formats.md but not in the report")

    def test_train(self):
        self.check("label train", self.json("train.json"))

    def test_parts(self):
        truth = self.cup.with_name(self.cup.stem + "_labels.txt")
        self.call("label", "rig", "cup.safetensors", self.cup, "--truth", truth, "--out", "r.glb", "--json", "r.json")
        self.check("label rig", self.json("r.json"))
        (self.folder / "skin.json").write_text('{"*": {"metallic": 1}}')
        self.call("label", "materials", self.cup, "--materials", "skin.json", "--out", "m.glb", "--json", "m.json")
        self.check("label materials", self.json("m.json"))
        self.call("label", "prototype", "mannequin", self.cup, "--resolution", "50", "--out", "printed", "--json", "p.json")
        self.check("label prototype mannequin", self.json("p.json"))

    def test_apply(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "labeled", "--split", "parts", "--json", "a.json")
        report = self.json("a.json")
        self.check("label split", {"meshes": [{**mesh.pop("split"), "mesh": "", "warnings": []} for mesh in report["meshes"]]})
        self.call("label", "split", "cups", "--out", "cut", "--json", "c.json")
        self.check("label split", self.json("c.json"))
        self.check("label apply", {**report, "split": None})

    def test_evaluate(self):
        tested = self.mistaken_cups()
        self.call("label", "evaluate", "--train-on", "cups", "cups/cup_001.off", "--test-on", tested, "--out", "e", "--json",
                  "e.json", "--curve", "--peer", tested, *QUICK)
        self.check("label evaluate", self.json("e.json"))

    def test_people(self):
        self.call("label", "simulate", "cups", "--order", "gain", "--json", "s.json")
        self.check("label simulate", self.json("s.json"))
        self.call("label", "next", "cups", "--json", "n.json")
        (self.folder / "cups" / "cup_002_labels.txt").rename(self.folder / "away.txt")
        self.call("label", "next", "cups", "--json", "n.json")
        (self.folder / "away.txt").rename(self.folder / "cups" / "cup_002_labels.txt")
        self.check("label next", self.json("n.json"))

    def test_stress(self):
        self.call("label", "stress", "cup.safetensors", "cups", "--damage", "holes", "--json", "x.json")
        self.check("label stress", self.json("x.json"))

    def test_features(self):
        self.call("features", self.cup, "--out", "f.npy", "--json", "f.json", "--samples", "60")
        self.check("features", self.json("f.json"))

    def test_synth(self):
        self.call("synth", "cup", "--faces", "500", "--out", "s", "--json", "s.json")
        self.check("synth", self.json("s.json"))

    def test_statistics_of_kernels(self):
        if "install mesa-vulkan-drivers" in self.start("bench", "shaders", "--statistics", "--filter", "copy").communicate()[1]:
            self.skipTest("Mesa's driver of AMD's cards is not installed")
        self.call("bench", "shaders", "--statistics", "--filter", "copy", "--json", "k.json")
        self.check("bench shaders --statistics", self.json("k.json"))

    def test_shaders_of_the_user(self):
        if not shutil.which("glslangValidator"):
            self.skipTest("glslangValidator is not installed")
        (self.folder / "double.comp").write_text("#version 450\nlayout(binding = 0) buffer X { float x[]; };\n"
                                                 "void main() { x[gl_GlobalInvocationID.x] *= 2.0; }\n")
        self.call("bench", "spirv", "double.comp", "--against", "double.comp", "--groups", "9", "--seconds", "0.5", "--json", "b.json")
        report = self.json("b.json")
        for kernel in report["measurements"][0]["kernels"]:
            kernel.pop("driver_statistics", None)  # its keys are the driver's
        report["measurements"][0]["references_ms"] = None
        self.check("bench spirv", {**report, "device": None})

    def test_devices(self):
        self.call("devices", "--no-measure", "--json", "d.json")
        self.check("devices", self.json("d.json"))
        self.assertEqual(sum(device["chosen"] for device in self.json("d.json")["devices"]), 1)


if __name__ == "__main__":
    unittest.main()

"""Labels from rigs, materials and mannequins, from outside. Needs a Vulkan device (a software one will do)."""

import json
import struct
import unittest
import zlib

from program import QUICK, ProgramTest


def png(width, height):
    """A gray picture."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = b"".join(b"\0" + bytes(range(width)) for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Parts(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "human", "--count", "1", "--seed", "3", "--out", "humans")
        cls.mesh = cls.folder / "humans" / "human_003.off"

    def test_a_rig_teaches_labels(self):
        self.call("label", "rig", self.mesh, "--out", "rig.glb", "--root", "torso")
        self.call("label", "train", "--from-rig", "rig.glb", "--poses", "2", "--export", "poses", "--out", "model", *QUICK)
        names = {path.name for path in (self.folder / "poses").iterdir()}
        self.assertEqual(names, {"rig_1.off", "rig_1_labels.txt", "rig_2.off", "rig_2_labels.txt"})
        lines = (self.folder / "poses" / "rig_1_labels.txt").read_text().splitlines()
        self.assertLessEqual({"torso", "upperarm", "lowerleg", "head"}, set(lines[::2]))
        self.call("label", "apply", "model", self.mesh, "--out", "applied")
        self.call("label", "train", self.mesh, "--from-rig", "rig.glb", "--poses", "1", "--out", "both", *QUICK)

    def test_a_rig_of_a_mesh_far_away_says_where_it_is(self):
        lines = self.mesh.read_text().splitlines()
        count = int(lines[1].split()[0])
        far = [" ".join((str(float(x) + 5e6), y, z)) for x, y, z in (line.split() for line in lines[2:2 + count])]
        (self.folder / "far.off").write_text("\n".join(lines[:2] + far + lines[2 + count:]) + "\n")
        labels = self.mesh.with_name(self.mesh.stem + "_labels.txt")
        said = self.call("label", "rig", "far.off", "--labels", labels, "--root", "torso", "--out", "far.glb", "--json", "far.json").stderr
        self.assertIn("far from the origin", said)
        self.call("label", "rig", self.mesh, "--root", "torso", "--out", "near.glb", "--json", "near.json")
        far, near = (json.loads((self.folder / name).read_text()) for name in ("far.json", "near.json"))
        self.assertEqual(near["origin"], [0, 0, 0])
        for a, b in zip(far["joints"], near["joints"]):
            self.assertEqual(a["joint"], b["joint"])
            self.assertAlmostEqual(a["head"][0] + far["origin"][0] - 5e6, b["head"][0], delta=1e-3)

    def test_unknown_bones_need_a_map(self):
        self.call("synth", "figure", "--count", "1", "--seed", "1", "--out", "figures")
        figure = next((self.folder / "figures").glob("*.glb"))
        (self.folder / "map.json").write_text('{"*": "body", "*arm*": "arm", "*head*": "head"}')
        self.call("label", "train", "--from-rig", figure, "--map", "map.json", "--poses", "1", "--out", "mapped", *QUICK)
        (self.folder / "map.json").write_text('{"nothing": "body"}')
        self.refused("label", "train", "--from-rig", figure, "--map", "map.json", "--out", "x", *QUICK, code=1, says=["--map", "bones"])
        (self.folder / "map.json").write_text("{")
        self.refused("label", "train", "--from-rig", figure, "--map", "map.json", "--out", "x", *QUICK, code=1, says="map.json")
        self.refused("label", "train", "--out", "x", code=2, says="--from-rig")

    def test_materials_keep_labels_and_hold_their_pictures(self):
        (self.folder / "fur.png").write_bytes(png(16, 16))
        (self.folder / "skin.json").write_text(json.dumps({"torso": {"texture": "fur.png"}, "*": {"color": "#ff0000", "metallic": 1}}))
        self.call("label", "materials", self.mesh, "--materials", "skin.json", "--out", "dressed.glb", "--json", "m.json")
        content = (self.folder / "dressed.glb").read_bytes()
        self.assertIn(png(16, 16), content)
        scene = json.loads(content[20:20 + struct.unpack_from("<I", content, 12)[0]])
        materials = {material["name"]: material["pbrMetallicRoughness"] for material in scene["materials"]}
        self.assertIn("baseColorTexture", materials["torso"])
        self.assertEqual(materials["head"]["baseColorFactor"], [1, 0, 0, 1])
        self.call("label", "rig", "dressed.glb", "--out", "again.glb")
        self.refused("label", "materials", self.mesh, "--materials", "none.json", "--out", "x.glb", code=1, says="none.json")
        (self.folder / "skin.json").write_text('{"torso": {"colour": "#ff0000"}}')
        self.refused("label", "materials", self.mesh, "--materials", "skin.json", "--out", "x.glb", code=1, says=["skin.json", "did you mean 'color'"])

    def test_drawings_take_the_inks_of_labels(self):
        inks = {"torso": {"line": {"color": "#cc2200", "width": 2}}, "head": {"line": {"width": 0}}}
        (self.folder / "inks.json").write_text(json.dumps(inks))
        self.call("lines", self.mesh, "--materials", "inks.json", "--out", "lines.svg")
        drawing = (self.folder / "lines.svg").read_text()
        self.assertIn('"contours: torso"', drawing)
        self.assertIn("#cc2200", drawing)
        self.assertNotIn("head", drawing)
        self.call("lines", self.mesh, "--out", "plain.svg")
        self.assertNotIn("torso", (self.folder / "plain.svg").read_text())
        self.call("lines", self.mesh, "--materials", "inks.json", "--size", "200x160", "--out", "lines.png")
        (self.folder / "wrong.json").write_text('{"torso": {"line": {"widht": 2}}}')
        self.refused("lines", self.mesh, "--materials", "wrong.json", "--out", "x.svg", code=1, says=["widht", "'width'"])
        (self.folder / "other.json").write_text('{"wing": {"line": {"width": 2}}}')
        self.refused("lines", self.mesh, "--materials", "other.json", "--out", "x.svg", code=2, says=["other.json", "torso"])

    def test_hatching_takes_the_inks_of_labels(self):
        self.call("hatch", "example", "light", self.mesh, "--size", "300x240", "--out", "drawing.png")
        self.call("hatch", "train", self.mesh, "drawing.png", "--size", "300x240", "--out", "style")
        inks = {"torso": {"hatching": {"color": "#cc2200"}, "line": {"color": "#0000cc"}}, "*": {"hatching": {"width": 0}}}
        (self.folder / "hatches.json").write_text(json.dumps(inks))
        self.call("hatch", "draw", "style", self.mesh, "--materials", "hatches.json", "--size", "300x240", "--out", "hatching.svg")
        drawing = (self.folder / "hatching.svg").read_text()
        self.assertIn('"hatching: torso"', drawing)
        self.assertIn('"contours: torso"', drawing)
        self.assertNotIn('"hatching: upperleg"', drawing)
        self.call("hatch", "draw", "style", self.mesh, "--materials", "hatches.json", "--size", "300x240", "--out", "hatching.png")

    def test_glasses_are_made_of_closed_solids(self):
        self.call("synth", "glasses", "--count", "1", "--seed", "1", "--faces", "6000", "--out", "glasses")
        mesh = next((self.folder / "glasses").glob("*.off"))
        self.call("label", "prototype", "glasses", mesh, "--resolution", "120", "--out", "print", "--json", "print.json")
        report = json.loads((self.folder / "print.json").read_text())
        names = {solid["solid"]: solid["closed"] for solid in report["solids"]}
        self.assertEqual(names, dict.fromkeys(("frame", "arm_left", "arm_right", "lens_left", "lens_right"), True))
        self.assertIn("<path", (self.folder / "print" / "lens_left.svg").read_text())
        self.refused("label", "prototype", "glasses", mesh, "--lens", "wheel", "--out", "x", code=2, says=["wheel", "temple"])
        self.refused("label", "prototype", "glasses", self.mesh, "--out", "x", code=2, says=["torso", "--lens"])

    def test_wrong_arguments_of_prototypes(self):
        self.refused("label", "prototype", "mannequin", self.mesh, "--root", "trunk", "--out", "x", code=1, says="trunk")
        (self.folder / "open.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.refused("label", "prototype", "mannequin", "open.off", "--out", "x", code=1, says="open.off")
        (self.folder / "open_labels.txt").write_text("leg\n1\n")
        self.refused("label", "prototype", "mannequin", "open.off", "--out", "x", code=1, says=["open.off", "closed"])

    def test_labels_that_are_paths_stay_in_the_folder(self):
        labels = self.mesh.with_name("human_003_labels.txt").read_text().replace("head", "../../head").replace("hand", "all")
        (self.folder / "odd.txt").write_text(labels)
        self.call("label", "prototype", "mannequin", self.mesh, "--labels", "odd.txt", "--resolution", "60", "--out", "deep/er/odd")
        self.assertEqual([path.name for path in self.folder.glob("*.stl")] + [path.name for path in self.folder.glob("deep/*.stl")], [])

    def test_a_mannequin_is_made_of_closed_solids(self):
        self.call("label", "prototype", "mannequin", self.mesh, "--root", "torso", "--resolution", "100", "--out", "mannequin", "--json", "p.json")
        report = json.loads((self.folder / "p.json").read_text())
        self.assertTrue(all(solid["closed"] for solid in report["solids"]))
        moving = [joint for joint in report["joints"] if joint["kind"] != "fused"]
        self.assertEqual(len(report["solids"]), len(moving) + 1)
        self.assertGreater(len(moving), 3)
        files = {path.name for path in (self.folder / "mannequin").iterdir()}
        self.assertEqual(files, {solid["file"] for solid in report["solids"]} | {"all.stl"})
        for solid in report["solids"]:
            size = (self.folder / "mannequin" / solid["file"]).stat().st_size
            self.assertEqual(size, 84 + 50 * solid["faces"])


if __name__ == "__main__":
    unittest.main()

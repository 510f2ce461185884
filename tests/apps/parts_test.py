"""Parts of labeled meshes as files, labels in the forms of other programs, and their transfer, from outside the program."""

import json
import shutil
import struct
import unittest
import xml.etree.ElementTree as ElementTree

from program import CUBE, CUBE_QUADS, CUBE_TRIANGLES, ProgramTest, WithModel, read_labels, read_off, write_off


def volume(vertices, faces):
    """The signed volume of a closed surface of triangles."""
    total = 0
    for a, b, c in faces:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (vertices[i] for i in (a, b, c))
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


def is_closed(faces):
    """Each directed edge once, and its reverse once."""
    edges = [(face[i], face[(i + 1) % 3]) for face in faces for i in range(3)]
    return len(set(edges)) == len(edges) and all((b, a) in set(edges) for a, b in edges)


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    return ([tuple(map(float, words[1:])) for words in lines if words[0] == "v"],
            [tuple(int(word) - 1 for word in words[1:]) for words in lines if words[0] == "f"])


def read_stl(path):
    """Vertices, one per position, and faces of a binary STL."""
    content = path.read_bytes()
    count, = struct.unpack_from("<I", content, 80)
    assert len(content) == 84 + 50 * count
    index, faces = {}, []
    for i in range(count):
        corners = struct.unpack_from("<9f", content, 96 + 50 * i)
        faces.append(tuple(index.setdefault(corners[k:k + 3], len(index)) for k in (0, 3, 6)))
    return list(index), faces


def read_glb(path):
    """The JSON and the binary chunk."""
    content = path.read_bytes()
    magic, version, length, json_length = struct.unpack_from("<4s3I", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    return json.loads(content[20:20 + json_length]), content[28 + json_length:]


def glb_parts(path):
    """{name of node: (vertices, faces)}"""
    scene, binary = read_glb(path)

    def numbers(accessor, form, width):
        view = scene["bufferViews"][scene["accessors"][accessor]["bufferView"]]
        count = scene["accessors"][accessor]["count"] * width
        flat = struct.unpack_from(f"<{count}{form}", binary, view.get("byteOffset", 0))
        return [flat[i:i + width] for i in range(0, count, width)]

    parts = {}
    for node in scene["nodes"]:
        primitive, = scene["meshes"][node["mesh"]]["primitives"]
        corners = [index for index, in numbers(primitive["indices"], "I", 1)]
        parts[node["name"]] = (numbers(primitive["attributes"]["POSITION"], "f", 3),
                               [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)])
    return parts


class Split(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "cup", "--count", "1", "--faces", "800", "--out", "cups")
        cls.cup = cls.folder / "cups" / "cup_001.off"
        cls.labels = read_labels(cls.folder / "cups" / "cup_001_labels.txt")

    def split(self, *options):
        self.call("label", "split", self.cup, "--out", "parts", "--json", "parts.json", *options)
        return json.loads((self.folder / "parts.json").read_text())["meshes"][0]

    def test_each_format_holds_the_faces_of_each_label(self):
        vertices, faces = read_off(self.cup)
        for form, read in (("obj", read_obj), ("stl", read_stl)):
            with self.subTest(form):
                shutil.rmtree(self.folder / "parts", ignore_errors=True)
                report = self.split("--format", form)
                self.assertEqual([part["name"] for part in report["parts"]], sorted(self.labels))
                for name, numbers in self.labels.items():
                    found_vertices, found = read(self.folder / "parts" / f"cup_001_{name}.{form}")
                    wanted = [[vertices[v] for v in faces[number - 1]] for number in numbers]
                    corners = [[found_vertices[v] for v in face] for face in found]
                    self.assertEqual(len(corners), len(wanted))
                    for a, b in zip(corners, wanted):
                        for p, q in zip(a, b):
                            self.assertLess(max(abs(x - y) for x, y in zip(p, q)), 1e-6)
        self.assertTrue(all((self.folder / "parts" / f"cup_001_{name}.stl").exists() for name in self.labels))

    def test_caps_close_the_parts_and_keep_the_volume(self):
        whole = volume(*read_off(self.cup))
        report = self.split("--format", "glb", "--caps")
        parts = glb_parts(self.folder / "parts" / "cup_001.glb")
        self.assertEqual(sorted(parts), sorted(self.labels))
        self.assertTrue(all(is_closed(faces) for _, faces in parts.values()))
        self.assertAlmostEqual(sum(volume(*part) for part in parts.values()) / whole, 1, places=5)
        self.assertLess(report["volume_defect"], 1e-6)
        self.assertTrue(all(part["closed"] and part["manifold"] for part in report["parts"]))
        open_parts = self.split("--format", "glb")["parts"]
        self.assertFalse(any(part["closed"] for part in open_parts))

    def test_parts_can_be_moved_apart(self):
        still = dict(glb_parts(self.folder / "parts" / "cup_001.glb")) if self.split("--format", "glb") else {}
        self.split("--format", "glb", "--explode", "0.5")
        moved = glb_parts(self.folder / "parts" / "cup_001.glb")
        offsets = {name: [b - a for a, b in zip(still[name][0][0], moved[name][0][0])] for name in moved}
        self.assertGreater(max(sum(x * x for x in offset) ** 0.5 for offset in offsets.values()), 0.3)
        self.assertEqual({name: faces for name, (_, faces) in still.items()}, {name: faces for name, (_, faces) in moved.items()})

    def test_pieces_get_names(self):
        vertices = CUBE + [(x + 3, y, z) for x, y, z in CUBE]
        write_off(self.folder / "two.off", vertices, CUBE_TRIANGLES + [tuple(v + 8 for v in t) for t in CUBE_TRIANGLES])
        (self.folder / "two_labels.txt").write_text("box\n" + " ".join(str(i + 1) for i in range(24)) + "\n")
        self.call("label", "split", "two.off", "--out", "pieces", "--format", "ply", "--instances")
        self.assertEqual(sorted(path.name for path in (self.folder / "pieces").iterdir()),
                         ["two_box_left.ply", "two_box_right.ply"])

    def test_wrong_arguments_are_refused(self):
        self.refused("label", "split", self.cup, "--out", "x", "--format", "fbx", code=2, says=["obj, ply, stl, glb", "'fbx'"])
        self.refused("label", "split", self.cup, "--out", "x", "--explode", "-1", code=2, says="--explode")
        write_off(self.folder / "plain.off", CUBE, CUBE_TRIANGLES)
        self.refused("label", "split", "plain.off", "--out", "x", code=1, says=["plain.off", "no labels"])
        self.refused("label", "split", "plain.off", "--labels", "none.txt", "--out", "x", code=1, says="none.txt")
        self.refused("label", "split", self.cup, "plain.off", "--labels", "cups/cup_001_labels.txt", "--out", "x", code=2,
                     says="one mesh")


class Transfer(ProgramTest):
    def test_another_resolution_gets_the_labels(self):
        self.call("synth", "cup", "--count", "1", "--faces", "800", "--out", "low")
        self.call("synth", "cup", "--count", "1", "--faces", "1600", "--out", "high")
        result = self.call("label", "transfer", "low/cup_001.off", "high/cup_001.off", "--out", "high_labels.txt", "--json", "t.json")
        truth, found = read_labels(self.folder / "high" / "cup_001_labels.txt"), read_labels(self.folder / "high_labels.txt")
        right = sum(len(set(truth[name]) & set(found[name])) for name in truth)
        self.assertGreater(right, 0.95 * sum(map(len, truth.values())))
        report = json.loads((self.folder / "t.json").read_text())
        self.assertGreater(report["sure_share"], 0.8)
        self.assertIn(f"sure of {100 * report['sure_share']:.1f} %", result.stdout)

    def test_meshes_elsewhere_are_unsure(self):
        write_off(self.folder / "a.off", CUBE, CUBE_QUADS)
        (self.folder / "a_labels.txt").write_text("x\n1 2 3\ny\n4 5 6\n")
        write_off(self.folder / "far.off", [(x + 50, y, z) for x, y, z in CUBE], CUBE_QUADS)
        result = self.call("label", "transfer", "a.off", "far.off", "--out", "far.txt")
        self.assertIn("sure of 0.0 %", result.stdout)
        self.assertIn("warning: most of far.off", result.stderr)
        self.assertEqual(sorted(sum(read_labels(self.folder / "far.txt").values(), [])), [1, 2, 3, 4, 5, 6])
        self.refused("label", "transfer", "a.off", "far.off", "--out", "a_labels.txt", code=2, says="a_labels.txt")


class Forms(WithModel):
    def test_labels_are_written_in_every_form(self):
        write_off(self.folder / "quads.off", CUBE, CUBE_QUADS)
        self.call("label", "apply", "cup.safetensors", self.cup, "quads.off", "--out", "out", "--labels", "json", "npy", "vtp", "vertices",
                  "vertices-json", "--split", "parts", "--split-format", "obj")
        for stem, count, corners in (("cup_001", len(read_off(self.cup)[1]), len(read_off(self.cup)[0])), ("quads", 6, 8)):
            labels = read_labels(self.folder / "out" / f"{stem}_labels.txt")
            wanted = {number - 1: name for name, numbers in labels.items() for number in numbers}
            data = json.loads((self.folder / "out" / f"{stem}_labels.json").read_text())
            self.assertEqual([data["labels"][label] for label in data["faces"]], [wanted[f] for f in range(count)])
            array = (self.folder / "out" / f"{stem}_labels.npy").read_bytes()
            self.assertEqual(list(struct.unpack(f"<{count}i", array[-4 * count:])), data["faces"])
            piece = ElementTree.parse(self.folder / "out" / f"{stem}.vtp").getroot().find("PolyData/Piece")
            self.assertEqual((piece.get("NumberOfPoints"), piece.get("NumberOfPolys")), (str(corners), str(count)))
            self.assertEqual(len((self.folder / "out" / f"{stem}_vertices.txt").read_text().split()), corners)
            teeth = json.loads((self.folder / "out" / f"{stem}_vertices.json").read_text())
            self.assertEqual((len(teeth["labels"]), len(teeth["instances"])), (corners, corners))
            for name in labels:
                self.assertTrue((self.folder / "parts" / f"{stem}_{name}.obj").exists())

    def test_labels_of_other_programs_train_alike(self):
        """The same labels in another form give the same model."""
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "known", "--labels", "json", "vtp")
        first = None
        for ending in ["_labels.txt", "_labels.json", ".vtp"]:
            folder = self.folder / ("train" + ending)
            folder.mkdir()
            for mesh in (self.folder / "cups").glob("*.off"):
                shutil.copy(mesh, folder)
                shutil.copy(self.folder / "known" / (mesh.stem + ending), folder)
            self.call("label", "train", folder, "--out", "again.safetensors", "--rounds", "4", "--patience", "4", "--samples", "60",
                      "--feature-fraction", "0.25")
            model = (self.folder / "again.safetensors").read_bytes()
            first = first or model
            self.assertEqual(model, first, ending)

    def test_wrong_forms_are_refused(self):
        self.refused("label", "apply", "cup.safetensors", self.cup, "--out", "x", "--labels", "csv", code=2, says=["'csv'", "vertices-json"])
        self.refused("label", "apply", "cup.safetensors", self.cup, "--out", "x", "--gltf", "--split", "x", code=2, says="NAME.glb")


if __name__ == "__main__":
    unittest.main()

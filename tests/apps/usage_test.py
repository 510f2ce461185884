"""Help, wrong usage and wrong files: what a first-time user meets. Needs no Vulkan device."""

import json
import struct
import unittest

from program import DOCS, ProgramTest, CUBE, CUBE_QUADS, CUBE_TRIANGLES, read_labels, read_off, write_off

DEVICE_COMMANDS = ["label train", "label apply", "label evaluate", "label stress", "devices", "demo", "bench", "lines"]
HOST_COMMANDS = ["category train", "category apply", "category evaluate", "features", "synth", "curvature train", "curvature evaluate", "curvature study"]
COMMANDS = DEVICE_COMMANDS + HOST_COMMANDS


class Help(ProgramTest):
    def test_every_subcommand_has_an_example_of_itself(self):
        for command in ["", "label", *COMMANDS]:
            with self.subTest(command):
                text = self.call(*command.split(), "--help").stdout
                example = text[text.index("Example"):]
                self.assertIn(f"exemplar {command}".strip(), example)

    def test_every_subcommand_takes_the_common_options(self):
        for command in COMMANDS:
            with self.subTest(command):
                text = self.call(*command.split(), "--help").stdout
                for option in ["--json", "--threads", "--quiet"]:
                    self.assertIn(option, text)

    def test_a_device_is_chosen_where_one_computes(self):
        for command in COMMANDS:
            with self.subTest(command):
                text = self.call(*command.split(), "--help").stdout
                (self.assertIn if command in DEVICE_COMMANDS else self.assertNotIn)("--device", text)
        self.refused("curvature", "train", "x.glb", "--out", "x", "--device", "0", code=2, says="'--device'")

    def test_version_is_a_number(self):
        self.assertRegex(self.call("--version").stdout, r"^\d+\.\d+\.\d+\n$")


class Usage(ProgramTest):
    def test_no_subcommand(self):
        self.refused(code=2, says="exemplar --help")
        self.refused("label", code=2, says="exemplar label --help")

    def test_unknown_subcommand_suggests_the_nearest(self):
        self.refused("sinth", code=2, says=["'sinth'", "'synth'", "exemplar --help"])
        self.refused("label", "aply", code=2, says=["'aply'", "'apply'", "exemplar label --help"])

    def test_unknown_option_suggests_the_nearest(self):
        self.refused("synth", "cup", "--cuont", "3", "--out", "x", code=2, says=["'--cuont'", "'--count'"])
        self.refused("label", "train", "--sed=1", code=2, says=["'--sed'", "'--seed'", "exemplar label train --help"])
        self.refused("label", "train", "x", "--qwertz", code=2, says="'--qwertz'")

    def test_unknown_kind_suggests_the_nearest(self):
        self.refused("synth", "humn", "--out", "x", code=2, says=["'humn'", "'human'"])

    def test_unknown_file_suggests_the_nearest(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        self.refused("features", "cbue.off", "--out", "x.npy", code=1, says=["cbue.off", "'cube.off'"])
        self.refused("label", "train", "cube.of", "--out", "x", code=1, says=["cube.of:", "'cube.off'"])
        self.refused("features", "nowhere/mesh.off", "--out", "x.npy", code=1, says="nowhere/mesh.off")

    def test_numbers_out_of_range(self):
        for count in ["0", "-1", "1.5", "many"]:
            with self.subTest(count):
                self.refused("synth", "cup", f"--count={count}", "--out", "x", code=2, says=["--count", "from 1"])
        self.refused("synth", "cup", "--out", "x", "--threads=-1", code=2, says="--threads")
        self.refused("synth", "cup", "--out", "x", "--faces", "12", code=2, says=["--faces", "500"])
        self.assertFalse((self.folder / "x").exists())

    def test_evaluate_needs_lists_or_a_protocol(self):
        self.refused("label", "evaluate", "--out", "x", code=2, says=["--train", "--protocol"])
        self.refused("label", "evaluate", "--out", "x", "--protocol", "sb6", code=2, says="folder")
        self.refused("label", "evaluate", "--out", "x", "--protocol", "sb7", ".", code=2, says="sb6")
        self.refused("label", "evaluate", "--out", "x", "--protocol", "sb6", ".", "--train", "a", code=2, says="--train")

    def test_evaluate_needs_both_of_a_pair_and_a_place_for_its_results(self):
        self.refused("label", "evaluate", "--out", "x", "--train-on", ".", code=2, says=["--train-on", "--test-on"])
        self.refused("label", "evaluate", "--out", "x", "--train-on", ".", "--test", ".", code=2, says="--test")
        self.refused("label", "evaluate", "--out", "x", "--train", ".", "--test", ".", "--labels", "no", code=1, says="no")
        self.refused("label", "evaluate", "--train", ".", "--test", ".", code=2, says=["--out", "--report"])
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        self.refused("label", "evaluate", "--train", "cube.off", "--test", "cube.off", "--report", "cube.off", code=2,
                     says="cube.off")

    def test_outputs_that_cannot_be_written_are_refused_before_the_work(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        (self.folder / "taken").mkdir(exist_ok=True)
        self.refused("features", "cube.off", "--out", "taken", code=2, says="taken: is a folder")
        self.refused("features", "cube.off", "--out", "cube.off/x.npy", code=2, says="no folder")
        self.refused("features", "cube.off", "--out", "x.npy", "--json", "taken", code=2, says="taken: is a folder")
        self.refused("synth", "cup", "--out", "cube.off", code=2, says="cube.off")
        self.refused("label", "train", "cube.off", "--out", "taken", code=2, says="taken: is a folder")
        self.assertFalse((self.folder / "x.npy").exists())

    def test_unknown_device_is_one_line(self):
        self.refused("devices", "--device", "no such device", code=1, says="'no such device'")


class Lists(ProgramTest):
    """Lists are read before a device is opened, so a wrong one shows without Vulkan."""

    def test_missing_mesh_names_list_and_line(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        (self.folder / "list.txt").write_text("# two meshes\n\ncube.off\nmissing.off\n")
        self.refused("label", "train", "list.txt", "--out", "m", code=1, says=["list.txt:4:", "missing.off"])

    def test_bad_mesh_names_file_and_line(self):
        (self.folder / "bad.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
        (self.folder / "bad_labels.txt").write_text("a\n1\n")
        (self.folder / "bad.txt").write_text("bad.off\n")
        self.refused("label", "train", "bad.txt", "--out", "m", code=1, says=["bad.off:6:"])

    def test_mesh_without_labels_says_what_is_accepted(self):
        write_off(self.folder / "bare.off", CUBE, CUBE_QUADS)
        self.refused("label", "train", "bare.off", "--out", "m", code=1, says=["bare_labels.txt", "PLY"])

    def test_wrong_labels_name_file_and_line(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        for content, line in [("a\n1 2 3 4 5 6 7\n", 2), ("a\n1 2 3\nb\n3 4 5 6\n", 4), ("a\n1 2 x\n", 2)]:
            (self.folder / "cube_labels.txt").write_text(content)
            self.refused("label", "train", "cube.off", "--out", "m", code=1, says=f"cube_labels.txt:{line}:")

    def test_folder_without_meshes_and_file_that_is_no_list(self):
        (self.folder / "nothing").mkdir()
        self.refused("label", "train", "nothing", "--out", "m", code=1, says=["nothing", "no meshes", ".off"])
        (self.folder / "binary.txt").write_bytes(bytes(range(256)))
        self.refused("label", "train", "binary.txt", "--out", "m", code=1, says=["binary.txt", "list"])


class Models(ProgramTest):
    def setUp(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)

    def refused_model(self, name, says):
        return self.refused("label", "apply", name, "cube.off", "--out", "labeled", code=1, says=[name, *says])

    def write_model(self, name, metadata, cut=None):
        header = json.dumps({"__metadata__": metadata}).encode()
        (self.folder / name).write_bytes((struct.pack("<Q", len(header)) + header)[:cut])

    def test_what_is_no_model_says_what_makes_one(self):
        (self.folder / "empty.st").write_bytes(b"")
        (self.folder / "text.st").write_text("This is a text of some length, no model.\n")
        for name in ["cube.off", "empty.st", "text.st", "."]:
            with self.subTest(name):
                self.refused_model(name, ["is no Exemplar model", "exemplar label train"])

    def test_missing_model_suggests_the_nearest(self):
        self.write_model("human.safetensors", {})
        self.refused_model("humna.safetensors", ["'human.safetensors'"])

    def test_safetensors_of_something_else(self):
        self.write_model("other.st", {"kind": "a language model"})
        self.refused_model("other.st", ["no mesh labeling model", "exemplar label train"])

    def test_truncated_model(self):
        self.write_model("cut.st", {"kind": "exemplar mesh labeling", "format_version": "1"}, cut=40)
        self.refused_model("cut.st", ["truncated"])

    def test_newer_format_asks_for_a_newer_program(self):
        self.write_model("new.st", {"kind": "exemplar mesh labeling", "format_version": "999"})
        self.refused_model("new.st", ["999", "newer Exemplar"])


class Synth(ProgramTest):
    def test_files_labels_and_report(self):
        self.call("synth", "cup", "--count", "2", "--faces", "500", "--seed", "7", "--out", "cups", "--json", "s.json")
        report = json.loads((self.folder / "s.json").read_text())
        self.assertEqual([shape["name"] for shape in report["shapes"]], ["cup_007", "cup_008"])
        for shape in report["shapes"]:
            vertices, faces = read_off(self.folder / "cups" / f"{shape['name']}.off")
            self.assertEqual((len(vertices), len(faces)), (shape["vertices"], shape["faces"]))
            labels = read_labels(self.folder / "cups" / f"{shape['name']}_labels.txt")
            self.assertEqual(set(labels), {"body", "handle"})
            self.assertEqual(sorted(sum(labels.values(), [])), list(range(1, len(faces) + 1)))

    def test_animations_and_their_options(self):
        size = ["--vertices", "1000", "--frames", "4"]
        self.call("synth", "face", *size, "--count", "2", "--out", "moving", "--json", "m.json")
        report = json.loads((self.folder / "m.json").read_text())
        self.assertEqual([made["name"] for made in report["animations"]], ["face_001", "face_002"])
        self.assertEqual([made["frames"] for made in report["animations"]], [4, 4])
        self.assertEqual((self.folder / "moving" / "face_001.glb").read_bytes()[:4], b"glTF")
        self.call("synth", "flag", *size, "--out", "moving")
        self.assertEqual(len(list((self.folder / "moving" / "flag_001").glob("*.ply"))), 5)  # and the rest shape
        self.refused("synth", "figre", "--out", "x", code=2, says=["'figre'", "'figure'", "cup"])
        self.refused("synth", "face", "--faces", "900", "--out", "x", code=2, says="--faces")
        self.refused("synth", "cup", "--frames", "9", "--out", "x", code=2, says="--frames")

    def test_equal_seeds_give_equal_files_and_others_do_not(self):
        for out, seed in [("a", 3), ("b", 3), ("c", 4)]:
            self.call("synth", "cup", "--faces", "500", "--seed", seed, "--out", out)
        first = (self.folder / "a" / "cup_003.off").read_bytes()
        self.assertEqual(first, (self.folder / "b" / "cup_003.off").read_bytes())
        self.assertNotEqual(first, (self.folder / "c" / "cup_004.off").read_bytes())

    def test_quiet_and_the_progress_of_a_pipe(self):
        loud = self.call("synth", "cup", "--faces", "500", "--out", "p")
        self.assertRegex(loud.stderr, r"^generating cup: 1 in [\d.]+ s\n$")  # no control characters
        self.assertEqual(self.call("synth", "cup", "--faces", "500", "--out", "p", "--quiet").stderr, "")


class Features(ProgramTest):
    def read_npy(self, name):
        """Shape and little-endian float32 values of a NumPy file."""
        content = (self.folder / name).read_bytes()
        self.assertEqual(content[:8], b"\x93NUMPY\x01\x00")
        size = struct.unpack("<H", content[8:10])[0]
        header = eval(content[10:10 + size], {"__builtins__": {}})  # a dict literal, by the format's definition
        self.assertEqual((header["descr"], header["fortran_order"]), ("<f4", False))
        data = content[10 + size:]
        return header["shape"], struct.unpack(f"<{len(data) // 4}f", data)

    def test_array_names_and_report(self):
        write_off(self.folder / "cube with spaces.off", CUBE, CUBE_TRIANGLES)
        self.call("features", "cube with spaces.off", "--out", "new folder/f.npy", "--names", "n.json", "--json",
                  "r.json", "--samples", "20")
        shape, values = self.read_npy("new folder/f.npy")
        names = json.loads((self.folder / "n.json").read_text())
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(shape, (12, len(names)))
        self.assertEqual(len(values), shape[0] * shape[1])
        self.assertTrue(all(abs(value) < 1e6 for value in values))
        self.assertEqual((report["rows"], report["features"], report["names"]), (12, len(names), names))

    def test_pairwise_has_a_row_per_edge(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_TRIANGLES)
        self.call("features", "cube.off", "--out", "p.npy", "--pairwise", "--samples", "20")
        self.assertEqual(self.read_npy("p.npy")[0][0], 18)

    def test_unusable_meshes_are_refused_in_one_line(self):
        write_off(self.folder / "empty.off", [], [])
        write_off(self.folder / "points.off", CUBE, [])
        write_off(self.folder / "nan.off", [("nan", 0, 0), *CUBE[1:]], CUBE_TRIANGLES)
        write_off(self.folder / "range.off", CUBE, [(0, 1, 99)])
        (self.folder / "garbage.off").write_bytes(bytes(range(1, 256)))
        (self.folder / "cut.ply").write_bytes(b"ply\nformat binary_little_endian 1.0\nelement vertex 9\n")
        (self.folder / "mesh.xyz").write_text("0 0 0\n")
        (self.folder / "folder.off").mkdir()
        for name in ["empty.off", "points.off", "nan.off", "range.off", "garbage.off", "cut.ply", "mesh.xyz", "folder.off"]:
            with self.subTest(name):
                self.refused("features", name, "--out", "x.npy", code=1, says=name)
                self.assertFalse((self.folder / "x.npy").exists())


if __name__ == "__main__":
    unittest.main()

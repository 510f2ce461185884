"""Training, labeling and damaging on tiny generated shapes. Needs a Vulkan device (a software one will do)."""

import json
import os
import re
import shutil
import struct
import unittest
import zlib

from program import (TRUTH, WithModel, CUBE, CUBE_QUADS, CUBE_TRIANGLES, QUICK, read_labels, read_off, write_off)


class Train(WithModel):
    def train(self, source, out, *options):
        self.call("label", "train", source, "--out", out, *QUICK, *options)
        return (self.folder / out).read_bytes()

    def test_equal_seeds_give_equal_models_for_any_cache_and_threads(self):
        first = (self.folder / "cup.safetensors").read_bytes()
        self.assertEqual(self.train("cups", "again", "--cache", "", "--threads", "1"), first)
        self.assertNotEqual(self.train("cups", "other", "--seed", "2"), first)

    def test_progress_of_a_pipe_has_no_control_characters(self):
        self.assertIn("training unary 0", self.trained.stderr)
        for line in self.trained.stderr.splitlines():
            self.assertTrue(line.isprintable(), repr(line))

    def test_lists_may_be_commented_relative_and_from_windows(self):
        spaced = self.folder / "my shapes"
        shutil.copytree(self.folder / "cups", spaced)
        lines = ["# relative to the list", "", "  cup_001.off  ", "cup_002.off # the second", str(spaced / "cup_003.off")]
        (spaced / "list.txt").write_bytes("\r\n".join(lines).encode())
        self.assertEqual(self.train("my shapes/list.txt", "listed"), (self.folder / "cup.safetensors").read_bytes())

    def test_several_sources_are_one_set_and_labels_may_lie_elsewhere(self):
        bare, style = self.folder / "bare", self.folder / "labels only"
        bare.mkdir(), style.mkdir()
        for k in (1, 2, 3):
            shutil.copy(self.folder / "cups" / f"cup_00{k}.off", bare)
            shutil.copy(self.folder / "cups" / f"cup_00{k}_labels.txt", style)
        self.call("label", "train", "bare/cup_001.off", "bare", "bare/", "--labels", "labels only", "--out", "united", *QUICK)
        self.assertEqual((self.folder / "united").read_bytes(), (self.folder / "cup.safetensors").read_bytes())
        self.refused("label", "train", "bare", "--labels", "none", "--out", "x", *QUICK, code=1, says="none")

    def test_labels_in_a_ply_are_those_beside_a_mesh(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "labeled")
        within, beside = self.folder / "within", self.folder / "beside"
        within.mkdir(), beside.mkdir()
        for ply in (self.folder / "labeled").glob("*.ply"):
            shutil.copy(ply, within)
            shutil.copy(self.folder / "cups" / f"{ply.stem}.off", beside)
            shutil.copy(ply.with_name(f"{ply.stem}_labels.txt"), beside)
        self.assertEqual(self.train("within", "from_ply"), self.train("beside", "from_text"))

    def test_stumps_may_stay_alone(self):
        pooled = self.train("cups", "pooled", "--json", "pooled.json")
        alone = self.train("cups", "alone", "--no-linear", "--json", "alone.json")
        self.assertIn(b"linear.0.weight", pooled)
        self.assertNotIn(b"linear.0.weight", alone)
        stages = {name: json.loads((self.folder / f"{name}.json").read_text())["classifiers"] for name in ("pooled", "alone")}
        self.assertLess(stages["pooled"][0]["validation_loss"], stages["pooled"][0]["stumps_loss"])
        for stage in stages["alone"]:
            self.assertEqual(stage["validation_loss"], stage["stumps_loss"])
        self.call("label", "apply", "alone", self.cup, "--out", "by_stumps")

    def test_borders_may_be_left_to_length_and_angle(self):
        self.assertIn(b"pairwise.0.", self.train("cups", "with_boundary"))
        self.assertNotIn(b"pairwise.0.", self.train("cups", "without_boundary", "--no-boundary", "--json", "plain.json"))
        stages = [stage["classifier"] for stage in self.json("plain.json")["classifiers"]]
        self.assertTrue(all(stage.startswith("unary") for stage in stages), stages)
        self.call("label", "apply", "without_boundary", self.cup, "--out", "plain")

    def test_the_model_does_not_depend_on_memory(self):
        self.assertEqual(self.train("cups", "little", "--feature-memory", "0"), self.train("cups", "much", "--feature-memory", "9"))

    def test_one_mesh_is_enough_and_one_label_is_not(self):
        self.train(self.cup, "one")
        single = self.folder / "single"
        single.mkdir()
        shutil.copy(self.cup, single)
        _, faces = read_off(self.cup)
        (single / "cup_001_labels.txt").write_text(f"all\n{' '.join(str(i + 1) for i in range(len(faces)))}\n")
        self.refused("label", "train", "single", "--out", "x", *QUICK, code=1, says="labels")


class Apply(WithModel):
    def parse_ply(self, path):
        """Label names of the header, and (label, confidence) per face."""
        head, body = path.read_bytes().split(b"end_header\n", 1)
        head = head.decode()
        self.assertIn("format binary_little_endian 1.0", head)
        vertices, faces = (int(re.search(rf"element {kind} (\d+)", head)[1]) for kind in ("vertex", "face"))
        face_properties = head[head.index("element face"):]
        self.assertEqual(re.findall(r"property (\w+) (?:\w+ \w+ )?(\w+)", face_properties),
                         [("list", "vertex_indices"), ("int", "label"), ("uchar", "red"), ("uchar", "green"),
                          ("uchar", "blue"), ("float", "confidence")])
        row = struct.Struct("<B3iiBBBf")
        self.assertEqual(len(body), 12 * vertices + row.size * faces)
        rows = [row.unpack_from(body, 12 * vertices + row.size * i) for i in range(faces)]
        return re.findall(r"comment label \d+ (\w+)", head), [(values[4], values[8]) for values in rows]

    def parse_glb(self, path):
        """(material name, color, number of indices) of each primitive."""
        content = path.read_bytes()
        magic, version, length, json_length = struct.unpack_from("<4s3I", content)
        self.assertEqual((magic, version, length), (b"glTF", 2, len(content)))
        scene = json.loads(content[20:20 + json_length])
        primitives = [p for mesh in scene["meshes"] for p in mesh["primitives"]]
        used = [scene["materials"][p["material"]] for p in primitives]
        return [(material["name"], tuple(material["pbrMetallicRoughness"]["baseColorFactor"]),
                 scene["accessors"][p["indices"]]["count"]) for material, p in zip(used, primitives)]

    def picture_colors(self, path):
        """The distinct RGB(A) values of an 8-bit PNG whose scan lines are not interlaced."""
        content = path.read_bytes()
        self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
        width, height, depth, kind = struct.unpack(">IIBB", content[16:26])
        self.assertEqual(depth, 8)
        chunks, at = b"", 8
        while at < len(content):
            size, name = struct.unpack_from(">I4s", content, at)
            if name == b"IDAT":
                chunks += content[at + 8:at + 8 + size]
            at += 12 + size
        lines, step = zlib.decompress(chunks), {2: 3, 6: 4}[kind]
        self.assertEqual(len(lines), height * (1 + width * step))
        return {lines[i:i + step] for i in range(1, len(lines) - step, step)}

    def test_every_file_of_a_mesh(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "all", "--gltf", "--png", "--json", "all.json")
        report = self.json("all.json")
        self.assertEqual(len(report["meshes"]), 3)
        for entry in report["meshes"]:
            stem = self.folder / "all" / os.path.basename(entry["mesh"])[:-len(".off")]
            _, faces = read_off(self.folder / entry["mesh"])
            labels = read_labels(stem.with_name(stem.name + "_labels.txt"))
            self.assertEqual(sorted(sum(labels.values(), [])), list(range(1, len(faces) + 1)))
            names, rows = self.parse_ply(stem.with_suffix(".ply"))
            by_ply = {name: [i + 1 for i, (label, _) in enumerate(rows) if label == c] for c, name in enumerate(names)}
            self.assertEqual({name: found for name, found in by_ply.items() if found}, labels)
            self.assertTrue(all(0 <= confidence <= 1 for _, confidence in rows))
            segments = list(map(int, stem.with_suffix(".seg").read_text().split()))
            self.assertEqual(len(segments), len(faces))
            self.assertEqual(set(segments), set(range(max(segments) + 1)))
            parts = self.parse_glb(stem.with_suffix(".glb"))
            self.assertEqual({name: count // 3 for name, _, count in parts}, {n: len(f) for n, f in labels.items()})
            self.assertEqual(len({color for _, color, _ in parts}), len(parts))
            self.assertGreater(len(self.picture_colors(stem.with_suffix(".png"))), 50)
            self.assertEqual({part["label"]: part["triangles"] for part in entry["labels"]},
                             {name: len(found) for name, found in labels.items()})
            self.assertAlmostEqual(sum(part["area_share"] for part in entry["labels"]), 1, places=4)

    def test_training_shapes_are_mostly_recognized(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "known")
        for name in ["cup_001", "cup_002", "cup_003"]:
            truth = read_labels(self.folder / "cups" / f"{name}_labels.txt")
            found = read_labels(self.folder / "known" / f"{name}_labels.txt")
            right = sum(len(set(truth[label]) & set(found.get(label, []))) for label in TRUTH)
            self.assertGreater(right, 0.9 * sum(map(len, truth.values())))

    def test_optional_files_are_optional(self):
        self.call("label", "apply", "cup.safetensors", self.cup, "--out", "plain")
        self.assertEqual(sorted(path.name for path in (self.folder / "plain").iterdir()),
                         ["cup_001.ply", "cup_001.seg", "cup_001_labels.txt"])

    def test_polygons_keep_their_faces(self):
        write_off(self.folder / "quads.off", CUBE, CUBE_QUADS)
        self.call("label", "apply", "cup.safetensors", "quads.off", "--out", "polygons")
        labels = read_labels(self.folder / "polygons" / "quads_labels.txt")
        self.assertEqual(sorted(sum(labels.values(), [])), [1, 2, 3, 4, 5, 6])
        self.assertEqual(len((self.folder / "polygons" / "quads.seg").read_text().split()), 6)

    def test_messy_meshes_are_labeled_with_a_warning(self):
        second = [(x + 3, y, z) for x, y, z in CUBE]
        cases = {
            "nonmanifold": (CUBE + [(2, 2, 2)], CUBE_TRIANGLES + [(0, 1, 8)], "more than two faces"),
            "flipped": (CUBE, [t[::-1] if i % 2 else t for i, t in enumerate(CUBE_TRIANGLES)], "orientation"),
            "flat": (CUBE + [(0.5, 0, 0)], CUBE_TRIANGLES + [(0, 8, 1)], "without area"),
            "two": (CUBE + second, CUBE_TRIANGLES + [tuple(v + 8 for v in t) for t in CUBE_TRIANGLES], "components"),
            "open": (CUBE, CUBE_TRIANGLES[:6], "boundary"),
            "single": (CUBE[:3], [(0, 1, 2)], "boundary"),
            "point": ([CUBE[0]] * 3, [(0, 1, 2)], "without area"),
            "repeated": (CUBE, CUBE_TRIANGLES + [(0, 0, 1)], "without area"),
            "loose": (CUBE + [(9, 9, 9)], CUBE_TRIANGLES, "vert"),
        }
        for name, (vertices, faces, warning) in cases.items():
            with self.subTest(name):
                write_off(self.folder / f"{name}.off", vertices, faces)
                result = self.call("label", "apply", "cup.safetensors", f"{name}.off", "--out", "messy", "--json", "m.json",
                                   "--gltf", "--png")
                self.assertIn(f"warning: {name}.off: ", result.stderr)
                self.assertIn(warning, " ".join(self.json("m.json")["meshes"][0]["warnings"]))
                labels = read_labels(self.folder / "messy" / f"{name}_labels.txt")
                self.assertEqual(sorted(sum(labels.values(), [])), list(range(1, len(faces) + 1)))

    def test_unusable_mesh_is_refused_in_one_line(self):
        write_off(self.folder / "nan.off", [("nan", 0, 0), *CUBE[1:]], CUBE_TRIANGLES)
        self.refused("label", "apply", "cup.safetensors", "nan.off", "--out", "none", code=1, says="nan.off")
        self.assertEqual(list(self.folder.glob("none/*")), [])

    def refused_file(self, name, content, says):
        (self.folder / name).write_bytes(content)
        error = self.refused("label", "apply", "cup.safetensors", name, "--out", "none", code=1, says=says)
        self.assertTrue(error.startswith(f"error: {name}"), error)
        self.assertEqual(list(self.folder.glob("none/*")), [])

    def test_empty_files_say_so(self):
        for kind in ["off", "obj", "ply", "stl", "gltf", "glb"]:
            for content in [b"", b"\n \r\n"]:
                with self.subTest(kind=kind, content=content):
                    self.refused_file(f"nothing.{kind}", content, ["the file is empty", "again"])
        self.refused_file("nothing.stl", b"solid nothing\nendsolid nothing\n", ["no faces", "again"])
        self.refused_file("nothing.gltf", b'{"asset": {"version": "2.0"}}', ["no node", "export"])

    def test_point_clouds_say_so(self):
        points = b"0 0 0\n1 0 0\n0 1 0\n"
        ply = b"ply\nformat ascii 1.0\nelement vertex 3\n" + b"".join(b"property float %c\n" % c for c in b"xyz")
        files = {
            "without.ply": ply + b"end_header\n" + points,
            "zero.ply": ply + b"element face 0\nproperty list uchar int vertex_indices\nend_header\n" + points,
            "points.obj": b"".join(b"v " + line + b"\n" for line in points.splitlines()),
            "points.off": b"OFF\n3 0 0\n" + points,
        }
        for name, content in files.items():
            with self.subTest(name):
                self.refused_file(name, content, ["3 points and no faces", "point cloud", "surface"])

    def test_one_bad_mesh_does_not_stop_the_others(self):
        many = self.folder / "many"
        shutil.copytree(self.folder / "cups", many)
        (many / "a_bad.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
        result = self.call("label", "apply", "cup.safetensors", "many", "--out", "rest", "--json", "rest.json", code=1)
        self.assertIn("3 of 4 meshes labeled", result.stdout)
        errors = [line for line in result.stderr.splitlines() if line.startswith("error: ")]
        self.assertIn("a_bad.off:6:", errors[0])
        self.assertIn("1 of 4", errors[1])
        self.assertEqual(len(list((self.folder / "rest").glob("*_labels.txt"))), 3)
        self.assertEqual([("error" in entry) for entry in self.json("rest.json")["meshes"]], [True, False, False, False])

    def test_labels_beside_the_meshes_are_not_replaced(self):
        for out in ["cups", "./cups/", "cups/../cups"]:
            self.refused("label", "apply", "cup.safetensors", "cups", "--out", out, code=2, says=["cup_001.off", "another folder"])

    def test_small_pieces_can_be_kept(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "kept", "--keep-small")
        self.assertEqual(len(list((self.folder / "kept").glob("*_labels.txt"))), 3)

    def test_two_meshes_of_one_name_are_refused(self):
        self.refused("label", "apply", "cup.safetensors", "cups", self.cup, "--out", "x", code=2, says="cup_001.off")

    def test_damaged_models_are_refused(self):
        model = (self.folder / "cup.safetensors").read_bytes()
        for length in [len(model) - 1, len(model) // 2, 2000, 12]:
            (self.folder / "cut.safetensors").write_bytes(model[:length])
            self.refused("label", "apply", "cut.safetensors", self.cup, "--out", "x", code=1, says="cut.safetensors: damaged")
        newer = model.replace(b'"format_version":"', b'"format_version":"9', 1)
        header = struct.unpack("<Q", model[:8])[0] + 1
        (self.folder / "new.safetensors").write_bytes(struct.pack("<Q", header) + newer[8:])
        self.refused("label", "apply", "new.safetensors", self.cup, "--out", "x", code=1, says="newer Exemplar")
        self.assertFalse((self.folder / "x").exists())

    def test_unwritable_cache_is_a_warning(self):
        result = self.call("label", "apply", "cup.safetensors", self.cup, "--out", "y", "--cache", self.cup)
        self.assertIn("warning: features are not remembered", result.stderr)


class Stress(WithModel):
    NAMES = ["holes", "rotated", "unwelded"]

    def test_a_row_per_damage(self):
        write_off(self.folder / "unlabeled.off", *read_off(self.cup))
        result = self.call("label", "stress", "cup.safetensors", self.cup, "unlabeled.off", "--damage", *self.NAMES, "--json",
                           "stress.json", "--out", "stressed")
        rows = self.json("stress.json")["damages"]
        self.assertEqual([row["damage"] for row in rows], ["undamaged", *self.NAMES])
        for row in rows:
            self.assertRegex(result.stdout, rf"\n{row['damage']} +{100 * row['unchanged_mean']:.1f} % ")
            labeled, unlabeled = row["meshes"]
            self.assertEqual(row["unchanged_worst"], min(mesh["unchanged"] for mesh in row["meshes"]))
            self.assertAlmostEqual(row["unchanged_mean"], (labeled["unchanged"] + unlabeled["unchanged"]) / 2)
            self.assertEqual(labeled["unchanged"], unlabeled["unchanged"], "the same mesh, the same damage")
            self.assertEqual(row["recognition_rate"], labeled["recognition_rate"])
            self.assertEqual(row["recognition_rate_before"], rows[0]["recognition_rate"])
            self.assertNotIn("recognition_rate", unlabeled)
            for stem in ["cup_001", "unlabeled"]:
                for suffix in [".ply", ".png"]:
                    self.assertTrue((self.folder / "stressed" / f"{stem}-{row['damage']}{suffix}").exists())
        undamaged, holes, rotated, unwelded = rows
        self.assertEqual(undamaged["unchanged_mean"], 1)
        self.assertGreater(rotated["unchanged_mean"], 0.98)
        self.assertLess(holes["meshes"][0]["faces"], undamaged["meshes"][0]["faces"])
        self.assertIn("boundary", " ".join(holes["meshes"][0]["warnings"]))
        self.assertIn("joined", " ".join(unwelded["meshes"][0]["warnings"]))

    def test_equal_seeds_damage_equally(self):
        def rates(seed):
            self.call("label", "stress", "cup.safetensors", self.cup, "--damage", "holes", "--seed", seed, "--json", "s.json")
            return [row["meshes"][0]["faces"] for row in self.json("s.json")["damages"]], [
                row["recognition_rate"] for row in self.json("s.json")["damages"]]

        self.assertEqual(rates(3), rates(3))

    def test_wrong_arguments_are_refused_before_any_work(self):
        self.refused("label", "stress", "cup.safetensors", self.cup, "--damage", "hole", code=2, says=["'hole'", "'holes'"])
        self.refused("label", "stress", self.cup, self.cup, code=1, says=["cup_001.off", "is no Exemplar model"])
        self.refused("label", "stress", "cup.safetensors", "cup.off", code=1, says="cup.off: no such file")
        write_off(self.folder / "cloud.off", CUBE, [])
        self.refused("label", "stress", "cup.safetensors", self.cup, "cloud.off", code=1, says=["cloud.off: 8 points", "surface"])
        shutil.copytree(self.folder / "cups", self.folder / "twins")
        self.refused("label", "stress", "cup.safetensors", "twins", "cups", "--out", "x", code=2, says="cup_001.off")


if __name__ == "__main__":
    unittest.main()

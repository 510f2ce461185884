"""Train, apply and evaluate end to end on tiny generated shapes. Needs a Vulkan device (a software one will do)."""

import json
import os
import re
import shutil
import struct
import unittest
import zlib

from program import (DOCS, QUICK, ProgramTest, CUBE, CUBE_QUADS, CUBE_TRIANGLES, read_labels, read_off, write_off)

TRUTH = ("body", "handle")
SEGMENT_RATES = ["rand_error", "cut_discrepancy", "hamming_distance", "missing_rate", "false_alarm_rate",
                 "global_consistency_error", "local_consistency_error"]


class WithModel(ProgramTest):
    """Three cups and a model trained on them."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "cup", "--count", "3", "--faces", "500", "--out", "cups")
        cls.trained = cls.call("label", "train", "cups", "--out", "cup.safetensors", "--json", "train.json", *QUICK)
        cls.cup = cls.folder / "cups" / "cup_001.off"

    def json(self, name):
        return json.loads((self.folder / name).read_text())


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
        self.refused_file("nothing.gltf", b'{"asset": {"version": "2.0"}}', ["no faces", "again"])

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
        self.assertIn("components", " ".join(unwelded["meshes"][0]["warnings"]))

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


class Evaluate(WithModel):
    def evaluate(self, out, *options, code=0):
        return self.call("label", "evaluate", "--train", "cups", "--test", "cups", "--out", out, *QUICK, *options, code=code)

    def test_files_and_figures(self):
        self.evaluate("report", "--json", "e.json")
        report = self.json("e.json")
        self.assertEqual(report, self.json("report/report.json"))
        meshes = report["categories"][0]["splits"][0]["meshes"]
        for entry in meshes:
            stem = self.folder / "report" / "cups" / "lists" / entry["mesh"]
            for suffix in ["_labels.txt", ".ply", ".json"]:
                self.assertTrue(stem.with_name(stem.name + suffix).exists())
            found = read_labels(stem.with_name(stem.name + "_labels.txt"))
            right, total = self.right_area(entry["path"], found)
            self.assertAlmostEqual(entry["recognition_rate"], right / total, places=4)
            count = len(entry["names"])
            self.assertAlmostEqual(sum(entry["confusion"][i * count + i] for i in range(count)), right / total, places=4)
        mean = sum(entry["recognition_rate"] for entry in meshes) / len(meshes)
        self.assertAlmostEqual(report["recognition_rate"], mean)
        page = (self.folder / "report" / "index.html").read_text()
        self.assertTrue(page.startswith("<!DOCTYPE html>"))
        self.assertNotRegex(page, r"""(?:src|href|url)\s*[=(]\s*["']?\s*(?:https?:)?//""")

    def right_area(self, path, found, rated=TRUTH):
        """Area labeled right, and all area, of the faces whose true label is rated, computed from the files."""
        vertices, faces = read_off(self.folder / path)
        truth = read_labels((self.folder / path).with_name(os.path.basename(path)[:-4] + "_labels.txt"))
        right = total = 0.0
        for i, (a, b, c) in enumerate(faces, 1):
            u, v = ([q - p for p, q in zip(vertices[a], vertices[w])] for w in (b, c))
            cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            area = sum(x * x for x in cross) ** 0.5 / 2 * any(i in truth.get(label, ()) for label in rated)
            total += area
            right += area * any(i in truth[label] and i in found.get(label, ()) for label in truth)
        return right, total

    def test_confusion_and_chosen_features_of_a_category(self):
        printed = self.evaluate("summary", "--json", "s.json").stdout
        report = self.json("s.json")
        category = report["categories"][0]
        meshes = category["splits"][0]["meshes"]
        self.assertEqual(category["names"], list(TRUTH))
        for i, share in enumerate(category["confusion"]):
            self.assertAlmostEqual(share, sum(mesh["confusion"][i] for mesh in meshes) / len(meshes))
        areas = [pair["area_share"] for pair in category["confused"]]
        self.assertEqual(sorted(areas, reverse=True), areas)
        for pair in category["confused"]:
            t, p = category["names"].index(pair["truth"]), category["names"].index(pair["predicted"])
            self.assertAlmostEqual(pair["area_share"], category["confusion"][2 * t + p])
            self.assertAlmostEqual(pair["label_share"], pair["area_share"] / sum(category["confusion"][2 * t:2 * t + 2]))
        run = self.json("summary/cups/lists/run.json")
        count = {}
        for stage in report["features"]:
            self.assertAlmostEqual(sum(stage["share_per_family"].values()), 1)
            for family, share in stage["share_per_family"].items():
                count[family] = count.get(family, 0) + share * stage["stumps"]
                self.assertIn(family, printed)
        self.assertEqual({family: round(stumps) for family, stumps in count.items()}, run["stumps_per_family"])
        self.assertEqual(category["splits"][0]["training"]["classifiers"], run["classifiers"])

    def test_segments_that_people_made_too_have_no_error(self):
        self.evaluate("agreed")
        self.call("label", "apply", "agreed/cups/lists/model.safetensors", "cups", "--out", "applied")
        people = self.folder / "agreeing"
        for name in ["cup_001", "cup_002"]:
            (people / name).mkdir(parents=True)
            shutil.copy(self.folder / "applied" / f"{name}.seg", people / name / "1.seg")
        result = self.evaluate("agreed", "--humans", "agreeing", "--json", "agreed.json")
        for column in ["RI err", "CD", "HD", "GCE", "LCE"]:
            self.assertIn(column, result.stdout)
        category = self.json("agreed.json")["categories"][0]
        first, second, third = category["splits"][0]["meshes"]
        for rate in SEGMENT_RATES:
            self.assertAlmostEqual(first[rate], 0)
            self.assertAlmostEqual(second[rate], 0)
            self.assertIsNone(third[rate])
            self.assertAlmostEqual(category[rate], 0)

    def test_categories_of_the_benchmark_are_set_beside_the_thesis(self):
        shutil.copytree(self.folder / "cups", self.folder / "Cup")
        _, faces = read_off(self.cup)
        people = self.folder / "crowd" / "cup_001"
        people.mkdir(parents=True)
        (people / "1.seg").write_text("0\n" * len(faces))
        call = ["label", "evaluate", "--train", "Cup", "--test", "Cup", "--out", "beside", "--json", "b.json", *QUICK]
        self.assertIn("thesis", self.call(*call, "--humans", "crowd").stdout)
        category = self.json("b.json")["categories"][0]
        self.assertEqual(category["thesis"], {"recognition_rate": 0.963, "rand_error": 0.1})
        self.assertIsNone(category["cut_discrepancy"], "one segment has no cuts")
        # Other meshes of that name are not the benchmark's: these have no human segmentations.
        self.assertNotIn("thesis", self.call(*call).stdout)
        self.assertNotIn("thesis", self.json("b.json")["categories"][0])

    def relabeled(self, name, **names):
        """A copy of the cups whose labels have other names."""
        shutil.copytree(self.folder / "cups", self.folder / name)
        for path in (self.folder / name).glob("*_labels.txt"):
            lines = path.read_text().split("\n")
            path.write_text("\n".join(names.get(line, line) for line in lines))

    def test_another_category_is_rated_by_the_labels_of_both(self):
        self.relabeled("mugs", handle="grip")
        call = ["label", "evaluate", "--train-on", "cups", "--test-on", "mugs", "--out", "other", *QUICK]
        result = self.call(*call, "--json", "other.json")
        self.assertIn("labels that training and test meshes both have: body\n", result.stdout)
        category = self.json("other.json")["categories"][0]
        self.assertEqual(category["category"], "cups-to-mugs")
        self.assertEqual(category["names"], ["body", "handle", "grip"])
        split = category["splits"][0]
        self.assertEqual(split["shared_labels"], ["body"])
        for entry in split["meshes"]:
            found = read_labels(self.folder / "other" / "cups-to-mugs" / "category" / f"{entry['mesh']}_labels.txt")
            right, total = self.right_area(entry["path"], found, rated=["body"])
            self.assertAlmostEqual(entry["recognition_rate"], right / total, places=4)
            self.assertAlmostEqual(entry["segment_weighted_accuracy"], right / total, places=4)
            grip_as_handle = entry["confusion"][2 * 3 + 1]
            self.assertGreater(grip_as_handle, 0.5 * sum(entry["confusion"][6:9]))
        self.assertTrue((self.folder / "other" / "index.html").exists())
        # The same labels rated as of one category count what the model cannot name as wrong.
        self.call("label", "evaluate", "--train", "cups", "--test", "mugs", "--out", "same", "--json", "same.json", *QUICK)
        self.assertLess(self.json("same.json")["recognition_rate"], category["recognition_rate"])

    def test_categories_without_a_common_label_are_compared_by_segments(self):
        self.relabeled("jars", handle="grip", body="hull")
        (self.folder / "strangers" / "cup_001").mkdir(parents=True)
        _, faces = read_off(self.cup)
        (self.folder / "strangers" / "cup_001" / "1.seg").write_text(
            "".join(f"{int(i > 100)}\n" for i in range(len(faces))))
        result = self.call("label", "evaluate", "--train-on", "cups", "--test-on", "jars", "--humans", "strangers", "--out",
                           "foreign", "--json", "foreign.json", *QUICK)
        self.assertIn("no label name in common", result.stdout)
        self.assertNotIn("count as wrong", result.stderr)
        report = self.json("foreign.json")
        self.assertEqual(report["categories"][0]["splits"][0]["shared_labels"], [])
        self.assertIsNone(report["recognition_rate"])
        self.assertIsNone(report["segment_weighted_accuracy"])
        self.assertGreater(report["rand_error"], 0)
        for name in ["cup_001", "cup_002", "cup_003"]:
            labels = read_labels(self.folder / "foreign" / "cups-to-jars" / "category" / f"{name}_labels.txt")
            self.assertLessEqual(set(labels), set(TRUTH))

    def test_merged_sets_share_labels_of_equal_names(self):
        self.relabeled("pots", handle="grip")
        for options in [["--train", "cups", "pots"], ["--train", "cups", "--train", "pots"]]:
            result = self.call("label", "evaluate", *options, "--test", "cups", "--out", "merged", "--json", "m.json", *QUICK)
        self.assertRegex(result.stdout, r"\n +body  cups, pots\n +grip  pots\n +handle  cups\n")
        split = self.json("m.json")["categories"][0]["splits"][0]
        self.assertEqual(self.json("m.json")["categories"][0]["category"], "cups+pots")
        self.assertEqual(split["train"], 2 * ["cup_001", "cup_002", "cup_003"])
        self.assertEqual(split["training"]["labels"], ["body", "grip", "handle"])
        self.assertEqual(split["merged_labels"],
                         [{"label": "body", "sources": ["cups", "pots"]}, {"label": "grip", "sources": ["pots"]},
                          {"label": "handle", "sources": ["cups"]}])
        self.call("label", "evaluate", "--train", "cups", "cups/", self.cup, "--test", "cups", "--out", "once", "--json",
                  "o.json", *QUICK)
        self.assertEqual(len(self.json("o.json")["categories"][0]["splits"][0]["train"]), 3, "each mesh once")

    def test_labels_of_another_style(self):
        self.relabeled("renaming", body="hull", handle="knob")
        style = self.folder / "style"
        style.mkdir()
        for path in (self.folder / "renaming").glob("*_labels.txt"):
            shutil.move(path, style)
        self.evaluate("styled", "--labels", "style", "--json", "styled.json")
        report = self.json("styled.json")
        self.assertEqual(report["categories"][0]["names"], ["hull", "knob"])
        self.evaluate("plain", "--json", "plain.json")
        self.assertEqual(report["recognition_rate"], self.json("plain.json")["recognition_rate"])
        # Other labels are another run, whose results are not taken over.
        self.evaluate("styled", "--json", "styled.json")
        self.assertEqual(self.json("styled.json")["categories"][0]["names"], list(TRUTH))
        (style / "cup_002_labels.txt").unlink()
        self.refused("label", "evaluate", "--train", "cups", "--test", "cups", "--labels", "style", "--out", "x", *QUICK,
                     code=1, says=["cup_002_labels.txt", "cup_002.off"])

    def test_the_page_can_be_all_that_is_kept(self):
        scratch = self.folder / "scratch"
        scratch.mkdir()
        with_scratch = dict(self.environment, TMPDIR=str(scratch))
        self.addCleanup(setattr, type(self), "environment", self.environment)
        type(self).environment = with_scratch
        self.call("label", "evaluate", "--train", "cups", "--test", "cups", "--report", "page", *QUICK)
        self.assertEqual([path.name for path in (self.folder / "page").iterdir()], ["index.html"])
        self.assertEqual(list(scratch.iterdir()), [])
        self.call("label", "evaluate", "--train", "cups", "--test", "cups", "--report", "page2", "--out", "rest", *QUICK)
        self.assertEqual(sorted(path.name for path in (self.folder / "rest").iterdir()), ["cups", "report.json"])
        self.assertTrue((self.folder / "page2" / "index.html").exists())

    def test_protocol_splits_a_folder(self):
        self.call("label", "evaluate", "--protocol", "sb19", "cups/", "--out", "sb19", "--json", "sb19.json", *QUICK)
        splits = self.json("sb19.json")["categories"][0]["splits"]
        self.assertEqual([split["split"] for split in splits], ["sb19-0", "sb19-1", "sb19-2"])
        for split in splits:
            self.assertEqual(len(split["train"]), 2)
            self.assertNotIn(split["meshes"][0]["mesh"], split["train"])

    def test_another_option_or_mesh_is_no_finished_result(self):
        copy = self.folder / "changing"
        shutil.copytree(self.folder / "cups", copy)
        call = ["label", "evaluate", "--train", "cups", "--test", "changing", "--out", "changed", *QUICK]
        stamp = lambda name: (self.folder / "changed" / "cups" / "lists" / name).stat().st_mtime_ns
        self.call(*call)
        model, first, second = stamp("model.safetensors"), stamp("cup_001.json"), stamp("cup_002.json")
        shutil.copy(copy / "cup_003.off", copy / "cup_001.off")
        shutil.copy(copy / "cup_003_labels.txt", copy / "cup_001_labels.txt")
        self.call(*call)
        self.assertEqual((stamp("model.safetensors"), stamp("cup_002.json")), (model, second))
        self.assertGreater(stamp("cup_001.json"), first)
        self.call(*call, "--seed", "2")
        self.assertGreater(stamp("model.safetensors"), model)
        self.assertGreater(stamp("cup_002.json"), second)
        model = stamp("model.safetensors")
        self.call(*call, "--seed", "2", "--fresh")
        self.assertGreater(stamp("model.safetensors"), model)

    def test_unknown_label_suggests_the_nearest_and_counts_as_wrong(self):
        renamed = self.folder / "renamed"
        shutil.copytree(self.folder / "cups", renamed)
        labels = (renamed / "cup_002_labels.txt").read_text()
        (renamed / "cup_002_labels.txt").write_text(labels.replace("handle", "handel"))
        result = self.call("label", "evaluate", "--train", "cups", "--test", "renamed", "--out", "r", "--json", "r.json", *QUICK)
        self.assertIn("'handel' (did you mean 'handle'?)", result.stderr)
        rates = [mesh["recognition_rate"] for mesh in self.json("r.json")["categories"][0]["splits"][0]["meshes"]]
        self.assertLess(rates[1], min(rates[0], rates[2]))

    def test_meshes_that_were_trained_on_are_named(self):
        self.assertIn("cup_002.off: is among the training meshes", self.evaluate("overlap").stderr)

    def test_human_segmentations_are_per_face_of_the_file(self):
        quads, people = self.folder / "quad_cups", self.folder / "people"
        shutil.copytree(self.folder / "cups", quads)
        vertices, faces = read_off(quads / "cup_001.off")
        a, b, c = faces[0]  # a triangle and what it looks at across an edge, as one quadrilateral
        other = next(i for i, face in enumerate(faces) if i and {a, b} <= set(face))
        d = next(v for v in faces[other] if v not in (a, b))
        rest = [face for i, face in enumerate(faces) if i not in (0, other)]
        lines = [f"OFF\n{len(vertices)} {len(rest) + 1} 0", *(" ".join(map(str, v)) for v in vertices), f"4 {a} {d} {b} {c}",
                 *(" ".join(map(str, (3, *face))) for face in rest)]
        (quads / "cup_001.off").write_text("\n".join(lines) + "\n")
        (quads / "cup_001_labels.txt").write_text("body\n" + " ".join(str(i + 1) for i in range(len(rest) + 1)) + "\n")
        (people / "cup_001").mkdir(parents=True)
        (people / "cup_001" / "1.seg").write_text("0\n" * (len(rest) + 1))
        (self.folder / "quad.txt").write_text("quad_cups/cup_001.off\n")
        self.call("label", "evaluate", "--train", "cups", "--test", "quad.txt", "--humans", "people", "--out", "q", "--json",
                  "q.json", *QUICK)
        self.assertIsNotNone(self.json("q.json")["rand_error"])

    def test_splits_do_not_apply_to_leave_one_out(self):
        self.refused("label", "evaluate", "--protocol", "sb19", "cups", "--splits", "2", "--out", "x", code=2, says="sb19")

    def test_two_test_meshes_of_one_name_are_refused(self):
        (self.folder / "twice.txt").write_text("cups/cup_001.off\ncups/cup_001.off\n")
        self.refused("label", "evaluate", "--train", "cups", "--test", "twice.txt", "--out", "x", code=2, says="cup_001")


class Reports(WithModel):
    """docs/formats.md says all keys of every report, and no others."""

    OPEN = {"stumps_per_family", "share_per_family", "seconds_per_family"}  # their keys are names of families
    OPTIONAL = {"error", "unusable_because", "copy_gb_per_s", "fma_gflop_per_s", "subgroup_size", "thesis"}

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

    def test_apply(self):
        self.call("label", "apply", "cup.safetensors", "cups", "--out", "labeled", "--json", "a.json")
        self.check("label apply", self.json("a.json"))

    def test_evaluate(self):
        self.call("label", "evaluate", "--train-on", "cups", "cups/cup_001.off", "--test-on", "cups", "--out", "e", "--json",
                  "e.json", *QUICK)
        self.check("label evaluate", self.json("e.json"))

    def test_features(self):
        self.call("features", self.cup, "--out", "f.npy", "--json", "f.json", "--samples", "60")
        self.check("features", self.json("f.json"))

    def test_synth(self):
        self.call("synth", "cup", "--faces", "500", "--out", "s", "--json", "s.json")
        self.check("synth", self.json("s.json"))

    def test_devices(self):
        self.call("devices", "--no-measure", "--json", "d.json")
        self.check("devices", self.json("d.json"))
        self.assertEqual(sum(device["chosen"] for device in self.json("d.json")["devices"]), 1)


if __name__ == "__main__":
    unittest.main()

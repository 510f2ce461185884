"""label evaluate end to end on tiny generated shapes. Needs a Vulkan device (a software one will do)."""

import json
import os
import shutil
import subprocess
import sys
import unittest

from program import (DOCS, TRUTH, WithModel, QUICK, read_labels, read_off)

SEGMENT_RATES = ["rand_error", "cut_discrepancy", "hamming_distance", "missing_rate", "false_alarm_rate",
                 "global_consistency_error", "local_consistency_error"]


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
        printed = self.call("label", "evaluate", "--train", "cups", "--test", self.mistaken_cups(), "--out", "summary", "--json",
                            "s.json", *QUICK).stdout
        report = self.json("s.json")
        category = report["categories"][0]
        meshes = category["splits"][0]["meshes"]
        self.assertEqual(category["names"], list(TRUTH))
        for i, share in enumerate(category["confusion"]):
            self.assertAlmostEqual(share, sum(mesh["confusion"][i] for mesh in meshes) / len(meshes))
        areas = [pair["area_share"] for pair in category["confused"]]
        self.assertGreater(len(areas), 0)
        self.assertEqual(sorted(areas, reverse=True), areas)
        for pair in category["confused"]:
            t, p = category["names"].index(pair["truth"]), category["names"].index(pair["predicted"])
            self.assertAlmostEqual(pair["area_share"], category["confusion"][2 * t + p])
            self.assertAlmostEqual(pair["label_share"], pair["area_share"] / sum(category["confusion"][2 * t:2 * t + 2]))
        run = self.json("summary/cups/lists/model.training.json")
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

    def test_the_split_of_shapepfcn_goes_by_the_numbers_of_meshes(self):
        shapes = self.folder / "numbered"
        shapes.mkdir()
        for number in range(7, 17):  # by name, 10 to 16 come before 7
            for ending in (".off", "_labels.txt"):
                shutil.copy(self.folder / f"cups/cup_00{1 + number % 2}{ending}", shapes / f"{number}{ending}")
        self.call("label", "evaluate", "--protocol", "pfcn", "numbered", "--out", "pfcn", "--json", "pfcn.json", *QUICK)
        [split] = self.json("pfcn.json")["categories"][0]["splits"]
        self.assertEqual(split["train"], ["7", "8", "10", "12", "13", "15"])
        self.assertEqual([mesh["mesh"] for mesh in split["meshes"]], ["9", "11", "14", "16"])
        self.refused("label", "evaluate", "--protocol", "pfcn", "cups", "--out", "x", code=2, says="five meshes")
        self.refused("label", "evaluate", "--protocol", "pfcn", "numbered", "--splits", "2", "--out", "x", code=2,
                     says="pfcn")

    def test_protocol_leaves_what_a_model_made_alone(self):
        copy = self.folder / "labeled-before"
        shutil.copytree(self.folder / "cups", copy)
        shutil.copytree(self.folder / "cups", copy / "labeled")
        self.call("label", "evaluate", "--protocol", "sb19", "labeled-before", "--out", "lb", "--json", "lb.json", *QUICK)
        self.assertEqual([c["category"] for c in self.json("lb.json")["categories"]], ["labeled-before"])

    def test_a_mesh_may_have_any_name(self):
        poses = self.folder / "poses"
        poses.mkdir()
        for ending in (".off", "_labels.txt"):
            shutil.copy(self.folder / f"cups/cup_001{ending}", poses / f"run{ending}")
            shutil.copy(self.folder / f"cups/cup_002{ending}", poses / f"model{ending}")
        call = ["label", "evaluate", "--train", "cups", "--test", "poses", "--out", "posed", *QUICK]
        times = lambda: {p.name: p.stat().st_mtime_ns for p in (self.folder / "posed" / "cups" / "lists").iterdir()}
        self.call(*call)
        before = times()
        self.call(*call)
        self.assertEqual(before, times(), "finished work was done again")

    def test_other_human_segmentations_are_no_finished_result(self):
        humans = self.folder / "humans" / "cup_001"
        humans.mkdir(parents=True)
        faces = len(read_off(self.folder / "cups/cup_001.off")[1])
        call = ["label", "evaluate", "--train", "cups", "--test", "cups", "--humans", "humans", "--out", "h", "--json",
                "h.json", *QUICK]
        rates = []
        for segments in (["0\n"] * faces, [f"{f % 2}\n" for f in range(faces)]):
            (humans / "cup_001_0.seg").write_text("".join(segments))
            self.call(*call)
            meshes = self.json("h.json")["categories"][0]["splits"][0]["meshes"]
            rates.append(next(m["rand_error"] for m in meshes if m["mesh"] == "cup_001"))
        self.assertNotEqual(*rates)

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

    def test_labels_of_another_program_are_rated_beside(self):
        peer = self.folder / "peer" / "cups"
        peer.mkdir(parents=True)
        shutil.copy(self.folder / "cups/cup_001_labels.txt", peer)  # all right
        lines = (self.folder / "cups/cup_002_labels.txt").read_text().split("\n")
        wrong = {"body": "handle", "handle": "spout"}  # all wrong, with a label that nothing else has
        (peer / "cup_002_labels.txt").write_text("\n".join(wrong.get(line, line) for line in lines))
        said = self.call("label", "evaluate", "--protocol", "sb19", "cups", "--out", "peers", "--peer", "peer", "--json",
                         "peers.json", *QUICK).stdout
        report = self.json("peers.json")
        rated = {mesh["mesh"]: mesh.get("peer") for split in report["categories"][0]["splits"] for mesh in split["meshes"]}
        self.assertEqual(rated["cup_001"], {"recognition_rate": 1, "segment_weighted_accuracy": 1})
        self.assertEqual(rated["cup_002"], {"recognition_rate": 0, "segment_weighted_accuracy": 0})
        self.assertIsNone(rated["cup_003"])
        means = report["categories"][0]["peer"]
        self.assertEqual([means[key] for key in ("meshes", "recognition_rate", "ahead")], [2, 0.5, 1])
        own = [mesh["recognition_rate"] for split in report["categories"][0]["splits"] for mesh in split["meshes"]][:2]
        self.assertAlmostEqual(means["own_recognition_rate"], sum(own) / 2)
        self.assertEqual(report["peer"], means)
        self.assertIn("peer RR", said)
        changed = [mesh["without_cut"] - mesh["recognition_rate"] for split in report["categories"][0]["splits"] for mesh in split["meshes"]]
        self.assertTrue(0 < max(map(abs, changed)) < 0.2, "the cut changes some faces")
        (self.folder / "nothing").mkdir()

        def make_page(*reports):
            return subprocess.run([sys.executable, "-B", DOCS / "results/label_pages.py", *reports, "--peer-name",
                                   "the man next door"], cwd=self.folder, capture_output=True, text=True, check=False)

        page = make_page("peers.json").stdout
        self.assertIn("psb/labeled --rounds 8 --patience 8 --feature-fraction 0.25 --samples 60 --out out/sb19 --peer peer\n", page)
        self.assertIn("## Beside the man next door\n", page)
        for row in (r"cups( \| [\d.-]+){12}", r"cups \| 2 \| [\d.]+ \| 50.0 \|", r"\*\*mean\*\*"):
            self.assertRegex(page, rf"\| {row}")

        report["categories"][0].update(category="mugs", recognition_rate=0)
        (self.folder / "mugs.json").write_text(json.dumps(report))
        both, half = make_page("peers.json", "mugs.json").stdout, 50 * self.json("peers.json")["recognition_rate"]
        self.assertRegex(both, rf"\| \*\*mean\*\* \| \*\*{half:.1f}\*\* ")
        self.assertIn("| mean | 4 |", both)
        self.assertEqual(both.split("## Chosen")[1], page.split("## Chosen")[1], "the same models chose the same features")
        self.assertIn("peers.json, peers.json: cannot be made a page (two reports", make_page("peers.json", "peers.json").stderr)
        (self.folder / "other.json").write_text(json.dumps({**report, "options": {**report["options"], "rounds": 9}}))
        self.assertIn("other options", make_page("peers.json", "other.json").stderr)
        self.refused("label", "evaluate", "--protocol", "sb19", "cups", "--out", "peers", "--peer", "nothing", *QUICK,
                     code=1, says="labels of no test mesh")
        self.refused("label", "evaluate", "--protocol", "sb19", "cups", "--out", "peers", "--peer", "nowhere", code=1,
                     says="nowhere")

    def test_splits_do_not_apply_to_leave_one_out(self):
        self.refused("label", "evaluate", "--protocol", "sb19", "cups", "--splits", "2", "--out", "x", code=2, says="sb19")

    def test_two_test_meshes_of_one_name_are_refused(self):
        (self.folder / "twice.txt").write_text("cups/cup_001.off\ncups/cup_001.off\n")
        self.refused("label", "evaluate", "--train", "cups", "--test", "twice.txt", "--out", "x", code=2, says="cup_001")


class Study(WithModel):
    STUDY = ["label", "study", "cups", "--size", "2", "--held", "1", "--splits", "2", "--faces", "400", *QUICK]

    def test_every_training_mesh_is_held_out_once(self):
        printed = self.call(*self.STUDY, "--out", "study.json", "--json", "report.json").stdout
        report = self.json("study.json")
        self.assertEqual(report, self.json("report.json"))
        self.assertIn("cups", printed)
        for split in range(2):
            rows = [row for row in report["rows"] if row["split"] == split]
            self.assertEqual(len({row["mesh"] for row in rows}), 2)
            self.assertEqual({row["group"] for row in rows}, {0, 1})
        for row in report["rows"]:
            for key in ["recognition_rate", "segment_weighted_accuracy", "without_cut"]:
                self.assertGreater(row[key], 0.3, row)
                self.assertLessEqual(row[key], 1, row)
            self.assertGreater(row["log_loss"], 0)

    def test_goes_on_where_it_stopped(self):
        self.call(*self.STUDY, "--out", "whole.json")
        whole = self.json("whole.json")
        (self.folder / "part.json").write_text(json.dumps({**whole, "rows": whole["rows"][:3]}))
        self.call(*self.STUDY, "--out", "part.json")
        part = self.json("part.json")
        self.assertEqual(part["rows"][:3], whole["rows"][:3])
        for row in [part["rows"][3], whole["rows"][3]]:
            row.pop("seconds")
        self.assertEqual(part["rows"][3], whole["rows"][3])

    def test_results_of_other_options_are_not_replaced(self):
        self.call(*self.STUDY, "--out", "kept.json")
        before = (self.folder / "kept.json").read_bytes()
        refused = self.call(*self.STUDY, "--out", "kept.json", "--seed", "2", code=2)
        self.assertIn("give another --out", refused.stderr)
        self.assertEqual((self.folder / "kept.json").read_bytes(), before)

    def test_results_of_other_labels_are_not_continued(self):
        shutil.copytree(self.folder / "cups", self.folder / "changing")
        study = [argument.replace("cups", "changing") for argument in self.STUDY]
        self.call(*study, "--out", "changing.json")
        labels = self.folder / "changing" / "cup_001_labels.txt"
        labels.write_text(labels.read_text().replace("handle", "grip"))
        self.assertIn("give another --out", self.call(*study, "--out", "changing.json", code=2).stderr)

    def test_compares_with_studies_alone(self):
        (self.folder / "list.json").write_text("[1, 2]")
        refused = self.call(*self.STUDY, "--out", "never.json", "--against", "list.json", code=1)
        self.assertIn("list.json: is no study", refused.stderr)
        self.assertFalse((self.folder / "never.json").exists())

    def test_does_not_differ_from_itself(self):
        self.call(*self.STUDY, "--out", "one.json")
        printed = self.call(*self.STUDY, "--out", "two.json", "--against", "one.json", "--without", "cups").stdout
        difference = self.json("two.json")["difference"]["recognition_rate"]
        self.assertEqual(difference["all"], {"mean": 0, "lowest": 0, "highest": 0})
        self.assertIsNone(difference["without"]["mean"])
        self.assertIn("4 labelings", printed)

    def test_too_few_meshes_or_none_left_to_learn_are_refused(self):
        few = self.call("label", "study", "cups", "--out", "few.json", code=2)
        self.assertIn("cups: has 3 meshes, but --size 6 needs more", few.stderr)
        none = self.call("label", "study", "cups", "--size", "2", "--held", "2", "--out", "none.json", code=2)
        self.assertIn("--held must be below --size", none.stderr)


if __name__ == "__main__":
    unittest.main()

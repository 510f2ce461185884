"""Batch labeling and catalogs, as their users meet them."""

import csv
import json
import os
import shutil
import sqlite3
import subprocess
import unittest

from batch import BatchTest
from program import CUBE, CUBE_QUADS, QUICK, read_labels, write_off


class CatalogTest(BatchTest):
    def test_add_list_status_export(self):
        write_off(self.folder / "mixed" / "cube.off", CUBE, CUBE_QUADS)
        (self.folder / "mixed" / "bad.off").write_text("OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n")
        said = self.call("catalog", "add", "a.db", "mixed", "shapes", "--category", "cup").stdout
        self.assertIn(f"{self.SHAPES + 2} shapes found: {self.SHAPES + 2} read, 0 as they were; 1 of those read cannot", said)
        again = self.call("catalog", "add", "a.db", "mixed", "shapes").stdout
        self.assertIn(f"1 read, {self.SHAPES + 1} as they were; 1 of those read cannot", again)

        listed = self.call("catalog", "list", "a.db").stdout.splitlines()
        self.assertEqual(len(listed), self.SHAPES + 2)
        self.assertIn("6 faces", next(line for line in listed if "cube.off" in line))
        problems = self.call("catalog", "list", "a.db", "--problems", "--json", "p.json").stdout.splitlines()
        self.assertEqual(len(problems), 1)
        self.assertIn("bad.off:3", problems[0])
        self.assertFalse(json.loads((self.folder / "p.json").read_text())["shapes"][0]["usable"])
        self.assertEqual(self.call("catalog", "list", "a.db", "--category", "x' OR '1").stdout, "")

        status = self.status("a.db")
        self.assertEqual((status["shapes"], status["unusable"]), (self.SHAPES + 2, 1))
        self.assertEqual(status["categories"], [{"category": "cup", "shapes": self.SHAPES + 1}])

        self.call("catalog", "export", "a.db", "--out", "a.csv")
        with open(self.folder / "a.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), self.SHAPES + 2)
        self.assertEqual({row["state"] for row in rows}, {"open"})
        cube = next(row for row in rows if row["name"] == "mixed/cube")
        self.assertEqual((cube["faces"], cube["vertices"], cube["usable"]), ("6", "8", "true"))
        self.call("catalog", "export", "a.db", "--out", "a.json")
        exported = json.loads((self.folder / "a.json").read_text())
        self.assertEqual([row["name"] for row in exported], [row["name"] for row in rows])

    def test_what_changes_is_read_again(self):
        write_off(self.folder / "changing" / "cube.off", CUBE, CUBE_QUADS)
        self.call("catalog", "add", "c.db", "changing")
        write_off(self.folder / "changing" / "cube.off", CUBE, CUBE_QUADS[:5])
        self.assertIn("1 read, 0 as they were", self.call("catalog", "add", "c.db", "changing").stdout)
        self.assertIn(" 5 faces", self.call("catalog", "list", "c.db").stdout)

    def test_mistakes(self):
        (self.folder / "no.db").write_text("no")
        self.refused("catalog", "status", "no.db", code=1, says=["no.db", "no catalog"])
        self.refused("catalog", "status", "missing.db", code=1, says="no such catalog")
        self.refused("catalog", "add", "d.db", "shapez", code=1, says=["shapez", "did you mean 'shapes'"])
        self.call("catalog", "add", "d.db", "shapes")
        self.refused("catalog", "export", "d.db", "--out", "d.txt", code=2, says=".csv or .json")
        self.refused("catalog", "merge", "d.db", code=1, says="nothing was labeled")
        self.refused("catalog", "export", "d.db", "--out", "d.csv", "--run", "3", code=1, says="has no run 3")


class BatchLabelingTest(BatchTest):
    def batch(self, source, out, *options, code=0):
        return self.call("label", "batch", source, "--model", "cup.safetensors", "--out", out, *options, code=code)

    def test_labels_all_as_apply_does(self):
        said = self.batch("shapes", "all", "--gltf", "--json", "all.json").stdout
        self.assertIn(f"{self.SHAPES} shapes labeled, 0 of unknown category, 0 failed", said)
        self.assertIn("slowest stage: ", said)
        self.assert_all_labeled("all", self.SHAPES)
        self.call("label", "apply", "cup.safetensors", "shapes", "--out", "applied", "--gltf")
        for name in os.listdir(self.folder / "applied"):
            self.assertEqual((self.folder / "all" / "labeled" / name).read_bytes(),
                             (self.folder / "applied" / name).read_bytes(), name)
        report = json.loads((self.folder / "all.json").read_text())
        self.assertEqual([stage["stage"] for stage in report["stages"]], ["read", "features", "scores", "cuts", "writing"])
        self.assertTrue(all(stage["shapes"] == self.SHAPES for stage in report["stages"]))

    def test_goes_on_where_it_was(self):
        self.batch("shapes", "twice")
        before = {path: path.stat().st_mtime_ns for path in (self.folder / "twice" / "labeled").iterdir()}
        self.assertIn("0 shapes labeled", self.batch("shapes", "twice").stdout)
        self.assertEqual(before, {path: path.stat().st_mtime_ns for path in before})
        # A catalog that is lost is made anew from the records, and what somebody has removed is labeled again.
        (self.folder / "twice" / "catalog.db").unlink()
        self.assertIn(f"{self.SHAPES} results of earlier or other programs taken over", self.batch("shapes", "twice").stdout)
        self.records("twice")[0].unlink()
        self.assertIn("1 shape labeled", self.batch("shapes", "twice").stdout)
        self.assert_all_labeled("twice", self.SHAPES)

    def test_other_models_and_options_label_anew(self):
        self.batch("shapes", "anew")
        self.assertIn(f"{self.SHAPES} shapes labeled", self.batch("shapes", "anew", "--keep-small").stdout)
        self.assertEqual([run["done"] for run in self.status("anew/catalog.db")["runs"]], [self.SHAPES, self.SHAPES])
        # Back to what was before: its results have been replaced.
        self.assertIn(f"{self.SHAPES} shapes labeled", self.batch("shapes", "anew").stdout)

    def test_nothing_is_left_of_what_is_labeled_anew(self):
        write_off(self.folder / "left" / "cube.off", CUBE, CUBE_QUADS)
        self.batch("left", "out-left", "--gltf")
        labeled = self.folder / "out-left" / "labeled"
        self.assertEqual(sorted(path.name for path in labeled.iterdir()),
                         ["cube.glb", "cube.json", "cube.ply", "cube.seg", "cube_labels.txt"])
        self.batch("left", "out-left")
        self.assertFalse((labeled / "cube.glb").exists())
        (self.folder / "left" / "cube.off").write_text("OFF\nno\n")
        self.assertIn("1 failed", self.call("label", "batch", "out-left/catalog.db", "--model", "cup.safetensors", "--out",
                                            "out-left", "--keep-small").stdout)
        self.assertEqual([path.name for path in labeled.iterdir()], ["cube.json"])

    def test_damaged_records_are_made_anew(self):
        self.batch("shapes", "damaged", "--tasks", "1")
        shard = self.folder / "damaged/shards/1/1.shard"
        self.call("label", "batch", shard)
        self.records("damaged")[0].write_text("")
        self.records("damaged")[1].write_text('{"run":')
        self.assertIn(f"{self.SHAPES - 2} results of earlier or other programs", self.call("label", "batch", shard).stdout)
        self.call("catalog", "merge", "damaged/catalog.db")
        self.assert_all_labeled("damaged", self.SHAPES)
        self.records("damaged")[0].write_text("")
        self.assertIn("1 shape labeled", self.batch("shapes", "damaged").stdout)
        self.assert_all_labeled("damaged", self.SHAPES)

    def test_a_file_that_changes_after_the_shards_are_written(self):
        write_off(self.folder / "moving" / "cube.off", CUBE, CUBE_QUADS)
        self.batch("moving", "out-moving", "--tasks", "1")
        write_off(self.folder / "moving" / "cube.off", CUBE, CUBE_QUADS[:5])
        shard = self.folder / "out-moving/shards/1/1.shard"
        self.assertIn("1 shape labeled", self.call("label", "batch", shard).stdout)
        self.assertIn("1 result of earlier or other programs taken over", self.call("label", "batch", shard).stdout)
        self.assertIn("1 result new", self.call("catalog", "merge", "out-moving/catalog.db").stdout)
        self.assertIn(" 5 faces", self.call("catalog", "list", "out-moving/catalog.db").stdout)

    def test_folders_named_like_results(self):
        for name in ("a.off", "a.ply/b.off", "a.json/b.off", "a_labels.txt/b.off"):
            write_off(self.folder / "named" / name, CUBE, CUBE_QUADS)
        self.assertIn("4 shapes labeled", self.batch("named", "out-named").stdout)

    def test_bad_shapes_are_recorded_and_left_out(self):
        shutil.copytree(self.folder / "shapes", self.folder / "bad")
        (self.folder / "bad" / "cut off.off").write_text("OFF\n8 12 0\n0 0 0\n")
        (self.folder / "bad" / "empty.stl").write_text("")
        # Readable, but gone or changed when its turn comes:
        write_off(self.folder / "bad" / "gone.off", CUBE, CUBE_QUADS)
        write_off(self.folder / "bad" / "worse.off", CUBE, CUBE_QUADS)
        write_off(self.folder / "bad" / "other.off", CUBE, CUBE_QUADS)
        self.call("catalog", "add", "bad.db", "bad")
        (self.folder / "bad" / "gone.off").unlink()
        (self.folder / "bad" / "worse.off").write_text("OFF\nno\n")
        write_off(self.folder / "bad" / "other.off", CUBE, CUBE_QUADS[:5])
        said = self.batch("bad.db", "out-bad").stdout
        self.assertIn(f"{self.SHAPES + 1} shapes labeled, 0 of unknown category, 2 failed", said)
        self.assertIn("3 shapes cannot be used", said)  # cut off, empty, and by now worse
        self.call("catalog", "export", "bad.db", "--out", "bad.json")
        rows = {row["name"]: row for row in json.loads((self.folder / "bad.json").read_text())}
        self.assertIn("cannot be read", rows["bad/gone"]["error"])
        self.assertEqual(rows["bad/other"]["faces"], 5)
        self.assertEqual(sum(map(len, read_labels(self.folder / "out-bad/labeled/bad/other_labels.txt").values())), 5)
        self.assertEqual({rows[name]["state"] for name in ("bad/gone", "bad/worse")}, {"failed"})
        self.assertEqual(rows["bad/cut off"]["state"], "open")
        self.assertNotEqual(rows["bad/cut off"]["problem"], "")
        # Called again it does not try them again, unless it is told to; and then the mended one is labeled.
        self.assertIn("0 shapes labeled, 0 of unknown category, 0 failed", self.batch("bad.db", "out-bad").stdout)
        write_off(self.folder / "bad" / "worse.off", CUBE, CUBE_QUADS)
        self.assertIn("1 shape labeled, 0 of unknown category, 1 failed", self.batch("bad.db", "out-bad", "--retry").stdout)

    def test_two_at_once_share_the_work(self):
        for i in range(6):
            shutil.copytree(self.folder / "shapes", self.folder / "many" / str(i))
        both = [self.start("label", "batch", "many", "--model", "cup.safetensors", "--out", "shared", "--cache", "",
                           "--json", f"shared{i}.json") for i in range(2)]
        for process in both:
            output, errors = process.communicate(timeout=200)
            self.assertEqual(process.returncode, 0, output + errors)
        self.assert_all_labeled("shared", 6 * self.SHAPES)
        done = [json.loads((self.folder / f"shared{i}.json").read_text())["labeled"] for i in range(2)]
        self.assertEqual(sum(done), 6 * self.SHAPES)
        self.assertGreater(min(done), 0)

    def test_names_from_anywhere_stay_in_the_folder(self):
        outside = self.folder / "outside"
        inside = self.folder / "hostile"
        write_off(outside / "secret.off", CUBE, CUBE_QUADS)
        write_off(inside / "a" / "b...off", CUBE, CUBE_QUADS)
        write_off(inside / "a\\..\\c.off", CUBE, CUBE_QUADS)
        write_off(inside / "new\nline <script>.off", CUBE, CUBE_QUADS)
        write_off(inside / os.fsdecode(b"\xff\xfe.off"), CUBE, CUBE_QUADS)
        (inside / "link.off").symlink_to(outside / "secret.off")
        (inside / "folder").symlink_to(outside)
        said = self.batch("hostile", "out-hostile", "--json", "h.json")
        self.assertIn("link.off: leads out of the folder", said.stderr)
        self.assertEqual(json.loads((self.folder / "h.json").read_text())["labeled"], 4)
        self.assertEqual(sorted(path.name for path in outside.iterdir()), ["secret.off"])
        # A catalog that somebody has tampered with:
        self.call("catalog", "add", "tampered.db", "hostile")
        with sqlite3.connect(self.folder / "tampered.db") as database:
            database.execute("UPDATE shapes SET name = '../../escaped' WHERE id = 1")
        self.refused("label", "batch", "tampered.db", "--model", "cup.safetensors", "--out", "out-tampered", code=1,
                     says="leads out of the output folder")
        self.assertEqual([path for path in self.folder.rglob("escaped*")], [])

    def test_an_output_folder_with_a_link_in_it(self):
        outside = self.folder / "elsewhere"
        outside.mkdir()
        write_off(self.folder / "linked" / "sub" / "a.off", CUBE, CUBE_QUADS)
        (self.folder / "out-linked" / "labeled").mkdir(parents=True)
        (self.folder / "out-linked" / "labeled" / "sub").symlink_to(outside)
        (outside / "a.json").write_text("{}")  # as the record would be named
        self.refused("label", "batch", "linked", "--model", "cup.safetensors", "--out", "out-linked", code=1,
                     says="is no folder")
        self.assertEqual(list(outside.iterdir()), [outside / "a.json"])
        for name in ("labeled", ".work", ".exemplar-output", "index.html"):
            out = self.folder / f"out-{name}"
            out.mkdir()
            (out / name).symlink_to(outside)
            self.refused("label", "batch", "linked", "--model", "cup.safetensors", "--out", out, code=1, says="is a link")
        self.assertEqual(list(outside.iterdir()), [outside / "a.json"])

    def test_a_record_that_is_a_link_is_made_anew(self):
        write_off(self.folder / "moved" / "a.off", CUBE, CUBE_QUADS)
        record = self.folder / "out-moved" / "labeled" / "a.json"
        for target in ("vanished", self.folder / "moved" / "a.off"):
            self.batch("moved", "out-moved")
            record.unlink()
            record.symlink_to(target)
            self.assertIn("1 shape labeled", self.batch("moved", "out-moved").stdout)
            self.assertTrue(record.is_file() and not record.is_symlink())
        self.assertTrue((self.folder / "moved" / "a.off").read_text().startswith("OFF"))

    def test_a_shard_that_names_a_folder_of_others(self):
        write_off(self.folder / "foreign" / "a.off", CUBE, CUBE_QUADS)
        self.batch("foreign", "out-foreign", "--tasks", "1")
        (self.folder / "out-foreign" / ".exemplar-output").unlink()
        self.refused("label", "batch", "out-foreign/shards/1/1.shard", code=1, says="was not made by the program")
        self.assertFalse((self.folder / "out-foreign" / "labeled" / "a.json").exists())

    def test_results_inside_the_folder_of_shapes_are_no_shapes(self):
        shutil.copytree(self.folder / "shapes", self.folder / "own")
        self.batch("own", "own/results")
        self.assertIn("0 shapes labeled", self.batch("own", "own/results").stdout)
        self.refused("label", "batch", "own", "--model", "cup.safetensors", "--out", "own", code=2,
                     says="is the folder of the shapes")

    def test_a_full_disk_ends_it_and_it_goes_on(self):
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=400k", "none", disk], capture_output=True).returncode:
            self.skipTest("no right to mount a small disk")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        error = self.refused("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "disk/out", code=1, says="disk/out")
        self.assertRegex(error, "No space left|disk is full")
        done = len(self.records("disk/out"))
        self.assertLess(done, self.SHAPES)
        subprocess.run(["mount", "-o", "remount,size=8m", disk], check=True)
        self.batch("shapes", "disk/out")
        self.assert_all_labeled("disk/out", self.SHAPES)

    def test_memory_is_kept_whatever_the_shapes_are(self):
        for kind in ("floor", "cone", "slats", "spikes", "graded", "pieces", "strip"):
            self.call("synth", kind, "--faces", "5000", "--out", "costly")
        process = self.start("label", "batch", "costly", "--model", "cup.safetensors", "--out", "bounded",
                             "--memory", "0.25", "--quiet")
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        with process.stdout, process.stderr:
            self.assertEqual(process.returncode, 0, process.stderr.read())
        self.assertEqual(len(self.records("bounded")), 7)
        # Estimates may err by a tenth or two. Two shapes at once, or what one leaves behind, take 0.4 GB.
        self.assertLess(used.ru_maxrss * 1024, 0.31e9)

    def test_a_model_for_each_category(self):
        (self.folder / "models").mkdir()
        shutil.copy(self.folder / "cup.safetensors", self.folder / "models" / "Cup.safetensors")
        self.call("synth", "table", "--count", "2", "--faces", "500", "--out", "tables")
        self.call("label", "train", "tables", "--out", "models/table.safetensors", *QUICK)
        self.call("catalog", "add", "both.db", "shapes", "--category", "cup")
        self.call("catalog", "add", "both.db", "tables", "--category", "table")
        write_off(self.folder / "what" / "cube.off", CUBE, CUBE_QUADS)
        write_off(self.folder / "chairs" / "cube.off", CUBE, CUBE_QUADS)
        self.call("catalog", "add", "both.db", "what")
        self.call("catalog", "add", "both.db", "chairs", "--category-of-folder")
        self.call("label", "batch", "both.db", "--models", "models", "--out", "out-both")
        self.call("catalog", "export", "both.db", "--out", "both.json")
        rows = json.loads((self.folder / "both.json").read_text())
        models = {(row["category"], row["model"]) for row in rows if row["state"] == "done"}
        self.assertEqual(models, {("cup", "Cup"), ("table", "table")})
        errors = {row["name"]: row["error"] for row in rows if row["state"] == "failed"}
        self.assertIn("exemplar category train", errors["what/cube"])
        self.assertIn("no model of the category 'chairs'", errors["chairs/cube"])

    def test_mistakes(self):
        for options, says in [([], "either --model FILE or --models"),
                              (["--model", "cup.safetensors", "--models", "."], "either --model FILE or --models"),
                              (["--model", "cup.safetensors"], "--out is empty"),
                              (["--model", "cup.safetensors", "--out", "m", "--slurm"], "--tasks N"),
                              (["--model", "cup.safetensors", "--out", "m", "--wait"], "--slurm")]:
            self.refused("label", "batch", "shapes", *options, code=2, says=says)
        self.refused("label", "batch", "nothing", "--model", "cup.safetensors", "--out", "m", code=1, says="no such file")
        self.refused("label", "batch", "shapes", "--models", "shapes", "--out", "m", code=1, says="holds no models")
        self.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "shards", "--tasks", "2")
        shard = self.folder / "shards/shards/1/1.shard"
        whole = shard.read_text()
        shard.write_text(whole[:len(whole) - 30])
        self.refused("label", "batch", shard, code=1, says=["1.shard:", "is damaged"])
        shard.write_text(whole.replace('"name":"cup', '"name":"../cup'))
        self.refused("label", "batch", shard, code=1, says="leads out of the folder")
        shard.write_text(whole.replace('"keep_small":false', '"keep_small":true'))
        self.refused("label", "batch", shard, code=1, says="not those that the shard was written for")
        shard.write_text(whole)
        for options in (["--retry"], ["--out", "elsewhere"], ["--model", "cup.safetensors"], ["--gltf"], ["--tasks", "2"]):
            self.refused("label", "batch", shard, *options, code=2, says=["1.shard: is a shard", options[0]])

    def test_a_list_with_a_mesh_that_is_gone(self):
        listed = sorted((self.folder / "shapes").glob("*.off"))[:2]
        (self.folder / "list.txt").write_text(f"{listed[0]}\n{self.folder}/gone.off\n{listed[1]}\n")
        self.assertIn("2 shapes labeled", self.batch("list.txt", "out-list").stdout)
        self.call("catalog", "list", "out-list/catalog.db", "--problems", "--json", "gone.json")
        [gone] = json.loads((self.folder / "gone.json").read_text())["shapes"]
        self.assertIn("gone.off: cannot be read", gone["problem"])

    def test_nobodys_link_is_written_through(self):
        out = self.folder / "out-locked"
        (out / ".work").mkdir(parents=True)
        (out / ".work" / ".lock").symlink_to(self.folder / "made")
        self.refused("label", "batch", "shapes", "--model", "cup.safetensors", "--out", out, code=1, says=".lock: cannot be written")
        self.assertFalse((self.folder / "made").exists())

    def test_slurm_where_there_is_none(self):
        environment = dict(self.environment, PATH="/nonexistent")
        result = subprocess.run([os.environ["EXEMPLAR_PROGRAM"], "label", "batch", "shapes", "--model", "cup.safetensors",
                                 "--out", "no-slurm", "--slurm", "--tasks", "2"], cwd=self.folder, env=environment,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertIn("slurm-client", result.stderr)


if __name__ == "__main__":
    unittest.main()

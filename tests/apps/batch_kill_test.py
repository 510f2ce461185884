"""Batch labeling is killed again and again at random moments: it loses no finished shape and repeats none."""

import contextlib
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import time
import unittest

from batch import BatchTest

KILLS = int(os.environ.get("EXEMPLAR_KILLS", "200"))
# Of the time of a whole run: kills hit its beginning as well as the middle of its work, and it ends after about ten.
LONGEST = 0.2


class KillTest(BatchTest):
    SHAPES = 40
    FACES = 500

    def batch(self, out="out"):
        return self.start("label", "batch", "shapes", "--model", "cup.safetensors", "--out", out, "--quiet", "--cache", "")

    def finished(self):
        """{name of a finished shape: what would change if any of its files were written again}."""
        found = {}
        for record in self.records("out"):
            stem = str(record).removesuffix(".json")
            files = [pathlib.Path(stem + ending) for ending in (".json", "_labels.txt", ".seg", ".ply")]
            found[record.stem] = [(file.stat().st_ino, file.stat().st_mtime_ns) for file in files]
        return found

    def claiming(self):
        """The numbers of the processes that have claimed shapes."""
        try:
            with contextlib.closing(sqlite3.connect(self.folder / "out" / "catalog.db")) as database:
                rows = database.execute("SELECT DISTINCT worker FROM labels WHERE state = 'claimed'").fetchall()
        except sqlite3.OperationalError:  # it is just being made
            return set()
        return {int(worker.split("-")[-2]) for [worker] in rows}

    def kill_one_of_two(self, generator):
        """What the dead one had claimed is done by the other, which had begun before."""
        dead, other = self.batch(), self.batch()
        while not {dead.pid, other.pid} <= self.claiming():
            self.assertIsNone(other.poll(), "one did all the work")
            time.sleep(0.005)
        time.sleep(generator.uniform(0, 0.02) * self.whole)
        dead.kill()
        dead.communicate()
        output, errors = other.communicate(timeout=200)
        self.assertEqual(other.returncode, 0, output + errors)
        return dead.returncode == -signal.SIGKILL

    def kill_some(self, generator, count):
        """Starts programs that share the work and kills them; returns how many did not end before."""
        processes = [self.batch() for _ in range(count)]
        for process in processes:
            time.sleep(generator.uniform(0, LONGEST * self.whole) / count)
            process.kill()
        errors = [process.communicate()[1] for process in processes]
        codes = [process.returncode for process in processes]
        self.assertTrue(set(codes) <= {0, -signal.SIGKILL}, errors)
        return codes.count(-signal.SIGKILL)

    def test_kill(self):
        generator = random.Random(1)
        begin = time.monotonic()
        self.run_to_the_end()
        self.whole = time.monotonic() - begin
        kills = rounds = finished = attempts = survived = 0
        while kills < KILLS:
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            rounds += 1
            before = {}
            while len(before) < self.SHAPES and kills < KILLS:
                attempts += 1
                if attempts % 10 == 0 and len(before) < self.SHAPES / 2:  # the other has more to do than the dead one had
                    survived += 1
                    kills += self.kill_one_of_two(generator)
                    self.assertEqual(len(self.finished()), self.SHAPES, "what a dead program had claimed was left")
                else:
                    kills += self.kill_some(generator, 2 if kills % 3 == 2 else 1)
                now = self.finished()
                lost = {name for name in before if name not in now}
                repeated = {name for name in before if name in now and now[name] != before[name]}
                self.assertEqual((lost, repeated), (set(), set()), f"kill {kills}")
                before = now
            finished += len(before)
            after = self.run_to_the_end()
            self.assertEqual({name: after[name] for name in before}, before)
        print(f"{kills} kills in {rounds} rounds, {survived} times beside a program that went on; {finished} shapes finished in all but the "
              "last call of each round", flush=True)
        self.assertGreater(survived, 0)
        self.assertGreater(finished, 0)  # kills hit work, not only beginnings

    def run_to_the_end(self):
        self.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "out", "--quiet", "--cache", "")
        self.assert_all_labeled("out", self.SHAPES)
        self.assert_no_leftovers()
        self.assertEqual([path.name for path in (self.folder / "out" / ".work").iterdir()], [".lock"])
        return self.finished()


if __name__ == "__main__":
    unittest.main()

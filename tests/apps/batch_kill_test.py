"""Batch labeling is killed again and again at random moments: it loses no finished shape and repeats none."""

import os
import pathlib
import random
import shutil
import signal
import subprocess
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

    def kill_one_of_two(self, generator):
        """What the dead one had claimed is done by the other."""
        dead, other = self.batch(), self.batch()
        time.sleep(generator.uniform(0.3, 1) * LONGEST * self.whole)
        dead.kill()
        dead.communicate()
        output, errors = other.communicate(timeout=200)
        self.assertEqual(other.returncode, 0, output + errors)
        return dead.returncode == -signal.SIGKILL

    def kill_at_random(self, generator, processes):
        for process in processes:
            time.sleep(generator.uniform(0, LONGEST * self.whole) / len(processes))
            process.kill()
        return [process.wait() for process in processes]

    def test_kill(self):
        generator = random.Random(1)
        begin = time.monotonic()
        self.run_to_the_end()
        self.whole = time.monotonic() - begin
        kills = rounds = finished = 0
        while kills < KILLS:
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            rounds += 1
            before = {}
            while len(before) < self.SHAPES and kills < KILLS:
                # Every third time two programs share the work, and both are killed.
                processes = [self.batch() for _ in range(2 if kills % 3 == 2 else 1)]
                codes = self.kill_at_random(generator, processes)
                self.assertTrue(set(codes) <= {0, -signal.SIGKILL}, [p.stderr.read() for p in processes])
                kills += codes.count(-signal.SIGKILL)
                for process in processes:
                    process.stdout.close()
                    process.stderr.close()
                now = self.finished()
                lost = {name for name in before if name not in now}
                repeated = {name for name in before if name in now and now[name] != before[name]}
                self.assertEqual((lost, repeated), (set(), set()), f"kill {kills}")
                before = now
            finished += len(before)
            if len(before) < self.SHAPES and self.kill_one_of_two(generator):
                kills += 1
                after = self.finished()
                self.assertEqual(len(after), self.SHAPES, "what a dead program had claimed was left")
                self.assertEqual({name: after[name] for name in before}, before)
                before = after
            after = self.run_to_the_end()
            self.assertEqual({name: after[name] for name in before}, before)
        print(f"{kills} kills in {rounds} rounds; {finished} shapes finished by programs that were killed", flush=True)
        self.assertGreater(finished, 0)  # kills hit work, not only beginnings

    def run_to_the_end(self):
        self.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "out", "--quiet", "--cache", "")
        self.assert_all_labeled("out", self.SHAPES)
        self.assert_no_leftovers()
        self.assertEqual([path.name for path in (self.folder / "out" / ".work").iterdir()], [".lock"])
        return self.finished()


if __name__ == "__main__":
    unittest.main()

"""Ctrl-C and kill -9 at random moments: nothing half-written, one line, and evaluation goes on where it stopped."""

import contextlib
import json
import os
import pathlib
import random
import signal
import sqlite3
import struct
import time
import unittest

from program import ProgramTest, read_labels, read_off

SEED = int(os.environ.get("EXEMPLAR_TEST_SEED", time.time_ns()))
TRIES = 2
# Long enough to be interrupted, short enough to be tested.
LEARNING = ["--rounds", "40", "--patience", "40", "--samples", "60"]


def handles_interrupts(pid):
    """Whether the process has installed its handler of SIGINT: before that, no program can say anything."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False
    caught = [line.split()[1] for line in status.splitlines() if line.startswith("SigCgt")]
    return bool(caught) and bool(int(caught[0], 16) >> (signal.SIGINT - 1) & 1)


class Interruption(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.random = random.Random(SEED)
        cls.call("synth", "cup", "--count", "3", "--faces", "500", "--out", "cups")
        cls.call("label", "train", "cups", "--out", "cup.safetensors", "--rounds", "5", "--samples", "50")
        animal, size = "animals/fourleg_001.off", ["--size", "300x260", "--cache", ""]
        cls.call("synth", "fourleg", "--faces", "1500", "--out", "animals")
        cls.call("hatch", "example", "contour", animal, *size, "--out", "drawing.png")
        cls.call("hatch", "train", animal, "drawing.png", *size, "--out", "style.safetensors")
        # No cache: each call computes its features again, so that there is work to interrupt.
        cls.commands = {
            "train": ["label", "train", "cups", "--out", "out/m.safetensors", "--cache", "", *LEARNING],
            "apply": ["label", "apply", "cup.safetensors", "cups", "--out", "out", "--cache", "", "--gltf", "--png"],
            "batch": ["label", "batch", "cups", "--model", "cup.safetensors", "--out", "out", "--cache", "", "--gltf"],
            "features": ["features", "cups/cup_001.off", "--samples", "60", "--out", "out/f.npy", "--names", "out/n.json"],
            "hatch train": ["hatch", "train", animal, "drawing.png", *size, "--out", "out/style.safetensors"],
            "hatch draw": ["hatch", "draw", "style.safetensors", animal, *size, "--properties", "out/properties",
                           "--out", "out/drawing.svg", "--json", "out/drawing.json"],
            "hatch frames": ["hatch", "draw", "style.safetensors", animal, *size, "--turn", "9", "--frames", "0:4", "--out", "out/turning"],
            "synth": ["synth", "human", "--count", "3", "--faces", "2000", "--out", "out"],
        }
        cls.seconds = {}
        for name, command in cls.commands.items():
            start = time.monotonic()
            cls.call(*command)
            cls.seconds[name] = time.monotonic() - start

    def interrupt(self, command, after, number):
        """Exit code and stderr of a call that got the signal after so many seconds (or ended before)."""
        process = self.start(*command)
        start = time.monotonic()
        while process.poll() is None and not handles_interrupts(process.pid):
            time.sleep(0.001)
        time.sleep(max(0.0, after - (time.monotonic() - start)))
        process.send_signal(number)
        _, errors = process.communicate(timeout=240)
        return process.returncode, errors

    def check_file(self, path):
        """Reads a file of the program in full: a half of it would not parse."""
        content = path.read_bytes()
        if path.name.endswith("_labels.txt"):
            self.assertEqual(sorted(f for faces in read_labels(path).values() for f in faces)[0], 1, path)
            self.assertTrue(content.endswith(b"\n"), path)
        elif path.suffix == ".off":
            _, faces = read_off(path)
            self.assertEqual(len(faces), int(content.split()[2]), path)
        elif path.suffix == ".json":
            json.loads(content)
        elif path.suffix == ".safetensors":
            size = struct.unpack("<Q", content[:8])[0]
            header = json.loads(content[8:8 + size])
            header.pop("__metadata__")
            self.assertEqual(len(content), 8 + size + max(entry["data_offsets"][1] for entry in header.values()), path)
        elif path.suffix == ".glb":
            self.assertEqual(struct.unpack_from("<I", content, 8)[0], len(content), path)
        elif path.suffix == ".png":
            self.assertTrue(content.endswith(b"IEND\xaeB`\x82"), path)
        elif path.suffix == ".npy":
            head, rows, columns = content[:128], *map(int, content[:128].split(b"(")[1].split(b")")[0].split(b","))
            self.assertEqual(len(content), 10 + struct.unpack("<H", head[8:10])[0] + 4 * rows * columns, path)
        elif path.suffix == ".ply":
            head, body = content.split(b"end_header\n", 1)
            vertices, faces = (int(head.split(b"element " + kind + b" ")[1].split()[0]) for kind in (b"vertex", b"face"))
            self.assertEqual(len(body), 12 * vertices + struct.calcsize("<B3iiBBBf") * faces, path)
        elif path.suffix == ".seg":
            _, faces = read_off(self.folder / "cups" / f"{path.stem}.off")
            self.assertEqual(len(content.splitlines()), len(faces), path)
        elif path.suffix == ".svg":
            self.assertTrue(content.rstrip().endswith(b"</svg>"), path)
        elif path.suffix == ".db":
            with contextlib.closing(sqlite3.connect(path)) as database:
                self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        elif path.name in (".exemplar-output", ".lock") or path.suffix == ".lock":
            self.assertEqual(content, b"", path)
        elif path.suffix == ".html":
            self.assertTrue(content.rstrip().endswith(b"</html>"), path)
        else:
            self.fail(f"unexpected file {path}")

    def check_folder(self, folder, temporary_allowed):
        for path in (self.folder / folder).rglob("*"):
            if path.is_dir() or path.suffix in (".db-journal", ".db-wal", ".db-shm"):  # parts of a database
                continue
            if path.suffix == ".tmp":
                self.assertTrue(temporary_allowed, path)
                path.unlink()
            else:
                self.check_file(path)

    def clear(self, folder):
        for path in (self.folder / folder).rglob("*"):
            if path.is_file():
                path.unlink()

    def test_interrupt_ends_cleanly(self):
        for name, command in self.commands.items():
            for _ in range(TRIES):
                after = self.random.uniform(0, self.seconds[name])
                with self.subTest(name, seed=SEED, after=after):
                    self.clear("out")
                    code, errors = self.interrupt(command, after, signal.SIGINT)
                    self.check_folder("out", temporary_allowed=False)
                    if code == 0:  # it came after the last step
                        continue
                    self.assertEqual(code, 130, errors)
                    self.assertEqual(errors.splitlines()[-1], "interrupted")
                    self.assertNotIn("error", errors)

    def test_kill_leaves_nothing_half_written(self):
        for name, command in self.commands.items():
            for _ in range(TRIES):
                after = self.random.uniform(0, self.seconds[name])
                with self.subTest(name, seed=SEED, after=after):
                    self.clear("out")
                    self.interrupt(command, after, signal.SIGKILL)
                    self.check_folder("out", temporary_allowed=True)

    def without_times(self, value):
        if isinstance(value, dict):
            return {key: self.without_times(inner) for key, inner in value.items() if key != "seconds"}
        return [self.without_times(inner) for inner in value] if isinstance(value, list) else value

    def test_evaluation_goes_on_where_it_was_stopped(self):
        def command(out):
            return ["label", "evaluate", "--train", "cups", "--test", "cups", "--out", out, "--cache", "", *LEARNING]

        start = time.monotonic()
        self.call(*command("whole"))
        seconds = time.monotonic() - start
        expected = self.without_times(json.loads((self.folder / "whole/report.json").read_text()))
        for number in (signal.SIGINT, signal.SIGKILL):
            out = f"stopped{number}"
            for _ in range(TRIES):
                after = self.random.uniform(0.2, 0.9) * seconds
                with self.subTest(number, seed=SEED, after=after):
                    before = self.finished(out)
                    code, errors = self.interrupt(command(out), after, number)
                    self.assertIn(code, (0, 130, -signal.SIGKILL), errors)
                    self.check_folder(out, temporary_allowed=number == signal.SIGKILL)
                    self.assertLessEqual(before.items(), self.finished(out).items())
            before = self.finished(out)
            self.call(*command(out))
            self.assertLessEqual(before.items(), self.finished(out).items(), "finished work was done again")
            self.assertEqual(self.without_times(json.loads((self.folder / out / "report.json").read_text())), expected)
            self.assert_no_leftovers()

    def finished(self, out):
        """When each result was written: the model once its record is there, and each mesh with its scores."""
        folder = self.folder / out / "cups" / "lists"
        done = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.json")}
        if "model.training.json" in done:
            done["model"] = (folder / "model.safetensors").stat().st_mtime_ns
        return done


if __name__ == "__main__":
    unittest.main()

"""Runs the exemplar program for the tests of this folder, each in a folder of its own."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ.get("EXEMPLAR_PROGRAM", "build/exemplar")).absolute()
DOCS = pathlib.Path(__file__).parents[2] / "docs"
# A training of seconds: what is tested here is that things fit together, not that they are accurate.
QUICK = ["--rounds", "8", "--patience", "8", "--samples", "60", "--feature-fraction", "0.25"]


class ProgramTest(unittest.TestCase):
    """A working folder per class, and calls whose exit code and messages are checked."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="exemplar-test-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.environment = dict(os.environ, XDG_CACHE_HOME=str(cls.folder / "cache"))

    @classmethod
    def start(cls, *arguments, program=PROGRAM):
        return subprocess.Popen([program, *map(str, arguments)], cwd=cls.folder, env=cls.environment, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    @classmethod
    def call(cls, *arguments, code=0, program=PROGRAM, timeout=240):
        """Runs the program to its end; an exit code other than `code` is a failure that shows what was said."""
        process = cls.start(*arguments, program=program)
        output, errors = process.communicate(timeout=timeout)
        result = subprocess.CompletedProcess(arguments, process.returncode, output, errors)
        if process.returncode != code:
            raise AssertionError(f"{program.name} {' '.join(map(str, arguments))} gave exit code {process.returncode} "
                                 f"instead of {code}:\n{output}{errors}")
        return result

    def refused(self, *arguments, code, says, program=PROGRAM):
        """The one line on stderr of a call that fails; it must hold each of `says`."""
        lines = self.call(*arguments, code=code, program=program).stderr.splitlines()
        errors = [line for line in lines if line.startswith("error: ")]
        self.assertEqual(len(errors), 1, lines)
        self.assertEqual(lines[-1], errors[0])
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, errors[0])
        self.assertTrue(errors[0].isprintable(), repr(errors[0]))
        return errors[0]

    def assert_no_leftovers(self):
        self.assertEqual([str(path) for path in self.folder.rglob("*.tmp")], [])


TRUTH = ("body", "handle")  # the labels of cups


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

    def mistaken_cups(self):
        """The cups again, whose true labels call every tenth face of one part the other: whatever labels them is wrong in some."""
        folder = self.folder / "mistaken"
        shutil.copytree(self.folder / "cups", folder, dirs_exist_ok=True)
        for path in folder.glob("*_labels.txt"):
            (one, faces), (other, others) = read_labels(path).items()
            kept = [face for i, face in enumerate(faces) if i % 10]
            path.write_text("".join(f"{name}\n{' '.join(map(str, numbers))}\n"
                                    for name, numbers in ((one, kept), (other, others + faces[::10]))))
        return folder


def write_off(path, vertices, faces):
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(map(str, vertex)) for vertex in vertices]
    lines += [" ".join(map(str, (len(face), *face))) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def read_off(path):
    """Vertices and faces of a file that the program wrote."""
    lines = path.read_text().split("\n")
    vertices, faces, _ = map(int, lines[1].split())
    return ([tuple(map(float, line.split())) for line in lines[2:2 + vertices]],
            [tuple(map(int, line.split()[1:])) for line in lines[2 + vertices:2 + vertices + faces]])


def read_labels(path):
    """{label: [1-based faces]} of a _labels.txt file."""
    lines = [line for line in path.read_text().split("\n") if line.strip()]
    return {name: list(map(int, faces.split())) for name, faces in zip(lines[::2], lines[1::2])}


CUBE = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
CUBE_TRIANGLES = [t for a, b, c, d in CUBE_QUADS for t in ((a, b, c), (a, c, d))]

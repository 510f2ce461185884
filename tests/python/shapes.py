"""Small meshes for the tests of the Python package, and the program to compare with."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

PROGRAM = pathlib.Path(os.environ.get("EXEMPLAR_PROGRAM", "build/exemplar")).absolute()
# A training of seconds: what is tested here is that things fit together, not that they are accurate.
QUICK = {"rounds": 8, "patience": 8, "samples": 60, "feature_fraction": 0.25}

CUBE = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=np.float32)
CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
CUBE_FACES = np.array([t for a, b, c, d in CUBE_QUADS for t in ((a, b, c), (a, c, d))])


def sphere(rings=24, radius=1.0):
    """Vertices and faces of a sphere around the origin, looking outward."""
    sides = 2 * rings
    polar = np.pi * np.arange(1, rings) / rings
    around = 2 * np.pi * np.arange(sides) / sides
    rows = np.stack([np.outer(np.sin(polar), np.cos(around)), np.outer(np.sin(polar), np.sin(around)),
                     np.outer(np.cos(polar), np.ones(sides))], axis=-1).reshape(-1, 3)
    vertices = radius * np.concatenate([rows, [(0, 0, 1), (0, 0, -1)]])
    north, south = len(rows), len(rows) + 1
    faces = []
    for s in range(sides):
        t = (s + 1) % sides
        faces += [(north, s, t), (south, (rings - 2) * sides + t, (rings - 2) * sides + s)]
        for r in range(rings - 2):
            a, b, c, d = r * sides + s, (r + 1) * sides + s, (r + 1) * sides + t, r * sides + t
            faces += [(a, b, c), (a, c, d)]
    return vertices, np.array(faces)


class PackageTest(unittest.TestCase):
    """A working folder per class, and the program."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="exemplar-python-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)

    def program(self, *arguments):
        """What the program does, to compare with."""
        subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache")), timeout=240)

    def raises(self, error, says, call, *arguments, **options):
        """The call raises that error, of one line that holds each of `says`."""
        with self.assertRaises(error) as caught:
            call(*arguments, **options)
        message = str(caught.exception)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, message)
        self.assertEqual(len(message.splitlines()), 1, message)

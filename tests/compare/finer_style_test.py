#!/usr/bin/env python3
"""A part in three, as people cut it; see finer_style.py.

    finer_style_test.py

Exit code 77 says that the test was skipped, and why."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import programs

SCRIPT = pathlib.Path(__file__).with_name("finer_style.py")
SQUARES = 12  # of a strip: the first three are the head, the others the torso


def faces_of(squares):
    """The numbers of the two faces of each square, from 0."""
    return [2 * square + side for square in squares for side in range(2)]


class Benchmark:
    """Strips of squares of side 1 in a folder like that of the Princeton benchmark."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "labeled" / "Strip").mkdir(parents=True)

    def add(self, name, *segmentations):
        """Each segmentation has the number of a segment per square."""
        points = [f"{x} {y} 0" for x in range(SQUARES + 1) for y in range(2)]
        faces = [f"3 {2 * x + a} {2 * x + b} {2 * x + c}" for x in range(SQUARES) for a, b, c in ((0, 2, 3), (0, 3, 1))]
        mesh = self.folder / "labeled" / "Strip" / f"{name}.off"
        mesh.write_text("\n".join(["OFF", f"{len(points)} {len(faces)} 0", *points, *faces]) + "\n")
        parts = {"head": faces_of(range(3)), "torso": faces_of(range(3, SQUARES))}
        mesh.with_name(f"{name}_labels.txt").write_text(
            "".join(f"{part}\n{' '.join(str(face + 1) for face in numbers)}\n" for part, numbers in parts.items()))
        (self.folder / "seg" / name).mkdir(parents=True)
        for person, segments in enumerate(segmentations):
            (self.folder / "seg" / name / f"{name}_{person}.seg").write_text("".join(f"{number}\n{number}\n" for number in segments))

    def run(self, out):
        return subprocess.run([sys.executable, "-B", SCRIPT, self.folder, "Strip", "torso", out], capture_output=True, text=True)


def squares(path):
    """The label of each square, from a label file; both of its faces must have it."""
    lines = path.read_text().splitlines()
    labels = {int(face) - 1: name for name, faces in zip(lines[::2], lines[1::2]) for face in faces.split()}
    assert len(labels) == 2 * SQUARES and all(labels[2 * i] == labels[2 * i + 1] for i in range(SQUARES))
    return [labels[2 * i] for i in range(SQUARES)]


class FinerStyle(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.benchmark = Benchmark(self.folder / "psb")

    def test_the_segments_are_named_by_their_distance_from_the_head(self):
        for name in ("1", "2"):  # the numbers of the segments say nothing of their order
            self.benchmark.add(name, [7] * 3 + [9] * 2 + [2] * 3 + [4] * 4)
        run = self.benchmark.run(self.folder / "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        expected = ["head"] * 3 + ["front"] * 2 + ["middle"] * 3 + ["rear"] * 4
        self.assertEqual(squares(self.folder / "out/1_labels.txt"), expected)
        lists = [(self.folder / "out" / f"{name}.txt").read_text().split() for name in ("train", "test")]
        self.assertEqual(sorted(pathlib.Path(path).name for both in lists for path in both), ["1.off", "2.off"])

    def test_of_two_people_the_one_with_the_most_even_thirds_counts(self):
        uneven, even = [0] * 3 + [1] * 2 + [2] * 2 + [3] * 5, [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3
        self.benchmark.add("1", uneven, even)
        self.benchmark.add("2", even, uneven)
        self.benchmark.run(self.folder / "out")
        for name in ("1", "2"):
            self.assertEqual(squares(self.folder / f"out/{name}_labels.txt")[3:], ["front"] * 3 + ["middle"] * 3 + ["rear"] * 3)

    def test_what_remains_of_the_part_joins_the_nearest_segment(self):
        # The square of the torso that is next to the head belongs to the head's segment.
        for name in ("1", "2"):
            self.benchmark.add(name, [0] * 4 + [1] * 3 + [2] * 2 + [3] * 3)
        self.benchmark.run(self.folder / "out")
        self.assertEqual(squares(self.folder / "out/1_labels.txt")[3:6], ["front"] * 3)

    def test_meshes_that_nobody_cut_in_three_are_left_out(self):
        three = [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3
        for name in ("1", "2"):
            self.benchmark.add(name, three)
        self.benchmark.add("two", [0] * 3 + [1] * 4 + [2] * 5)
        self.benchmark.add("crumb", [0] * 3 + [1] * 4 + [2] * 4 + [3])      # a ninth of the part
        self.benchmark.add("outside", [1] * 3 + [1] * 2 + [2] * 3 + [3] * 4)  # more of the segment is head than torso
        run = self.benchmark.run(self.folder / "out")
        self.assertEqual(run.stdout, "2 meshes: 1 2\n")
        self.assertEqual(sorted(path.name for path in (self.folder / "out").glob("*_labels.txt")), ["1_labels.txt", "2_labels.txt"])

    def test_what_cannot_be_used_is_said_in_one_line(self):
        self.benchmark.add("1", [0] * 3 + [1] * 3 + [2] * 3 + [3] * 3)
        run = self.benchmark.run(self.folder / "out")
        self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)
        self.assertIn("fewer than two meshes", run.stderr)
        segments = self.folder / "psb/seg/1/1_0.seg"
        for text, problem in (("0\n1\n", "2 segments of faces"), ("0\nx\n", "not numbers")):
            segments.write_text(text)
            run = self.benchmark.run(self.folder / "out")
            self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)
            self.assertIn(f"{segments}: ", run.stderr)
            self.assertIn(problem, run.stderr)


if __name__ == "__main__":
    programs.require_compare()
    unittest.main()

"""Labels painted in exemplar-viewer: by a script without a window, and with real mouse events in one (Xvfb, xdotool)."""

import json
import os
import signal
import stat
import time
import unittest

from program import write_off
from viewer_window import VIEWER, ViewerTest, WindowTest


def dumbbell(segments=16, rings=40):
    """Two balls joined by a bar along x: vertices, triangles, and which of the three parts each triangle belongs to."""
    import math
    vertices, faces, part = [], [], []
    for i in range(rings + 1):
        x = -3 + 6 * i / rings
        ball = 1 - (abs(x) - 2) ** 2
        radius = max(0.3, math.sqrt(ball) if ball > 0 else 0) if 0 < i < rings else 0.05
        vertices += [(x, radius * math.cos(2 * math.pi * k / segments), radius * math.sin(2 * math.pi * k / segments))
                     for k in range(segments)]
    for i in range(rings):
        x = -3 + 6 * (i + 0.5) / rings
        for k in range(segments):
            a, b = i * segments + k, i * segments + (k + 1) % segments
            faces += [(a, a + segments, b), (b, a + segments, b + segments)]
            part += 2 * ["ball left" if x < -1.05 else "ball right" if x > 1.05 else "bar"]
    for end, ring in ((0, 0), (1, rings)):
        vertices.append((-3.02 + 6.04 * end, 0, 0))
        for k in range(segments):
            a, b = ring * segments + k, ring * segments + (k + 1) % segments
            faces.append((len(vertices) - 1, b, a) if end else (len(vertices) - 1, a, b))
            part.append("ball right" if end else "ball left")
    return vertices, faces, part


def read_labels(path):
    """The label of each face, from a label file of the benchmark."""
    lines = [line for line in path.read_text().splitlines() if line.strip()]
    label = {}
    for name, faces in zip(lines[::2], lines[1::2]):
        for face in faces.split():
            label[int(face) - 1] = name
    return [label[face] for face in range(len(label))]


class Painting(ViewerTest):
    """A folder of dumbbells. Seen from the front, x runs to the right."""

    def setUp(self):
        self.shapes = self.folder / self.id().rsplit(".", 1)[-1]
        self.shapes.mkdir()
        vertices, faces, self.part = dumbbell()
        for i in range(3):
            write_off(self.shapes / f"bell{i}.off", [((1 + 0.1 * i) * x, y, z) for x, y, z in vertices], faces)

    def script(self, *lines, code=0, folder=None):
        (self.shapes / "script.txt").write_text("\n".join(lines) + "\n")
        return self.view(folder or self.shapes.name, "--label", "--headless", "--quiet", "--size", "400x300", "--script",
                         self.shapes / "script.txt", code=code)

    def right(self, name):
        """The share of the faces whose label is right."""
        labels = read_labels(self.shapes / f"{name}_labels.txt")
        self.assertEqual(len(labels), len(self.part))
        return sum(a == b for a, b in zip(labels, self.part)) / len(labels)


THREE_STROKES = ['label "ball left"', "label bar", 'label "ball right"', "side front", "radius 6", 'label "ball left"',
                 "stroke 60 150 80 150", "label bar", "stroke 180 150 220 150", 'label "ball right"', "stroke 320 150 340 150"]


class ByScript(Painting):
    def test_three_strokes_label_the_mesh(self):
        self.script(*THREE_STROKES, "wait features", "verify")
        self.assertGreater(self.right("bell0"), 0.93)
        self.assertFalse((self.shapes / "bell0_painting.json").exists())
        self.assertEqual([entry["name"] for entry in json.loads((self.shapes / "palette.json").read_text())["labels"]],
                         ["ball left", "bar", "ball right"])

    def test_what_was_learned_labels_the_other_shapes(self):
        said = self.script("label ball", "label bar", "side front", "radius 6", "label ball", "stroke 60 150 80 150",
                           "stroke 320 150 340 150", "label bar", "stroke 180 150 220 150", "wait features", "verify",
                           "wait learning", "state", "accept", "learn", "wait learning", "next", "wait features").stdout
        self.assertIn("bell0.off verified\nbell1.off suggested\nbell2.off suggested\n", said)
        accepted = said.split(" accepted")[0].rsplit("\n", 1)[-1].removesuffix(".off")
        self.part = [part.split()[0] for part in self.part]
        self.assertGreater(self.right(accepted), 0.8)
        self.assertTrue((self.shapes / "suggestions.safetensors").exists())

    def test_undo_and_redo(self):
        said = self.script(*THREE_STROKES[:5], 'label "ball left"', "stroke 60 150 80 150", "state", "stroke 60 130 80 130",
                           "undo", "state", "undo", "undo", "state", "redo", "redo", "erase 60 150 80 150", "undo", "state").stdout
        painted = [line.split()[0] for line in said.splitlines() if "faces painted" in line]
        self.assertEqual(painted[0], painted[1])
        self.assertEqual(painted[2], "0")
        self.assertGreater(int(painted[3]), int(painted[0]))

    def test_strokes_outlive_the_program(self):
        first = self.script(*THREE_STROKES, "state").stdout
        again = self.script("state").stdout
        self.assertEqual(first, again)

    def test_the_brush_leaves_what_is_hidden(self):
        seen = self.script("label a", "side front", "complete off", "radius 10", "stroke 60 150 340 150", "state").stdout
        all_through = self.script("label a", "side front", "complete off", "radius 10", "through on", "stroke 60 150 340 150",
                                  "state", folder=f"{self.shapes.name}/bell1.off").stdout
        painted = [int(text.split(" faces painted")[0].split("\n")[-1].split()[0]) for text in (seen, all_through)]
        self.assertGreater(painted[1], 1.7 * painted[0])

    def test_a_fill_takes_the_piece_and_a_lasso_what_it_encloses(self):
        said = self.script("label a", "side front", "complete off", "fill 200 150", "state", "undo", "lasso 0 0 200 0 200 300 0 300",
                           "state").stdout
        painted = [int(line.split()[0]) for line in said.splitlines() if "faces painted" in line]
        self.assertEqual(painted[0], len(self.part))
        self.assertTrue(len(self.part) / 8 < painted[1] < len(self.part) / 2, painted)

    def test_a_mirror_image(self):
        said = self.script("label a", "side front", "complete off", "stroke 60 150 80 150", "state", "mirror", "state").stdout
        painted = [int(line.split()[0]) for line in said.splitlines() if " of " in line and "faces painted" in line]
        self.assertAlmostEqual(painted[1], 2 * painted[0], delta=4)

    def test_a_labeled_mesh_opens_with_its_labels(self):
        truth = "\n".join(f"{name}\n" + " ".join(str(f + 1) for f, part in enumerate(self.part) if part == name)
                          for name in ("ball left", "bar", "ball right"))
        (self.shapes / "bell0_labels.txt").write_text(truth + "\n")
        self.script("open bell0", "state", "side front", "label bar", "radius 5", "stroke 330 150 335 150", "verify")
        changed = [a for a, b in zip(read_labels(self.shapes / "bell0_labels.txt"), self.part) if a != b]
        self.assertTrue(0 < len(changed) < 40 and set(changed) == {"bar"}, changed)

    def test_polygons_keep_their_faces(self):
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        write_off(self.shapes / "cube.off", corners, quads)
        self.script("label front", "label other", "complete off", "side front", "label other", "through on", "lasso 0 0 400 0 400 300 0 300",
                    "through off", "label front", "radius 3", "stroke 200 150", "verify", folder=f"{self.shapes.name}/cube.off")
        labels = read_labels(self.shapes / "cube_labels.txt")
        self.assertEqual(sorted(labels), ["front"] + 5 * ["other"])

    def test_faults_are_one_line(self):
        self.refused("there is no label to paint with", "stroke 200 150")
        self.refused("no command 'storke' (did you mean 'stroke'?)", "storke 1 2")
        self.refused("script.txt:2: places are pairs of pixels", "label a", "stroke 1 2 3")
        self.refused("there are two labels 'a'", "label a", "label b", "rename a")
        self.refused("a label needs a name", 'label "  "')
        self.refused("the name of a label has at most 100 bytes", "label " + 101 * "x")
        self.refused("have no label yet", "label a", "verify")

    def refused(self, what, *lines):
        error = self.script(*lines, code=1 if "no label yet" in what else 2).stderr
        self.assertIn(what, error)
        self.assertEqual(error.strip().count("\n"), 0, error)

    def test_a_label_file_that_another_program_changed_is_not_replaced_at_once(self):
        self.script(*THREE_STROKES, "wait features", "verify")
        lines = ["open bell0", "wait", "side front", "label bar", "stroke 60 150 80 150"]
        (self.shapes / "script.txt").write_text("\n".join(lines + ["wait learning", "wait learning", "verify"]) + "\n")
        process = self.start(self.shapes.name, "--label", "--headless", "--quiet", "--script", self.shapes / "script.txt",
                             program=VIEWER)
        for _ in range(600):  # until its strokes are kept, so its labels are read
            if (self.shapes / "bell0_painting.json").exists() or process.poll() is not None:
                break
            time.sleep(0.02)
        (self.shapes / "bell0_labels.txt").write_text("all\n" + " ".join(str(f + 1) for f in range(len(self.part))) + "\n")
        error = process.communicate(timeout=120)[1]
        self.assertIn("was changed by another program", error)
        self.assertEqual(set(read_labels(self.shapes / "bell0_labels.txt")), {"all"})

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_a_folder_that_cannot_be_written(self):
        self.shapes.chmod(stat.S_IRUSR | stat.S_IXUSR)
        self.addCleanup(self.shapes.chmod, stat.S_IRWXU)
        error = self.script(*THREE_STROKES, "wait", "verify", code=1).stderr
        self.assertIn("bell0_labels.txt", error)

    def test_a_broken_shape_is_told_and_passed_over(self):
        (self.shapes / "bell1.off").write_text("OFF\n3 1 0\n0 0 0\n")
        said = self.script("wait learning", "state").stdout
        self.assertIn("bell1.off broken", said)

    def test_damaged_strokes_are_told(self):
        self.script(*THREE_STROKES)
        (self.shapes / "bell0_painting.json").write_text('{"kind": "exemplar painting"')
        told = self.script("state")
        self.assertIn("bell0_painting.json: it is damaged", told.stderr)
        self.assertIn("0 of", told.stdout)


class ByHand(WindowTest, Painting):
    def drag(self, *places):
        self.xdotool("mousemove", *places[0])
        time.sleep(0.15)
        self.xdotool("mousedown", 1)
        for place in places[1:]:
            time.sleep(0.15)
            self.xdotool("mousemove", *place)
        time.sleep(0.15)
        self.xdotool("mouseup", 1)

    def strokes(self, name="bell0"):
        path = self.shapes / f"{name}_painting.json"
        if not path.exists():
            return 0
        return sum(run[1] for label in json.loads(path.read_text())["labels"] for run in label["faces"])

    def test_paints_undoes_is_killed_and_goes_on(self):
        (self.shapes / "palette.json").write_text(json.dumps({"labels": [{"name": name} for name in ("ball left", "bar", "ball right")]}))
        process, _ = self.open(self.shapes.name, "--label", "--plain", "--size", "400x300", "--side", "front")
        self.xdotool("mousemove", 200, 20, "key", "1")
        self.drag((60, 150), (70, 150), (80, 150))
        self.until(lambda: self.strokes() > 0, "the first stroke is kept")
        first = self.strokes()
        self.xdotool("key", "2")
        self.drag((180, 150), (200, 150), (220, 150))
        self.until(lambda: self.strokes() > first, "the second stroke is kept")
        both = self.strokes()
        self.xdotool("key", "ctrl+z")
        self.until(lambda: self.strokes() == first, "the second stroke is undone")
        self.xdotool("key", "ctrl+y")
        self.until(lambda: self.strokes() == both, "the second stroke is done again")
        process.send_signal(signal.SIGKILL)
        process.wait()
        process, _ = self.open(self.shapes.name, "--label", "--plain", "--size", "400x300", "--side", "front")
        self.xdotool("mousemove", 200, 20, "key", "3")
        self.drag((320, 150), (330, 150), (340, 150))
        self.until(lambda: self.strokes() > both, "the third stroke is kept beside those of before")
        time.sleep(2)
        self.xdotool("key", "Return")
        self.until((self.shapes / "bell0_labels.txt").exists, "the labels are saved")
        self.assertGreater(self.right("bell0"), 0.9)
        self.closes_well(process)

    def test_a_click_beside_the_mesh_and_closing_while_learning_are_safe(self):
        self.script(*THREE_STROKES, "wait features", "verify")
        process, _ = self.open(self.shapes.name, "--label", "--size", "900x600")
        self.drag((880, 580), (885, 590))
        self.xdotool("key", "Tab")
        time.sleep(0.5)
        self.closes_well(process)


if __name__ == "__main__":
    unittest.main()

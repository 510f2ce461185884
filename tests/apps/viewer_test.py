"""exemplar-viewer from outside: its pictures without a window, and its window on a display of its own (Xvfb).

Skipped where there is no Xvfb or xdotool.
"""

import re
import time
import unittest
import xml.etree.ElementTree as ElementTree

from png import read_png
from program import CUBE, CUBE_QUADS, CUBE_TRIANGLES, write_off
from viewer_window import HEIGHT, VIEWER, WIDTH, ViewerTest, WindowTest

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


class Viewer(ViewerTest):
    """With an animation."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "figure", "--vertices", "800", "--frames", "30", "--seed", "1", "--out", ".")

    learned_style = None  # the file

    @classmethod
    def learn_style(cls):
        """Leaves a style of hatching in the folder; it is learned once for all classes."""
        if Viewer.learned_style is None:
            drawn = ["shapes/fourleg_001.off", "--size", "260x240"]
            cls.call("synth", "fourleg", "--faces", "600", "--out", "shapes")
            cls.call("hatch", "example", "contour", *drawn, "--out", "drawing.png")
            cls.call("hatch", "train", drawn[0], "drawing.png", *drawn[1:], "--out", "style.safetensors")
            Viewer.learned_style = (cls.folder / "style.safetensors").read_bytes()
        (cls.folder / "style.safetensors").write_bytes(Viewer.learned_style)

    def still(self, name, *arguments):
        """The bytes of a hatched still."""
        self.view("figure_001.glb", "--headless", "--hatching", "style.safetensors", "--save-hatching", name, "--quiet",
                  "--size", "320x240", *arguments)
        return (self.folder / name).read_bytes()

    def picture(self, *arguments):
        self.view(*arguments, "--headless", "--out", "out", "--quiet")
        return read_png(self.folder / "out" / "frame_0000.png")


class Headless(Viewer):
    def test_frames_are_those_of_the_animation(self):
        self.view("figure_001.glb", "--headless", "--frames", "3", "--out", "frames", "--size", "160x120")
        files = sorted((self.folder / "frames").iterdir())
        self.assertEqual([file.name for file in files], ["frame_0000.png", "frame_0001.png", "frame_0002.png"])
        third = read_png(files[2])
        self.assertEqual(third[:2], (160, 120))
        self.assertGreater(len(set(zip(*[iter(third[2])] * 3))), 20)
        self.assertFalse(third[2] == read_png(files[0])[2])
        again = self.picture("figure_001.glb", "--size", "160x120", "--first-frame", "2")
        self.assertTrue(again == third)

    def test_labels_color_a_mesh(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        plain = self.picture("cube.off", "--size", "64x64", "--light", "none")[2]
        (self.folder / "cube_labels.txt").write_text("side\n1 3 4 5 6\nlid\n2\n")
        colored = self.picture("cube.off", "--size", "64x64", "--light", "none")[2]
        self.assertEqual(colored[3 * (32 * 64 + 32):][:3], bytes([64, 120, 200]))  # the second label's color
        self.assertFalse(plain == colored)

    def test_a_mesh_that_is_inside_out_looks_as_one_that_is_not(self):
        write_off(self.folder / "outside.off", CUBE, CUBE_TRIANGLES)
        write_off(self.folder / "inside.off", CUBE, [(a, c, b) for a, b, c in CUBE_TRIANGLES])
        look = ["--size", "64x64", "--lines", "contours,creases"]
        self.assertTrue(self.picture("inside.off", *look) == self.picture("outside.off", *look))
        said = self.view("inside.off", "--headless", "--size", "64x64").stderr
        self.assertIn("inside out", said)

    def test_vertices_at_one_place_are_joined(self):
        corners = [vertex for triangle in CUBE_TRIANGLES for vertex in triangle]
        write_off(self.folder / "joined.off", [CUBE[v] for v in dict.fromkeys(corners)],
                  [tuple(list(dict.fromkeys(corners)).index(v) for v in triangle) for triangle in CUBE_TRIANGLES])
        write_off(self.folder / "apart.off", [CUBE[v] for v in corners], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)])
        look = ["--size", "64x64", "--lines", "contours,creases,boundaries"]
        self.assertTrue(self.picture("apart.off", *look) == self.picture("joined.off", *look))

    def test_learned_curvature_is_shown_beside_that_of_every_frame(self):
        self.call("curvature", "train", "figure_001.glb", "--out", "m.safetensors", "--augment", "40")
        size = ["--size", "200x100", "--paint", "mean", "--first-frame", "4", "--lines", "none"]
        both = self.picture("figure_001.glb", "--model", "m.safetensors", "--curvature", "both", *size)
        half = self.picture("figure_001.glb", *size[2:], "--size", "100x100")
        right = b"".join(both[2][600 * y + 300:600 * (y + 1)] for y in range(100))
        left = b"".join(both[2][600 * y:600 * y + 300] for y in range(100))
        self.assertFalse(left == right)
        for picture in (left, half[2]):  # the model also has its own unit of smoothing
            self.assertLess(sum(abs(a - b) for a, b in zip(picture, right)) / 30000, 3)

    def test_says_that_the_device_measures_otherwise_than_a_robust_model(self):
        self.call("curvature", "train", "figure_001.glb", "--out", "r.safetensors", "--robust", "cauchy", "--augment",
                  "10")
        shown = self.view("figure_001.glb", "--model", "r.safetensors", "--headless", "--frames", "1", "--size", "64x64")
        self.assertIn("r.safetensors was trained with --robust", shown.stderr)

    def test_lines_and_styles_are_drawn(self):
        arguments = ["figure_001.glb", "--size", "200x150", "--first-frame", "3"]
        none = self.picture(*arguments, "--lines", "none", "--light", "none")
        contours = self.picture(*arguments, "--lines", "contours", "--light", "none")
        more = self.picture(*arguments, "--lines", "contours,ridges,valleys", "--light", "none")
        dark = [sum(max(pixel) < 100 for pixel in zip(*[iter(picture[2])] * 3)) for picture in (none, contours, more)]
        self.assertEqual(dark[0], 0)
        self.assertGreater(dark[1], 100)
        self.assertGreater(dark[2], dark[1])
        blue = self.picture(*arguments, "--style", "blueprint")
        self.assertEqual(blue[2][:3], bytes.fromhex("16407c"))

    def test_a_hatched_still(self):
        self.learn_style()
        drawn = self.still("one.svg", "--first-frame", "3", "--lines", "contours")
        layers = {g.get(LABEL): len(list(g.iter(SVG + "path"))) for g in ElementTree.fromstring(drawn).findall(SVG + "g")}
        self.assertEqual(list(layers), ["background", "hatching", "cross_hatching", "contours"])
        self.assertGreater(layers["hatching"], 20)
        self.assertGreater(layers["contours"], 0)
        self.assertEqual(self.still("two.svg", "--first-frame", "3", "--lines", "contours"), drawn)
        self.assertNotEqual(self.still("moved.svg", "--first-frame", "9", "--lines", "contours"), drawn)
        bare = self.still("bare.svg", "--first-frame", "3", "--lines", "none")
        self.assertNotIn(b'"contours"', bare)
        self.assertIn(bare.split(b"</g>")[1], drawn)  # the strokes are the same
        self.assert_no_leftovers()

    def test_a_hatched_still_as_a_picture(self):
        self.learn_style()
        drawn = self.still("one.png", "--lines", "contours")
        width, height, pixels = read_png(self.folder / "one.png")
        self.assertEqual((width, height), (320, 240))
        dark = sum(value < 128 for value in pixels[::3]) / (width * height)
        self.assertTrue(0.005 < dark < 0.4, dark)
        self.assertEqual(self.still("two.png", "--lines", "contours"), drawn)
        # Lines of a blueprint are pale; here they are on white paper.
        self.still("blue.png", "--lines", "contours", "--style", "blueprint")
        inked = sum(value < 128 for value in read_png(self.folder / "blue.png")[2][::3]) / (width * height)
        self.still("bare.png", "--lines", "none")
        bare = sum(value < 128 for value in read_png(self.folder / "bare.png")[2][::3]) / (width * height)
        self.assertGreater(inked, 1.2 * bare)

    def test_what_cannot_be_hatched_is_refused_in_one_line(self):
        self.learn_style()
        (self.folder / "text.safetensors").write_text("no model at all")
        self.call("curvature", "train", "figure_001.glb", "--out", "figure.safetensors", "--augment", "40")
        draw = ["figure_001.glb", "--headless", "--size", "64x48"]
        save = [*draw, "--save-hatching", "x.svg", "--hatching"]
        for arguments, code, says in [([*save, "none.safetensors"], 1, "none.safetensors"),
                                      ([*save, "text.safetensors"], 1, "text.safetensors"),
                                      ([*save, "figure.safetensors"], 1, ["figure.safetensors", "no hatching style"]),
                                      ([*draw, "--model", "style.safetensors"], 1, ["style.safetensors", "no curvature model"]),
                                      (["text.safetensors", "--headless"], 1, "text.safetensors"),
                                      (["style.safetensors", "--headless"], 2, "nothing to draw in style.safetensors"),
                                      (["figure.safetensors", "--headless"], 2, "open the animation first"),
                                      ([*save, "style.safetensors", "--frames", "2"], 2, "--frames"),
                                      ([*save, "style.safetensors", "--out", "x"], 2, "--out"),
                                      ([*draw, "--save-hatching", "x.svg"], 2, "--hatching"),
                                      ([draw[0], *save[2:], "style.safetensors"], 2, "--headless"),
                                      ([*draw, "--hatching", "style.safetensors", "--save-hatching", "x.jpg"], 2,
                                       ["x.jpg", ".svg", ".png"]),
                                      ([*draw, "--hatching", "style.safetensors", "--save-hatching", "style.safetensors/x.svg"], 1,
                                       "style.safetensors/x.svg")]:
            self.refused(*arguments, code=code, says=says, program=VIEWER)
        self.assertFalse((self.folder / "x.svg").exists())

    def test_memory_does_not_grow(self):
        output = self.view("figure_001.glb", "--headless", "--frames", "500", "--size", "96x64", "--paint", "mean").stdout
        before, after = map(float, re.search(r"memory: ([\d.]+) MiB after .*, ([\d.]+) MiB after 500", output).groups())
        self.assertLess(after - before, 2)  # MiB; a kilobyte a frame would be half of that

    def test_wrong_arguments_are_refused_in_one_line(self):
        for arguments, code, says in [(["nowhere.glb", "--headless"], 1, "nowhere.glb"),
                                      (["--headless"], 2, "FILE"),
                                      (["figure_001.glb", "--size", "0x9"], 2, "0x9"),
                                      (["figure_001.glb", "--out", "x"], 2, "--headless"),
                                      (["figure_001.glb", "--headless", "--clip", "moton_1"], 2, "'motion_1'"),
                                      (["figure_001.glb", "--headless", "--model", "figure_001.glb"], 1, "figure"),
                                      (["figure_001.glb", "--lines", "contuors"], 2, "'contours'"),
                                      (["figure_001.glb", "--headless", "--style", "inc"], 1, "'ink'"),
                                      (["figure_001.glb", "--paint", "red"], 2, "red")]:
            self.refused(*arguments, code=code, says=says, program=VIEWER)

    def test_without_a_display_it_says_how_to_do_without(self):
        environment = dict(self.environment)
        self.environment.pop("DISPLAY", None)
        self.environment.pop("WAYLAND_DISPLAY", None)
        try:
            self.refused("figure_001.glb", code=2, says="--headless", program=VIEWER)
        finally:
            self.environment.update(environment)


class InWindow(WindowTest, Viewer):
    def test_shows_the_headless_picture_in_every_size(self):
        frame = ["figure_001.glb", "--first-frame", "7"]
        process, window = self.open(*frame, "--plain", "--size", "640x480")
        picture = self.picture(*frame, "--size", "640x480")
        self.until(lambda: self.difference(picture) <= 2, "the window shows the headless picture")
        for width, height in [(400, 300), (1, 1), (3, 700), (800, 600)]:
            self.xdotool("windowsize", window, width, height)
            time.sleep(0.3)
            self.assertIsNone(process.poll())
        larger = self.picture(*frame, "--size", "800x600")
        self.until(lambda: self.difference(larger) <= 2, "the larger window shows the larger picture")
        self.closes_well(process)

    def test_survives_being_hidden_and_dragged_to_sizes(self):
        process, window = self.open("figure_001.glb")
        self.xdotool("windowunmap", window)
        time.sleep(0.5)
        self.xdotool("windowmap", window)
        for i in range(30):
            self.xdotool("windowsize", window, 300 + 31 * i, 680 - 17 * i)
        time.sleep(0.5)
        self.closes_well(process)

    def test_hands_move_the_camera_and_keys_do_what_they_say(self):
        process, window = self.open("figure_001.glb", "--first-frame", "3", "--plain", "--size", "640x480")
        picture = self.picture("figure_001.glb", "--first-frame", "3", "--size", "640x480")
        self.until(lambda: self.difference(picture) <= 2, "the window shows the picture")
        for step in [("mousemove", 320, 240), ("mousedown", 1), ("mousemove", 400, 200), ("mouseup", 1)]:
            self.xdotool(*step)
            time.sleep(0.3)
        self.until(lambda: self.difference(picture) > 50, "a drag turns the camera")
        self.xdotool("key", "4")
        right = self.picture("figure_001.glb", "--first-frame", "3", "--size", "640x480", "--side", "right")
        self.until(lambda: self.difference(right) <= 2, "4 looks from the right")
        for key in ["1", "5", "f", "s", "c", "c", "c", "o", "p", "g", "h", "space", "period", "Tab", "v", "r"]:
            self.xdotool("key", key)
            time.sleep(0.05)
        self.xdotool("key", "ctrl+s")
        self.until(lambda: list(self.folder.glob("figure_001_*.png")), "Ctrl+S saves a picture")
        self.xdotool("key", "ctrl+e")
        self.until(lambda: list(self.folder.glob("figure_001_*.svg")), "Ctrl+E saves the lines")
        self.assertIn("<path", next(self.folder.glob("figure_001_*.svg")).read_text())
        self.closes_well(process)

    def test_what_is_side_by_side_is_saved_so(self):
        self.call("curvature", "train", "figure_001.glb", "--out", "m.safetensors", "--augment", "40")
        before = set(self.folder.glob("figure_001_*.svg"))
        saved = lambda: set(self.folder.glob("figure_001_*.svg")) - before
        process, _ = self.open("figure_001.glb", "--model", "m.safetensors", "--curvature", "both", "--plain",
                               "--lines", "contours,suggestive", "--size", "640x480")
        time.sleep(0.5)
        self.xdotool("key", "ctrl+e")
        self.until(saved, "Ctrl+E saves the lines")
        places = [float(x) for x in re.findall(r"[ML]([0-9.]+)", saved().pop().read_text())]
        self.assertTrue(any(x < 300 for x in places) and any(x > 340 for x in places), places[:20])
        self.closes_well(process)

    def test_hatches_in_the_background_what_headless_hatches(self):
        self.learn_style()
        process, _ = self.open("figure_001.glb", "--hatching", "style.safetensors", "--first-frame", "3", "--plain",
                               "--size", "320x240")
        picture = self.picture("figure_001.glb", "--first-frame", "3", "--size", "320x240")
        self.until(lambda: self.difference(picture) <= 2, "the window shows the picture")
        self.xdotool("mousemove", 200, 100, "key", "ctrl+h")
        time.sleep(0.2)
        self.xdotool("key", "4")  # what is drawn is what was shown at the key
        saved = [self.folder / f"figure_001_hatched_0{extension}" for extension in (".svg", ".png")]
        self.until(lambda: all(file.exists() for file in saved), "Ctrl+H saves a hatched still")
        self.closes_well(process)
        for file in saved:
            self.assertEqual(file.read_bytes(), self.still("still" + file.suffix, "--first-frame", "3"))

    def test_says_that_hatching_needs_a_style(self):
        process, _ = self.open("figure_001.glb", "--first-frame", "3", "--plain", "--size", "320x240")
        picture = self.picture("figure_001.glb", "--first-frame", "3", "--size", "320x240")
        self.until(lambda: self.difference(picture) <= 2, "the window shows the picture")
        self.xdotool("mousemove", 200, 200, "key", "ctrl+h")
        self.until(lambda: self.difference(picture) > 50, "a message is shown")
        self.closes_well(process)

    def test_closes_while_it_hatches(self):
        self.learn_style()
        self.call("synth", "fourleg", "--faces", "30000", "--out", "large")
        process, _ = self.open("large/fourleg_001.off", "--hatching", "style.safetensors", "--size", "640x480")
        time.sleep(1)
        self.xdotool("mousemove", 500, 200, "key", "ctrl+h")
        time.sleep(1)
        self.closes_well(process)
        self.assertEqual(list(self.folder.glob("fourleg_001_hatched*")), [])
        self.assert_no_leftovers()

    def test_a_lost_device_is_opened_again(self):
        process, _ = self.open("figure_001.glb", "--first-frame", "7", "--plain", "--size", "640x480",
                               "--lose-device-at", "2")
        time.sleep(2)
        self.closes_well(process)

    def test_what_cannot_be_drawn_is_closed_with_a_message(self):
        process, _ = self.open("figure_001.glb", "--size", "640x480", "--fail-at", "2")
        self.until(lambda: self.xdotool("search", "--name", "^Exemplar$", check=False).strip(),
                   "the title of a window without a document")
        self.closes_well(process)

    def test_ends_after_as_many_frames_as_asked(self):
        output = self.view("figure_001.glb", "--frames", "40", "--size", "320x240").stdout
        self.assertRegex(output, r"first frame after \d+ ms")


if __name__ == "__main__":
    unittest.main()

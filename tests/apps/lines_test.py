"""Line drawings of meshes and animations, as SVG, pictures and videos."""

import json
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree

from png import read_png
from program import ProgramTest, CUBE, CUBE_QUADS, write_off

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
MODE = "{http://www.inkscape.org/namespaces/inkscape}groupmode"
ANIMATION = ["--vertices", "800", "--frames", "24"]


class Lines(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "human", "--faces", "4000", "--out", "shapes")
        cls.call("synth", "figure", *ANIMATION, "--out", "moving")
        cls.call("synth", "flag", *ANIMATION, "--out", "moving")
        write_off(cls.folder / "cube.off", [(x - 0.5, y - 0.5, z - 0.5) for x, y, z in CUBE], CUBE_QUADS)

    def draw(self, source, *options, out="drawing.svg"):
        """The root of the SVG file."""
        self.call("lines", source, "--out", out, *options)
        self.assert_no_leftovers()
        root = ElementTree.parse(self.folder / out).getroot()
        self.assertEqual(root.tag, SVG + "svg")
        return root

    def layers(self, group):
        """{label: layer} of the layers directly inside."""
        return {g.get(LABEL): g for g in group.findall(SVG + "g") if g.get(MODE) == "layer"}

    def paths(self, group):
        return list(group.iter(SVG + "path"))

    def test_a_mesh_with_the_defaults(self):
        root = self.draw("shapes/human_001.off", "--json", "report.json")
        self.assertEqual((root.get("width"), root.get("height"), root.get("viewBox")), ("1000px", "800px", "0 0 1000 800"))
        layers = self.layers(root)
        self.assertEqual(list(layers), ["background", "suggestive_contours", "boundaries", "contours"])
        self.assertEqual(len(self.paths(layers["boundaries"])), 0)
        self.assertGreater(len(self.paths(layers["contours"])), 2)
        self.assertGreater(len(self.paths(layers["suggestive_contours"])), 2)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(report["paths"], len(self.paths(root)))
        self.assertEqual(report["bytes"], (self.folder / "drawing.svg").stat().st_size)
        self.assertGreater(report["types"]["contours"]["visible_pixels"], 1000)
        self.assertEqual(set(report["seconds"]), {"read", "curvature", "lines", "visibility", "strokes", "write"})

    def test_only_the_edges_of_a_cube_that_are_seen(self):
        root = self.draw("cube.off", "--types", "creases", "--style", "technical", "--json", "cube.json")
        paths = self.paths(self.layers(root)["creases"])
        self.assertEqual(len(paths), 9)
        self.assertEqual({path.get("stroke-width") for path in paths}, {"0.9"})
        self.call("lines", "--types", "crease,bound", "--threshold", "crease=30", "cube.off", "--out", "order.svg")
        front = self.draw("cube.off", "--types", "crease", "--view", "front", "--fov", "0", "--style", "technical")
        self.assertEqual(len(self.paths(front)), 4)

    def test_the_outline_is_complete(self):
        for source, types in [("cube.off", "contours"), ("shapes/human_001.off", "contours,suggestive")]:
            for out in ["check.svg", "check.png"]:
                with self.subTest(source=source, out=out):
                    done = self.call("lines", source, "--types", types, "--check", "--out", out, "--json", "check.json")
                    self.assertIn("% of the silhouette", done.stdout)
                    outline = json.loads((self.folder / "check.json").read_text())["outline"]
                    self.assertGreater(outline["silhouette_pixels"], 500)
                    self.assertGreater(outline["outlined"], 0.97)
                    self.assertLess(outline["stray"], 0.05)
        self.call("lines", "cube.off", "--types", "highlights", "--check", "--out", "none.svg", "--json", "none.json")
        self.assertEqual(json.loads((self.folder / "none.json").read_text())["outline"]["outlined"], 0)

    def test_no_path_leaves_the_picture(self):
        near = ["--eye", "0.8,0.6,2", "--fov", "30", "--types", "creases,contours"]
        for form in [[], ["--curves"], ["--form", "outlines"]]:
            root = self.draw("cube.off", *near, *form, "--size", "300x200")
            points = [float(n) for path in self.paths(root) for n in re.findall(r"-?[0-9.]+", path.get("d"))]
            self.assertGreater(len(points), 8)
            self.assertTrue(all(0 <= x <= 300 for x in points[::2]) and all(0 <= y <= 200 for y in points[1::2]))

    def test_every_type_every_style_and_both_forms(self):
        for style in ["ink", "pencil", "charcoal", "brush", "technical", "blueprint", "colored"]:
            for form in ["lines", "outlines"]:
                with self.subTest(style=style, form=form):
                    root = self.draw("shapes/human_001.off", "--types", "all", "--style", style, "--form", form)
                    self.assertEqual(len(self.layers(root)), 10)
                    attribute = "stroke" if form == "lines" else "fill"
                    self.assertTrue(self.layers(root)["contours"].get(attribute).startswith("#"))

    def test_equal_calls_give_equal_files_for_any_number_of_threads(self):
        self.draw("shapes/human_001.off", "--types", "all", "--threads", "1", out="a.svg")
        self.draw("shapes/human_001.off", "--types", "all", out="b.svg")
        self.assertEqual((self.folder / "a.svg").read_bytes(), (self.folder / "b.svg").read_bytes())

    def test_cameras(self):
        def box(root):
            """The corners of what is drawn."""
            numbers = [float(n) for path in self.paths(root)
                       for n in path.get("d").replace("M", " ").replace("L", " ").replace("Z", " ").split()]
            return min(numbers[::2]), max(numbers[::2]), min(numbers[1::2]), max(numbers[1::2])

        edges = ["--types", "creases", "--style", "technical", "--size", "400x400", "--fov", "0"]
        left, right, top, bottom = box(self.draw("cube.off", *edges, "--view", "top"))
        self.assertAlmostEqual(left, 400 - right, delta=1)
        self.assertAlmostEqual(top, 10, delta=1)
        placed = box(self.draw("cube.off", *edges[:-2], "--eye", "0,0,20", "--target", "0,0,0", "--fov", "10"))
        self.assertAlmostEqual(placed[0] + placed[1], 400, delta=1)
        self.assertGreater(placed[0], 50)
        near = box(self.draw("cube.off", *edges[:-2], "--eye", "0,0,10", "--fov", "10"))
        self.assertGreater(near[1] - near[0], 1.5 * (placed[1] - placed[0]))

    def test_frames_of_an_animation_play(self):
        root = self.draw("moving/figure_001.glb", "--frames", "2:5")
        frames = [layer for label, layer in self.layers(root).items() if label.startswith("frame")]
        self.assertEqual(len(frames), 3)
        for frame in frames:
            self.assertEqual(frame.find(SVG + "animate").get("dur"), "0.1s")
            self.assertGreater(len(self.paths(frame)), 5)
        first, second = ([p.get("d") for p in self.paths(frame)] for frame in frames[:2])
        self.assertNotEqual(first, second)
        one = self.draw("moving/flag_001")  # a folder; the first frame
        self.assertEqual(list(self.layers(one)), ["background", "suggestive_contours", "boundaries", "contours"])

    def test_a_picture_shows_what_the_svg_file_has(self):
        edges = ["--types", "creases", "--style", "technical", "--view", "front", "--fov", "0", "--size", "200x100"]
        self.call("lines", "cube.off", *edges, "--out", "cube.png")
        self.assert_no_leftovers()
        width, height, pixels = read_png(self.folder / "cube.png")
        self.assertEqual((width, height), (200, 100))
        dark = [(i % 200, i // 200) for i in range(20000) if pixels[3 * i] < 128]
        # A square with a margin of a twentieth of half the height.
        self.assertGreater(len(dark), 300)
        for x, y in dark:
            self.assertTrue(min(abs(x - 52), abs(x - 147), abs(y - 2), abs(y - 97)) <= 2, (x, y))
        self.call("lines", "cube.off", *edges, "--no-background", "--out", "clear.png")
        clear = read_png(self.folder / "clear.png")[2]
        self.assertEqual({clear[4 * i + 3] for i in (0, 199, 19999)}, {0})
        self.assertEqual(max(clear[3::4]), 255)

    def test_a_folder_has_a_picture_of_each_frame(self):
        self.call("lines", "moving/figure_001.glb", "--size", "100x80", "--frames", "2:5", "--out", "frames",
                  "--json", "frames.json")
        files = sorted((self.folder / "frames").iterdir())
        self.assertEqual([f.name for f in files], ["frame_0000.png", "frame_0001.png", "frame_0002.png"])
        self.assertNotEqual(files[0].read_bytes(), files[1].read_bytes())
        report = json.loads((self.folder / "frames.json").read_text())
        self.assertEqual(report["frames"], 3)
        self.assertLess(report["flicker"]["appeared"], 0.5)
        self.assertLess(report["flicker"]["slip"], 20)
        self.refused("lines", "moving/figure_001.glb", "--frames", "2:5", "--out", "x.png", code=2, says="3 frames")

    VIDEO = ["lines", "moving/figure_001.glb", "--size", "101x80", "--frames", "2:5", "--out", "walk.mp4"]

    def with_ffmpeg(self, script):
        """Puts a program of that name first, for this test."""
        programs = self.folder / "programs"
        programs.mkdir(exist_ok=True)
        (programs / "ffmpeg").write_text("#!/bin/sh\n" + script)
        (programs / "ffmpeg").chmod(0o755)
        before = self.environment["PATH"]
        self.environment["PATH"] = f"{programs}:{before}"
        self.addCleanup(self.environment.update, PATH=before)

    def test_videos_are_made_where_there_is_ffmpeg(self):
        if shutil.which("ffmpeg") is None:
            self.refused(*self.VIDEO, code=2, says="ffmpeg")
        else:
            self.call(*self.VIDEO)
            probe = subprocess.run(["ffmpeg", "-i", self.folder / "walk.mp4", "-f", "null", "-"], capture_output=True)
            self.assertIn(b"frame=    3", probe.stderr)
        self.assert_no_leftovers()
        self.refused(*self.VIDEO, "--no-background", code=2, says="")

    def test_a_video_gets_all_pixels_of_all_frames(self):
        self.with_ffmpeg('for out; do :; done; echo "$@" >words; cat >"$out"\n')
        self.call(*self.VIDEO)
        self.assertEqual((self.folder / "walk.mp4").stat().st_size, 3 * 3 * 101 * 80)
        (self.folder / "walk.mp4").unlink()
        words = (self.folder / "words").read_text()
        for option in ("-pixel_format rgb24", "-video_size 101x80", "-framerate 30"):
            self.assertIn(option, words)

    def test_an_ffmpeg_that_fails_is_told_in_a_line(self):
        for script in ("exit 1\n", "head -c 1000 >/dev/null; exit 1\n", "cat >/dev/null; exit 1\n"):
            self.with_ffmpeg(script)
            self.refused(*self.VIDEO, code=1, says=["walk.mp4", "ffmpeg"])
            self.assertFalse((self.folder / "walk.mp4").exists())
            self.assertEqual(list(self.folder.glob(".part*")), [])

    def test_curvature_of_a_model(self):
        self.call("curvature", "train", "moving/figure_001.glb", "--out", "m.safetensors", "--augment", "60")
        learned = self.draw("moving/figure_001.glb", "--model", "m.safetensors", "--frames", "12")
        self.assertGreater(len(self.paths(self.layers(learned)["suggestive_contours"])), 0)
        self.refused("lines", "moving/flag_001", "--model", "m.safetensors", "--out", "x.svg", code=1, says="skeleton")
        self.refused("lines", "cube.off", "--model", "m.safetensors", "--out", "x.svg", code=2, says="--model")
        self.refused("lines", "moving/figure_001.glb", "--model", "cube.off", "--out", "x.svg", code=1, says="cube.off")

    def test_learned_lines_beside_measured_ones(self):
        self.call("curvature", "train", "moving/figure_001.glb", "--frames", ":20", "--out", "c.safetensors", "--augment", "60")
        compare = ["lines", "moving/figure_001.glb", "--model", "c.safetensors", "--compare", "--types", "contour,sugg,ridge",
                   "--size", "120x90"]
        printed = self.call(*compare, "--frames", "21:23", "--out", "both", "--json", "c.json").stdout
        self.assertEqual(len(list((self.folder / "both").iterdir())), 2)
        width, height, pixels = read_png(self.folder / "both" / "frame_0000.png")
        self.assertEqual((width, height), (240, 90))
        comparison = json.loads((self.folder / "c.json").read_text())["comparison"]
        # Contours are the same by any curvature.
        self.assertEqual(set(comparison["types"]), {"suggestive_contours", "ridges"})
        for name in ["suggestive_contours", "ridges", "any of these"]:
            self.assertIn(name, printed)
        for share in [*comparison["types"].values(), comparison["any"]]:
            self.assertLess(share["misclassified"], share["faces_with_line"])
        self.assertGreater(comparison["any"]["misclassified"], 0)

        # The halves are the pictures that either curvature makes.
        def half(side):
            return b"".join(bytes(pixels[3 * (240 * y + 120 * side):][:360]) for y in range(90))

        alone = [word for word in compare if word != "--compare"]
        self.call(*alone, "--frames", "21:23", "--out", "learned")
        self.assertEqual(half(0), bytes(read_png(self.folder / "learned" / "frame_0000.png")[2]))
        self.assertNotEqual(half(0), half(1))

        # Seen from six sides, it is what the model's evaluation says, but for faces at the thresholds.
        self.call("curvature", "evaluate", "c.safetensors", "moving/figure_001.glb", "--frames", "21:23", "--json", "e.json")
        for name, told in json.loads((self.folder / "e.json").read_text())["lines"].items():
            if name in comparison["types"]:
                for key in ["faces_with_line", "misclassified"]:
                    self.assertAlmostEqual(told[key], comparison["types"][name]["six_sides"][key], delta=1e-3)

        self.call(*compare, "--frames", "22", "--out", "one.png")
        self.assertEqual(read_png(self.folder / "one.png")[:2], (240, 90))
        self.refused(*compare, "--out", "x.svg", code=2, says=["x.svg", "--compare"])
        self.refused("lines", "moving/figure_001.glb", "--compare", "--out", "x.png", code=2, says="--model")
        self.refused("lines", "moving/flag_001", *compare[2:], "--out", "x.png", code=1, says="skeleton")
        self.refused("lines", "cube.off", *compare[2:], "--out", "x.png", code=2, says="--model")
        self.refused(*compare[:5], "--types", "contour", "--out", "x.png", code=2, says="--types")

    def test_a_style_file_starts_from_a_printed_style(self):
        printed = self.call("lines", "--print-style", "ink").stdout
        style = json.loads(printed)
        style["contours"]["color"] = "#123456"
        (self.folder / "my.json").write_text(json.dumps(style))
        root = self.draw("cube.off", "--types", "contours", "--style", "my.json")
        self.assertEqual(self.layers(root)["contours"].get("stroke"), "#123456")
        self.assertNotIn("background", self.layers(self.draw("cube.off", "--style", "my.json", "--no-background")))
        self.refused("lines", "--print-style", "inc", code=2, says=["'inc'", "'ink'"])

    def test_thresholds(self):
        def length(*options):
            self.draw("shapes/human_001.off", "--types", "valleys", "--json", "r.json", *options)
            return json.loads((self.folder / "r.json").read_text())["types"]["valleys"]["visible_pixels"]

        self.assertGreater(length(), 2 * length("--threshold", "valleys=0.5"))
        self.assertEqual(length("--threshold", "valleys=1e6"), 0)

    def test_wrong_input_is_one_line(self):
        refused = self.refused
        refused("lines", "cube.off", "--out", "x.pdf", code=2, says=["x.pdf", ".svg"])
        refused("lines", "cube.off", code=2, says="--out")
        refused("lines", "--out", "x.svg", code=2, says="MESH")
        refused("lines", "cbue.off", "--out", "x.svg", code=1, says=["cbue.off", "'cube.off'"])
        refused("lines", "cube.off", "--out", "x.svg", "--types", "contuors", code=2, says=["'contuors'", "'contours'"])
        refused("lines", "cube.off", "--out", "x.svg", "--style", "inkk", code=1, says=["inkk", "'ink'"])
        refused("lines", "cube.off", "--out", "x.svg", "--style", "cube.off", code=1, says=["cube.off:1:1", "JSON"])
        refused("lines", "cube.off", "--out", "x.svg", "--view", "frnt", code=2, says=["'frnt'", "'front'"])
        refused("lines", "cube.off", "--out", "x.svg", "--eye", "1,2", code=2, says=["--eye", "'1,2'"])
        refused("lines", "cube.off", "--out", "x.svg", "--target", "1,2,3", code=2, says="--eye")
        refused("lines", "cube.off", "--out", "x.svg", "--eye", "1,2,3", "--target", "1,2,3", code=2, says="same point")
        refused("lines", "cube.off", "--out", "x.svg", "--up", "0,0,0", code=2, says="--up")
        refused("lines", "cube.off", "--out", "x.svg", "--fov", "200", code=2, says="--fov")
        refused("lines", "cube.off", "--out", "x.svg", "--size", "100", code=2, says=["--size", "'100'"])
        refused("lines", "cube.off", "--out", "x.svg", "--size", "0x5", code=2, says="--size")
        refused("lines", "cube.off", "--out", "x.svg", "--threshold", "ridges", code=2, says="'ridges'")
        refused("lines", "cube.off", "--out", "x.svg", "--threshold", "contours=1", code=2, says="contours")
        refused("lines", "cube.off", "--out", "x.svg", "--form", "line", code=2, says="'lines'")
        refused("lines", "cube.off", "--out", "x.svg", "--fading", "blur", code=2, says="opacity")
        refused("lines", "moving/figure_001.glb", "--frames", "9:3", "--out", "x.svg", code=2, says="9:3")
        refused("lines", "moving/figure_001.glb", "--clips", "nod", "--out", "x.svg", code=2, says="nod")
        refused("lines", "cube.off", "--out", "cube.off/x.svg", code=2, says="no folder")
        write_off(self.folder / "empty.off", CUBE, [])
        refused("lines", "empty.off", "--out", "x.svg", code=1, says="empty.off")
        write_off(self.folder / "point.off", [(5, 5, 5)] * 3, [(0, 1, 2)])
        refused("lines", "point.off", "--out", "x.svg", code=1, says=["point.off", "one place"])
        self.assertFalse((self.folder / "x.svg").exists())

    def test_poor_meshes_are_drawn(self):
        write_off(self.folder / "triangle.off", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        self.assertEqual(len(self.paths(self.draw("triangle.off", "--types", "all", "--style", "technical"))), 1)
        write_off(self.folder / "flat.off", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2), (0, 0, 1)])
        self.draw("flat.off", "--types", "all")
        fan = [(0, 0, 0), (0, 0, 1), (1, 0, 0.5), (-0.5, 0.8, 0.5), (-0.5, -0.8, 0.5)]
        write_off(self.folder / "fan.off", fan, [(0, 1, 2), (0, 1, 3), (1, 0, 4)])
        layers = self.layers(self.draw("fan.off", "--types", "creases,boundaries"))
        self.assertGreaterEqual(len(self.paths(layers["creases"])), 1)
        layers = self.layers(self.draw("fan.off", "--types", "all"))  # in which it is on the outline
        self.assertEqual(len(self.paths(layers["creases"])), 0)
        self.assertGreaterEqual(len(self.paths(layers["contours"])), 1)


if __name__ == "__main__":
    unittest.main()

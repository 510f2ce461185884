"""Hatching: a view to trace, a drawing by a known rule, what is measured of it, the style learned from it, and drawings in it."""

import json
import math
import unittest
import xml.etree.ElementTree as ElementTree

from png import read_png
from program import ProgramTest, CUBE, CUBE_QUADS, CUBE_TRIANGLES, write_off

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
VIEW = ["--size", "500x460"]
MESH = "shapes/fourleg_001.off"
PROPERTIES = {"orientation", "thickness", "intensity", "spacing", "length", "levels"}


class Hatch(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("synth", "fourleg", "--faces", "2500", "--out", "shapes")
        cls.call("hatch", "example", "contour", MESH, *VIEW, "--out", "drawing.png")
        cls.call("hatch", "train", MESH, "drawing.png", *VIEW, "--out", "style.safetensors", "--json", "train.json")

    def test_a_view_to_trace(self):
        self.call("hatch", "template", MESH, *VIEW, "--out", "template.png", "--json", "template.json")
        report = json.loads((self.folder / "template.json").read_text())
        self.assertEqual((report["width"], report["height"]), (500, 460))
        self.assertGreater(report["pixels"], 5000)

    def test_a_template_tells_the_view(self):
        self.call("hatch", "template", MESH, *VIEW, "--light", "0.3,0.2,1", "--out", "told.png")
        extract = ["hatch", "extract", MESH, "drawing.png"]
        for name, view in (("told", ["--template", "told.png"]), ("said", [*VIEW, "--light", "0.3,0.2,1"])):
            self.call(*extract, *view, "--out", name)
        for picture in (self.folder / "told").iterdir():
            self.assertEqual(picture.read_bytes(), (self.folder / "said" / picture.name).read_bytes())
        self.refused(*extract, "--template", "told.png", "--fov", "30", "--out", "no", code=2, says="--fov excludes --template")
        self.refused(*extract, "--template", "drawing.png", "--out", "no", code=1, says="drawing.png: the picture tells no view")
        self.refused(*extract, "--template", MESH, "--out", "no", code=1, says="tells no view; give a picture of")
        write_off(self.folder / "cube.off", CUBE, CUBE_TRIANGLES)
        self.refused("hatch", "extract", "cube.off", "drawing.png", "--template", "told.png", "--out", "no", code=1,
                     says="told.png: shows another mesh than cube.off (12 faces): fourleg_001.off with")

    def test_the_view_of_a_drawing_is_found(self):
        camera = ["--eye=3,1.2,2.5", "--target=0,0.5,0", "--fov", "32", "--size", "420x360"]
        self.call("lines", MESH, *camera, "--types", "contours", "--out", "outlines.png")
        register = ["hatch", "register", MESH, "outlines.png"]
        said = self.call(*register, "--light", "0.1,0.2,1", "--out", "found.json", "--json", "register.json").stdout
        self.assertIn("found.json: the outlines fit to", said)
        report = json.loads((self.folder / "register.json").read_text())
        eye, target = ([float(x) for x in report[key].split(",")] for key in ("eye", "target"))
        way = [a - b for a, b in zip(eye, target)]
        cosine = (3 * way[0] + 0.7 * way[1] + 2.5 * way[2]) / math.hypot(*way) / math.hypot(3, 0.7, 2.5)
        self.assertGreater(cosine, math.cos(math.radians(4)), report)
        self.assertLess(report["residual"], 1)
        self.assertEqual(read_png(self.folder / "found_overlay.png")[:2], (420, 360))
        self.assertEqual(json.loads((self.folder / "found.json").read_text())["light"], [0.1, 0.2, 1])
        self.call("hatch", "template", MESH, *camera, "--light", "0.5,0.5,1", "--out", "shaded.png")
        said = self.call(*register, "--place", *camera[:-2], "--shaded", "shaded.png", "--out", "placed.json").stdout
        light = json.loads((self.folder / "placed.json").read_text())["light"]
        self.assertGreater((light[0] + light[1] + 2 * light[2]) / math.sqrt(6), 0.97, said)
        self.call("hatch", "extract", MESH, "outlines.png", "--template", "placed.json", "--out", "placed")
        write_off(self.folder / "cube.off", CUBE, CUBE_TRIANGLES)
        self.refused("hatch", "register", "cube.off", "outlines.png", "--out", "no.json", code=1, says="no view of cube.off fits")
        self.assertFalse((self.folder / "no.json").exists())

    def test_what_is_measured_of_a_drawing(self):
        self.call("hatch", "extract", MESH, "drawing.png", *VIEW, "--out", "measured", "--json", "extract.json")
        report = json.loads((self.folder / "extract.json").read_text())
        self.assertGreater(report["median_spacing"], 3.5)
        self.assertLess(report["median_spacing"], 8)
        written = {path.stem for path in (self.folder / "measured").glob("*.png")}
        self.assertLessEqual(PROPERTIES | {"skeleton", "intersections", "boundaries"}, written)

    def test_a_drawing_in_lines(self):
        """What 'hatch draw' wrote as SVG is read without tracing, and says what its picture says."""
        draw = ["hatch", "draw", "style.safetensors", MESH, *VIEW, "--curves", "contours", "--out"]
        self.call(*draw, "lines.svg")
        self.call(*draw, "lines.png", "--scale", "3")
        for name in ("svg", "png"):
            self.call("hatch", "extract", MESH, f"lines.{name}", *VIEW, "--out", f"lines_{name}", "--json", f"lines_{name}.json")
        svg, png = (json.loads((self.folder / f"lines_{name}.json").read_text()) for name in ("svg", "png"))
        self.assertLess(abs(svg["median_spacing"] / png["median_spacing"] - 1), 0.05)
        self.assertLess(abs(svg["median_thickness"] / png["median_thickness"] - 1), 0.2)  # a picture of thin strokes tells less
        self.call("hatch", "compare", MESH, "lines.svg", "lines.png", *VIEW, "--json", "lines.json")
        same, = json.loads((self.folder / "lines.json").read_text())
        self.assertLess(same["direction_median"], 1.5)
        self.assertGreater(same["region_overlap"], 0.95)
        self.call("hatch", "train", MESH, "lines.svg", *VIEW, "--out", "lines.safetensors")
        # A page of another size is placed by its border; one with dashes is refused.
        page = (self.folder / "lines.svg").read_text()
        scaled = page.replace('viewBox="0 0 500 460"', 'viewBox="-500 -460 1500 1380"')
        (self.folder / "small.svg").write_text(scaled)
        self.call("hatch", "compare", MESH, "small.svg", "lines.png", *VIEW, "--json", "small.json")
        placed, = json.loads((self.folder / "small.json").read_text())
        self.assertLess(placed["direction_median"], 4)
        self.assertGreater(placed["region_overlap"], 0.8)
        (self.folder / "dashed.svg").write_text(page.replace('fill="none"', 'fill="none" stroke-dasharray="4 2"', 1))
        self.refused("hatch", "extract", MESH, "dashed.svg", *VIEW, "--out", "no", code=1,
                     says=["dashed.svg: line ", "strokes with dashes; make them solid"])

    def test_drawings_are_compared_with_an_artists(self):
        self.call("hatch", "draw", "style.safetensors", MESH, *VIEW, "--out", "drawn.png")
        compare = ["hatch", "compare", MESH, "drawing.png"]
        said = self.call(*compare, "drawing.png", "drawn.png", *VIEW, "--out", "compared", "--json", "compare.json").stdout
        for word in ("direction", "region", "tone", "levels", "spacing"):
            self.assertIn(word, said)
        same, drawn = json.loads((self.folder / "compare.json").read_text())
        self.assertEqual((same["direction_off"], same["region_overlap"]), (0, 1))
        self.assertGreater(same["level_right"], 0.999)
        self.assertLess(drawn["direction_median"], 12)
        self.assertGreater(drawn["region_overlap"], 0.6)
        self.assertGreater(drawn["tone"][0], 0.7)
        width, height, _ = read_png(self.folder / "compared" / "drawn_compared.png")
        self.assertEqual((width, height), (500, 460))
        # A picture of another shape is no mask, and no drawing of the view.
        self.refused(*compare, "drawn.png", "--size", "460x500", "--mask", "compared/drawn_compared.png", code=1,
                     says="drawn_compared.png: 500 x 460 pixels; a mask has the view's size, 460 x 500")
        self.refused("hatch", "compare", MESH, "drawing.png", "measured_elsewhere.png", *VIEW, code=1,
                     says="measured_elsewhere.png")

    def test_the_size_of_a_picture_is_its_sharpness(self):
        draw = ["hatch", "draw", "style.safetensors", MESH, "--curves", "none"]
        self.call(*draw, *VIEW, "--out", "as_drawn.png")
        self.call(*draw, *VIEW, "--seed", "2", "--out", "again.png")
        self.call(*draw, "--size", "1000x920", "--out", "twice.png")
        self.call("hatch", "compare", MESH, "as_drawn.png", "again.png", "twice.png", *VIEW, "--json", "sizes.json")
        again, twice = json.loads((self.folder / "sizes.json").read_text())
        # No more than other strokes do.
        self.assertLess(twice["direction_off"], again["direction_off"] + 0.02)
        self.assertGreater(twice["level_right"], again["level_right"] - 0.03)
        self.assertGreater(twice["tone"][0], again["tone"][0] - 0.01)
        for ratio in twice["property_ratio"][:3]:  # thickness, intensity and spacing in pixels of the smaller picture
            self.assertAlmostEqual(ratio, 1, delta=0.1)

    def test_a_second_drawing_teaches_more(self):
        """Under another light and from another side: a drawing by the same rule tells what the first one could not."""
        light = ["hatch", "example", "light", MESH]
        self.call(*light, *VIEW, "--out", "first.png")
        self.call("hatch", "template", MESH, "--view", "left", "--size", "420x420", "--light", "0.5,0.3,1", "--out", "left.png")
        self.call(*light, "--template", "left.png", "--out", "second.png")
        train = ["hatch", "train", MESH, "first.png", *VIEW]
        self.call(*train, "--out", "one.safetensors")
        said = self.call(*train, "--also", MESH, "left.png", "second.png", "--out", "two.safetensors").stdout
        self.assertIn("Hatching style of first.png, second.png,", said)
        for style in ("one", "two"):
            self.call("hatch", "draw", f"{style}.safetensors", MESH, "--template", "left.png", "--curves", "none", "--out", f"{style}.png")
        self.call("hatch", "compare", MESH, "second.png", "one.png", "two.png", "--template", "left.png", "--json", "taught.json")
        one, two = json.loads((self.folder / "taught.json").read_text())
        self.assertGreater(two["level_right"], one["level_right"] + 0.2)
        self.assertGreater(two["tone"][0], one["tone"][0])
        self.refused(*train, "--also", MESH, "left.png", "--out", "no.safetensors", code=2, says="--also takes three files a drawing")
        self.refused(*train, "--also", MESH, "second.png", "second.png", "--out", "no.safetensors", code=1,
                     says="second.png: the picture tells no view")
        self.refused(*train, "--mask", "first.png", "second.png", "--out", "no.safetensors", code=2, says="2 masks are given, but 1 drawing")

    def test_figures_of_how_a_style_is_learned(self):
        self.call("synth", "octopus", "--faces", "1500", "--out", "shapes")
        figures = ["hatch", "figures", MESH, "drawing.png", *VIEW]
        said = self.call(*figures, "--on", "shapes/octopus_001.off", "--out", "figures").stdout
        self.assertIn("hatches along", said)
        written = {path.stem for path in (self.folder / "figures").glob("*.png")}
        rows = ("drawing", "same_view", "new_view", "on_octopus_001")
        self.assertEqual(written, {
            "drawing", "picked_principal_curvature", "picked_local_PCA_axes", "picked_gradient_of_intensity", "one_rule",
            "segments_found", "segments_boosting", "segments_same_view", "segments_on_octopus_001",
            *(f"learned_{row}" for row in rows[1:]),
            *(f"{row}_{what}" for row in rows for what in PROPERTIES - {"orientation"} | {"orientation_1", "orientation_2"})})
        page = ElementTree.parse(self.folder / "figures" / "figures.svg")
        self.assertEqual(len(page.findall(f"{SVG}image")), len(written))
        texts = [text.text for text in page.findall(f"{SVG}text")]
        self.assertTrue(any("of the strokes: hatches along" in text for text in texts), texts)
        # The style is that of 'hatch train'.
        self.assertEqual((self.folder / "figures" / "style.safetensors").read_bytes(), (self.folder / "style.safetensors").read_bytes())
        self.refused(*figures, "--on", "none.obj", "--out", "no", code=1, says="none.obj")

    def test_the_features_of_styles(self):
        said = self.call("hatch", "features", "style.safetensors", "--out", "features.svg", "--json", "features.json").stdout
        self.assertIn("orientation\n  100 %  k_max, k_min\n", said)
        report = json.loads((self.folder / "features.json").read_text())
        for use, shares in report.items():
            self.assertAlmostEqual(sum(shares.values()), 1, msg=use)
        chart = ElementTree.parse(self.folder / "features.svg")
        bars = sum(len(shares) for shares in report.values())
        self.assertEqual(len(chart.findall(f"{SVG}rect")), bars)
        self.assertEqual(len(chart.findall(f"{SVG}text")), bars + len(report))
        self.refused("hatch", "features", "drawing.png", code=1, says="drawing.png")

    def test_the_style_is_told_in_words(self):
        result = self.call("hatch", "train", MESH, "drawing.png", *VIEW, "--out", "again.safetensors")
        self.assertIn("learning: 100 in", result.stderr)  # hundredths, whichever steps there were
        said = result.stdout
        for word in ("Segment 1", "hatches along", "Hatching levels are told by", "thickness =", "spacing ="):
            self.assertIn(word, said)
        self.assertEqual((self.folder / "again.safetensors").read_bytes(), (self.folder / "style.safetensors").read_bytes())
        report = json.loads((self.folder / "train.json").read_text())
        self.assertGreaterEqual(report["segments"], 1)
        self.assertLess(report["level_error"], 0.3)

    def test_surfaces_are_remembered(self):
        draw = ["hatch", "draw", "style.safetensors", MESH, *VIEW, "--out"]
        cache = self.folder / "cache" / "exemplar" / "surfaces"
        self.call(*draw, "remembered.svg")
        known = {path.name for path in cache.iterdir()}
        self.call(*draw, "anew.svg", "--cache", "")
        self.assertEqual((self.folder / "anew.svg").read_bytes(), (self.folder / "remembered.svg").read_bytes())
        self.call(*draw, "elsewhere.svg", "--cache", "elsewhere")
        entries = [path.name for path in (self.folder / "elsewhere").iterdir()]
        self.assertEqual(len(entries), 1)
        self.assertIn(entries[0], known)
        said = self.call(*draw, "x.svg", "--cache", MESH).stderr
        self.assertIn("measured surfaces are not remembered", said)

    def test_another_view_as_svg(self):
        self.call("hatch", "draw", "style.safetensors", MESH, *VIEW, "--view", "side", "--out", "side.svg", "--json", "draw.json",
                  "--properties", "targets")
        root = ElementTree.parse(self.folder / "side.svg").getroot()
        layers = {g.get(LABEL): g for g in root.findall(SVG + "g")}
        self.assertEqual(list(layers), ["background", "hatching", "cross_hatching", "contours"])
        self.assertGreater(len(list(layers["hatching"].iter(SVG + "path"))), 50)
        self.assertGreater(len(list(layers["contours"].iter(SVG + "path"))), 0)
        report = json.loads((self.folder / "draw.json").read_text())
        self.assertLess(report["tone_error"], 0.2)
        self.assertLess(report["spacing_error"], 0.3)
        written = {path.stem for path in (self.folder / "targets").glob("*.png")}
        self.assertEqual(written, PROPERTIES | {"segments", "cross_orientation"})
        self.assert_no_leftovers()

    def test_a_picture_and_the_same_bytes_again(self):
        for name in ("one.png", "two.png"):
            self.call("hatch", "draw", "style.safetensors", MESH, *VIEW, "--out", name, "--scale", "1.5")
        width, height, pixels = read_png(self.folder / "one.png")
        self.assertEqual((width, height), (750, 690))
        dark = sum(1 for value in pixels[::3] if value < 128) / (width * height)
        self.assertGreater(dark, 0.01)
        self.assertLess(dark, 0.4)
        self.assertEqual((self.folder / "one.png").read_bytes(), (self.folder / "two.png").read_bytes())

    def test_strokes_of_an_animation_stay_on_the_surface(self):
        self.call("synth", "figure", "--vertices", "800", "--frames", "10", "--seed", "1", "--out", ".")
        draw = ["hatch", "draw", "style.safetensors", "figure_001.glb", "--frames", "2:5", "--size", "260x240", "--out"]
        said = self.call(*draw, "walk", "--json", "walk.json").stdout
        self.assertIn("of the length of strokes is new", said)
        self.call(*draw, "fresh", "--fresh", "--json", "fresh.json")
        kept, fresh = (json.loads((self.folder / name).read_text()) for name in ("walk.json", "fresh.json"))
        self.assertEqual(kept["frames"], 3)
        for figure in ("appeared", "vanished", "slip"):
            self.assertLess(kept["flicker"][figure], 0.6 * fresh["flicker"][figure])
        pictures = sorted((self.folder / "walk").iterdir())
        self.assertEqual([picture.name for picture in pictures], [f"frame_{i:04}.png" for i in range(3)])
        self.assertEqual(read_png(pictures[0])[:2], (260, 240))
        self.assertEqual(pictures[0].read_bytes(), (self.folder / "fresh" / "frame_0000.png").read_bytes())
        self.assertNotEqual(pictures[2].read_bytes(), (self.folder / "fresh" / "frame_0002.png").read_bytes())
        self.call("hatch", "draw", "style.safetensors", "figure_001.glb", "--frames", "2", "--size", "260x240", "--out", "frame.svg")
        self.assertEqual(ElementTree.parse(self.folder / "frame.svg").getroot().get("width"), "260px")

    def test_a_mesh_that_turns(self):
        self.call("hatch", "draw", "style.safetensors", MESH, "--turn", "3", "--frames", "0:3", "--size", "260x240", "--out", "turning",
                  "--json", "turning.json")
        report = json.loads((self.folder / "turning.json").read_text())
        self.assertEqual(report["frames"], 3)
        self.assertLess(report["flicker"]["appeared"], 0.3)

    def test_evaluation_beside_the_known_rule(self):
        self.call("hatch", "evaluate", MESH, "--styles", "flow", "--size", "500x500", "--json", "evaluation.json", "--export", "rows")
        (result,) = json.loads((self.folder / "evaluation.json").read_text())
        self.assertEqual(len(result["rows"]), 4)
        for row in result["rows"]:
            self.assertLess(row["orientation_degrees"], 15)
            self.assertGreater(row["level_accuracy"], 0.7)
            self.assertGreater(row["majority_level"], 1 / 3)
            self.assertNotIn("segment_accuracy", row)  # a style of one segment
        size = {file.name[len("flow_"):-len(".npy")]: file.stat().st_size - 128 for file in (self.folder / "rows").iterdir()}
        self.assertEqual(len(size), 2 * 3 + 4 * 5)  # of the drawing, and of each view with what was learned
        for rows in ("train", "strokes", "seen_fourleg_001_three-quarter", "test_fourleg_001_side"):
            self.assertEqual((size[rows + "_x"] / 301, size[rows + "_y"] / 5), (size[rows + "_pixel"] / 2,) * 2)
        self.assertEqual(size["test_fourleg_001_side_boosted"], size["test_fourleg_001_side_pixel"] / 2)
        self.call("hatch", "evaluate", MESH, "--styles", "parts", "--size", "300x300", "--json", "parts.json")
        for row in json.loads((self.folder / "parts.json").read_text())[0]["rows"]:
            self.assertGreater(row["segment_accuracy"], max(0.9, row["majority_segment"]))

    def test_messy_meshes_are_seen_as_their_surface(self):
        """A vertex of no face, far away, and triangles that share no vertices."""
        lines = (self.folder / MESH).read_text().split("\n")
        vertices, faces = (int(number) for number in lines[1].split()[:2])
        corners, triangles = lines[2:2 + vertices], lines[2 + vertices:2 + vertices + faces]
        loose = ["OFF", f"{vertices + 1} {faces} 0", *corners, "100 0 0", *triangles]
        soup = ["OFF", f"{3 * faces} {faces} 0", *(corners[int(v)] for face in triangles for v in face.split()[1:4]),
                *(f"3 {3 * i} {3 * i + 1} {3 * i + 2}" for i in range(faces))]
        pictures = []
        for name, text in (("whole", lines), ("loose", loose), ("soup", soup)):
            (self.folder / f"{name}.off").write_text("\n".join(text) + "\n")
            self.call("hatch", "template", f"{name}.off", *VIEW, "--out", f"{name}.png")
            pictures.append(read_png(self.folder / f"{name}.png"))
        self.assertEqual(read_png(self.folder / "loose.png"), read_png(self.folder / "whole.png"))
        off = [abs(a - b) for a, b in zip(pictures[0][2], pictures[2][2])]
        self.assertLess(sum(off) / len(off), 0.1)
        self.call("hatch", "draw", "style.safetensors", "loose.off", *VIEW, "--turn", "9", "--frames", "1", "--out", "turned.png")
        self.call("hatch", "draw", "style.safetensors", "whole.off", *VIEW, "--turn", "9", "--frames", "1", "--out", "again.png")
        self.call("hatch", "draw", "style.safetensors", "whole.off", *VIEW, "--turn", "9", "--frames", "0", "--out", "unturned.png")
        self.assertEqual((self.folder / "turned.png").read_bytes(), (self.folder / "again.png").read_bytes())
        self.assertNotEqual((self.folder / "turned.png").read_bytes(), (self.folder / "unturned.png").read_bytes())

    def test_a_folder_of_meshes_is_drawn_as_its_first_frame(self):
        lines = (self.folder / MESH).read_text().split("\n")
        vertices, faces = (int(number) for number in lines[1].split()[:2])
        corners = [[float(x) for x in line.split()] for line in lines[2:2 + vertices]]
        triangles = "".join(f"f {' '.join(str(int(v) + 1) for v in line.split()[1:4])}\n"
                            for line in lines[2 + vertices:2 + vertices + faces])
        (self.folder / "gait").mkdir()
        for frame in range(2):
            moved = "".join(f"v {x} {y * (1 + 0.1 * frame)} {z}\n" for x, y, z in corners)
            (self.folder / "gait" / f"frame_{frame}.obj").write_text(moved + triangles)
        for name, more in (("still.svg", []), ("first.svg", ["--frames", "0"]), ("second.svg", ["--frames", "1"])):
            self.call("hatch", "draw", "style.safetensors", "gait", *VIEW, *more, "--out", name)
        pictures = [(self.folder / name).read_bytes() for name in ("still.svg", "first.svg", "second.svg")]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])

    def test_what_is_read_is_not_replaced(self):
        before = (self.folder / "drawing.png").read_bytes()
        self.refused("hatch", "train", MESH, "drawing.png", *VIEW, "--out", "./drawing.png", code=2, says="would be replaced")
        self.assertEqual((self.folder / "drawing.png").read_bytes(), before)
        self.refused("hatch", "template", MESH, *VIEW, "--out", MESH, code=2, says=".png")
        self.refused("hatch", "example", "flow", MESH, *VIEW, "--out", "x.jpg", code=2, says=".png")
        self.refused("hatch", "draw", "style.safetensors", MESH, *VIEW, "--properties", "drawing.png", "--out", "unwritten.svg",
                     code=2, says="drawing.png")
        self.assertFalse((self.folder / "unwritten.svg").exists())

    def test_what_cannot_be_hatched(self):
        write_off(self.folder / "cube.off", CUBE, CUBE_QUADS)
        train = ["hatch", "train", MESH]
        self.refused("hatch", "example", "contours", MESH, "--out", "x.png", code=2, says=["contours", "contour, light"])
        self.refused(*train, "no.png", *VIEW, "--out", "x.safetensors", code=1, says="no.png")
        self.refused(*train, MESH, *VIEW, "--out", "x.safetensors", code=1, says="fourleg_001.off")
        damaged = self.folder / "damaged.png"
        damaged.write_bytes((self.folder / "drawing.png").read_bytes()[:2000])
        self.refused(*train, "damaged.png", *VIEW, "--out", "x.safetensors", code=1, says="damaged.png")
        self.call("hatch", "template", "cube.off", *VIEW, "--out", "cube.png")
        self.refused("hatch", "draw", "drawing.png", MESH, "--out", "x.svg", code=1, says="drawing.png")
        self.refused("hatch", "draw", "style.safetensors", MESH, "--out", "x.jpg", code=2, says=[".svg", ".png"])
        self.refused("hatch", "draw", "style.safetensors", MESH, "--turn", "9", "--frames", "0:2", "--out", "x.png", code=2,
                     says="no single picture")
        self.refused("hatch", "draw", "style.safetensors", MESH, "--frames", "0", "--properties", "p", "--out", "x.png", code=2,
                     says="--properties")
        # A word after an option is no second value of it.
        self.refused("hatch", "draw", "--clips", "walk", "style.safetensors", MESH, "--turn", "9", "--out", "x", code=2,
                     says="are for animations")
        self.refused("hatch", "evaluate", MESH, MESH, code=2, says="same files")
        self.refused("hatch", "draw", "style.safetensors", MESH, "--light", "0,0,0", "--out", "x.svg", code=2, says="--light")
        self.refused("hatch", "draw", "style.safetensors", MESH, "--eye", "0,0,9", "--target", "0,0,99", "--out", "x.svg", code=1,
                     says="shows nothing of the mesh")


if __name__ == "__main__":
    unittest.main()

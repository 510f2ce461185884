#!/usr/bin/env python3
"""Judges learned hatching by drawings of a hand that shares no code with Exemplar.

    hatching_hand.py build/exemplar OUT cow.obj spot.obj

renders the meshes with a camera, normals and light of its own, and draws them by rules that are not among Exemplar's: stroke by
stroke, with disturbances. A style is learned from the first mesh, seen from one side ('hatch train'). It is drawn there, from the
other side, and on the other meshes ('hatch draw'), and compared with what the hand would draw there ('hatch compare'):

  direction   degrees between strokes in the median, and the share of pixels that are over 30 degrees off
  region      intersection over union of the hatched regions
  level       share of pixels with the right level: none, single, crossed
  tone        correlation of the darkness over one spacing

The hand against itself, with other strokes, tells how well a perfect learner would do. OUT gets all pictures. Needs numpy and
Pillow (Debian: python3-numpy, python3-pil)."""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy
from PIL import Image, ImageDraw, ImageFilter

SIZE = 560  # pixels of all pictures, square
VIEWS = {"same view": (0.8, 0.45, 1.0), "other side": (-1.0, 0.35, 0.6)}
LIGHT = (-0.4, 0.6, 0.7)  # as the eye has it


def read_obj(path):
    vertices, faces = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            faces += [[corners[0], a, b] for a, b in zip(corners[1:], corners[2:])]
    return numpy.array(vertices), numpy.array(faces)


class Seen:
    """What a camera sees of a mesh: per pixel whether it shows the mesh, its normal, height and curvature, and its tone."""

    def __init__(self, path, direction):
        self.path = path
        vertices, faces = read_obj(path)
        low, high = vertices.min(0), vertices.max(0)
        self.target = (low + high) / 2
        radius = numpy.linalg.norm(high - low) / 2
        away = numpy.array(direction) / numpy.linalg.norm(direction)
        self.eye = self.target + away * 4 * radius
        right = numpy.cross([0, 1, 0], away)
        right /= numpy.linalg.norm(right)
        self.axes = numpy.array([right, numpy.cross(away, right), away])
        self.render(vertices, faces)
        light = numpy.array(LIGHT) / numpy.linalg.norm(LIGHT)
        self.tone = numpy.where(self.inside, 1 - numpy.clip(self.normal @ light, 0, 1), 0)
        self.height = numpy.where(self.inside, (self.height - low[1]) / (high[1] - low[1]), 0)

    def render(self, vertices, faces):
        """A depth buffer, triangle by triangle, with normals in the axes of the eye."""
        inward = (vertices - self.eye) @ self.axes.T
        tangents = inward[:, :2] / -inward[:, 2:]
        self.half = 1.05 * numpy.abs(tangents).max()  # the picture just shows all of it
        self.place = SIZE / 2 * (1 + tangents * [1, -1] / self.half)
        corners = vertices[faces]
        face_normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = numpy.zeros_like(vertices)
        for k in range(3):
            numpy.add.at(normals, faces[:, k], face_normals)
        normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        values = numpy.concatenate([normals @ self.axes.T, vertices[:, 1:2], mean_bend(vertices, faces, normals)[:, None]], 1)
        depth = numpy.full((SIZE, SIZE), numpy.inf)
        seen = numpy.zeros((SIZE, SIZE, values.shape[1]))
        for face in faces:
            self.fill(self.place[face], -inward[face, 2], values[face], depth, seen)
        self.inside = numpy.isfinite(depth)
        self.depth = depth
        length = numpy.maximum(numpy.linalg.norm(seen[..., :3], axis=2, keepdims=True), 1e-9)
        self.normal, self.height, self.bend = seen[..., :3] / length, seen[..., 3], seen[..., 4]

    @staticmethod
    def fill(place, away, values, depth, seen):
        (left, top), (right, bottom) = numpy.floor(place.min(0)).astype(int), numpy.ceil(place.max(0)).astype(int)
        x, y = numpy.meshgrid(numpy.arange(max(left, 0), min(right, SIZE - 1) + 1), numpy.arange(max(top, 0), min(bottom, SIZE - 1) + 1))
        a, b, c = place
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(area) < 1e-9 or x.size == 0:
            return
        px, py = x + 0.5, y + 0.5
        second = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / area
        third = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / area
        weights = numpy.stack([1 - second - third, second, third], -1)
        z = 1 / (weights @ (1 / away))
        nearer = (weights.min(-1) >= -1e-6) & (z < depth[y, x])
        depth[y[nearer], x[nearer]] = z[nearer]
        seen[y[nearer], x[nearer]] = weights[nearer] @ values

    def options(self):
        text = lambda point: ",".join(f"{x:.9g}" for x in point)
        return [f"--eye={text(self.eye)}", f"--target={text(self.target)}", f"--fov={2 * numpy.degrees(numpy.arctan(self.half)):.9g}", f"--size={SIZE}x{SIZE}", f"--light={text(LIGHT)}"]

    def across(self, direction):
        """The angle in the picture, per pixel, of horizontal slices through the surface: across `direction` and the normal."""
        way = numpy.cross(self.axes @ numpy.array(direction, float), self.normal)
        return numpy.arctan2(-way[..., 1], way[..., 0])


def mean_bend(vertices, faces, normals, rounds=6):
    """Positive where the surface is convex: how far the neighbors of a vertex lie below it, smoothed."""
    edges = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = numpy.concatenate([edges, edges[:, ::-1]])
    count = numpy.bincount(edges[:, 0], minlength=len(vertices))[:, None].clip(1)

    def mean_of_neighbors(values):
        total = numpy.zeros_like(values)
        numpy.add.at(total, edges[:, 0], values[edges[:, 1]])
        return total / count

    bend = ((vertices - mean_of_neighbors(vertices)) * normals).sum(1, keepdims=True)
    for _ in range(rounds):
        bend = mean_of_neighbors(bend)
    return bend[:, 0]


class Rule:
    """What a hand draws at each pixel: up to two angles, the level, spacing, width and length of strokes in pixels."""

    def __init__(self, angle, level, spacing=7.0, width=1.8, length=40.0, second=None):
        self.angle = [angle, angle + numpy.pi / 2 if second is None else second]
        self.level = level
        fill = lambda value: numpy.broadcast_to(numpy.asarray(value, float), level.shape)
        self.spacing, self.width, self.length = fill(spacing), fill(width), fill(length)


def levels(seen, single, crossed):
    return numpy.where(seen.inside, (seen.tone > single).astype(int) + (seen.tone > crossed), 0)


def blended(first, second, share):
    z = (1 - share) * numpy.exp(2j * first) + share * numpy.exp(2j * second)
    return numpy.angle(z) / 2


RULES = {
    "diagonal, four tones": lambda s: Rule(numpy.full(s.tone.shape, -0.8), levels(s, 0.25, 0.7), spacing=numpy.select([s.tone > 0.55, s.tone > 0.4], [5.5, 7.0], 9.0)),
    "slices": lambda s: Rule(s.across((0, 1, 0)), levels(s, 0.3, 0.75)),
    "slices to diagonal": lambda s: Rule(blended(s.across((0, 1, 0)), -0.8, numpy.clip(2 * s.height - 0.5, 0, 1)), levels(s, 0.3, 0.75)),
    "by sign of curvature": lambda s: Rule(numpy.where(s.bend > 0, s.across((0, 1, 0)), s.across((0, 0, 1))), levels(s, 0.3, 0.75)),
    "fading": lambda s: Rule(s.across((1, 0, 0)), levels(s, 0.2, 9), spacing=12 - 8 * s.tone, length=15 + 40 * s.tone),
    "engraving": lambda s: Rule(s.across((0, 1, 0.3)), levels(s, -1, 9), spacing=5.5, width=0.8 + 2.6 * s.tone, length=400.0),
}


class Hand:
    """Draws a rule. `tremble`: degrees, of each stroke; `missing`, `doubled`: shares of strokes; `shift`: pixels, of the whole
    drawing; `blur`: pixels, of a scanner, with noise."""

    def __init__(self, seed, tremble=2.0, missing=0.0, doubled=0.0, shift=0.0, blur=0.0):
        self.random = numpy.random.default_rng(seed)
        self.tremble, self.missing, self.doubled, self.shift, self.blur = numpy.radians(tremble), missing, doubled, shift, blur

    def draw(self, seen, rule):
        finer = 4
        paper = Image.new("L", (finer * SIZE, finer * SIZE), 255)
        pen = ImageDraw.Draw(paper)
        offset = self.shift * numpy.array([0.8, 0.6])
        for layer in (0, 1):
            for line, width in self.strokes(seen, rule, layer):
                for beside in [0.0] + [1.2 * width] * (self.random.random() < self.doubled):
                    points = [tuple(finer * (p + offset + beside)) for p in line]
                    pen.line(points, fill=20, width=max(1, round(finer * width * self.random.uniform(0.9, 1.1))), joint="curve")
        picture = paper.resize((SIZE, SIZE), Image.Resampling.BOX)
        if self.blur > 0:
            picture = picture.filter(ImageFilter.GaussianBlur(self.blur))
            gray = numpy.asarray(picture, float) + self.random.normal(0, 4, (SIZE, SIZE))
            picture = Image.fromarray(gray.clip(0, 255).astype("uint8"))
        return picture

    def strokes(self, seen, rule, layer):
        """Evenly spaced strokes, one after the other from random places: each is as long as it may be and keeps its distance."""
        hatched = rule.level > layer
        taken = numpy.zeros((SIZE, SIZE), bool)
        rows, columns = numpy.nonzero(hatched)
        for k in self.random.permutation(len(rows))[: len(rows) // 6]:
            spacing = rule.spacing[rows[k], columns[k]]
            if self.is_taken(taken, columns[k], rows[k], spacing):
                continue
            turn = self.random.normal(0, self.tremble)
            start = numpy.array([columns[k] + 0.5, rows[k] + 0.5])
            most = rule.length[rows[k], columns[k]] * self.random.uniform(0.8, 1.2)
            ahead = self.follow(seen, rule, layer, hatched, taken, start, 1, most / 2, turn)
            line = self.follow(seen, rule, layer, hatched, taken, start, -1, most - len(ahead), turn)[::-1] + [start] + ahead
            if len(line) < 1.2 * spacing:
                continue
            for x, y in line:
                taken[int(y), int(x)] = True
            if self.random.random() >= self.missing:
                yield line[::2] if len(line) > 4 else line, rule.width[rows[k], columns[k]]

    @staticmethod
    def is_taken(taken, x, y, spacing):
        r = int(round(0.85 * spacing))
        box = taken[max(0, y - r):y + r + 1, max(0, x - r):x + r + 1]
        if not box.any():
            return False
        ys, xs = numpy.nonzero(box)
        return ((ys + max(0, y - r) - y) ** 2 + (xs + max(0, x - r) - x) ** 2).min() < (0.85 * spacing) ** 2

    def follow(self, seen, rule, layer, hatched, taken, start, sign, most, turn):
        points, at, way = [], start, None
        while len(points) < most:
            x, y = int(at[0]), int(at[1])
            angle = rule.angle[layer][y, x] + turn
            step = numpy.array([numpy.cos(angle), numpy.sin(angle)])
            step = sign * step if way is None else step * numpy.sign(step @ way or 1)
            if way is not None and step @ way < 0.8:
                break
            to = at + step
            nx, ny = int(to[0]), int(to[1])
            if not (0 <= nx < SIZE and 0 <= ny < SIZE) or not hatched[ny, nx]:
                break
            if abs(seen.depth[ny, nx] - seen.depth[y, x]) > 0.02 * seen.depth[y, x]:
                break
            if self.is_taken(taken, nx, ny, 0.7 * rule.spacing[ny, nx]):
                break
            points.append(to)
            at, way = to, step
        return points


class Judge:
    def __init__(self, exemplar, folder, meshes):
        self.exemplar, self.folder = exemplar, folder
        self.views = {name: Seen(meshes[0], direction) for name, direction in VIEWS.items()}
        for mesh in meshes[1:]:
            self.views[mesh.stem] = Seen(mesh, VIEWS["same view"])

    def call(self, *arguments):
        done = subprocess.run([self.exemplar, "hatch", *map(str, arguments), "--quiet"], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"exemplar hatch {' '.join(map(str, arguments))}\n{done.stderr}")

    def judge(self, rule, name, hand, views):
        """Yields a row of numbers for each view: of the style that is learned from the hand, and of the hand again."""
        stem = self.folder / name.replace(",", "").replace(" ", "_")
        first = next(iter(self.views.values()))
        hand.draw(first, RULES[rule](first)).save(f"{stem}.png")
        self.call("train", first.path, f"{stem}.png", *first.options(), "--out", f"{stem}.safetensors")
        for view in views:
            seen = self.views[view]
            drawn, truth, again = (f"{stem}_{view.replace(' ', '_')}_{what}.png" for what in ("drawn", "truth", "again"))
            Hand(101).draw(seen, RULES[rule](seen)).save(truth)
            Hand(102).draw(seen, RULES[rule](seen)).save(again)
            self.call("draw", f"{stem}.safetensors", seen.path, *seen.options(), "--curves", "none", "--out", drawn)
            self.call("compare", seen.path, truth, drawn, again, *seen.options(), "--json", f"{stem}.json")
            yield (view, *json.load(open(f"{stem}.json")))


def cells(row):
    return f"{row['direction_median']:.0f} / {100 * row['direction_off']:.0f} % | {row['region_overlap']:.2f} | {100 * row['level_right']:.0f} % | {row['tone'][0]:.2f}"


DISTURBANCES = {"tremble, degrees": ("tremble", (2, 5, 10, 20)), "missing strokes": ("missing", (0, 0.1, 0.2, 0.4)),
                "doubled strokes": ("doubled", (0, 0.1, 0.2, 0.4)), "shift, pixels": ("shift", (0, 1, 2, 4)), "blur, pixels": ("blur", (0, 0.5, 1, 1.5))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("exemplar", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    parser.add_argument("meshes", type=pathlib.Path, nargs="+", metavar="MESH", help="OBJ; the first one is learned from")
    parser.add_argument("--disturb", default="slices to diagonal", choices=RULES, help="the rule that disturbed hands draw")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    judge = Judge(arguments.exemplar.resolve(), arguments.out, arguments.meshes)
    print("| style | drawn on | direction | region | level | tone | the hand again: direction | region | level | tone |\n|" + 10 * "---|")
    for rule in RULES:
        for view, drawn, again in judge.judge(rule, rule, Hand(1), judge.views):
            print(f"| {rule} | {view} | {cells(drawn)} | {cells(again)} |", flush=True)
    print("\n| disturbance | strength | direction | region | level | tone |\n|" + 6 * "---|")
    for name, (parameter, strengths) in DISTURBANCES.items():
        for strength in strengths:
            for _, drawn, _ in judge.judge(arguments.disturb, f"{parameter} {strength}", Hand(1, **{parameter: strength}), ["other side"]):
                print(f"| {name} | {strength} | {cells(drawn)} |", flush=True)


if __name__ == "__main__":
    main()

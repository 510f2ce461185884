#!/usr/bin/env python3
"""Hatches a template as a simple-minded draftsman would, who sees nothing but the picture: strokes that run down to the left where
it is gray, a second layer down to the right where it is dark, none where it is light. Each stroke bends, trembles, and ends a
little early or late.

    docs/examples/hatch_template.py view.png drawing.png [SEED]

Works on both kinds of pictures of 'exemplar hatch template': on a plain view, whose strokes are written alone, on white; and on
a sheet to print (--sheet), whose strokes are drawn over it. Needs numpy and Pillow (Debian: python3-numpy, python3-pil).
"""
import sys

import numpy
from PIL import Image, ImageDraw, ImageFilter


def tone_of(picture):
    """The tone of the object from 0 (light) to 1 (dark) per pixel, and where the object is."""
    gray = numpy.asarray(picture.convert("L").filter(ImageFilter.GaussianBlur(2)), float)
    colors = numpy.asarray(picture.convert("RGB"), int)
    is_sheet = (colors.max(2) - colors.min(2) > 20).any()
    inside = gray < 252
    if is_sheet:  # marks and scale are black, the view is blue
        blue = colors[..., 2] - colors[..., 0] > 2
        inside &= numpy.asarray(Image.fromarray((255 * blue).astype("uint8")).filter(ImageFilter.MedianFilter(5))) > 0
    low, high = numpy.quantile(gray[inside], [0.02, 0.98])
    return numpy.clip((high - gray) / max(high - low, 1), 0, 1), inside, is_sheet


def strokes(tone, inside, angle, threshold, spacing, random):
    """Polylines along `angle` where the object is darker than `threshold`."""
    height, width = tone.shape
    along = numpy.array([numpy.cos(angle), numpy.sin(angle)])
    across = numpy.array([-along[1], along[0]])
    reach = numpy.hypot(width, height) / 2
    middle = numpy.array([width, height]) / 2
    for offset in numpy.arange(-reach, reach, spacing):
        offset += random.normal(0, 0.06 * spacing)
        bend = random.normal(0, 0.3 * spacing)
        steps = numpy.arange(-reach, reach, max(1, spacing / 6))
        sway = bend * numpy.sin(3 * steps / reach) + 0.05 * spacing * numpy.cumsum(random.normal(0, 0.3, len(steps)))
        points = middle + steps[:, None] * along + (offset + sway - sway.mean())[:, None] * across
        column, row = points.astype(int).T
        on_paper = (column >= 0) & (row >= 0) & (column < width) & (row < height)
        drawn = numpy.zeros(len(steps), bool)
        drawn[on_paper] = (inside & (tone > threshold))[row[on_paper], column[on_paper]]
        edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[False], drawn, [False]]).astype(int)))
        for begin, end in zip(edges[::2], edges[1::2]):
            early, late = random.integers(-1, 2, 2)
            line = points[max(begin + early, 0):end + late]
            if len(line) * max(1, spacing / 6) > 1.5 * spacing:
                yield [tuple(point) for point in line]


def main(template, out, seed=1):
    picture = Image.open(template)
    tone, inside, is_sheet = tone_of(picture)
    rows, columns = numpy.nonzero(inside)
    size = max(numpy.ptp(rows), numpy.ptp(columns))
    spacing, pen = size / 75, size / 330
    finer = 1 if is_sheet else 3  # strokes are drawn finer than they are seen
    paper = picture.convert("RGB") if is_sheet else Image.new("RGB", picture.size, "white")
    paper = paper.resize((finer * paper.width, finer * paper.height))
    draw = ImageDraw.Draw(paper)
    random = numpy.random.default_rng(int(seed))
    for angle, threshold in ((2.2, 0.3), (0.8, 0.65)):
        for line in strokes(tone, inside, angle, threshold, spacing, random):
            draw.line([(finer * x, finer * y) for x, y in line], fill=(25, 25, 28),
                      width=max(1, round(finer * pen * random.uniform(0.85, 1.15))), joint="curve")
    paper.resize((paper.width // finer, paper.height // finer), Image.Resampling.LANCZOS).save(out, dpi=picture.info.get("dpi", (300, 300)))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

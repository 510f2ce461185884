#!/usr/bin/env python3
"""Photographs a sheet of paper with a drawing, as a phone does: from aslant, turned, unevenly lit, on a dark table, a little out of
focus, with noise, as JPEG.

    photographed_sheet.py SHEET PHOTO.jpg [DEGREES [SEED]]
"""
import sys

import numpy
from PIL import Image, ImageFilter


def projective(source, target):
    """The eight numbers of PIL's perspective transform, which takes places of `target` to `source`."""
    rows, right = [], []
    for (x, y), (u, v) in zip(target, source):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        right += [u, v]
    return numpy.linalg.solve(numpy.array(rows, float), numpy.array(right, float))


def main(sheet, photo, degrees=8, seed=1):
    paper = Image.open(sheet).convert("RGB")
    random = numpy.random.default_rng(int(seed))
    width, height = paper.size
    size = int(1.15 * numpy.hypot(width, height) * 0.8)
    turn = numpy.radians(float(degrees))
    rotation = numpy.array([[numpy.cos(turn), -numpy.sin(turn)], [numpy.sin(turn), numpy.cos(turn)]])
    corners = []
    for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        place = rotation @ (numpy.array([x * width, y * height]) * 0.5 * 0.8)
        place *= 1 / (1 + 0.16 * place[1] / size + 0.1 * place[0] / size)  # aslant
        corners.append(tuple(place + size / 2))
    ends = [(0, 0), (width, 0), (width, height), (0, height)]
    coefficients = tuple(projective(ends, corners))
    seen = paper.transform((size, size), Image.Transform.PERSPECTIVE, coefficients, Image.Resampling.BICUBIC)
    on_table = Image.new("L", paper.size, 255).transform((size, size), Image.Transform.PERSPECTIVE, coefficients)
    table = Image.new("RGB", (size, size), (70, 62, 55))
    table.paste(seen, mask=on_table)
    pixels = numpy.asarray(table.filter(ImageFilter.GaussianBlur(1.2)), float)
    y, x = numpy.mgrid[-1:1:size * 1j, -1:1:size * 1j]
    light = 0.86 - 0.16 * x + 0.1 * y - 0.12 * (x * x + y * y)
    pixels = pixels * light[..., None] * [1, 0.98, 0.93] + random.normal(0, 3, pixels.shape)
    Image.fromarray(numpy.clip(pixels, 0, 255).astype("uint8")).save(photo, quality=80)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

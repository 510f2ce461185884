#!/usr/bin/env python3
"""Writes labels of a finer style: a part in three, as some people cut it in the Princeton benchmark (thesis Fig. 3.7).

    tests/compare/finer_style.py psb FourLeg torso finer
    exemplar label evaluate --train finer/train.txt --test finer/test.txt --labels finer --out out/finer

Takes each mesh of the category of which a person's segmentation cuts the part in three: three segments that each lie in the
part for the most, and each hold an eighth of it. Where several people did so, the one whose smallest segment is largest counts.
The segments are called front, middle and rear, by their distance from the head; what remains of the part joins the nearest. All
other labels stay. Half of the meshes, drawn at random, are to train on. Needs SciPy (Debian: python3-scipy)."""
import argparse
import pathlib
import random
import sys

import numpy

from surfaces import DataError, face_areas, labels_path, read_labels, read_off, read_text, write_labels

LEAST_SHARE, LEAST_INSIDE = 0.125, 0.6  # of the part, and of the segment's own area
NAMES = ('front', 'middle', 'rear')


def read_segments(path, faces):
    """Returns the number of each face's segment."""
    try:
        segment = numpy.array(read_text(path).split(), int)
    except ValueError:
        raise DataError(path, 'has lines that are not numbers of segments') from None
    if len(segment) != faces:
        raise DataError(path, f'has {len(segment)} segments of faces; the mesh has {faces} faces')
    return segment


def pieces_of(segment, in_part, area):
    """Returns the segments that are pieces of the part, and the smallest one's share of it."""
    shares = {number: area[in_part & (segment == number)].sum() for number in numpy.unique(segment[in_part])}
    pieces = [number for number, inside in shares.items()
              if inside >= LEAST_SHARE * area[in_part].sum() and inside > LEAST_INSIDE * area[segment == number].sum()]
    return pieces, min((shares[number] for number in pieces), default=0) / area[in_part].sum()


def finer(mesh, segmentations, part, head):
    """Returns the labels of a mesh in the finer style, or None if nobody cut the part in three."""
    positions, corners = read_off(mesh)
    center, area = positions[corners].mean(axis=1), face_areas(positions, corners)
    label = read_labels(labels_path(mesh), len(area))
    in_part, from_head = label == part, label == head
    best, best_share = None, 0
    for path in sorted(segmentations.glob('*.seg')):
        segment = read_segments(path, len(area))
        pieces, share = pieces_of(segment, in_part, area)
        if len(pieces) == 3 and share > best_share:
            best, best_share = [in_part & (segment == number) for number in pieces], share
    if best is None or not from_head.any():
        return None
    middle_of = lambda faces: numpy.average(center[faces], axis=0, weights=area[faces])
    best.sort(key=lambda faces: numpy.linalg.norm(middle_of(faces) - middle_of(from_head)))
    known = numpy.flatnonzero(best[0] | best[1] | best[2])
    name_of_known = numpy.select([faces[known] for faces in best], NAMES)
    for face in numpy.flatnonzero(in_part):
        label[face] = name_of_known[numpy.linalg.norm(center[known] - center[face], axis=1).argmin()]
    return label


def write_style(options):
    """Writes the labels, and which meshes train and test."""
    options.out.mkdir(parents=True, exist_ok=True)
    found = []
    for mesh in sorted((options.benchmark / 'labeled' / options.category).glob('*.off')):
        label = finer(mesh, options.benchmark / 'seg' / mesh.stem, options.part, options.head)
        if label is not None:
            write_labels(options.out / f'{mesh.stem}_labels.txt', label)
            found.append(mesh)
    if len(found) < 2:
        raise DataError(options.benchmark, f'has fewer than two meshes of {options.category} with the {options.part} in three')
    training = set(random.Random(1).sample(found, len(found) // 2))
    for name, chosen in (('train', training), ('test', set(found) - training)):
        (options.out / f'{name}.txt').write_text(''.join(f'{mesh.resolve()}\n' for mesh in sorted(chosen)))
    print(f'{len(found)} meshes: {" ".join(mesh.stem for mesh in found)}')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('benchmark', type=pathlib.Path, help='folder of the benchmark, with labeled/ and seg/')
    parser.add_argument('category')
    parser.add_argument('part', help='label of the part in three')
    parser.add_argument('out', type=pathlib.Path, help='folder for the labels and the lists of meshes')
    parser.add_argument('--head', default='head', help='label of the part that the front is next to')
    options = parser.parse_args()
    try:
        write_style(options)
    except DataError as error:
        sys.exit(f'error: {error}')


if __name__ == '__main__':
    main()

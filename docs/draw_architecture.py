#!/usr/bin/env python3
"""Draws the subjects of the code and their dependencies as docs/architecture.svg.

    docs/draw_architecture.py            writes docs/architecture.svg
    docs/draw_architecture.py --check    exits with 1 and one line if the file is not what would be written

Reads the include lines of host/, gpu/, apps/ and python/. Draws a box per subject, with the names of its rooms, above
all subjects that it includes. An arrow leads from a subject to one that it includes. Arrows that follow from others
are left out, and arrows to the same box join. The output depends on the include lines only.
"""
import collections
import functools
import itertools
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / 'docs' / 'architecture.svg'
TOPS = ('host', 'gpu', 'apps', 'python')
LIBRARIES = ('apps/bench/kernels', 'apps/bench/spirv')  # rooms that are libraries of their own and get a box
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)

WIDTH, MARGIN = 1200, 20  # all lengths are in pixels
GAP, ROW_GAP = 22, 54  # between neighbors in a row, and between rows
NAME_SIZE, ROOM_SIZE, LINE = 16, 13, 17  # sizes of fonts, and the distance of lines
NAME_WIDTH, ROOM_WIDTH = 9.6, 7  # upper bounds of the mean width of a character
ROOM_CHARACTERS = 34  # in a line of rooms, at most
PORT = 18  # between arrows that leave a box
COLORS = {'host': ('#dbe9f6', '#33608c'), 'gpu': ('#fde3cb', '#b35c1e'),  # of boxes: inside, and border
          'apps': ('#dff0d8', '#3f7a34'), 'python': ('#dff0d8', '#3f7a34')}
LEGEND = {'host': 'host: needs no device', 'gpu': 'gpu: computes on a device', 'apps': 'programs and Python package'}


def subject_and_room(parts):
    """Returns the subject of a file, and its room; '' for a file in the subject's own folder."""
    if parts[0] == 'python':
        return 'python', ''
    for library in LIBRARIES:
        if '/'.join(parts).startswith(library + '/'):
            return library, ''
    return '/'.join(parts[:2]), parts[2] if len(parts) > 3 else ''


def read_includes():
    """Returns the subjects that each subject includes, and for each subject the same of its rooms."""
    subjects = collections.defaultdict(set)
    rooms = collections.defaultdict(lambda: collections.defaultdict(set))
    for path in sorted(path for top in TOPS for path in (ROOT / top).rglob('*')):
        if path.suffix not in ('.h', '.cpp'):
            continue
        subject, room = subject_and_room(path.relative_to(ROOT).parts)
        subjects[subject], rooms[subject][room]  # exist even if they include nothing
        for name in INCLUDE.findall(path.read_text()):
            parts = name.split('/')
            if parts[0] not in TOPS:
                continue
            other, other_room = subject_and_room(parts)
            if other != subject:
                subjects[subject].add(other)
            elif other_room != room:
                rooms[subject][room].add(other_room)
    return subjects, rooms


def layers_of(graph):
    """Returns the layer of each node: one above the highest that it includes."""
    @functools.cache
    def layer(node):
        return 1 + max((layer(other) for other in graph[node]), default=-1)
    return {node: layer(node) for node in sorted(graph)}


def raise_programs(layer, graph):
    """Moves what programs share up to just below them."""
    for node in sorted(graph, key=layer.get, reverse=True):
        users = [layer[user] for user in graph if node in graph[user]]
        if node.startswith('apps/') and users:
            layer[node] = min(users) - 1


def reduced(graph):
    """Returns the graph without edges that follow from others (transitive reduction)."""
    @functools.cache
    def below(node):
        return graph[node].union(*(below(other) for other in graph[node]))
    return {node: {a for a in graph[node] if not any(a in below(b) for b in graph[node])} for node in graph}


def mean(values, weights=None):
    """Returns the weighted mean, the same with every version of Python."""
    weights = weights or [1] * len(values)
    return math.fsum(value * weight for value, weight in zip(values, weights)) / sum(weights)


class Layout:
    """Places nodes in rows, with links between neighboring rows (Sugiyama et al. 1981).

    A node is (subject, row): the subject's box in its own row; in a higher row, a point that arrows to it pass.
    """

    def __init__(self, graph, layer, box_width):
        self.layer = layer
        self.links = set()  # (upper node, lower node)
        for subject, targets in graph.items():
            for target in targets:
                passed = [(target, row) for row in range(layer[subject] - 1, layer[target] - 1, -1)]
                self.links.update(itertools.pairwise([(subject, layer[subject]), *passed]))
        nodes = sorted({node for link in self.links for node in link} | {(subject, layer[subject]) for subject in graph},
                       key=lambda node: (TOPS.index(node[0].split('/')[0]), node))
        self.rows = [[node for node in nodes if node[1] == row] for row in range(max(layer.values()) + 1)]
        self.width = {node: box_width[node[0]] if self.is_box(node) else 0 for node in nodes}
        self.below = {node: sorted(b for a, b in self.links if a == node) for node in nodes}
        self.above = {node: sorted(a for a, b in self.links if b == node) for node in nodes}
        self.sort_rows()
        self.x = self.middles()

    def is_box(self, node):
        return self.layer[node[0]] == node[1]

    def crossings(self):
        place = {node: i for row in self.rows for i, node in enumerate(row)}
        return sum((place[a] - place[c]) * (place[b] - place[d]) < 0
                   for (a, b), (c, d) in itertools.combinations(self.links, 2) if a[1] == c[1])

    def sort_rows(self):
        """Orders rows by the mean places of their neighbors, up and down in turns; keeps the best order."""
        best, least = None, None
        for sweep in range(24):
            neighbors, order = (self.below, 1) if sweep % 2 == 0 else (self.above, -1)
            for i in range(len(self.rows))[::order]:
                place = {node: (k + 0.5) / len(row) for row in self.rows for k, node in enumerate(row)}
                self.rows[i].sort(key=lambda node: mean([place[n] for n in neighbors[node] or [node]]))
            self.swap_neighbors()
            count = self.crossings()
            if least is None or count < least:
                best, least = [list(row) for row in self.rows], count
        self.rows = best

    def swap_neighbors(self):
        """Swaps neighbors in a row as long as that saves crossings."""
        count, before = self.crossings(), None
        while count != before:
            before = count
            for row in self.rows:
                for i in range(len(row) - 1):
                    row[i:i + 2] = row[i + 1], row[i]
                    swapped = self.crossings()
                    if swapped < count:
                        count = swapped
                    else:
                        row[i:i + 2] = row[i + 1], row[i]

    def middles(self):
        """Returns the x of each node: near those of its neighbors, in sweeps."""
        x = {node: WIDTH * (i + 0.5) / len(row) for row in self.rows for i, node in enumerate(row)}
        for _ in range(200):
            for row in self.rows:
                near = [self.above[node] + self.below[node] for node in row]
                pulls = [[self.pull(node, n) for n in nodes] for node, nodes in zip(row, near)]
                # Boxes without arrows stay where they are.
                wanted = [mean([x[n] for n in nodes], pull) if nodes else x[node]
                          for node, nodes, pull in zip(row, near, pulls)]
                x.update(zip(row, self.spread(row, wanted, [sum(pull) or 1 for pull in pulls])))
        return x

    def pull(self, a, b):
        """Returns the weight of a link. The passing parts of an arrow weigh most, which keeps it straight."""
        return (1, 2, 8)[(not self.is_box(a)) + (not self.is_box(b))]

    def spread(self, row, wanted, weights):
        """Returns the places nearest to the wanted ones (isotonic least squares) that keep order, gaps and margins."""
        offsets, end = [], MARGIN
        for node in row:
            offsets.append(end + self.width[node] / 2)
            end += self.width[node] + GAP
        room = WIDTH - MARGIN - (end - GAP)
        blocks = []  # neighbors that touch: their shift, weight and number
        for place, offset, weight in zip(wanted, offsets, weights):
            blocks.append((place - offset, weight, 1))
            while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
                (a, p, i), (b, q, j) = blocks[-2:]
                blocks[-2:] = [((a * p + b * q) / (p + q), p + q, i + j)]
        shifts = [min(max(shift, 0), room) for shift, _, count in blocks for _ in range(count)]
        return [offset + shift for offset, shift in zip(offsets, shifts)]


def room_lines(graph):
    """Returns the names of rooms in lines of text, those first that include the fewest others."""
    lines = []
    for room in sorted(filter(None, graph), key=lambda room: (layers_of(graph)[room], room)):
        if lines and len(lines[-1]) + len(room) + 2 <= ROOM_CHARACTERS:
            lines[-1] += f' {room},'
        else:
            lines.append(f'{room},')
    return lines[:-1] + [lines[-1].rstrip(',')] if lines else []


class Drawing:
    """The lines of an SVG file."""

    def __init__(self, height):
        self.lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" '
            'font-family="Helvetica, Arial, sans-serif" fill="#111111">',
            '<!-- Written by docs/draw_architecture.py. -->',
            f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>']

    def rectangle(self, x, y, width, height, top):
        inside, border = COLORS[top]
        self.lines.append(f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{height}" rx="4" fill="{inside}" '
                          f'stroke="{border}"/>')

    def text(self, x, y, size, words, more='text-anchor="middle"'):
        self.lines.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" {more}>{words}</text>')

    def box(self, x, y, width, height, subject, rooms):
        self.rectangle(x - width / 2, y, width, height, subject.split('/')[0])
        y += (height - LINE * len(rooms)) / 2 + 6
        self.text(x, y, NAME_SIZE, subject, 'text-anchor="middle" font-weight="bold"')
        for i, line in enumerate(rooms, 1):
            self.text(x, y + LINE * i, ROOM_SIZE, line)

    def arrow(self, x0, y0, x1, y1, end, color):
        """A curve from (x0, y0) to (x1, y1): with a tip there, or, where it passes a row, a line on to y = `end`."""
        middle, tip = (y0 + y1) / 2, 8 if end is None else 0
        on = '' if end is None else f' V{end}'
        self.lines.append(f'<path d="M{x0:.1f} {y0} C{x0:.1f} {middle} {x1:.1f} {middle} {x1:.1f} {y1 - tip}{on}" '
                          f'fill="none" stroke="{color}" stroke-width="1.5"/>')
        if tip:
            self.lines.append(f'<path d="M{x1 - 4.5:.1f} {y1 - tip} h9 L{x1:.1f} {y1} z" fill="{color}"/>')

    def legend(self):
        for i, (top, words) in enumerate(LEGEND.items()):
            self.rectangle(MARGIN + 230 * i, MARGIN - 6, 14, 14, top)
            self.text(MARGIN + 230 * i + 20, MARGIN + 6, ROOM_SIZE, words, '')


def picture():
    subjects, rooms = read_includes()
    layer = layers_of(subjects)
    raise_programs(layer, subjects)
    lines = {subject: room_lines(rooms[subject]) for subject in sorted(subjects)}
    width = {subject: 20 + max([NAME_WIDTH * len(subject), *(ROOM_WIDTH * len(line) for line in lines[subject])])
             for subject in lines}
    layout = Layout(reduced(subjects), layer, width)

    heights = [30 + LINE * max(len(lines[subject]) for subject in lines if layer[subject] == row)
               for row in range(len(layout.rows))]
    tops = [MARGIN + 24 + sum(heights[row + 1:]) + ROW_GAP * (len(heights) - 1 - row) for row in range(len(heights))]
    drawing = Drawing(tops[0] + heights[0] + MARGIN)
    drawing.legend()
    for upper, lower in sorted(layout.links):
        leaving = sorted(layout.below[upper], key=layout.x.get)
        port = PORT * (leaving.index(lower) - (len(leaving) - 1) / 2)
        end = None if layout.is_box(lower) else tops[lower[1]] + heights[lower[1]]
        drawing.arrow(layout.x[upper] + port, tops[upper[1]] + heights[upper[1]], layout.x[lower], tops[lower[1]], end,
                      COLORS[lower[0].split('/')[0]][1])
    for subject in lines:
        row = layer[subject]
        drawing.box(layout.x[subject, row], tops[row], width[subject], heights[row], subject, lines[subject])
    return '\n'.join([*drawing.lines, '</svg>', ''])


def main(arguments):
    if arguments not in ([], ['--check']):
        sys.exit(__doc__)
    svg = picture()
    if not arguments:
        PICTURE.write_text(svg)
    elif not PICTURE.exists() or PICTURE.read_text() != svg:
        print('docs/architecture.svg does not show the include lines: run docs/draw_architecture.py')
        sys.exit(1)


if __name__ == '__main__':
    main(sys.argv[1:])

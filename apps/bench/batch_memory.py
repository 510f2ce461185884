#!/usr/bin/env python3
"""Prints, every five seconds of a batch run, how many shapes are labeled and how much memory the program has.

    for kind in human fourleg cup chair table octopus glasses; do
        exemplar synth $kind --count 1430 --faces 500 --out shapes/$kind --quiet
    done
    batch_memory.py shapes human.safetensors --out labeled > curve.txt
    batch_memory.py --plot curve.txt curve.svg

Columns: seconds, shapes, memory of the process and the most it had until then, both in MB. Nothing is taken from a
feature cache. Linux only."""

import argparse
import contextlib
import os
import pathlib
import sqlite3
import subprocess
import sys
import time

PROGRAM = pathlib.Path(os.environ.get("EXEMPLAR_PROGRAM", "build/exemplar")).absolute()
WIDTH, HEIGHT, MARGIN = 640, 240, 50


def labeled(catalog):
    """Shapes that the run is done with; 0 while there is no catalog, and nothing that can be read."""
    try:
        with contextlib.closing(sqlite3.connect(f"file:{catalog}?mode=ro", uri=True, timeout=1)) as database:
            return database.execute("SELECT count(*) FROM labels WHERE state <> 'claimed'").fetchone()[0]
    except sqlite3.Error:
        return 0


def memory(process):
    """MB the process has, and has had at most; none when it has ended."""
    try:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        return [int(status.split(name)[1].split()[0]) / 1024 for name in ("VmRSS:", "VmHWM:")]
    except (OSError, IndexError):
        return None


def measure(shapes, model, out):
    begin = time.monotonic()
    with subprocess.Popen([PROGRAM, "label", "batch", shapes, "--model", model, "--out", out, "--cache", "", "--quiet"],
                          stdout=sys.stderr) as process:
        while process.poll() is None:
            if megabytes := memory(process):
                now, peak = megabytes
                print(f"{time.monotonic() - begin:.0f} {labeled(f'{out}/catalog.db')} {now:.0f} {peak:.0f}", flush=True)
            time.sleep(5)
    return process.returncode


def plot(curve, picture):
    rows = [tuple(float(word) for word in line.split()) for line in pathlib.Path(curve).read_text().splitlines()]
    most_shapes = max(row[1] for row in rows)
    top = 50 * (int(max(row[3] for row in rows)) // 50 + 1)

    def place(shapes, megabytes):
        return (MARGIN + shapes / most_shapes * (WIDTH - 2 * MARGIN), HEIGHT - MARGIN - megabytes / top * (HEIGHT - 2 * MARGIN))

    def line(column, color):
        points = " ".join("%.1f,%.1f" % place(row[1], row[column]) for row in rows)
        return f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.5"/>'

    def text(x, y, words, anchor="middle"):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>'

    marks = []
    for megabytes in range(0, top + 1, 50):
        x, y = place(0, megabytes)
        marks.append(f'<line x1="{x}" y1="{y:.1f}" x2="{WIDTH - MARGIN}" y2="{y:.1f}" stroke="#ddd"/>')
        marks.append(text(x - 6, y + 4, megabytes, "end"))
    for part in range(5):
        shapes = most_shapes * part / 4
        marks.append(text(place(shapes, 0)[0], HEIGHT - MARGIN + 18, f"{shapes:,.0f}"))
    body = [*marks, text(MARGIN, MARGIN - 16, "MB of memory: now (blue) and at most until then (gray)", "start"),
            text(WIDTH / 2, HEIGHT - 12, "shapes labeled"), line(3, "#888"), line(2, "#2458d3")]
    pathlib.Path(picture).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(body) + "\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shapes", nargs="?", help="folder of meshes, or a catalog")
    parser.add_argument("model", nargs="?")
    parser.add_argument("--out", help="folder that the run writes to")
    parser.add_argument("--plot", nargs=2, metavar=("CURVE", "SVG"), help="only draw what an earlier run has printed")
    arguments = parser.parse_args()
    if arguments.plot:
        plot(*arguments.plot)
        return 0
    if not (arguments.shapes and arguments.model and arguments.out):
        parser.error("SHAPES, MODEL and --out are needed")
    return measure(arguments.shapes, arguments.model, arguments.out)


if __name__ == "__main__":
    sys.exit(main())

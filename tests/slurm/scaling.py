"""Prints how long batch labeling takes on Slurm with one node and with two: each of one processor of this machine, in turn.

    python3 tests/slurm/scaling.py SHAPES MODEL [--tasks 8] [--repeat 3]

A time is that of the whole command, from `exemplar label batch ... --slurm --wait` to its report."""

import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

from cluster import SlurmCluster

PROGRAM = pathlib.Path(os.environ.get("EXEMPLAR_PROGRAM", "build/exemplar")).absolute()


def seconds(nodes, arguments):
    with SlurmCluster(nodes=nodes, cpus=1) as cluster, tempfile.TemporaryDirectory(prefix="exemplar-scaling-") as folder:
        begin = time.monotonic()
        subprocess.run([PROGRAM, "label", "batch", arguments.shapes, "--model", arguments.model, "--out", f"{folder}/out", "--cache",
                        "", "--slurm", "--wait", "--quiet", "--tasks", str(arguments.tasks), "--threads", "1"], check=True,
                       env={**os.environ, **cluster.environment}, stdout=subprocess.DEVNULL)
        return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shapes", help="folder of meshes")
    parser.add_argument("model")
    parser.add_argument("--tasks", type=int, default=8)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    times = {1: [], 2: []}
    for _ in range(arguments.repeat):
        for nodes, found in times.items():
            found.append(seconds(nodes, arguments))
            print(f"{nodes} {'node' if nodes == 1 else 'nodes'}: {found[-1]:.1f} s", flush=True)
    one, two = (statistics.median(found) for found in times.values())
    print(f"medians: {one:.1f} s on one node, {two:.1f} s on two: {one / two:.2f} times as fast")


if __name__ == "__main__":
    main()

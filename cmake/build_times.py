#!/usr/bin/env python3
"""Prints where the time of a build went: seconds per target and the slowest steps, from Ninja's log.

    cmake/build_times.py [BUILD_FOLDER]      for example after: rm -rf build; CCACHE_DISABLE=1 apps/demo.sh

A step's seconds are those that it ran, beside others: on a machine with N busy cores the sum is about N times the time waited.
"""

import collections
import pathlib
import re
import sys

SLOWEST = 12


def steps(build):
    """(seconds, output) of each step's last run."""
    last = {}
    for line in (build / ".ninja_log").read_text().splitlines():
        if not line.startswith("#"):
            start, end, _, output, _ = line.split("\t")
            last[output] = (int(end) - int(start)) / 1000
    return [(seconds, output) for output, seconds in last.items()]


def target_of(output):
    match = re.search(r"CMakeFiles/([\w.-]+)\.dir/", output)
    if match:
        return match.group(1)
    return "shaders" if output.startswith("shaders/") else "linking and the rest"


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build")
    if not (build / ".ninja_log").exists():
        sys.exit(f"error: {build} holds no .ninja_log; name a folder that Ninja has built in")
    all_steps = steps(build)
    by_target = collections.Counter()
    for seconds, output in all_steps:
        by_target[target_of(output)] += seconds
    print(f"{sum(by_target.values()):7.0f} s  {len(all_steps)} outputs")
    for target, seconds in by_target.most_common():
        if seconds >= 1:
            print(f"{seconds:7.0f} s  {target}")
    print("slowest steps")
    for seconds, output in sorted(all_steps, reverse=True)[:SLOWEST]:
        print(f"{seconds:7.0f} s  {output}")


main()

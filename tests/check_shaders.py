#!/usr/bin/env python3
"""Shaders keep to what every Vulkan device has: a stage binds no more than four storage buffers."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[1]
MOST = 4  # the least maxPerStageDescriptorStorageBuffers


def lines_of(path, cpu):
    """The lines of a file that are compiled for CPU drivers, or for cards."""
    wanted = [True]
    for line in path.read_text().splitlines():
        if line.startswith("#ifdef EXEMPLAR_CPU"):
            wanted.append(cpu)
        elif line.startswith("#if"):
            wanted.append(True)
        elif line == "#else":
            wanted[-1] = not wanted[-1]
        elif line.startswith("#endif"):
            wanted.pop()
        elif all(wanted):
            yield line


def bindings(path, cpu, seen):
    """The storage buffers that a shader and what it includes declare, in one of its builds."""
    if path in seen:
        return []
    seen.add(path)
    text = "\n".join(lines_of(path, cpu))
    found = re.findall(r"^layout.*\bbuffer\s+(\w+)\s*\{", text, re.M)
    if not cpu:  # shaders/lib/tables.glsl
        found += re.findall(r"^layout.*\bu?vec4_table\((\w+)", text, re.M)
    for name in re.findall(r'^#include "([^"]+)"', text, re.M):
        found += bindings(ROOT / name, cpu, seen)
    return found


def main():
    stages = [path for end in ("comp", "vert", "frag") for path in sorted((ROOT / "shaders").rglob(f"*.{end}"))]
    assert len(stages) > 40, stages
    wrong = 0
    for path, cpu in ((path, cpu) for path in stages for cpu in (False, True)):
        buffers = bindings(path, cpu, set())
        if len(buffers) > MOST:
            wrong += 1
            print(f"{path.relative_to(ROOT)}{' (CPU)' if cpu else ''}: {len(buffers)} storage buffers ({', '.join(buffers)}); at most {MOST}, "
                  "so read some through texel buffers")
    if not wrong:
        print(f"{len(stages)} shaders bind what every device has")
    return wrong


sys.exit(main())

#!/usr/bin/env python3
"""Shaders keep to what every Vulkan device has: a stage binds no more than four storage buffers."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[1]
MOST = 4  # the least maxPerStageDescriptorStorageBuffers


def bindings(path, seen):
    """The storage buffers that a shader and what it includes declare."""
    if path in seen:
        return []
    seen.add(path)
    text = path.read_text()
    found = re.findall(r"\bbuffer\s+(\w+)\s*\{", text)
    for name in re.findall(r'#include "([^"]+)"', text):
        found += bindings(ROOT / name, seen)
    return found


def main():
    stages = [path for end in ("comp", "vert", "frag") for path in sorted((ROOT / "shaders").rglob(f"*.{end}"))]
    assert len(stages) > 40, stages
    wrong = 0
    for path in stages:
        buffers = bindings(path, set())
        if len(buffers) > MOST:
            wrong += 1
            print(f"{path.relative_to(ROOT)}: {len(buffers)} storage buffers ({', '.join(buffers)}); at most {MOST}, "
                  "so read some through texel buffers")
    if not wrong:
        print(f"{len(stages)} shaders bind what every device has")
    return wrong


sys.exit(main())

#!/usr/bin/env python3
"""Writes a source for each library and program that includes all of its sources, and says how to compile these.

Usage: whole_libraries.py BUILD FOLDER

BUILD is a configured build folder of this project. FOLDER receives the sources (NAME.cpp), the options of each for a compiler
(NAME.options), and a compile_commands.json. The paths of the sources are printed. Sources outside the project and those that the
build makes (shaders' arrays) are left out.
"""
import collections
import json
import pathlib
import shlex
import sys


def own(source, build):
    """Whether a source is the project's: a batch of its sources (EXEMPLAR_UNITY), or one of them."""
    root = pathlib.Path(__file__).resolve().parent.parent
    return "Unity" in source.parts or (root in source.parents and build not in source.parents)


def main():
    build, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    commands = json.loads((build / "compile_commands.json").read_text())
    by_target = collections.defaultdict(list)
    for entry in commands:
        if own(pathlib.Path(entry["file"]), build):
            words = shlex.split(entry["command"])
            target = words[words.index("-o") + 1].split(".dir/")[0]
            by_target[entry["directory"], target].append((entry["file"], words[:words.index("-o")]))
    wholes = []
    for (directory, target), parts in sorted(by_target.items()):
        whole = folder / (pathlib.Path(target).name + ".cpp")
        whole.write_text("".join(f'#include "{file}"\n' for file, _ in sorted(parts)))
        arguments = parts[0][1]
        whole.with_suffix(".options").write_text(shlex.join(arguments[1:]))
        wholes.append({"directory": directory, "file": str(whole), "arguments": [*arguments, "-c", str(whole)]})
    (folder / "compile_commands.json").write_text(json.dumps(wholes))
    print(*(whole["file"] for whole in wholes), sep="\n")


if __name__ == "__main__":
    main()

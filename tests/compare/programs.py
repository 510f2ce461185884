"""Runs the programs of programs/, which give what Exemplar learns for arrays of numbers, and reads and writes their files."""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy

SKIPPED = 77
TYPES = {"F32": "<f4", "I32": "<i4", "U8": "u1"}
ROOT = pathlib.Path(__file__).resolve().parents[2]


def write_tensors(path, arrays, metadata=None):
    """A safetensors file of float32, int32 and uint8 arrays and of texts."""
    header, parts, offset = {"__metadata__": {key: str(value) for key, value in (metadata or {}).items()}}, [], 0
    names = {numpy.dtype(code): name for name, code in TYPES.items()}
    # The widest first, so that every array lies at a multiple of its size.
    for name, array in sorted(arrays.items(), key=lambda item: -item[1].dtype.itemsize):
        array = numpy.ascontiguousarray(array)
        header[name] = {"dtype": names[array.dtype], "shape": array.shape, "data_offsets": [offset, offset + array.nbytes]}
        offset += array.nbytes
        parts.append(array)
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text)
        for array in parts:
            file.write(array.data)


def read_tensors(path):
    """The arrays of a safetensors file, by name, and its texts."""
    content = pathlib.Path(path).read_bytes()
    size = struct.unpack("<Q", content[:8])[0]
    header = json.loads(content[8:8 + size])
    metadata = header.pop("__metadata__", {})
    arrays = {}
    for name, entry in header.items():
        begin, end = (8 + size + offset for offset in entry["data_offsets"])
        arrays[name] = numpy.frombuffer(content[begin:end], TYPES[entry["dtype"]]).reshape(entry["shape"])
    return arrays, metadata


def program(name):
    """The path of a built program; EXEMPLAR_BUILD is the build folder, 'build' unless set."""
    folder = pathlib.Path(os.environ.get("EXEMPLAR_BUILD", ROOT / "build"))
    inside = {"exemplar": folder / "exemplar"}
    return inside.get(name, folder / "tests" / name)


def run(name, arguments, arrays, metadata=None, scratch=None, behind=()):
    """Calls a program with 'arguments IN OUT behind' and returns what it wrote to OUT: arrays and texts."""
    with tempfile.TemporaryDirectory(prefix="exemplar-compare-", dir=scratch) as folder:
        given, found = pathlib.Path(folder) / "in", pathlib.Path(folder) / "out"
        write_tensors(given, arrays, metadata)
        subprocess.run([program(name), *map(str, arguments), given, found, *behind], check=True)
        return read_tensors(found)


def table(title, columns, rows):
    """A table in Markdown; 'rows' are pairs of a name and its cells."""
    lines = [f"| {title} | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(cells) + " |" for name, cells in rows]
    return "\n".join(lines)


def require_compare():
    """Ends a test that 'tests/run.sh --compare' did not ask for, with the exit code that ctest takes for skipped."""
    if not os.environ.get("EXEMPLAR_COMPARE"):
        print("skipped: comparisons with other learners are run by 'tests/run.sh --compare'")
        sys.exit(SKIPPED)
    try:
        import sklearn  # noqa: F401
        import xgboost  # noqa: F401
    except ImportError as error:
        print(f"skipped: {sys.executable} lacks a package (Debian: python3-sklearn, python3-xgboost): {error}")
        sys.exit(SKIPPED)

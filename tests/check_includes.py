#!/usr/bin/env python3
"""Checks the direction of includes by reading the include lines, and that folders stay small enough to be walked through.

Directions: apps, python -> gpu -> host; between the subjects of host and of gpu as below; inside a subject that has rooms, a
room includes those listed before it. A folder has at most 30 files. Prints one line per violation and exits with 1 if there
is any; first makes sure that violations would be found.
"""
import pathlib
import re
import sys

HOST = {
    'core': set(),
    'mesh': {'core'},
    'learn': {'core'},
    'graphcut': {'core'},
    'data': {'core', 'mesh', 'learn'},
    'imaging': {'core', 'mesh'},
    'animation': {'core', 'mesh'},
    'synth': {'core', 'mesh', 'animation', 'hatching'},
    'lines': {'core', 'mesh', 'imaging'},
    'curvature': {'core', 'mesh', 'learn', 'data', 'animation', 'lines'},
    'shape': {'core', 'mesh', 'learn'},
    'labeling': {'core', 'mesh', 'learn', 'graphcut', 'data', 'shape'},
    'parts': {'core', 'mesh', 'graphcut', 'animation', 'shape', 'data', 'lines'},
    'hatching': {'core', 'mesh', 'learn', 'graphcut', 'data', 'imaging', 'lines', 'shape'},
}
GPU = {
    'runtime': set(),
    'learn': {'runtime'},
    'labeling': {'runtime', 'learn'},
    'imaging': {'runtime'},
    'curvature': {'runtime'},
    'lines': {'runtime', 'imaging', 'curvature'},
    'hatching': {'runtime', 'imaging', 'learn'},
    'window': {'runtime', 'imaging'},
}
# The rooms of a subject, each may include those before it. '' stands for the files that lie in the subject's own folder.
ROOMS = {
    'host/curvature': ['state', 'model', 'learning'],
    'host/data': ['', 'catalog'],
    'host/hatching': ['fields', 'features', 'tracing', 'measurement', 'comparison', 'drawing', 'registration', 'rules', 'style', 'placement', 'refinement', 'animation', ''],
    'host/imaging': ['', 'pictures', 'vectors'],
    'host/labeling': ['features', 'inference', 'training', 'evaluation', 'category', 'painting', 'batch'],
    'host/learn': ['', 'regression', 'components', 'boosting'],
    'host/lines': ['extraction', 'strokes', ''],
    'host/mesh': ['', 'queries', 'editing', 'curvature', 'io', 'gltf', 'label_files'],
    'host/parts': ['splitting', 'transfer', 'rigging', 'materials', 'prototype'],
    'host/synth': ['modeling', 'shapes', 'animations', 'damage', 'arrangements', 'hatching'],
    'gpu/curvature': ['surface', 'learned', ''],
    'gpu/runtime': ['vulkan', 'device', 'kernels', 'record', 'measure'],
    'apps/bench': ['kernels', 'spirv', ''],
    'apps/exemplar': ['', 'parts', 'label', 'category', 'catalog', 'batch', 'curvature', 'lines', 'hatch', 'bench', 'demo'],
    'apps/viewer': ['controls', 'painting', 'scene', 'window', ''],
}
FOLDERS = ('apps', 'cmake', 'docs', 'gpu', 'host', 'python', 'shaders', 'tests')
MOST_FILES = 30
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')


def room_violation(file, included):
    """The same between rooms of one subject."""
    subject = '/'.join(file[:2])
    if subject not in ROOMS or included[:2] != file[:2]:
        return None
    own, other = (parts[2] if len(parts) > 3 else '' for parts in (file, included))
    order = ROOMS[subject]
    if own not in order or other not in order:
        return f'tests/check_includes.py does not list the room {subject}/{own if own not in order else other}'
    if order.index(other) > order.index(own):
        return f'{subject}/{own or "."} is not above {subject}/{other or "."}'
    return None


def violation(file, included):
    """Why `file` (path parts) may not include `included` (path parts), or None."""
    top, target = file[0], included[0]
    if top == 'host':
        if target in ('gpu', 'apps', 'python') or included[-1] in ('volk.h', 'vulkan.h', 'vulkan.hpp') or target == 'vulkan':
            return 'host/ knows no Vulkan'
        if target == 'host' and included[1] != file[1] and included[1] not in HOST.get(file[1], set()):
            return f'host/{file[1]} is not above host/{included[1]}'
    if top == 'gpu':
        if target in ('apps', 'python'):
            return f'gpu/ is below {target}/'
        if target == 'gpu' and included[1] != file[1] and included[1] not in GPU.get(file[1], set()):
            return f'gpu/{file[1]} is not above gpu/{included[1]}'
    if {top, target} == {'apps', 'python'}:
        return 'programs and bindings share libraries, not each other'
    return room_violation(file, included)


def crowded(root):
    """One line for each folder with too many files; examples of damaged files are counted by nobody."""
    found = []
    for top in FOLDERS:
        for folder in [root / top, *sorted((root / top).rglob('*'))]:
            if not folder.is_dir() or '__pycache__' in folder.parts or 'corpus' in folder.parts:
                continue
            count = sum(path.is_file() for path in folder.iterdir())
            if count > MOST_FILES:
                found.append(f'{folder.relative_to(root)}: {count} files; at most {MOST_FILES}: divide it into rooms')
    return found


def check(root):
    found = []
    for top in ('host', 'gpu', 'apps', 'python'):
        for path in sorted((root / top).rglob('*')):
            if path.suffix not in ('.h', '.cpp'):
                continue
            file = path.relative_to(root).parts
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                reason = match and violation(file, tuple(match.group(1).split('/')))
                if reason:
                    found.append(f'{"/".join(file)}:{number}: includes {match.group(1)}: {reason}')
    return found


def self_test():
    assert violation(('host', 'mesh', 'a.h'), ('gpu', 'runtime', 'device.h'))
    assert violation(('host', 'mesh', 'a.h'), ('volk.h',))
    assert violation(('host', 'mesh', 'a.h'), ('python', 'arrays.h'))
    assert violation(('gpu', 'learn', 'a.h'), ('python', 'arrays.h'))
    assert violation(('python', 'a.cpp'), ('apps', 'exemplar', 'backend.h'))
    assert violation(('host', 'mesh', 'a.h'), ('host', 'labeling', 'crf.h'))
    assert violation(('gpu', 'runtime', 'a.h'), ('gpu', 'learn', 'b.h'))
    assert not violation(('host', 'labeling', 'a.h'), ('host', 'core', 'errors.h'))
    assert not violation(('gpu', 'learn', 'a.h'), ('host', 'learn', 'b.h'))
    assert not violation(('python', 'a.cpp'), ('gpu', 'learn', 'b.h'))
    assert not violation(('host', 'mesh', 'a.h'), ('vector',))
    assert violation(('host', 'mesh', 'queries', 'a.h'), ('host', 'mesh', 'io', 'io.h'))
    assert violation(('host', 'mesh', 'mesh.h'), ('host', 'mesh', 'io', 'io.h'))
    assert violation(('host', 'mesh', 'unknown', 'a.h'), ('host', 'mesh', 'mesh.h'))
    assert not violation(('host', 'mesh', 'io', 'a.h'), ('host', 'mesh', 'mesh.h'))


if __name__ == '__main__':
    self_test()
    root = pathlib.Path(__file__).resolve().parent.parent
    violations = check(root) + crowded(root)
    print('\n'.join(violations) or 'includes point the right way')
    sys.exit(1 if violations else 0)

#!/usr/bin/env python3
"""Checks the direction of includes by reading the include lines: apps, python -> gpu -> host, and inside host the layers below.

Prints one line per violation and exits with 1 if there is any; first makes sure that violations would be found.
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
    'synth': {'core', 'mesh', 'animation', 'learn', 'imaging', 'hatching'},
    'lines': {'core', 'mesh', 'imaging'},
    'curvature': {'core', 'mesh', 'learn', 'data', 'animation', 'lines', 'imaging'},
    'shape': {'core', 'mesh', 'learn'},
    'labeling': {'core', 'mesh', 'learn', 'graphcut', 'data', 'imaging', 'shape'},
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
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]')


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
    return None


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


if __name__ == '__main__':
    self_test()
    violations = check(pathlib.Path(__file__).resolve().parent.parent)
    print('\n'.join(violations) or 'includes point the right way')
    sys.exit(1 if violations else 0)

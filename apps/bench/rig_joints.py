#!/usr/bin/env python3
"""Measures rigs: rig_joints.py MODEL MESH... labels each mesh by the model, and compares its joints with those by NAME_labels.txt beside
it ('exemplar label rig --truth'). Prints a line per mesh and the share of joints within 5 % of the longest edge of its box."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = os.environ.get('EXEMPLAR_PROGRAM', 'exemplar')


def measure(model, mesh, folder):
    truth = mesh.with_name(mesh.stem + '_labels.txt')
    subprocess.run([PROGRAM, 'label', 'rig', model, mesh, '--truth', truth, '--out', folder / 'rig.glb', '--json', folder / 'rig.json',
                    '--quiet'], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / 'rig.json').read_text())['truth']


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    near = total = 0
    with tempfile.TemporaryDirectory() as folder:
        for mesh in map(pathlib.Path, sys.argv[2:]):
            truth = measure(sys.argv[1], mesh, pathlib.Path(folder))
            far = [joint for joint in truth['joints'] if joint['distance'] is None or joint['distance'] > 0.05]
            near += truth['within_5_percent']
            total += len(truth['joints'])
            listed = ', '.join('/'.join(joint['labels']) + (': none' if joint['distance'] is None else f": {joint['distance']:.3f}") for joint in far)
            print(f"{mesh.name}: {truth['within_5_percent']} of {len(truth['joints'])}  {listed}")
    print(f'{near} of {total}: {100 * near / max(1, total):.1f} %')


if __name__ == '__main__':
    main()

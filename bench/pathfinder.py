#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Compares `holdfast move` with plans that ignore mechanics, on pairs of shapes of a geometric
planner (Modular Robotics Group, "pathfinder", MIT): files with `initial` in their name, and the
same with `final`.

    python3 bench/pathfinder.py HOLDFAST FOLDER [--seconds S] [--keep FOLDER]

Cells are read as cubes: of order 3 with z upwards, of order 2 standing, second coordinate upwards,
and no module leaves the plane. Where modules touch by edges only they are rhombic dodecahedra, read
as balls in a face-centred lattice. Static modules are fixed, and the final shape has them where the
initial one has them; without any the lowest modules stand on a floor. Colours are kinds where both
shapes have the same ones. Prints a table in Markdown, and of each pair that cannot be read why.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

MARGIN = 2  # Cells that a module may go beyond both shapes.


def read(path):
    """Modules as {cell: (is static, colour)}; raises ValueError for what is no set of cells."""
    data = json.loads(path.read_text())
    modules = {}
    for module in data['modules']:
        position = module['position']
        cell = (position[0], 0, position[1]) if len(position) == 2 else tuple(position)
        color = module.get('color') or module.get('properties', {}).get('colorProperty', {}).get(
            'color')
        if cell in modules:
            raise ValueError(f'{path.name}: two modules at {position}')
        modules[cell] = (module['static'], json.dumps(color))
    return modules, len(data['modules'][0]['position']) == 2


def final_of(path):
    return path.with_name(path.name.replace('initial', 'final'))


CUBE_SIDES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
BALL_SIDES = [(a, b, 0) for a in (1, -1) for b in (1, -1)]
BALL_SIDES += [(a, 0, c) for a in (1, -1) for c in (1, -1)]
BALL_SIDES += [(0, b, c) for b in (1, -1) for c in (1, -1)]


def is_connected(cells, sides):
    left, queue = set(cells), [next(iter(cells))]
    left.discard(queue[0])
    while queue:
        x, y, z = queue.pop()
        for cell in ((x + a, y + b, z + c) for a, b, c in sides):
            if cell in left:
                left.discard(cell)
                queue.append(cell)
    return not left


def read_pair(path):
    if not final_of(path).exists():
        raise ValueError('there is no final shape')
    initial, is_flat = read(path)
    final, _ = read(final_of(path))
    static = {cell: module for cell, module in initial.items() if module[0]}
    final = {**static, **{cell: (cell in static, module[1]) for cell, module in final.items()}}
    if len(initial) != len(final):
        raise ValueError(f'{len(initial)} modules at first, {len(final)} at last')
    lattice = 'cubic'
    if not all(is_connected(modules, CUBE_SIDES) for modules in (initial, final)):
        if not all(is_connected(modules, BALL_SIDES) for modules in (initial, final)):
            raise ValueError('the modules are in pieces')
        lattice = 'face-centred'
        initial, final = to_balls(initial), to_balls(final)
    return initial, final, is_flat, lattice


def to_balls(modules):
    """From coordinates with an even sum to those of a face-centred lattice whose layers are square:
    along (1, 1, 0), (1, -1, 0) and (1, 0, 1), every second layer shifted back."""
    return {((x + y - z) // 2 + z // 2, (x - y - z) // 2 + z // 2, z): module
            for (x, y, z), module in modules.items()}


def mobile_colors(modules):
    return collections.Counter(color for is_static, color in modules.values() if not is_static)


def write(path, modules, kinds, lattice):
    has_fixed = any(is_static for is_static, _ in modules.values())
    entries = []
    for cell, (is_static, color) in sorted(modules.items()):
        entry = {'cell': cell}
        if is_static:
            entry['fixed'] = True
        elif kinds:
            entry['kind'] = kinds[color]
        entries.append(entry)
    structure = {'format': 'holdfast-structure', 'version': 2, 'lattice': lattice,
                 'support_z': None if has_fixed else min(cell[2] for cell in modules),
                 'kinds': {kind: {} for kind in kinds.values()}, 'modules': entries}
    path.write_text(json.dumps(structure))


def box(initial, final, is_flat):
    cells = list(initial) + list(final)
    low = [min(cell[k] for cell in cells) - MARGIN for k in range(3)]
    high = [max(cell[k] for cell in cells) + MARGIN for k in range(3)]
    if is_flat:
        low[1] = high[1] = 0
    return ','.join(map(str, low)) + ':' + ','.join(map(str, high))


def move(program, files, options):
    result = subprocess.run([program, 'move', *map(str, files), '--quiet', '--json', '-', *options],
                            capture_output=True, text=True, check=False)
    if result.returncode > 2:
        raise ValueError(result.stderr.strip())
    return json.loads(result.stdout)


def steps_text(plan):
    if plan['result'] != 'found':
        return plan['result']
    least = plan['steps_min']
    return f"{plan['steps']}" if plan['steps'] == least else f"{plan['steps']} (>= {least})"


def seconds_text(plan):
    return f"{plan['seconds']:.2g}"


def compare(arguments, path, name):
    initial, final, is_flat, lattice = read_pair(path)
    kinds = {}
    if mobile_colors(initial) == mobile_colors(final):
        kinds = {color: f'color-{i}' for i, color in enumerate(sorted(mobile_colors(initial)))}
    kinds = kinds if len(kinds) > 1 else {}
    files = [arguments.keep / f'{name}_initial.json', arguments.keep / f'{name}_final.json']
    write(files[0], initial, kinds, lattice)
    write(files[1], final, kinds, lattice)
    options = ['--seconds', str(arguments.seconds), '--within', box(initial, final, is_flat)]
    options += ['--pivot'] if arguments.pivot else []
    free = move(arguments.program, files, [*options, '--geometry-only'])
    safe = move(arguments.program, files, options)
    count = sum(not is_static for is_static, _ in initial.values())
    unsafe = free['stages'] - free['stages_safe']
    cost = safe['steps'] - free['steps'] if 'found' == safe['result'] == free['result'] else '-'
    return [name, f'{len(initial)} ({count})', steps_text(free), seconds_text(free),
            f"{unsafe} of {free['stages']}", steps_text(safe), seconds_text(safe), f'{cost}']


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('program')
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--seconds', type=float, default=20, help='of each search')
    parser.add_argument('--pivot', action='store_true', help='cubes pivot instead of sliding')
    parser.add_argument('--only', help='one pair, by its name')
    parser.add_argument('--keep', type=pathlib.Path, help='folder for the structures made')
    arguments = parser.parse_args()
    scratch = tempfile.TemporaryDirectory()
    arguments.keep = arguments.keep or pathlib.Path(scratch.name)
    arguments.keep.mkdir(exist_ok=True)
    print('| pair | modules (that can move) | geometric moves | s | stages not safe | safe moves '
          '| s | cost |\n|---|---|---|---|---|---|---|---|')
    failures = []
    for path in sorted(arguments.folder.glob('*initial*.json')):
        name = path.stem.replace('initial', '').strip('_').replace('--', '-')
        if arguments.only not in (None, name):
            continue
        try:
            print('| ' + ' | '.join(compare(arguments, path, name)) + ' |', flush=True)
        except ValueError as error:
            failures.append(f'{name}: {error}')
    print('\n' + '\n'.join(failures))


if __name__ == '__main__':
    sys.exit(main())

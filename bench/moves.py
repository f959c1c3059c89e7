#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Times `holdfast move` on pairs of shapes of many cubes on a floor, and replays every plan.

    python3 bench/moves.py HOLDFAST [--modules N ...] [--pairs slab middle line blob] [--seconds S]
                           [--strength N] [--keep FOLDER] [-- OPTIONS OF MOVE]

slab: a solid block becomes a plate of one layer around the same corner; middle: around the block.
line: a row on the floor becomes a standing wall at its end. blob: two random blobs, grown cell by
cell from the same one, `--seed` says which. --strength: what a connection holds, N, such as 1e5, by
which nothing breaks; default: the strengths of Blinky Blocks. Plans are replayed by what shapes
alone say (`replay`). Prints a table in Markdown.
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

SIDES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def plus(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def blob(count, rng):
    cells, border = {(0, 0, 0)}, []
    newest = (0, 0, 0)
    while True:
        border += [plus(newest, side) for side in SIDES if newest[2] + side[2] >= 0]
        if len(cells) == count:
            return sorted(cells)
        while newest in cells:
            newest = border.pop(rng.randrange(len(border)))
        cells.add(newest)


def box(count, width, depth):
    return [(i % width, i // width % depth, i // (width * depth)) for i in range(count)]


def root(count, power):
    width = 1
    while width ** power < count:
        width += 1
    return width


def pair(kind, count, seed):
    if kind == 'slab':
        return (box(count, root(count, 3), root(count, 3)), box(count, root(count, 2), count))
    if kind == 'middle':
        plate = box(count, root(count, 2), count)
        inset = (root(count, 2) - root(count, 3)) // 2
        block = box(count, root(count, 3), root(count, 3))
        return [plus(cell, (inset, inset, 0)) for cell in block], plate
    if kind == 'line':
        width = root(count, 2)
        return ([(i, 0, 0) for i in range(count)], box(count, width, 1))
    rng = random.Random(seed)
    return blob(count, rng), blob(count, rng)


def is_connected(cells):
    left, queue = set(cells), [next(iter(cells))]
    left.discard(queue[0])
    while queue:
        cell = queue.pop()
        for side in SIDES:
            other = plus(cell, side)
            if other in left:
                left.discard(other)
                queue.append(other)
    return not left


def is_way(rest, start, end):
    """Whether a cube slides beside two of `rest` one behind the other, or around the corner of one
    over a free cell."""
    way = minus(end, start)
    if way in SIDES:
        return any(plus(start, side) in rest and plus(end, side) in rest for side in SIDES
                   if side not in (way, minus((0, 0, 0), way)))
    if sorted(map(abs, way)) != [0, 1, 1]:
        return False
    parts = [side for side in SIDES if sum(a * b for a, b in zip(side, way)) == 1]
    return any(plus(start, carrier) in rest and plus(start, along) not in rest
               and (start[2] + along[2] >= 0)
               for carrier, along in (parts, parts[::-1]))


def replay(start, target, steps):
    """Raises AssertionError for a plan that cannot be carried out. While one module walks the rest
    is the same, so whether it is in one piece is asked once a walk."""
    cells, walker, rest = set(start), None, None
    for number, step in enumerate(steps):
        (move,) = step['move']
        origin, end = tuple(move['from']), tuple(move['to'])
        assert origin in cells and end not in cells and end[2] >= 0, (number, move)
        if origin != walker:
            rest = cells - {origin}
            assert is_connected(rest), (number, move)
            assert any(cell[2] == 0 for cell in rest), (number, move)
        assert is_way(rest, origin, end), (number, move)
        cells = rest | {end}
        walker = end
    assert cells == set(target)


def write(path, cells, strength):
    material = {'strength_vertical_n': strength, 'strength_lateral_n': strength}
    path.write_text(json.dumps({
        'format': 'holdfast-structure', 'version': 1, 'name': path.stem,
        **({'material': material} if strength else {}),
        'modules': [list(cell) for cell in cells]}))


def run(arguments, kind, count, folder):
    start, target = pair(kind, count, arguments.seed)
    files = [folder / f'{kind}_{count}_{end}.json' for end in ('from', 'to')]
    plan, report = folder / f'{kind}_{count}_plan.json', folder / f'{kind}_{count}_report.json'
    for path, cells in zip(files, (start, target)):
        write(path, cells, arguments.strength)
    before = time.monotonic()
    done = subprocess.run(
        [arguments.holdfast, 'move', *map(str, files), '-q', '-o', str(plan), '--json', str(report),
         '--seconds', str(arguments.seconds), *arguments.options], check=False)
    wall = time.monotonic() - before
    if done.returncode not in (0, 1, 2):
        sys.exit(f'{kind} {count}: exit code {done.returncode}')
    answer = json.loads(report.read_text())
    if answer['result'] == 'found':
        replay(start, target, json.loads(plan.read_text())['steps'])
    found = answer['steps'] if answer['result'] == 'found' else answer['result']
    bound = answer['assignment_bound']
    share = f'{answer["steps"] / bound:.2f}' if answer['result'] == 'found' else '-'
    print(f'| {kind} | {count} | {found} | {bound} | {share} | '
          f'{answer["stages_safe"]} of {answer["stages"]} | {wall:.1f} |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('holdfast')
    parser.add_argument('--modules', type=int, nargs='+', default=[30, 100, 300, 1000])
    parser.add_argument('--pairs', nargs='+', default=['slab', 'middle', 'line', 'blob'])
    parser.add_argument('--seconds', type=float, default=60)
    parser.add_argument('--strength', type=float)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--keep', help='Keep shapes, plans and reports there')
    own, options = sys.argv[1:], []
    if '--' in own:
        own, options = own[:own.index('--')], own[own.index('--') + 1:]
    arguments = parser.parse_args(own)
    arguments.options = options
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(arguments.keep or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        print('| pair | modules | moves | at least | ratio | stages safe | s |')
        print('|---|---|---|---|---|---|---|')
        for kind in arguments.pairs:
            for count in arguments.modules:
                run(arguments, kind, count, folder)


if __name__ == '__main__':
    main()

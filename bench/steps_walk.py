#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a sequence of steps to time holdfast steps with: a module walks over a robot of cubes.

    bench/steps_walk.py walk.json [STEPS] [--shape portal|bush]
    time holdfast steps walk.json --quiet

The robot has 221 modules: with `portal` a slab of 10 x 10, two towers of 2 x 2 x 10 on it and a
beam of 40 modules over them; with `bush` a slab of 8 x 8 with towers and arms that the walker
loads. The walker goes to the free place beside it that it was at the longest time ago, by slides
and convex turns."""

import argparse
import json

DIRECTIONS = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def portal():
    cells = {(x, y, 0) for x in range(10) for y in range(10)}
    cells |= {(x, y, z) for x in (1, 2, 7, 8) for y in (4, 5) for z in range(1, 11)}
    return cells | {(x, y, z) for x in range(10) for y in (4, 5) for z in (11, 12)}


def bush():
    cells = {(x, y, 0) for x in range(8) for y in range(8)}
    for x, y in ((1, 1), (1, 6), (6, 1), (6, 6), (3, 3)):
        cells |= {(x, y, z) for z in range(1, 22)}
        cells |= {(x + (1 if x < 4 else -1) * k, y, 11) for k in (1, 2)}
    cells |= {(x, 2, 5) for x in (1, 6)} | {(1, 1, 22), (6, 6, 22), (6, 1, 22), (1, 6, 22)}
    cells |= {(x, 3, 15) for x in (2, 4)} | {(4, 4, 15), (2, 4, 15), (2, 2, 15), (4, 2, 15)}
    rest = 220 - len(cells)
    cells |= {(3, 3 + (k % 2), 22 + k // 2) for k in range(rest)}
    return cells


def places(cells, at):
    """Where a module can go, with the module that carries it there in a turn."""
    found = []
    for forth in DIRECTIONS:
        to = plus(at, forth)
        for side in DIRECTIONS:
            carrier = plus(at, side)
            if carrier not in cells:
                continue
            if to not in cells and plus(to, side) in cells and to[2] >= 0:
                found.append(to)
            corner = plus(to, side)
            if (to not in cells and corner not in cells and corner != at
                    and forth != side and corner[2] >= 0 and to[2] >= 0):
                found.append(corner)
    return sorted(set(found))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('path')
    parser.add_argument('count', type=int, nargs='?', default=26000)
    parser.add_argument('--shape', choices=['portal', 'bush'], default='portal')
    options = parser.parse_args()
    cells = bush() if options.shape == 'bush' else portal()
    at = (0, 0, 1)
    modules = sorted(cells) + [at]
    seen = {at: 0}
    steps = []
    for step in range(1, options.count + 1):
        to = min(places(cells, at), key=lambda cell: (seen.get(cell, 0), cell))
        steps.append({'move': [{'from': at, 'to': to}]})
        seen[to] = step
        at = to
    with open(options.path, 'w') as file:
        json.dump({'format': 'holdfast-structure', 'version': 2, 'name': 'walk', 'modules': modules,
                   'steps': steps}, file)
    print(f'{len(modules)} modules, {len(steps)} steps, {len(seen)} places')


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""limit_highs.py HOLDFAST [COUNT] [SEED]   limit loads beside another solver and formulation.

Makes COUNT random robots (1,000) of all lattices, has HOLDFAST find their limit loads (check
--limit) and finds them once more with SciPy's HiGHS: six forces per connection as variables and
every limit as rows, cones by polygons of 32 sides within and around. Both must agree to a
millionth, or overlap where there are cones. Needs python3-scipy. Exits 1 if any disagree.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

SIDES = 32
PITCH = 40.0
GRAVITY = np.array([0, 0, -9.81])
FACTOR_MAX = 1e5
STEPS = {
    'cubic': [(1, 0, 0), (0, 1, 0), (0, 0, 1)],
    'face-centred': [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 1), (0, -1, 1), (-1, -1, 1)],
    'hexagonal': [(1, 0, 0), (0, 0, 1), (-1, 0, 1)],
    'hexagonal-prism': [(1, 0, 0), (0, 1, 0), (-1, 1, 0), (0, 0, 1)]}
BASES = {
    'cubic': np.eye(3),
    'face-centred': np.array([[1, 0, 0], [0, 1, 0], [0.5, 0.5, math.sqrt(0.5)]]),
    'hexagonal': np.array([[1, 0, 0], [0, 1, 0], [0.5, 0, math.sqrt(0.75)]]),
    'hexagonal-prism': np.array([[1, 0, 0], [0.5, math.sqrt(0.75), 0], [0, 0, 1]])}


def file_cell(lattice, axial):
    i, j, k = axial
    if lattice == 'face-centred':
        return [i + k // 2, j + k // 2, k]
    if lattice == 'hexagonal':
        return [i + k // 2, j, k]
    return [i, j, k]


def random_robot(rng, lattice):
    """Axial cells, grown from one on the floor, and the law of all connectors."""
    cells = [(0, 0, 0)]
    for _ in range(rng.randrange(1, 14)):
        base = rng.choice(cells)
        step = rng.choice(STEPS[lattice])
        sign = rng.choice((1, -1))
        cell = tuple(b + sign * s for b, s in zip(base, step))
        if cell not in cells and cell[2] >= 0:
            cells.append(cell)
    law = {'strength_n': rng.uniform(2, 20), 'lever_mm': rng.uniform(8, 20)}
    if rng.random() < 0.8:
        law['shear_strength_n'] = rng.uniform(1, 10)
    if rng.random() < 0.8:
        law['torsion_strength_nmm'] = rng.uniform(20, 200)
    if rng.random() < 0.3:
        law['bending'] = 'round'
    if rng.random() < 0.3:
        law['friction'] = rng.uniform(0.2, 2)
        law['torsion_radius_mm'] = rng.uniform(5, 20)
    return cells, law


def frame(along):
    """x', y', z' of a connection along a unit vector."""
    up = np.array([0, 0, 1.0]) - along[2] * along
    x = up / np.linalg.norm(up) if np.linalg.norm(up) > 1e-9 else np.array([1.0, 0, 0])
    return x, np.cross(-along, x), -along


def polygon_rows(radius):
    return [(radius * math.cos(2 * math.pi * i / SIDES), radius * math.sin(2 * math.pi * i / SIDES))
            for i in range(SIDES)]


class Program:
    """Rows A_eq x = 0 for every module; A_ub x <= b for every limit; x0 is the factor."""

    def __init__(self, lattice, cells, law, mass, is_within):
        self.law = law
        # A polygon around the circle has its sides at the radius, one within shrunk by the cosine.
        self.radius = 1 / math.cos(math.pi / SIDES) if is_within else 1.0
        self.count = 1
        self.balance = []
        self.limits = []
        index = {cell: i for i, cell in enumerate(cells)}
        place = [np.array(cell) @ BASES[lattice] * PITCH for cell in cells]
        for i in range(len(cells)):
            self.balance += [(6 * i + k, 0, mass * GRAVITY[k]) for k in range(3)]
        for cell, i in index.items():
            for step in STEPS[lattice]:
                other = index.get(tuple(c + s for c, s in zip(cell, step)))
                if other is not None:
                    along = np.array(step) @ BASES[lattice]
                    self.connect(i, other, along, place)
            if cell[2] == 0:
                self.stand(i, PITCH / 2 if lattice == 'cubic' else PITCH / 4)

    def force(self, first, second, arm, axes):
        """Six variables, at `arm` from the first node and -arm from the second."""
        begin = self.count
        self.count += 6
        for module, sign, lever in ((first, 1, arm), (second, -1, -arm)):
            if module is None:
                continue
            for k in range(3):
                moment = np.cross(lever, axes[k])
                for row in range(3):
                    self.balance.append((6 * module + row, begin + k, sign * axes[k][row]))
                    turning = 6 * module + 3 + row
                    self.balance.append((turning, begin + k, sign * moment[row] / PITCH))
                    self.balance.append((turning, begin + 3 + k, sign * axes[k][row]))
        return begin

    def limit(self, terms, bound):
        self.limits.append((terms, bound))

    def connect(self, first, second, along, place):
        x, y, z = frame(along)
        begin = self.force(first, second, along * PITCH / 2, (x, y, -z))
        fx, fy, axial, mx, my, torsion = range(begin, begin + 6)
        law, lever = self.law, self.law['lever_mm'] / PITCH
        if law.get('bending') == 'round':
            for a, b in polygon_rows(self.radius):
                self.limit([(axial, 1), (mx, a / lever), (my, b / lever)], law['strength_n'])
        else:
            for moment in (mx, my):
                for sign in (1, -1):
                    self.limit([(axial, 1), (moment, sign / lever)], law['strength_n'])
        if 'shear_strength_n' in law:
            for a, b in polygon_rows(self.radius):
                self.limit([(fx, a), (fy, b)], law['shear_strength_n'])
        if 'torsion_strength_nmm' in law:
            for sign in (1, -1):
                self.limit([(torsion, sign)], law['torsion_strength_nmm'] / PITCH)
        if 'friction' in law:
            turn = PITCH / (law['friction'] * law['torsion_radius_mm'])
            for a, b in polygon_rows(self.radius / law['friction']):
                for sign in (1, -1):
                    self.limit([(axial, 1), (fx, a), (fy, b), (torsion, sign * turn)],
                               law['strength_n'])

    def stand(self, module, half):
        axes = (np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, 1.0]))
        begin = self.force(module, None, np.array([0, 0, -PITCH / 2]), axes)
        for moment in (begin + 3, begin + 4):
            for sign in (1, -1):
                self.limit([(begin + 2, -1), (moment, sign * PITCH / half)], 0)

    def solve(self, module_count):
        rows, columns, values = zip(*self.balance)
        equal = csr_matrix((values, (rows, columns)), shape=(6 * module_count, self.count))
        entries = [(row, column, value) for row, (terms, _) in enumerate(self.limits)
                   for column, value in terms]
        rows, columns, values = zip(*entries)
        below = csr_matrix((values, (rows, columns)), shape=(len(self.limits), self.count))
        cost = np.zeros(self.count)
        cost[0] = -1
        found = linprog(cost, A_ub=below, b_ub=[bound for _, bound in self.limits], A_eq=equal,
                        b_eq=np.zeros(6 * module_count), method='highs',
                        bounds=[(0, FACTOR_MAX)] + [(None, None)] * (self.count - 1))
        return found.x[0] if found.status == 0 else math.nan


def disagreement(low, high, within, around):
    """How far apart the two ranges are, as a share; 0 where they overlap."""
    return max(0.0, within - high, low - around) / max(1e-3, abs(around))


def main():
    program = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    rng = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    robots = [(lattice, *random_robot(rng, lattice))
              for lattice in (rng.choice(list(STEPS)) for _ in range(count))]
    mass = 0.06106
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for i, (lattice, cells, law) in enumerate(robots):
            files.append(os.path.join(folder, f'{i}.json'))
            with open(files[-1], 'w', encoding='utf-8') as file:
                json.dump({'format': 'holdfast-structure', 'version': 2, 'lattice': lattice,
                           'support_z': 0, 'material': {'mass_kg': mass, **law},
                           'modules': [file_cell(lattice, cell) for cell in cells]}, file)
        report = os.path.join(folder, 'report.json')
        subprocess.run([program, 'check', '--quiet', '--limit', '--json', report, *files],
                       check=False)
        with open(report, encoding='utf-8') as file:
            answers = json.load(file)
    worst, faults, outcomes = 0.0, 0, {}
    for i, ((lattice, cells, law), answer) in enumerate(zip(robots, answers)):
        found = answer['limit_load']
        outcomes[found['outcome']] = outcomes.get(found['outcome'], 0) + 1
        low, high = found['range']
        high = FACTOR_MAX if high is None else high
        ranges = [Program(lattice, cells, law, mass, is_within).solve(len(cells))
                  for is_within in (True, False)]
        apart = disagreement(low, high, *ranges)
        worst = max(worst, apart)
        if not apart <= 1e-6 or found['outcome'] == 'stopped':
            faults += 1
            print(f'{i}: {lattice}, {len(cells)} modules, {law}: {low} to {high}, HiGHS {ranges}')
    print(f'{count} robots, {outcomes}; apart by at most {worst:.1e}; {faults} disagree')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

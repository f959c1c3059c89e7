#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""contact_states.py FILE...   every consistent set of contact states of a few cubes

Tries all states of all facets under the regularised law, Eqs. (9)-(12) of [Piranda 2021]: solves
the linear system that they make and looks whether its solution prescribes the same states. None
means that the law has no solution, more than one that it has several. Shares nothing with the
library. For structures of version 2 with cubes of Table I on obstacles in contact: 10 states a
facet, so 3 facets are plenty.
"""
import itertools
import json
import sys

E, L, WEIGHT, GAMMA = 100.0, 40.0, 0.06106 * 9.81, 1e-4
STEPS = [tuple(sign * (k == axis) for k in range(3)) for axis in range(3) for sign in (1, -1)]
SEPARATED = 'separated'
STATES = [SEPARATED] + list(itertools.product((0, 1, -1), repeat=2))


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(row) for row in zip(*a)]


def beam():
    """K11 and K12, Eqs. (1)-(2)."""
    area, inertia, torsion = L * L, L**4 / 12, 2.25 * L**4 / 41.6
    s, c, b = 12 * E * inertia / L**3, 6 * E * inertia / L**2, 4 * E * inertia / L
    k11 = [[0.0] * 6 for _ in range(6)]
    k12 = [[0.0] * 6 for _ in range(6)]
    for i, value in enumerate((s, s, E * area / L, b, b, E * torsion / L)):
        k11[i][i] = value
        k12[i][i] = value / 2 if i in (3, 4) else -value
    for i, j, sign in ((0, 4, -1), (1, 3, 1)):
        k11[i][j] = k11[j][i] = k12[i][j] = sign * c
        k12[j][i] = -sign * c
    return k11, k12


def frame(n):
    """Rows x', y', z' = -n, for forces and torques."""
    x = (1, 0, 0) if n[2] else (0, 0, 1)
    z = tuple(-component for component in n)
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    return [[*axis, 0, 0, 0] for axis in (x, y, z)] + [[0, 0, 0, *axis] for axis in (x, y, z)]


def law(state):
    """What makes the force of the trial force, Eqs. (10)-(12)."""
    if state == SEPARATED:
        return [[GAMMA * (i == j) for j in range(6)] for i in range(6)]
    matrix = [[float(i == j) for j in range(6)] for i in range(6)]
    for row, (tilt, other, sign) in enumerate(zip(state, (1, 0), (1, -1)), start=3):
        if tilt:
            matrix[row] = [0.0] * 6
            matrix[row][row] = GAMMA
            matrix[row][other] = sign * (1 - GAMMA) * L / 2
            matrix[row][2] = -(1 - GAMMA) * tilt * L / 2
    return matrix


def state_of(f):
    """The state that a trial force prescribes."""
    if f[2] >= 0:
        return SEPARATED
    hats = (f[3] - f[1] * L / 2, f[4] + f[0] * L / 2)
    return tuple((1 if hat > 0 else -1) if abs(hat) >= -f[2] * L / 2 else 0 for hat in hats)


def solved(matrix, right):
    """Gaussian elimination with pivots."""
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            share = rows[i][k] / rows[k][k]
            if share:
                rows[i] = [x - share * y for x, y in zip(rows[i], rows[k])]
    u = [0.0] * n
    for k in reversed(range(n)):
        u[k] = (rows[k][n] - sum(rows[k][j] * u[j] for j in range(k + 1, n))) / rows[k][k]
    return u


def add(matrix, row, column, block):
    for i in range(6):
        for j in range(6):
            matrix[6 * row + i][6 * column + j] += block[i][j]


def assembled(document):
    """Stiffness without contact, and for every facet its module and the frame."""
    index = {tuple(cell): i for i, cell in enumerate(document['modules'])}
    solid = {tuple(cell) for obstacle in document['obstacles'] for cell in obstacle['cells']}
    k11, k12 = beam()
    matrix = [[0.0] * (6 * len(index)) for _ in range(6 * len(index))]
    facets = []
    for cell, i in index.items():
        for step in STEPS:
            other, t = tuple(a + b for a, b in zip(cell, step)), frame(step)
            if other in index:
                add(matrix, i, i, product(transposed(t), product(k11, t)))
                add(matrix, i, index[other], product(transposed(t), product(k12, t)))
            elif other in solid:
                facets.append((i, t))
    return matrix, facets, k11


def consistent_states(document):
    matrix, facets, k11 = assembled(document)
    right = [-WEIGHT if i % 6 == 2 else 0.0 for i in range(len(matrix))]
    for states in itertools.product(STATES, repeat=len(facets)):
        stiffness = [row[:] for row in matrix]
        for (i, t), state in zip(facets, states):
            add(stiffness, i, i, product(transposed(t), product(law(state), product(k11, t))))
        u = solved(stiffness, right)
        trial = [product(product(k11, t), [[x] for x in u[6 * i:6 * i + 6]]) for i, t in facets]
        if tuple(state_of([x for (x,) in f]) for f in trial) == states:
            yield states


def main():
    for name in sys.argv[1:]:
        with open(name, encoding='utf-8') as file:
            document = json.load(file)
        found = list(consistent_states(document))
        facet_count = len(assembled(document)[1])
        print(f'{name}: {len(found)} of {len(STATES) ** facet_count} sets are consistent')
        for states in found:
            print('   ', ', '.join(str(state) for state in states))


if __name__ == '__main__':
    main()

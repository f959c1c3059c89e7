# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Random robots for compare.py: what crosses the borders of parts in all ways.

Trees with long and short branches and a few loops on a foot of nine modules, and frames of straight
bars on which trees hang, whose loads a rank must hand on to the next. Some have loads, heavy or
fixed modules, gravity aslant, friction, or planned modules anywhere.
"""
import random

CUBIC = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
PRISM = CUBIC + [(-1, 1, 0), (1, -1, 0)]
LAYER = CUBIC[:4]
EVEN = [(0, 0), (-1, 0), (0, -1), (-1, -1)]
ODD = [(0, 0), (1, 0), (0, 1), (1, 1)]


def neighbours(lattice, cell):
    x, y, z = cell
    if lattice == 'face-centred':
        above = [(i, j, k) for k in (1, -1) for i, j in (EVEN if z % 2 == 0 else ODD)]
        steps = LAYER + above
    else:
        steps = CUBIC if lattice == 'cubic' else PRISM
    return [(x + i, y + j, z + k) for i, j, k in steps]


def tree(generator, lattice, count, straightness):
    """Branches that go straight on with this probability, or begin anywhere; a few close loops."""
    cells = [(i, j, 0) for i in range(-1, 2) for j in range(-1, 2)]
    known = set(cells)
    direction = None
    tip = cells[0]
    while len(cells) < count:
        if direction is None or generator.random() > straightness:
            tip = generator.choice(cells)
            direction = generator.randrange(len(neighbours(lattice, tip)))
        cell = neighbours(lattice, tip)[direction]
        touching = sum(other in known for other in neighbours(lattice, cell))
        if cell in known or cell[2] < 0 or touching > generator.choice([1, 1, 1, 2, 6]):
            direction = None
            continue
        known.add(cell)
        cells.append(cell)
        tip = cell
    return cells


def frame(generator):
    """Bars of cubes along the edges of large cells, on which trees hang."""
    step = generator.randrange(3, 9)
    size = step * generator.randrange(2, 4)
    every = range(size + 1)
    cells = [(x, y, z) for x in every for y in every for z in every
             if (x % step == 0) + (y % step == 0) + (z % step == 0) >= 2]
    known = set(cells)
    bars = len(cells)
    for _ in range(generator.randrange(5, 60)):
        tip = cells[generator.randrange(bars)]
        direction = generator.randrange(6)
        for _ in range(generator.randrange(1, 6)):
            tip = neighbours('cubic', tip)[direction]
            touching = sum(other in known for other in neighbours('cubic', tip))
            if tip in known or tip[2] < 0 or touching > 1:
                break
            known.add(tip)
            cells.append(tip)
            direction = generator.choice([direction, direction, generator.randrange(6)])
    return cells


def add_extras(generator, cells, document):
    """Each of them once in three times."""
    modules = document['modules']
    if generator.random() < 0.3:
        document['loads'] = [{'cell': list(generator.choice(cells)),
                              'force_n': [generator.uniform(-1, 1) for _ in range(3)]}
                             for _ in range(5)]
    if generator.random() < 0.3:
        for i in generator.sample(range(len(cells)), 5):
            modules[i] = {'cell': modules[i], 'mass_kg': generator.uniform(0.01, 0.3)}
    if generator.random() < 0.3:
        fixed = generator.choice([module for module in modules if isinstance(module, list)])
        modules[modules.index(fixed)] = {'cell': fixed, 'fixed': True}
    if generator.random() < 0.3:
        document['gravity_m_s2'] = [generator.uniform(-2, 2), generator.uniform(-2, 2), -9.5]
    if generator.random() < 0.3:
        document['floor'] = {'friction': 0.5}
    if generator.random() < 0.3:
        known = set(cells)
        tips = [list(cell) for cell in cells
                if sum(other in known for other in neighbours(document['lattice'], cell)) == 1]
        document['planned'] = [module for module in modules if module in tips]
        document['modules'] = [module for module in modules if module not in tips]


def random_robot(seed):
    """Its name, its document, and options of the check."""
    generator = random.Random(seed)
    kind = generator.choice(['tree', 'tree', 'frame', 'tiny tree'])
    lattice = 'cubic'
    if kind == 'frame':
        cells = frame(generator)
    else:
        lattice = generator.choice(['cubic', 'cubic', 'hexagonal-prism', 'face-centred'])
        count = generator.randrange(10, 22) if kind == 'tiny tree' else generator.randrange(99, 900)
        cells = tree(generator, lattice, count, generator.choice([0.3, 0.7, 0.9]))
    document = {'format': 'holdfast-structure', 'version': 2, 'lattice': lattice,
                'modules': [list(cell) for cell in cells],
                'material': {'strength_vertical_n': 10 ** generator.uniform(0, 3),
                             'strength_lateral_n': 10 ** generator.uniform(0, 3)}}
    add_extras(generator, cells, document)
    options = ['--bonded'] if generator.random() < 0.5 else []
    name = f'random {seed}: {lattice} {kind}{", bonded" if options else ""}'
    return name, document, options

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Compares holdfast-mpi on several numbers of ranks with holdfast check on one machine.

    compare.py HOLDFAST HOLDFAST_MPI RANKS [RANKS ...] [--only TEXT] [--table]

For each structure: the same verdict; the largest load ratio within 1e-4 of itself or of 1; at most
1.2 times the iterations of multigrid. Random robots in contact, which one machine solves directly
in between, are compared with one rank that does without the direct solver.
"""
import argparse
import copy
import json
import os
import subprocess
import sys
import tempfile

import random_robots

# As root, and on fewer cores than ranks: what mpirun asks for as options, which differ by user.
ENVIRONMENT = {**os.environ, 'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1',
               'OMPI_MCA_rmaps_base_oversubscribe': '1', 'OMPI_MCA_mpi_yield_when_idle': '1',
               'OMPI_MCA_btl_vader_single_copy_mechanism': 'none', 'OMP_NUM_THREADS': '1'}
LOAD_RATIO_ERROR = 1e-4
ITERATION_SHARE = 1.2
SECONDS_MAX = 120
# Random robots, chosen for what they have: planned and fixed modules, loads, other lattices, trees
# on frames, a few modules for each rank, undecided ones.
SEEDS = range(0, 20)
BONDED = ('--bonded',)
STRENGTHS = {'strength_vertical_n': 11.98, 'strength_lateral_n': 14.97}


def generated(holdfast, family, size):
    run = subprocess.run([holdfast, 'generate', family, str(size)], capture_output=True, check=True)
    return json.loads(run.stdout)


def planned_tail(document, count):
    """The last modules become planned ones, and some weights are the modules' own."""
    document['planned'] = document['modules'][-count:]
    document['modules'] = document['modules'][:-count]
    return document


def scaled_to_limit(holdfast, document, factor, *options):
    """The same with strengths at which the largest load ratio is about `factor`."""
    ratio = one_machine(holdfast, document, options)['overload']['load_ratio_max']
    scaled = copy.deepcopy(document)
    scaled['material'] = {key: strength * ratio / factor for key, strength in STRENGTHS.items()}
    return scaled


def written(document):
    file = tempfile.NamedTemporaryFile('w', suffix='.json', delete=False)
    with file:
        json.dump(document, file)
    return file.name


def one_machine(holdfast, document, options):
    name = written(document)
    run = subprocess.run([holdfast, 'check', name, '--json', '-', '--connections', '0', *options],
                         capture_output=True, timeout=SECONDS_MAX)
    os.unlink(name)
    return json.loads(run.stdout)


def in_parts(program, document, ranks, options, alone_max=0):
    name = written(document)
    run = subprocess.run(['mpirun', '-n', str(ranks), program, 'check', name, '--alone-max',
                          str(alone_max), '--json', '-', *options],
                         capture_output=True, timeout=SECONDS_MAX, env=ENVIRONMENT)
    os.unlink(name)
    if not run.stdout:
        raise AssertionError(f'no report on {ranks} ranks: {run.stderr.decode()}')
    return json.loads(run.stdout), run.returncode


def structures(holdfast):
    """Name, document, options: all families, near the limit and far from it, bonded and in contact,
    safe, overload, unstable."""
    cube = generated(holdfast, 'cube', 14)
    yield 'cube', cube, []
    yield 'cube, bonded', cube, ['--bonded']
    tower = generated(holdfast, 'tower', 60)
    yield 'tower', tower, []
    portal = generated(holdfast, 'portal', 40)
    yield 'portal', portal, []
    for factor in (0.99, 1.01):
        yield f'portal at {factor} of its limit', scaled_to_limit(holdfast, portal, factor), []
    yield 'portal, bonded', portal, ['--bonded']
    bridge = generated(holdfast, 'bridge', 60)
    yield 'bridge', bridge, []
    scaffold = generated(holdfast, 'scaffold', 21)
    yield 'scaffold', scaffold, []
    yield 'scaffold at 1.02', scaled_to_limit(holdfast, scaffold, 1.02), []
    yield 'shell', generated(holdfast, 'shell', 20), []
    growth = generated(holdfast, 'growth', 3000)
    yield 'growth', planned_tail(copy.deepcopy(growth), 5), []
    yield 'growth, bonded', growth, ['--bonded']
    yield 'arm', generated(holdfast, 'arm', 300), []
    yield 'arm, bonded', generated(holdfast, 'arm', 300), ['--bonded']
    yield 'ball', generated(holdfast, 'ball', 16), []
    yield 'sheet', generated(holdfast, 'sheet', 40), []
    yield 'prism-wall', generated(holdfast, 'prism-wall', 20), []
    yield from special_structures(holdfast)
    yield from small_structures()
    yield from slender_structures(holdfast)
    for seed in SEEDS:
        yield random_robots.random_robot(seed)


def special_structures(holdfast):
    """What one rank has and others have not: a mass, a load, an obstacle; and gravity aslant."""
    cube = {**generated(holdfast, 'cube', 10), 'version': 2}
    heavy = copy.deepcopy(cube)
    heavy['modules'][-1] = {'cell': heavy['modules'][-1], 'mass_kg': 2.0}
    yield 'cube with a heavy module', heavy, []
    yield 'cube with a load', {**cube, 'loads': [{'cell': [9, 9, 9], 'force_n': [5, 0, -20]}]}, []
    yield 'cube on a slope', {**cube, 'gravity_m_s2': [1.7, 0, -9.66]}, []
    yield 'cube that slides', {**cube, 'gravity_m_s2': [5, 0, -8], 'floor': {'friction': 0.3}}, []
    walls = {'support_z': None,
             'obstacles': [{'from': [-1, 0, 0], 'to': [-1, 9, 9], 'hold': 'bonded'}]}
    yield 'cube on a wall', {**cube, **walls}, []


def row_of(cells, **others):
    return {'format': 'holdfast-structure', 'version': 2, 'modules': cells, **others}


def small_structures():
    """Fewer modules than ranks, and a module or two for each; trees that cross ranks often."""
    yield 'single module', row_of([[0, 0, 0]]), []
    yield 'single planned module', row_of([[0, 0, 0]], planned=[[0, 0, 1]]), []
    yield 'three modules', row_of([[0, 0, 0], [0, 0, 1], [1, 0, 1]]), []
    yield 'hook', row_of([[0, 0, z] for z in range(4)] + [[1, 0, 3], [1, 0, 2]]), ['--bonded']
    snake = [[x, y, 0] for y in range(0, 16, 2) for x in range(8)]
    turns = [[7 if y % 4 == 1 else 0, y, 0] for y in range(1, 15, 2)]
    fixed = {'cell': snake.pop(0), 'fixed': True}
    yield 'snake', row_of([fixed] + snake + turns, support_z=None), []
    yield 'held by its tip', row_of([fixed] + [[x, 0, 0] for x in range(1, 70)],
                                    support_z=None), []


def slender_structures(holdfast):
    """What takes double precision, on lattices and supports of all kinds."""
    for family, size in (('sheet', 20), ('ball', 12)):
        wall = generated(holdfast, family, size)
        for factor in (0.99999, 1.00001):
            scaled = scaled_to_limit(holdfast, wall, factor, *BONDED)
            yield f'{family} at {factor} of its limit', scaled, list(BONDED)
    mast = [[x, y, z] for z in range(3300) for y in range(2) for x in range(2)]
    yield 'mast of prisms', row_of(mast, lattice='hexagonal-prism',
                                    gravity_m_s2=[1, 0, -9.7]), list(BONDED)
    wall = {'support_z': None,
            'obstacles': [{'from': [-1, 0, 0], 'to': [-1, 1, 1], 'hold': 'bonded'}]}
    beam = [[x, y, z] for z in range(2) for y in range(2) for x in range(3300)]
    yield 'beam on a wall', row_of(beam, **wall), []


def expected_iterations(program, name, document, options, one):
    """Those of one machine by multigrid alone; None: parts may ask one machine once more."""
    if not name.startswith('random') or options == list(BONDED):
        return one['solver']['multigrid_iterations']
    report, _ = in_parts(program, document, 1, [*options, '--multigrid'], alone_max=1000000)
    is_settled = report['verdict'] == one['verdict'] != 'undecided'
    return report['solver']['multigrid_iterations'] if is_settled else None


def compare(one, parts, name):
    faults = []
    if parts['verdict'] != one['verdict']:
        faults.append(f'{parts["verdict"]} ({parts["reasons"][0]}) instead of {one["verdict"]}')
    expected = one['overload']['load_ratio_max']
    found = parts['overload']['load_ratio_max']
    if not one['overload']['meaningful']:
        expected = found
    if (expected is None) != (found is None):
        faults.append(f'load ratio {found} instead of {expected}')
    elif expected is not None and abs(found - expected) > LOAD_RATIO_ERROR * max(1, abs(expected)):
        faults.append(f'load ratio {found} instead of {expected}')
    if parts['modules'] != one['modules']:
        faults.append(f'modules {parts["modules"]} instead of {one["modules"]}')
    margin, other = (one['stability']['simplified']['margin_mm'],
                     parts['stability']['simplified']['margin_mm'])
    if (margin is None) != (other is None) or abs((margin or 0) - (other or 0)) > 1e-6:
        faults.append(f'margin {other} instead of {margin}')
    return [f'{name}: {fault}' for fault in faults]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('holdfast')
    parser.add_argument('program')
    parser.add_argument('ranks', type=int, nargs='+')
    parser.add_argument('--only', default='')
    parser.add_argument('--table', action='store_true')
    arguments = parser.parse_args()
    faults = []
    count = 0
    for name, document, options in structures(arguments.holdfast):
        if arguments.only not in name:
            continue
        one = one_machine(arguments.holdfast, document, options)
        expected = expected_iterations(arguments.program, name, document, options, one)
        line = f'{name:28} {one["verdict"]:9} {one["overload"]["load_ratio_max"]} ' \
               f'{"-" if expected is None else expected:4}'
        for ranks in arguments.ranks:
            count += 1
            try:
                parts, code = in_parts(arguments.program, document, ranks, options)
            except (AssertionError, subprocess.TimeoutExpired) as error:
                faults.append(f'{name} on {ranks} ranks: {error}')
                continue
            faults += compare(one, parts, f'{name} on {ranks} ranks')
            iterations = parts['solver']['multigrid_iterations']
            if expected and iterations > ITERATION_SHARE * expected:
                faults.append(f'{name} on {ranks} ranks: {iterations} iterations, {expected} on '
                              f'one machine')
            line += f' {iterations:4}'
        if arguments.table:
            print(line, flush=True)
    for fault in faults:
        print(fault)
    print(f'{count} runs, {len(faults)} faults')
    return 1 if faults or count == 0 else 0


if __name__ == '__main__':
    sys.exit(main())

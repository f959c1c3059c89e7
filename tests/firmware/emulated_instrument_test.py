#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""emulated_instrument_test.py HOLDFAST IMAGE STRUCTURE   boards without pages, told at a line.

The structure's modules are emulated ('emulate --bare --serial'), a pseudo-terminal is at a free
face of the first one, and 'holdfast tell' says there what a stranger with boards would say. Their
verdict must be the exact one of 'holdfast check'.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from joined_terminals import DIRECTIONS, NAMES, joined


def main():
    holdfast, image, path = sys.argv[1:]
    faults = []

    def run(*arguments):
        done = subprocess.run([holdfast, *map(str, arguments)], capture_output=True, text=True,
                              check=False, timeout=120)
        print(f'$ holdfast {" ".join(map(str, arguments))}   [{done.returncode}]\n{done.stdout}'
              f'{done.stderr}', end='', flush=True)
        return done.returncode, done.stdout + done.stderr

    def expect(is_so, what):
        if not is_so:
            faults.append(what)

    document = json.loads(pathlib.Path(path).read_text())
    cells = [tuple(cell) for cell in document['modules']]
    face = next(k for k, step in enumerate(DIRECTIONS)
                if tuple(a + b for a, b in zip(cells[0], step)) not in cells)
    place = ','.join(map(str, cells[0]))
    with tempfile.TemporaryDirectory() as folder:
        ground = f'{folder}/ground.json'
        pathlib.Path(ground).write_text(json.dumps({**document, 'planned': []}))
        exact = json.loads(run('check', ground, '--json', '-')[1])
        here, there = joined()
        with subprocess.Popen([holdfast, 'emulate', ground, '--image', image, '--bare', '--serial',
                               f'{place}:{NAMES[face]}={there}', '--json', '-', '--time', '100'],
                              stdout=subprocess.PIPE, text=True) as emulated:
            expect(run('listen', here, '--once')[0] == 2, 'no numbers, no verdict')
            expect('(?), anchor' not in run('listen', here, '--once')[1], 'nobody has said so yet')
            expect(run('tell', here, 'anchor', place)[0] == 0, 'told who it is before its numbers')
            code, text = run('tell', here, 'configure', ground)
            expect(code == 0 and 'revision 1' in text, 'told the numbers')
            report = json.loads(emulated.communicate(timeout=300)[0])
    robot = report['distributed']
    expect(robot['verdict'] == exact['verdict'] and robot['all_modules_agree'],
           f'the robot says {robot["verdict"]}, exact is {exact["verdict"]}')
    expect(report['firmware']['steps_unlike_host'] == 0, 'steps are those of the host')
    print('\n'.join(faults) if faults else f'told at a line, all say {exact["verdict"]}')
    sys.exit(1 if faults else 0)


main()

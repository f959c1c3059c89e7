#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""serial_test.py HOLDFAST MODULE IMAGE STRUCTURE   a real module in an emulated robot.

The last module of the structure is MODULE, examples/module/on_terminals.c, a process in real time;
the others are emulated, and a pseudo-terminal joins the two ('emulate --serial'). The verdict must
be the exact one of 'holdfast check', and both must come to it.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from joined_terminals import DIRECTIONS, NAMES, joined


def main():
    holdfast, module, image, path = sys.argv[1:]
    cells = [tuple(module['cell'] if isinstance(module, dict) else module)
             for module in json.loads(pathlib.Path(path).read_text())['modules']]
    exact = json.loads(subprocess.run([holdfast, 'check', path, '--json', '-'], capture_output=True,
                                      text=True, check=False).stdout)
    real = cells[-1]
    face, neighbour = next((k, tuple(a + b for a, b in zip(real, step)))
                           for k, step in enumerate(DIRECTIONS)
                           if tuple(a + b for a, b in zip(real, step)) in cells)
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([holdfast, 'emulate', path, '--pages', folder], check=True,
                       stdout=subprocess.DEVNULL)
        here, there = joined()
        page = f'{folder}/module_{len(cells) - 1}.bin'
        with subprocess.Popen([module, page, f'{face}={here}'], stdout=subprocess.PIPE,
                              text=True) as process:
            place = ','.join(map(str, neighbour)) + ':' + NAMES[face ^ 1]
            done = subprocess.run([holdfast, 'emulate', path, '--image', image, '--serial',
                                   f'{place}={there}', '--json', '-', '--time', '60'],
                                  capture_output=True, text=True, check=False, timeout=300)
            process.kill()
            said = process.stdout.read().splitlines()
        report = json.loads(done.stdout)
        print(done.stderr, said, report['distributed'].get('verdict'), report['firmware'])
        if report['distributed']['verdict'] != exact['verdict']:
            faults.append(f'the emulated ones say {report["distributed"]["verdict"]}')
        if not said or said[-1].split(' ')[0] != exact['verdict']:
            faults.append(f'the real one says {said[-1:]}')
        if report['firmware']['steps_unlike_host'] != 0:
            faults.append('steps differ from the host\'s')
        first = ','.join(map(str, cells[0]))
        for arguments, words in [(['9,9,9:+x=' + there], 'module'), (['0,0,0=' + there], 'FACE'),
                                 ([first + ':+x=/no/such'], 'cannot be opened')]:
            done = subprocess.run([holdfast, 'emulate', path, '--image', image, '--serial',
                                   *arguments], capture_output=True, text=True, check=False)
            if done.returncode not in (64, 65) or words not in done.stderr:
                faults.append(f'{arguments}: {done.returncode}, {done.stderr}')
    print('\n'.join(faults) if faults else f'both say {exact["verdict"]}')
    sys.exit(1 if faults else 0)


main()

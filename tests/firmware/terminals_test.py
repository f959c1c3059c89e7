#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""terminals_test.py HOLDFAST MODULE STRUCTURE...   robots of processes on pseudo-terminals.

MODULE is examples/module/on_terminals.c, one process for each module. Where two modules touch, each
has a pseudo-terminal, and this program carries the bytes from one to the other. The first module is
told what is planned. The last verdict that each prints must be the exact one of 'holdfast check'.
"""
import json
import os
import pathlib
import selectors
import subprocess
import sys
import tempfile
import time
import tty

from joined_terminals import DIRECTIONS

TIMEOUT_S = 60
QUIET_S = 1.0  # So long nobody may have changed what was said.


def wire(cells):
    """By module: arguments FACE=TERMINAL; and, by the end that this program holds, the other."""
    arguments, across = [[] for _ in cells], {}
    for i, cell in enumerate(cells):
        for face, step in enumerate(DIRECTIONS[::2]):
            other = tuple(a + b for a, b in zip(cell, step))
            if other not in cells:
                continue
            ends = []
            for module, its_face in ((i, 2 * face), (cells.index(other), 2 * face + 1)):
                held, terminal = os.openpty()
                tty.setraw(terminal)
                arguments[module].append(f'{its_face}={os.ttyname(terminal)}')
                ends.append(held)
            across.update({ends[0]: ends[1], ends[1]: ends[0]})
    return arguments, across


def carry(across, processes):
    """Carries bytes until all have said what they keep to; returns the last line of each."""
    said = {process.stdout.fileno(): '' for process in processes}
    selector = selectors.DefaultSelector()
    for end in [*across, *said]:
        selector.register(end, selectors.EVENT_READ)
    begin = changed = time.monotonic()
    while time.monotonic() < begin + TIMEOUT_S:
        for key, _ in selector.select(0.05):
            data = os.read(key.fd, 4096)
            if key.fd in across:
                os.write(across[key.fd], data)
            elif data:
                said[key.fd] = data.decode().splitlines()[-1]
                changed = time.monotonic()
            else:
                selector.unregister(key.fd)  # It has ended.
        if time.monotonic() > changed + QUIET_S and not any(
                line == '' or line.startswith('none') for line in said.values()):
            break
    return list(said.values())


def run(holdfast, program, path):
    """Faults found, as text."""
    document = json.loads(pathlib.Path(path).read_text())
    cells = [tuple(module['cell'] if isinstance(module, dict) else module)
             for module in document['modules']]
    exact = json.loads(subprocess.run([holdfast, 'check', path, '--json', '-'], capture_output=True,
                                      text=True, check=False).stdout)
    plans = ['plan=' + ','.join(map(str, cell)) for cell in document['planned']]
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([holdfast, 'emulate', path, '--pages', folder], check=True,
                       stdout=subprocess.DEVNULL)
        arguments, across = wire(cells)
        processes = [subprocess.Popen([program, f'{folder}/module_{i}.bin', *arguments[i],
                                       *(plans if i == 0 else [])], stdout=subprocess.PIPE)
                     for i in range(len(cells))]
        try:
            said = carry(across, processes)
        finally:
            for process in processes:
                process.kill()
                process.wait()
    print(f'{document["name"]}: {len(cells)} modules, {said[0]}, '
          f'{time.monotonic() - begin:.1f} s', flush=True)
    return [f'module {i}: {line}, exact is {exact["verdict"]}' for i, line in enumerate(said)
            if line.split(' ')[0] != exact['verdict']]


def main():
    holdfast, program, *paths = sys.argv[1:]
    faults = [f'{path}: {fault}' for path in paths for fault in run(holdfast, program, path)]
    print('\n'.join(faults) if faults else f'{len(paths)} robots decided like the exact answer')
    sys.exit(1 if faults else 0)


main()

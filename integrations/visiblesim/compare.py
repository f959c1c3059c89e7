#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""compare.py HOLDFAST BLOCK_CODE CONFIGURATION...   the robot in VisibleSim beside our own programs

Runs every configuration in VisibleSim without a display for several seeds, by `holdfast simulate
--link v1` and by `holdfast check`, and prints a table: verdicts, seconds on the robot, packets,
seconds on this machine. Where two modules are in the middle of a robot it depends on microseconds
which one becomes the root, so a run is compared with the simulated one that has as many packets.
Exits 1 if a verdict differs from the exact one or seconds on the robot by more than a tenth.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

SECONDS_TOLERANCE = 0.1
SEEDS = range(1, 6)
SEEDS_HERE = range(1, 11)
HEAD = ['configuration', 'modules', '`check`', 'VisibleSim', 'load ratio',
        's on the robot, VisibleSim', '`simulate`', 'largest difference', 'packets, VisibleSim',
        '`simulate`', 'wall s, VisibleSim', '`simulate`']


def report(command, folder=None):
    """The JSON report that a command writes into the file at its end; wall seconds."""
    with tempfile.TemporaryDirectory() as out:
        path = pathlib.Path(out) / 'report.json'
        begin = time.monotonic()
        run = subprocess.run([*command, path], cwd=folder, capture_output=True, text=True)
        seconds = time.monotonic() - begin
        if not path.exists():
            sys.exit(f'{" ".join(map(str, command))}: {run.stderr or run.stdout}')
        return json.loads(path.read_text()), seconds, run.stdout


def run_there(block_code, path, seed):
    command = [block_code, '-t', '-a', str(seed), '-c', path, '-J']
    found, _, text = report(command, block_code.parent)
    return found['distributed'], float(re.search(r'wall +(\S+) s', text)[1])


def run_here(holdfast, path, seed):
    """Lines jitter as much as VisibleSim's, so that waves that meet do so in either order."""
    command = [holdfast, 'simulate', path, '--link', 'v1', '--jitter', '3e-5', '--seed', str(seed)]
    found, wall, _ = report([*command, '--json'])
    return found['distributed'], wall


def from_to(values, form):
    low, high = format(min(values), form), format(max(values), form)
    return low if low == high else f'{low} to {high}'


def row(holdfast, block_code, path):
    exact, _, _ = report([holdfast, 'check', path, '--json'])
    there = [run_there(block_code, path, seed) for seed in SEEDS]
    here = [run_here(holdfast, path, seed) for seed in SEEDS_HERE]
    differences, partners = [], []
    for run, _ in there:
        # Whose tree was the same: its packets are as many.
        partner = min(here, key=lambda other: abs(other[0]['messages'] - run['messages']))[0]
        differences.append(run['simulated_s'] / partner['simulated_s'] - 1)
        partners.append(partner)
    largest = max(differences, key=abs)
    is_right = all(run['verdict'] == exact['verdict'] and run['all_modules_agree']
                   for run, _ in there)
    ratio = there[0][0].get('load_ratio_max')
    modules = exact['modules']
    cells = [path.stem, f'{modules["existing"]}+{modules["planned"]}', exact['verdict'],
             exact['verdict'] if is_right else 'differs', f'{ratio:.4f}' if ratio else '',
             from_to([run['simulated_s'] for run, _ in there], '.2f'),
             from_to([run['simulated_s'] for run in partners], '.2f'), f'{100 * largest:+.1f} %',
             from_to([run['messages'] for run, _ in there], 'd'),
             from_to([run['messages'] for run in partners], 'd'),
             f'{min(wall for _, wall in there):.3f}', f'{min(wall for _, wall in here):.3f}']
    return cells, is_right and abs(largest) <= SECONDS_TOLERANCE


def main():
    holdfast, block_code, *paths = (pathlib.Path(name).resolve() for name in sys.argv[1:])
    print('| ' + ' | '.join(HEAD) + ' |')
    print('|' + '---|' * len(HEAD))
    is_good = True
    for path in paths:
        cells, is_row_good = row(holdfast, block_code, path)
        print('| ' + ' | '.join(cells) + ' |', flush=True)
        is_good = is_good and is_row_good
    sys.exit(0 if is_good else 1)


if __name__ == '__main__':
    main()

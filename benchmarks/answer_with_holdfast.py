#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""answer_with_holdfast.py HOLDFAST   holdfast's own answers as CSV, for score.py

Runs the program HOLDFAST on all structures and takes the fields from its JSON reports.
"""
import csv
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent


def reports(holdfast, command, names, *options):
    """Name -> report; the exit codes 0, 1 and 2 are verdicts."""
    files = [str(HERE / 'structures' / f'{name}.json') for name in names]
    run = subprocess.run([holdfast, command, *files, '--json', '-', *options],
                         capture_output=True, text=True, check=False)
    if run.returncode not in (0, 1, 2):
        sys.exit(f'answer_with_holdfast.py: holdfast {command} ended with {run.returncode}:\n'
                 f'{run.stderr}')
    found = json.loads(run.stdout)
    return dict(zip(names, found if isinstance(found, list) else [found]))


def cells(pair):
    return '-'.join(f'({x},{y},{z})' for x, y, z in pair) if pair else None


def row_of_check(report):
    rigid, overload = report['stability']['rigid'], report['overload']
    is_meaningful = overload['meaningful'] and overload['load_ratio_max'] is not None
    row = {'verdict': report['verdict'],
           'load_ratio_max': max(overload['load_ratio_max'], 0) if is_meaningful else None,
           'at': cells(overload['at']) if is_meaningful else None,
           'margin_mm': report['stability']['simplified']['margin_mm'],
           'tilt_margin_deg': rigid['tilt_margin_deg']}
    if 'limit_load' in report:
        row['limit_load_factor'] = report['limit_load_factor']
        if report['limit_load']['outcome'] == 'unbounded':
            row['limit_load_factor'] = 'unbounded'
    return row


def row_of_steps(report):
    first = report['first_unsafe']
    return {'verdict': report['verdict'],
            'first_unsafe': f'{first["step"]} {first["stage"]}' if first else 'none'}


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ('-h', '--help'):
        sys.exit(__doc__)
    holdfast = sys.argv[1]
    answers = json.loads((HERE / 'answers.json').read_text())['answers']
    checks = [one['name'] for one in answers if one['question'] == 'check']
    limits = [one['name'] for one in answers if 'limit_load_factor' in one]
    found = reports(holdfast, 'check', [name for name in checks if name not in limits],
                    '--connections', '1')
    found |= reports(holdfast, 'check', limits, '--connections', '1', '--limit')
    rows = {name: row_of_check(report) for name, report in found.items()}
    for one in answers:
        if one['question'] == 'steps':
            rows[one['name']] = row_of_steps(reports(holdfast, 'steps', [one['name']])[one['name']])
    writer = csv.DictWriter(sys.stdout, ['name', 'verdict', 'load_ratio_max', 'at', 'margin_mm',
                                         'tilt_margin_deg', 'limit_load_factor', 'first_unsafe'],
                            lineterminator='\n')
    writer.writeheader()
    writer.writerows({'name': one['name'], **rows[one['name']]} for one in answers)


if __name__ == '__main__':
    main()

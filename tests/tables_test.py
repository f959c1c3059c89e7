#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""tables_test.py HOLDFAST REPOSITORY
The tables and pages of next, steps, order and move say what the JSON report of the same run says.

- every row of --csv has the numbers, cells and verdicts of its entry in --json, in its order
- every --html is well formed, has the text of the command in it, and as many pictures as it should
"""
import csv
import html
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

NUMBERS = ('load_ratio_max', 'load_ratio_bound', 'margin_mm')
faults = []


def expect(is_so, *what):
    if not is_so:
        faults.append(' '.join(map(str, what)))


def numbers_of(row):
    return [float(row[key]) if row.get(key) else None for key in NUMBERS]


def cell_of(row, prefix=''):
    return [int(row[f'{prefix}{axis}']) for axis in 'xyz']


def places(report, rows):
    expect(len(rows) == len(report['candidates']) > 0, 'next: rows', len(rows))
    for row, place in zip(rows, report['candidates']):
        expect(cell_of(row) == place['cell'] and row['verdict'] == place['verdict'], row, place)
        expect(numbers_of(row) == [place.get(key) for key in NUMBERS], row, place)


def stages(report, rows):
    wanted = [(step, name) for step in report['steps'] for name in step['stages']]
    expect(len(rows) == len(wanted) > 0, 'steps: rows', len(rows))
    for row, (step, name) in zip(rows, wanted):
        stage = step['stages'][name]
        expect((int(row['step']), row['stage']) == (step['step'], name), row, step['step'], name)
        expect(row['verdict'] == stage['verdict'], row, stage)
        expect(numbers_of(row) == [stage.get(key) for key in NUMBERS], row, stage)


def order(report, rows):
    wanted = [(step, cell, state) for step, state in enumerate(report['way'][1:])
              for cell in state.get('attach', state.get('detach'))]
    expect(len(rows) == len(wanted), 'order: rows', len(rows))
    for row, (step, cell, state) in zip(rows, wanted):
        expect(int(row['step']) == step and cell_of(row) == cell, row, step, cell)
        expect(numbers_of(row) == [state.get(key) for key in NUMBERS], row, state)


def moves(report, rows):
    """The moves themselves are in the plan, which `steps` judges once more."""
    expect(len({row['step'] for row in rows}) == report['steps'], 'move: steps', len(rows))
    ratios = [float(row['load_ratio_max']) for row in rows if row['load_ratio_max']]
    margins = [float(row['margin_mm']) for row in rows if row['margin_mm']]
    expect(max(ratios, default=None) == report['load_ratio_max'], 'move: load ratio', ratios)
    expect(min(margins, default=None) == report['margin_min_mm'], 'move: margin', margins)


def check_plan(plan, rows):
    steps = json.loads(plan)['steps']
    said = [(int(row['step']), cell_of(row, 'from_'), cell_of(row, 'to_')) for row in rows]
    expect(said == [(index, move['from'], move['to']) for index, step in enumerate(steps)
                    for move in step['move']], 'move: rows', said)


def check_page(page, printed, picture_count, command):
    expect(page.startswith('<!DOCTYPE html>') and '<script' not in page, command, 'no plain page')
    pictures = re.findall(r'<svg.*?</svg>', page, re.S)
    expect(len(pictures) == picture_count, command, len(pictures), 'pictures')
    for picture in pictures:
        ET.fromstring(picture)
    shown = html.unescape(page[page.index('<pre>') + 5:page.index('</pre>')]).splitlines()
    # The verdict of steps is in the page's heading; times differ.
    lines = printed.splitlines()[command[0] == 'steps':]
    missing = [line for line in lines if line not in shown and ' s' not in line[-2:]]
    expect(lines and not missing, command, 'the text is missing:', missing)


def run(program, folder, arguments, compare, picture_count, *, plan=False):
    """One run for everything but the text, which is not printed beside it."""
    files = {kind: folder / f'out.{kind}' for kind in ('json', 'csv', 'html')}
    command = [program, *arguments]
    for kind, file in files.items():
        command += [f'--{kind}', file]
    if plan:
        command += ['-o', folder / 'plan.json']
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    expect(done.returncode in (0, 1, 2), arguments, done.stderr)
    rows = list(csv.DictReader(io.StringIO(files['csv'].read_text())))
    compare(json.loads(files['json'].read_text()), rows)
    check_page(files['html'].read_text(), done.stdout, picture_count, arguments)
    if plan:
        check_plan((folder / 'plan.json').read_text(), rows)


def main():
    program, repository = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    scenarios = repository / 'scenarios'
    plans = scenarios / 'plan'
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([program, 'generate', 'cube', '15', '-o', folder / 'cube.json'], check=True)
        (folder / 'odd.json').write_text(json.dumps({
            'format': 'holdfast-structure', 'version': 2, 'name': '<b> & "odd"',
            'modules': [[0, 0, 0], [0, 0, 1], [1, 0, 1]], 'steps': [{'attach': [[2, 0, 1]]}]}))
        for file in ('arm_breaks_b', 'crane_tips_a'):
            run(program, folder, ['next', scenarios / f'{file}.json'], places, 1)
        run(program, folder, ['next', folder / 'cube.json', '--limit', '7'], places, 1)
        run(program, folder, ['next', folder / 'odd.json'], places, 1)
        run(program, folder, ['steps', folder / 'odd.json'], stages, 2)
        run(program, folder, ['steps', plans / 'walk_over_beam.json'], stages, 2)
        for more in ([], ['--reverse'], ['--group', '2']):
            run(program, folder, ['order', plans / 'counterweight.json', *more], order, 2)
        run(program, folder, ['order', plans / 'arch.json', '--help-seconds', '0'], order, 0)
        run(program, folder, ['order', folder / 'cube.json'], order, 2)
        shapes = [plans / 'around_arm_from.json', plans / 'around_arm_to.json']
        for more in ([], ['--geometry-only']):
            run(program, folder, ['move', *shapes, '--within=-9,0,-9:9,0,9', *more], moves, 2,
                plan=True)
    print('\n'.join(faults) or 'all tables and pages are as their reports')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""score_test.py ROOT   benchmarks/score.py sees what is wrong, and says so with its exit code

The rows are those of answers.json themselves, and then each has one fault.
"""
import csv
import io
import json
import pathlib
import subprocess
import sys

COLUMNS = ['name', 'verdict', 'load_ratio_max', 'at', 'margin_mm', 'tilt_margin_deg',
           'limit_load_factor', 'first_unsafe']


def perfect_rows(answers):
    rows = {}
    for one in answers:
        row = {key: one[key] for key in COLUMNS if key in one}
        row['verdict'] = one['verdict'][0]
        if 'at' in row:
            row['at'] = '-'.join(str(tuple(cell)) for cell in reversed(row['at'][-1]))
        if isinstance(row.get('load_ratio_max'), dict):
            row['load_ratio_max'] = row['load_ratio_max']['low']
        rows[one['name']] = row
    return rows


def as_csv(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, list(dict.fromkeys(key for row in rows for key in row)))
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


class Scorer:
    def __init__(self, root):
        self.program = root / 'benchmarks/score.py'
        self.faults = []

    def expect(self, what, code, text, text_expected='', *options):
        run = subprocess.run([sys.executable, self.program, '-', *options], check=False,
                             input=text, capture_output=True, text=True)
        if run.returncode != code or text_expected not in run.stdout + run.stderr:
            self.faults.append(f'{what}: expected {code} and "{text_expected}", found '
                               f'{run.returncode}:\n{run.stdout[-1500:]}{run.stderr}')


def check_wrong_answers(scorer, rows):
    def changed(name, **changes):
        return as_csv([{**row, **changes} if row['name'] == name else row
                       for row in rows.values()])

    def without(*names):
        return as_csv([row for row in rows.values() if row['name'] not in names])

    ratio = rows['arm_4']['load_ratio_max']
    scorer.expect('all right', 0, as_csv(rows.values()))
    scorer.expect('a byte order mark', 0, '\ufeff' + as_csv(rows.values()))
    scorer.expect('JSON, a list', 0, json.dumps(list(rows.values())))
    scorer.expect('JSON, by name', 0, json.dumps(
        {name: {key: row[key] for key in row if key != 'name'} for name, row in rows.items()}))
    scorer.expect('a wrong verdict', 1, changed('arm_4', verdict='overload'),
                  'arm_4: overload, expected safe')
    scorer.expect('a wrong verdict, and a missing row', 1, as_csv(
        [{**rows['arm_5'], 'verdict': 'safe'}]), 'arm_5: safe, expected overload')
    scorer.expect('undecided', 0, changed('arm_4', verdict='undecided'))
    scorer.expect('within the tolerance', 0, changed('arm_4', load_ratio_max=ratio + 1e-4))
    scorer.expect('beyond the tolerance', 2, changed('arm_4', load_ratio_max=ratio + 2e-4),
                  '1.22 times the tolerance off')
    scorer.expect('beyond a stricter one', 2, changed('arm_4', load_ratio_max=ratio + 1e-4),
                  'arm_4: load_ratio_max', '--tolerance', '0.1')
    scorer.expect('another connection', 2, changed('arm_4', at='(1,0,0)-(2,0,0)'), 'arm_4: at')
    scorer.expect('below a proved interval', 2, changed('posts_0.99995', load_ratio_max=0.9997),
                  'posts_0.99995: load_ratio_max')
    scorer.expect('a limit where none is', 2, changed('limit_tower', limit_load_factor=3))
    scorer.expect('another step', 2, changed('arm_grows', first_unsafe='2 connect'))
    scorer.expect('a missing row', 3, without('arm_4'))
    scorer.expect('a missing row of another kind', 0, without('arm_4'), '', '--kind', 'towers')
    scorer.expect('no figures', 0, as_csv([{'name': row['name'], 'verdict': row['verdict']}
                                           for row in rows.values()]))


def check_refusals(scorer):
    for what, text, message in (
            ('a name', 'name,verdict\narm_44,safe\n', "line 2: no structure is named 'arm_44': "
             "did you mean 'arm_4'?"),
            ('a verdict', 'name,verdict\narm_4,stable\n', "line 2: the verdict 'stable' is "
             'unknown: write one of safe'),
            ('a number', 'name,verdict,margin_mm\ntower_2,safe,1mm\n', 'expected a number in '
             "margin_mm, found '1mm'"),
            ('nan', 'name,verdict,margin_mm\ntower_2,safe,nan\n', 'leave it empty'),
            ('a column', 'name,verdict,load_ratio\narm_4,safe,1\n',
             "did you mean 'load_ratio_max'"),
            ('twice', 'name,verdict\narm_4,safe\narm_4,safe\n', 'has been answered before'),
            ('a short line', 'name,verdict,at\narm_4,safe\n', 'expected 3 values'),
            ('cells', 'name,verdict,at\narm_4,safe,root\narm_3,safe,1 2\n', 'expected two cells'),
            ('a stage', 'name,verdict,first_unsafe\narm_grows,safe,3\n', "'3 connect'"),
            ('no names', 'verdict\nsafe\n', 'expected name and verdict among the columns'),
            ('nothing', 'name,verdict\n', 'found no answer'),
            ('JSON', '[{"name": "arm_4",]', 'line 1: no JSON'),
            ('no objects', '[3]', 'answer 1: expected an object')):
        scorer.expect(f'refused: {what}', 65, text, message)
    scorer.expect('an option', 64, '', 'unrecognized', '--strict')
    scorer.expect('a kind', 64, '', "did you mean 'arms'?", '--kind', 'arm')
    scorer.expect('a tolerance', 64, '', 'more than 0', '--tolerance', '0')
    scorer.expect('a count', 64, '', 'expected 0 or more', '--worst', '-1')
    scorer.expect('help', 0, '', 'exit status', '--help')


def main():
    root = pathlib.Path(sys.argv[1])
    scorer = Scorer(root)
    rows = perfect_rows(json.loads((root / 'benchmarks/answers.json').read_text())['answers'])
    check_wrong_answers(scorer, rows)
    check_refusals(scorer)
    sys.exit('\n'.join(scorer.faults) or 0)


if __name__ == '__main__':
    main()

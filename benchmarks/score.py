#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Compares somebody's answers with answers.json; README.md explains every field.

examples:
  python3 score.py mine.csv                    right, wrong, undecided and missing by kind
  python3 score.py mine.json --worst 50        and the 50 worst cases instead of 10
  python3 score.py mine.csv --tolerance 0.05   20 times as strict with figures
  python3 score.py - --kind arms < mine.csv    one kind only

exit status:
   0  no verdict and no figure is wrong, and no structure is missing
   1  a verdict is wrong
   2  no verdict is wrong, but a figure is beyond its tolerance
   3  nothing is wrong, but structures are missing
  64  wrong usage
  65  the answers cannot be read
"""
import argparse
import csv
import difflib
import io
import json
import math
import pathlib
import re
import sys

VERDICTS = ('safe', 'overload', 'unstable', 'undecided')
FIGURES = ('load_ratio_max', 'at', 'margin_mm', 'tilt_margin_deg', 'limit_load_factor',
           'first_unsafe')
COLUMNS = ('name', 'verdict', *FIGURES)


class Refused(Exception):
    """What is wrong with the answers, where, and what to do."""


def close_to(word, words):
    near = difflib.get_close_matches(str(word), words, 1)
    return f"did you mean '{near[0]}'?" if near else f'expected one of {", ".join(list(words)[:9])}'


def read_rows(text):
    """(where, row) of every answer, from CSV or JSON."""
    if text.lstrip()[:1] in ('[', '{'):
        try:
            rows = json.loads(text)
        except json.JSONDecodeError as error:
            raise Refused(f'line {error.lineno}: no JSON, {error.msg}: correct it there') from None
        if isinstance(rows, dict):
            rows = [{**row, 'name': name} if isinstance(row, dict) else row
                    for name, row in rows.items()]
        for number, row in enumerate(rows, 1):
            if not isinstance(row, dict):
                raise Refused(f'answer {number}: expected an object with the keys name and '
                              f'verdict, found {json.dumps(row)[:40]}')
            yield f'answer {number}', row
        return
    reader = csv.DictReader(io.StringIO(text))
    for row in reader:
        where = f'line {reader.line_num}'
        if None in row or None in row.values():
            raise Refused(f'{where}: expected {len(reader.fieldnames)} values as in the first '
                          'line: leave a value empty, but keep its comma')
        yield where, {key.strip(): value for key, value in row.items()}


def number(where, key, value):
    """A number, a word that stands for one, or None where nothing is given."""
    text = str(value).strip() if value is not None else ''
    if not text:
        return None
    if key == 'limit_load_factor' and text == 'unbounded':
        return text
    try:
        found = float(text)
    except ValueError:
        found = math.nan
    if not math.isfinite(found):
        raise Refused(f"{where}: expected a number in {key}, found '{text}': leave it empty where "
                      'you have none')
    return found


def figure(where, key, value):
    """A figure as answers.json has it."""
    if key == 'at':
        cells = [int(digits) for digits in re.findall(r'-?\d+', str(value or ''))]
        if cells and len(cells) != 6:
            raise Refused(f"{where}: expected two cells in at, as (2,1,2)-(3,1,2), found '{value}'")
        return sorted((tuple(cells[:3]), tuple(cells[3:]))) if cells else None
    if key == 'first_unsafe':
        text = str(value or '').strip()
        if text and not re.fullmatch(r'none|\d+ (release|shift|connect)', text):
            raise Refused(f"{where}: expected none, or a step and its stage as in '3 connect', in "
                          f"first_unsafe, found '{text}'")
        return text or None
    return number(where, key, value)


def read_answers(text, known):
    """Name -> answer."""
    given = {}
    for where, row in read_rows(text):
        for key in row:
            if key not in COLUMNS:
                raise Refused(f"{where}: the column '{key}' is unknown: "
                              f'{close_to(key, COLUMNS)}')
        if not {'name', 'verdict'} <= row.keys():
            raise Refused(f'{where}: expected name and verdict among the columns, found '
                          f'{", ".join(row)}: the first line of a CSV names its columns')
        name = str(row.get('name', '')).strip()
        if name not in known:
            raise Refused(f"{where}: no structure is named '{name}': {close_to(name, known)}")
        if name in given:
            raise Refused(f"{where}: '{name}' has been answered before: keep one of both")
        verdict = str(row.get('verdict', '')).strip()
        if verdict not in VERDICTS:
            raise Refused(f"{where}: the verdict '{verdict}' is unknown: write one of "
                          f'{", ".join(VERDICTS)}')
        given[name] = {key: figure(where, key, row.get(key)) for key in FIGURES}
        given[name]['verdict'] = verdict
    if not given:
        raise Refused('line 1: expected a line of column names and one line for each structure, '
                      'found no answer')
    return given


def excess(key, expected, found, tolerances):
    """By how many tolerances a figure is off; up to 1 is right."""
    if key == 'at':
        pairs = [sorted(map(tuple, pair)) for pair in expected]
        return 0 if found in pairs else math.inf
    if isinstance(expected, str) or isinstance(found, str):
        return 0 if expected == found else math.inf
    if key == 'load_ratio_max':
        found = max(found, 0)
    span = expected if isinstance(expected, dict) else {'low': expected, 'high': expected}
    allowed = tolerances[key]['absolute'] + tolerances[key]['relative'] * abs(span['high'])
    return max(span['low'] - found, found - span['high'], 0) / allowed


def compare(answers, given, tolerances):
    """Counts by kind, and (excess, what is wrong) of every wrong verdict and figure."""
    counts, wrongs = {}, []
    for answer in answers:
        count = counts.setdefault(answer['kind'], dict.fromkeys(
            ('structures', 'right', 'wrong', 'undecided', 'missing', 'figures', 'beyond',
             'not given'), 0))
        count['structures'] += 1
        found = given.get(answer['name'])
        verdict = found['verdict'] if found else 'missing'
        is_right = verdict in answer['verdict']
        word = 'right' if is_right else verdict if verdict in ('undecided', 'missing') else 'wrong'
        count[word] += 1
        if word == 'wrong':
            wrongs.append((math.inf, 1, f'{answer["name"]}: {verdict}, expected '
                                        f'{" or ".join(answer["verdict"])}'))
        for key in FIGURES if found else ():
            if key not in answer:
                continue
            if found[key] is None:
                count['not given'] += 1
                continue
            off = excess(key, answer[key], found[key], tolerances)
            count['figures' if off <= 1 else 'beyond'] += 1
            if off > 1:
                by = '' if math.isinf(off) else f', {off:.3g} times the tolerance off'
                wrongs.append((off, 0, f'{answer["name"]}: {key} {shown(found[key])}, expected '
                                       f'{shown(answer[key])}{by}'))
    return counts, sorted(wrongs, key=lambda one: (-one[1], -one[0], one[2]))


def shown(value):
    if isinstance(value, dict):
        return f'{value["low"]} to {value["high"]}'
    return f'{value:.9g}' if isinstance(value, float) else json.dumps(value)


def print_table(counts):
    total = {key: sum(count[key] for count in counts.values())
             for key in next(iter(counts.values()))}
    print(f'{"":20}         verdicts                            figures')
    print(f'{"kind":20} {"all":>6} {"right":>6} {"wrong":>6} {"undecided":>9} {"missing":>8}'
          f' {"right":>8} {"wrong":>6} {"not given":>10}')
    for kind, count in [*counts.items(), ('total', total)]:
        print('{:20} {:6} {:6} {:6} {:9} {:8} {:8} {:6} {:10}'.format(kind, *count.values()))
    return total


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(64, f'score.py: {message}; score.py --help says more\n')


def parse_arguments():
    parser = Parser(prog='score.py', description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('answers', help='CSV or JSON with the answers; - is standard input')
    parser.add_argument('--kind', help='score this kind of structures only')
    parser.add_argument('--worst', type=int, default=10, metavar='N',
                        help='list so many of the wrong verdicts and figures (default: 10)')
    parser.add_argument('--tolerance', type=float, default=1.0, metavar='FACTOR',
                        help='multiply all tolerances (default: 1)')
    arguments = parser.parse_args()
    if not arguments.tolerance > 0:
        parser.error(f'argument --tolerance: expected more than 0, found {arguments.tolerance:g}')
    if arguments.worst < 0:
        parser.error(f'argument --worst: expected 0 or more, found {arguments.worst}')
    return parser, arguments


def main():
    parser, arguments = parse_arguments()
    book = json.loads(pathlib.Path(__file__).with_name('answers.json').read_text())
    answers = book['answers']
    kinds = dict.fromkeys(answer['kind'] for answer in answers)
    if arguments.kind is not None and arguments.kind not in kinds:
        parser.error(f"argument --kind: '{arguments.kind}' is unknown: "
                     f'{close_to(arguments.kind, kinds)}')
    try:
        data = (sys.stdin.buffer.read() if arguments.answers == '-'
                else pathlib.Path(arguments.answers).read_bytes())
        known = {answer['name']: answer for answer in answers}
        given = read_answers(data.decode('utf-8-sig'), known)
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, 'strerror', None) or 'it is not UTF-8'
        print(f'score.py: {arguments.answers}: {reason}: name a CSV or JSON file', file=sys.stderr)
        return 65
    except Refused as refused:
        print(f'score.py: {arguments.answers}: {refused}', file=sys.stderr)
        return 65
    tolerances = {key: {kind: arguments.tolerance * value for kind, value in both.items()}
                  for key, both in book['tolerances'].items()}
    counts, wrongs = compare([answer for answer in answers
                              if arguments.kind in (None, answer['kind'])], given, tolerances)
    total = print_table(counts)
    for _, _, text in wrongs[:arguments.worst]:
        print(f'  {text}')
    if len(wrongs) > arguments.worst:
        print(f'  ... and {len(wrongs) - arguments.worst} more; --worst {len(wrongs)} lists all')
    return 1 if total['wrong'] else 2 if total['beyond'] else 3 if total['missing'] else 0


if __name__ == '__main__':
    sys.exit(main())

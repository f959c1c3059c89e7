#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""make.py HOLDFAST CHECKER [--check]   writes structures/ and answers.json

Structures and answers come from scenarios/, from tests/reference/, which other programs computed,
and from families.py, by closed forms and the solver of frame.py. The program HOLDFAST is only used
to write certificates, whose intervals CHECKER (holdfast-checker) proves. With --check nothing is
written, and what differs is named.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # Nothing is to appear beside the sources.
import families
from frame import Frame

HERE = pathlib.Path(__file__).resolve().parent.parent
ROOT = HERE.parent
TOLERANCES = {'load_ratio_max': {'absolute': 1e-4, 'relative': 1e-4},
              'margin_mm': {'absolute': 1e-3, 'relative': 1e-4},
              'tilt_margin_deg': {'absolute': 1e-2, 'relative': 1e-4},
              'limit_load_factor': {'absolute': 0.0, 'relative': 1e-4}}
SECOND_METHOD_MODULES_MAX = 30  # A dense solution of more takes seconds.
HEAD = ('format', 'version', 'name', 'description', 'lattice', 'support_z')
book = {}


def put(structure, kind, verdict, sources, because, *, question='check', **figures):
    """One structure with its answer; figures that are None are not known."""
    name = structure['name']
    assert name not in book, name
    verdicts = verdict if isinstance(verdict, list) else [verdict]
    figures = {key: round(value, 9) if isinstance(value, float) else value
               for key, value in figures.items() if value is not None}
    answer = {'name': name, 'kind': kind, 'question': question, 'verdict': verdicts, **figures,
              'source': sources, **({'because': because} if because else {})}
    head = {key: structure[key] for key in HEAD if key in structure}
    rest = {key: value for key, value in structure.items()
            if key not in HEAD and key != 'known_answer'}
    book[name] = (answer, {**head, **rest})


def worst(ratios):
    """The largest load ratio, 0 if nothing is pulled, and the connections that have it."""
    largest = max([ratio for ratio, _, _ in ratios], default=0)
    if largest < 1e-6:
        return 0.0, None
    return largest, [[a, b] for ratio, a, b in ratios if ratio > largest * (1 - 1e-6)]


def read_references():
    """What tests/reference/README.md describes, one object a structure."""
    lines = (ROOT / 'tests/reference/structures.txt').read_text().splitlines()
    found = []
    while lines:
        _, name, existing, _, count, settled, stable, tie, margin = lines.pop(0).split()
        cells = [[int(k) for k in cell.split(',')] for cell in lines.pop(0).split()]
        rows = [lines.pop(0).split() for _ in range(int(count))]
        ratios = [(float(row[2]), cells[int(row[0])], cells[int(row[1])]) for row in rows]
        found.append({'name': name, 'cells': cells, 'existing': int(existing), 'ratios': ratios,
                      'is_settled': settled == '1', 'is_stable': stable == '1',
                      'is_tie': tie == '1', 'margin': float(margin)})
    return found


def put_scenarios(references):
    """The paper's six tests, whose verdicts it gives, and those of other modules and supports."""
    by_cells = {frozenset(map(tuple, one['cells'])): one for one in references}
    for path in sorted((ROOT / 'scenarios').glob('*.json')):
        structure = json.loads(path.read_text())
        known = structure['known_answer']
        cells = frozenset(map(tuple, structure['modules'] + structure.get('planned', [])))
        is_loaded = 'load_ratio_max' in known and cells in by_cells
        sources = ['paper', 'independent computation']
        if is_loaded:
            assert abs(Frame(structure).answer()[0] - known['load_ratio_max']) < 1e-6
            sources.append('second method')
        put(structure, 'paper', known['verdict'], sources, '', margin_mm=known.get('margin_mm'),
            load_ratio_max=known.get('load_ratio_max'),
            at=worst(by_cells[cells]['ratios'])[1] if is_loaded else None)
    put(json.loads((ROOT / 'scenarios/plan/walk_over_beam.json').read_text()) |
        {'name': 'walk_over_beam'}, 'planned steps', 'safe', ['closed form'],
        'below the beam 15 W / vertical strength at most', question='steps', first_unsafe='none')
    kinds = {'catoms_under_ceiling': 'other lattices', 'prism_wall': 'other lattices',
             'tower_on_slope': 'friction', 'slides_off_slope': 'friction',
             'over_a_step': 'obstacles', 'shelf_with_payload': 'payloads',
             'battery_on_wall': 'kinds and masses'}
    for path in sorted((ROOT / 'scenarios/general').glob('*.json')):
        structure = json.loads(path.read_text())
        known = structure['known_answer']
        put(structure, kinds[structure['name']], known['verdict'], ['closed form'],
            known['source'].removeprefix('statics: '), load_ratio_max=known.get('load_ratio_max'),
            margin_mm=known.get('margin_mm'))


def put_random_cubes(references):
    """Of 200 random cubes: ties, the nearest to toppling and to breaking, the most loaded."""
    random = [one for one in references if one['name'].startswith('random') and one['is_settled']
              and one['ratios']]
    ties = [one for one in random if one['is_tie']]
    rest = [one for one in random if not one['is_tie']]
    stable = [one for one in rest if one['margin'] > 0]
    chosen = ties[:2]
    for order in (sorted(stable, key=lambda one: abs(math.log(max(worst(one['ratios'])[0], 1e-3)))),
                  sorted(stable, key=lambda one: -worst(one['ratios'])[0]),
                  sorted(stable, key=lambda one: one['margin']),
                  sorted(rest, key=lambda one: one['margin'] > 0 or -one['margin']),
                  sorted(rest, key=lambda one: -len(one['cells']))):
        chosen += [one for one in order if one not in chosen][:5]
    for one in chosen:
        ratio, at = worst(one['ratios'])
        structure = {'format': 'holdfast-structure', 'version': 1,
                     'name': 'cubes_' + one['name'].removeprefix('random-').replace('-', '_'),
                     'support_z': 0, 'modules': one['cells'][:one['existing']]}
        if one['existing'] < len(one['cells']):
            structure['planned'] = one['cells'][one['existing']:]
        holds = 'safe' if ratio < 1 else 'overload'
        if one['is_tie']:
            put(structure, 'ties and undecided', ['unstable', holds], ['independent computation'],
                'the margin is exactly 0', margin_mm=0.0)
        elif one['margin'] < 0:
            put(structure, 'random cubes', 'unstable', ['independent computation'], '',
                margin_mm=one['margin'])
        else:
            sources = ['independent computation']
            if len(one['cells']) <= SECOND_METHOD_MODULES_MAX:
                assert abs(Frame(structure).answer()[0] - ratio) < 1e-6, structure['name']
                sources.append('second method')
            put(structure, 'random cubes', holds, sources, '', margin_mm=one['margin'],
                load_ratio_max=ratio, at=at)


def put_general():
    """Of 100 random robots of all lattices: those whose answers all agree, up to ten a kind."""
    counts = {}
    for line in (ROOT / 'tests/reference/general.jsonl').read_text().splitlines():
        one = json.loads(line)
        structure, expected = one['structure'], one['expected']
        is_stable = expected['stable']
        if not expected['settled'] or is_stable != expected['holds_no_slip']:
            continue
        lattice = structure['lattice']
        kind = 'random, any support' if lattice == 'cubic' else f'random, {lattice}'
        counts[kind, is_stable] = counts.get((kind, is_stable), 0) + 1
        if counts[kind, is_stable] > (8 if is_stable else 2):
            continue
        ratio, at = worst([(link['load_ratio'], link['a'], link['b'])
                           for link in expected['connections']])
        if is_stable:
            assert abs(Frame(structure).answer()[0] - ratio) < 1e-6, structure['name']
        holds = 'safe' if ratio < 1 else 'overload'
        put({**structure, 'name': structure['name'].replace('-', '_')}, kind,
            holds if is_stable else 'unstable',
            ['independent computation', 'second method'][:1 + is_stable], '',
            load_ratio_max=ratio if is_stable else None, at=at if is_stable else None)


def put_proved(holdfast, checker):
    """Robots that earlier versions got wrong, by the interval that the checker proves."""
    for path in sorted((ROOT / 'tests/reference/near_limit').glob('*.json')):
        if path.stem == 'spiral':
            continue  # It has several solutions, and a proof is of one.
        structure = json.loads(path.read_text())
        with tempfile.TemporaryDirectory() as folder:
            certificate = f'{folder}/certificate'
            subprocess.run([holdfast, 'check', str(path), '--quiet', '--certificate', certificate],
                           check=False, capture_output=True)
            text = subprocess.run([checker, certificate], check=False, capture_output=True,
                                  text=True).stdout
        low, high, verdict = re.search(r'lies between (\S+) and (\S+)\n +verdict +(\w+)',
                                       text).groups()
        # Outwards, so that the last digits of a certificate do not show.
        interval = {'low': math.floor(float(low) * 1e9) / 1e9,
                    'high': math.ceil(float(high) * 1e9) / 1e9}
        put({**structure, 'name': path.stem}, 'near the limit', verdict.lower(),
            ['proved interval'], 'one solution of Eqs. (9)-(12), by holdfast-checker',
            load_ratio_max=interval)


def put_undecided():
    """Where Eqs. (9)-(12) have several solutions, or one that the exact law contradicts."""
    structure = json.loads((HERE / 'make/several_solutions.json').read_text())
    frame = Frame(structure)
    start = list(frame.equilibrium()[1])
    start[14] = None  # A facet that tilts; where it begins off, Newton's method ends elsewhere.
    low, high = frame.answer()[0], frame.answer(start)[0]
    assert low < 1 < high
    put(structure, 'ties and undecided', ['undecided', 'overload'], ['second method'],
        'Eqs. (9)-(12) have solutions with both ends of the interval; one holds, one breaks',
        load_ratio_max={'low': round(low, 9), 'high': round(high, 9)})
    structure = {'format': 'holdfast-structure', 'version': 2, 'name': 'foot_and_wall',
                 'support_z': None, 'modules': [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
                 'obstacles': [{'cells': [[0, 0, -1], [1, -1, 0]]}]}
    put(structure, 'ties and undecided', ['undecided', 'unstable'], ['second method'],
        'the one consistent set of contact states falls (tools/contact_states.py); the exact law '
        'has forces that hold')


def put_families():
    for one in families.all_families():
        structure = {'format': 'holdfast-structure', 'version': 2, 'name': one['name'],
                     **one['structure']}
        figures, verdict, sources = dict(one['figures']), one['verdict'], [one['source']]
        if one['question'] == 'check' and verdict != 'unstable' and not isinstance(verdict, list):
            frame = Frame(structure)
            assert frame.is_held(), one['name']
            ratio, at = frame.answer()
            formula = figures.get('load_ratio_max', ratio)
            assert abs(formula - ratio) < 1e-9, (one['name'], formula, ratio)
            if frame.pairs:
                figures |= {'load_ratio_max': ratio, 'at': at}
            else:
                figures.pop('load_ratio_max', None)
            if frame.is_on_level_floor():
                margin = frame.margin_mm()
                assert abs(figures.setdefault('margin_mm', margin) - margin) < 1e-9, one['name']
            verdict = verdict or families.by_ratio(ratio)
            assert verdict == families.by_ratio(ratio), one['name']
            sources = list(dict.fromkeys([*sources, 'second method']))
        put(structure, one['kind'], verdict, sources, one['formula'], question=one['question'],
            **figures)


def wrapped(value, indent):
    """JSON on lines of up to 100 columns; what does not fit is divided between its items."""
    text = json.dumps(value)
    if len(text) + indent <= 98 or not isinstance(value, (list, dict)):
        return text
    pad = ' ' * (indent + 2)
    if isinstance(value, dict):
        items = [f'{json.dumps(key)}: {wrapped(item, indent + 2)}' for key, item in value.items()]
        return '{\n' + ',\n'.join(pad + item for item in items) + '\n' + ' ' * indent + '}'
    lines = ['']
    for item in value:
        one = wrapped(item, indent + 2)
        if lines[-1] and len(lines[-1]) + len(one) + indent + 5 > 100:
            lines.append('')
        lines[-1] += (', ' if lines[-1] else '') + one
    return '[\n' + ',\n'.join(pad + line for line in lines) + '\n' + ' ' * indent + ']'


def documents():
    """Path -> text of all that is made."""
    kinds = list(dict.fromkeys(answer['kind'] for answer, _ in book.values()))
    answers = sorted((answer for answer, _ in book.values()),
                     key=lambda answer: (kinds.index(answer['kind']), answer['name']))
    files = {HERE / 'structures' / f'{name}.json': wrapped(structure, 0) + '\n'
             for name, (_, structure) in book.items()}
    lines = ',\n'.join('  ' + json.dumps(answer) for answer in answers)
    files[HERE / 'answers.json'] = (
        '{"format": "holdfast-benchmarks", "version": 1,\n "tolerances": '
        f'{wrapped(TOLERANCES, 1)},\n "answers": [\n{lines}\n]}}\n')
    return files


def main():
    if len(sys.argv) not in (3, 4) or (len(sys.argv) == 4 and sys.argv[3] != '--check'):
        sys.exit(__doc__)
    references = read_references()
    put_scenarios(references)
    put_families()
    put_random_cubes(references)
    put_general()
    put_proved(*sys.argv[1:3])
    put_undecided()
    files = documents()
    there = {*(HERE / 'structures').glob('*.json'), HERE / 'answers.json'}
    if len(sys.argv) == 4:
        differing = sorted(path.name for path in there | files.keys()
                           if path not in files or not path.exists() or
                           path.read_text() != files[path])
        if differing:
            sys.exit('make.py: write these anew, without --check: ' + ', '.join(differing))
        return
    (HERE / 'structures').mkdir(exist_ok=True)
    for path in there - files.keys():
        path.unlink(missing_ok=True)
    for path, text in files.items():
        path.write_text(text)


if __name__ == '__main__':
    main()

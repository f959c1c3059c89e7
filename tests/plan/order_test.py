#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""order_test.py HOLDFAST REPOSITORY   orders as users seek them.

- the shapes of scenarios/plan have the answers of their table; `holdfast steps` finds every order
  that is found safe, forwards and backwards
- certificates are replayed by a second program, this one: geometry written anew, and what lies just
  beyond the cut checked file by file with `holdfast check`; with a state taken out they fail
- modules keep kind, mass and load of their own in the steps that attach them
- bad input is one clear line
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

faults = []


def expect(is_so, message):
    if not is_so:
        faults.append(message)


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def table(repository):
    """(name, options) -> result, as scenarios/plan/README.md has it."""
    text = (repository / 'scenarios/plan/README.md').read_text()
    rows = re.findall(r'^\| `(\w+)` \| `?([^|`]*?)`? \| (found|none) \|', text, re.M)
    return [(name, options.split(), result) for name, options, result in rows]


def neighbours(cell):
    x, y, z = cell
    return [(x + 1, y, z), (x - 1, y, z), (x, y + 1, z), (x, y - 1, z), (x, y, z + 1),
            (x, y, z - 1)]


def is_connected(cells):
    cells = set(cells)
    seen = {next(iter(cells))}
    queue = list(seen)
    while queue:
        for other in neighbours(queue.pop()):
            if other in cells and other not in seen:
                seen.add(other)
                queue.append(other)
    return seen == cells


def steps_from(state, cells, is_growing, group):
    """All sets that one step leads to, of cubes that can get anywhere."""
    found, last = set(), {state}
    for _ in range(group):
        grown = set()
        for before in last:
            for cell in cells:
                if is_growing and cell not in before and any(n in before for n in neighbours(cell)):
                    grown.add(before | {cell})
                if not is_growing and cell in before and len(before) > 1:
                    rest = before - {cell}
                    if is_connected(rest) and any(z == 0 for _, _, z in rest):
                        grown.add(rest)
        found |= grown
        last = grown
    return found


def replay(program, certificate, folder):
    """Whether the cut is one: all steps from inside lead inside or to what check finds not safe."""
    target = certificate['target']
    cells = [tuple(cell) for cell in target['modules']]
    states = {frozenset(c for c, bit in zip(cells, text) if bit == '1')
              for text in certificate['states']}
    is_growing = certificate['sense'] == 'attach'
    whole = frozenset(cells)
    start = frozenset(map(tuple, certificate['start']))
    starts = {start} if start else {frozenset([c]) for c in cells if c[2] == 0}
    near, far = (starts, {whole}) if is_growing else ({whole}, starts)
    if states & far:
        return False
    beyond = near - states
    for state in states:
        beyond |= steps_from(state, cells, is_growing, certificate['group']) - states
    files = []
    for i, state in enumerate(beyond):
        structure = {**target, 'modules': [list(cell) for cell in state]}
        structure.pop('known_answer', None)
        files.append(folder / f'beyond_{i}.json')
        files[-1].write_text(json.dumps(structure))
    if not files:
        return True
    checked = json.loads(run(program, 'check', *files, '--json', '-').stdout)
    entries = checked if isinstance(checked, list) else [checked]
    return len(entries) == len(files) and all(e['verdict'] != 'safe' for e in entries)


def check_found(program, file, options, folder):
    for way in ([], ['--reverse']):
        steps = folder / 'steps.json'
        run(program, 'order', file, *options, *way, '-q', '-o', steps)
        judged = run(program, 'steps', steps, '--quiet')
        expect(judged.returncode == 0, f'{file.name} {way}: steps says {judged.returncode} '
               f'{judged.stderr}')
    one, two = (run(program, 'order', file, *options, '--threads', n, '-q', '-o', '-').stdout
                for n in (1, 3))
    expect(one == two, f'{file.name}: the order depends on the number of threads')


def check_none(program, file, options, folder):
    path = folder / 'certificate.json'
    run(program, 'order', file, *options, '-q', '--help-seconds', 0, '--certificate', path)
    certificate = json.loads(path.read_text())
    verified = run(program, 'steps', '--verify', path)
    expect(verified.returncode == 0, f'{file.name}: {verified.stderr}')
    expect(replay(program, certificate, folder), f'{file.name}: the cut is none')
    if certificate['states']:
        certificate['states'].pop(0)
        path.write_text(json.dumps(certificate))
        expect(run(program, 'steps', '--verify', path).returncode == 65,
               f'{file.name}: a state is missing and nobody sees it')
        expect(not replay(program, certificate, folder), f'{file.name}: the replay sees nothing')


def check_special(program, folder):
    """In the file of the order every module is what it is in the target, whose check says so."""
    target = {'format': 'holdfast-structure', 'version': 2, 'kinds': {'heavy': {'mass_kg': 0.1}},
              'modules': [[0, 0, 0], {'cell': [0, 0, 1], 'kind': 'heavy'},
                          {'cell': [1, 0, 1], 'mass_kg': 0.02}, [0, 0, 2]],
              'loads': [{'cell': [1, 0, 1], 'force_n': [0, 0, -0.1]}]}
    file, steps, end = (folder / name for name in ('special.json', 'steps.json', 'end.json'))
    file.write_text(json.dumps(target))
    done = run(program, 'order', file, '-q', '-o', steps)
    expect(done.returncode == 0, f'special modules: {done.returncode} {done.stderr}')
    judged = json.loads(run(program, 'steps', steps, '--json', '-').stdout)
    expect(judged['verdict'] == 'safe', f'special modules: {judged["verdict"]}')
    document = json.loads(steps.read_text())
    coming = [document.pop('planned', [])] + document.pop('later_steps', [])
    document['modules'] += [module for step in coming for module in step]
    end.write_text(json.dumps(document))
    ratios = []
    for one in (file, end):
        report = json.loads(run(program, 'check', one, '--json', '-').stdout)
        ratios.append(report['overload']['load_ratio_max'])
    last = judged['steps'][-1]['stages']['connect']['load_ratio_max']
    expect(max(ratios + [last]) - min(ratios + [last]) < 1e-9,
           f'special modules: load ratios {ratios}, {last}')


def check_words(program, repository, folder):
    """What is proved of which robot, what arrives together, and orders of no steps."""
    none = next(name for name, options, result in table(repository)
                if result == 'none' and not options)
    file = repository / f'scenarios/plan/{none}.json'
    structure = json.loads(file.read_text())
    proof, other, one = (folder / name for name in ('proof.json', 'other.json', 'one.json'))
    run(program, 'order', file, '--help-seconds', 0, '--certificate', proof)
    for target, code, words in [
            ([], 0, f'{structure.get("name", none)}, {len(structure["modules"])} modules'),
            ([file], 0, '1 module at a time'),
            ([other], 65, 'another robot')]:
        other.write_text(json.dumps({**structure, 'modules': structure['modules'][:-1]}))
        done = run(program, 'steps', '--verify', proof, *target)
        expect(done.returncode == code and words in done.stdout + done.stderr,
               f'{target}: {done.returncode}, {done.stdout}{done.stderr}')
    other.write_text(json.dumps({**structure, 'material': {'elastic_modulus_mpa': 17}}))
    done = run(program, 'steps', '--verify', proof, other)
    expect(done.returncode == 65 and 'they differ in material' in done.stderr, done.stderr)
    expect(run(program, 'steps', file, other).returncode == 64, 'TARGET without --verify')

    one.write_text(json.dumps({'format': 'holdfast-structure', 'version': 1,
                               'modules': [[0, 0, 0]]}))
    steps = folder / 'no_steps.json'
    done = run(program, 'order', one, '-o', steps)
    expect('FOUND       0 steps' in done.stdout, f'no steps: {done.stdout}')
    expect(not steps.exists() and 'not written, as there are no steps' in done.stderr,
           f'an order of no steps is written: {done.stderr}')

    done = run(program, 'order', repository / 'scenarios/plan/pair.json', '--group', 2)
    expect('have to arrive at the same instant' in done.stdout and '-o STEPS.json' in done.stdout,
           f'--group 2: {done.stdout}')
    arms = re.search(r'attach .*?(\([^)]*\) \([^)]*\))', done.stdout)
    expect(arms is not None, f'the order is not told: {done.stdout}')


def check_bad_input(program, repository, folder):
    balance = repository / 'scenarios/plan/balance.json'
    cube = repository / 'scenarios/plan/core.json'
    cases = [
        (65, 'the target has none', [balance, '--from', cube]),
        (65, 'not safe', [cube, '--from', folder / 'arm.json']),
        (65, 'is taken by a module of the start',
         [balance, '--from', folder / 'foot.json', '--reach', 'surface', '--source', '0,0,0']),
        (65, 'lies in an obstacle or below the floor',
         [cube, '--reach', 'surface', '--source', '0,0,-1']),
        (64, 'named for two files', ['-', '--from', '-']),
        (64, '--reach surface requires --source', [balance, '--reach', 'surface']),
        (64, '--source requires --reach surface', [balance, '--source', '0,0,0']),
        (64, 'expected a cell', [balance, '--reach', 'surface', '--source', '1,2']),
        (64, '--seconds', [balance, '--seconds', 'soon']),
        (64, '--seed', [balance, '--seed', 'x']),
        (64, '--seed', [balance, '--seed', '-1']),
        (64, '--group', [balance, '--group', '0']),
        (64, '--reach', [balance, '--reach', 'air']),
        (65, 'nothing.json', [folder / 'nothing.json']),
        (65, 'has steps of its own', [repository / 'scenarios/plan/walk_over_beam.json']),
    ]
    frame = json.loads(cube.read_text())
    # A row of three on the edge of a cube's layer hangs over nothing: it topples.
    (folder / 'arm.json').write_text(json.dumps(
        {**frame, 'modules': [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]]}))
    (folder / 'foot.json').write_text(json.dumps({**frame, 'modules': [[0, 0, 0]]}))
    (folder / 'heavy.json').write_text(json.dumps(
        {**frame, 'version': 2, 'modules': [{'cell': [0, 0, 0], 'mass_kg': 5, 'fixed': True}]}))
    done = run(program, 'order', cube, '--from', folder / 'heavy.json')
    expect('differs in what is fixed, masses\n' in done.stderr, f'start: {done.stderr}')
    # The start is to blame, by its file.
    for start in ('arm', 'foot'):
        done = run(program, 'order', balance if start == 'foot' else cube, '--from',
                   folder / f'{start}.json')
        expect(done.returncode != 65 or f'{start}.json: ' in done.stderr, f'blamed: {done.stderr}')
    for code, words, arguments in cases:
        done = run(program, 'order', *arguments)
        expect(done.returncode == code and words in done.stderr,
               f'{arguments[1:]}: {done.returncode}, {done.stderr}')


def main():
    program, repository = sys.argv[1], pathlib.Path(sys.argv[2])
    rows = table(repository)
    expect(len(rows) >= 6, 'scenarios/plan/README.md has no table')
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scenario, options, result in rows:
            file = repository / f'scenarios/plan/{scenario}.json'
            done = run(program, 'order', file, *options, '--help-seconds', 0, '--json', '-')
            report = json.loads(done.stdout)
            expect(report['result'] == result, f'{scenario} {options}: {report["result"]}')
            expect(done.returncode == (0 if result == 'found' else 1), f'{scenario}: exit code')
            (check_found if result == 'found' else check_none)(program, file, options, folder)
        check_special(program, folder)
        check_words(program, repository, folder)
        check_bad_input(program, repository, folder)
    print('\n'.join(faults) if faults else f'order: {len(rows)} rows, no fault')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())

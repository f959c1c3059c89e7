#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""instrument_test.py HOLDFAST MODULE STRUCTURE   listen, tell and twin, at robots of processes.

MODULE is examples/module/on_terminals.c, one process for each module, joined by pseudo-terminals;
one free face of each module has a pseudo-terminal of its own, at which the instrument is. What it
says is compared with the exact answer of 'holdfast check', and with what was told.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from joined_terminals import DIRECTIONS, joined

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from schemas_test import Schemas, places_of  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE_S = 60

faults = []
schemas = Schemas(ROOT / 'docs/schemas')
places = set()


def expect(is_so, what):
    if not is_so:
        faults.append(what)
        print(f'FAULT: {what}', flush=True)


def all_keys_occur():
    """Every key of the two schemas, but for those that only a busy or mixed robot has."""
    seldom = {f'listen.schema.json#/properties/{key}' for key in ('wire_version', 'count', 'face')}
    for schema in ('listen.schema.json', 'twin.schema.json'):
        for place in places_of(schema, schemas.file(schema)):
            expect(place in places or place in seldom, f'occurs in no report: {place}')


def checked(schema, text):
    """A report, or a line of one, that must be as its schema says."""
    value = json.loads(text)
    found = schemas.check(schema + '#', value)
    places.update(found.places)
    expect(not found.faults, f'{schema}: {found.faults[:3]}')
    return value


def heard_as_json(holdfast, device, *options):
    """What listen says, line by line."""
    text = holdfast('listen', device, '--json', *options)[1]
    return [checked('listen.schema.json', line) for line in text.splitlines()
            if line.startswith('{')]


def is_status(lines, cell, verdict):
    status, = lines
    return (status['event'] == 'status' and status['verdict'] == verdict and
            status['cell'] == list(cell) and status['anchor'] and len(status['neighbours']) == 1)


def is_same_as_twin(holdfast, count, arguments):
    report = checked('twin.schema.json', holdfast('twin', *arguments, '--json', '-')[1])
    return len(report['modules']) == count and not report['differences'] and all(
        row['table'] == row['twin'] for module in report['modules']
        for row in module['compared'] if row['what'] == 'verdict')


def is_heard(holdfast, device, event, cell):
    """Told again, as a module remembers 16 things, and listened to."""
    words = cell if cell == 'all' else ','.join(map(str, cell))
    holdfast('tell', device, event, words)
    of = cell if cell == 'all' else list(cell)
    return any(line['event'] == event and line['of'] == of
               for line in heard_as_json(holdfast, device, '--time', 0.5))


class Robot:
    """Processes, and by cell the terminal at a free face."""

    def __init__(self, program, cells, pages, extra=None):
        arguments, self.devices = [[] for _ in cells], []
        for i, cell in enumerate(cells):
            free = None
            for face, step in enumerate(DIRECTIONS):
                other = tuple(a + b for a, b in zip(cell, step))
                if other not in cells:
                    free = face if free is None else free
                elif face % 2 == 0:
                    here, there = joined()
                    arguments[i].append(f'{face}={here}')
                    arguments[cells.index(other)].append(f'{face + 1}={there}')
            here, device = joined()
            arguments[i].append(f'{free}={here}')
            self.devices.append(device)
        self.processes = [
            subprocess.Popen([program, pages[i], *arguments[i], *(extra(i) if extra else [])],
                             stdout=subprocess.DEVNULL) for i in range(len(cells))]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()
            process.wait()


class Program:
    """holdfast on the command line."""

    def __init__(self, path):
        self.path = path

    def __call__(self, *arguments):
        done = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True,
                              check=False, timeout=120)
        print(f'$ holdfast {" ".join(map(str, arguments))}   [{done.returncode}]\n{done.stdout}'
              f'{done.stderr}', end='', flush=True)
        return done.returncode, done.stdout + done.stderr

    def exact(self, path):
        return json.loads(self('check', path, '--json', '-')[1])


def of_all(robot, path):
    """Arguments of twin for all modules of a robot."""
    first, *others = robot.devices
    return [first, path, *(word for device in others for word in ('--also', device))]


def eventually(is_so, what):
    """On a machine at work a module may miss its neighbour for a moment, and begins anew."""
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        if time.monotonic() > end:
            expect(False, what)
            return
        time.sleep(0.2)


def listened(holdfast, device, words):
    """Whether somebody who listens for a while hears the words."""
    return words in holdfast('listen', device, '--time', 1.5)[1]


def flashed_pages(holdfast, module, path, cells, planned, folder):
    """Robots of pages that were flashed, as in terminals_test.py."""
    holdfast('emulate', path, '--pages', folder)
    pages = [f'{folder}/module_{i}.bin' for i in range(len(cells))]
    bare = pathlib.Path(folder) / 'bare.json'
    document = json.loads(pathlib.Path(path).read_text())
    bare.write_text(json.dumps({**document, 'planned': []}))
    before, after = holdfast.exact(bare)['verdict'], holdfast.exact(path)['verdict']
    expect(before != after, 'the plan changes the verdict, so that it tells something')
    with Robot(module, cells, pages) as robot:
        eventually(lambda: listened(holdfast, robot.devices[0], f'knows the verdict: {before}'),
                   f'{before} before the plan')
        eventually(lambda: holdfast('twin', *of_all(robot, bare))[0] == 0, 'as its twin')
        eventually(lambda: any(line['event'] == 'verdict' and line['verdict'] == before for line in
                               heard_as_json(holdfast, robot.devices[0], '--time', 1.5)),
                   'the verdict as JSON')
        eventually(lambda: is_status(heard_as_json(holdfast, robot.devices[0], '--once'), cells[0],
                                     before), 'the status as JSON')
        eventually(lambda: is_same_as_twin(holdfast, len(cells), of_all(robot, bare)),
                   'twins as JSON')
        for cell in planned:
            code, text = holdfast('tell', robot.devices[-1], 'plan', ','.join(map(str, cell)))
            expect(code == 0, 'a plan is taken at the last module')
            eventually(lambda cell=cell: is_heard(holdfast, robot.devices[-1], 'plan', cell),
                       'a plan as JSON')
        eventually(lambda: listened(holdfast, robot.devices[0], f'knows the verdict: {after}'),
                   f'{after} with the plan')
        eventually(lambda: holdfast('listen', *robot.devices, '--once')[1].count(
            f'verdict     {after}') == len(cells), 'every module says so')
        eventually(lambda: holdfast('twin', *of_all(robot, path))[0] == 0, 'as the planned twin')
        code, text = holdfast('twin', robot.devices[0], bare)
        expect(code == 1 and 'differs' in text and after in text, 'the plan is a difference')
        expect(holdfast('tell', robot.devices[0], 'withdraw', 'all')[0] == 0, 'withdrawn')
        eventually(lambda: is_heard(holdfast, robot.devices[0], 'withdraw', 'all'),
                   'a withdrawal as JSON')
        eventually(lambda: holdfast('twin', robot.devices[0], bare)[0] == 0, 'as before')
        other = pathlib.Path(folder) / 'other.json'
        other.write_text(json.dumps({**document, 'planned': [], 'modules': [
            *document['modules'], [0, 1, 0]]}))
        code, text = holdfast('twin', robot.devices[0], other)
        expect(code == 1 and 'hears nobody at +y, where its twin has a neighbour' in text,
               'a module that is missing is named')


def bare_boards(holdfast, module, path, cells, folder):
    """Boards without pages: all is told at terminals, and kept over a loss of power."""
    pages = [f'{folder}/board_{i}.bin' for i in range(len(cells))]
    ground = pathlib.Path(folder) / 'ground.json'
    ground.write_text(json.dumps({**json.loads(pathlib.Path(path).read_text()), 'planned': []}))
    verdict = holdfast.exact(ground)['verdict']
    with Robot(module, cells, pages, lambda i: [f'id={i + 50}']) as robot:
        code, text = holdfast('listen', robot.devices[0], '--once')
        expect(code == 2 and 'waits for the robot' in text, 'no numbers, no verdict')
        code, text = holdfast('tell', robot.devices[0], 'plan', '1,2,3')
        expect(code == 65 and 'configure FILE' in text, 'a plan would be forgotten')
        expect(holdfast('tell', robot.devices[-1], 'configure', ground)[0] == 0, 'configured')
        code, text = holdfast('tell', robot.devices[-1], 'configure', ground)
        expect(code == 0 and 'already' in text, 'once is enough')
        expect(holdfast('tell', robot.devices[0], 'anchor', '0,0,0')[0] == 0, 'anchored')
        eventually(lambda: holdfast('twin', *of_all(robot, ground))[0] == 0, 'as the twin')
        eventually(lambda: f'verdict      {verdict}' in
                   holdfast('twin', robot.devices[0], ground)[1], 'and as the exact answer')
        expect(holdfast('tell', robot.devices[0], 'fixed')[0] == 0, 'fixed')
        code, text = holdfast('twin', robot.devices[0], ground)
        expect(code == 1 and 'is held from outside, its twin is not' in text, 'fixed is seen')
        expect(holdfast('tell', robot.devices[0], 'free')[0] == 0, 'free again')
        other = ['--set', 'strength_lateral_n=9']
        code, text = holdfast('twin', robot.devices[0], ground, *other)
        expect(code == 1 and 'other numbers' in text, 'other numbers are seen')
        expect(holdfast('tell', robot.devices[0], 'configure', ground, *other)[0] == 0, 'again')
        eventually(lambda: holdfast('twin', *of_all(robot, ground), *other)[0] == 0,
                   'all have them')
    with Robot(module, cells, pages, lambda i: [f'id={i + 50}']) as robot:
        eventually(lambda: holdfast('twin', *of_all(robot, ground), *other)[0] == 0,
                   'kept without power')


def refusals(holdfast, path):
    """What is wrong is said, and nothing waits for ever."""
    here, device = joined()
    del here
    for arguments, code, words in [
            (['listen', '/dev/null', '--once'], 65, 'no serial device'),
            (['listen', '/no/such/device'], 65, 'cannot be opened'),
            (['listen', device, '--once', '--baud', '12345'], 65, 'unknown rate 12345'),
            (['listen', device, '--once'], 65, 'no answer'),
            (['tell', device, 'plan', '1,2,3'], 65, 'no answer'),
            (['tell', device, 'plan', '1,2'], 64, 'expected X,Y,Z'),
            (['tell', device, 'plan'], 64, 'expected X,Y,Z, found nothing'),
            (['tell', device, 'fixed', '1'], 64, 'expected nothing'),
            (['tell', device, 'stand'], 64, 'stand'),
            (['tell', device, 'configure'], 64, 'expected FILE'),
            (['twin', device], 64, 'FILE'),
            (['twin', device, path, '--time', '1'], 65, 'no answer')]:
        found, text = holdfast(*arguments)
        expect(found == code and words in text, f'{arguments}: {code}, {words}')


def main():
    path_of_holdfast, module, path = sys.argv[1:]
    holdfast = Program(path_of_holdfast)
    document = json.loads(pathlib.Path(path).read_text())
    cells = [tuple(cell) for cell in document['modules']]
    with tempfile.TemporaryDirectory() as folder:
        refusals(holdfast, path)
        flashed_pages(holdfast, module, path, cells, document['planned'], folder)
        bare_boards(holdfast, module, path, cells, folder)
    all_keys_occur()
    print(f'{len(faults)} faults' if faults else 'listen, tell and twin say what is')
    sys.exit(1 if faults else 0)


main()

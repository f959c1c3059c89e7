#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""schemas_test.py HOLDFAST REPOSITORY [IMAGE]
Every JSON report is what its schema in docs/schemas says, and every key of the schemas occurs.

The reports are those of real commands on robots of all kinds. Reports of `emulate` take an IMAGE of
the firmware; without one their keys are not asked for.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# Only faulty neighbours make a robot refuse messages: libs/holdfast/test/refused_test.cpp.
NOT_OF_PROGRAMS = {f'simulate.schema.json#/$defs/distributed/properties/refused{rest}'
                   for rest in ('', *(f'/properties/{key}' for key in (
                       'messages', 'cell', 'messages_of_cell')))}
# Their reports need modules: tests/firmware/conformance_test.py and instrument_test.py.
OF_DEVICES = ('conformance.schema.json', 'listen.schema.json', 'twin.schema.json')
TYPES = {'object': dict, 'array': list, 'string': str, 'boolean': bool, 'null': type(None)}


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_of(name, value):
    if name in ('number', 'integer'):
        return is_number(value) and (name == 'number' or value == int(value))
    return isinstance(value, TYPES[name])


def of(kind, is_met):
    """A rule for values of one kind; others meet it."""
    return lambda value, rule: not kind(value) or is_met(value, rule)


def is_list(value):
    return isinstance(value, list)


def is_object(value):
    return isinstance(value, dict)


def is_text(value):
    return isinstance(value, str)


# Keywords that look at the value alone.
PLAIN = {
    'type': lambda value, rule: any(
        is_of(name, value) for name in (rule if is_list(rule) else [rule])),
    'const': lambda value, rule: value == rule and type(value) is type(rule),
    'enum': lambda value, rule: value in rule,
    'pattern': of(is_text, lambda value, rule: re.search(rule, value)),
    'minLength': of(is_text, lambda value, rule: len(value) >= rule),
    'minimum': of(is_number, lambda value, rule: value >= rule),
    'maximum': of(is_number, lambda value, rule: value <= rule),
    'minItems': of(is_list, lambda value, rule: len(value) >= rule),
    'maxItems': of(is_list, lambda value, rule: len(value) <= rule),
    'minProperties': of(is_object, lambda value, rule: len(value) >= rule),
    'maxProperties': of(is_object, lambda value, rule: len(value) <= rule),
    'required': of(is_object, lambda value, rule: all(key in value for key in rule)),
}
# Keywords that say nothing, or that others look at.
QUIET = {'$schema', '$id', '$defs', 'definitions', 'title', 'description', 'then',
         'patternProperties', 'unevaluatedProperties'}


class Found:
    """What came of one value: its faults, the keys that a schema knows, and the places of these."""

    def __init__(self, faults=()):
        self.faults = list(faults)
        self.known = set()
        self.places = set()

    def add(self, other, is_same_value=True):
        self.faults += other.faults
        self.places |= other.places
        self.known |= other.known if is_same_value else set()


class Schemas:
    """A validator of the keywords of JSON Schema that our schemas use; others are a fault here."""

    def __init__(self, folder):
        self.folder = folder
        self.files = {}

    def file(self, name):
        if name not in self.files:
            self.files[name] = json.loads((self.folder / name).read_text())
        return self.files[name]

    def check(self, place, value, at=''):
        """Looks at a value by the schema at a place, FILE#POINTER."""
        file, _, pointer = place.partition('#')
        rule = self.file(file)
        for part in pointer.split('/')[1:]:
            rule = rule[int(part) if is_list(rule) else part]
        if isinstance(rule, bool):
            return Found([] if rule else [f'{at}: not allowed by {place}'])
        found = Found()
        for keyword, limit in rule.items():
            if keyword in PLAIN:
                if not PLAIN[keyword](value, limit):
                    found.faults.append(f'{at}: {str(value)[:60]} against {keyword} of {place}')
            elif keyword not in QUIET:
                look = getattr(self, 'look_at_' + keyword.strip('$'), None)
                if look is None:
                    raise ValueError(f'{place}: this test does not know {keyword}')
                look(found, rule, place, value, at)
        if rule.get('unevaluatedProperties') is False and is_object(value):
            found.faults += [f'{at}/{key}: not in {place}' for key in value
                             if key not in found.known]
        return found

    def look_at_ref(self, found, rule, place, value, at):
        file, _, pointer = rule['$ref'].partition('#')
        found.add(self.check(f"{file or place.partition('#')[0]}#{pointer}", value, at))

    def look_at_items(self, found, rule, place, value, at):
        for i, one in enumerate(value if is_list(value) else []):
            found.add(self.check(place + '/items', one, f'{at}/{i}'), False)

    def look_at_properties(self, found, rule, place, value, at):
        for key in rule['properties']:
            if is_object(value) and key in value:
                here = f'{place}/properties/{key}'
                found.add(self.check(here, value[key], f'{at}/{key}'), False)
                found.known.add(key)
                found.places.add(here)

    def look_at_additionalProperties(self, found, rule, place, value, at):
        free = rule.get('patternProperties', {})
        for key in value if is_object(value) else ():
            if key not in rule.get('properties', {}) and not any(
                    re.search(pattern, key) for pattern in free):
                found.add(self.check(place + '/additionalProperties', value[key], f'{at}/{key}'),
                          False)
            found.known.add(key)

    def look_at_propertyNames(self, found, rule, place, value, at):
        for key in value if is_object(value) else ():
            found.add(self.check(place + '/propertyNames', key, f'{at}/{key}'), False)

    def look_at_allOf(self, found, rule, place, value, at):
        for i in range(len(rule['allOf'])):
            found.add(self.check(f'{place}/allOf/{i}', value, at))

    def look_at_oneOf(self, found, rule, place, value, at, keyword='oneOf'):
        branches = [self.check(f'{place}/{keyword}/{i}', value, at)
                    for i in range(len(rule[keyword]))]
        good = [branch for branch in branches if not branch.faults]
        for branch in good or [min(branches, key=lambda branch: len(branch.faults))]:
            found.add(branch)
        if keyword == 'oneOf' and len(good) > 1:
            found.faults.append(f'{at}: {len(good)} of oneOf of {place}')

    def look_at_anyOf(self, found, rule, place, value, at):
        self.look_at_oneOf(found, rule, place, value, at, 'anyOf')

    def look_at_not(self, found, rule, place, value, at):
        if not self.check(place + '/not', value, at).faults:
            found.faults.append(f'{at}: against not of {place}')

    def look_at_if(self, found, rule, place, value, at):
        if not self.check(place + '/if', value, at).faults:
            found.add(self.check(place + '/then', value, at))


def places_of(file, rule, place=''):
    """The places of all keys that a schema names."""
    if isinstance(rule, list):
        for i, one in enumerate(rule):
            yield from places_of(file, one, f'{place}/{i}')
    if not isinstance(rule, dict):
        return
    for key in rule:
        here = f'{place}/{key}'
        if key == 'properties':
            for name, one in rule[key].items():
                yield f'{file}#{here}/{name}'
                yield from places_of(file, one, f'{here}/{name}')
        elif key not in ('const', 'enum', 'required'):
            yield from places_of(file, rule[key], here)


def structure(*modules, **members):
    return {'format': 'holdfast-structure', 'version': 2, 'modules': modules, **members}


# Robots beside those of the repository.
ROBOTS = {
    'latched': structure([0, 0, 0], [0, 0, 1], [1, 0, 1], material={'shear_strength_n': 50},
                         steps=[{'attach': [[2, 0, 1]]}]),
    'foot': structure([0, 0, 0]),
    'column': structure([0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4],
                        material={'elastic_modulus_mpa': 0.09}),
    'row': structure([0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]),
    'shifted': structure([1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0]),
    'pieces': structure([0, 0, 0], [0, 0, 1], [5, 0, 0], [5, 0, 1], [6, 0, 1]),
    'leaning': structure([0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]),
    'slab': structure([0, 0, 0], steps=[{'attach': [[number // 17, number % 17, 0]]}
                                        for number in range(1, 17 * 16)]),
    'bricks': structure([0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3],
                        bodies=[[[0, 0, 0], [0, 0, 1]], [[0, 0, 2], [0, 0, 3]]]),
    'grows': structure([0, 0, 0], [0, 0, 1], [1, 0, 0], planned=[[0, 1, 0]],
                       later_steps=[[[1, 1, 0]]], steps=[{'detach': [[1, 1, 0]]}]),
}


def commands(scenarios, tests):
    """The runs whose reports are looked at; NAME.json is a robot of those above."""
    plan = f'{scenarios}/plan'
    general = sorted(str(path) for path in (scenarios / 'general').glob('*.json'))
    safe, breaks, topples = (f'{scenarios}/{name}.json' for name in (
        'arm_breaks_a', 'arm_breaks_b', 'arm_tips_c'))
    yield from (['check', str(path)] for path in sorted(scenarios.glob('*.json')))
    yield from (['check', path, '--limit', '--connections', 'broken'] for path in general)
    yield ['check', safe, 'missing.json', topples]
    yield ['check', safe, '--bonded', '--prove', '--set', 'mass_kg=0.05', '--set', 'pitch_mm=41']
    yield ['check', topples, '--prove', '--limit']
    yield ['check', breaks, '--limit', '--limit-seconds', '0']
    yield from (['check', path, '--deformed'] for path in (safe, topples))
    yield ['check', safe, '--deformed', '--up-to', '1', '--set', 'elastic_modulus_mpa=0.001']
    for modulus in ('0.001', '0.02', '0.15'):  # Too soft, collapses, holds.
        yield ['check', safe, '--deformed', '--follow', '--cascade', '--set',
               f'elastic_modulus_mpa={modulus}']
    yield ['check', 'column.json', '--deformed', '--follow', '--bonded']
    yield ['check', safe, '--lose-one', '--cascade', '--lose', 'connections,modules']
    yield from (['check', path, '--remedies'] for path in (safe, breaks, topples))
    yield from (['check', path, '--scatter', '10%', '--lose-one'] for path in (safe, topples))
    yield ['check', general[0], '--scatter', '5%', '--scatter-common', '3%', '--lose-one']
    yield ['check', safe, '--scatter-mass', '5%']
    yield ['check', 'cube.json', '--lose-one', '--lose-seconds', '0']
    yield ['check', 'bricks.json', '--lose-one', '--lose', 'modules', '--cascade']
    yield ['next', safe, '--set', 'elastic_modulus_mpa=0.05']
    yield from (['check', path, '--cascade'] for path in (safe, topples, general[0]))
    yield from (['check', 'cube.json', '--lose-one', '--lose', part]
                for part in ('modules', 'feet'))
    yield ['check', f'{tests}/physics/two_paths.json']
    yield ['check', 'slender.json', '--connections', '3']
    yield ['check', 'pieces.json']
    yield ['steps', f'{plan}/walk_over_beam.json']
    yield ['steps', 'walk_to_topple.json', '--until-unsafe']
    yield ['steps', 'slab.json']
    yield ['steps', 'grows.json', '--scatter', '10%', '--probability', '0.9', '--lose-one']
    yield from (['next', path] for path in (safe, topples, *general))
    yield ['next', 'large.json']
    yield ['next', safe, '--scatter', '10%', '--probability', '0.9', '--limit', '3']
    yield ['next', safe, '--lose-one', '--lose', 'connections,feet']
    yield ['next', 'cube.json', '--seconds', '0']
    yield ['order', 'cube.json', '--reverse']
    yield ['order', 'cube.json', '--reach', 'line', '--from', 'row.json']
    yield ['order', 'row.json', '--continue', 'row_plan.json', '--at', '1']
    yield ['order', 'cube.json', '--parallel', 'all', '--reverse']
    yield ['order', f'{plan}/pair.json', '--pieces']
    yield ['order', f'{plan}/pair.json', '--parallel', '3']
    yield ['order', f'{plan}/pair.json', '--strength-needed', '--scatter', '10%', '--lose-one']
    yield ['order', 'row.json', '--scatter', '10%', '--lose-one', '--safety-factor', '1.5']
    yield from (['order', f'{plan}/{name}.json'] for name in ('crane_near_limit', 'pair', 'arch'))
    yield ['order', f'{plan}/core.json', '--reach', 'surface', '--source', '3,0,0', '--group', '2']
    yield ['order', 'row.json', '--reach', 'surface', '--source', '-1,0,0', '--from', 'foot.json',
           '--avoid', '-1,0,1:0,0,1', '--avoid', '0,1,0', '--avoid', '0,-1,0']
    yield ['move', f'{plan}/around_arm_from.json', f'{plan}/around_arm_to.json', '--pivot']
    yield ['move', 'row.json', 'shifted.json', '--within', '0,0,0:4,0,0']
    yield ['move', 'row.json', 'leaning.json']
    yield ['move', 'row.json', '--continue', 'row_moves.json', '--at', '1']
    yield ['move', 'row.json', 'shifted.json', '--within', '0,0,0:4,0,0', '--keep', '2,0,0',
           '--avoid', '1,0,1']
    yield ['move', 'row.json', 'shifted.json', '--scatter', '50%', '--lose-one', '--lose', 'feet']
    yield from (['simulate', path] for path in (safe, breaks, topples, 'latched.json'))
    yield ['simulate', safe, '--link', 'unit', '--kill', '2,1,1@5', '--plan', '3,1,2@1']
    yield from (['simulate', path, '--next'] for path in (safe, general[0]))
    yield from (['simulate', 'grows.json', way] for way in ('--steps', '--stages'))
    yield ['simulate', 'latched.json', '--stages']
    yield from (['fit', f'{tests.parent}/examples/experiments/{name}.json'] for name in (
        'paper_six_tests', 'paper_and_hanging'))
    yield ['robots']
    yield ['robots', 'rofi']


def streams(plan):
    """Runs whose lines are looked at."""
    yield ['order', 'cube.json', '--parallel', '20']
    yield ['order', 'cube.json', '--reverse', '--seconds', '0']
    yield ['order', 'row.json', '--reverse']
    yield ['order', f'{plan}/pair.json']
    yield ['move', f'{plan}/around_arm_from.json', f'{plan}/around_arm_to.json', '--within',
           '-9,0,-9:9,0,9']


def main(program, repository, image=None):
    schemas = Schemas(repository / 'docs/schemas')
    runs = list(commands(repository / 'scenarios', repository / 'tests'))
    if image:
        runs.append(['emulate', f'{repository}/scenarios/arm_breaks_a.json', '--image', str(image)])
    faults = []
    places = set()
    with tempfile.TemporaryDirectory() as folder:
        def run(*arguments):
            return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)

        def look_at(schema, shown, value):
            nonlocal places, faults
            found = schemas.check(schema, value)
            places |= found.places
            faults += [f'{shown}: {fault}' for fault in found.faults[:3]]

        for name, robot in ROBOTS.items():
            pathlib.Path(folder, name + '.json').write_text(json.dumps(robot))
        run('generate', 'cube', '7', '-o', 'cube.json')
        run('generate', 'tower', '7000', '-o', 'slender.json')
        run('generate', 'cube', '15', '-o', 'large.json')
        run('order', 'row.json', '-o', 'row_plan.json')
        run('move', 'row.json', 'shifted.json', '-o', 'row_moves.json')
        run('move', f'{repository}/scenarios/plan/around_arm_from.json',
            f'{repository}/scenarios/plan/around_arm_to.json', '--geometry-only', '-o',
            'walk_to_topple.json')
        for command in runs:
            done = run(*command, '--json', '-', '-q') if command[0] != 'robots' else run(
                *command, '--json', '-')
            shown = ' '.join(command).replace(f'{repository}/', '')
            if not done.stdout:
                faults.append(f'{shown}: no report: {done.stderr.strip()}')
                continue
            look_at(f'{command[0]}.schema.json#', shown, json.loads(done.stdout))
        for command in streams(repository / 'scenarios/plan'):
            for line in run(*command, '--stream').stdout.splitlines() or ['']:
                look_at('stream.schema.json#', ' '.join(command), json.loads(line or 'null'))
    wanted = {place for path in sorted(schemas.folder.iterdir())
              if (image or path.name != 'emulate.schema.json') and path.name not in OF_DEVICES
              for place in places_of(path.name, schemas.file(path.name))}
    faults += [f'occurs in no report: {place}' for place in sorted(wanted - places)
               if place not in NOT_OF_PROGRAMS]
    faults += [f'occurs after all: {place}' for place in sorted(NOT_OF_PROGRAMS - wanted)]
    print('\n'.join(faults) or f'{len(runs)} reports, {len(places)} keys')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:])))

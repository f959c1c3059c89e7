# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers and texts that are not allowed are refused in one line, whatever takes them."""
import json

import holdfast
import pytest
from holdfast import Robot

ROBOT = Robot([[0, 0, 0], [1, 0, 0]], planned=[[0, 0, 1]])
STEPS = [{'attach': [[0, 0, 1]]}]
HUGE = [2**31, 2**32, 2**64, 10**400, -1, -2**63, -2**64]
NO_NUMBERS = [float('nan'), float('-inf'), 10**400, -1]

CALLS = {
    'threads': lambda given: ROBOT.check(threads=given),
    'threads of many': lambda given: holdfast.check_many([ROBOT], threads=given),
    'threads of next': lambda given: ROBOT.next(threads=given),
    'threads of steps': lambda given: holdfast.steps(ROBOT, STEPS, threads=given),
    'threads of order': lambda given: holdfast.order(ROBOT, threads=given),
    'threads of move': lambda given: holdfast.move(ROBOT, ROBOT, threads=given),
    'group': lambda given: holdfast.order(ROBOT, group=given),
    'parallel': lambda given: holdfast.order(ROBOT, parallel=given),
    'size': lambda given: holdfast.generate('cube', given),
}
SEEDS = {
    'simulate': lambda given: ROBOT.simulate(link='unit', seed=given),
    'order': lambda given: holdfast.order(ROBOT, seed=given),
    'move': lambda given: holdfast.move(ROBOT.planning([]), ROBOT.planning([]), seed=given),
}
NUMBERS = {
    'memory': lambda given: ROBOT.check(memory=given),
    'limit_seconds': lambda given: ROBOT.check(limit=True, limit_seconds=given),
    'seconds of order': lambda given: holdfast.order(ROBOT, seconds=given),
    'help_seconds': lambda given: holdfast.order(ROBOT, help_seconds=given),
    'seconds of move': lambda given: holdfast.move(ROBOT, ROBOT, seconds=given),
    'a time': lambda given: ROBOT.simulate(events=[('kill', given, (0, 0, 0))]),
    'loss': lambda given: ROBOT.simulate(noise={'loss': given}),
    'jitter': lambda given: ROBOT.simulate(noise={'jitter': given}),
    'mass': lambda given: Robot([[0, 0, 0]], masses={(0, 0, 0): given}),
    'masses': lambda given: Robot([[0, 0, 0]], masses=[given]),
}
# No number is a text, nor a text a number.
TYPES = [
    lambda: ROBOT.check(threads=1.5), lambda: ROBOT.check(memory='much'),
    lambda: ROBOT.simulate(seed='one'), lambda: ROBOT.simulate(method=3),
    lambda: ROBOT.simulate(noise={'loss': 'much'}), lambda: ROBOT.simulate(noise={3: 0.1}),
    lambda: ROBOT.simulate(events=[('kill', 'soon', (0, 0, 0))]),
    lambda: ROBOT.simulate(events=[(3, 1, (0, 0, 0))]),
    lambda: ROBOT.simulate(events=[('cut', 1, (0, 0, 0), 3)]),
    lambda: holdfast.order(ROBOT, reach=3), lambda: holdfast.generate('cube', 3.0),
    lambda: Robot.from_text(b'{}'), lambda: Robot([[0, 0, 0]], kind_of={(0, 0, 0): 3}),
    lambda: holdfast.check_many(['robot.json']), lambda: holdfast.table([ROBOT]),
    lambda: holdfast.animate([ROBOT]), lambda: holdfast.plot_steps(ROBOT),
    lambda: holdfast.plot_order(ROBOT)]


def refuses(call, error=holdfast.Error):
    with pytest.raises(error) as caught:
        call()
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


@pytest.mark.parametrize('name', CALLS)
def test_integers_beyond_what_is_allowed(name):
    for given in HUGE:
        assert f', found {given}' in refuses(lambda given=given: CALLS[name](given))


@pytest.mark.parametrize('name', SEEDS)
def test_seeds_have_64_bits(name):
    for given in (-1, 2**64):
        assert f', found {given}' in refuses(lambda given=given: SEEDS[name](given))
    SEEDS[name](2**64 - 1)


@pytest.mark.parametrize('name', NUMBERS)
def test_numbers_that_are_none(name):
    for given in NO_NUMBERS:
        refuses(lambda given=given: NUMBERS[name](given))


@pytest.mark.parametrize('call', TYPES)
def test_wrong_types(call):
    refuses(call, TypeError)


def test_other_values_that_are_refused(tmp_path):
    for options in ({'masses': ['heavy']}, {'masses': 'heavy'}, {'kind_of': 3},
                    {'loads': {(0, 0, 0): 'heavy'}}, {'loads': {(0, 0, 0): (10**400, 0, 0)}}):
        refuses(lambda options=options: Robot([[0, 0, 0]], **options))
    for origin in ((0, 0), [], ((0,), 0, 0)):
        refuses(lambda origin=origin: Robot.from_voxels([[[1]]], origin=origin))
    refuses(lambda: ROBOT.simulate(noise='loud'))
    report = ROBOT.check()
    for milliseconds in (0, float('nan'), float('inf'), 10**400):
        refuses(lambda given=milliseconds: holdfast.animate([report], milliseconds=given))
    for name in ('film.gif', 'film.html'):
        refuses(lambda name=name: holdfast.animate([report], tmp_path / 'absent' / name))


def test_the_lattice_that_connects_the_modules_is_named():
    catoms = Robot([[2, 2, 0], [1, 1, 1]], lattice='face-centred')
    cells = {'modules': [[2, 2, 0], [1, 1, 1]], 'planned': [[2, 2, 2]]}
    text = json.dumps({'format': 'holdfast-structure', 'version': 1, **cells})
    assert len(catoms) == 2
    for call in (lambda: Robot([[2, 2, 0], [1, 1, 1]]), lambda: Robot.from_text(text)):
        assert 'the lattice is cubic, in face-centred it is connected' in refuses(call)


# What is written, as it is said, and its own endings; --vtk and -o of the program say the same.
SAVERS = {
    'save_json': (lambda path: ROBOT.check().save_json(path), 'JSON', ['.json']),
    'save_csv': (lambda path: ROBOT.check().save_csv(path), 'CSV', ['.csv']),
    'save_svg': (lambda path: ROBOT.check().save_svg(path), 'SVG', ['.svg']),
    'save_figure': (lambda path: ROBOT.check().save_figure(path), 'SVG, PNG or PDF',
                    ['.svg', '.png', '.pdf', '.PNG']),
    'save_vtu': (lambda path: ROBOT.check().save_vtu(path), "VTK's XML format", ['.vtu']),
    'save_vtk': (lambda path: holdfast.steps(ROBOT).save_vtk(path), 'a list of .vtu files',
                 ['.pvd']),
    'save': (ROBOT.save, 'holdfast JSON or VisibleSim XML', ['.json', '.xml', '.XML']),
    'animate': (lambda path: holdfast.animate([ROBOT.check()], path), None, ['.gif', '.html'])}
ENDINGS = ['.json', '.csv', '.svg', '.vtu', '.pvd', '.html', '.htm', '.holdfast', '.xml', '.png',
           '.PNG', '.pdf', '.jpg', '.gif', '.vtk', '.stl', '.XML']
# What tells the format when it is known; where it is chosen by the ending it has to be.
CHOSEN_BY_ENDING = ['save_figure', 'save']


@pytest.mark.parametrize('name', SAVERS)
def test_what_a_file_is_called_is_what_is_written(name, tmp_path):
    save, written, own = SAVERS[name]
    unknown = ['.xyzzy'] if name in CHOSEN_BY_ENDING else []
    for ending in {*ENDINGS, *unknown} - set(own):
        path = tmp_path / f'robot{ending}'
        text = refuses(lambda: save(path))
        endings = {'save_figure': '.svg, .png or .pdf', 'save': '.json or .xml'}.get(name, own[0])
        said = f'what is written is {written}, whose files end in {endings}' if written else (
            'expected a name that ends in .gif or .html')
        assert text == f'{path}: {said}'
    assert not list(tmp_path.iterdir())
    for ending in own if name != 'animate' else []:
        save(tmp_path / f'robot{ending}')
        assert (tmp_path / f'robot{ending}').stat().st_size > 0


def test_every_saver_is_tried():
    """Whatever the package gives that writes a file."""
    classes = [holdfast.Robot, holdfast.Report, holdfast.Steps, holdfast.Order,
               *(made for made in vars(holdfast).values() if isinstance(made, type))]
    found = {name for made in classes for name in dir(made) if name.startswith('save')}
    assert found == set(SAVERS) - {'animate'}

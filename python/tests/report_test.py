# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Reports: views of what was found, the same as the other ways to read it, equilibrium."""
import copy
import gc
import json
import pickle

import holdfast
import numpy as np
import pytest
from holdfast import Robot, Verdict

ARRAYS = ['connections', 'displacements', 'facet_forces', 'contacts']


@pytest.fixture(scope='module')
def arm(root):
    return holdfast.load(root / 'scenarios/arm_breaks_b.json')


@pytest.mark.parametrize('name', ARRAYS)
def test_arrays_are_views_that_outlive_their_report(arm, name):
    report = arm.check()
    first, second = getattr(report, name), getattr(report, name)
    assert len(first) > 0
    assert np.shares_memory(first, second)
    assert not first.flags.owndata and not first.flags.writeable
    expected = first.copy()
    del report, second
    gc.collect()
    [np.ones(1000) for _ in range(100)]
    assert (first == expected).all()
    with pytest.raises(ValueError):
        first[0] = first[1]


def test_ground_forces_are_made_of_those_of_the_facets(arm):
    report = arm.check()
    modules = report.robot.facets['module']
    for name in ('force_n', 'moment_nmm'):
        expected = np.zeros((len(report.robot), 3))
        np.add.at(expected, modules, report.facet_forces[name])
        assert (report.ground_forces[name] == expected).all()
    with pytest.raises(ValueError):
        report.ground_forces[0] = report.ground_forces[1]


def test_arrays_say_what_the_json_says(arm):
    report = arm.check()
    said = json.loads(report.json())
    assert said['verdict'] == report.verdict.value == 'overload'
    assert said['reasons'] == report.reasons
    assert said['overload']['load_ratio_max'] == report.load_ratio_max
    assert report.connections['load_ratio'].max() == report.load_ratio_max
    assert report.broken[0] == report.worst == report.connections['load_ratio'].argmax()
    assert len(said['connections']) == len(report.connections) == len(report.limits)
    for entry, row in zip(said['connections'], report.connections):
        assert entry['load_ratio'] == row['load_ratio']
        assert entry['axial_n'] == row['axial_n']
    assert report.weight_factor == pytest.approx(1 / report.load_ratio_max)
    assert report.text().startswith('OVERLOAD  arm_breaks_b\n')
    assert str(report) == report.text()
    assert np.nanmax(report.module_load_ratios) == report.load_ratio_max


def test_forces_balance_the_weight(arm):
    """Statics: facets carry the weight, and their moments about the origin balance it."""
    report = arm.check()
    weight = np.zeros((len(report.robot), 3))
    weight[:, 2] = -9.81 * report.robot.masses
    places = report.robot.positions
    facets = report.facet_forces
    at = places[report.robot.facets['module']]
    force = facets['force_n'].sum(axis=0) + weight.sum(axis=0)
    moment = (facets['moment_nmm'] + np.cross(at, facets['force_n'])).sum(axis=0)
    moment += np.cross(places, weight).sum(axis=0)
    # The displacements have 1e-12 of their digits wrong, forces are stiffness times differences.
    assert np.abs(force).max() < 1e-6 * np.abs(weight).sum()
    assert np.abs(moment).max() < 1e-6 * np.abs(np.cross(places, weight)).sum()
    ground = report.ground_forces['force_n'].sum(axis=0)
    assert ground == pytest.approx(facets['force_n'].sum(axis=0))


def test_displacements_are_those_of_a_rod():
    """A tower's top moves down by the sum of N L / (E A): Eq. (1) without bending."""
    height = 6
    robot = Robot([[0, 0, z] for z in range(height)])
    down = -robot.check().displacements['translation_mm'][:, 2]
    material = robot.material
    weight = material['mass_kg'] * 9.81
    unit = weight * material['pitch_mm'] / (
        material['elastic_modulus_mpa'] * material['section_area_mm2'])
    carried = np.arange(height, 0, -1)  # The beam below a module carries it and all above.
    assert down == pytest.approx(unit * np.cumsum(carried), rel=1e-9)


@pytest.mark.parametrize('name, verdict', [
    ('arm_breaks_a', Verdict.SAFE), ('arm_breaks_b', Verdict.OVERLOAD),
    ('crane_tips_b', Verdict.UNSTABLE)])
def test_verdicts_of_the_scenarios(root, name, verdict):
    assert holdfast.load(root / f'scenarios/{name}.json').check().verdict is verdict


def test_too_little_memory_is_undecided_and_has_no_arrays():
    report = holdfast.generate('cube', 40).check(memory=0.01)
    assert report.verdict is Verdict.UNDECIDED
    for name in ARRAYS[:2]:
        assert len(getattr(report, name)) == 0
    assert report.load_ratio_max is None and report.worst is None
    assert np.isnan(report.module_load_ratios).all()


@pytest.mark.parametrize('options', [
    {'threads': -1}, {'threads': 65}, {'memory': 0}, {'memory': float('nan')}, {'memory': 1e9}])
def test_options_out_of_bounds(arm, options):
    with pytest.raises(holdfast.Error, match=next(iter(options))):
        arm.check(**options)


def test_limit_load_proof_and_bonded(arm):
    report = arm.check(limit=True, proof=True)
    assert report.limit_load['outcome'] in ('found', 'unbounded', 'stopped')
    # The static theorem: no elastic answer exceeds the limit load.
    assert report.limit_load['high'] >= report.weight_factor
    assert report.certificate()
    assert report.timings.proof > 0 and report.timings.limit > 0
    assert arm.check().limit_load is None
    with pytest.raises(holdfast.Error, match='no certificate'):
        arm.check().certificate()
    assert arm.check(bonded=True).contact_model == 'bonded'


def test_files(arm, tmp_path):
    report = arm.check()
    report.save_json(tmp_path / 'r.json')
    report.save_csv(tmp_path / 'r.csv')
    report.save_svg(tmp_path / 'r.svg')
    report.save_vtu(tmp_path / 'r.vtu')
    assert (tmp_path / 'r.json').read_text().rstrip() == report.json().rstrip()
    assert (tmp_path / 'r.csv').read_text() == report.csv()
    assert (tmp_path / 'r.svg').read_text() == report.svg()
    assert len(report.csv().splitlines()) == len(report.connections) + 1
    assert b'<VTKFile' in (tmp_path / 'r.vtu').read_bytes()[:100]
    with pytest.raises(holdfast.Error, match='absent'):
        report.save_svg(tmp_path / 'absent' / 'r.svg')


def test_a_file_gets_what_its_ending_says(arm, tmp_path):
    report = arm.check()
    for name in ('r.json', 'r.csv', 'r.svg', 'r.vtu', 'r.png', 'r.pdf', 'r.SVG'):
        report.save(tmp_path / name)
    assert (tmp_path / 'r.json').read_text().rstrip() == report.json().rstrip()
    assert (tmp_path / 'r.csv').read_text() == report.csv()
    assert (tmp_path / 'r.svg').read_text() == (tmp_path / 'r.SVG').read_text() == report.svg()
    report.save_vtu(tmp_path / 'other.vtu')
    assert (tmp_path / 'r.vtu').read_bytes() == (tmp_path / 'other.vtu').read_bytes()
    assert (tmp_path / 'r.png').read_bytes()[1:4] == b'PNG'
    assert (tmp_path / 'r.pdf').read_bytes()[:5] == b'%PDF-'
    for name in ('r', 'r.xyzzy', 'r.html'):
        with pytest.raises(holdfast.Error, match='expected a file that ends in .json, .csv, .vtu'):
            report.save(tmp_path / name)
        assert not (tmp_path / name).exists()


@pytest.mark.parametrize('options', [{}, {'limit': True}, {'proof': True}, {'bonded': True},
                                     {'deformed': True}],
                         ids=str)
def test_copies_and_pickles_are_the_same(arm, options):
    report = arm.check(**options)
    for again in (pickle.loads(pickle.dumps(report)), copy.copy(report), copy.deepcopy(report)):
        assert again.robot == report.robot
        assert again.json() == report.json()
        assert again.timings == report.timings
        for name in ARRAYS:
            assert (getattr(again, name) == getattr(report, name)).all()


def test_a_pickle_of_a_robot_with_supports_anywhere():
    robot = Robot([[0, 0, 0], [1, 0, 0]], supports=None, obstacles=[
        {'from': (-1, -1, 0), 'to': (-1, 1, 0), 'hold': 'contact', 'friction': 0.5},
        {'from': (0, 0, -1), 'to': (1, 0, -1)}])
    report = robot.check(limit=True)
    again = pickle.loads(pickle.dumps(report))
    assert again.json() == report.json() and again.text() == report.text()


def test_a_column_of_two_buckles_where_it_does_by_hand():
    """docs/second_order.md: P = 2.4860 E I / L^2 = 1.1067 W, a little more as it is compressed."""
    column = Robot.from_text('''{"format": "holdfast-structure", "version": 1, "support_z": -1,
        "material": {"elastic_modulus_mpa": 0.2, "moment_x_mm4": 2133.3333,
                     "moment_y_mm4": 2133.3333},
        "modules": [{"cell": [0, 0, 0], "fixed": true}, [0, 0, 1]]}''')
    assert column.check().deformed is None
    report = column.check(deformed=True, up_to=1.5)
    found = report.deformed
    assert report.verdict == 'safe' and found is not None
    assert found['kind'] == 'bifurcation'
    assert found['factor_critical'] == pytest.approx(1.1067, rel=3e-3)
    assert found['path'].shape[1] == 3 and (np.diff(found['path'][:, 0]) > 0).all()
    assert column.check(deformed=True, up_to=1).deformed['factor_critical'] is None
    behind = column.check(deformed=True, up_to=1.2, follow=True).deformed['behind']
    assert len(behind) == 2 and behind[0]['end'] == 'up_to'
    assert behind[0]['path'].shape[1] == 4
    assert behind[0]['path'][-1, 0] == pytest.approx(1.2, abs=1e-3)
    with pytest.raises(holdfast.Error, match='do not go together'):
        column.check(deformed=True, proof=True)
    with pytest.raises(holdfast.Error, match='follow requires deformed'):
        column.check(follow=True)
    with pytest.raises((holdfast.Error, ValueError), match='up_to'):
        column.check(deformed=True, up_to=0)


def test_many_are_the_same_as_each(root):
    robots = [holdfast.load(path) for path in sorted((root / 'scenarios').glob('*.json'))]
    for threads in (1, 2, 5):
        reports = holdfast.check_many(iter(robots), threads=threads)
        for robot, report in zip(robots, reports):
            alone = robot.check()
            assert report.robot == robot
            assert (report.connections == alone.connections).all()
            assert report.reasons == alone.reasons
    rows = holdfast.table(reports)
    assert rows['load_ratio_max'] == pytest.approx(
        [report.load_ratio_max or np.nan for report in reports], nan_ok=True)
    assert holdfast.check_many([]) == []


def test_a_verdict_is_its_name_and_a_judgement_is_no_truth_value(root, arm):
    """What everybody writes first must not read an overload as good news."""
    steps = holdfast.steps(root / 'scenarios/plan/walk_over_beam.json')
    run = arm.simulate()
    order = holdfast.order(root / 'scenarios/plan/counterweight.json')
    assert arm.check().verdict == 'overload' and json.dumps(arm.check().verdict) == '"overload"'
    assert f'{Verdict.SAFE}' == str(Verdict.SAFE) == 'safe'
    assert f'{holdfast.Stage.SHIFT}' == str(holdfast.Stage.SHIFT) == 'shift'
    assert f'{holdfast.Outcome.NOT_FOUND}' == str(holdfast.Outcome.NOT_FOUND) == 'not-found'
    assert [Verdict.from_code(code) for code in range(4)] == list(Verdict)
    with pytest.raises(ValueError, match='expected 0 to 3, found 4'):
        Verdict.from_code(4)
    for judged in [arm.check(), run, steps]:
        assert judged.is_safe == (judged.verdict == 'safe')
        with pytest.raises(TypeError, match='is_safe'):
            bool(judged)
    with pytest.raises(TypeError, match='is_found'):
        bool(order)
    assert order.is_found == (order.outcome == 'found')


def test_every_name_in_backticks_exists():
    """Docstrings of the package, its classes and their members."""
    import inspect
    import re

    public = {name: getattr(holdfast, name) for name in holdfast.__all__}
    members = {name for thing in public.values() if inspect.isclass(thing) for name in dir(thing)}
    values = {member.value for thing in public.values()
              if inspect.isclass(thing) and issubclass(thing, str) for member in thing}
    known = set(public) | members | values | {'None'}
    count = 0
    for name, thing in public.items():
        documented = [(name, thing)]
        parameters = set()
        if inspect.isclass(thing):
            documented += [(f'{name}.{key}', value) for key, value in vars(thing).items()]
        for _, value in documented:
            function = value.fget if isinstance(value, property) else getattr(
                value, '__func__', value)
            if inspect.isfunction(function):
                parameters |= set(inspect.signature(function).parameters)
        for where, value in documented:
            for quoted in re.findall(r'(?<!`)`([^`]+)`(?!`)', inspect.getdoc(value) or ''):
                last = quoted.split('(')[0].split('.')[-1]
                count += 1
                assert last in known or last in parameters or hasattr(holdfast, last), (
                    where, quoted)
    assert count > 20

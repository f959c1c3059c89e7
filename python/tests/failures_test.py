# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How sure a report is, and what follows from losses: against closed forms and robots without."""
import copy
import json
import math
import pickle
import subprocess

import numpy as np
import pytest

import holdfast
from holdfast import Robot, Verdict
from holdfast._pictures import states


def arm(length):
    return Robot([[x, 0, 2] for x in range(length)], fixed=[[0, 0, 2]])


def test_one_connection_fails_as_its_distribution_says():
    weak = Robot([[0, 0, 1], [1, 0, 1]], fixed=[[0, 0, 1]]).check()
    variance = math.log(1 + 0.5 ** 2)
    z = (math.log(weak.load_ratio_max) + variance / 2) / math.sqrt(variance)
    sure = weak.reliability(0.5)
    assert sure.probability_fails == pytest.approx(0.5 * math.erfc(-z / math.sqrt(2)), rel=1e-9)
    assert sure.likeliest[0]['share'] == pytest.approx(1)


def test_an_arm_loses_all_beyond_a_connection():
    lost = arm(4).lose_one(parts=['connection'])
    assert not lost.holds_all
    assert [loss['fallen'] for loss in lost.fatal] == [3, 2, 1]


def test_losses_are_those_of_robots_without_the_module():
    robot = holdfast.generate('cube', 3)
    lost = robot.lose_one(parts=['module'])
    cells = [tuple(cell) for cell in robot.cells.tolist()]
    fatal = {tuple(loss['module']) for loss in lost.fatal}
    for cell in cells:
        left = Robot([other for other in cells if other != cell])
        assert (left.check().verdict is not Verdict.SAFE) == (cell in fatal)


def test_an_arm_that_breaks_falls_beyond_its_root():
    robot = arm(7)
    report = robot.check()
    assert report.verdict is Verdict.OVERLOAD
    cascade = robot.cascade()
    assert cascade.outcome == 'stands'
    assert cascade.standing == [[0, 0, 2]]
    assert cascade.rounds[0]['broken'][0]['load_ratio'] == pytest.approx(report.load_ratio_max)
    assert cascade.fallen == sum(len(turn['fallen']) for turn in cascade.rounds) == 6
    assert arm(3).cascade().outcome == 'holds'


def test_faults_are_named():
    with pytest.raises(holdfast.Error, match='expected a share'):
        arm(3).check().reliability(10)
    with pytest.raises(holdfast.Error, match='expected lognormal'):
        arm(3).check().reliability(0.1, law='cauchy')
    with pytest.raises(holdfast.Error, match="expected 'connection'"):
        arm(3).lose_one(parts=['legs'])


def test_what_a_robot_states_is_what_scatters():
    stated = Robot([[x, 0, 2] for x in range(4)], fixed=[[0, 0, 2]],
                   material={'strength_cv': 0.2, 'strength_distribution': 'weibull'}).check()
    assert stated.reliability() == stated.reliability(0.2, law='weibull')
    assert stated.reliability(mass=0.05).samples > 0
    with pytest.raises(holdfast.Error, match='nothing is known to scatter'):
        arm(3).check().reliability()


def test_pull_tests_are_fitted_by_their_logarithms():
    forces = [10.2, 12.9, 11.1, 9.5, 13.3, 11.8]
    mean = sum(map(math.log, forces)) / len(forces)
    variance = sum((math.log(force) - mean) ** 2 for force in forces) / len(forces)
    found = holdfast.fit({'experiments': [{'pull': 'lateral', 'broke_n': force}
                                          for force in forces]})
    assert found.strength_lateral_n.value == pytest.approx(math.exp(mean + variance / 2), rel=1e-3)
    assert found.strength_cv.low < found.strength_cv.value < found.strength_cv.high
    assert found.strength_vertical_n.value is None
    with pytest.raises(holdfast.Error, match='expected at least one experiment'):
        holdfast.fit({'experiments': []})


def test_a_safety_factor_divides_strengths_and_is_not_lost():
    beam = Robot([[0, 0, 2], [1, 0, 2], [2, 0, 2]], fixed=[[0, 0, 2]], planned=[[3, 0, 2]])
    ratio = beam.check().load_ratio_max
    assert beam.check(safety_factor=1.25).load_ratio_max == pytest.approx(1.25 * ratio, rel=1e-12)
    assert beam.check(safety_factor=1.01 / ratio).verdict is Verdict.OVERLOAD
    allowed = beam.with_safety_factor(1.25)
    assert allowed.safety_factor == 1.25 and beam.safety_factor == 1 and allowed != beam
    assert json.loads(allowed.json())['safety_factor'] == 1.25
    assert Robot.from_text(allowed.json()) == allowed != Robot.from_text(beam.json())
    assert 'safety_factor' not in beam.json()
    again = [Robot.from_text(allowed.json()), Robot.from_text(allowed.visiblesim()),
             pickle.loads(pickle.dumps(allowed)), copy.deepcopy(allowed), allowed.attached(),
             allowed.with_steps([]), allowed.translated([1, 0, 0]), allowed.rotated(),
             *states(allowed.planning([])), allowed.check().robot,
             pickle.loads(pickle.dumps(allowed.check())).robot]
    assert len(again) == 11
    for robot in again:
        assert robot.safety_factor == 1.25
    assert again[0].check().load_ratio_max == pytest.approx(1.25 * ratio, rel=1e-12)
    assert allowed.check(safety_factor=1).load_ratio_max == pytest.approx(ratio, rel=1e-12)
    places = beam.next(safety_factor=1.01 / ratio)
    assert len(beam.next().safe) > 0 and len(places.safe) == 0
    one = beam.lose_one(parts=['connection'], safety_factor=1.01 / ratio)
    assert not one.holds_all
    plan = [{'attach': [[3, 0, 2]]}]
    bare = Robot([[0, 0, 2], [1, 0, 2], [2, 0, 2]], fixed=[[0, 0, 2]])
    assert holdfast.steps(bare, plan).verdict is Verdict.SAFE
    assert holdfast.steps(bare, plan, safety_factor=1.01 / ratio).verdict is Verdict.OVERLOAD
    assert holdfast.order(beam).is_found
    assert not holdfast.order(beam, safety_factor=1.01 / ratio).is_found
    for bad in (0.5, 0, -1, 1001, math.nan):
        with pytest.raises(holdfast.Error, match='safety_factor: expected a number from 1 to'):
            beam.check(safety_factor=bad)


QUESTIONS = {'scatter': 0.1, 'common': 0.05, 'law': 'weibull', 'probability': 0.95,
             'lose_one': True, 'parts': ['connection', 'foot']}
OPTIONS = ['--scatter', '10%', '--scatter-common', '5%', '--scatter-law', 'weibull',
           '--probability', '0.95', '--lose-one', '--lose', 'connections,feet']


def said(root, folder, *arguments):
    """What the command line says as JSON, but for times."""
    out = folder / 'report.json'
    done = subprocess.run([root / 'build/release/holdfast', *arguments, '--json', out, '-q'],
                          capture_output=True, text=True)
    assert done.stderr == '' and done.returncode in (0, 1, 2)
    return json.loads(out.read_text())


def place_of(stage):
    return None if stage is None else {'step': stage[0], 'stage': stage[1].value}


def agrees(answer, report):
    """The attributes and the report's members are those of the command line."""
    assert report['reliability'] == {
        key: place_of(value) if isinstance(value, tuple) else value
        for key, value in answer.reliability._asdict().items()}
    assert report['lose_one'] == {key: place_of(value) if isinstance(value, tuple) else value
                                  for key, value in answer.lose_one._asdict().items()}
    own = json.loads(answer.json())
    assert {key: own[key] for key in ('reliability', 'lose_one')} == {
        key: report[key] for key in ('reliability', 'lose_one')}
    assert 'reliability' in answer.text() and 'lose one' in answer.text()
    assert pickle.loads(pickle.dumps(answer.lose_one)) == answer.lose_one
    assert pickle.loads(pickle.dumps(answer.reliability)) == answer.reliability


PLANS = {
    'bar': (arm(4), [{'attach': [[4, 0, 2]]}, {'attach': [[5, 0, 2]]}]),
    'prism': (Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1]], lattice='hexagonal-prism'),
              [{'attach': [[0, 0, 2]]}, {'detach': [[1, 0, 0]]}]),
    'square': (Robot([[x, y, 0] for x in range(3) for y in range(2)]),
               [{'attach': [[0, 0, 1], [1, 0, 1]]}, {'attach': [[0, 0, 2]]}]),
}


@pytest.mark.parametrize('name', PLANS)
def test_steps_are_as_sure_as_the_command_line_says(root, tmp_path, name):
    robot, plan = PLANS[name]
    robot = robot.with_steps(plan)
    robot.save(tmp_path / 'plan.json')
    mass = {'mass': 0.02} if name == 'prism' else {}  # A check for each of many samples.
    judged = holdfast.steps(robot, **QUESTIONS, **mass)
    agrees(judged, said(root, tmp_path, 'steps', tmp_path / 'plan.json', *OPTIONS,
                        *(['--scatter-mass', '2%'] if mass else [])))
    assert holdfast.steps(robot).reliability is holdfast.steps(robot).lose_one is None


def test_steps_are_as_sure_as_each_state_is():
    """The states between steps as robots of their own, each checked by itself."""
    states = [arm(length) for length in (4, 5, 6)]
    sure = [state.check().reliability(0.2).probability_holds for state in states]
    plan = [{'attach': [[4, 0, 2]]}, {'attach': [[5, 0, 2]]}]
    judged = holdfast.steps(states[0], plan, scatter=0.2, probability=(sure[1] + sure[2]) / 2)
    assert judged.reliability.probability_min == pytest.approx(min(sure), rel=1e-12)
    assert judged.reliability.first_below == (1, holdfast.Stage.CONNECT)
    assert judged.reliability.least == judged.reliability.first_below


@pytest.mark.parametrize('name', ['crane_breaks_a', 'arm_breaks_a', 'angle_breaks_a'])
def test_places_are_as_sure_as_the_command_line_says(root, tmp_path, name):
    file = root / f'scenarios/{name}.json'
    places = holdfast.next_places(file, **QUESTIONS)
    report = said(root, tmp_path, 'next', file, *OPTIONS)
    own = json.loads(places.json())
    assert own['candidates'] == report['candidates'] and own['counts'] == report['counts']
    probabilities = [place.get('probability_holds') for place in report['candidates']]
    assert [None if math.isnan(one) else one for one in places.reliability] == probabilities
    assert places.lose_one == [place.get('fatal') for place in report['candidates']]
    assert np.isnan(holdfast.next_places(file).reliability).all()
    assert any(one is not None for one in probabilities)


def test_places_are_as_sure_as_each_robot_is():
    robot = Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1]])
    places = robot.next(scatter=0.3)
    for candidate, holds in zip(places.candidates, places.reliability):
        if candidate['verdict'] == 0:
            there = robot.planning([candidate['cell']]).attached()
            assert holds == pytest.approx(there.check().reliability(0.3).probability_holds)


def test_orders_and_moves_are_as_sure_as_the_command_line_says(root, tmp_path):
    plan = root / 'scenarios/plan'
    for target in (root / 'scenarios/crane_breaks_a.json', root / 'scenarios/bush_tips_a.json'):
        found = holdfast.order(target, **QUESTIONS)
        agrees(found, said(root, tmp_path, 'order', target, *OPTIONS))
    ends = [plan / f'around_arm_{end}.json' for end in ('from', 'to')]
    moves = holdfast.move(*ends, **QUESTIONS)
    agrees(moves, said(root, tmp_path, 'move', *ends, *OPTIONS))
    none = holdfast.order(plan / 'arch.json', seconds=0, scatter=0.1, lose_one=True)
    assert none.reliability is None and none.lose_one is None


def test_questions_that_cannot_be_asked_are_refused():
    robot, plan = PLANS['bar']
    for ask in (lambda **asked: holdfast.steps(robot, plan, **asked), robot.next,
                lambda **asked: holdfast.order(arm(3), **asked),
                lambda **asked: holdfast.move(arm(3), Robot([[0, 0, 2], [1, 0, 2], [1, 0, 3]],
                                                            fixed=[[0, 0, 2]]),
                                              ignores_mechanics=True, **asked)):
        for asked, match in (({'scatter': 10}, 'scatter: expected a share from 0.0001 to 1'),
                             ({'mass': 0.5}, 'mass: expected a share from 0.0001 to 0.3'),
                             ({'probability': 2}, 'probability: expected 0 to 1, found 2'),
                             ({'probability': 0.9}, 'nothing is known to scatter'),
                             ({'law': 'cauchy'}, 'law: expected lognormal'),
                             ({'lose_one': True, 'parts': ['leg']}, "expected 'connection'"),
                             ({'lose_seconds': 3}, 'expected lose_one=True')):
            with pytest.raises(holdfast.Error, match=match):
                ask(**asked)
        with pytest.raises(TypeError, match="unexpected keyword argument 'scater'"):
            ask(scater=0.1)
        with pytest.raises(TypeError):
            ask(scatter='much')

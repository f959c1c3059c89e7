# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How sure a report is, and what follows from losses: against closed forms and robots without."""
import copy
import math
import pickle

import pytest

import holdfast
from holdfast import Robot, Verdict


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
    again = [pickle.loads(pickle.dumps(allowed)), copy.deepcopy(allowed), allowed.attached(),
             allowed.with_steps([]), allowed.translated([1, 0, 0]), allowed.rotated(),
             allowed.check().robot, pickle.loads(pickle.dumps(allowed.check())).robot]
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

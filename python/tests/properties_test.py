# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every robot, tried on random ones."""
import json

import holdfast
import numpy as np
import pytest
from holdfast import Robot, Verdict

SEEDS = range(25)


def random_cells(seed, count=24):
    """A connected heap on the floor, in the order in which it grew."""
    rng = np.random.default_rng(seed)
    cells = [(0, 0, 0)]
    while len(cells) < count:
        cell = list(cells[rng.integers(len(cells))])
        cell[rng.integers(3)] += rng.choice((-1, 1))
        if cell[2] >= 0 and tuple(cell) not in cells:
            cells.append(tuple(cell))
    return np.array(cells)


def ratios(report):
    """Load ratios by the cells of both ends."""
    cells = [tuple(cell) for cell in report.robot.modules['cell'].tolist()]
    return {frozenset((cells[pair['a']], cells[pair['b']])): ratio for pair, ratio in
            zip(report.robot.connections, report.connections['load_ratio'])}


def assert_same(a, b):
    """Another order of elimination rounds differently, by some 1e-12 of the largest."""
    assert a.keys() == b.keys()
    scale = max(map(abs, a.values()))
    assert [b[key] for key in a] == pytest.approx(list(a.values()), abs=1e-9 * scale)


@pytest.mark.parametrize('seed', SEEDS)
def test_the_order_of_modules_does_not_matter(seed):
    cells = random_cells(seed)
    report = Robot(cells).check()
    shuffled = Robot(np.random.default_rng(seed).permutation(cells)).check()
    assert shuffled.verdict is report.verdict
    assert_same(ratios(report), ratios(shuffled))


@pytest.mark.parametrize('seed', SEEDS)
def test_planned_modules_are_like_existing_ones(seed):
    cells = random_cells(seed)
    robot = Robot(cells[:18], planned=cells[18:])
    report, attached = robot.check(), robot.attached().check()
    assert attached.verdict is report.verdict is Robot(cells).check().verdict
    assert (attached.connections == report.connections).all()


@pytest.mark.parametrize('seed', SEEDS)
def test_threads_files_and_batches_change_no_bit(seed):
    robot = Robot(random_cells(seed), material={'strength_lateral_n': 9.0})
    report = robot.check(threads=1)
    others = [robot.check(threads=3), Robot.from_text(robot.json()).check(),
              *holdfast.check_many([robot] * 5, threads=2)]
    for other in others:
        assert other.verdict is report.verdict
        assert other.connections.tobytes() == report.connections.tobytes()
        assert other.displacements.tobytes() == report.displacements.tobytes()


@pytest.mark.parametrize('seed', SEEDS)
def test_loads_and_strengths_scale(seed):
    """Eqs. (1)-(17) are homogeneous: twice the gravity, twice the ratios; so with half the
    strength."""
    cells = random_cells(seed)
    report = Robot(cells).check()
    heavy = Robot(cells, gravity=(0, 0, -2 * 9.81)).check()
    weak = Robot(cells, material={'strength_vertical_n': 11.98 / 2,
                                  'strength_lateral_n': 14.97 / 2}).check()
    assert heavy.stability['margin_mm'] == pytest.approx(report.stability['margin_mm'])
    assert_same({key: 2 * ratio for key, ratio in ratios(report).items()}, ratios(heavy))
    assert_same(ratios(heavy), ratios(weak))


@pytest.mark.parametrize('seed', SEEDS)
def test_places_are_those_of_checks(seed):
    robot = Robot(random_cells(seed, 10))
    for candidate in robot.next().candidates[:6]:
        report = robot.planning([candidate['cell']]).check()
        assert report.verdict is list(Verdict)[candidate['verdict']]


@pytest.mark.parametrize('seed', SEEDS)
def test_the_json_of_a_robot_is_the_robot(seed):
    rng = np.random.default_rng(seed)
    cells = random_cells(seed)
    robot = Robot(cells, masses=rng.uniform(0.01, 0.2, len(cells)),
                  loads={tuple(cells[3].tolist()): rng.normal(size=6)}, gravity=rng.normal(size=3))
    again = Robot.from_text(robot.json())
    assert again == robot
    assert json.loads(again.json()) == json.loads(robot.json())
    assert again.masses.tolist() == robot.masses.tolist()

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Robots that are moved, turned, put together, and robots as graphs."""
import json
import pickle

import networkx
import numpy as np
import pytest

import holdfast


def grown(seed, count=12):
    """A random robot of cubes with everything in it that has a place or a direction."""
    random = np.random.default_rng(seed)
    cells = [(0, 0, 0)]
    while len(cells) < count:
        cell = np.array(cells[random.integers(len(cells))])
        cell[random.integers(3)] += random.choice([-1, 1])
        if cell[2] >= 0 and tuple(cell) not in cells:
            cells.append(tuple(int(x) for x in cell))
    free = max(cell[0] for cell in cells) + 1
    return holdfast.Robot(
        cells, planned=[[0, 0, max(c[2] for c in cells if c[:2] == (0, 0)) + 1]],
        loads={cells[-1]: [*random.normal(size=3), *(10 * random.normal(size=3))]},
        obstacles=[{'from': [free, -9, 0], 'to': [free + 1, 9, 4]}],
        gravity=[0.4, -0.3, -9.8], name='grown')


def summary(robot):
    report = robot.check()
    return report.verdict, report.load_ratio_max


@pytest.mark.parametrize('seed', range(20))
def test_a_turned_robot_has_the_same_answer(seed):
    robot = grown(seed)
    verdict, ratio = summary(robot)
    for quarters in (1, 2, 3, -1):
        other = summary(robot.rotated(quarters))
        assert other[0] is verdict
        assert other[1] == pytest.approx(ratio, rel=1e-6)


@pytest.mark.parametrize('seed', range(20))
def test_turns_add_up(seed):
    robot = grown(seed)
    assert robot.rotated(4) == robot.rotated(0)
    once, twice = robot.rotated(3), robot.rotated().rotated(2)
    assert json.loads(once.json()) == json.loads(twice.json())


@pytest.mark.parametrize('seed', range(20))
def test_a_moved_robot_has_the_same_answer(seed):
    robot = grown(seed)
    moved = robot.translated([5, -3, 2])
    assert moved.supports == 2
    assert (moved.cells - robot.cells == [5, -3, 2]).all()
    assert summary(moved) == summary(robot)
    assert moved.translated([-5, 3, -2]) == robot.translated([0, 0, 0])


def test_steps_open_faces_and_connections_move_along():
    text = json.dumps({
        'format': 'holdfast-structure', 'version': 2,
        'modules': [{'from': [0, 0, 0], 'to': [1, 1, 0]}], 'open': [[[0, 0, 0], [0, 1, 0]]],
        'connections': [{'between': [[0, 0, 0], [1, 0, 0]], 'strength_n': 3}],
        'steps': [{'attach': [[0, 0, 1]]}, {'move': [{'from': [0, 0, 1], 'to': [1, 0, 1]}]},
                  {'detach': [[1, 0, 1]]}]})
    moved = json.loads(holdfast.Robot.from_text(text).rotated(2).translated([1, 1, 0]).json())
    assert moved['open'] == [[[1, 1, 0], [1, 0, 0]]]
    assert moved['connections'][0]['between'] == [[1, 1, 0], [0, 1, 0]]
    assert moved['steps'][1]['move'] == [{'from': [1, 1, 1], 'to': [0, 1, 1]}]
    assert moved['steps'][2]['detach'] == [[0, 1, 1]]


def test_a_layer_of_balls_moves_to_one_of_its_kind():
    balls = holdfast.Robot([[0, 0, 0], [0, 0, 1]], lattice='face-centred')
    assert summary(balls.translated([1, 1, 2])) == summary(balls)
    with pytest.raises(holdfast.Error, match='expected an even z, found 1'):
        balls.translated([0, 0, 1])
    with pytest.raises(holdfast.Error, match='expected a robot of cubes'):
        balls.rotated()


def test_a_union_is_the_robot_of_both():
    one, other = [[0, 0, 0], [0, 0, 1]], [[1, 0, 0], [2, 0, 0]]
    assert holdfast.Robot(one).union(
        holdfast.Robot(other)) == holdfast.Robot(one + other).translated([0, 0, 0])


def test_a_union_says_what_it_cannot_be():
    robot = holdfast.Robot([[0, 0, 0], [1, 0, 0]])
    with pytest.raises(holdfast.Error, match=r'\(1, 0, 0\) is a cell of both'):
        robot.union(robot.translated([1, 0, 0]))
    with pytest.raises(holdfast.Error, match='with the same material'):
        robot.union(holdfast.Robot([[2, 0, 0]], material={'mass_kg': 1}))


def test_a_union_may_be_in_pieces():
    robot = holdfast.Robot([[0, 0, 0], [0, 0, 1], [1, 0, 1]])
    report = robot.union(robot.translated([5, 0, 0])).check()
    assert [(piece['modules'], piece['first']) for piece in report.pieces] == [
        (3, (0, 0, 0)), (3, (5, 0, 0))]
    assert {piece['verdict'] for piece in report.pieces} == {robot.check().verdict}
    assert report.load_ratio_max == robot.check().load_ratio_max
    assert robot.check().pieces == []
    copy = pickle.loads(pickle.dumps(report))
    assert copy.pieces == report.pieces and copy.text() == report.text()
    with pytest.raises(holdfast.Error, match='nothing holds 1 of its 2 pieces'):
        holdfast.Robot([[0, 0, 0], [0, 0, 1], [5, 0, 1], [6, 0, 1]])


def split(report):
    return sorted((piece['modules'], piece['verdict'], piece['load_ratio_max'])
                  for piece in report.pieces)


@pytest.mark.parametrize('seed', range(10))
def test_pieces_are_the_robots_of_which_a_union_is_made(seed):
    """What each is as a robot of its own is what the whole says of it."""
    one, two = grown(seed), grown(seed + 100, 7)
    both = one.union(two.translated([0, 40, 0]))
    small, large = sorted(both.pieces(), key=len)
    assert large.json() == both.largest_piece().json()
    assert summary(large) == summary(one) and summary(small) == summary(two)
    assert {tuple(cell) for cell in large.cells.tolist()} == {
        tuple(cell) for cell in one.cells.tolist()}
    assert split(both.check()) == sorted((len(piece), *summary(piece)) for piece in both.pieces())
    assert one.pieces() == [one] and one.largest_piece() is one


def test_pieces_keep_what_is_theirs_alone():
    text = json.dumps({
        'format': 'holdfast-structure', 'version': 2, 'joined': 'listed',
        'kinds': {'heavy': {'mass_kg': 0.2}},
        'modules': [{'cell': [0, 0, 0], 'kind': 'heavy'}, [1, 0, 0], [2, 0, 0], [9, 0, 0],
                    {'cell': [9, 0, 1], 'fixed': True}, [10, 0, 0]],
        'planned': [[9, 0, 2]], 'loads': [{'cell': [9, 0, 1], 'force_n': [0, 0, -1]}],
        'connections': [{'between': [[0, 0, 0], [1, 0, 0]], 'strength_n': 3},
                        {'between': [[1, 0, 0], [2, 0, 0]]}, {'between': [[9, 0, 0], [9, 0, 1]]},
                        {'between': [[9, 0, 0], [10, 0, 0]]},
                        {'between': [[9, 0, 1], [9, 0, 2]]}]})
    held, flat = holdfast.Robot.from_text(text).pieces()
    assert (len(held), held.planned.tolist()) == (4, [[9, 0, 2]])
    assert json.loads(held.json())['loads'][0]['cell'] == [9, 0, 1]
    assert 'loads' not in json.loads(flat.json()) and len(flat.planned) == 0
    assert json.loads(flat.json())['connections'][0] == {
        'between': [[0, 0, 0], [1, 0, 0]], 'strength_n': 3}
    assert flat.masses.tolist() == [0.2, 0.06106, 0.06106]


def test_steps_are_of_all_pieces():
    robot = holdfast.Robot.from_text(json.dumps({
        'format': 'holdfast-structure', 'version': 1, 'modules': [[0, 0, 0], [5, 0, 0]],
        'planned': [[0, 0, 1]], 'later_steps': [[[0, 0, 2]]]}))
    with pytest.raises(holdfast.Error, match='without steps'):
        robot.pieces()


def test_an_order_is_of_one_piece():
    with pytest.raises(holdfast.Error, match='not connected'):
        holdfast.order(holdfast.Robot([[0, 0, 0], [0, 0, 1], [5, 0, 0]]))


@pytest.mark.parametrize('what', ['next', 'simulate', 'lose_one', 'cascade'])
def test_pieces_are_refused_by_name(what):
    robot = holdfast.Robot([[0, 0, 0], [0, 0, 1], [5, 0, 0]])
    with pytest.raises(holdfast.Error, match='in 2 pieces'):
        getattr(robot, what)()
    for wish in ('proof', 'limit', 'deformed'):
        with pytest.raises(holdfast.Error, match=f'in 2 pieces, and {wish} is for robots of one'):
            robot.check(**{wish: True})


def test_a_robot_contains_cells():
    robot = holdfast.Robot([[0, 0, 0], [1, 0, 0]], planned=[[0, 0, 1]])
    assert (1, 0, 0) in robot and [0, 0, 1] in robot and np.array([0, 0, 0]) in robot
    assert (2, 0, 0) not in robot and 'arm' not in robot and (0, 0) not in robot


@pytest.mark.parametrize('seed', range(5))
def test_a_graph_is_the_robot(seed):
    robot = grown(seed)
    report = robot.check()
    graph = report.to_networkx()
    assert networkx.is_connected(graph)
    assert graph.number_of_nodes() == len(robot)
    assert graph.number_of_edges() == len(robot.connections)
    for a, b in graph.edges:
        assert sum(abs(x - y) for x, y in zip(a, b)) == 1
    for pair, row in zip(robot.connections, report.connections):
        a, b = (tuple(robot.modules['cell'][pair[end]].tolist()) for end in 'ab')
        assert graph.edges[a, b]['load_ratio'] == row['load_ratio']
    assert sum(graph.nodes[cell]['mass_kg'] for cell in graph) == pytest.approx(robot.masses.sum())
    assert [graph.nodes[c]['is_planned'] for c in graph].count(True) == len(robot.planned)

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Places, steps, orders, moves and the robot's own computation agree with checks."""
import copy
import csv
import html
import json

import holdfast
import numpy as np
import pytest
from holdfast import Outcome, Robot, Stage, Verdict

ARM = Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2], [3, 0, 2],
             [4, 0, 2]])
VERDICTS = list(Verdict)


def test_places_have_the_verdicts_of_checks():
    places = ARM.next()
    assert len(places) > 20
    for candidate in places.candidates:
        report = ARM.planning([candidate['cell']]).check()
        assert report.verdict is VERDICTS[candidate['verdict']]
        if report.verdict in (Verdict.SAFE, Verdict.OVERLOAD):
            assert candidate['load_ratio_max'] == pytest.approx(report.load_ratio_max, rel=1e-9)
    assert (places.candidates['verdict'] == 0).sum() == len(places.safe)
    assert json.loads(places.json()) and places.text() and '<svg' in places.svg()
    assert places.robot == ARM


def test_remedies_are_safe_by_checks_of_the_changed_robot():
    crane = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1]] + [[x, 0, 2] for x in range(6)])
    report = crane.check()
    remedies = report.remedies()
    cells = [tuple(cell) for cell in crane.cells]
    for place in remedies.module:
        assert crane.planning([place['cell']]).check().load_ratio_max == pytest.approx(
            place['load_ratio_max'], rel=1e-6)
    for place in remedies.removal:
        left = Robot([cell for cell in cells if cell != tuple(place['cell'])])
        assert left.check().load_ratio_max == pytest.approx(place['load_ratio_max'], rel=1e-6)
    for kind in ('module', 'prop', 'fixing', 'removal'):
        table = getattr(remedies, kind)
        assert 0 < len(table) <= remedies.tried[kind]
        assert (table['load_ratio_max'] < 1).all()
        assert (np.diff(table['load_ratio_max']) > -1e-6).all()
    assert report.load_ratio_max <= remedies.strength_factor < report.load_ratio_max + 0.01


def test_steps_are_judged_at_every_stage(root):
    tower = Robot([[0, 0, 0], [1, 0, 0]])
    judged = holdfast.steps(tower, [{'attach': [[0, 0, 1]]}, {'attach': [[-1, 0, 1], [-2, 0, 1],
                                                                         [-3, 0, 1]]}])
    assert judged.stages.shape == (2, 3)
    assert judged.verdict is Verdict.UNSTABLE
    assert judged.first_unsafe == (1, Stage.CONNECT)
    # The last stage is the check of the robot with all attached.
    whole = Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1], [-1, 0, 1], [-2, 0, 1], [-3, 0, 1]]).check()
    assert judged.stages['margin_mm'][1, 2] == pytest.approx(whole.stability['margin_mm'])
    assert '<svg' in judged.svg() and '<html' in judged.html().lower() and judged.text()
    from_file = holdfast.steps(root / 'scenarios/plan/walk_over_beam.json')
    assert from_file.verdict is VERDICTS[from_file.stages['verdict'].max()]
    with pytest.raises(holdfast.Error, match='no steps'):
        holdfast.steps(tower)
    with pytest.raises(holdfast.Error, match='step'):
        holdfast.steps(tower, [{'detach': [[9, 9, 9]]}])


def test_steps_are_written_for_paraview(tmp_path):
    judged = holdfast.steps(Robot([[0, 0, 0]]), [{'attach': [[0, 0, 1]]}])
    judged.save_vtk(tmp_path / 'series.pvd')
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        'series.pvd', 'series_0.vtu', 'series_1.vtu']


def test_an_order_is_safe_all_the_way():
    target = Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [-1, 0, 1]])
    found = holdfast.order(target)
    assert found.outcome is Outcome.FOUND
    cells = found.start.tolist()
    for batch in found.batches:
        assert Robot(cells, planned=batch).check().verdict is Verdict.SAFE
        cells += batch.tolist()
    assert sorted(cells) == sorted(target.cells.tolist())
    assert holdfast.steps(found.robot()).verdict is Verdict.SAFE
    apart = holdfast.order(target, reverse=True)
    assert holdfast.steps(apart.robot()).verdict is Verdict.SAFE
    for options in ({'reach': 'fly'}, {'reach': 'surface'}, {'group': 0}, {'seconds': -1},
                    {'seconds': float('nan')}, {'start': [[9, 9, 9]]}):
        with pytest.raises(holdfast.Error):
            holdfast.order(target, **options)


def test_an_exact_order_has_every_load_ratio():
    """More than 256 modules, of which all are solved only if that is asked for."""
    target = holdfast.generate('tower', 30)
    certified = holdfast.order(target).judgements['load_ratio_max'][1:]
    found = holdfast.order(target, exact=True)
    exact = found.judgements['load_ratio_max'][1:]  # One module alone has no connection.
    assert np.isnan(certified).any() and not np.isnan(exact).any()
    is_solved = ~np.isnan(certified)
    np.testing.assert_allclose(exact[is_solved], certified[is_solved], rtol=0, atol=1e-4)
    assert found.load_ratio_max == exact.max() <= found.load_ratio_bound


def test_no_order_is_certified(root):
    """Each half of the arch topples before they meet (scenarios/plan)."""
    arch = root / 'scenarios/plan/arch.json'
    none = holdfast.order(arch, seconds=60)
    assert none.outcome is Outcome.NONE
    assert json.loads(none.certificate())['states']
    found = holdfast.order(Robot([[0, 0, 0], [0, 0, 1]]))
    assert found.outcome is Outcome.FOUND
    with pytest.raises(holdfast.Error, match='certificate'):
        found.certificate()


def test_moves_are_safe_steps(root):
    plan = root / 'scenarios/plan'
    found = holdfast.move(plan / 'around_arm_from.json', plan / 'around_arm_to.json', seconds=60)
    assert found.outcome is Outcome.FOUND
    start, target = (holdfast.load(plan / f'around_arm_{end}.json') for end in ('from', 'to'))
    cells = {tuple(cell) for cell in start.cells.tolist()}
    for step in found.steps:
        for origin, to, _ in step:
            cells.remove(origin)
            cells.add(to)
    assert cells == {tuple(cell) for cell in target.cells.tolist()}
    assert holdfast.steps(found.robot()).verdict is Verdict.SAFE
    with pytest.raises(holdfast.Error, match='within'):
        holdfast.move(start, target, within=[[0, 0, 0]])


def test_moves_have_the_motions_that_are_given(root, tmp_path):
    plan = root / 'scenarios/plan'
    ends = [plan / f'around_arm_{end}.json' for end in ('from', 'to')]
    box = [[-9, 0, -9], [9, 0, 9]]
    pivoting = holdfast.move(*ends, motions='pivoting', within=box)
    assert pivoting.steps == holdfast.move(*ends, pivots=True, within=box).steps
    robot = pivoting.robot()
    assert holdfast.steps(robot, motions='pivoting').verdict is Verdict.SAFE
    slides = tmp_path / 'slides.json'
    slides.write_text('{"format": "holdfast-motions", "version": 1, "name": "slides", "motions": '
                      '[{"to": [1, 0, 0], "modules": [[0, 0, -1], [1, 0, -1]]}]}')
    with pytest.raises(holdfast.Error, match='no motion leads from'):
        holdfast.steps(robot, motions=slides)
    with pytest.raises(holdfast.Error, match='another lattice'):
        holdfast.move(*ends, motions='catoms3D')
    with pytest.raises(FileNotFoundError):
        holdfast.move(*ends, motions=tmp_path / 'none.json')
    with pytest.raises(ValueError, match='expected one of them'):
        holdfast.move(*ends, pivots=True, motions=slides)


def replayed(plan):
    """The cells after the steps of a plan, which are safe."""
    steps = json.loads(plan.json()).get('steps', [])
    assert not steps or holdfast.steps(plan).verdict is Verdict.SAFE
    cells = {tuple(cell) for cell in plan.cells.tolist()}
    for step in steps:
        cells |= {tuple(cell) for cell in step.get('attach', [])}
        cells -= {tuple(cell) for cell in step.get('detach', [])}
        for move in step.get('move', []):
            cells.remove(tuple(move['from']))
            cells.add(tuple(move['to']))
    return cells


def test_a_plan_is_gone_on_with(tmp_path):
    tower = Robot([[0, 0, z] for z in range(5)] + [[1, 0, 0]])
    told = []
    first = holdfast.order(tower, on_step=told.append)
    assert [step['attach'] for step in told[1:]] == [batch.tolist() for batch in first.batches]
    assert told[0]['start'] == first.start.tolist() and told[-1]['margin_mm'] > 0
    assert first.kept_count is None
    rest = holdfast.order(tower, continue_=first.robot(), at=2)
    assert rest.kept_count == len(rest.batches) == len(first.batches) - 2
    assert replayed(rest.robot()) == {tuple(cell) for cell in tower.cells.tolist()}
    path = tmp_path / 'plan.json'
    first.robot().save(path)
    now = Robot([*first.start.tolist(), *first.batches[0].tolist(), *first.batches[1].tolist()])
    assert holdfast.order(now, continue_=path).kept_count == len(first.batches) - 2

    row = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    up = Robot([[0, 0, 0], [0, 0, 1], [0, 0, 2]])
    told.clear()
    moves = holdfast.move(row, up, on_step=told.append)
    assert [(tuple(step['from']), tuple(step['to'])) for step in told] == [
        (origin, to) for (origin, to, _), in moves.steps]
    for at in range(len(moves.steps) + 1):
        left = holdfast.move(row, continue_=moves.robot(), at=at)
        assert left.steps == moves.steps[at:] and left.kept_count == len(left.steps)
    with pytest.raises(holdfast.Error, match='of which 99 cannot be done'):
        holdfast.move(row, continue_=moves.robot(), at=99)
    with pytest.raises(holdfast.Error, match='at: '):
        holdfast.order(tower, continue_=first.robot(), at=-1)
    for wrong in ({'target': up, 'continue_': moves.robot()}, {}, {'target': up, 'at': 1}):
        with pytest.raises(ValueError, match='continue_'):
            holdfast.move(row, **wrong)
    with pytest.raises(ValueError, match='start and continue_'):
        holdfast.order(tower, start=[[0, 0, 0]], continue_=first.robot())


def test_what_a_listener_raises_ends_the_search():
    def refuse(step):
        raise RuntimeError(f'no more after {sorted(step)}')
    cube = Robot([[x, y, z] for x in range(3) for y in range(3) for z in range(3)])
    with pytest.raises(RuntimeError, match='no more after'):
        holdfast.order(cube, parallel='all', on_step=refuse)
    with pytest.raises(RuntimeError, match='no more after'):
        holdfast.move(Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]]),
                      Robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]]), on_step=refuse)


def test_modules_are_kept_and_cells_avoided():
    row = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    bend = Robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]])
    assert len(holdfast.move(row, bend).steps) == 1
    around = holdfast.move(row, bend, keep=[[0, 0, 0], [1, 0, 0]], avoid=[[2, 0, 1]])
    assert {to for (_, to, _), in around.steps}.isdisjoint({(2, 0, 1)})
    assert len(around.steps) == 2 and replayed(around.robot()) == replayed(bend)
    with pytest.raises(holdfast.Error, match='to be kept, and the target has no such'):
        holdfast.move(row, bend, keep=[[2, 0, 0]])
    tower = Robot([[0, 0, z] for z in range(4)])
    for reverse in (False, True):
        found = holdfast.order(tower, keep=[[0, 0, 0], [0, 0, 1]], reverse=reverse)
        assert found.start.tolist() == [[0, 0, 0], [0, 0, 1]] and len(found.batches) == 2
    with pytest.raises(holdfast.Error, match='to be kept, but no module is there'):
        holdfast.order(tower, keep=[[1, 0, 0]])


def test_the_robot_finds_the_exact_verdict_itself(root):
    for name in ('arm_breaks_a', 'arm_breaks_b', 'crane_tips_b'):
        robot = holdfast.load(root / f'scenarios/{name}.json')
        run = robot.simulate(link='unit')
        assert run.verdict is run.exact.verdict is robot.check().verdict
        if len(run.load_ratios) and run.verdict is not Verdict.UNSTABLE:
            # Reals travel as binary32.
            assert run.load_ratios == pytest.approx(run.exact.connections['load_ratio'], abs=1e-4)
        assert run.numbers['all_agree'] and run.numbers['packets'] > 0
        assert run.numbers == robot.simulate(link='unit').numbers
        assert json.loads(run.json())['distributed'] and run.text() and '<svg' in run.svg()


def test_every_method_is_described_and_finds_the_verdict(root):
    text = (root / 'docs/distributed.md').read_text()
    table = text[text.index('| `--method` |'):].split('\n\n')[0].splitlines()[2:]
    methods = [row.split('`')[1] for row in table]
    assert set(methods) == {'elimination', 'fronts', 'polynomial'}
    robot = Robot([[x, y, 0] for x in range(3) for y in range(3)], planned=[[1, 1, 1]])
    with pytest.raises(holdfast.Error) as caught:
        robot.simulate(method='guess')
    for method in methods:
        assert f'``{method}``' in Robot.simulate.__doc__ and method in str(caught.value)
        run = robot.simulate(link='unit', method=method)
        assert run.verdict is run.exact.verdict is Verdict.SAFE


def test_answers_are_copied_as_they_never_change():
    robot = Robot([[0, 0, 0], [1, 0, 0]], planned=[[0, 0, 1]])
    for answer in (robot.simulate(link='unit'), robot.check(), robot.next(), holdfast.order(robot),
                   holdfast.steps(robot), holdfast.move(Robot([[0, 0, 0], [1, 0, 0]]),
                                                        Robot([[0, 0, 0], [0, 0, 1]]))):
        for again in (copy.copy(answer), copy.deepcopy(answer), copy.deepcopy([answer])[0]):
            assert type(again) is type(answer)
            assert again.json() == answer.json() and again.text() == answer.text()


def test_events_happen_to_the_robot(root):
    robot = holdfast.load(root / 'scenarios/arm_breaks_a.json')
    silent = robot.simulate(link='unit', events=[('kill', 1, robot.cells[4])])
    assert silent.verdict is Verdict.UNDECIDED
    grown = robot.simulate(link='unit', events=[('plan', 200, np.array([1, 1, 3]))])
    assert grown.exact.robot.planned.tolist()[-1] == [1, 1, 3]
    noisy = robot.simulate(noise={'loss': 0.05, 'jitter': 0.001}, seed=7)
    assert noisy.verdict is noisy.exact.verdict and noisy.numbers['lost_packets'] > 0
    for options in ({'link': 'v3'}, {'method': 'guess'}, {'noise': {'loud': 1.0}},
                    {'noise': {'loss': 2.0}}, {'events': [('jump', 1, (0, 0, 0))]},
                    {'events': [('kill', -1, robot.cells[0])]}, {'events': [('kill', 1)]},
                    {'events': [('kill', 1, (99, 0, 0))]},
                    {'events': [('cut', 1, robot.cells[0], 'up')]}):
        with pytest.raises(holdfast.Error):
            robot.simulate(**options)


def test_emulation_says_what_it_needs(tmp_path):
    """With firmware the emulator's own tests are run; here: clear words without."""
    with pytest.raises(holdfast.Error, match='Unicorn|firmware|no such|image'):
        Robot([[0, 0, 0]]).emulate(image=tmp_path / 'absent.elf')


def test_steps_with_unknown_keys_are_refused():
    for plan in ([{'add': [[0, 0, 1]]}], [{'attach': [[0, 0, 1]], 'speed': 3}]):
        with pytest.raises(holdfast.Error, match='unknown'):
            holdfast.steps(Robot([[0, 0, 0]]), plan)
    with pytest.raises(holdfast.Error, match='/steps/0'):
        holdfast.steps(Robot([[0, 0, 0]]), [{'attach': 3}])


def test_a_plan_of_its_own_keeps_masses_and_loads():
    heavy = Robot([[0, 0, 0], [0, 0, 1]], planned=[[1, 0, 1]], masses={(1, 0, 1): 2.0})
    assert heavy.check().verdict == holdfast.Verdict.UNSTABLE
    assert heavy.planning([[-1, 0, 0], [1, 0, 1]]).planning(heavy.planned).check() \
        .verdict == holdfast.Verdict.UNSTABLE
    assert heavy.planning([[1, 0, 0]]).check().verdict == holdfast.Verdict.SAFE
    with pytest.raises(holdfast.Error, match='mass or a kind'):
        holdfast.steps(heavy, [{'attach': [[1, 0, 1]]}])
    loaded = Robot([[0, 0, 0], [0, 0, 1]], planned=[[1, 0, 1]], loads={(1, 0, 1): (0, 0, -20)})
    assert holdfast.steps(loaded, [{'attach': [[1, 0, 1]]}]).verdict \
        == holdfast.steps(loaded).verdict == holdfast.Verdict.UNSTABLE
    assert loaded.planning([]).check().verdict == holdfast.Verdict.SAFE
    assert holdfast.steps(loaded, [{'attach': [[0, 0, 2]]}]).verdict == holdfast.Verdict.SAFE


def test_loads_move_and_leave_with_their_modules():
    robot = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]], loads={(2, 0, 0): (0, 0, -1)})
    plan = [{'move': [{'from': (2, 0, 0), 'to': (1, 0, 1)}]}, {'detach': [(1, 0, 1)]}]
    steps = holdfast.steps(robot, plan)
    from holdfast._pictures import states
    _, moved, left = states(steps.robot)
    assert moved.check().load_ratio_max == pytest.approx(steps.stages['load_ratio_max'][0, 2])
    assert 'loads' not in left.json()
    holdfast.animate(holdfast.order(robot))


def test_steps_of_a_large_robot_are_certified_unless_all_are_to_be_exact():
    plan = holdfast.order(holdfast.generate('tower', 30)).robot()
    certified, exact = holdfast.steps(plan), holdfast.steps(plan, exact=True)
    assert certified.verdict is exact.verdict is Verdict.SAFE
    assert exact.load_ratio_bound is None
    assert exact.load_ratio_max <= certified.load_ratio_bound + 1e-4
    assert np.isnan(certified.stages['load_ratio_max'][1:]).any()
    np.testing.assert_allclose(certified.stages['margin_mm'], exact.stages['margin_mm'], atol=1e-6)
    assert not np.isnan(exact.stages['load_ratio_max'][1:]).any()


def test_places_that_nobody_has_judged_are_counted():
    robot = Robot([[0, 0, 0], [1, 0, 0]])
    known, none = robot.next(), robot.next(seconds=0)
    assert known.open_count == 0 and len(known) > 0
    assert len(none) == 0 and none.open_count >= len(known)
    large = holdfast.generate('cube', 15)
    certified, exact = large.next(), large.next(exact=True)
    assert np.isnan(certified.candidates['load_ratio_max']).all()
    assert not np.isnan(exact.candidates['load_ratio_max']).any()
    assert len(certified.safe) == len(exact.safe)


def test_a_bound_is_no_load_ratio():
    order = holdfast.order(Robot([[0, 0, 0], [-1, 0, 0]], planned=[[0, -1, 0], [0, -2, 0]],
                                 fixed=[[0, 0, 0]]))
    found = order.judgements['load_ratio_max'][1:]
    exact = holdfast.steps(order.robot()).stages['load_ratio_max'][:, 2]
    known = ~np.isnan(found)
    assert known.any()
    assert found[known] == pytest.approx(exact[known], rel=1e-6)


def test_tables_have_the_numbers_of_the_arrays_and_pages_their_texts():
    robot = Robot([[0, 0, 0], [0, 0, 1], [1, 0, 1]], name='<small>')
    places, order = robot.next(), holdfast.order(robot)
    judged = holdfast.steps(order.robot())
    moves = holdfast.move(Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]]),
                          Robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]]))
    rows = list(csv.DictReader(places.csv().splitlines()))
    assert [[int(row[axis]) for axis in 'xyz'] for row in rows] == places.candidates[
        'cell'].tolist()
    assert [float(row['margin_mm']) for row in rows] == places.candidates['margin_mm'].tolist()
    rows = list(csv.DictReader(order.csv().splitlines()))
    assert [[int(row[axis]) for axis in 'xyz'] for row in rows] == [
        cell for batch in order.batches for cell in batch.tolist()]
    rows = list(csv.DictReader(judged.csv().splitlines()))
    assert len(rows) == judged.stages.size and {row['verdict'] for row in rows} == {'safe'}
    rows = list(csv.DictReader(moves.csv().splitlines()))
    assert len(rows) == len(moves.steps) > 0
    for answer, pictures in ((places, 1), (order, 2), (judged, 2), (moves, 2)):
        page = answer.html()
        assert page.count('<svg') == pictures and '<small>' not in page
        assert all(html.escape(line) in page for line in answer.text().splitlines())

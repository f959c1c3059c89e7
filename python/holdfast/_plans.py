# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What may come next: places for a module, steps, orders, moves."""
from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _core
from ._answers import Moves, Order, Places, Steps
from ._figures import FileAbsent, Path
from ._given import Cell, Cells, reading
from ._plan_failures import PlanQuestions, asked_of
from ._progress import Progress, told
from ._robot import Robot, read_robot

if TYPE_CHECKING:
    from typing_extensions import Unpack

OnStep = Optional[Callable[[dict[str, Any]], object]]
"""What is called with each step of a plan, as a dictionary."""


def _robot(source: Union[Robot, Path], unsaid: Optional[str] = None) -> Robot:
    return source if isinstance(source, Robot) else read_robot(source, reading(), unsaid)


def next_places(robot: Union[Robot, Path], *, threads: int = 0, memory: float = 4,
                bonded: bool = False, exact: bool = False, seconds: float = math.inf,
                safety_factor: Optional[float] = None, progress: Progress = None,
                **questions: Unpack[PlanQuestions]) -> Places:
    """Where may the next module go? See `Robot.next`.

    Most places of robots of more than 3,000 modules are certified by a bound of the load ratio;
    `exact` finds it for all. The search ends after `seconds`: places that nobody has judged by then
    are left out, and `Places.open_count` says how many. `progress` is called with (places judged,
    of how many).

    >>> robot = Robot([[0, 0, 0], [1, 0, 0]])
    >>> next_places(robot)
    <holdfast.Places: 8 of 8 safe>
    """
    return _robot(robot).next(threads=threads, memory=memory, bonded=bonded, exact=exact,
                              seconds=seconds, safety_factor=safety_factor, progress=progress,
                              **questions)


def _motions(given: Union[Path, None]) -> str:
    name = os.fsdecode(given or '')
    if name not in ('', 'pivoting', 'catoms3D') and not os.path.exists(name):
        raise FileAbsent(f'{name}: no such file')
    return name


def steps(robot: Union[Robot, Path], plan: Optional[Sequence[Mapping[str, Any]]] = None, *,
          threads: int = 0, memory: float = 4, ends_when_unsafe: bool = False,
          exact: bool = False, motions: Union[Path, None] = None,
          safety_factor: Optional[float] = None, progress: Progress = None,
          **questions: Unpack[PlanQuestions]) -> Steps:
    """Is every stage of every step safe?

    `plan` is a list of steps as in holdfast JSON, ``[{'attach': [...]}, {'move': [{'from': ...,
    'to': ...}]}]``; without it the robot's own steps are judged. `progress` is called with (steps
    judged, of how many). `exact` solves every stage, also of robots of more than 256 modules: of
    these most stages of steps that only attach, or only detach, are certified by a bound.
    `motions`, as of `move`, are those that every move must be one of.
    `safety_factor`: as of `Robot.check`. With `PlanQuestions` every stage is also asked how sure it
    is (`Steps.reliability`), and what follows if a part is lost (`Steps.lose_one`).

    >>> tower = Robot([[0, 0, 0], [1, 0, 0]])
    >>> steps(tower, [{'attach': [[0, 0, 1]]}, {'attach': [[0, 0, 2], [0, 0, 3]]}])
    <holdfast.Steps: 2 steps, safe>
    >>> steps(tower, [{'attach': [[0, 0, 1]]}], scatter=0.1, lose_one=True).lose_one.holds_all
    False
    """
    start = _robot(robot, unsaid='holdfast steps judges all')
    if plan is not None:
        start = start.with_steps(plan)
    if safety_factor is not None:
        start = start.with_safety_factor(safety_factor)
    with told(progress, 'steps', is_counted=True) as tell:
        judged: Steps = Steps._of(
            _core.steps(start._held, threads, memory, ends_when_unsafe, exact,
                        _motions(motions), asked_of('steps', questions), tell))
    judged.robot = start
    return judged


def _step(line: str) -> dict[str, Any]:
    step: dict[str, Any] = json.loads(line)
    return step


def _expect_at(plan: Union[Robot, Path, None], at: Optional[int]) -> None:
    if at is not None and plan is None:
        raise ValueError('at: expected continue_ beside it, the plan whose steps are done')


def order(target: Union[Robot, Path], *, start: Optional[Cells] = None,
          continue_: Union[Robot, Path, None] = None, at: Optional[int] = None,
          reach: str = 'free', source: Optional[Cell] = None, avoid: Optional[Cells] = None,
          keep: Optional[Cells] = None, group: int = 1, parallel: Union[int, str] = 1,
          pieces: bool = False, reverse: bool = False, exact: bool = False, seed: int = 0,
          seconds: float = 300, help_seconds: float = 0, threads: int = 0,
          safety_factor: Optional[float] = None, progress: Progress = None,
          on_step: OnStep = None, **questions: Unpack[PlanQuestions]) -> Order:
    """In which order can a robot be built so that it is safe all the way?

    Parameters
    ----------
    target
        The robot to build, planned modules included.
    start
        Cells of the modules that are there at first; else the fixed modules, or one that the search
        chooses.
    `continue_`, at
        A plan to go on with, as of `Order.robot`, or a file: its last steps are kept as far as they
        are safe (`Order.kept_count`). `at` of its steps are done, and `target` is the robot that it
        was made for; without `at` `target` is the robot as it is now.
    reach, source
        How a module gets to its cell: ``free``, any cell; ``line``, a straight way in; ``surface``,
        sliding along the robot from `source`.
    avoid
        Cells that bar these ways and carry nothing.
    keep
        Cells of modules that no step attaches or detaches: they are there at first, and to the end.
    group
        Modules that are attached at the same instant at most, 1 to 16: states in between are not
        judged.
    parallel
        Modules that each step attaches at most, or ``'all'`` that can come: the robot is safe in
        whatever order they arrive.
    pieces
        Modules may also come on the ground away from the others: the robot grows in pieces, each
        of which is judged by itself.
    reverse
        Take the robot apart, from the target to the start.
    exact
        Solve every state exactly, the default up to 256 modules: then
        `Order.load_ratio_max` is the largest of all. Else most are certified by a bound.
    seconds, help_seconds
        Give up after this time; where there is no order, seek the least help for so long. None is
        sought by itself, as the command does for 10 s: whoever asks for many orders need not wait.
    safety_factor
        As of `Robot.check`.
    progress
        Called with (states, modules now, modules at the furthest state).
    on_step
        Called with a dictionary for the ``start`` of an order that is found and for each of its
        steps, the keys of ``holdfast order --stream``, as soon as it is certified and will not be
        taken back: early with `parallel`, else when the search ends. What it raises ends the
        search.
    questions
        `PlanQuestions` of the order that is found: `Order.reliability` and `Order.lose_one`.

    >>> order(Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1]]))
    <holdfast.Order found: 2 steps>
    """
    _expect_at(continue_, at)
    if continue_ is not None and start is not None:
        raise ValueError('start and continue_: expected one of them')
    plan = None if continue_ is None else _robot(continue_)._asked(safety_factor)
    ways = {'reach': reach, 'source': source, 'avoid': avoid, 'keep': keep}
    listener = None if on_step is None else lambda line: on_step(_step(line))
    with told(progress, 'order') as tell:
        found: Order = Order._of(_core.order(_robot(target)._asked(safety_factor), start, plan, at,
                                             ways, group, parallel, pieces, reverse, exact, seed,
                                             seconds, help_seconds, threads,
                                             asked_of('order', questions), tell, listener))
    return found


def move(start: Union[Robot, Path], target: Union[Robot, Path, None] = None, *,
         continue_: Union[Robot, Path, None] = None, at: Optional[int] = None,
         pivots: bool = False, motions: Union[Path, None] = None, within: Optional[Cells] = None,
         avoid: Optional[Cells] = None, keep: Optional[Cells] = None,
         ignores_mechanics: bool = False, seed: int = 0, seconds: float = 300, threads: int = 0,
         safety_factor: Optional[float] = None, progress: Progress = None, on_step: OnStep = None,
         **questions: Unpack[PlanQuestions]) -> Moves:
    """How does a robot get from one shape to another, module by module?

    `motions`: those that a module has, ``'pivoting'`` (cubes that turn about edges; `pivots` says
    the same), ``'catoms3D'``, or a file. `within`: two cells, the corners of a box
    that modules stay in. `avoid`: cells that no module enters or sweeps. `keep`: cells of modules
    that do not move. `safety_factor`: as of `Robot.check`. `progress` is called with (moves
    judged, moves to the target at least). `PlanQuestions` are asked of the plan that is found:
    `Moves.reliability` and `Moves.lose_one`.

    `continue_` instead of `target`: a plan to go on with, as of `Moves.robot`, or a file. Its last
    steps are kept as far as they are safe (`Moves.kept_count`). `at` of its steps are done, and
    `start` is the robot that it was made for; without `at` `start` is the robot as it is now.

    `on_step` is called with a dictionary for each step of a plan that is found, the keys of
    ``holdfast move --stream``, when the search ends.

    >>> row = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    >>> moves = move(row, Robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]]), avoid=[[2, 0, 1]])
    >>> moves
    <holdfast.Moves found: 2 steps>
    >>> move(row, continue_=moves.robot(), at=1)
    <holdfast.Moves found: 1 step>
    """
    if pivots and motions is not None:
        raise ValueError('pivots and motions: expected one of them')
    _expect_at(continue_, at)
    end = target if continue_ is None else continue_
    if end is None or (target is not None and continue_ is not None):
        raise ValueError('target and continue_: expected one of them')
    if on_step is not None and ignores_mechanics:
        raise ValueError('on_step and ignores_mechanics: steps that need not be safe are not told')
    motion_name = 'pivoting' if pivots else _motions(motions)
    ways = {'within': within, 'avoid': avoid, 'keep': keep}
    with told(progress, 'move') as tell:
        found: Moves = Moves._of(_core.move(_robot(start)._asked(safety_factor),
                                            _robot(end)._asked(safety_factor),
                                            continue_ is not None, at, motion_name, ways,
                                            ignores_mechanics, seed, seconds, threads,
                                            asked_of('move', questions), tell))
    if on_step is not None:
        for line in found._held.lines().splitlines()[:-1]:
            on_step(_step(line))
    return found

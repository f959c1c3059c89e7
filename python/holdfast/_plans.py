# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What may come next: places for a module, steps, orders, moves."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._figures import Drawn, Path
from ._progress import Progress, told
from ._robot import Cell, Cells, Robot, Table, counted
from ._verdict import VERDICTS, Judged, Name, Verdict


class Stage(Name):
    """The three stages of a step (Sec. II-B)."""

    RELEASE = 'release'
    SHIFT = 'shift'
    CONNECT = 'connect'


class Outcome(Name):
    """What came of a search."""

    FOUND = 'found'
    NONE = 'none'
    """There is none, which is proved."""
    NOT_FOUND = 'not-found'
    """Time ran out, or undecided states are in the way."""


class _Sought:
    """What came of a search. It has no truth value: a search may find nothing and prove nothing."""

    __slots__ = ()

    @property
    def outcome(self) -> Outcome:
        raise NotImplementedError

    @property
    def is_found(self) -> bool:
        """Whether the outcome is FOUND."""
        return self.outcome is Outcome.FOUND

    def __bool__(self) -> bool:
        raise TypeError(f'a {type(self).__name__} is neither true nor false; '
                        'ask for its is_found or its outcome')


def _robot(source: Union[Robot, Path]) -> Robot:
    return source if isinstance(source, Robot) else Robot.from_file(source)


class _Texts:
    """What has a report for people and one for programs."""

    __slots__ = ('_held',)

    _held: Any

    @classmethod
    def _of(cls, core: Any) -> Any:
        made = cls.__new__(cls)
        made._held = core
        return made

    def text(self) -> str:
        """The report for people."""
        text: str = self._held.text()
        return text

    def json(self) -> str:
        """The report as JSON; keys are in docs/formats.md."""
        text: str = self._held.json()
        return text

    @property
    def seconds(self) -> float:
        """How long it took."""
        seconds: float = self._held.seconds
        return seconds

    def __str__(self) -> str:
        return self.text()

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: Any) -> Any:
        return self


class Places(_Texts, Drawn):
    """Where the next module may go: every free cell beside a robot, judged."""

    __slots__ = ()

    _held: _core.Places

    @property
    def robot(self) -> Robot:
        """The robot without the next module."""
        return Robot._of(self._held.structure)

    @property
    def candidates(self) -> Table:
        """Best first: safe ones by ascending load ratio, then undecided, overload, unstable.

        Fields: ``cell`` (3), ``verdict`` (0 safe, 1 overload, 2 unstable, 3 undecided),
        ``load_ratio_max`` and ``margin_mm`` (NaN where none is known, or only a bound).
        """
        return self._held.candidates

    @property
    def safe(self) -> npt.NDArray[np.int32]:
        """Cells of the safe places, best first: (k, 3)."""
        candidates = self.candidates
        cells: npt.NDArray[np.int32] = candidates['cell'][candidates['verdict'] == 0]
        return cells

    @property
    def open_count(self) -> int:
        """The number of places of which nothing is known, as time ended the search."""
        return self._held.open_count

    def _drawn(self, asked: _core.Figure) -> str:
        """With a ghost in every place."""
        return self._held.svg(asked)

    def __len__(self) -> int:
        return len(self._held.candidates)

    def __repr__(self) -> str:
        return f'<holdfast.Places: {len(self.safe)} of {len(self)} safe>'


def next_places(robot: Union[Robot, Path], *, threads: int = 0, memory: float = 4,
                bonded: bool = False, exact: bool = False, seconds: float = math.inf,
                safety_factor: Optional[float] = None, progress: Progress = None) -> Places:
    """Where may the next module go? See `Robot.next`.

    Most places of robots of more than 3,000 modules are certified by a bound of the load ratio;
    `exact` finds it for all. The search ends after `seconds`: places that nobody has judged by then
    are left out, and `Places.open_count` says how many. `progress` is called with (places judged,
    of how many).

    >>> robot = Robot([[0, 0, 0], [1, 0, 0]])
    >>> next_places(robot)
    <holdfast.Places: 8 of 8 safe>
    """
    with told(progress, 'next', is_counted=True) as tell:
        places: Places = Places._of(
            _core.next(_robot(robot)._asked(safety_factor), threads, memory, bonded, exact,
                       seconds, tell))
    return places


class State(Drawn):
    """The robot after a step, or at the start."""

    __slots__ = ('_judged', '_step')

    def __init__(self, judged: _core.Steps, step: Optional[int]) -> None:
        self._judged = judged
        self._step = step

    def _drawn(self, asked: _core.Figure) -> str:
        return self._judged.state_svg(self._step, asked)


class Strip(Drawn):
    """The robot at the start and after each step, side by side."""

    __slots__ = ('_judged',)

    def __init__(self, judged: _core.Steps) -> None:
        self._judged = judged

    def _drawn(self, asked: _core.Figure) -> str:
        return self._judged.strip_svg(asked)


class Steps(_Texts, Judged, Drawn):
    """A sequence of steps, each judged at its three stages (Sec. II-B)."""

    __slots__ = ('robot',)

    _held: _core.Steps
    robot: Robot
    """The robot at the start, with its steps."""

    @property
    def verdict(self) -> Verdict:
        """SAFE, UNDECIDED, or that of the first unsafe stage."""
        return VERDICTS[self._held.verdict]

    @property
    def stages(self) -> Table:
        """What each stage was found to be: (steps, 3), release, shift, connect.

        Fields: ``verdict`` (0 safe, 1 overload, 2 unstable, 3 undecided), ``load_ratio_max``,
        ``margin_mm`` (NaN where none is known; a load ratio that is only proved not to exceed a
        bound counts in `load_ratio_bound` alone).
        """
        return self._held.stages

    @property
    def first_unsafe(self) -> Optional[tuple[int, Stage]]:
        """The first step, from 0, that is overloaded or unstable, and its stage."""
        return _stage(self._held.first_unsafe)

    @property
    def first_undecided(self) -> Optional[tuple[int, Stage]]:
        """The first undecided one before that."""
        return _stage(self._held.first_undecided)

    @property
    def load_ratio_max(self) -> Optional[float]:
        """The largest load ratio of all stages that were solved (Eq. 17)."""
        return self._held.load_ratio_max

    @property
    def load_ratio_bound(self) -> Optional[float]:
        """What no stage exceeds, where some are certified by a bound; None if all were solved."""
        return self._held.load_ratio_bound

    @property
    def margin_min_mm(self) -> Optional[float]:
        """The smallest margin of all stages, mm."""
        return self._held.margin_min_mm

    def _drawn(self, asked: _core.Figure) -> str:
        """The verdicts as a band, load ratio and margin below."""
        return self._held.svg(asked)

    def state(self, step: Optional[int]) -> State:
        """The robot after a step, from 0, or at the start, with its picture."""
        return State(self._held, step)

    def strip(self) -> Strip:
        """The start and the robot after each step side by side, up to 24 of them."""
        return Strip(self._held)

    def html(self) -> str:
        """A page with the picture and the report."""
        return self._held.html()

    def save_vtk(self, path: Path) -> None:
        """Writes a series for ParaView: a .pvd file, and a .vtu file for each state beside it."""
        self._held.save_vtk(path)

    def __len__(self) -> int:
        return len(self._held.stages)

    def __repr__(self) -> str:
        return f'<holdfast.Steps: {counted(len(self), "step")}, {self.verdict.value}>'


def _stage(place: Optional[tuple[int, int]]) -> Optional[tuple[int, Stage]]:
    return None if place is None else (place[0], tuple(Stage)[place[1]])


def steps(robot: Union[Robot, Path], plan: Optional[Sequence[Mapping[str, Any]]] = None, *,
          threads: int = 0, memory: float = 4, ends_when_unsafe: bool = False,
          exact: bool = False, safety_factor: Optional[float] = None,
          progress: Progress = None) -> Steps:
    """Is every stage of every step safe?

    `plan` is a list of steps as in holdfast JSON, ``[{'attach': [...]}, {'move': [{'from': ...,
    'to': ...}]}]``; without it the robot's own steps are judged. `progress` is called with (steps
    judged, of how many). `exact` solves every stage, also of robots of more than 256 modules: of
    these most stages of steps that only attach, or only detach, are certified by a bound.
    `safety_factor`: as of `Robot.check`.

    >>> tower = Robot([[0, 0, 0], [1, 0, 0]])
    >>> steps(tower, [{'attach': [[0, 0, 1]]}, {'attach': [[0, 0, 2], [0, 0, 3]]}])
    <holdfast.Steps: 2 steps, safe>
    """
    start = _robot(robot)
    if plan is not None:
        start = start.with_steps(plan)
    if safety_factor is not None:
        start = start.with_safety_factor(safety_factor)
    with told(progress, 'steps', is_counted=True) as tell:
        judged: Steps = Steps._of(
            _core.steps(start._held, threads, memory, ends_when_unsafe, exact, tell))
    judged.robot = start
    return judged


class Order(_Texts, _Sought):
    """An order in which a robot can be built, or taken apart, safe all the way."""

    __slots__ = ()

    _held: _core.Order

    @property
    def outcome(self) -> Outcome:
        """FOUND, NONE (proved), NOT_FOUND."""
        return Outcome(self._held.outcome)

    @property
    def start(self) -> npt.NDArray[np.int32]:
        """Cells of the modules that are there at first, or are left behind: (n, 3)."""
        return self._held.start

    @property
    def batches(self) -> list[npt.NDArray[np.int32]]:
        """Cells of the modules that each step attaches, or detaches: (k, 3) each."""
        return self._held.batches

    @property
    def judgements(self) -> Table:
        """Of the start and of the state after each step, in the order of the steps.

        Fields: ``verdict``, ``load_ratio_max``, ``margin_mm`` (NaN where none is known; a load
        ratio that is only proved not to exceed a bound counts in `load_ratio_bound` alone).
        """
        return self._held.judgements

    @property
    def state_count(self) -> int:
        """States judged in all."""
        return self._held.state_count

    @property
    def load_ratio_max(self) -> Optional[float]:
        """The largest load ratio of all states on the way that were solved."""
        return self._held.load_ratio_max

    @property
    def load_ratio_bound(self) -> Optional[float]:
        """What no state on the way exceeds."""
        return self._held.load_ratio_bound

    @property
    def margin_min_mm(self) -> Optional[float]:
        """The smallest margin on the way, mm."""
        return self._held.margin_min_mm

    @property
    def help(self) -> Optional[dict[str, npt.NDArray[np.int32]]]:
        """Where there is no order: ``supports`` or ``temporary`` modules that would suffice."""
        return self._held.help

    def robot(self) -> Robot:
        """The start with the order as its steps, for `steps`; of NOT_FOUND as far as it got.

        Error: no step was found.
        """
        return Robot._of(self._held.as_steps())

    def certificate(self) -> str:
        """What proves that there is no order; ``holdfast steps --verify FILE`` replays it."""
        return self._held.certificate()

    def __repr__(self) -> str:
        return f'<holdfast.Order {self.outcome.value}: {counted(len(self.batches), "step")}>'


def order(target: Union[Robot, Path], *, start: Optional[Cells] = None, reach: str = 'free',
          source: Optional[Cell] = None, avoid: Optional[Cells] = None, group: int = 1,
          reverse: bool = False,
          exact: bool = False, seed: int = 0, seconds: float = 300, help_seconds: float = 0,
          threads: int = 0, safety_factor: Optional[float] = None,
          progress: Progress = None) -> Order:
    """In which order can a robot be built so that it is safe all the way?

    Parameters
    ----------
    target
        The robot to build, planned modules included.
    start
        Cells of the modules that are there at first; else the fixed modules, or one that the search
        chooses.
    reach, source
        How a module gets to its cell: ``free``, any cell; ``line``, a straight way in; ``surface``,
        sliding along the robot from `source`.
    avoid
        Cells that bar these ways and carry nothing.
    group
        Modules that are attached at the same instant at most, 1 to 16: states in between are not
        judged.
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

    >>> order(Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1]]))
    <holdfast.Order found: 2 steps>
    """
    with told(progress, 'order') as tell:
        found: Order = Order._of(_core.order(_robot(target)._asked(safety_factor), start,
                                             reach, source, avoid, group, reverse, exact, seed,
                                             seconds, help_seconds, threads, tell))
    return found


class Moves(_Texts, _Sought):
    """Moves from one shape to another, safe at every stage."""

    __slots__ = ()

    _held: _core.Moves

    @property
    def outcome(self) -> Outcome:
        """FOUND, NONE (proved), NOT_FOUND."""
        return Outcome(self._held.outcome)

    @property
    def steps(self) -> list[list[tuple[Cell, Cell, Optional[Cell]]]]:
        """The moves of each step: from, to, carrier."""
        return self._held.steps

    @property
    def is_shortest(self) -> bool:
        """Whether it is proved that no plan has fewer steps."""
        return self._held.is_shortest

    @property
    def length_min(self) -> int:
        """No plan has fewer steps than this."""
        return self._held.length_min

    @property
    def assignment_bound(self) -> int:
        """Moves of the cheapest assignment of modules to cells of the target; a lower bound."""
        return self._held.assignment_bound

    @property
    def state_count(self) -> int:
        """Moves judged in all."""
        return self._held.state_count

    def robot(self) -> Robot:
        """The start with the moves as its steps, for `steps`."""
        return Robot._of(self._held.as_steps())

    def __repr__(self) -> str:
        return f'<holdfast.Moves {self.outcome.value}: {counted(len(self.steps), "step")}>'


def move(start: Union[Robot, Path], target: Union[Robot, Path], *, pivots: bool = False,
         within: Optional[Cells] = None, ignores_mechanics: bool = False, seed: int = 0,
         seconds: float = 300, threads: int = 0, safety_factor: Optional[float] = None,
         progress: Progress = None) -> Moves:
    """How does a robot get from one shape to another, module by module?

    `pivots`: modules are cubes that turn about edges. `within`: two cells, the corners of a box
    that modules stay in. `safety_factor`: as of `Robot.check`. `progress` is called with (moves
    judged, moves to the target at least).

    >>> row = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    >>> move(row, Robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]]))
    <holdfast.Moves found: 1 step>
    """
    with told(progress, 'move') as tell:
        found: Moves = Moves._of(_core.move(_robot(start)._asked(safety_factor),
                                            _robot(target)._asked(safety_factor), pivots,
                                            within, ignores_mechanics, seed, seconds, threads,
                                            tell))
    return found

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What is found of places, steps, orders and moves."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core
from ._figures import Drawn, Path
from ._given import Cell, Table, counted
from ._maker import robot_of
from ._plan_failures import PlanAnswers, StageId
from ._verdict import VERDICTS, Judged, Name, Stage, Verdict

if TYPE_CHECKING:
    from ._robot import Robot


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

    _held: Any

    @property
    def outcome(self) -> Outcome:
        """FOUND, NONE (proved), NOT_FOUND."""
        return Outcome(self._held.outcome)

    @property
    def is_found(self) -> bool:
        """Whether the outcome is FOUND."""
        return self.outcome is Outcome.FOUND

    def __bool__(self) -> bool:
        raise TypeError(f'a {type(self).__name__} is neither true nor false; '
                        'ask for its is_found or its outcome')


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

    def csv(self) -> str:
        """A table; columns are in docs/formats.md."""
        text: str = self._held.csv()
        return text

    def html(self) -> str:
        """A page with pictures and the report."""
        text: str = self._held.html()
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
        return robot_of(self._held.structure)

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
    def reliability(self) -> npt.NDArray[np.float64]:
        """For each candidate the probability that every connection holds; NaN where it is not
        known, or was not asked for, as of places that are not safe by themselves."""
        return np.array(self._held.failures[0], dtype=float)

    @property
    def lose_one(self) -> list[Optional[str]]:
        """For each candidate the first loss that brings it down, such as ``(0,0,0)-(1,0,0)``; None
        where none does, or none was tried."""
        return self._held.failures[1]

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


def _stage(place: Optional[tuple[int, int]]) -> Optional[StageId]:
    return None if place is None else (place[0], tuple(Stage)[place[1]])


class _Judgements(PlanAnswers):
    """What has the extremes of all its states: the stages of steps, or what an order passes."""

    __slots__ = ()

    @property
    def load_ratio_max(self) -> Optional[float]:
        """The largest load ratio of all states that were solved (Eq. 17)."""
        ratio: Optional[float] = self._held.load_ratio_max
        return ratio

    @property
    def load_ratio_bound(self) -> Optional[float]:
        """What no state exceeds, where some are certified by a bound; None if all were solved."""
        bound: Optional[float] = self._held.load_ratio_bound
        return bound

    @property
    def margin_min_mm(self) -> Optional[float]:
        """The smallest margin of all states, mm."""
        margin: Optional[float] = self._held.margin_min_mm
        return margin


class Steps(_Texts, _Judgements, Judged, Drawn):
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
    def first_unsafe(self) -> Optional[StageId]:
        """The first step, from 0, that is overloaded or unstable, and its stage."""
        return _stage(self._held.first_unsafe)

    @property
    def first_undecided(self) -> Optional[StageId]:
        """The first undecided one before that."""
        return _stage(self._held.first_undecided)

    def _drawn(self, asked: _core.Figure) -> str:
        """The verdicts as a band, load ratio and margin below."""
        return self._held.svg(asked)

    def state(self, step: Optional[int]) -> State:
        """The robot after a step, from 0, or at the start, with its picture."""
        return State(self._held, step)

    def strip(self) -> Strip:
        """The start and the robot after each step side by side, up to 24 of them."""
        return Strip(self._held)

    def save_vtk(self, path: Path) -> None:
        """Writes a series for ParaView: a .pvd file, and a .vtu file for each state beside it."""
        self._held.save_vtk(path)

    def __len__(self) -> int:
        return len(self._held.stages)

    def __repr__(self) -> str:
        return f'<holdfast.Steps: {counted(len(self), "step")}, {self.verdict.value}>'


class Order(_Texts, _Judgements, _Sought):
    """An order in which a robot can be built, or taken apart, safe all the way."""

    __slots__ = ()

    _held: _core.Order

    @property
    def start(self) -> npt.NDArray[np.int32]:
        """Cells of the modules that are there at first, or are left behind: (n, 3)."""
        return self._held.start

    @property
    def batches(self) -> list[npt.NDArray[np.int32]]:
        """Cells of the modules that each step attaches, or detaches: (k, 3) each."""
        return self._held.batches

    @property
    def steps_least(self) -> Optional[int]:
        """With ``parallel``: from this start nothing takes fewer steps."""
        return self._held.steps_least

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
    def help(self) -> Optional[dict[str, Any]]:
        """Where there is no order: ``supports`` or ``temporary`` modules that would suffice.

        Or, where only the ways bar it, another ``source``, or the ``reach`` with which there is
        one. Cells are (n, 3); ``reach`` is None where it has no part. ``pieces``: whether there is
        an order with pieces.
        """
        return self._held.help

    @property
    def kept_count(self) -> Optional[int]:
        """Where a plan is gone on with: how many of its steps are the last ones; else None."""
        return self._held.kept_count

    def robot(self) -> Robot:
        """The start with the order as its steps, for `steps`; of NOT_FOUND as far as it got.

        Error: no step was found.
        """
        return robot_of(self._held.as_steps())

    def certificate(self) -> str:
        """What proves that there is no order; ``holdfast steps --verify FILE`` replays it."""
        return self._held.certificate()

    def __repr__(self) -> str:
        return f'<holdfast.Order {self.outcome.value}: {counted(len(self.batches), "step")}>'


class Moves(_Texts, PlanAnswers, _Sought):
    """Moves from one shape to another, safe at every stage."""

    __slots__ = ()

    _held: _core.Moves

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

    @property
    def kept_count(self) -> Optional[int]:
        """Where a plan is gone on with: how many of its steps are the last ones; else None."""
        return self._held.kept_count

    def robot(self) -> Robot:
        """The start with the moves as its steps, for `steps`."""
        return robot_of(self._held.as_steps())

    def __repr__(self) -> str:
        return f'<holdfast.Moves {self.outcome.value}: {counted(len(self.steps), "step")}>'

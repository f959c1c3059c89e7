# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How sure a plan is, and whether it holds whatever single part is lost."""
from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional, TypedDict

from ._verdict import Stage

StageId = tuple[int, Stage]
"""A step, from 0, and its stage."""


class PlanQuestions(TypedDict, total=False):
    """What is also asked of every stage of a plan, and of every place for the next module.

    The keyword arguments of `Robot.next`, `next_places`, `steps`, `order` and `move` that say it.
    """

    scatter: Optional[float]
    """As of `Report.reliability`, and so are the next three."""
    common: float
    law: Optional[str]
    mass: Optional[float]
    probability: float
    """What holds with less is named by ``first_below``; a place with less is not safe."""
    lose_one: bool
    """Whether every single loss is tried, as by `Robot.lose_one`."""
    parts: Sequence[str]
    """Which parts are lost: ``connection``, ``module``, ``foot``."""
    lose_seconds: float
    """Losses of one stage, or one place, that are not judged after this time are undecided."""


class PlanReliability(NamedTuple):
    """How sure it is that every connection holds at every stage of a plan."""

    probability_min: Optional[float]
    """The least of all stages; None if one is not known."""
    least: Optional[StageId]
    """The stage that has it."""
    first_below: Optional[StageId]
    """The first stage that holds with less than the probability that is asked for,"""
    first_unknown: Optional[StageId]
    """or may."""


class PlanLosses(NamedTuple):
    """Whether every stage of a plan holds whatever single part is lost."""

    holds_all: bool
    first_fatal: Optional[StageId]
    """The first stage that a loss brings down,"""
    fatal: Optional[str]
    """which is this one, such as ``(0,0,0)-(1,0,0)``."""
    first_undecided: Optional[StageId]
    """The first stage of which that is not known."""


def asked_of(what: str, given: PlanQuestions) -> dict[str, Any]:
    """The questions that are asked; TypeError for others, as of every function."""
    for key in given:
        if key not in PlanQuestions.__annotations__:
            raise TypeError(f'{what}() got an unexpected keyword argument {key!r}')
    return {key: value for key, value in given.items() if value is not None and value is not False}


class PlanAnswers:
    """What has the answers to `PlanQuestions` over all its stages."""

    __slots__ = ()

    _held: Any

    def _answer(self, key: str) -> Optional[dict[str, Any]]:
        found: Optional[dict[str, Any]] = json.loads('{' + self._held.failures + '}').get(key)
        for name, value in (found or {}).items():
            if isinstance(value, dict) and found:
                found[name] = (value['step'], Stage(value['stage']))
        return found

    @property
    def reliability(self) -> Optional[PlanReliability]:
        """How sure it is; None if that was not asked, or no plan was found."""
        found = self._answer('reliability')
        return None if found is None else PlanReliability(**found)

    @property
    def lose_one(self) -> Optional[PlanLosses]:
        """Whether it holds whatever is lost; None if that was not asked, or no plan was found."""
        found = self._answer('lose_one')
        return None if found is None else PlanLosses(**found)

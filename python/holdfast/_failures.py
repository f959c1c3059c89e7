# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How sure a report is, what follows if a part is lost, and what follows the break."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Mapping, NamedTuple, Optional, Union

from . import _core


class Reliability(NamedTuple):
    """The probability that every connection holds where strengths scatter."""

    probability_holds: Optional[float]
    """None if the robot is not known to stay where it is, or no load is known."""
    probability_fails: Optional[float]
    """One less that, with all its digits where it is small."""
    probability_low: Optional[float]
    """At least this, by the range of load ratios."""
    probability_high: Optional[float]
    """At most this."""
    strength_cv: float
    """The largest of all connections."""
    common_cv: float
    mass_cv: float
    """The largest of all modules; 0 where masses do not scatter."""
    distribution: str
    likeliest: list[dict[str, Any]]
    """At most ten connections: ``a``, ``b``, ``load_ratio``, ``share`` of the cases."""
    samples: int
    """How many samples of masses were taken."""
    samples_with_other_states: int
    """In how many of them facets are in other states."""
    strength_factor_99: Optional[float]
    """With all strengths times this they hold with probability 0.99."""
    strength_factor_99_low: Optional[float]
    """At least this, with 95 %, by the samples of masses; itself without."""
    strength_factor_99_high: Optional[float]
    """At most this; None if samples are too few to say."""
    strength_factor_999: Optional[float]
    """The same for 0.999, and so are the next two."""
    strength_factor_999_low: Optional[float]
    strength_factor_999_high: Optional[float]


class LoseOne(NamedTuple):
    """What follows from the loss of each single part of a robot.

    A loss is a dictionary with ``a`` and ``b`` of a connection, ``module``, or ``foot`` and its
    ``direction``, and with ``verdict``, ``load_ratio_max`` and ``fallen``.
    """

    holds_all: bool
    """Whether it is safe as it is and after each loss."""
    losses: int
    """How many parts there are."""
    fatal: list[dict[str, Any]]
    """Losses that bring it down."""
    undecided: list[dict[str, Any]]
    """Losses of which that is not known."""
    worst: Optional[dict[str, Any]]
    """The loss with the largest load ratio of those after which all is held."""
    bounds: int
    """How many are safe by a bound."""
    checks: int
    """How many took a check."""
    seconds: float


class Cascade(NamedTuple):
    """What follows the break: connections are taken out as they break, and the rest is judged."""

    outcome: str
    """``holds`` (nothing breaks or falls), ``stands`` (something is left), ``falls`` (nothing is)
    or ``undecided``."""
    rounds: list[dict[str, Any]]
    """Each with ``broken``, connections with ``a``, ``b`` and ``load_ratio``, and ``fallen``,
    cells."""
    broken: int
    """How many connections break in all."""
    fallen: int
    """How many modules fall in all."""
    standing: list[list[int]]
    """The cells of the modules that are left."""
    checks: int
    """How many pieces were judged."""


def cascade_of(text: str) -> Cascade:
    return Cascade(**json.loads(text)['cascade'])


def reliability_of(text: str) -> Reliability:
    return Reliability(**json.loads(text)['reliability'])


def lose_one_of(text: str) -> LoseOne:
    return LoseOne(**json.loads(text)['lose_one'])


class Fitted(NamedTuple):
    """A fitted number and its interval at 95 %; None is no value, or no end."""

    value: Optional[float]
    low: Optional[float]
    high: Optional[float]


class Fit(NamedTuple):
    """How strong connections are and how they scatter, by what held and what broke."""

    strength_vertical_n: Fitted
    strength_lateral_n: Fitted
    strength_cv: Fitted
    distribution: str
    log_likelihood: float
    experiments: list[dict[str, Any]]
    """In their order: ``name``, ``probability``, ``place_probability``, ``contradicts``."""
    next: list[dict[str, Any]]
    """Structures that could be built next, the one that tells most first: ``name``,
    ``probability_holds``, ``information_gain``."""
    notes: list[str]
    """Structures that could not be taken, and why."""


def fit(experiments: Union[str, 'os.PathLike[str]', Mapping[str, Any]]) -> Fit:
    """Fits strengths and their scatter to experiments, as ``holdfast fit`` does.

    Parameters
    ----------
    experiments
        A file, or its content as a dictionary without ``format`` and ``version``; files that this
        names are in the working folder then.

    >>> import holdfast
    >>> pulls = [{'pull': 'vertical', 'broke_n': force} for force in (10.5, 12.1, 11.4)]
    >>> round(holdfast.fit({'experiments': pulls}).strength_vertical_n.value, 1)
    11.3
    """
    if isinstance(experiments, Mapping):
        text = json.dumps({'format': 'holdfast-experiments', 'version': 1, **experiments})
        folder = ''
    else:
        text = pathlib.Path(experiments).read_text(encoding='utf-8')
        folder = str(pathlib.Path(experiments).parent)
    found = json.loads(_core.fit(text, folder))
    for key in ('strength_vertical_n', 'strength_lateral_n', 'strength_cv'):
        found[key] = Fitted(**found[key])
    return Fit(**{key: found[key] for key in Fit._fields})

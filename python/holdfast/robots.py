# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of robots that have been built, each figure with where it comes from.

>>> import holdfast
>>> holdfast.robots.names()[0]
'blinky-blocks'
>>> holdfast.robots.get('blinky-blocks').figures['mass_kg'].value
0.06106
"""
from __future__ import annotations

from typing import NamedTuple, Optional

from . import _core


class Figure(NamedTuple):
    """A number of a robot; the unit is in its key."""

    value: Optional[float]
    """None if it was not found."""
    certainty: str
    """``published``, ``project page``, ``second hand``, ``derived`` or ``not found``."""
    source: str
    """Where it comes from, or what is known if there is no value."""


class CatalogueRobot(NamedTuple):
    """A robot of the catalogue; its name is what ``Robot(robot=...)`` takes."""

    name: str
    title: str
    lattice: str
    note: str
    """What to know before the figures are used."""
    figures: dict[str, Figure]
    """By key, as in the material of holdfast JSON."""


CATALOGUE: dict[str, CatalogueRobot] = {
    name: CatalogueRobot(name, title, lattice, note,
                         {key: Figure(value, certainty, source)
                          for key, value, certainty, source in figures})
    for name, title, lattice, note, figures in _core.catalogue()}
"""All robots by name."""


def names() -> list[str]:
    """The names of all robots."""
    return list(CATALOGUE)


def get(name: str) -> CatalogueRobot:
    """The robot of that name; holdfast.Error if there is none."""
    if name not in CATALOGUE:
        raise _core.Error(f"no robot '{name}', there are {', '.join(CATALOGUE)}")
    return CATALOGUE[name]

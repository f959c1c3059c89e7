# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Robots of what the core holds, for reports and plans, which give robots back and are below them.

`Robot` says how it is made when it is defined, so its file may import all others and none of these
has to import it.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    from ._robot import Robot

_makers: list[Callable[[_core.Structure], Robot]] = []


def robots_are(made: Callable[[_core.Structure], Robot]) -> None:
    """Says how a robot is made."""
    _makers.append(made)


def robot_of(core: _core.Structure) -> Robot:
    """The robot of what the core holds."""
    return _makers[0](core)

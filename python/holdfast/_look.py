# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Colours and words of pictures, those of the program's SVG.

tests/pictures_test.py compares both with the SVG.
"""
from __future__ import annotations

import enum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._verdict import Verdict

if TYPE_CHECKING:
    from ._report import Report

Colors = npt.NDArray[np.float64]
"""Red, green and blue in the last axis, 0 to 1."""

INK = '#22262b'
INK_SOFT = '#6a7178'
GROUND_INK = '#3f6b7d'
GROUND_FILL = '#9cc3d1'
GRID_INK = '#d8dee0'
NUMBER_INK = '#8a9299'
BROKEN_INK = '#6b0a14'
WORST_INK = '#a50f1d'
PAYLOAD_INK = '#101418'
GRAVITY_INK = '#4a4f9c'
PLANNED_FILL = '#b9bfc4'
CARD = '#fdfdfb'

PLANNED_ALPHA = 0.7
OBSTACLE_ALPHA = 0.35

VERDICT_INKS = {Verdict.SAFE: '#1e7a3a', Verdict.OVERLOAD: WORST_INK,
                Verdict.UNSTABLE: '#8e4db2', Verdict.UNDECIDED: '#5a6066'}
BAND_INKS = {Verdict.SAFE: '#6fae7d', Verdict.OVERLOAD: '#d1495b', Verdict.UNSTABLE: '#8e5aa8',
             Verdict.UNDECIDED: '#b9bfc4'}

NO_LOAD = 0.005
"""Load ratios below this read as 0.00; which connection is the worst then is but rounding."""

PLANNED_WORDS = 'planned module'
POLYGON_WORDS = 'support polygon'
MASS_WORDS = 'centre of mass'
PAYLOAD_WORDS = 'payload'
SCALE_WORDS = "share of the connection's strength"


class Meaning(enum.Enum):
    """What a module's colour says; the value is its words in a legend."""

    LOAD = SCALE_WORDS
    BROKEN = 'a connection breaks (1 or more)'
    FIXED = 'fixed module'
    UNSTABLE = 'unstable robot'
    UNKNOWN = 'loads not known'


MEANING_COLORS = {Meaning.BROKEN: (214, 32, 43), Meaning.FIXED: (58, 123, 200),
                  Meaning.UNSTABLE: (142, 77, 178), Meaning.UNKNOWN: (165, 170, 176)}
OBSTACLE_COLORS = {False: (128, 138, 146), True: MEANING_COLORS[Meaning.FIXED]}
OBSTACLE_WORDS = {False: 'obstacle', True: 'obstacle, bonded'}
OBSTACLES_TOO_MANY_WORDS = 'obstacles, too many to be drawn'

FACET_LOOKS = {'presses': ('facet pressed', '#17708f'),
               'tilts': ('facet tilts: on its thick edge or corner', '#c26a00'),
               'open': ('facet open', '#6b0a14'),
               'bonded': ('facet bonded', '#2f63a5'),
               'unknown': ('facet that touches', '#6a7178')}
"""By state: words and colour."""
FACETS_FILLED = ('presses', 'bonded', 'unknown')

_STOPS = ((0, (62, 166, 88)), (50, (242, 218, 78)), (100, (240, 138, 36)))


def load_colors(ratios: npt.ArrayLike) -> Colors:
    """Green, yellow, orange: of load ratios from 0 to 1."""
    shares = np.clip(np.asarray(ratios, dtype=float), 0, 1) * 100
    places = [stop[0] for stop in _STOPS]
    channels = [np.interp(np.floor(shares + 0.5), places, [stop[1][k] for stop in _STOPS])
                for k in range(3)]
    colors: Colors = np.floor(np.stack(channels, axis=-1) + 0.5) / 255
    return colors


def shaded(colors: Colors, normals: npt.NDArray[np.float64]) -> Colors:
    """Colours of faces by their normals: light falls from above and from the left."""
    percent = np.rint(normals @ np.array([-22.0, 4.0, 14.0]))[..., None] / 100
    shades: Colors = np.where(percent > 0, colors + (1 - colors) * percent, colors * (1 + percent))
    return shades


def lightened(colors: Colors, percent: float) -> Colors:
    """Mixed with white."""
    light: Colors = colors + (1 - colors) * percent / 100
    return light


def has_loads(report: Report) -> bool:
    """Whether the report says what every connection carries."""
    count = len(report.connections)
    return count == len(report.robot.connections) and (
        count > 0 or report.verdict is not Verdict.UNDECIDED)


def meanings(report: Report) -> list[Meaning]:
    """What each module's colour says, in the robot's order."""
    modules = report.robot.modules
    if report.verdict is Verdict.UNSTABLE:
        return [Meaning.UNSTABLE] * len(modules)
    out = [Meaning.UNKNOWN] * len(modules)
    if has_loads(report):
        pairs = report.robot.connections
        is_unknown = np.zeros(len(modules), dtype=bool)
        strange = np.isnan(report.connections['load_ratio'])
        is_unknown[pairs['a'][strange]] = is_unknown[pairs['b'][strange]] = True
        out = [Meaning.UNKNOWN if unknown else Meaning.LOAD for unknown in is_unknown]
        for connection in report.broken:
            for end in (pairs['a'][connection], pairs['b'][connection]):
                out[int(end)] = Meaning.BROKEN
    for fixed in np.flatnonzero(modules['support'] == 2):
        out[int(fixed)] = Meaning.FIXED
    return out


def module_colors(report: Report, said: list[Meaning]) -> Colors:
    """The colour of each module, (n + m, 3); planned ones are lighter."""
    colors = load_colors(np.nan_to_num(report.module_load_ratios))
    for meaning, color in MEANING_COLORS.items():
        colors[[one is meaning for one in said]] = np.array(color) / 255
    is_planned = report.robot.modules['is_planned']
    colors[is_planned] = lightened(colors[is_planned], 34)
    return colors

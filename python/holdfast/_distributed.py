# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The robot's own computation: simulated, and as firmware."""
from __future__ import annotations

import os
import pathlib
import sys
from collections.abc import Iterable, Mapping
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from . import _core
from ._figures import Drawn
from ._report import Report
from ._verdict import VERDICTS, Judged, Verdict


class Run(Judged, Drawn):
    """What the modules of a robot came to, beside the exact answer. It never changes."""

    __slots__ = ('_held',)

    _held: _core.Run

    @classmethod
    def _of(cls, core: _core.Run) -> Run:
        run = cls.__new__(cls)
        run._held = core
        return run

    @property
    def verdict(self) -> Verdict:
        """The robot's own; UNDECIDED if it came to none."""
        return VERDICTS[self._held.verdict]

    @property
    def reason(self) -> str:
        """Why, in the words of the modules' protocol."""
        return self._held.reason

    @property
    def exact(self) -> Report:
        """The exact answer, for the robot as it is in the end."""
        return Report._of(self._held.exact)

    @property
    def load_ratio_max(self) -> Optional[float]:
        """The largest load ratio that the robot knows (Eq. 17)."""
        return self._held.load_ratio_max

    @property
    def load_ratios(self) -> npt.NDArray[np.float64]:
        """The robot's own load ratio of each connection; empty if it came to know none."""
        return self._held.load_ratios

    @property
    def numbers(self) -> dict[str, Any]:
        """Rounds, packets, bytes, seconds to the verdict, and the hash of the trace."""
        return self._held.numbers

    @property
    def notes(self) -> list[str]:
        """What to know when comparing with the exact answer."""
        return self._held.notes

    def text(self) -> str:
        """The report for people."""
        return self._held.text()

    def json(self) -> str:
        """The report as JSON; keys are in docs/formats.md."""
        return self._held.json()

    def _drawn(self, asked: _core.Figure) -> str:
        """The robot in the colours of its own load ratios."""
        return self._held.svg(asked)

    def __copy__(self) -> Run:
        return self

    def __deepcopy__(self, memo: Any) -> Run:
        return self

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f'<holdfast.Run {self.verdict.value}, exact {self.exact.verdict.value}>'


def find_image() -> str:
    """The firmware that is installed, or that './dev firmware' has built beside this package."""
    here = pathlib.Path(__file__).resolve().parent
    name = 'module_stm32f0.elf'
    places = [here.parent.parent / 'firmware' / name,
              pathlib.Path(sys.prefix) / 'share/holdfast' / name]
    for place in places:
        if place.is_file():
            return os.fspath(place)
    raise _core.Error("no firmware is there: './dev firmware' builds it, image= says where it is; "
                      f"looked for {', '.join(map(str, places))}")


def events_of(events: Iterable[Any]) -> list[Any]:
    """As the extension takes them."""
    return [tuple(event) for event in events]


def noise_of(noise: Optional[Mapping[str, float]]) -> dict[str, float]:
    """As the extension takes it."""
    if not isinstance(noise, (Mapping, type(None))):
        raise _core.Error('noise: expected a mapping from names to numbers, found '
                          f'{type(noise).__name__}')
    return dict(noise or {})

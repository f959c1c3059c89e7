# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Many robots at once."""
from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from . import _core
from ._given import Table
from ._progress import Progress, told
from ._report import Report, expect
from ._robot import Robot


def check_many(robots: Iterable[Robot], *, threads: int = 0, memory: float = 4,
               bonded: bool = False, progress: Progress = None) -> list[Report]:
    """Checks robots, several at a time, each as `Robot.check` does; reports in their order.

    `progress` is called with (robots checked, of how many).

    >>> reports = check_many(Robot([[0, 0, z] for z in range(height)]) for height in (1, 2, 3))
    >>> [report.verdict.name for report in reports]
    ['SAFE', 'SAFE', 'SAFE']
    """
    cores = []
    for robot in robots:
        expect(robot, Robot, 'robots')
        cores.append(robot._held)
    with told(progress, 'check', is_counted=True) as tell:
        checks = _core.check_many(cores, threads, memory, bonded, tell)
    return [Report._of(check) for check in checks]


def table(reports: Sequence[Report]) -> Table:
    """The reports' main numbers, one row each.

    Fields: ``verdict`` (0 safe, 1 overload, 2 unstable, 3 undecided), ``load_ratio_max`` (Eq. 17),
    ``margin_mm``, ``weight_factor`` (NaN where none is known), ``modules``, ``seconds``.

    >>> table([Robot([[0, 0, 0]]).check()])['modules']
    array([1])
    """
    rows = np.empty(len(reports), dtype=[('verdict', 'u1'), ('load_ratio_max', 'f8'),
                                         ('margin_mm', 'f8'), ('weight_factor', 'f8'),
                                         ('modules', 'i8'), ('seconds', 'f8')])
    for index, report in enumerate(reports):
        expect(report, Report, 'reports')
        rows[index] = report._held.row
    return rows

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Will a modular robot hold when modules are attached?

>>> import holdfast
>>> report = holdfast.Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1]], planned=[[1, 0, 1]]).check()
>>> report.verdict.name
'SAFE'
>>> report.connections['load_ratio'].shape
(4,)

Verdicts with margins and loads after Piranda et al., IEEE T-RO 37(6), 2021; equations are counted
as there. Units: N, mm, kg, s. Cells are VisibleSim's triples, z up.
"""
from . import _core, robots
from ._answers import Moves, Order, Outcome, Places, Steps
from ._core import Error
from ._distributed import Run
from ._failures import Cascade, Fit, Fitted, LoseOne, Reliability, fit
from ._figures import FileAbsent, RobotWarning
from ._many import check_many, table
from ._page import PageNotFound
from ._pictures import animate, plot_order, plot_steps
from ._plan_failures import PlanLosses, PlanQuestions, PlanReliability
from ._plans import move, next_places, order, steps
from ._report import Remedies, Report, Timings
from ._robot import Robot, families, foreign_formats, generate, load
from ._verdict import Stage, Verdict

Error.__module__ = PageNotFound.__module__ = 'holdfast'
FileAbsent.__module__ = RobotWarning.__module__ = 'holdfast'
Error.__doc__ = 'A robot, a file or an option is not as it may be; one line says what and where.'

__version__ = _core.version()

__all__ = ['Cascade', 'Error', 'FileAbsent', 'Fit', 'Fitted', 'LoseOne', 'Moves', 'Order',
           'Outcome', 'PageNotFound', 'Places', 'PlanLosses', 'PlanQuestions', 'PlanReliability',
           'Reliability', 'Remedies', 'Report', 'Robot', 'RobotWarning', 'Run', 'Stage', 'Steps',
           'Timings', 'Verdict', 'animate', 'check_many', 'families', 'fit',
           'foreign_formats', 'generate', 'load', 'move', 'next_places', 'order', 'plot_order',
           'plot_steps', 'robots', 'steps', 'table']

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What a check has found."""
from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from . import _core, _geometry
from ._failures import Reliability, reliability_of
from ._figures import Drawn, Path
from ._given import Table
from ._maker import robot_of
from ._optional import need
from ._progress import Progress, told
from ._verdict import VERDICTS, Judged, Verdict

if TYPE_CHECKING:
    from ._robot import Robot


def expect(given: object, kind: type, what: str) -> None:
    """Raises TypeError for anything else."""
    if not isinstance(given, kind):
        raise TypeError(f'{what}: expected {kind.__name__}, found {type(given).__name__}')


class Timings(NamedTuple):
    """Seconds: of the check, and what proof and limit load took beyond it."""

    check: float
    proof: float
    limit: float


class Remedies(NamedTuple):
    """Single changes with which a robot is safe, by kind, each the best first.

    Fields of the tables: ``cell`` (3), ``verdict``, ``load_ratio_max``, ``margin_mm`` with the
    change.
    """

    module: Table
    """One more module in a cell."""
    prop: Table
    """An obstacle in a cell, below a module."""
    fixing: Table
    """The module in a cell is fixed to the environment."""
    removal: Table
    """The module in a cell is taken away."""
    strength_factor: Optional[float]
    """With all connections stronger by this factor it is safe; None if that does not do."""
    tried: dict[str, int]
    """How many changes of each kind were judged."""


class Report(Judged, Drawn):
    """The verdict on a robot, and everything that it rests on. It never changes.

    Arrays are views of what the solver found: nothing is copied, and they keep it alive.
    """

    __slots__ = ('_held',)

    _held: _core.Check

    @classmethod
    def _of(cls, core: _core.Check) -> Report:
        report = cls.__new__(cls)
        report._held = core
        return report

    @property
    def robot(self) -> Robot:
        """What was checked."""
        return robot_of(self._held.structure)

    @property
    def verdict(self) -> Verdict:
        """SAFE, OVERLOAD, UNSTABLE or UNDECIDED."""
        return VERDICTS[self._held.verdict]

    @property
    def reasons(self) -> list[str]:
        """Why, in sentences; the first decides."""
        return self._held.reasons

    @property
    def load_ratio_max(self) -> Optional[float]:
        """The largest load ratio; breaks at 1 or more (Eq. 17). None if none is known."""
        return self._held.load_ratio_max

    @property
    def weight_factor(self) -> Optional[float]:
        """By which all loads could grow before the first connection breaks."""
        return self._held.weight_factor

    @property
    def worst(self) -> Optional[int]:
        """The index of the connection with the largest load ratio; None if none is pulled."""
        return self._held.worst

    @property
    def broken(self) -> list[int]:
        """Indices of connections at 1 or more, worst first."""
        return self._held.broken

    @property
    def connections(self) -> Table:
        """What every connection carries in its middle (Eqs. 16-17), by connection.

        Fields: ``load_ratio``, ``axial_n`` (N, tension positive), ``bending_nmm`` (N mm),
        ``shear_n`` (N), ``torsion_nmm`` (N mm). Empty where no equilibrium is known.
        """
        return self._held.connections

    @property
    def limits(self) -> list[str]:
        """What each load ratio is of: ``opens``, ``slips``, ``shears`` or ``twists``."""
        return self._held.limits

    @property
    def displacements(self) -> Table:
        """How far every module moves (Eq. 13), in `Robot.modules`' order.

        Fields: ``translation_mm`` (3), ``rotation_rad`` (3), global frame.
        """
        return self._held.displacements

    @property
    def facet_forces(self) -> Table:
        """What each facet does to its module, about its node, in `Robot.facets`' order.

        Fields: ``force_n`` (3), ``moment_nmm`` (3), global frame (Eqs. 6-12).
        """
        return self._held.facet_forces

    @property
    def pieces(self) -> list[dict[str, Any]]:
        """Each piece of a robot that is in several, the worst first; else empty.

        Keys: ``modules`` (how many), ``first`` (the cell of one), ``verdict``, ``load_ratio_max``
        and ``margin_mm``, None where they are not known. Each is judged by itself; the report's
        verdict is the worst one's, its loads are those of all.
        """
        return [{'modules': count, 'first': first, 'verdict': Verdict(verdict),
                 'load_ratio_max': ratio, 'margin_mm': margin}
                for count, first, verdict, ratio, margin in self._held.pieces]

    @property
    def contacts(self) -> Table:
        """How each facet touches: ``is_pressed``, ``tilt_x``, ``tilt_y`` (signs; Eqs. 9-12)."""
        return self._held.contacts

    @property
    def ground_forces(self) -> Table:
        """What the ground does to every module, in `Robot.modules`' order.

        Fields: ``force_n`` (3), ``moment_nmm`` (3) about the module's centre.
        """
        return self._held.ground_forces

    def remedies(self, *, threads: int = 0, memory: float = 4, bonded: bool = False,
                 progress: Progress = None) -> Remedies:
        """What would make the robot hold: single changes, each judged by a check.

        The options are those of the check; `progress` is called with (changes judged, of how many).

        >>> from holdfast import Robot
        >>> crane = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1]] +
        ...               [[x, 0, 2] for x in range(6)])
        >>> crane.check().remedies().module['cell'].tolist()
        [[2, 0, 1], [1, 0, 1]]
        """
        with told(progress, 'remedies', is_counted=True) as tell:
            found = _core.remedies(self._held, threads, memory, bonded, tell)
        factor = found.pop('strength_factor')
        module, prop, fixing, removal = (
            found[kind][0] for kind in ('module', 'prop', 'fixing', 'removal'))
        return Remedies(module, prop, fixing, removal, factor,
                        {kind: tried for kind, (_, tried) in found.items()})

    def reliability(self, scatter: Optional[float] = None, *, common: float = 0,
                    law: Optional[str] = None, mass: Optional[float] = None) -> Reliability:
        """How sure it is that every connection holds, where strengths and masses scatter.

        Parameters
        ----------
        scatter
            Standard deviation over mean of each strength by itself, 0.1 for 10 %; None: as the
            robot's ``strength_cv``.
        common
            That of a factor that all strengths share.
        law
            Their distribution: ``lognormal``, ``normal`` or ``weibull``; None: as the robot states,
            or lognormal.
        mass
            That of each module's mass; None: as the robot's ``mass_cv``.

        >>> from holdfast import Robot
        >>> bar = Robot([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], fixed=[[0, 0, 0]])
        >>> bar.check().reliability(0.1).distribution
        'lognormal'
        """
        return reliability_of(_core.reliability(self._held, scatter, common, law, mass))

    @property
    def module_load_ratios(self) -> npt.NDArray[np.float64]:
        """For each module the largest load ratio of its connections; NaN without any."""
        modules = np.full(len(self.robot), np.nan)
        if len(self.connections):
            ratios = self.connections['load_ratio']
            pairs = self._held.structure.connections
            np.fmax.at(modules, pairs['a'], ratios)
            np.fmax.at(modules, pairs['b'], ratios)
        return modules

    @property
    def stability(self) -> dict[str, Any]:
        """Whether it stands: Sec. III-B and III-C, and the rigid body with supports anywhere.

        Keys: ``is_stable``, ``margin_mm``, ``centre_of_mass_mm``, ``polygon_mm``, ``edge_mm``,
        ``is_stable_by_model``, ``rigid``, ``friction_needed``, ``tilt_margin_deg``, ``motion``.
        """
        return self._held.stability

    @property
    def contact_model(self) -> str:
        """Where the forces come from: ``none``, ``bonded``, ``regularised`` or ``unilateral``."""
        return self._held.contact_model

    @property
    def limit_load(self) -> Optional[dict[str, Any]]:
        """The factor beyond which no forces balance: ``outcome``, ``low``, ``high``.

        The outcome is found, unbounded or stopped; ``high`` is None where none is known. None if it
        was not computed.
        """
        return self._held.limit_load

    @property
    def second_order(self) -> Optional[dict[str, Any]]:
        """Whether linear theory suffices: ``trusted`` (None where that is not certain).

        ``buckling_factor`` (None where it is above the bound ``buckling_factor_above``, or there is
        none), ``elastic_modulus_needed_mpa``, ``mode``, ``load_ratio_max`` to second order and
        more, by the keys of the JSON report. None where nothing holds the robot.
        """
        return self._held.second_order

    @property
    def deformed(self) -> Optional[dict[str, Any]]:
        """The equilibrium in the deformed shape, by the keys of the JSON report.

        ``factor_critical``, ``kind`` and ``events`` of the path, an array ``path`` of it with the
        columns factor, load_ratio_max and displacement_max_mm, and the state at the loads; with
        ``follow=True``, where stability is lost, also ``behind``, of whose branches ``path`` has
        the column stable besides. None without ``check(deformed=True)``, or where the robot topples
        unbent.
        """
        found: Optional[dict[str, Any]] = json.loads(self.json()).get('deformed')
        if found is not None:
            found['path'] = np.array([[point['factor'], point['load_ratio_max'],
                                       point['displacement_max_mm']] for point in found['path']])
            for branch in found.get('behind', []):
                branch['path'] = np.array([[point['factor'], point['load_ratio_max'],
                                            point['displacement_max_mm'], point['stable']]
                                           for point in branch['path']])
        return found

    @property
    def timings(self) -> Timings:
        """Seconds."""
        return Timings(*self._held.seconds)

    def certificate(self) -> str:
        """The proof of the largest load ratio, for holdfast-checker, of ``check(proof=True)``."""
        return self._held.certificate()

    def text(self) -> str:
        """The report for people: the verdict, why, and the worst connections."""
        name = self._held.structure.name
        return f'{self.verdict.name}  {name}'.rstrip() + '\n' + self._held.text()

    def json(self) -> str:
        """The report as JSON; keys are in docs/formats.md."""
        return self._held.json()

    def csv(self) -> str:
        """A table of the connections."""
        return self._held.csv()

    def _drawn(self, asked: _core.Figure) -> str:
        return self._held.svg(asked)

    def plot(self, axes: Any = None, *, title: Optional[str] = None, legend: bool = True) -> Any:
        """Draws the robot in space, in the colours and with the legend of the SVG.

        Parameters
        ----------
        axes
            Axes of matplotlib with ``projection='3d'``; by default a figure of their own. Their
            unit is mm, and their frame the robot's.
        title
            By default the robot's name.

        Returns the axes. Needs python3-matplotlib.
        """
        need('matplotlib', 'report.plot()')
        from ._picture import plot
        return plot(self, axes, title, legend)

    def page(self) -> str:
        """The page with the robot and the report in it: one HTML text that needs no network.

        `PageNotFound` says where the page was looked for, if it is not built.
        """
        from ._page import filled
        return filled(self)

    def show(self, *, height: int = 640) -> None:
        """Shows the page, where the robot can be turned and changed: in a notebook in the cell's
        output, which takes 2 MB there, elsewhere in the browser."""
        from ._page import show
        show(self, height)

    def to_networkx(self) -> Any:
        """The graph of `Robot.to_networkx`, each edge with what its connection carries.

        Edges have the fields of ``connections``. Needs python3-networkx.
        """
        return _geometry.loaded_graph(self)

    def to_vtk(self) -> Any:
        """The grid of ``save_vtu`` as a ``vtkUnstructuredGrid``. Needs python3-vtk9."""
        need('vtkmodules', 'report.to_vtk()')
        from ._vtk import to_vtk
        return to_vtk(self)

    def save(self, path: Path) -> None:
        """Writes what the file's ending says, whole or not at all: the report (``.json``), the
        table of connections (``.csv``), a grid for ParaView (``.vtu``), else the picture
        (``.svg``, ``.png``, ``.pdf``)."""
        self._held.save_by_ending(path)

    def save_json(self, path: Path) -> None:
        """Writes the report, whole or not at all."""
        self._held.save(path, 'json')

    def save_csv(self, path: Path) -> None:
        """Writes the table of connections."""
        self._held.save(path, 'csv')

    def save_svg(self, path: Path) -> None:
        """Writes the picture as SVG; ``save_figure`` has options and writes PNG and PDF, too."""
        _core.expect_ending(path, 'svg')
        _core.write_file(path, self.svg())

    def save_vtu(self, path: Path) -> None:
        """Writes a grid for ParaView."""
        self._held.save(path, 'vtu')

    def __reduce__(self) -> Any:
        return (_unpickled, (self.robot, _core.to_bytes(self._held)))

    def __copy__(self) -> Report:
        return self

    def __deepcopy__(self, memo: Any) -> Report:
        return self

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        ratio = self.load_ratio_max
        known = '' if ratio is None else f', largest load ratio {ratio:.4f}'
        return f'<holdfast.Report {self.verdict.value}{known}>'


def _unpickled(robot: Robot, data: bytes) -> Report:
    return Report._of(_core.from_bytes(robot._held, data))

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Robots, and where they come from."""
from __future__ import annotations

import json
import math
import os
import pathlib
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core, _geometry, _maker
from ._answers import Places
from ._distributed import Run, events_of, find_image, noise_of
from ._failures import Cascade, LoseOne, cascade_of, lose_one_of
from ._figures import Path, Readable, RobotWarning, read_from
from ._given import (Cell, Cells, Table, cell_of, counted, floats, head_of, json_of, level, listed,
                     load_list, obstacle_list, own_parts, reading)
from ._plan_failures import PlanQuestions, asked_of
from ._progress import Progress, told
from ._report import Report

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Robot:
    """A robot with the step that is planned for it. It never changes.

    Cells are VisibleSim's triples (x, y, z), z up; units are N, mm, kg, s.

    >>> robot = Robot([[0, 0, 0], [0, 0, 1], [1, 0, 1]], planned=[[2, 0, 1]])
    >>> robot
    <holdfast.Robot of 3 modules and 1 planned, cubic>
    >>> robot.check().verdict
    <Verdict.UNSTABLE: 'unstable'>

    Parameters
    ----------
    cells
        The existing modules: an (n, 3) array of integers, of any strides, lists, a set or a
        generator.
    planned
        Modules that are attached in the planned step, all at once: (m, 3).
    fixed
        Modules that do not move at all: (k, 3) cells of existing ones, or a mask of n truths.
    lattice
        ``cubic``, ``face-centred``, ``hexagonal`` or ``hexagonal-prism``, or what VisibleSim calls
        its modules, such as ``catoms3D``.
    supports
        The layer z whose modules rest on the floor, or ``lowest``; None: there is no floor; or a
        mapping with
        ``support_z``, ``floor`` and ``obstacles`` of holdfast JSON.
    obstacles
        Cells that the environment occupies: (k, 3) cells, or a list as in holdfast JSON, such as
        ``[{'from': (-1, -3, 0), 'to': (-1, 3, 6), 'hold': 'bonded'}]``.
    masses
        kg: one for each module (n, or n + m), or a mapping from cells.
    kinds, kind_of
        Kinds of modules by name, as in holdfast JSON, and a mapping from cells to names.
    loads
        Payloads: a mapping from cells to a force (3) in N, or a force and a torque (6) in N mm.
    open
        Faces that touch and are not joined: (k, 2, 3), pairs of cells.
    connections
        What single connections hold, as in holdfast JSON, such as
        ``[{'between': [(0, 0, 0), (1, 0, 0)], 'strength_n': 6}]``.
    joined
        ``all``, or ``listed``: the pairs in `connections` alone are joined.
    bodies
        Rigid pieces, such as bricks: (n, 3) cells each, whose connections never part.
    gravity
        Three numbers, m/s^2. By default (0, 0, -9.81).
    material
        What differs from Table I of the paper, keys as in holdfast JSON (``strength_lateral_n``).
    robot
        A robot of `holdfast.robots`, whose figures are the defaults.
    steps
        What happens to the robot, for `holdfast.steps`, as in holdfast JSON.
    """

    __slots__ = ('_held',)

    _held: _core.Structure

    def __init__(self, cells: Cells, *, planned: Optional[Cells] = None, fixed: Any = None,
                 lattice: Optional[str] = None, supports: Any = 0, obstacles: Any = None,
                 masses: Any = None, kinds: Optional[Mapping[str, Any]] = None,
                 kind_of: Optional[Mapping[Cell, str]] = None, loads: Any = None,
                 open: Optional[Iterable[Cells]] = None,
                 connections: Optional[Sequence[Mapping[str, Any]]] = None,
                 joined: Optional[str] = None, bodies: Optional[Iterable[Any]] = None,
                 gravity: Optional[Sequence[float]] = None,
                 material: Optional[Mapping[str, Any]] = None, robot: Optional[str] = None,
                 steps: Optional[Sequence[Any]] = None, name: str = '') -> None:
        if isinstance(cells, (str, bytes, os.PathLike)):
            raise _core.Error('cells: expected an (n, 3) array of integers, a cell in each row, '
                              f'found {cells!r}; holdfast.load reads files')
        cells, planned, fixed = listed(cells), listed(planned), listed(fixed)
        head = head_of({'lattice': lattice and _core.lattice_name(lattice),
                        'obstacles': obstacle_list(obstacles), 'kinds': kinds,
                        'loads': load_list(loads), 'open': listed(open), 'connections': connections,
                        'joined': joined,
                        'bodies': None if bodies is None else [listed(body) for body in bodies],
                        'gravity_m_s2': gravity, 'material': material, 'robot': robot,
                        'steps': steps, 'name': name or None},
                       level(supports, cells))
        self._held = _core.Structure.make(cells, planned, fixed, head,
                                          own_parts(cells, planned, masses, kind_of))

    @classmethod
    def _of(cls, core: _core.Structure) -> Robot:
        robot = cls.__new__(cls)
        robot._held = core
        return robot

    @classmethod
    def from_file(cls, path: Union[Path, Readable], *, lattice: str = '', robot: str = '',
                  allow_unknown: bool = False, supports: Union[int, str, None] = None,
                  pitch: Optional[float] = None,
                  palette: Optional[Mapping[str, Any]] = None) -> Robot:
        """Reads VisibleSim XML, holdfast JSON, version 1 or 2, a binary structure, or a file of
        another program: `foreign_formats` lists them. `path` may be a file object. What is in
        `warnings` is a `RobotWarning` as well.

        `lattice` and `robot` say what the file leaves open. A key of holdfast JSON that is unknown
        is an error, unless it begins with ``x-``; with `allow_unknown` it is ignored and stands in
        `warnings`. `supports` is the layer z whose modules rest on the ground, or ``lowest``,
        whatever the file says; `pitch` the edge of a module in the unit of a mesh; `palette` a
        dictionary of the `kinds` of voxels and of the `palette`, which kind each colour is.
        """
        return read_robot(path, reading(lattice, robot, allow_unknown, supports, pitch, palette))

    @classmethod
    def from_text(cls, text: str, *, name: str = '', lattice: str = '', robot: str = '',
                  allow_unknown: bool = False, supports: Union[int, str, None] = None) -> Robot:
        """Reads what `from_file` reads from a text.

        >>> text = Robot([[0, 0, 0]], name='one').json()
        >>> Robot.from_text(text)
        <holdfast.Robot 'one' of 1 module, cubic>
        """
        return cls._of(_core.Structure.load_text(
            text, name, reading(lattice, robot, allow_unknown, supports)))

    @classmethod
    def from_voxels(cls, voxels: npt.ArrayLike, *, origin: Sequence[int] = (0, 0, 0),
                    **options: Any) -> Robot:
        """Makes a module of every element of voxels[x, y, z] that is not 0.

        Voxel (0, 0, 0) is the cell `origin`; a number of 2 is a planned module, one of 3 a fixed
        one. `options` are those of `Robot`.

        >>> Robot.from_voxels(np.ones((2, 1, 3), dtype=bool))
        <holdfast.Robot of 6 modules, cubic>
        """
        if (shape := floats('origin', origin).shape) != (3,):
            raise _core.Error(f'origin: expected a cell, found the shape {shape}')
        array = np.asarray(voxels)
        if array.ndim != 3 or array.dtype.kind not in 'bui':
            raise _core.Error('voxels: expected truths or integers of three dimensions, found an '
                              f'array of {array.dtype} of shape {array.shape}')
        if array.size and not 0 <= array.min() <= array.max() <= 3:
            raise _core.Error('voxels: expected 0 (nothing), 1 (a module), 2 (a planned one) '
                              f'and 3 (a fixed one), found {array.min()} to {array.max()}')
        places = np.argwhere((array == 1) | (array == 3))
        for value, key in ((2, 'planned'), (3, 'fixed')):
            if (array == value).any() and key in options:
                raise _core.Error(f'voxels: a {value} says what is {key}, and so does the option; '
                                  'expected one of them')
        if (array == 2).any():
            options.setdefault('planned', np.argwhere(array == 2) + np.asarray(origin))
        if (array == 3).any():
            options.setdefault('fixed', array[tuple(places.T)] == 3)
        return cls(places + np.asarray(origin), **options)

    def check(self, *, threads: int = 0, memory: float = 4, bonded: bool = False,
              limit: bool = False, limit_seconds: float = 600, proof: bool = False,
              deformed: bool = False, up_to: float = 2, follow: bool = False,
              safety_factor: Optional[float] = None,
              progress: Progress = None) -> Report:
        """Says whether the robot holds with its planned modules attached (Eqs. 1-17).

        Parameters
        ----------
        threads
            0: as many as the machine has cores. The result does not depend on it.
        memory
            The most for the solver, GB; a robot that needs more is `undecided`.
        bonded
            The ground is treated as glued: supports can neither lift nor tilt.
        limit, limit_seconds
            Also seeks the limit load: the factor beyond which no forces balance.
        proof
            Proves the largest load ratio; a verdict that is not proved becomes `undecided`.
        deformed, up_to
            Judges the equilibrium in the deformed shape, followed up to a factor of all loads.
        follow
            Goes on behind the first loss of stability: ``behind`` of `Report.deformed`.
        safety_factor
            Strengths are divided by this, from 1 to 1000: see `with_safety_factor`.
        progress
            Called with (iteration, error) while a large robot is solved; True: a bar of tqdm's.
        """
        with told(progress, 'check') as tell:
            return Report._of(_core.check(self._asked(safety_factor), threads, memory, bonded,
                                          limit, limit_seconds, proof, deformed, up_to, follow,
                                          tell))

    def lose_one(self, *, parts: Sequence[str] = ('connection', 'module', 'foot'),
                 seconds: float = math.inf, threads: int = 0, memory: float = 4,
                 bonded: bool = False, cascade: bool = False, deformed: bool = False,
                 safety_factor: Optional[float] = None,
                 progress: Progress = None) -> LoseOne:
        """What follows if any single connection, module or foot is lost?

        Losses that are not judged after `seconds` are undecided; `progress` is called with (losses
        judged, of how many). With `cascade` each fatal loss says what follows it; with `deformed`
        all is judged in the deformed shape.

        >>> square = Robot([[x, y, 0] for x in range(2) for y in range(2)])
        >>> square.lose_one(parts=['connection']).holds_all
        True
        """
        with told(progress, 'lose_one', is_counted=True) as tell:
            return lose_one_of(_core.lose_one(self._asked(safety_factor), list(parts), seconds,
                                              threads, memory, bonded, cascade, deformed, tell))

    def cascade(self, *, threads: int = 0, memory: float = 4, bonded: bool = False,
                deformed: bool = False, progress: Progress = None) -> Cascade:
        """What follows the break: which connections break one after another, what falls?

        `progress` is called with (modules that stand, of how many). With `deformed` each piece is
        judged in its deformed shape.

        >>> arm = Robot([[x, 0, 2] for x in range(7)], fixed=[[0, 0, 2]])
        >>> arm.cascade().fallen
        6
        """
        with told(progress, 'cascade', is_counted=True) as tell:
            return cascade_of(_core.cascade(self._held, threads, memory, bonded, deformed,
                                             tell))

    def next(self, *, threads: int = 0, memory: float = 4, bonded: bool = False,
             exact: bool = False, seconds: float = math.inf,
             safety_factor: Optional[float] = None, progress: Progress = None,
             **questions: Unpack[PlanQuestions]) -> Places:
        """Where may the next module go? Judges every free cell beside the robot.

        Most places of robots of more than 3,000 modules are certified by a bound of the load ratio;
        `exact` finds it for all. After `seconds` the search ends with what is judged by then. With
        `PlanQuestions` a place is safe only if the robot with a module there holds with
        ``probability``, or whatever is lost: `Places.reliability`, `Places.lose_one`.

        >>> Robot([[0, 0, 0], [1, 0, 0]]).next().safe.shape
        (8, 3)
        """
        with told(progress, 'next', is_counted=True) as tell:
            places: Places = Places._of(
                _core.next(self._asked(safety_factor), threads, memory, bonded, exact, seconds,
                           asked_of('next', questions), tell))
        return places

    def simulate(self, *, link: str = 'v1', method: str = 'auto', seed: int = 1,
                 noise: Optional[Mapping[str, float]] = None, events: Iterable[Any] = (),
                 progress: Progress = None) -> Run:
        """Lets the robot work its verdict out by itself, in simulation.

        Parameters
        ----------
        link
            ``v1`` and ``v2``: Blinky Blocks; ``catoms``: assumed, as nothing is published;
            ``unit``: rounds of a synchronous network.
        method
            ``auto``: ``elimination`` on a level floor under weight alone, else ``fronts``, which
            takes few sweeps for any loops and contact in modules with more memory; or
            ``polynomial``.
        noise
            Probabilities ``loss``, ``duplication``, ``corruption``, ``reordering``; seconds
            ``jitter``.
        events
            What happens meanwhile: ``('kill', 0.1, cell)``, ``('cut', 0.1, cell, '+x')``,
            ``('detach', ...)``, ``('attach', ...)``, ``('plan', ...)``, ``('withdraw', ...)``;
            times are seconds, or rounds.
        progress
            Called with (events, rounds).

        >>> run = Robot([[0, 0, 0], [1, 0, 0]], planned=[[0, 0, 1]]).simulate(link='unit')
        >>> run.verdict is run.exact.verdict
        True
        """
        with told(progress, 'simulate') as tell:
            return Run._of(_core.simulate(self._held, link, method, seed, noise_of(noise),
                                          events_of(events), tell))

    def emulate(self, *, image: Optional[Path] = None, seed: int = 1, seconds: float = 60,
                events: Iterable[Any] = (), progress: Progress = None) -> Run:
        """Lets the robot work its verdict out as firmware on emulated modules.

        Needs the firmware's image ('./dev firmware'), Unicorn, and a package that was built where
        it is installed. `seconds`: give up after so long on the robot. Events are those of
        `simulate`, but for ``detach``, and ``flip``, ``reset``.
        """
        if not _core.can_emulate():
            raise _core.Error('this package is without Unicorn and cannot emulate; install '
                              "libunicorn2, or libunicorn-dev and build it anew by './dev python'")
        with told(progress, 'emulate') as tell:
            return Run._of(_core.emulate(self._held, image or find_image(), seed,
                                         seconds, events_of(events), tell))

    def with_steps(self, steps: Sequence[Mapping[str, Any]]) -> Robot:
        """The same robot with these steps, as in holdfast JSON, in the place of its own plan.

        >>> Robot([[0, 0, 0]]).with_steps([{'attach': [[0, 0, 1]]}]).step_count
        1
        """
        document = json.loads(self.json())
        own_plan = [document.pop('planned', []), *document.pop('later_steps', [])]
        own = [entry for step in own_plan for entry in step
               if isinstance(entry, dict) and not entry.keys() <= {'cell', 'color', 'attributes'}]
        document.pop('known_answer', None)
        document['version'] = 2
        document['steps'] = list(steps)
        text = json_of(document)
        document = json.loads(text)
        attached = {cell_of(cell) for step in document['steps'] if isinstance(step, dict)
                    and isinstance(step.get('attach'), list) for cell in step['attach']}
        for entry in own:
            if cell_of(entry) in attached:
                raise _core.Error(f'the planned module {cell_of(entry)} has a mass or a kind of '
                                  'its own, which steps cannot say; expected a robot without it')
        there = {cell_of(module) for module in document['modules']} | attached
        document['loads'] = [load for load in document.get('loads', []) if cell_of(load) in there]
        document['bodies'] = [body for body in document.get('bodies', [])
                              if any(cell_of(cell) in there for cell in body)]
        return self.from_text(json_of(document), name=self.name)

    @property
    def step_count(self) -> int:
        """How many steps `holdfast.steps` would judge."""
        return self._held.step_count

    def planning(self, planned: Cells) -> Robot:
        """The same robot with these planned modules in the place of its own.

        >>> Robot([[0, 0, 0]]).planning([[0, 0, 1]])
        <holdfast.Robot of 1 module and 1 planned, cubic>
        """
        return self._of(self._held.with_planned(planned))

    @property
    def safety_factor(self) -> float:
        """What all strengths are divided by; 1 unless its file or `with_safety_factor` says
        otherwise."""
        return self._held.safety_factor

    def with_safety_factor(self, factor: float) -> Robot:
        """The same robot with all strengths divided by a factor: safe is what would be safe under
        all loads times it. Files keep it.

        >>> tower = Robot([[0, 0, 0], [0, 0, 1]]).with_safety_factor(2)
        >>> tower.safety_factor, tower.attached().safety_factor
        (2.0, 2.0)
        """
        return self._of(self._held.with_safety_factor(factor))

    def _asked(self, safety_factor: Optional[float]) -> _core.Structure:
        """What is judged if somebody asks for a safety factor, or for none."""
        return (self._held if safety_factor is None
                else self._held.with_safety_factor(safety_factor))

    def attached(self) -> Robot:
        """The same robot with its planned modules attached.

        >>> Robot([[0, 0, 0]], planned=[[0, 0, 1]]).attached()
        <holdfast.Robot of 2 modules, cubic>
        """
        return self._of(self._held.attached())

    def translated(self, by: Sequence[int]) -> Robot:
        """The same robot with every cell moved by three integers, and the floor with it.

        >>> Robot([[0, 0, 0]]).translated([2, 0, 1]).supports
        1
        """
        return _geometry.translated(self, by)

    def rotated(self, quarters: int = 1) -> Robot:
        """A robot of cubes turned about z by quarters of a turn, from x towards y, with its loads.

        >>> Robot([[0, 0, 0], [1, 0, 0]]).rotated().cells.tolist()
        [[0, 0, 0], [0, 1, 0]]
        """
        return _geometry.rotated(self, quarters)

    def union(self, other: Robot) -> Robot:
        """This robot and another one, of the same lattice and material, as one.

        >>> arm = Robot([[0, 0, 0], [0, 0, 1]])
        >>> arm.union(arm.translated([1, 0, 0]))
        <holdfast.Robot of 4 modules, cubic>
        """
        return _geometry.union(self, other)

    def pieces(self) -> list[Robot]:
        """Each piece of a robot that is in several, as a robot of its own, the largest first.

        >>> [len(piece) for piece in Robot([[0, 0, 0], [1, 0, 0], [5, 0, 0]]).pieces()]
        [2, 1]

        A robot in one piece is the only one.
        """
        return _geometry.pieces(self)

    def largest_piece(self) -> Robot:
        """The piece with the most modules; of equal ones the first.

        >>> Robot([[0, 0, 0], [1, 0, 0], [5, 0, 0]]).largest_piece()
        <holdfast.Robot of 2 modules, cubic>
        """
        return self.pieces()[0]

    def to_networkx(self) -> Any:
        """The modules as a ``networkx.Graph``: nodes are cells, edges connections.

        Nodes have ``mass_kg``, ``support`` (none, touches, fixed) and ``is_planned``. Needs
        python3-networkx.
        """
        return _geometry.graph(self)

    def __contains__(self, cell: object) -> bool:
        """Whether there is a module in a cell, planned ones too."""
        try:
            wanted = np.asarray(cell)
        except ValueError:
            return False
        return wanted.shape == (3,) and bool((self.modules['cell'] == wanted).all(axis=1).any())

    @property
    def name(self) -> str:
        """The file's name, or what it was given."""
        return self._held.name

    @property
    def warnings(self) -> list[str]:
        """What the reader wants its user to know."""
        return self._held.warnings

    @property
    def lattice(self) -> str:
        """Its name: ``cubic``, ``face-centred``, ``hexagonal`` or ``hexagonal-prism``."""
        return self._held.lattice

    @property
    def modules(self) -> Table:
        """All modules, existing ones first, then planned: a view, (n + m,).

        Fields: ``cell`` (3), ``support`` (0 none, 1 touches something, 2 fixed), ``is_planned``,
        ``kind`` (0: of no kind in particular).
        """
        return self._held.modules

    @property
    def cells(self) -> npt.NDArray[np.int32]:
        """Cells of the existing modules: a view, (n, 3)."""
        count = len(self.modules) - self._held.planned_count
        cells: npt.NDArray[np.int32] = self.modules['cell'][:count]
        return cells

    @property
    def planned(self) -> npt.NDArray[np.int32]:
        """Cells of the planned modules: a view, (m, 3)."""
        count = len(self.modules) - self._held.planned_count
        cells: npt.NDArray[np.int32] = self.modules['cell'][count:]
        return cells

    @property
    def connections(self) -> Table:
        """All pairs of connected modules: fields ``a``, ``b`` (indices), ``direction``."""
        return self._held.connections

    @property
    def facets(self) -> Table:
        """All facets that touch something, a view.

        Fields: ``module`` (index), ``direction``, ``hold`` (0 contact, 1 bonded).
        """
        return self._held.facets

    @property
    def directions(self) -> npt.NDArray[np.float64]:
        """The unit vector of each direction of the lattice, (d, 3), global frame."""
        return self._held.directions

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The centres of all modules, mm: (n + m, 3)."""
        return self._held.positions

    @property
    def masses(self) -> npt.NDArray[np.float64]:
        """The masses of all modules, kg: (n + m,)."""
        return self._held.masses

    @property
    def material(self) -> dict[str, float]:
        """Every number of Table I, keys as in holdfast JSON."""
        return self._held.material

    @property
    def facet_half_width_mm(self) -> float:
        """Half the width of a facet that touches something, mm."""
        return self._held.foot_half_width

    @property
    def obstacles(self) -> list[dict[str, Any]]:
        """What the robot may touch besides the floor, as in holdfast JSON."""
        return self._held.obstacles

    @property
    def supports(self) -> Optional[int]:
        """The layer whose modules rest on the floor; None: there is no floor."""
        return self._held.supports

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Three numbers, m/s^2, global frame."""
        x, y, z = self._held.gravity
        return (x, y, z)

    def json(self) -> str:
        """Holdfast JSON: version 1 where that says it all."""
        return self._held.json()

    def visiblesim(self) -> str:
        """VisibleSim XML."""
        return self._held.visiblesim()

    def save(self, path: Path) -> None:
        """Writes holdfast JSON, or VisibleSim XML to a file that ends in .xml."""
        _core.expect_ending(path, 'structure')
        is_xml = os.fsdecode(path).lower().endswith('.xml')
        _core.write_file(path, self.visiblesim() if is_xml else self.json())

    def __len__(self) -> int:
        """How many modules there are, planned ones too."""
        return len(self._held.modules)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Robot):
            return NotImplemented
        return self._held.has_same_document(other._held)

    def __hash__(self) -> int:
        return hash((self.name, len(self)))

    def __reduce__(self) -> Any:
        return (Robot.from_text, (self.json(),), self.name)

    def __setstate__(self, name: str) -> None:
        if name != self.name:
            self._held = _core.Structure.load_text(self.json(), name, reading())

    def __copy__(self) -> Robot:
        return self

    def __deepcopy__(self, memo: Any) -> Robot:
        return self

    def __repr__(self) -> str:
        planned = self._held.planned_count
        count = len(self) - planned
        name = f' {self.name!r}' if self.name else ''
        return (f'<holdfast.Robot{name} of {counted(count, "module")}'
                f'{f" and {planned} planned" if planned else ""}, {self.lattice}>')


_maker.robots_are(Robot._of)


def _text_of(file: Readable) -> tuple[str, str]:
    """What is in a file object, and its name without ending."""
    name = getattr(file, 'name', '')
    content = file.read()
    if not isinstance(content, str):
        try:
            content = content.decode()
        except UnicodeDecodeError:
            raise _core.Error('expected text in UTF-8, found other bytes; what is no text is read '
                              'by its path') from None
    return content, pathlib.Path(name).stem if isinstance(name, str) else ''


def read_robot(source: Union[Path, Readable], how: dict[str, Any],
               unsaid: Optional[str] = None) -> Robot:
    """Reads a robot, and warns of what its reader notes, but for notes that `unsaid` is in."""
    if isinstance(source, Readable):
        robot = Robot._of(_core.Structure.load_text(*_text_of(source), how))
    else:
        with read_from(source):
            robot = Robot._of(_core.Structure.load_file(source, how))
    for text in robot.warnings:
        if unsaid is None or unsaid not in text:
            warnings.warn(text, RobotWarning, stacklevel=3)
    return robot


def load(path: Union[Path, Readable], *, lattice: str = '', robot: str = '',
         allow_unknown: bool = False, supports: Union[int, str, None] = None,
         pitch: Optional[float] = None, palette: Optional[Mapping[str, Any]] = None) -> Robot:
    """Reads a robot, see `Robot.from_file`."""
    return read_robot(path, reading(lattice, robot, allow_unknown, supports, pitch, palette))


def foreign_formats() -> list[dict[str, str]]:
    """The formats of other programs that `load` reads: their name, their endings, what becomes of
    them, and what is lost.

    >>> [row['name'] for row in foreign_formats() if '.vox' in row['endings']]
    ['MagicaVoxel']
    """
    keys = ('name', 'endings', 'content', 'lost')
    return [dict(zip(keys, row)) for row in _core.foreign_formats()]


def generate(family: str, size: int) -> Robot:
    """A structure to begin with, such as an arch or a crane; `families` lists them.

    >>> generate('tower', 2)
    <holdfast.Robot 'tower 2' of 18 modules, cubic>
    """
    return Robot._of(_core.Structure.generate(family, size))


def families() -> dict[str, str]:
    """The families of `generate`, and what their size means.

    >>> 'arm' in families()
    True
    """
    return dict(_core.families())

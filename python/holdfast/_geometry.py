# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Robots from robots: moved, turned, put together; and as graphs."""
from __future__ import annotations

import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import _core
from ._optional import need

if TYPE_CHECKING:
    from ._report import Report
    from ._robot import Robot

Map = Callable[[list[Any]], list[Any]]

_CELLS = ('modules', 'planned', 'later_steps', 'steps', 'loads', 'open', 'connections',
          'bodies', 'obstacles')
"""The keys of holdfast JSON that name cells."""
_VECTORS = ('force_n', 'torque_nmm')


def _is_cell(value: Any) -> bool:
    return (isinstance(value, list) and len(value) == 3
            and all(type(number) is int for number in value))


def _is_box(value: dict[str, Any], key: str) -> bool:
    return 'from' in value and 'to' in value and key != 'move'


def _mapped(value: Any, cell: Map, vector: Map, key: str = '') -> Any:
    """A part of the document with every cell and every vector in its new place."""
    if key in _VECTORS:
        return vector(value)
    if _is_cell(value):
        return cell(value)
    if isinstance(value, list):
        return [_mapped(entry, cell, vector, key) for entry in value]
    if not isinstance(value, dict):
        return value
    made = {name: entry if name in ('attributes', 'color', 'at') else
            _mapped(entry, cell, vector, name) for name, entry in value.items()}
    if _is_box(value, key):
        corners = list(zip(made['from'], made['to']))
        made['from'], made['to'] = [list(map(pick, corners)) for pick in (min, max)]
    return made


def _document(robot: Robot) -> dict[str, Any]:
    """What a robot is, without what another program said of it."""
    document: dict[str, Any] = json.loads(robot.json())
    for key in ('known_answer', 'visiblesim'):
        document.pop(key, None)
    document['version'] = 2
    document.setdefault('support_z', 0)
    return document


def _made(robot: Robot, document: dict[str, Any]) -> Robot:
    return type(robot).from_text(json.dumps(document), name=robot.name)


def translated(robot: Robot, by: Any) -> Robot:
    """See `Robot.translated`."""
    offset = [int(number) for number in by]
    if len(offset) != 3 or offset != list(by):
        raise _core.Error(f'by: expected three integers, found {by!r}')
    if robot.lattice != 'cubic' and offset[2] % 2:
        raise _core.Error(f'by: layers of a {robot.lattice} lattice alternate; expected an even z, '
                          f'found {offset[2]}')
    document = _document(robot)
    for key in _CELLS:
        if key in document:
            document[key] = _mapped(document[key],
                                    lambda cell: [a + b for a, b in zip(cell, offset)], list)
    if document['support_z'] is not None:
        document['support_z'] += offset[2]
    return _made(robot, document)


def _turned(vector: list[Any], quarters: int) -> list[Any]:
    x, y, z = vector
    return [[x, y, z], [-y, x, z], [-x, -y, z], [y, -x, z]][quarters % 4]


def rotated(robot: Robot, quarters: int) -> Robot:
    """See `Robot.rotated`."""
    if robot.lattice != 'cubic':
        raise _core.Error('rotated: expected a robot of cubes, found a lattice that is '
                          f'{robot.lattice}')
    document = _document(robot)
    for key in _CELLS:
        if key in document:
            document[key] = _mapped(document[key], lambda cell: _turned(cell, quarters),
                                    lambda vector: _turned(vector, quarters))
    if 'gravity_m_s2' in document:
        document['gravity_m_s2'] = _turned(document['gravity_m_s2'], quarters)
    return _made(robot, document)


def _cells(robot: Robot) -> set[tuple[int, ...]]:
    return {tuple(cell) for cell in robot.modules['cell'].tolist()}


def union(robot: Robot, other: Robot) -> Robot:
    """See `Robot.union`."""
    mine, theirs = _document(robot), _document(other)
    both = _cells(robot) & _cells(other)
    if both:
        raise _core.Error(f'union: {min(both)} is a cell of both robots; translated() moves one')
    for key in {*mine, *theirs} - {*_CELLS, 'name', 'description', 'kinds'}:
        if mine.get(key) != theirs.get(key):
            raise _core.Error(f'union: expected robots with the same {key}, found '
                              f'{mine.get(key)!r} and {theirs.get(key)!r}')
    for name, kind in theirs.get('kinds', {}).items():
        if mine.setdefault('kinds', {}).setdefault(name, kind) != kind:
            raise _core.Error(f'union: the robots differ in what the kind {name!r} is')
    if any(key in document for document in (mine, theirs) for key in ('steps', 'later_steps')):
        raise _core.Error('union: expected robots without steps; with_steps() adds them')
    for key in _CELLS:
        if key in theirs:
            mine[key] = mine.get(key, []) + theirs[key]
    return _made(robot, mine)


def pieces(robot: Robot) -> list[Robot]:
    """See `Robot.pieces`."""
    parts = robot._held.pieces
    if not parts:
        return [robot]
    document = _document(robot)
    if any(key in document for key in ('steps', 'later_steps')):
        raise _core.Error('pieces: expected a robot without steps, which may concern several')
    cells = robot.modules['cell']
    return [_made(robot, _part(document, {tuple(cell) for cell in cells[part].tolist()}))
            for part in parts]


def _part(document: dict[str, Any], cells: set[tuple[int, ...]]) -> dict[str, Any]:
    """The document of the modules in these cells."""
    def is_in(entry: Any) -> bool:
        if isinstance(entry, dict):
            entry = entry.get('cell', entry.get('between'))
        ends = [entry] if _is_cell(entry) else entry
        return all(tuple(cell) in cells for cell in ends)
    return {key: [entry for entry in value if is_in(entry)]
            if key in ('modules', 'planned', 'loads', 'open', 'connections', 'bodies') else value
            for key, value in document.items()}


def graph(robot: Robot) -> Any:
    """See `Robot.to_networkx`."""
    need('networkx', 'robot.to_networkx()')
    import networkx  # type: ignore[import]
    made = networkx.Graph(name=robot.name)
    rows = robot.modules
    cells = [tuple(cell) for cell in rows['cell'].tolist()]
    for cell, row, mass in zip(cells, rows, robot.masses.tolist()):
        made.add_node(cell, mass_kg=mass, is_planned=bool(row['is_planned']),
                      support=('none', 'touches', 'fixed')[row['support']])
    for pair in robot.connections:
        made.add_edge(cells[pair['a']], cells[pair['b']])
    return made


def loaded_graph(report: Report) -> Any:
    """See `Report.to_networkx`."""
    robot, rows = report.robot, report.connections
    made = graph(robot)
    cells = [tuple(cell) for cell in robot.modules['cell'].tolist()]
    for pair, row in zip(robot.connections, rows):
        edge = made.edges[cells[pair['a']], cells[pair['b']]]
        edge.update((key, float(row[key])) for key in rows.dtype.names or ())
    return made

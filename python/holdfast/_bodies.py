# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What modules look like, by lattice, and what surrounds them. Unit: one pitch from the node."""
from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._robot import Robot

Places = npt.NDArray[np.float64]
"""Points or vectors in the last axis of three."""

Cells = npt.NDArray[np.int32]

OBSTACLE_CELLS_MAX = 100_000
_DISC_DEPTH = 0.5
_TIE = 1e-9


class Face(NamedTuple):
    """A flat face of a convex body."""

    normal: Places
    """Outwards, of length one."""
    corners: Places
    """(k, 3), counter-clockwise from outside."""
    direction: Optional[int]
    """Where the neighbour is that shares the face; None: there is no such direction."""
    is_strip: bool = False
    """A part of something round."""


def _sorted_around(normal: Places, corners: Places) -> Places:
    right = corners[0] - corners.mean(axis=0)
    ways = corners - corners.mean(axis=0)
    return corners[np.argsort(np.arctan2(ways @ np.cross(normal, right), ways @ right))]


def cell_faces(directions: Places) -> list[Face]:
    """The cell of a lattice: what is nearer to a node than to all its neighbours."""
    count = len(directions) // 2 * 2  # A last one without an opposite leads to a floor only.
    spaces: list[tuple[Places, Optional[int]]] = [
        (unit, index) for index, unit in enumerate(directions[:count])]
    if not directions[:, 1].any():  # A single layer, one pitch deep.
        spaces += [(np.array([0.0, side, 0.0]), None) for side in (-1.0, 1.0)]
    normals = np.array([normal for normal, _ in spaces])
    points = []
    for three in itertools.combinations(normals, 3):
        matrix = np.array(three)
        if abs(np.linalg.det(matrix)) > _TIE:
            point = np.linalg.solve(matrix, np.full(3, 0.5))
            if (normals @ point <= 0.5 + _TIE).all():
                points.append(point)
    corners = np.unique(np.round(points, 9), axis=0)
    faces = []
    for normal, index in spaces:
        own = corners[np.abs(corners @ normal - 0.5) < 1e-6]
        if len(own) >= 3:
            faces.append(Face(normal, _sorted_around(normal, own), index))
    return faces


def _disc_faces(corner_count: int = 20) -> list[Face]:
    """A standing cylinder along y."""
    angles = 2 * np.pi * np.arange(corner_count) / corner_count
    front = np.stack([0.5 * np.cos(angles), np.full(corner_count, -_DISC_DEPTH / 2),
                      0.5 * np.sin(angles)], axis=-1)
    back = front * [1, -1, 1]
    faces = [Face(np.array([0.0, -1.0, 0.0]), front, None),
             Face(np.array([0.0, 1.0, 0.0]), back[::-1], None)]
    for i in range(corner_count):
        j = (i + 1) % corner_count
        corners = np.array([front[i], back[i], back[j], front[j]])
        middle = corners.mean(axis=0) * [1, 0, 1]
        faces.append(Face(middle / np.linalg.norm(middle), corners, None, True))
    return faces


def is_round(robot: Robot) -> bool:
    """Whether modules do not fill their cells."""
    return robot.lattice in ('face-centred', 'hexagonal')


def module_faces(robot: Robot) -> list[Face]:
    """The faces of every module that is no ball: a disc, or its cell."""
    return _disc_faces() if robot.lattice == 'hexagonal' else cell_faces(robot.directions)


def hidden_faces(robot: Robot, faces: list[Face]) -> npt.NDArray[np.bool_]:
    """(modules, faces): what a neighbour covers.

    Nothing is seen of a face between two existing modules or between two planned ones; of one
    between either kind the existing module's is drawn.
    """
    hidden = np.zeros((len(robot), len(faces)), dtype=bool)
    if is_round(robot):
        return hidden
    face_of = {face.direction: index for index, face in enumerate(faces)}
    is_planned = robot.modules['is_planned']
    pairs = robot.connections
    for end, other, turn in (('a', 'b', 0), ('b', 'a', 1)):
        index = np.array([face_of.get(direction ^ turn, -1)
                          for direction in pairs['direction'].tolist()], dtype=int)
        covered = (index >= 0) & (is_planned[pairs[end]] | ~is_planned[pairs[other]])
        hidden[pairs[end][covered], index[covered]] = True
    return hidden


def nodes_of(robot: Robot, cells: Cells) -> Places:
    """Where nodes in these cells would be, in pitches: (n, 3)."""
    x, y, z = cells.astype(float).T
    odd = (cells[:, 2] % 2) / 2
    places = {'cubic': (x, y, z),
              'face-centred': (x + odd, y + odd, z / np.sqrt(2)),
              'hexagonal': (x + odd, y, z * np.sqrt(0.75)),
              'hexagonal-prism': (x + y / 2, y * np.sqrt(0.75), z)}
    return np.stack(places[robot.lattice], axis=-1)


class Obstacles(NamedTuple):
    """The cells of obstacles near a robot, each once."""

    cells: Cells
    is_bonded: npt.NDArray[np.bool_]
    are_too_many: bool


def _cells_within(obstacle: dict[str, Any], low: Cells, high: Cells) -> Cells:
    """What an obstacle occupies of a box of cells."""
    if 'cells' in obstacle:
        cells = np.asarray(obstacle['cells'], dtype=np.int32)
        inside: Cells = cells[((cells >= low) & (cells <= high)).all(axis=1)]
        return inside
    spans = [np.arange(max(a, b), min(c, d) + 1) for a, b, c, d in
             zip(obstacle['from'], low.tolist(), obstacle['to'], high.tolist())]
    grid = np.stack(np.meshgrid(*spans, indexing='ij'), axis=-1)
    whole: Cells = grid.reshape(-1, 3).astype(np.int32)
    return whole


def _touched_cells(robot: Robot) -> Cells:
    """Where the robot's facets touch something."""
    cells = robot.modules['cell'][robot.facets['module']]
    goals = nodes_of(robot, cells) + robot.directions[robot.facets['direction']]
    around = np.array(list(itertools.product((-1, 0, 1), repeat=3)), dtype=np.int32)
    near = (cells[:, None] + around).reshape(-1, 3)
    ways = nodes_of(robot, near).reshape(len(cells), -1, 3) - goals[:, None]
    best = np.linalg.norm(ways, axis=2).argmin(axis=1)
    touched: Cells = near.reshape(len(cells), -1, 3)[np.arange(len(cells)), best]
    return touched


def obstacles_near(robot: Robot) -> Obstacles:
    """Of an obstacle that is touched what lies within two cells of a touch, else what lies beside
    the robot."""
    found: dict[tuple[int, ...], bool] = {}
    own = robot.modules['cell']
    touched = _touched_cells(robot) if robot.obstacles else own[:0]
    for obstacle in robot.obstacles:
        parts = []
        for cell in touched:
            if len(_cells_within(obstacle, cell, cell)):
                parts.append(_cells_within(obstacle, cell - 2, cell + 2))
        if not parts:
            parts.append(_cells_within(obstacle, own.min(axis=0) - 1, own.max(axis=0) + 1))
        for row in np.concatenate(parts).tolist():
            found.setdefault(tuple(row), obstacle['hold'] == 'bonded')
        if len(found) > OBSTACLE_CELLS_MAX:
            return Obstacles(own[:0], np.empty(0, dtype=bool), True)
    return Obstacles(np.array(list(found), dtype=np.int32).reshape(-1, 3),
                     np.array(list(found.values()), dtype=bool), False)


def facet_frames(robot: Robot) -> tuple[Places, Places]:
    """For each direction the axes x' and y' of the facet's frame, (d, 3) each: x' is upwards."""
    ways = robot.directions
    is_vertical = ~ways[:, :2].any(axis=1)
    x = np.array([0.0, 0.0, 1.0]) - ways[:, 2:] * ways
    x[is_vertical] = [1, 0, 0]
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return x, np.cross(-ways, x)

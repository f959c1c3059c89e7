# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Artists of matplotlib that know where the eye is whenever they are drawn."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection  # type: ignore[import]
from matplotlib.text import Annotation  # type: ignore[import]
from mpl_toolkits.mplot3d import proj3d  # type: ignore[import]

from ._look import INK

Array = npt.NDArray[Any]


class Faces(NamedTuple):
    """Faces of one look. All bodies lie inside cells that do not overlap."""

    nodes: Array
    """The node of the body to which each face belongs, (n, 3)."""
    corners: Array
    """(n, k, 3), counter-clockwise from outside."""
    colors: Array
    """(n, 4)."""
    edge: str
    """A colour, or ``face``: those of the faces."""
    is_dashed: bool = False

    def seen_by(self, axes: Any) -> list[Faces]:
        """Those that are turned towards the eye."""
        is_seen = _turn_left(projected(axes, self.corners)[..., :2])
        return [self._replace(nodes=self.nodes[is_seen], corners=self.corners[is_seen],
                              colors=self.colors[is_seen])]


class Balls(NamedTuple):
    """Spheres of one look, each drawn as circles across the line of sight."""

    nodes: Array
    radius: float
    colors: Array
    """(n, 4)."""
    is_dashed: bool = False

    def seen_by(self, axes: Any) -> list[Faces]:
        """Light falls from above and from the left: a dark edge on the right, a spot."""
        right, up = across(axes)
        angles = (2 * np.pi * np.arange(24) / 24)[:, None]
        circle = np.cos(angles) * right + np.sin(angles) * up
        layers = [(1.0, 0.0, -22.0), (0.82, 0.1, 0.0), (0.52, 0.25, 20.0), (0.15, 0.42, 65.0)]
        faces = []
        for share, aside, percent in layers:
            middle = self.nodes + self.radius * aside * (up - 0.75 * right)
            colors = self.colors.copy()
            goal = 1.0 if percent > 0 else 0.0
            colors[:, :3] += (goal - colors[:, :3]) * abs(percent) / 100
            faces.append(Faces(self.nodes, middle[:, None] + self.radius * share * circle, colors,
                               'none' if aside else INK, self.is_dashed))
        return faces


def across(axes: Any) -> tuple[Array, Array]:
    """What is to the right and what is up on the picture: vectors of length one."""
    turn, rise = np.deg2rad(axes.azim), np.deg2rad(axes.elev)
    right = np.array([-np.sin(turn), np.cos(turn), 0])
    up = np.array([-np.sin(rise) * np.cos(turn), -np.sin(rise) * np.sin(turn), np.cos(rise)])
    return right, up


def projected(axes: Any, points: Array) -> Array:
    """Where points (..., 3) are seen: data coordinates of the axes, and a depth that grows."""
    flat = points.reshape(-1, 3)
    x, y, z = proj3d.proj_transform(flat[:, 0], flat[:, 1], flat[:, 2], axes.get_proj())
    seen: Array = np.stack([x, y, z], axis=-1).reshape(points.shape)
    return seen


def _turn_left(outlines: Array) -> Array:
    """Whether polygons (n, k, 2) turn counter-clockwise."""
    x, y = outlines[..., 0], outlines[..., 1]
    turns = x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)
    left: Array = turns.sum(axis=1) > 0
    return left


class Bodies(PolyCollection):  # type: ignore[misc]
    """Convex bodies in cells: those whose nodes are farther are drawn first, which is exact."""

    def __init__(self, paints: Sequence[Union[Faces, Balls]], width: float, zorder: float) -> None:
        super().__init__([], linewidths=width, zorder=zorder, clip_on=False)
        self.paints = paints

    def do_3d_projection(self) -> float:
        """What Axes3D calls before it draws."""
        seen = [faces for paint in self.paints for faces in paint.seen_by(self.axes)]
        depths = np.concatenate([projected(self.axes, faces.nodes)[:, 2] for faces in seen])
        order = np.argsort(-depths, kind='stable')
        outlines = [one for faces in seen for one in projected(self.axes, faces.corners)[..., :2]]
        edges = [color if faces.edge == 'face' else faces.edge
                 for faces in seen for color in faces.colors]
        styles = ['--' if faces.is_dashed else '-' for faces in seen for _ in faces.nodes]
        self.set_verts([outlines[i] for i in order])
        self.set_facecolor(np.concatenate([faces.colors for faces in seen])[order])
        self.set_edgecolor([edges[i] for i in order])
        self.set_linestyle([styles[i] for i in order] if '--' in styles else '-')
        return float(depths.min())


class Callout(Annotation):  # type: ignore[misc]
    """A label with a line to a point in space, placed where it hides least."""

    def __init__(self, axes: Any, point: Array, text: str, avoided: Array, **style: Any) -> None:
        self.point = point
        self.avoided = avoided
        super().__init__(text, xy=(0, 0), xytext=(0, 0), textcoords='offset points', ha='center',
                         va='center', annotation_clip=False, **style)
        axes.add_artist(self)

    def place(self) -> None:
        """Follows the point, and keeps off what is to be seen."""
        axes = self.axes
        flat = projected(axes, np.vstack([self.point, self.avoided]))[:, :2]
        seen = axes.transData.transform(flat)
        ways = (seen[1:] - seen[0]) * 72 / axes.figure.dpi
        self.xy = tuple(flat[0])
        width = 0.34 * self.get_fontsize() * len(self.get_text())
        best = (np.inf, 0.0, 0.0)
        for reach in range(30, 180, 12):
            for angle in np.arange(16) * np.pi / 8 + np.pi / 4:
                x, y = (reach + width / 2) * np.cos(angle), reach * np.sin(angle)
                is_hidden = (np.abs(ways[:, 0] - x) < width + 9) & (np.abs(ways[:, 1] - y) < 18)
                best = min(best, (reach + 6.0 * float(is_hidden.sum()), x, y))
        self.set_position(best[1:])

    def draw(self, renderer: Any) -> None:
        """What the figure calls."""
        self.place()
        super().draw(renderer)

    def get_tightbbox(self, renderer: Any = None) -> Any:
        """What saving with a tight box asks."""
        self.place()
        return super().get_tightbbox(renderer)

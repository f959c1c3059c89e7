# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""A report as a picture in space, by matplotlib."""
from __future__ import annotations

import itertools
import json
import textwrap
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt
from matplotlib import cm, colors, pyplot  # type: ignore[import]
from matplotlib.legend_handler import HandlerTuple  # type: ignore[import]
from matplotlib.lines import Line2D  # type: ignore[import]
from matplotlib.patches import Patch  # type: ignore[import]
from matplotlib.path import Path  # type: ignore[import]
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection  # type: ignore[import]

from . import _bodies, _look
from ._look import Meaning
from ._painter import Balls, Bodies, Callout, Faces, across, projected
from ._verdict import Verdict

if TYPE_CHECKING:
    from ._report import Report

Array = npt.NDArray[Any]

# As in the SVG: x to the right and down, y to the right and up.
_AZIMUTH, _ELEVATION = -45.0, 35.264
_CLEAR = (0.0, 0.0, 0.0, 0.0)
_TOWARDS_EYE = np.array([1.0, -1.0, 1.0])

# From back to front.
_GRID, _GROUND, _BODIES, _FACETS, _OUTLINE, _MARKS, _MASS, _LABELS = range(1, 9)


class Picture:
    """What is drawn of one report, in mm."""

    def __init__(self, report: Report, axes: Any, cells: Optional[Array] = None) -> None:
        """`cells`: what there is room for, by default the robot."""
        self.report = report
        self.robot = report.robot
        self.axes = axes
        self.pitch = self.robot.material['pitch_mm']
        if not isinstance(self.pitch, float):
            raise ValueError('the pitch differs by direction, which svg() and write_vtk() draw, '
                             'and this picture does not')
        self.nodes = self.robot.positions
        self.obstacles = _bodies.obstacles_near(self.robot)
        self.said = _look.meanings(report)
        self.stability = report.stability
        self.handles: list[tuple[Any, str]] = []
        self.signs: list[Array] = []
        """Points that labels should not hide."""
        self.extent_mm = np.zeros(2)
        """How wide and high the drawing is."""
        self.cells = self.robot.modules['cell'] if cells is None else cells
        self.corners = [self._around(_bodies.nodes_of(self.robot, self.cells) * self.pitch)]
        """Points that are to be in the picture."""

    def draw(self) -> None:
        """Everything but header and legend."""
        self.axes.set_axis_off()
        self.axes.computed_zorder = False
        self.axes.set_proj_type('ortho')
        self.axes.view_init(_ELEVATION, _AZIMUTH)
        self._list_meanings()
        self._draw_bodies()
        self._draw_grid()
        self._draw_balance()
        self._draw_obstacle_signs()
        self._draw_facets()
        self._draw_payloads()
        self._draw_gravity()
        self._fit()
        self._mark_loads()
        for artist in [*self.axes.collections, *self.axes.lines, *self.axes.texts]:
            artist.set_clip_on(False)

    # Bodies.

    def _around(self, nodes: Array) -> Array:
        """The corners of cubes around nodes, (8 n, 3)."""
        signs = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
        corners: Array = (nodes[:, None] + self.pitch * signs).reshape(-1, 3)
        return corners

    def _list_meanings(self) -> None:
        for meaning, color in _look.MEANING_COLORS.items():
            if meaning in self.said:
                patch = Patch(facecolor=np.array(color) / 255, edgecolor=_look.INK, linewidth=0.8)
                self.handles.append((patch, meaning.value))
        if self.robot.modules['is_planned'].any():
            patch = Patch(facecolor=(*colors.to_rgb(_look.PLANNED_FILL), 0.35), edgecolor=_look.INK,
                          linestyle='--')
            self.handles.append((patch, _look.PLANNED_WORDS))

    def _paints_of(self, which: Array, fills: Array, alpha: float) -> list[Union[Faces, Balls]]:
        """The modules `which`, of the colours `fills`."""
        is_dashed = alpha < 1
        opacity = np.full((len(which), 1), alpha)
        if self.robot.lattice == 'face-centred':
            return [Balls(self.nodes[which], self.pitch / 2, np.hstack([fills[which], opacity]),
                          is_dashed)]
        paints: list[Union[Faces, Balls]] = []
        faces = _bodies.module_faces(self.robot)
        hidden = _bodies.hidden_faces(self.robot, faces)
        for index, face in enumerate(faces):
            is_free = ~hidden[which, index]
            nodes = self.nodes[which[is_free]]
            shades = np.hstack([_look.shaded(fills[which], face.normal), opacity])
            paints.append(Faces(nodes, nodes[:, None] + face.corners * self.pitch, shades[is_free],
                                'face' if face.is_strip else _look.INK, is_dashed))
        return paints

    def _draw_bodies(self) -> None:
        fills = _look.module_colors(self.report, self.said)
        is_planned = self.robot.modules['is_planned']
        paints = self._paints_of(np.flatnonzero(~is_planned), fills, 1.0)
        if is_planned.any():
            paints += self._paints_of(np.flatnonzero(is_planned), fills, _look.PLANNED_ALPHA)
        paints += self._obstacle_paints()
        self.axes.add_collection(Bodies(paints, 0.6 if len(self.robot) < 500 else 0.3, _BODIES))

    def _obstacle_paints(self) -> list[Union[Faces, Balls]]:
        cells = self.obstacles.cells
        if not len(cells):
            return []
        nodes = _bodies.nodes_of(self.robot, cells) * self.pitch
        self.corners.append(self._around(nodes))
        occupied = {tuple(row) for row in np.round(nodes, 3).tolist()}
        paints: list[Union[Faces, Balls]] = []
        for face in _bodies.cell_faces(self.robot.directions):
            beyond = np.round(nodes + face.normal * self.pitch, 3)
            free = np.array([tuple(row) not in occupied for row in beyond.tolist()])
            for is_bonded in (False, True):
                seen = free & (self.obstacles.is_bonded == is_bonded)
                base = np.array(_look.OBSTACLE_COLORS[is_bonded]) / 255
                shade = _look.lightened(_look.shaded(base, face.normal), 30)
                fill = np.tile([*shade, _look.OBSTACLE_ALPHA], (int(seen.sum()), 1))
                paints.append(Faces(nodes[seen], nodes[seen][:, None] + face.corners * self.pitch,
                                    fill, '#80808060'))
        return paints

    def _draw_obstacle_signs(self) -> None:
        if self.obstacles.are_too_many:
            self._list_obstacle(False, _look.OBSTACLES_TOO_MANY_WORDS)
            return
        for is_bonded in (False, True):
            if (self.obstacles.is_bonded == is_bonded).any():
                self._list_obstacle(is_bonded, _look.OBSTACLE_WORDS[is_bonded])

    def _list_obstacle(self, is_bonded: bool, words: str) -> None:
        color = np.array(_look.OBSTACLE_COLORS[is_bonded]) / 255
        self.handles.append((Patch(facecolor=(*color, 0.3), edgecolor=color), words))

    # Ground and balance.

    def _touches_floor(self) -> bool:
        facets = self.robot.facets
        down = int(np.argmin(self.robot.directions[:, 2]))
        lowest = self.robot.modules['cell'][facets['module'], 2] == self.robot.supports
        return bool((lowest & (facets['direction'] == down)).any())

    def _has_grid(self) -> bool:
        supports = self.robot.supports
        cells = self.robot.modules['cell']
        return supports is not None and cells[:, 2].min() >= supports and self._touches_floor()

    def _floor_point(self, x: float, y: float) -> Array:
        """The floor below a cell of the lowest layer, mm."""
        layer = self.robot.supports or 0
        three = np.array([[0, 0, layer], [1, 0, layer], [0, 1, layer]], dtype=np.int32)
        origin, right, back = _bodies.nodes_of(self.robot, three)
        down = np.array([0, 0, 0.5])
        place: Array = (origin - down + x * (right - origin) + y * (back - origin)) * self.pitch
        return place

    def _draw_grid(self) -> None:
        if not self._has_grid():
            self._draw_triad()
            return
        (x0, y0), (x1, y1) = self.cells[:, :2].min(axis=0), self.cells[:, :2].max(axis=0)
        span = max(x1 - x0, y1 - y0) + 3
        step = _round_step(span / 50)
        corners = [self._floor_point(x, y)
                   for x in (x0 - 1.5, x1 + 1.5) for y in (y0 - 1.5, y1 + 1.5)]
        self.corners.append(np.array(corners))
        lines = [[self._floor_point(x - 0.5, y0 - 1.5), self._floor_point(x - 0.5, y1 + 1.5)]
                 for x in range(x0 - 1, x1 + 3) if x % step == 0]
        lines += [[self._floor_point(x0 - 1.5, y - 0.5), self._floor_point(x1 + 1.5, y - 0.5)]
                  for y in range(y0 - 1, y1 + 3) if y % step == 0]
        self.axes.add_collection3d(
            Line3DCollection(lines, colors=_look.GRID_INK, linewidths=0.8, zorder=_GRID))
        step = _round_step(span / 16)
        for x in range(x0, x1 + 1):
            if x % step == 0:
                self._write(self._floor_point(x, y0 - 2), str(x), _look.NUMBER_INK)
        for y in range(y0, y1 + 1):
            if y % step == 0:
                self._write(self._floor_point(x1 + 2, y), str(y), _look.NUMBER_INK)
        self._write(self._floor_point(x1 + 1.2, y0 - 2), 'x', _look.INK_SOFT, fontstyle='italic')
        self._write(self._floor_point(x1 + 2, y1 + 1.2), 'y', _look.INK_SOFT, fontstyle='italic')

    def _write(self, place: Array, text: str, color: str, **style: Any) -> None:
        self.axes.text(*place, text, color=color, fontsize=8, ha='center', va='center',
                       zorder=_LABELS, **style)
        self.corners.append(place[None])

    def _draw_triad(self) -> None:
        """The directions of x, y and z, left of a robot without a floor."""
        low = np.concatenate(self.corners).min(axis=0)
        origin = low - self.pitch * np.array([1.5, 0.5, 0])
        for name, way in zip('xyz', np.eye(3) * self.pitch):
            self.axes.quiver(*origin, *way, color=_look.INK_SOFT, linewidth=1, zorder=_GRID,
                             arrow_length_ratio=0.25)
            self._write(origin + 1.3 * way, name, _look.INK_SOFT, fontstyle='italic')
        self.corners.append(origin[None] - self.pitch * 0.2)

    def _ground_z(self) -> float:
        facet = self.robot.facets[0]
        way = self.robot.directions[facet['direction']]
        return float(self.nodes[facet['module'], 2] + way[2] * self.pitch / 2)

    def _draw_balance(self) -> None:
        polygon = self.stability['polygon_mm']
        if len(polygon):
            level = np.full((len(polygon), 1), self._ground_z())
            outline = np.hstack([polygon, level])
            self.corners.append(outline)
            self.axes.add_collection3d(
                Poly3DCollection([outline], facecolors=(*colors.to_rgb(_look.GROUND_FILL), 0.55),
                                 edgecolors=_look.GROUND_INK, linewidths=1.6, zorder=_GROUND))
            closed = np.vstack([outline, outline[:1]])
            self.axes.plot(*closed.T, '--', color=_look.GROUND_INK, linewidth=1.2, zorder=_OUTLINE)
            self.handles.append((Patch(facecolor=(*colors.to_rgb(_look.GROUND_FILL), 0.55),
                                       edgecolor=_look.GROUND_INK), _look.POLYGON_WORDS))
        falls = self.report.verdict is Verdict.UNSTABLE and self.stability['motion'] is not None
        if len(polygon) or falls:
            self._draw_mass(len(polygon) > 0)

    def _draw_mass(self, has_foot: bool) -> None:
        masses = self.robot.masses
        height = float(masses @ self.nodes[:, 2] / masses.sum())
        x, y = self.stability['centre_of_mass_mm']
        if has_foot:
            foot = np.array([x, y, self._ground_z()])
            self.corners.append(foot[None])
            self.signs.append(np.linspace(foot, [x, y, height], 20))
            self.axes.plot([x, x], [y, y], [height, foot[2]], '--', color=_look.INK, linewidth=1.2,
                           zorder=_MASS)
            self.axes.plot([x], [y], [foot[2]], 'x', color=_look.INK, markersize=7,
                           markeredgewidth=2, zorder=_MASS)
            self._draw_toppling(foot)
        for sign in _mass_signs():
            self.axes.plot([x], [y], [height], zorder=_MASS, **sign)
        self.handles.append((tuple(Line2D([], [], linestyle='none', **sign)
                                   for sign in _mass_signs()), _look.MASS_WORDS))

    def _draw_toppling(self, foot: Array) -> None:
        """The edge over which an unstable robot tips, and the way of the centre of mass."""
        edge = self.stability['edge_mm']
        if self.report.verdict is not Verdict.UNSTABLE or edge is None:
            return
        color = _look.VERDICT_INKS[Verdict.UNSTABLE]
        a, b = np.hstack([edge, np.full((2, 1), foot[2])])
        self.axes.plot(*np.stack([a, b]).T, color=color, linewidth=4, solid_capstyle='round',
                       zorder=_MASS)
        along = b - a
        share = np.clip((foot - a) @ along / (along @ along), 0, 1)
        start = a + share * along
        reach = max(self.pitch, 0.6 * self.pitch - self.stability['margin_mm'])
        out = np.array([along[1], -along[0], 0]) / np.linalg.norm(along) * reach
        self.axes.quiver(*start, *out, color=color, linewidth=2.5, arrow_length_ratio=0.3,
                         zorder=_MASS)
        self.corners.append((start + out)[None])
        self.signs += [np.linspace(start, start + out, 20), np.linspace(a, b, 20)]
        words = _millimetres(-self.stability['margin_mm'])
        self._call_out(foot, words, color, True)

    # Marks.

    def _draw_facets(self) -> None:
        """What touches something, where it is more than cubes on a floor."""
        robot, facets = self.robot, self.robot.facets
        is_general = robot.lattice != 'cubic' or len(self.obstacles.cells) or \
            self.obstacles.are_too_many or (facets['hold'] == 1).any()
        if not len(facets) or not is_general:
            return
        half = max(0.06 * self.pitch, robot.facet_half_width_mm)
        across = [axis[facets['direction']] for axis in _bodies.facet_frames(robot)]
        ways = robot.directions[facets['direction']]
        middles = self.nodes[facets['module']] + ways * self.pitch / 2
        squares = np.stack([middles + half * (i * across[0] + j * across[1])
                            for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
        is_near = ways @ _TOWARDS_EYE > 0
        states = self._facet_states()
        for state, (words, color) in _look.FACET_LOOKS.items():
            own = states == state
            fill = color if state in _look.FACETS_FILLED else '#ffffff'
            for near in (False, True):
                if (own & (is_near == near)).any():
                    alpha = 0.15 if not near else 0.75
                    self.axes.add_collection3d(Poly3DCollection(
                        list(squares[own & (is_near == near)]), edgecolors=color, linewidths=1.3,
                        facecolors=(*colors.to_rgb(fill if near else '#ffffff'), alpha),
                        linestyles='--' if state == 'open' else '-', zorder=_FACETS))
            if own.any():
                patch = Patch(facecolor=(*colors.to_rgb(fill), 0.75), edgecolor=color,
                              linestyle='--' if state == 'open' else '-')
                self.handles.append((patch, words))

    def _facet_states(self) -> Array:
        facets, contacts = self.robot.facets, self.report.contacts
        states = np.full(len(facets), 'unknown', dtype='U8')
        if _look.has_loads(self.report) and len(contacts) == len(facets):
            tilts = (contacts['tilt_x'] != 0) | (contacts['tilt_y'] != 0)
            pressed = np.where(tilts, 'tilts', 'presses')
            states[:] = np.where(contacts['is_pressed'], pressed, 'open')
        states[facets['hold'] == 1] = 'bonded'
        return states

    def _draw_payloads(self) -> None:
        """Forces and torques besides the weight; the strongest is the longest."""
        loads = json.loads(self.robot.json()).get('loads', [])
        if not loads:
            return
        cells = np.array([load['cell'] for load in loads], dtype=np.int32)
        nodes = _bodies.nodes_of(self.robot, cells) * self.pitch
        forces = np.array([load.get('force_n', [0, 0, 0]) for load in loads], dtype=float)
        sizes = np.linalg.norm(forces, axis=1)
        for node, force, size in zip(nodes, forces, sizes):
            if size > 1e-9 * sizes.max():
                way = force / size * self.pitch * (0.6 + 0.9 * size / sizes.max())
                self.axes.quiver(*node, *way, color=_look.PAYLOAD_INK, linewidth=2.2,
                                 arrow_length_ratio=0.3, zorder=_MARKS)
                self.corners.append((node + way)[None])
        for node, load in zip(nodes, loads):
            self._draw_torque(node, np.array(load.get('torque_nmm', [0, 0, 0]), dtype=float))
        arrow = Line2D([], [], color=_look.PAYLOAD_INK, linewidth=2, marker='>', markersize=6,
                       markevery=[1])
        self.handles.append((arrow, _look.PAYLOAD_WORDS))

    def _draw_torque(self, node: Array, torque: Array) -> None:
        size = np.linalg.norm(torque)
        if size == 0:
            return
        axis = torque / size
        first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        first /= np.linalg.norm(first)
        angles = np.linspace(0, 1.5 * np.pi, 25)[:, None]
        arc = node + 0.35 * self.pitch * (np.cos(angles) * first +
                                          np.sin(angles) * np.cross(axis, first))
        self.axes.plot(*arc.T, color=_look.PAYLOAD_INK, linewidth=2, zorder=_MARKS)
        self.axes.quiver(*arc[-1], *(arc[-1] - arc[-4]), color=_look.PAYLOAD_INK, linewidth=2,
                         arrow_length_ratio=1, zorder=_MARKS)

    def _draw_gravity(self) -> None:
        gravity = np.array(self.robot.gravity)
        if not gravity[:2].any() and gravity[2] <= 0:
            return
        way = gravity / np.linalg.norm(gravity) * 1.3 * self.pitch
        everything = np.concatenate(self.corners)
        origin = np.array([*everything.min(axis=0)[:2], everything.max(axis=0)[2]])
        self.axes.quiver(*origin, *way, color=_look.GRAVITY_INK, linewidth=2.2,
                         arrow_length_ratio=0.3, zorder=_MARKS)
        self._write(origin + 1.3 * way, 'g', _look.GRAVITY_INK, fontstyle='italic',
                    fontweight='bold')

    def _mark_loads(self) -> None:
        """Broken connections, and the worst one by name."""
        report, ratio = self.report, self.report.load_ratio_max
        if (report.verdict is Verdict.UNSTABLE or not _look.has_loads(report)
                or report.worst is None or ratio is None or not np.isfinite(ratio)
                or ratio < _look.NO_LOAD):
            return
        others = [self._shared_face(one) for one in report.broken if one != report.worst]
        if others:
            self.axes.add_collection3d(Poly3DCollection(
                others, facecolors=_CLEAR, edgecolors=_look.BROKEN_INK, linewidths=1.5,
                zorder=_MARKS))
        is_broken = bool(report.broken)
        color = _look.WORST_INK if is_broken else _look.INK
        face = self._shared_face(report.worst)
        fill = (*colors.to_rgb('#d6202b'), 0.35) if is_broken else _CLEAR
        self.axes.add_collection3d(Poly3DCollection(
            [face], facecolors=fill, edgecolors=color, linewidths=3 if is_broken else 1.4,
            zorder=_MARKS))
        words = _ratio(ratio, is_broken) + (' \u00d7' if is_broken else '')
        self._call_out(face.mean(axis=0), words, color, is_broken)

    def _shared_face(self, connection: int) -> Array:
        pair = self.robot.connections[connection]
        direction = int(pair['direction'])
        middle = self.nodes[[pair['a'], pair['b']]].mean(axis=0)
        if not _bodies.is_round(self.robot):
            for face in _bodies.cell_faces(self.robot.directions):
                if face.direction == direction:
                    corners: Array = face.corners - face.corners.mean(axis=0)
                    outline: Array = middle + corners * self.pitch
                    return outline
        x, y = (axis[direction] for axis in _bodies.facet_frames(self.robot))
        angles = (2 * np.pi * np.arange(16) / 16)[:, None]
        around: Array = middle + 0.28 * self.pitch * (np.cos(angles) * x + np.sin(angles) * y)
        return around

    def _call_out(self, place: Array, words: str, color: str, is_strong: bool) -> None:
        avoided = np.concatenate([self.nodes, self._around(self.nodes), *self.signs])
        Callout(self.axes, place, words, avoided, color=color, zorder=_LABELS,
                fontsize=11 if is_strong else 9, fontweight='bold' if is_strong else 'normal',
                bbox={'boxstyle': 'round', 'facecolor': 'white', 'edgecolor': color},
                arrowprops={'arrowstyle': '-', 'color': color, 'linewidth': 1.2})

    # Around it.

    def _fit(self) -> None:
        """Equal axes, as large as fits."""
        ways = np.array(across(self.axes))
        everything = np.concatenate(self.corners)
        flat = everything @ ways.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        self.extent_mm = high - low
        half = self.extent_mm.max() / 2
        frame = self.axes.transAxes + self.axes.transData.inverted()
        left, centre, right = frame.transform([(0, 0), (0.5, 0.5), (1, 1)])
        # The middle of the limits is seen at 0, the middle of the frame is not.
        middle = everything.mean(axis=0)
        off = centre * 2 * half / (right - left)
        middle += ((low + high) / 2 - off - ways @ middle) @ ways
        for axis, value in zip('xyz', middle):
            getattr(self.axes, f'set_{axis}lim')(value - half, value + half, auto=None)
        self.axes.set_box_aspect((1, 1, 1))
        seen = projected(self.axes, middle + np.array([[-half], [half]]) * ways[0])
        self.axes.set_box_aspect((1, 1, 1), zoom=(right - left)[0] / (seen[1, 0] - seen[0, 0]))

    def draw_legend(self, frame: Frame) -> None:
        left = 0.0
        if Meaning.LOAD in self.said:
            left = 2.9
            bar = self.axes.inset_axes(frame.box(0.1, -0.5, 2.3, 0.12), transform=frame.transform)
            scale = cm.ScalarMappable(colors.Normalize(0, 1), load_colormap())
            self.axes.figure.colorbar(scale, cax=bar, orientation='horizontal',
                                      ticks=[0, 0.25, 0.5, 0.75, 1], format='{x:g}')
            bar.tick_params(labelsize=8)
            bar.set_title(_look.SCALE_WORDS, fontsize=9, color=_look.INK)
        if self.handles:
            signs, words = zip(*self.handles)
            self.axes.legend(signs, words, loc='upper left', ncol=2 if len(words) > 1 else 1,
                             bbox_to_anchor=frame.box(left, -0.15, 0, 0)[:2], frameon=False,
                             bbox_transform=frame.transform, fontsize=9, borderaxespad=0,
                             handler_map={tuple: HandlerTuple(ndivide=1)})


class Frame:
    """The rectangle around which header and legend stand; lengths in inches."""

    def __init__(self, axes: Any, transform: Any, low: Array, high: Array) -> None:
        self.axes = axes
        self.transform = transform
        """In whose unit `low` and `high` are, its corners."""
        self.low = low
        self.high = high
        corners = transform.transform([(0, 0), (1, 1)])
        self.unit = (corners[1] - corners[0]) / axes.figure.dpi

    def box(self, right: float, up: float, width: float, height: float) -> Array:
        """A box whose lower left corner is seen so from the frame's."""
        size = np.array([width, height]) / self.unit
        return np.concatenate([self.low + np.array([right, up]) / self.unit, size])

    def write_header(self, report: Report, title: str) -> None:
        """Name, verdict, and what it rests on, above the frame."""
        place = np.array([self.low[0], self.high[1]])
        lines, is_narrow = wrapped(report, (self.high - self.low)[0] * self.unit[0])
        above = np.array([0, 0.16 * (len(lines) + is_narrow)]) / self.unit
        style = {'transform': self.transform, 'color': _look.INK}
        self.axes.text2D(*(place + above * 1.1), title, fontweight='bold', fontsize=12,
                         va='bottom', **style)
        style['color'] = _look.VERDICT_INKS[report.verdict]
        first = self.axes.text2D(*(place + above), headline(report)[0] + ' \u2013', va='top',
                                 fontsize=9, fontweight='bold', **style)
        self.axes.annotate('\n'.join(lines), xy=(0, 0) if is_narrow else (1, 1), xycoords=first,
                           xytext=(0, -2) if is_narrow else (5, 0), textcoords='offset points',
                           va='top', fontsize=9, color=_look.INK, annotation_clip=False)


def _mass_signs() -> list[dict[str, Any]]:
    """Two circle sectors in a circle."""
    quarter = [Path.wedge(angle, angle + 90) for angle in (0, 180)]
    return [{'marker': 'o', 'markersize': 11, 'markerfacecolor': 'white',
             'markeredgecolor': _look.INK, 'markeredgewidth': 1.2},
            {'marker': Path.make_compound_path(*quarter), 'markersize': 11,
             'markerfacecolor': _look.INK, 'markeredgecolor': 'none'}]


def _round_step(least: float) -> int:
    """1, 2, 5, 10, 20... that is at least so much."""
    steps = (factor * 10**power for power in itertools.count() for factor in (1, 2, 5))
    found: int = next(step for step in steps if step >= least)
    return found


def _ratio(ratio: float, is_broken: bool) -> str:
    text = f'{ratio:.2f}'
    return text if is_broken or text != '1.00' else f'{ratio:.6f}'


def _millimetres(value: float) -> str:
    return f'{value:.2f} mm' if value < 0.095 else f'{value:.1f} mm'


def wrapped(report: Report, width: float) -> tuple[list[str], bool]:
    """What the verdict rests on, in lines that fit so many inches; whether below the verdict."""
    is_narrow = width < 4.5
    room = width if is_narrow else width - 1
    return textwrap.wrap(headline(report)[1], max(20, int(14.2 * room))), is_narrow


def load_colormap() -> Any:
    """The colours of load ratios from 0 to 1."""
    return colors.ListedColormap(_look.load_colors(np.linspace(0, 1, 101)), 'holdfast load ratio')


def headline(report: Report) -> tuple[str, str]:
    """The verdict in capitals, and what it rests on: the line above the SVG's picture."""
    root = ET.fromstring(report.svg())
    line = root.find(".//{*}text[@class='verdict']")
    parts = [] if line is None else [part.text or '' for part in line]
    return parts[0].rstrip(' \u2013'), parts[1]


_WIDTH, _MARGIN, _HEIGHT_MAX, _PITCH_MAX = 8.0, 0.35, 6.0, 0.75
"""Of a figure, its margin, a drawing and a module in it: inches."""


def _own_frame(picture: Picture) -> Frame:
    """Makes the figure as high as the drawing needs, and returns the drawing's frame."""
    axes = picture.axes
    room = np.array([_WIDTH - 2 * _MARGIN, _HEIGHT_MAX])
    scale = min(*(room / picture.extent_mm), _PITCH_MAX / picture.pitch)
    high = scale * picture.extent_mm[1]
    header = 0.65 + 0.16 * len(wrapped(picture.report, room[0])[0])
    legend = 0.65 + 0.09 * (len(picture.handles) + 1)
    size = np.array([_WIDTH, header + high + legend])
    axes.figure.set_size_inches(*size)
    side = scale * picture.extent_mm.max() / size
    middle = np.array([_WIDTH / 2, legend + high / 2]) / size
    axes.set_position([*(middle - side / 2), *side])
    low = np.array([_MARGIN, legend]) / size
    return Frame(axes, axes.figure.transFigure, low, 1 - np.array([_MARGIN, header]) / size)


def plot(report: Report, axes: Any, title: Optional[str], legend: bool) -> Any:
    """Draws into the axes, or makes a figure of their own."""
    is_own = axes is None
    if is_own:
        axes = pyplot.figure(facecolor=_look.CARD).add_subplot(projection='3d')
        axes.set_facecolor('none')
    picture = Picture(report, axes)
    picture.draw()
    frame = _own_frame(picture) if is_own else Frame(axes, axes.transAxes, np.zeros(2), np.ones(2))
    frame.write_header(report, report.robot.name if title is None else title)
    if legend:
        picture.draw_legend(frame)
    return axes

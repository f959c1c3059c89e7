# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Reports one after the other, by matplotlib."""
from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot  # type: ignore[import]
from matplotlib.animation import FuncAnimation, PillowWriter  # type: ignore[import]

from . import _core, _look
from ._optional import need
from ._picture import Frame, Picture

if TYPE_CHECKING:
    from ._report import Report

_SIZE = np.array([8.0, 7.0])
_LOW, _HIGH = np.array([0.35, 1.25]), np.array([7.65, 6.2])
"""Of the drawing in a frame of the film: inches."""


class Film:
    """Frames of one size, in which nothing jumps: every robot stands where it is."""

    def __init__(self, reports: list[Report], milliseconds: int) -> None:
        if not reports:
            raise _core.Error('expected at least one report, found none')
        if not 10 <= milliseconds <= 600_000:
            raise _core.Error(f'expected 10 to 600,000 milliseconds, found {milliseconds}')
        self.reports = reports
        self.milliseconds = milliseconds
        self._cells = np.concatenate([report.robot.modules['cell'] for report in reports])

    def __len__(self) -> int:
        """How many frames there are."""
        return len(self.reports)

    def frame(self, index: int, figure: Any = None) -> Any:
        """Draws one frame; returns the figure."""
        if figure is None:
            figure = pyplot.figure(figsize=tuple(_SIZE), facecolor=_look.CARD)
        figure.clear()
        axes = figure.add_subplot(projection='3d')
        axes.set_facecolor('none')
        report = self.reports[index]
        picture = Picture(report, axes, self._cells)
        picture.draw()
        side = min((_HIGH - _LOW) / picture.extent_mm) * picture.extent_mm.max()
        axes.set_position([*((_LOW + _HIGH - side) / 2 / _SIZE), *(side / _SIZE)])
        frame = Frame(axes, figure.transFigure, _LOW / _SIZE, _HIGH / _SIZE)
        frame.write_header(report, f'{report.robot.name}  {index + 1} / {len(self)}')
        picture.draw_legend(frame)
        return figure

    def animation(self) -> Any:
        """The film as matplotlib has it."""
        figure = pyplot.figure(figsize=tuple(_SIZE), facecolor=_look.CARD)
        return FuncAnimation(figure, lambda index: self.frame(index, figure).axes,
                             init_func=lambda: [], frames=len(self), interval=self.milliseconds)

    def html(self) -> str:
        """The film with buttons; needs no network."""
        film = self.animation()
        text: str = film.to_jshtml(fps=1000 / self.milliseconds)
        pyplot.close(film._fig)
        return text

    def save(self, path: str) -> None:
        """Writes a .gif or an .html file, whole or not at all."""
        if path.endswith('.html'):
            _core.write_file(path, self.html())
        elif path.endswith('.gif'):
            need('PIL', 'a .gif')
            try:
                with tempfile.TemporaryDirectory(dir=os.path.dirname(path) or '.') as folder:
                    made = os.path.join(folder, 'film.gif')
                    film = self.animation()
                    film.save(made, PillowWriter(fps=1000 / self.milliseconds),
                              savefig_kwargs={'facecolor': _look.CARD})
                    pyplot.close(film._fig)
                    os.replace(made, path)
            except OSError as error:
                raise _core.Error(f'{path}: {error.strerror}') from None
        else:
            raise _core.Error(f'{path}: expected a name that ends in .gif or .html')

    def _repr_html_(self) -> str:
        return self.html()

    def __repr__(self) -> str:
        return f'<holdfast.Film of {len(self)} frames>'

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What is asked of a picture, and how it becomes a file."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Optional, Protocol, Union, runtime_checkable

from . import _core

Path = Union[str, bytes, 'os.PathLike[str]', 'os.PathLike[bytes]']
Size = Union[int, tuple[int, int], None]
"""A width, or a width and a height, in pixels."""
View = Union[str, tuple[float, float]]
"""``iso``, ``front``, ``side``, ``top``, or azimuth and elevation of the eye, in degrees."""


@runtime_checkable
class Readable(Protocol):
    """A file object, of text or of bytes."""

    def read(self) -> Union[str, bytes]: ...


class RobotWarning(UserWarning):
    """What a reader wants its user to know; `Robot.warnings` has it, too."""


class FileAbsent(_core.Error, FileNotFoundError):
    """There is no such file; the error of Python's open() as well."""


@contextmanager
def read_from(path: Path) -> Iterator[None]:
    """An error of reading a file that is not there is `FileAbsent`."""
    try:
        yield
    except _core.Error as error:
        if os.path.exists(path):
            raise
        raise FileAbsent(str(error)) from None


def figure(size: Size, view: View, title: str, grey: bool, legend: bool) -> _core.Figure:
    """The core's form of it, or Error."""
    def text(given: Union[Size, View], between: str) -> Optional[str]:
        if given is None or isinstance(given, str):
            return given
        return between.join(f'{one}' for one in (given if isinstance(given, tuple) else (given,)))
    return _core.Figure(text(size, 'x'), text(view, ','), title, grey, legend)


class Drawn:
    """What has a picture."""

    __slots__ = ()

    def _drawn(self, asked: _core.Figure) -> str:
        raise NotImplementedError

    def svg(self, *, size: Size = None, view: View = 'iso', title: str = '', grey: bool = False,
            legend: bool = True) -> str:
        """A picture.

        Parameters
        ----------
        size
            A width, or a width and a height, in pixels.
        view
            ``iso``, ``front``, ``side``, ``top``, or azimuth and elevation of the eye, degrees.
        title
            In place of the robot's name.
        grey
            Without colours: the darker the more load.
        legend
            Whether there is one.
        """
        return self._drawn(figure(size, view, title, grey, legend))

    def save_figure(self, path: Path, *, size: Size = None, view: View = 'iso', title: str = '',
                    grey: bool = False, legend: bool = True) -> None:
        """Writes the picture, as SVG, PNG or PDF by the file's ending; options are those of svg().

        PNG and PDF need librsvg.
        """
        _core.write_figure(path, self.svg(size=size, view=view, title=title, grey=grey,
                                          legend=legend))

    def _repr_svg_(self) -> str:
        return self.svg()

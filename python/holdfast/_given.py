# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What a robot is given as, and the form of it that the core takes."""
from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Set
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core

Cells = Union[npt.NDArray[Any], Iterable[Iterable[int]]]
"""An (n, 3) array of integers, or what numpy makes one of."""
Cell = tuple[int, int, int]
Table = npt.NDArray[Any]
"""A structured array."""


def counted(count: int, one: str) -> str:
    """A number of things with their noun: 1 step, 2 steps."""
    return f'{count} {one if count == 1 else one + "s"}'


def _plain(value: Any) -> Any:
    """What json does not know: numpy's arrays and numbers."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise _core.Error('expected a number, a text, a list or a dictionary, found '
                      f'{type(value).__name__}')


def json_of(head: Mapping[str, Any]) -> str:
    try:
        return json.dumps(head, default=_plain, allow_nan=False, ensure_ascii=False)
    except ValueError as error:
        if isinstance(error, _core.Error):
            raise
        raise _core.Error(
            'expected finite numbers, found one that is infinite or no number') from None


def listed(cells: Any) -> Any:
    """Sets, in ascending order, and what can be gone through only once, as lists, as numpy takes
    them."""
    if isinstance(cells, Set):
        return sorted(cells)
    return list(cells) if isinstance(cells, Iterator) else cells


def floats(what: str, given: Any) -> npt.NDArray[np.float64]:
    """An array of numbers, or Error."""
    try:
        return np.asarray(given, dtype=float)
    except (ValueError, OverflowError) as error:
        raise _core.Error(f'{what}: {error}') from None


def load_list(loads: Any) -> Any:
    """The form of holdfast JSON, of a mapping from cells to forces in N, or to six numbers."""
    if not isinstance(loads, Mapping):
        return loads
    entries = []
    for cell, load in loads.items():
        numbers = floats('loads', load).ravel().tolist()
        if len(numbers) not in (3, 6):
            raise _core.Error('loads: expected 3 numbers, a force, or 6, a force and a torque, '
                              f'found {len(numbers)} for {tuple(cell)}')
        entry = {'cell': list(cell), 'force_n': numbers[:3]}
        if len(numbers) == 6:
            entry['torque_nmm'] = numbers[3:]
        entries.append(entry)
    return entries


def obstacle_list(obstacles: Any) -> Any:
    """The form of holdfast JSON; cells are together one obstacle that touches."""
    if isinstance(obstacles, np.ndarray):
        obstacles = obstacles.tolist()
    is_list = isinstance(obstacles, (list, tuple)) and len(obstacles) > 0
    if is_list and not any(isinstance(entry, Mapping) for entry in obstacles):
        return [{'cells': obstacles}]
    return obstacles


def reading(lattice: str = '', robot: str = '', allow_unknown: bool = False,
         supports: Union[int, str, None] = None, pitch: Optional[float] = None,
         palette: Optional[Mapping[str, Any]] = None) -> dict[str, Any]:
    """What readers are told beside the file."""
    head = {'format': 'holdfast-palette', 'version': 1}
    return {'lattice': lattice, 'robot': robot, 'allow_unknown': allow_unknown,
            'supports': supports, 'pitch': pitch,
            'palette': '' if palette is None else json_of({**head, **palette})}


def level(supports: Any, cells: Any) -> Any:
    """The layer that ``lowest`` means; other supports as they are."""
    if not isinstance(supports, str):
        return supports
    if supports != 'lowest':
        raise _core.Error(f"supports: expected a layer z, None, a mapping or 'lowest', found "
                          f'{supports!r}')
    array = np.asarray(cells)
    return int(array[:, 2].min()) if array.ndim == 2 and array.shape[1:] == (3,) else 0


def head_of(options: Mapping[str, Any], supports: Any) -> str:
    """Holdfast JSON with all but the modules; empty if all is as it is by default."""
    said = {key: value for key, value in options.items() if value is not None}
    if isinstance(supports, Mapping):
        for key, value in supports.items():
            if key not in ('support_z', 'floor', 'obstacles') or key in said:
                raise _core.Error('supports: expected support_z, floor and obstacles, each '
                                  f'once, found {key!r}')
            said[key] = obstacle_list(value) if key == 'obstacles' else value
    elif supports is None:
        said['support_z'] = None
    elif supports != 0:
        said['support_z'] = supports
    if not said:
        return ''
    return json_of({'format': 'holdfast-structure', 'version': 2, 'modules': [], **said})


def cell_of(entry: Any) -> tuple[Any, ...]:
    """The cell of what has one in holdfast JSON; empty if it has none."""
    cell = entry.get('cell') if isinstance(entry, dict) else entry
    return tuple(cell) if isinstance(cell, list) else ()


def own_parts(cells: Any, planned: Any, masses: Any,
              kind_of: Any) -> list[tuple[int, int, str, float]]:
    """Modules with masses or kinds of their own: step, index, kind, mass or not a number."""
    if masses is None and kind_of is None:
        return []
    existing = [tuple(cell) for cell in np.asarray(cells).tolist()]
    to_come = [tuple(cell) for cell in np.asarray([] if planned is None else planned).tolist()]
    names = existing + to_come
    if masses is not None and not isinstance(masses, Mapping):
        values = floats('masses', masses)
        if values.shape not in ((len(existing),), (len(names),)):
            raise _core.Error('masses: expected one number for each of the '
                              f'{len(existing)} modules, '
                              f'or a mapping from cells, found the shape {values.shape}')
        masses = dict(zip(names, values.tolist()))
    wanted: dict[Any, tuple[str, float]] = {}
    for cell, kilograms in (masses or {}).items():
        if not np.isfinite(floats('masses', kilograms)).all():
            raise _core.Error(f'masses: expected a number of kg, found {kilograms} for '
                              f'{tuple(cell)}')
        wanted[tuple(cell)] = ('', float(kilograms))
    if not isinstance(kind_of, (Mapping, type(None))):
        raise _core.Error('kind_of: expected a mapping from cells to names, found '
                          f'{type(kind_of).__name__}')
    for cell, kind in (kind_of or {}).items():
        wanted[tuple(cell)] = (kind, wanted.get(tuple(cell), ('', float('nan')))[1])
    places = {cell: (0, index) for index, cell in enumerate(existing)}
    places.update({cell: (1, index) for index, cell in enumerate(to_come)})
    own = []
    for cell, (kind, kilograms) in wanted.items():
        if cell not in places:
            raise _core.Error(f'masses, kind_of: there is no module at {cell}')
        own.append((*places[cell], kind, kilograms))
    return sorted(own)

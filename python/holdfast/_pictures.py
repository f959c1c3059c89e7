# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of what happens to a robot: over its steps, while it grows, and as a film."""
from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from ._answers import Order, Steps
from ._figures import Path
from ._given import cell_of
from ._optional import need
from ._report import Report, expect
from ._robot import Robot

if TYPE_CHECKING:
    from ._film import Film


def plot_steps(judged: Steps, figure: Any = None) -> Any:
    """Draws the verdict of every stage as a band, largest load ratio and margin below it.

    `judged` comes of `steps`. Returns the figure, by default a new one, with three axes. Needs
    python3-matplotlib.
    """
    expect(judged, Steps, 'judged')
    need('matplotlib', 'plot_steps')
    from ._curves import draw_steps
    return draw_steps(judged, figure)


def plot_order(found: Order, figure: Any = None) -> Any:
    """Draws how a robot grows: its modules, largest load ratio and margin after every step.

    Of states that were not solved the load ratio is below a bound, which is drawn as such. `found`
    comes of `order`. Returns the figure, by default a new one, with three axes. Needs
    python3-matplotlib.
    """
    expect(found, Order, 'found')
    need('matplotlib', 'plot_order')
    from ._curves import draw_order
    return draw_order(found, figure)


def animate(source: Union[Steps, Order, Sequence[Report]], path: Optional[Path] = None, *,
            milliseconds: int = 700) -> Film:
    """Makes a film: a frame for each report, or for the start and the state after each step.

    Parameters
    ----------
    source
        What `steps` or `order` returned, or reports in their order.
    path
        Where to write it: a .gif, or an .html with buttons, which needs no network.
    milliseconds
        How long a frame is seen.

    In a notebook the film shows itself. Needs python3-matplotlib; a .gif also needs python3-pil.
    """
    need('matplotlib', 'animate')
    from ._film import Film
    if isinstance(source, (Steps, Order)):
        robot = source.robot if isinstance(source, Steps) else source.robot()
        reports = [state.check() for state in states(robot)]
    else:
        reports = list(source)
        for report in reports:
            expect(report, Report, 'source')
    film = Film(reports, milliseconds)
    if path is not None:
        film.save(os.fsdecode(path))
    return film


def states(robot: Robot) -> Iterator[Robot]:
    """The robot without its steps, and as it is after each of them."""
    document = json.loads(robot.json())
    modules = {cell_of(module): module for module in document.pop('modules')}
    steps = [{'attach': step} for step in (document.pop('planned', None), ) if step]
    steps += [{'attach': step} for step in document.pop('later_steps', [])]
    steps += document.pop('steps', [])
    document.pop('known_answer', None)
    loads = document.pop('loads', [])

    def state() -> Robot:
        carried = [load for load in loads if cell_of(load) in modules]
        text = json.dumps({**document, 'modules': list(modules.values()),
                           **({'loads': carried} if carried else {})})
        return Robot.from_text(text, name=robot.name)
    yield state()
    for step in steps:
        gone = {cell_of(cell) for cell in step.get('detach', [])}
        ways = {cell_of(move['from']): move['to'] for move in step.get('move', [])}
        loads = [{**load, 'cell': ways.get(cell_of(load), load['cell'])} for load in loads
                 if cell_of(load) not in gone]
        for cell in gone:
            del modules[cell]
        moved = {tuple(move['to']): modules.pop(tuple(move['from']))
                 for move in step.get('move', [])}
        for cell, module in moved.items():
            modules[cell] = {**module, 'cell': cell} if isinstance(module, dict) else cell
        modules.update((cell_of(module), module) for module in step.get('attach', []))
        yield state()

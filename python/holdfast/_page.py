# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The page with a report in it: in a notebook, or in the browser."""
from __future__ import annotations

import html
import json
import pathlib
import sys
import tempfile
import webbrowser
from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    from ._report import Report

_START = 'id="holdfast-start">null<'
_REPORT = '<!-- holdfast view puts the report here. -->'
_TITLE = '<title>holdfast</title>'


class PageNotFound(_core.Error):
    """The page is not built."""


def _places() -> list[pathlib.Path]:
    """Beside build/python, and where it is installed."""
    above = pathlib.Path(__file__).absolute().parents[1]
    return [above.parent / 'page' / 'holdfast.html',
            above.parents[2] / 'share' / 'holdfast' / 'holdfast.html',
            pathlib.Path(sys.prefix) / 'share' / 'holdfast' / 'holdfast.html']


def _empty_page() -> str:
    for place in _places():
        if place.is_file():
            return place.read_text(encoding='utf-8')
    names = ', '.join(dict.fromkeys(str(place) for place in _places()))
    raise PageNotFound(f"the page is not built: looked for {names}; './dev page' builds it")


def _collapse(report: Report) -> dict[str, Any]:
    """How the robot gives way at its limit load, if that was sought."""
    if report.limit_load is None:
        return {}
    found = json.loads(report.json())
    if report.limit_load['outcome'] == 'stopped':
        return {'limit': None}
    mechanism = found['limit_load']['mechanism'] or {'yields': [], 'velocities': []}
    return {'limit': {'factor': found['limit_load_factor'], **mechanism}}


def filled(report: Report, opens_report: bool = True) -> str:
    """The page with the structure and the report in it, as ``holdfast check --html`` writes it.

    Unless the report opens, it is only seen where the page cannot draw.
    """
    robot = report.robot
    name = ' '.join(robot.name.split())
    text = f'{name}: {report.verdict.value}\n{report.text()}'
    entries = {'structure': robot.json(), 'name': robot.name, **_collapse(report)}
    if opens_report:
        entries['report'] = text
    start = json.dumps(entries, ensure_ascii=False)
    page = _empty_page()
    # No letter of what is put in can end a script or a comment.
    start = start.replace('<', '\\u003c')
    for place, content in ((_START, f'id="holdfast-start">{start}<'),
                           (_REPORT, f'<pre>{html.escape(text, quote=False)}</pre>'),
                           (_TITLE, f'<title>{html.escape(name)} - holdfast</title>')):
        if place not in page:
            raise PageNotFound("holdfast.html is no page of holdfast's; './dev page' builds it")
        page = page.replace(place, content, 1)
    return page


def frame(report: Report, height: int = 640) -> str:
    """HTML for a notebook: the page in a frame of its own, or without the page the picture."""
    try:
        page = filled(report, opens_report=False)
    except PageNotFound as error:
        return (f'<div>{report.svg()}<p>This is a picture; the page to turn the robot is not '
                f'there: {html.escape(str(error))}.</p></div>')
    return (f'<iframe srcdoc="{html.escape(page)}" title="holdfast" width="100%" '
            f'height="{height}" style="border: 0"></iframe>')


def _is_notebook() -> bool:
    """Whether a kernel of Jupyter runs this, which shows HTML."""
    if 'IPython' not in sys.modules:
        return False
    shell = sys.modules['IPython'].get_ipython()
    return shell is not None and hasattr(shell, 'kernel')


def show(report: Report, height: int) -> None:
    """In a notebook below the cell, elsewhere in the browser."""
    if _is_notebook():
        display = sys.modules['IPython'].display
        display.display({'text/html': frame(report, height)}, raw=True)
        return
    with tempfile.NamedTemporaryFile('w', suffix='.html', prefix='holdfast-', delete=False,
                                     encoding='utf-8') as file:
        file.write(filled(report))
    webbrowser.open(pathlib.Path(file.name).as_uri())

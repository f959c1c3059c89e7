# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Load ratio and margin over steps, by matplotlib."""
from __future__ import annotations

import json
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib import pyplot  # type: ignore[import]
from matplotlib.patches import Patch  # type: ignore[import]
from matplotlib.ticker import MaxNLocator  # type: ignore[import]

from . import _look
from ._answers import Order, Steps
from ._given import counted
from ._verdict import VERDICTS, Stage

_RATIO_INK, _MARGIN_INK, _LIMIT_INK = '#2f6690', '#3f6b7d', '#d1495b'
_RATIO_WORDS, _MARGIN_WORDS = 'largest load ratio', 'margin, mm'


def _panels(figure: Any, heights: tuple[float, ...]) -> tuple[Any, Any]:
    """A figure with axes one below the other, which share the steps."""
    if figure is None:
        figure = pyplot.figure(figsize=(8, 6), facecolor=_look.CARD, layout='constrained')
    axes = figure.subplots(len(heights), 1, sharex=True, gridspec_kw={'height_ratios': heights})
    for one in axes:
        one.set_facecolor('none')
        for side in ('top', 'right'):
            one.spines[side].set_visible(False)
    axes[-1].xaxis.set_major_locator(MaxNLocator(integer=True))
    return figure, axes


def _limit(axes: Any, value: float, words: str) -> None:
    """A line that must not be reached."""
    axes.axhline(value, color=_LIMIT_INK, linestyle='--', linewidth=1)
    axes.set_ylabel(words)


def _extreme(function: Any, values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Along the stages; NaN where none is known."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)
        extreme: npt.NDArray[np.float64] = function(values, axis=1)
    return extreme


def draw_steps(judged: Steps, figure: Any) -> Any:
    """Bands of stages, then curves; step k is drawn from k to k + 1."""
    figure, (bands, ratio, margin) = _panels(figure, (1, 2, 2))
    stages, count = judged.stages, len(judged)
    edges = np.arange(count + 1)
    for row in range(3):
        inks = [_look.BAND_INKS[VERDICTS[verdict]] for verdict in stages['verdict'][:, row]]
        bands.bar(edges[:-1], 0.85, 1, row - 0.425, align='edge', color=inks)
    bands.set_yticks(range(3), [stage.value for stage in Stage])
    bands.invert_yaxis()
    bands.tick_params(left=False)
    bands.spines[:].set_visible(False)
    found = sorted(set(stages['verdict'].ravel().tolist()))
    bands.legend([Patch(color=_look.BAND_INKS[VERDICTS[one]]) for one in found],
                 [VERDICTS[one].value for one in found], loc='lower left', ncol=4, frameon=False,
                 bbox_to_anchor=(0, 1), borderaxespad=0.2)
    ratio.stairs(_extreme(np.nanmax, stages['load_ratio_max']), edges, baseline=None,
                 color=_RATIO_INK, linewidth=1.6)
    if judged.load_ratio_bound is not None:
        bounds = np.array([[stage.get('load_ratio_bound', np.nan)
                            for stage in step['stages'].values()]
                           for step in json.loads(judged.json())['steps']], dtype=float)
        ratio.stairs(_extreme(np.nanmax, bounds), edges, baseline=None, color='#9db6c9',
                     linewidth=1.2, label='not solved: no more than')
        ratio.legend(loc='upper left', frameon=False)
    margin.stairs(_extreme(np.nanmin, stages['margin_mm']), edges, baseline=None,
                  color=_MARGIN_INK, linewidth=1.6)
    _limit(ratio, 1, _RATIO_WORDS)
    _limit(margin, 0, _MARGIN_WORDS)
    ratio.set_ylim(bottom=min(0, ratio.get_ylim()[0]))
    margin.set_xlim(0, count)
    margin.set_xlabel('step')
    title = f'{judged.robot.name}: {counted(count, "step")}, {judged.verdict.value}'
    if judged.first_unsafe is not None:
        step, stage = judged.first_unsafe
        for axes in (bands, ratio, margin):
            axes.axvline(step, color=_look.INK, linewidth=1)
        title += f'\nfirst unsafe: step {step}, {stage.value}'
    figure.suptitle(title)
    return figure


def draw_order(found: Order, figure: Any) -> Any:
    """What is known after each step; 0 is the start."""
    figure, (size, ratio, margin) = _panels(figure, (1, 2, 2))
    way = json.loads(found.json())['way']
    steps = np.arange(len(way))
    changes = [len(state.get('attach', [])) - len(state.get('detach', [])) for state in way]
    sizes = len(found.start) + max(0, -sum(changes)) + np.cumsum(changes)
    size.plot(steps, sizes, color=_look.INK, drawstyle='steps-post')
    size.set_ylabel('modules')
    for key, words, style in (
            ('load_ratio_max', 'solved', {'marker': 'o', 'color': _RATIO_INK}),
            ('load_ratio_bound', 'not solved: no more than', {
                'marker': 'v', 'color': '#9db6c9', 'markerfacecolor': 'none'})):
        known = np.array([state.get(key) for state in way], dtype=float)
        if np.isfinite(known).any():
            ratio.plot(steps, known, linestyle='none', markersize=4, label=words, **style)
    _limit(ratio, 1, _RATIO_WORDS)
    if ratio.get_legend_handles_labels()[0]:
        ratio.legend(loc='upper left', bbox_to_anchor=(0, 0.97), frameon=False)
    margins = np.array([state['margin_mm'] for state in way], dtype=float)
    margin.plot(steps, margins, color=_MARGIN_INK, marker='.', linewidth=1.2)
    _limit(margin, 0, _MARGIN_WORDS)
    margin.set_xlabel('step')
    titles = {'found': f'an order of {counted(len(found.batches), "step")}',
              'none': 'there is no safe order in one piece', 'not-found': 'no order was found'}
    figure.suptitle(titles[found.outcome.value])
    return figure

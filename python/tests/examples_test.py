# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""The examples run as notebooks, and the document shows what they print."""
import json
import re
import subprocess
import sys

import pytest


def test_notebooks_are_those_of_the_scripts_and_print_what_is_shown(root):
    pytest.importorskip('nbclient')
    pytest.importorskip('ipykernel')
    done = subprocess.run([sys.executable, root / 'tools/notebooks.py', root],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_figure_7_needs_the_iterations_of_an_independent_program(root):
    """To a relative error of 0.1, fixed arms of 8, 10 and 12 modules: 412, 2964, 12144, counted
    in 2026 by a dense solution of Eqs. (1)-(14) that has nothing in common with this one."""
    text = (root / 'docs/python_examples.md').read_text()
    counts = {int(size): int(count) for size, count in
              re.findall(r'^ +(\d+) +(\d+) +\d+$', text, flags=re.M)}
    assert {size: counts[size] for size in (8, 10, 12)} == {8: 412, 10: 2964, 12: 12144}


def test_figure_6_has_the_answers_of_the_scenarios(root):
    """Those of an independent solution, in scenarios/README.md."""
    shown = re.findall(r'^(#\d \([ab]\)) +(\w+) +([+-][\d.]+) *([\d.]*) *$',
                       (root / 'docs/python_examples.md').read_text(), flags=re.M)
    known = {}
    for test, stage, verdict, margin, ratio in re.findall(
            r'\| `\w+` \| (#\d) (\([ab]\)) \| \d+ \| \d+ \| (\w+) \| (\S+) \| *([\d.]*) *\|',
            (root / 'scenarios/README.md').read_text()):
        known.setdefault(f'{test} {stage}', []).append((verdict, margin, ratio[:6]))
    assert len(shown) == 12
    for test, verdict, margin, ratio in shown:
        assert any(verdict == other and margin == limit and abs(
            float(ratio or 0) - float(load or 0)) < 1e-4 for other, limit, load in known[test])


def test_notebooks_in_git_show_what_comes_out_and_are_small(root):
    paths = sorted(root.glob('examples/python/*.ipynb'))
    assert [path.stem for path in paths] == [
        path.stem for path in sorted(root.glob('examples/python/*.py'))]
    for path in paths:
        assert path.stat().st_size < 300_000
        assert any(cell.get('outputs') for cell in json.loads(path.read_text())['cells'])

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Every connection of 320 structures against numbers that were computed independently of this
project (tests/reference/README.md), through Python."""
import json

import holdfast
import numpy as np
import pytest
from holdfast import Verdict


def cell(text):
    return tuple(int(number) for number in text.split(','))


def read_structures(path):
    """Name, cells, planned count, flags, margin, connections by their two cells."""
    lines = iter(path.read_text().splitlines())
    for head in lines:
        _, name, existing, planned, count, settled, stable, tie, margin = head.split()
        cells = [cell(text) for text in next(lines).split()]
        assert len(cells) == int(existing) + int(planned)
        loads = {}
        for _ in range(int(count)):
            a, b, *numbers = next(lines).split()
            loads[frozenset((cells[int(a)], cells[int(b)]))] = [float(number) for number in numbers]
        yield (name, cells, int(existing), settled == '1', stable == '1', tie == '1',
               float(margin), loads)


def by_cells(report):
    """Load ratio, axial force and bending moment by the cells of each connection's ends."""
    cells = [tuple(cell) for cell in report.robot.modules['cell'].tolist()]
    return {frozenset((cells[pair['a']], cells[pair['b']])):
            [row['load_ratio'], row['axial_n'], row['bending_nmm']]
            for pair, row in zip(report.robot.connections, report.connections)}


def relative_differences(expected, found):
    """By column, of the largest number; below 1e-6 there is nothing but rounding."""
    assert found.keys() == expected.keys()
    a = np.array([expected[key] for key in expected])
    b = np.array([found[key] for key in expected])
    return np.abs(a - b).max(axis=0) / np.maximum(np.abs(a).max(axis=0), 1e-6)


def test_structures_of_the_paper_and_random_ones(root):
    count = 0
    for (name, cells, existing, is_settled, is_stable, is_tie, margin,
         loads) in read_structures(root / 'tests/reference/structures.txt'):
        report = holdfast.Robot(np.array(cells[:existing]), planned=cells[existing:]).check()
        stability = report.stability
        # The reference rounds margins to 1e-6 mm.
        assert stability['margin_mm'] == pytest.approx(margin, abs=1e-6), name
        assert stability['is_stable'] == (is_stable and not is_tie), name
        if is_settled:
            assert report.contact_model == 'regularised', name
            assert (relative_differences(loads, by_cells(report)) < 1e-6).all(), name
        largest = max((load[0] for load in loads.values()), default=0)
        if not stability['is_stable']:
            assert report.verdict is Verdict.UNSTABLE, name
        elif is_settled:
            expected = Verdict.OVERLOAD if largest >= 1 else Verdict.SAFE
            assert report.verdict is expected, name
        count += 1
    assert count == 220


def test_general_structures(root):
    """Of other lattices, supports and loads."""
    count = 0
    for line in (root / 'tests/reference/general.jsonl').read_text().splitlines():
        case = json.loads(line)
        expected = case['expected']
        report = holdfast.Robot.from_text(json.dumps(case['structure'])).check()
        if not expected['settled']:
            continue
        loads = {frozenset((tuple(entry['a']), tuple(entry['b']))):
                 [entry['load_ratio'], entry['axial_n'], entry['bending_nmm']]
                 for entry in expected['connections']}
        found = by_cells(report)
        if report.contact_model == 'regularised':
            assert (relative_differences(loads, found) < 1e-6).all(), case['structure']['name']
            count += 1
    assert count > 60  # The others have feet that may slip, or walls: the exact law is asked.

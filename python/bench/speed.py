# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""speed.py   how long checks take from Python beside C++, and how long robots take to come in."""
import statistics
import time

import holdfast
import numpy as np


def best(work, count=5):
    """The shortest of several times, which others on the machine have disturbed least."""
    times = []
    for _ in range(count):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def show_check(robot):
    """What a check takes as the library measures it itself, and as Python sees it."""
    inside = []
    around = []
    for _ in range(3000):
        start = time.perf_counter()
        report = robot.check()
        around.append(time.perf_counter() - start)
        inside.append(report.timings.check)
    inside_us = 1e6 * statistics.median(inside)
    around_us = 1e6 * statistics.median(around)
    allowed = 1.3 * inside_us + 20
    print(f'check of {len(robot)} modules: C++ {inside_us:.1f} us, from Python {around_us:.1f} us; '
          f'allowed {allowed:.1f} us')


def main():
    show_check(holdfast.generate('arm', 29))
    scenario = holdfast.load('scenarios/angle_breaks_b.json')
    show_check(scenario)
    grid = np.stack(np.meshgrid(*[np.arange(100)] * 3, indexing='ij'), axis=-1).reshape(-1, 3)
    print(f'10^6 cells in from numpy: {best(lambda: holdfast.Robot(grid)):.3f} s; allowed 0.2 s')
    robots = [holdfast.generate('growth', 30) for _ in range(10_000)]
    many = best(lambda: holdfast.check_many(robots, threads=2), 3)
    print(f'check_many of {len(robots)} robots of {len(robots[0])} modules on two threads: '
          f'{many:.2f} s; allowed 1.5 s')
    cells = [robot.cells for robot in robots]
    made = best(lambda: [holdfast.Robot(array) for array in cells], 3)
    print(f'{len(cells)} robots of {len(cells[0])} modules in from numpy: {made:.2f} s')


if __name__ == '__main__':
    main()

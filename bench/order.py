#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""order.py HOLDFAST [COUNT_MAX]   time to find an order, by family and number of modules.

Prints a table for tools/plot_lines.py, "family modules seconds", and as comments how many states of
each order were solved instead of being certified by a bound:

    python3 bench/order.py build/release/holdfast 10000 >order.txt
    python3 tools/plot_lines.py "Orders" modules seconds <order.txt >order.svg

Bridges and portals are as long as their connections bear.
"""
import json
import subprocess
import sys
import tempfile

SIZES = {
    'cube': (4, 6, 10, 14, 21),
    'tower': (12, 36, 111, 333, 1111),
    'scaffold': (9, 13, 17, 25, 41),
    'shell': (6, 9, 14, 19),
    'bridge': (8, 9, 10, 11),
    'portal': (8, 12),
    'growth': (100, 300, 1000, 3000, 10000),
    'ball': (6, 9, 14, 20, 30),
    'sheet': (10, 18, 32, 56, 100),
    'prism-wall': (5, 9, 16, 28, 50),
}
SECONDS_MAX = 120


def main():
    program = sys.argv[1]
    count_max = int(sys.argv[2]) if len(sys.argv) > 2 else 1100
    with tempfile.TemporaryDirectory() as folder:
        target = f'{folder}/target.json'
        for family, sizes in SIZES.items():
            for size in sizes:
                subprocess.run([program, 'generate', family, str(size), '-o', target], check=True)
                count = len(json.load(open(target))['modules'])
                if count > count_max:
                    break
                done = subprocess.run([program, 'order', target, '--json', '-', '--help-seconds',
                                       '0', '--seconds', str(SECONDS_MAX)],
                                      capture_output=True, text=True)
                report = json.loads(done.stdout)
                solved = sum('load_ratio_max' in state for state in report['way'])
                print(f'# {family} {size}: {report["result"]}, {count} modules, {solved} solved, '
                      f'load ratio {report["load_ratio_max"]}', flush=True)
                if report['result'] != 'found':
                    break
                print(family, count, report['seconds'], flush=True)


if __name__ == '__main__':
    main()

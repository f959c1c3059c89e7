#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""order.py HOLDFAST [COUNT_MAX [FAMILY ...]]   time to find an order, by family and size.

Prints a table for tools/plot_lines.py, "family modules seconds", of the processor's time on one
thread, so that other work on the machine counts little. As comments: what came out, how many
states of each order were solved instead of being certified by a bound, and the time that passed:

    python3 bench/order.py build/release/holdfast 10000 >order.txt
    python3 tools/plot_lines.py "Orders, one thread" modules seconds <order.txt >docs/order_time.svg

Bridges, portals and shells are as large as their connections bear. A family ends where it found
no order within SECONDS_MAX; progress goes to stderr.
"""
import json
import resource
import subprocess
import sys
import tempfile
import time

SIZES = {
    'cube': (4, 6, 10, 14, 21),
    'tower': (12, 36, 111, 333, 1111),
    'scaffold': (9, 13, 17, 25, 37),
    'shell': (6, 9, 14, 19),
    'bridge': (8, 9, 10, 11),
    'portal': (8, 12),
    'growth': (100, 300, 1000, 3000, 10000),
    'ball': (8, 11, 15, 22, 33),
    'sheet': (10, 18, 32, 56, 100),
    'prism-wall': (5, 9, 15, 28, 50),
}
SECONDS_MAX = 300


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def find_order(program, target):
    """The report, and the processor's seconds and those that passed."""
    begin, used = time.monotonic(), processor_seconds()
    done = subprocess.run([program, 'order', target, '--json', '-', '--help-seconds', '0',
                           '--threads', '1', '--seconds', str(SECONDS_MAX)],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    report = json.loads(done.stdout)
    return report, processor_seconds() - used, time.monotonic() - begin


def main():
    program = sys.argv[1]
    count_max = int(sys.argv[2]) if len(sys.argv) > 2 else 1100
    families = sys.argv[3:] or list(SIZES)
    with tempfile.TemporaryDirectory() as folder:
        target = f'{folder}/target.json'
        for family in families:
            for size in SIZES[family]:
                subprocess.run([program, 'generate', family, str(size), '-o', target], check=True)
                count = len(json.load(open(target))['modules'])
                if count > 1.1 * count_max:
                    break
                print(f'{family} {size}: {count} modules ...', file=sys.stderr, flush=True)
                report, used, passed = find_order(program, target)
                solved = sum('load_ratio_max' in state for state in report['way'])
                print(f'# {family} {size}: {report["result"]}, {solved} solved, '
                      f'load ratio {report["load_ratio_max"]}, {passed:.2f} s passed', flush=True)
                if report['result'] != 'found':
                    break
                print(f'{family} {count} {used:.3f}', flush=True)


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""draw_general.py FOLDER CSV...   the numbers and figures of docs/evidence/elastic_and_limit.md and
docs/evidence/supports.md, from what ./dev bench general prints: limit_over_elastic.svg,
supports.svg
"""
import csv
import math
import pathlib
import sys

from draw_figures import BLUE, GREEN, GREY, INK, RED, Canvas

LATTICES = ('floor', 'cubic', 'face-centred', 'hexagonal', 'hexagonal-prism')
COLOURS = dict(zip(LATTICES, (INK, BLUE, RED, GREEN, '#cc79a7')))
TIE = 1e-6
STANDS = ('stable', 'falls', 'not settled')


def read(files):
    """Rows by kind of table."""
    tables = {'limits': [], 'supports': []}
    for name in files:
        with open(name, encoding='utf-8') as file:
            for row in csv.DictReader(file):
                tables['limits' if 'elastic' in row else 'supports'].append(row)
    return tables


def line(*cells):
    print('| ' + ' | '.join(str(cell) for cell in cells) + ' |')


def share(part, whole):
    return f'{100 * part / whole:.1f} %' if whole else ''


# ---- Elastic and limit load

def ratios(rows):
    """Limit over elastic factor; infinite if unbounded."""
    return sorted(math.inf if row['outcome'] == 'unbounded'
                  else float(row['limit_low']) / float(row['elastic']) for row in rows)


def gain(row, key):
    return float(row[key]) / float(row['elastic'])


def show_limits(rows):
    for law in ('opens', 'friction'):
        for lattice in LATTICES:
            some = [row for row in rows if row['law'] == law and row['lattice'] == lattice]
            if some:
                show_limit_rows(law, lattice, some)
        show_limit_rows(law, 'all', [row for row in rows if row['law'] == law])
    print()
    for lattice in LATTICES + ('all',):
        some = [row for row in rows if row['outcome'] == 'found' and lattice in (
            'all', row['lattice'])]
        beyond = sorted(float(row['elastic']) / float(row['limit_high']) - 1 for row in some)
        above = [row for row in some
                 if float(row['elastic']) > float(row['limit_high']) * (1 + TIE)]
        stages = [row for row in some if max(float(row['brittle_all']), float(
            row['brittle_one'])) > float(row['limit_high']) * (1 + TIE)]
        line(lattice, len(some), len(above), f'{100 * max(beyond[-1], 0):.2f} %' if some else '',
             len(stages), sum(row['outcome'] == 'stopped' for row in rows
                              if lattice in ('all', row['lattice'])))
        for row in above[:3]:
            print(f'  {row["lattice"]} {row["seed"]} {row["law"]}: {row["elastic"]} beyond '
                  f'{row["limit_high"]}')


def show_limit_rows(law, lattice, rows):
    all_ratios = ratios(rows)
    n = len(rows)
    line(law, lattice, n, share(sum(r <= 1 + TIE for r in all_ratios), n),
         share(sum(r <= 1.5 for r in all_ratios), n), f'{all_ratios[n // 2]:.2f}',
         f'{all_ratios[9 * n // 10]:.3g}', share(sum(r == math.inf for r in all_ratios), n))


def show_orders(rows):
    for law in ('opens', 'friction'):
        for lattice in LATTICES + ('all',):
            some = [row for row in rows if row['law'] == law and lattice in ('all', row['lattice'])]
            if not some:
                continue
            n = len(some)
            gains = sorted(gain(row, 'brittle_all') for row in some)
            more = [row for row in some if gain(row, 'brittle_all') > 1 + TIE]
            other = [row for row in some if abs(gain(row, 'brittle_all') - gain(
                row, 'brittle_one')) > TIE * gain(row, 'brittle_all')]
            half = [row for row in more if row['outcome'] == 'found' and float(
                row['brittle_all']) > (float(row['elastic']) + float(row['limit_low'])) / 2]
            line(law, lattice, n, share(len(more), n), f'{gains[99 * n // 100]:.2f}',
                 share(len(half), n), share(len(other), n))


def draw_limits(rows):
    canvas = Canvas(720, 400, 'Limit load over elastic load: how many structures are below')
    for panel, law in enumerate(('opens', 'friction')):
        left, top, width, height = 60 + 340 * panel, 50, 280, 260
        canvas.text((left, 34), ('Eq. (17)', 'with friction')[panel], 'start')

        def place(ratio, part, left=left):
            return (left + width * math.log10(min(ratio, 30)) / math.log10(30),
                    top + height * (1 - part))
        for part in (0, 0.25, 0.5, 0.75, 1):
            canvas.line(place(1, part), place(30, part), colour='#ddd', width=1)
            canvas.text((left - 6, place(1, part)[1] + 4), f'{100 * part:g} %', 'end', size=11)
        for ratio in (1, 1.5, 2, 3, 5, 10, 20):
            canvas.line(place(ratio, 0), place(ratio, 1), colour='#ddd', width=1)
            canvas.text((place(ratio, 0)[0], top + height + 16), f'{ratio:g}', size=11)
        for lattice in LATTICES:
            some = ratios([row for row in rows
                           if row['law'] == law and row['lattice'] == lattice])
            points = [place(1, 0)]
            for i in range(0, len(some), max(1, len(some) // 200)):
                if some[i] > 30:
                    break
                points.append(place(max(some[i], 1), (i + 1) / len(some)))
            canvas.line(*points, colour=COLOURS[lattice], width=2)
        canvas.text((left + width / 2, top + height + 36), 'limit factor / elastic factor')
    for number, lattice in enumerate(LATTICES):
        x = 60 + 130 * number
        canvas.line((x, 374), (x + 20, 374), colour=COLOURS[lattice], width=2)
        canvas.text((x + 26, 378), lattice, 'start', size=12)
    return canvas


# ---- Supports

def show_supports(rows):
    for lattice in LATTICES[1:] + ('all',):
        some = [row for row in rows if lattice in ('all', row['lattice'])]
        n = len(some)
        pairs = [(row['rigid'], row['model']) for row in some]
        line(lattice, n, pairs.count(('holds', 'stable')), pairs.count(('falls', 'falls')),
             f'{pairs.count(("holds", "falls"))}, {share(pairs.count(("holds", "falls")), n)}',
             pairs.count(('falls', 'stable')),
             n - sum(pairs.count((a, b)) for a in ('holds', 'falls') for b in ('stable', 'falls')),
             sum(row['verdict'] == 'undecided' for row in some))
    print()
    for model in ('falls', 'stable'):
        some = [float(row['friction_needed']) for row in rows
                if row['rigid'] == 'holds' and row['model'] == model]
        line(f'holds, {model}', len(some), sum(x == 0 for x in some),
             *(sum(low < x <= high for x in some)
               for low, high in ((0, 0.5), (0.5, 1), (1, math.inf))))
    print()
    for lattice in LATTICES[1:] + ('all',):
        some = [row for row in rows if lattice in ('all', row['lattice'])]
        missing = [row for row in some if row['regularised'] != 'settled']
        line(lattice, len(some), f'{len(missing)}, {share(len(missing), len(some))}',
             *(sum(row['model'] == model for row in missing) for model in STANDS),
             sum(row['open_held'] != '0' for row in missing))


def draw_supports(rows):
    canvas = Canvas(640, 380, 'How often the answers differ, by the number of facets')
    left, top, width, height = 70, 40, 400, 270

    def place(count, part):
        return left + width * (count - 1) / 9, top + height * (1 - part)
    for part in (0, 0.25, 0.5, 0.75, 1):
        canvas.line(place(1, part), place(10, part), colour='#ddd', width=1)
        canvas.text((left - 8, place(1, part)[1] + 4), f'{100 * part:g} %', 'end', size=11)
    for count in range(1, 11):
        canvas.text((place(count, 0)[0], top + height + 18), str(count), size=11)
    canvas.text((left + width / 2, top + height + 42), 'facets that touch something')
    for number, (words, colour, is_it) in enumerate((
            ('rigid holds, model falls', RED,
             lambda row: (row['rigid'], row['model']) == ('holds', 'falls')),
            ('both fall', GREY, lambda row: (row['rigid'], row['model']) == ('falls', 'falls')),
            ('law not settled', BLUE, lambda row: row['regularised'] != 'settled'))):
        points = []
        for count in range(1, 11):
            some = [row for row in rows if int(row['facets']) == count]
            if some:
                points.append(place(count, sum(map(is_it, some)) / len(some)))
        canvas.line(*points, colour=colour, width=2)
        for point in points:
            canvas.dot(point, 3, colour)
        canvas.text((left + width + 14, 80 + 22 * number), words, 'start', colour)
    return canvas


def main():
    folder = pathlib.Path(sys.argv[1])
    tables = read(sys.argv[2:])
    if tables['limits']:
        show_limits(tables['limits'])
        print()
        show_orders(tables['limits'])
        draw_limits(tables['limits']).write(folder / 'limit_over_elastic.svg')
    if tables['supports']:
        show_supports(tables['supports'])
        draw_supports(tables['supports']).write(folder / 'supports.svg')


if __name__ == '__main__':
    main()

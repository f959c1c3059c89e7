#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""draw_test6.py HOLDFAST FOLDER   the numbers and the figure of docs/evidence/test6.md

Checks the structures of test #6 of [Piranda 2021] in scenarios/ under many connector laws, prints
the tables of the note and writes FOLDER/test6.svg.
"""
import json
import pathlib
import subprocess
import sys

from draw_figures import BLUE, GREEN, GREY, INK, PALE, RED, Canvas

SCENARIOS = pathlib.Path(__file__).parent.parent / 'scenarios'
# Connections that break first under some law; the structure is symmetric, each has a twin.
PLACES = {'pillar, top': ([7, 2, 2], [7, 2, 3]), 'upper arm, at the pillar': ([6, 2, 3], [7, 2, 3]),
          'lower arm, at the pillar': ([6, 2, 0], [7, 2, 0]),
          'upper arm, at the corner': ([2, 2, 3], [3, 2, 3])}
FILLS = {'pillar, top': PALE, 'upper arm, at the pillar': '#fde3cf',
         'lower arm, at the pillar': '#d5efe6'}
MATERIAL = {'strength': {'vertical': 11.98, 'lateral': 14.97}, 'lever': 20.0}
PROGRAM = sys.argv[1]


def check(stage, material=None, *options):
    """The report on scenario angle_breaks_STAGE with other numbers of the material."""
    document = json.loads((SCENARIOS / f'angle_breaks_{stage}.json').read_text())
    document.pop('known_answer')
    document.update(version=2, material=material or {})
    out = subprocess.run([PROGRAM, 'check', '-', '--json', '-', *options], check=False,
                         input=json.dumps(document), capture_output=True, text=True)
    return json.loads(out.stdout)


def place_of(a, b):
    """The name of a connection or of its twin, mirrored in the diagonal."""
    for name, place in PLACES.items():
        for ends in (place, [[y, x, z] for x, y, z in place]):
            if sorted((a, b)) == sorted(ends):
                return name
    return f'{tuple(a)}-{tuple(b)}'


def forces(report):
    """What every connection carries, by the name of its place."""
    return {place_of(c['a'], c['b']): c for c in report['connections']}


def ratio(force, lever=None, friction=None, radius=None, sum_radius=None):
    """The load ratio under a law: opens or slips; with `sum_radius` bending and torsion add up."""
    where = 'lateral' if force['a'][2] == force['b'][2] else 'vertical'
    strength = MATERIAL['strength'][where]
    opens = force['axial_n'] + force['bending_nmm'] / (lever or {}).get(where, MATERIAL['lever'])
    torsion = abs(force['torsion_nmm'])
    if sum_radius:
        opens += torsion / sum_radius
    slips = opens
    if friction:
        slips = force['axial_n'] + (force['shear_n'] + torsion / radius) / friction
    return max(opens, slips) / strength


def first(of_b, **law):
    return max((ratio(force, **law), name) for name, force in of_b.items())


def row(*cells):
    print('| ' + ' | '.join(str(cell) for cell in cells) + ' |')


def show_forces(reports):
    for stage, report in reports.items():
        for name in PLACES:
            force = forces(report)[name]
            numbers = [abs(force[key]) for key in ('bending_nmm', 'shear_n', 'torsion_nmm')]
            row(f'({stage})', name, *(f'{x:.2f}' for x in (force['axial_n'], *numbers)),
                f'{force["load_ratio"]:.4f}', f'{force["gap_mm"]:.4f}')


def show_laws():
    """Spot checks by the program itself."""
    laws = [{}, {'lever_mm': {'lateral': 18}}, {'lever_mm': {'lateral': 16}},
            {'lever_mm': {'vertical': 24}},
            {'torsion_strength_nmm': 140}, {'torsion_strength_nmm': 130},
            {'torsion_strength_nmm': 110},
            {'friction': 0.5}, {'friction': 0.5, 'torsion_radius_mm': 15.3},
            {'friction': 0.7, 'torsion_radius_mm': 15.3},
            {'friction': 0.8, 'torsion_radius_mm': 15.3},
            {'friction': 1.0, 'torsion_radius_mm': 15.3},
            {'torsion_mm4': 36000}, {'torsion_mm4': 3600}]
    for law in laws:
        cells = []
        for stage in 'ab':
            report = check(stage, law, '--limit')
            worst = max(report['connections'], key=lambda c: c['load_ratio'])
            cells += [f'{worst["load_ratio"]:.4f}', place_of(worst['a'], worst['b']),
                      worst['limit'], f'{report["limit_load_factor"]:.4f}']
        row(f'`{json.dumps(law)[1:-1]}`' if law else 'Eq. (17)', *cells)


def show_sums(of_a, of_b):
    for radius in (10, 10.5, 11, 15, 20, 30, 32, 33, 34, 40):
        value, name = first(of_b, sum_radius=radius)
        row(radius, f'{first(of_a, sum_radius=radius)[0]:.4f}', f'{value:.4f}', name)


def show_gaps():
    """Openings in all six tests: is #6 different?"""
    for file in sorted(SCENARIOS.glob('*_[ab].json')):
        out = subprocess.run([PROGRAM, 'check', file, '--json', '-'], capture_output=True,
                             text=True, check=False)
        report = json.loads(out.stdout)
        gaps = sorted((c['gap_mm'] for c in report['connections']), reverse=True)
        if report['overload']['meaningful']:
            row(f'`{file.stem}`', len(gaps), f'{gaps[0]:.4f}',
                *(sum(gap > limit for gap in gaps) for limit in (0.005, 0.01)), f'{sum(gaps):.4f}')


def show_borders(reports, of_a, of_b):
    """The laws at which another connection becomes the first, and those at which (a) breaks too."""
    def lever(where):
        return border(10, 30, lambda x: (first(of_b, lever={where: x})[1] == 'pillar, top') == (
            where == 'lateral'), 30)

    def where_first(name, low, high):
        return border(low, high, lambda x: first(of_b, sum_radius=x)[1] == name, 30)
    print(f'lateral lever {lever("lateral"):.2f} mm, vertical lever {lever("vertical"):.2f} mm')
    least = border(10, 20, lambda x: first(of_a, lever={'lateral': x})[0] < 1, 30)
    print(f'(a) holds from a lateral lever of {least:.2f} mm on')
    torsion = {stage: max(abs(c['torsion_nmm']) for c in report['connections'])
               for stage, report in reports.items()}
    print(f'largest torsion in (a) {torsion["a"]:.2f}, in (b) {torsion["b"]:.2f}; twists first in '
          f'(b) below {torsion["b"] / first(of_b)[0]:.2f} N mm')
    print('bending and torsion together: upper arm from '
          f'{where_first("upper arm, at the pillar", 5, 20):.2f} mm to '
          f'{where_first("pillar, top", 20, 50):.2f} mm; (a) holds from '
          f'{border(5, 40, lambda x: first(of_a, sum_radius=x)[0] < 1, 30):.2f} mm')


# ---- The figure

class Plane:
    """A panel with axes."""

    def __init__(self, canvas, corner, x, y, labels):
        self.canvas, self.corner, self.x, self.y = canvas, corner, x, y
        left, top = corner
        canvas.text((left + 130, top + 296), labels[0])
        canvas.text((left - 34, top - 12), labels[1], 'start')

    def place(self, x, y):
        left, top = self.corner
        return (left + 260 * (x - self.x[0]) / (self.x[1] - self.x[0]),
                top + 260 * (self.y[1] - y) / (self.y[1] - self.y[0]))

    def fill(self, colour_at, count=65):
        """Runs of one colour, row by row."""
        wide = (self.x[1] - self.x[0]) / count
        high = (self.y[1] - self.y[0]) / count
        for j in range(count):
            y = self.y[0] + (j + 0.5) * high
            colours = [colour_at(self.x[0] + (i + 0.5) * wide, y) for i in range(count)]
            start = 0
            for i in range(1, count + 1):
                if i == count or colours[i] != colours[start]:
                    a = self.place(self.x[0] + start * wide, y + high / 2)
                    b = self.place(self.x[0] + i * wide, y - high / 2)
                    self.canvas.parts.append(
                        f'<rect x="{a[0]:.1f}" y="{a[1]:.1f}" width="{b[0] - a[0]:.1f}" '
                        f'height="{b[1] - a[1] + 0.3:.1f}" fill="{colours[start]}"/>')
                    start = i

    def axes(self, x_ticks, y_ticks):
        left, top = self.corner
        self.canvas.line((left, top), (left + 260, top), (left + 260, top + 260),
                         (left, top + 260), (left, top))
        for x in x_ticks:
            self.canvas.text((self.place(x, 0)[0], top + 276), f'{x:g}', size=11)
        for y in y_ticks:
            self.canvas.text((left - 6, self.place(0, y)[1] + 4), f'{y:g}', 'end', size=11)


def border(low, high, is_above, steps=12):
    """Where a property that grows begins to hold, by halving."""
    for _ in range(steps):
        middle = (low + high) / 2
        low, high = (low, middle) if is_above(middle) else (middle, high)
    return (low + high) / 2


def limit_border(stage, radius):
    """The friction from which on some forces balance the loads."""
    return border(0.05, 1.5, lambda friction: (check(
        stage, {'friction': friction, 'torsion_radius_mm': radius},
        '--limit')['limit_load_factor'] or 1e9) >= 1)


def draw(of_a, of_b):
    canvas = Canvas(700, 470, 'Test #6 (b): which connection breaks first')

    def colour(law):
        if first(of_a, **law)[0] >= 1:
            return '#bbb'  # (a) would have broken, and it stood.
        return FILLS[first(of_b, **law)[1]]

    levers = Plane(canvas, (60, 50), (10, 20), (15, 30),
                   ('lever of lateral connections, mm', 'lever of vertical connections, mm'))
    levers.fill(lambda x, y: colour({'lever': {'lateral': x, 'vertical': y}}))
    levers.axes((10, 12, 14, 16, 18, 20), (15, 20, 25, 30))
    canvas.dot(levers.place(20, 20), 4, INK)
    slip = Plane(canvas, (410, 50), (0.2, 1.4), (5, 28),
                 ('coefficient of friction', 'torsion radius, mm'))
    slip.fill(lambda x, y: colour({'friction': x, 'radius': y}))
    radii = (5, 6.5, 8, 11, 14, 17, 20, 24, 28)
    for stage, shade in (('a', GREEN), ('b', RED)):
        points = [(limit_border(stage, radius), radius) for radius in radii]
        canvas.line(*(slip.place(x, y) for x, y in points if x <= 1.4), colour=shade, width=2)
        print(f'limit load of ({stage}) is 1 at (friction, radius):',
              ', '.join(f'({x:.3f}, {y})' for x, y in points))
    slip.axes((0.2, 0.4, 0.6, 0.8, 1, 1.2, 1.4), (5, 10, 15, 20, 25))
    for number, (shade, words) in enumerate((
            (PALE, 'pillar, top'), ('#fde3cf', 'upper arm, at the pillar'),
            ('#d5efe6', 'lower arm, at the pillar'), ('#bbb', 'excluded: (a) breaks as well'))):
        left, top = 60 + 320 * (number % 2), 372 + 22 * (number // 2)
        canvas.parts.append(f'<rect x="{left}" y="{top}" width="16" height="14" fill="{shade}" '
                            f'stroke="{GREY}"/>')
        canvas.text((left + 24, top + 12), words, 'start')
    canvas.line((60, 430), (84, 430), colour=GREEN, width=2)
    canvas.text((92, 434), 'left of it no forces balance (a)', 'start')
    canvas.line((380, 430), (404, 430), colour=RED, width=2)
    canvas.text((412, 434), 'left of it no forces balance (b)', 'start')
    canvas.text((60, 458), 'Dot: Eq. (17), levers of half a face.', 'start', BLUE, 12)
    return canvas


def main():
    reports = {stage: check(stage) for stage in 'ab'}
    of_a, of_b = (forces(reports[stage]) for stage in 'ab')
    show_forces(reports)
    print()
    show_laws()
    print()
    show_sums(of_a, of_b)
    print()
    show_gaps()
    print()
    show_borders(reports, of_a, of_b)
    draw(of_a, of_b).write(pathlib.Path(sys.argv[2]) / 'test6.svg')


if __name__ == '__main__':
    main()

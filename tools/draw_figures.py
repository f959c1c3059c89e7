#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""draw_figures.py FOLDER   writes the figures of docs/ that explain (those that measure are made by
plot_lines.py): element.svg, hierarchy.svg, sweep.svg, conductor.svg. White ground, so that they
read the same on light and dark pages.
"""
import html
import math
import pathlib
import sys

INK, PALE, BLUE, RED, GREEN, GREY = '#222', '#e8eef4', '#0072b2', '#d55e00', '#007a5a', '#777'


class Canvas:
    """Lines, arrows and words of one picture."""

    def __init__(self, width, height, title):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'font-family="sans-serif" font-size="13" fill="{INK}">',
            f'<title>{html.escape(title)}</title>',
            f'<rect width="{width}" height="{height}" fill="#fff"/>']

    def text(self, at, words, anchor='middle', colour=INK, size=13, style=''):
        self.parts.append(f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" '
                          f'fill="{colour}" font-size="{size}"{style}>{html.escape(words)}</text>')

    def heading(self, at, words):
        self.text(at, words, 'start', INK, 14, ' font-weight="bold"')

    def path(self, data, colour=INK, width=1.5, fill='none', dash='', more=''):
        dashes = f' stroke-dasharray="{dash}"' if dash else ''
        self.parts.append(f'<path d="{data}" fill="{fill}" stroke="{colour}" '
                          f'stroke-width="{width}"{dashes}{more}/>')

    def line(self, *points, **how):
        self.path('M' + 'L'.join(f'{x:.1f} {y:.1f}' for x, y in points), **how)

    def arrow(self, *points, **how):
        # Every arrow has its head drawn by hand: markers that take their line's colour are young.
        colour, width = how.get('colour', INK), how.get('width', 1.5)
        (x0, y0), (x1, y1) = points[-2], points[-1]
        length = math.hypot(x1 - x0, y1 - y0)
        u, v = (x1 - x0) / length, (y1 - y0) / length
        self.line(*points[:-1], (x1 - 7 * u, y1 - 7 * v), **how)
        self.head((x1, y1), (u, v), colour, 4.0 + width / 2)

    def head(self, at, along, colour, half=4.5):
        (x, y), (u, v) = at, along
        self.path(f'M{x:.1f} {y:.1f}L{x - 10 * u - half * v:.1f} {y - 10 * v + half * u:.1f}'
                  f'L{x - 10 * u + half * v:.1f} {y - 10 * v - half * u:.1f}z',
                  colour, 0, colour)

    def turn(self, centre, radius, start, sweep, **how):
        """An arc with a head, degrees, counterclockwise positive."""
        colour = how.get('colour', INK)
        at = [(centre[0] + radius * math.cos(math.radians(angle)),
               centre[1] - radius * math.sin(math.radians(angle)))
              for angle in (start, start + sweep)]
        self.path(f'M{at[0][0]:.1f} {at[0][1]:.1f}A{radius} {radius} 0 '
                  f'{int(abs(sweep) > 180)} {int(sweep < 0)} {at[1][0]:.1f} {at[1][1]:.1f}', **how)
        end = math.radians(start + sweep + (12 if sweep > 0 else -12))
        sign = 1 if sweep > 0 else -1
        along = (-math.sin(end) * sign, -math.cos(end) * sign)
        self.head((at[1][0] + 5 * along[0], at[1][1] + 5 * along[1]), along, colour)

    def dot(self, at, radius=4.5, colour=INK, fill=None):
        self.parts.append(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{radius}" '
                          f'fill="{fill or colour}" stroke="{colour}"/>')

    def box(self, corner, size, words, fill=PALE, colour=INK, dash=''):
        (x, y), (width, height) = corner, size
        dashes = f' stroke-dasharray="{dash}"' if dash else ''
        self.parts.append(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="6" '
                          f'fill="{fill}" stroke="{colour}"{dashes}/>')
        lines = words.split('\n')
        for number, line in enumerate(lines):
            self.text((x + width / 2, y + height / 2 + 4.5 + 16 * (number - (len(lines) - 1) / 2)),
                      line, size=13 if number == 0 else 11.5, colour=INK if number == 0 else GREY)

    def write(self, file):
        file.write_text('\n'.join(self.parts + ['</svg>\n']), encoding='utf-8')


# ---- The element: axes, beam, facet, signs.

def draw_cube(canvas, view, low, high, fill):
    corner = [view((x, y, z)) for x in (low[0], high[0]) for y in (low[1], high[1])
              for z in (low[2], high[2])]
    for face in ((0, 4, 5, 1), (1, 5, 7, 3), (4, 6, 7, 5)):
        canvas.line(*(corner[i] for i in face + face[:1]), colour=GREY, width=1, fill=fill,
                    more=' fill-opacity="0.55"')
    for a, b in ((0, 2), (2, 3), (2, 6)):
        canvas.line(corner[a], corner[b], colour=GREY, width=0.8, dash='3 3')


def draw_pair(canvas):
    canvas.heading((20, 28), '1  Two modules, one beam')

    def view(point):
        x, y, z = point
        return 112 + 110 * x + 45 * y, 190 + -110 * z - 34 * y
    for x in (0, 1):
        draw_cube(canvas, view, (x - .5, -.5, -.5), (x + .5, .5, .5), PALE)
    q, p, middle = view((0, 0, 0)), view((1, 0, 0)), view((.5, 0, 0))
    canvas.line(q, p, colour=INK, width=5)
    for node, name in ((q, 'q'), (p, 'p')):
        canvas.dot(node, 6)
        canvas.text((node[0], node[1] + 23), name, size=15)
    for end, name, at in (((1, 0, 0), "z'", (6, 17)), ((.5, 0, .58), "x'", (-11, 2)),
                          ((.5, -.95, 0), "y'", (-4, 16))):
        tip = view(end) if name != "z'" else view((.93, 0, 0))
        canvas.arrow(middle, tip, colour=RED, width=2.2)
        canvas.text((tip[0] + at[0] - (14 if name == "z'" else 0), tip[1] + at[1]), name,
                    colour=RED, size=15)
    canvas.line(view((0, -.5, -.62)), view((1, -.5, -.62)), width=1)
    for x in (0, 1):
        canvas.line(view((x, -.5, -.57)), view((x, -.5, -.67)), width=1)
    canvas.text((view((.5, -.5, -.75))[0], view((.5, -.5, -.75))[1] + 3), 'pitch L')
    origin = (42, 330)
    for tip, name, at in (((42, 0), 'x', (12, 4)), ((24, -19), 'y', (10, -1)),
                          ((0, -42), 'z', (0, -7))):
        canvas.arrow(origin, (origin[0] + tip[0], origin[1] + tip[1]), colour=BLUE, width=2)
        canvas.text((origin[0] + tip[0] + at[0], origin[1] + tip[1] + at[1]), name, colour=BLUE,
                    size=15)
    canvas.text((112, 322), 'x, y, z: global, z up', 'start', BLUE)
    canvas.text((112, 340), "x', y', z': of the beam, seen from p", 'start', RED)


def draw_signs(canvas):
    canvas.heading((400, 28), "2  Positive forces and turns, plane x' z'")
    q, p = (440, 130), (700, 130)
    canvas.line(q, p, width=5)
    for node, name in ((q, 'q'), (p, 'p')):
        canvas.dot(node, 6)
        canvas.text((node[0] + (-17 if name == 'q' else -5), node[1] + 24), name, size=15)
    canvas.arrow(p, (700, 68), colour=RED, width=2.2)
    canvas.text((688, 74), 'fx', 'end', RED)
    canvas.arrow(p, (762, 130), colour=RED, width=2.2)
    canvas.text((762, 150), 'fz', 'end', RED)
    canvas.turn(p, 30, -65, 130, colour=RED, width=2.2)
    canvas.text((732, 99), 'my', 'start', RED)
    words = ['F_pq is what node p does to the end of the beam;',
             'displacements and turns of p point the same way.',
             'fz > 0 is tension. At q the forces are opposite, and the',
             'beam is in balance: my_p + my_q + L fx = 0.']
    for number, line in enumerate(words):
        canvas.text((400, 186 + 17 * number), line, 'start')
    cut = 570
    canvas.line((cut, 108), (cut, 152), colour=GREEN, width=2, dash='5 3')
    canvas.text((cut, 100), 'the connection, Eq. (16)', colour=GREEN)
    for number, line in enumerate(['In the middle, where two faces meet, fz and the larger',
                                   'of |mx| and |my| meet the strength, Eq. (17).']):
        canvas.text((400, 272 + 17 * number), line, 'start', GREEN)
    canvas.text((400, 324), "Lateral beams: x' = z, up. Vertical beams: x' = x.", 'start')
    canvas.text((400, 341), "z' always points from the neighbour to the module.", 'start')


def draw_facet(canvas):
    canvas.heading((20, 388), '3  A facet on the ground, from the side')
    left, top, side = 90, 415, 110
    node, facet, ground = (145, 470), (145, 525), (145, 580)
    canvas.parts.append(f'<rect x="{left}" y="{top}" width="{side}" height="{side}" fill="{PALE}" '
                        f'stroke="{GREY}"/>')
    canvas.line((30, 525), (300, 525), width=1.5)
    for x in range(30, 300, 15):
        canvas.line((x, 533), (x + 8, 525), colour=GREY, width=0.8)
    canvas.line(node, ground, width=5)
    canvas.dot(node, 6)
    canvas.dot(ground, 6, INK, '#fff')
    canvas.text((133, 464), 'p', 'end', size=15)
    canvas.text((145, 607), 'ground node, immobile')
    canvas.arrow(facet, (145, 492), colour=RED, width=2.2)
    canvas.text((152, 500), 'fz', 'start', RED)
    canvas.arrow(facet, (188, 525), colour=RED, width=2.2)
    canvas.text((193, 520), 'fx', 'start', RED)
    canvas.turn(facet, 24, 160, -140, colour=RED, width=2.2)
    canvas.text((118, 505), 'my^', 'end', RED)
    canvas.line((222, 470), (222, 525), width=1)
    canvas.line((217, 470), (227, 470), width=1)
    canvas.text((230, 502), 'L/2', 'start')
    canvas.line((90, 548), (200, 548), width=1)
    for x in (90, 200):
        canvas.line((x, 543), (x, 553), width=1)
    canvas.text((206, 553), 'facet, width a', 'start')
    canvas.text((310, 440), 'fz < 0 presses, the', 'start')
    canvas.text((310, 457), 'ground cannot pull.', 'start')
    canvas.text((310, 480), 'Torques mx^, my^ about', 'start')
    canvas.text((310, 497), "the facet's centre.", 'start')
    canvas.text((310, 560), 'It tilts where |my^|', 'start')
    canvas.text((310, 577), 'reaches -fz a/2.', 'start')


def draw_edges(canvas):
    canvas.heading((500, 388), '4  The same facet from above')
    canvas.parts.append(f'<rect x="575" y="435" width="110" height="110" fill="{PALE}" '
                        f'stroke="{GREY}"/>')
    for x in (575, 685):
        for y in (435, 545):
            canvas.dot((x, y), 4.5, GREEN)
    centre = (630, 490)
    canvas.dot(centre, 3)
    canvas.arrow(centre, (668, 490), colour=BLUE, width=1.8)
    canvas.text((667, 506), 'x', colour=BLUE, size=15)
    canvas.arrow(centre, (630, 452), colour=BLUE, width=1.8)
    canvas.text((619, 460), 'y', colour=BLUE, size=15)
    for at, anchor, words in (((695, 494), 'start', 'my^ > 0'), ((565, 494), 'end', 'my^ < 0'),
                              ((630, 425), 'middle', 'mx^ < 0'), ((630, 564), 'middle', 'mx^ > 0')):
        canvas.text(at, words, anchor, RED)
    canvas.text((500, 590), 'At each edge: the torque that tips over it.', 'start')
    canvas.text((500, 607), 'Green: the corners that may press.', 'start', GREEN)


def element():
    canvas = Canvas(780, 620, 'Axes, beam, facet and signs')
    draw_pair(canvas)
    draw_signs(canvas)
    canvas.line((20, 364), (760, 364), colour='#ccc', width=1)
    draw_facet(canvas)
    draw_edges(canvas)
    return canvas


FIGURES = {'element': element}


def main():
    folder = pathlib.Path(sys.argv[1])
    for name, draw in FIGURES.items():
        draw().write(folder / f'{name}.svg')


if __name__ == '__main__':
    main()

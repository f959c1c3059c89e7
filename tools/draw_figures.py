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


# ---- The hierarchy: a block, an arm that hangs on it, and a leg.

BLOCK = [(x, y) for x in range(8) for y in range(4)]
RUN = [(x, 3) for x in range(8, 13)] + [(13, 2), (13, 1)]
HANGING = [(2, 4), (2, 5), (3, 5), (4, 5)]
CORNERS = [(13, 3), (13, 0)]
STEP = 22


def clusters_of(width):
    """Nodes by the cell of this width that they lie in; here each is one connected part."""
    found = {}
    for x, y in BLOCK + CORNERS:
        found.setdefault((x // width, y // width), []).append((x, y))
    return list(found.values())


def centre_of(nodes):
    return tuple(sum(node[axis] for node in nodes) / len(nodes) for axis in (0, 1))


def place(origin, node):
    return origin[0] + STEP * node[0] + STEP / 2, origin[1] + 132 - STEP * node[1] - STEP / 2


def draw_robot(canvas, origin):
    for cells, fill in ((BLOCK + CORNERS, PALE), (RUN, '#fde3cf'), (HANGING, '#d5efe6')):
        for x, y in cells:
            left, top = origin[0] + STEP * x, origin[1] + 110 - STEP * y
            canvas.parts.append(f'<rect x="{left}" y="{top}" width="{STEP}" height="{STEP}" '
                                f'fill="{fill}" stroke="{GREY}"/>')
    canvas.line((origin[0] - 6, origin[1] + 132), (origin[0] + 314, origin[1] + 132), width=2)


def draw_network(canvas, origin):
    for x, y in BLOCK:
        for other in ((x + 1, y), (x, y + 1)):
            if other in BLOCK:
                canvas.line(place(origin, (x, y)), place(origin, other), colour=GREY, width=1.5)
    for a, b in (((7, 3), (13, 3)), ((13, 3), (13, 0))):
        canvas.line(place(origin, a), place(origin, b), colour=RED, width=3)
    for node in BLOCK + CORNERS:
        even = (node[0] + node[1]) % 2 == 0
        canvas.dot(place(origin, node), 4, INK, INK if even else '#fff')
    x, y = place(origin, (2, 3))
    canvas.arrow((x, y - 46), (x, y - 8), colour=GREEN, width=2)
    canvas.turn((x, y), 24, 130, -80, colour=GREEN, width=1.6)
    canvas.text((x + 28, y - 30), 'weight and lever of what hung there', 'start', GREEN, 12)


def draw_level(canvas, origin, width, pairs):
    for nodes in clusters_of(width):
        low = [min(node[axis] for node in nodes) for axis in (0, 1)]
        high = [max(node[axis] for node in nodes) for axis in (0, 1)]
        canvas.parts.append(
            f'<rect x="{origin[0] + STEP * low[0] + 2}" '
            f'y="{origin[1] + 112 - STEP * high[1]}" '
            f'width="{STEP * (high[0] - low[0] + 1) - 4}" '
            f'height="{STEP * (high[1] - low[1] + 1) - 4}" rx="6" '
            f'fill="{PALE}" stroke="{GREY}"/>')
    centres = [centre_of(nodes) for nodes in clusters_of(width)]
    for a in centres:
        for b in centres:
            if a < b and pairs(a, b):
                canvas.line(place(origin, a), place(origin, b), colour=BLUE, width=2.5)
    for centre in centres:
        canvas.dot(place(origin, centre), 5)


def draw_cycle(canvas, top):
    canvas.heading((20, top), 'One K-cycle, z = M^-1 r')
    levels = [top + 46, top + 106, top + 166]
    for y, name in zip(levels, ('level 0: the network', 'level 1', 'level 2: coarsest')):
        canvas.text((20, y + 4), name, 'start')
    canvas.parts.append(f'<rect x="268" y="{top + 76}" width="372" height="118" rx="10" '
                        f'fill="none" stroke="{BLUE}" stroke-dasharray="5 4"/>')
    spots = [(212, levels[0], 'relax'), (324, levels[1], 'relax'), (454, levels[2], 'solve'),
             (584, levels[1], 'relax'), (696, levels[0], 'relax')]
    for (x0, y0, _), (x1, y1, _) in zip(spots, spots[1:]):
        down = y1 > y0
        canvas.arrow((x0 + (24 if down else 44), y0 + (21 if down else 0)),
                     (x1 - (44 if down else 24), y1 + (0 if down else 21)))
    notes = ['colours 1, 2', 'colours 1, 2', 'factorized', 'colours 2, 1', 'colours 2, 1']
    for (x, y, words), note in zip(spots, notes):
        canvas.box((x - 44, y - 19), (88, 40), f'{words}\n{note}')
    canvas.text((222, levels[1] - 10), 'forces left', 'middle', GREY, 12)
    canvas.text((698, levels[1] - 10), 'rigid motions', 'middle', GREY, 12)
    canvas.text((454, levels[1] - 8), 'twice at most, as steps', 'middle', BLUE, 12)
    canvas.text((454, levels[1] + 8), 'of conjugate gradients', 'middle', BLUE, 12)


def hierarchy():
    canvas = Canvas(780, 612, 'From modules to the coarsest level, and one cycle')
    left, right, upper, lower = 24, 424, 52, 218
    canvas.heading((left, upper - 24), '1  Modules: 45')
    draw_robot(canvas, (left, upper))
    canvas.heading((right, upper - 24), '2  Reduced network: 34 nodes, 2 colours')
    draw_network(canvas, (right, upper))
    canvas.text((right + 196, upper + 84), 'runs are single', 'start', RED, 12)
    canvas.text((right + 196, upper + 100), 'longer beams', 'start', RED, 12)
    canvas.heading((left, lower + 22), '3  Level 1: clusters in cells of 2')
    draw_level(canvas, (left, lower), 2,
               lambda a, b: abs(a[0] - b[0]) + abs(a[1] - b[1]) < 2.1 or (a, b) == (
                   (6.5, 2.5), (13.0, 3.0)) or a[0] == b[0] == 13)
    canvas.heading((right, lower + 22), '4  Level 2: clusters in cells of 4')
    draw_level(canvas, (right, lower), 4,
               lambda a, b: a == (1.5, 1.5) and b == (5.5, 1.5) or a == (5.5, 1.5))
    for number, words in enumerate(('springs reach', 'from centre', 'to centre')):
        canvas.text((left + 188, lower + 84 + 16 * number), words, 'start', BLUE, 12)
    canvas.line((20, 374), (760, 374), colour='#ccc', width=1)
    draw_cycle(canvas, 402)
    return canvas


# ---- One sweep: an order down the tree, exchanges with neighbours, reports up.

LANES = {'root': 150, 'inner': 390, 'leaf': 630}


def draw_lanes(canvas, bottom):
    for (lane, x), words in zip(LANES.items(), ('root\nwith the conductor', 'a module between\n',
                                                'a leaf\nno children')):
        canvas.box((x - 66, 14), (132, 42), words.strip('\n'))
        canvas.line((x, 56), (x, bottom), colour=GREY, width=1, dash='4 4')


def message(canvas, source, target, y, words, colour=INK, drop=14):
    x0, x1 = LANES[source], LANES[target]
    side = 5 if x1 > x0 else -5
    canvas.arrow((x0 + side, y), (x1 - side, y + drop), colour=colour)
    canvas.text(((x0 + x1) / 2, y - 2 + (0 if drop < 8 else 3)), words, colour=colour, size=12)


def exchange(canvas, pair, y, words):
    a, b = (LANES[name] for name in pair)
    canvas.arrow((b - 5, y), (a + 5, y), colour=BLUE)
    canvas.arrow((a + 5, y), (b - 5, y), colour=BLUE)
    canvas.text(((a + b) / 2, y - 5), words, colour=BLUE, size=12)


def work(canvas, lane, y, words, height=20, side=58):
    canvas.box((LANES[lane] - side, y), (2 * side, height), words, '#fff', GREY)


def draw_iteration(canvas):
    message(canvas, 'root', 'inner', 68, 'order: iterate')
    work(canvas, 'root', 84, 'u := u + correction')
    message(canvas, 'inner', 'leaf', 90, 'order: iterate')
    work(canvas, 'inner', 108, 'u := u + correction')
    work(canvas, 'leaf', 112, 'u := u + correction')
    for y, words in ((176, 'vector: leading digits of u'), (206, 'vector: the other digits')):
        exchange(canvas, ('root', 'inner'), y, words)
        exchange(canvas, ('inner', 'leaf'), y, words)
    for lane in LANES:
        work(canvas, lane, 222, 'r = f - K(s) u, state s', side=78)
    message(canvas, 'leaf', 'inner', 258, 'report: sums of r', GREEN)
    work(canvas, 'inner', 277, 'adds its own')
    message(canvas, 'inner', 'root', 301, 'report: sums of r', GREEN)
    work(canvas, 'root', 320, 'makes the next order', side=74)
    for y, words in ((334, 'vector: first term of M^-1 r'), (392, 'vector: last term of M^-1 r')):
        exchange(canvas, ('inner', 'leaf'), y, words)
    exchange(canvas, ('root', 'inner'), 364, 'vector: first term')
    exchange(canvas, ('root', 'inner'), 418, 'vector: last term')
    message(canvas, 'root', 'inner', 444, 'order: the next one')
    message(canvas, 'inner', 'leaf', 476, 'order: the next one')


def sweep():
    canvas = Canvas(800, 520, 'One sweep: an order down, exchanges, reports up')
    draw_lanes(canvas, 505)
    draw_iteration(canvas)
    for top, bottom, words in ((66, 132, ('down:', 'depth', 'rounds')),
                               (164, 246, ('exchange:', '2 rounds')),
                               (252, 326, ('up:', 'depth', 'rounds')),
                               (332, 430, ('behind it:', 'm rounds,', 'mostly in', 'idle time'))):
        canvas.line((714, top), (720, top), (720, bottom), (714, bottom), colour=GREY, width=1)
        for number, word in enumerate(words):
            canvas.text((726, (top + bottom) / 2 + 4 + 15 * (number - (len(words) - 1) / 2)), word,
                        'start', GREY, 11)
    return canvas


# ---- The conductor: from each report to the next order.

STATES = {  # name: centre, what else it may be
    'plan': (70, 86, 'or forget'), 'hosts': (190, 86, ''), 'mass': (310, 86, ''),
    'angles': (430, 86, ''), 'begin': (580, 86, 'or clusters'),
    'factor': (470, 206, ''), 'iterate': (600, 206, 'or tree iterate'),
    'corners': (600, 316, ''), 'release': (310, 426, 'order: hold'),
    'free': (430, 426, 'order: hold'), 'loads': (600, 426, ''), 'verdict': (600, 520, '')}
FILLS = {**dict.fromkeys(('factor', 'iterate'), '#d5efe6'),
         **dict.fromkeys(('corners', 'release', 'free', 'loads', 'verdict'), '#f3f3f3')}
AGAIN = {'plan': -1, 'iterate': 1}
EDGES = [  # corners of the way, colour
    ((114, 86), (146, 86)), ((234, 86), (266, 86)), ((354, 86), (386, 86)), ((474, 86), (536, 86)),
    ((310, 66), (310, 44), (580, 44), (580, 66)),
    ((430, 66), (430, 26), (764, 26), (764, 520), (644, 520)),
    ((560, 106), (560, 150), (470, 150), (470, 186)), ((600, 106), (600, 186)),
    ((514, 206), (556, 206)), ((580, 226), (580, 250), (470, 250), (470, 226)),
    ((612, 226), (612, 296)), ((556, 316), (330, 316), (330, 406)),
    ((290, 406), (290, 274), (596, 274), (596, 226)), ((430, 406), (430, 274)),
    ((556, 426), (474, 426)), ((310, 446), (310, 470), (580, 470), (580, 446)),
    ((610, 336), (610, 406)), ((600, 446), (600, 500))]
RED_EDGES = [((644, 191), (694, 191), (694, 98), (624, 98)),
             ((644, 316), (744, 316), (744, 74), (624, 74))]
WORDS = [((506, 39), 'a module is fixed', INK), ((690, 21), 'topples', INK),
         ((516, 145), 'elimination', INK), ((634, 146), 'polynomial', INK),
         ((525, 245), 'new states', INK), ((640, 264), 'settled', INK),
         ((370, 269), 'freed', INK), ((510, 311), 'under law 2', INK),
         ((516, 420), 'open, held', INK), ((445, 465), 'none', INK),
         ((662, 184), 'stuck', RED), ((692, 311), 'contradict: law 2', RED)]
NOTES = ['Green: iterations, one sweep each.', 'Law 2: the unilateral one, Eqs. (6)-(8).',
         'Settled: of a robot with a fixed module, loads comes next; behind free, the verdict.',
         'Stuck: begin without clusters if there were any, else with the next method or law.',
         'Before a verdict that is safe: bend, where the elastic modulus is stated.',
         'From every state: verdict, undecided, with the reason.']


def conductor():
    canvas = Canvas(780, 662, 'What the root orders next')
    for points in EDGES:
        canvas.arrow(*points, width=1.3)
    for points in RED_EDGES:
        canvas.arrow(*points, width=1.3, colour=RED)
    for name, side in AGAIN.items():
        x, y, _ = STATES[name]
        canvas.turn((x + side * 47, y), 11, 50 if side < 0 else 130, -side * 260, width=1.3)
    for name, (x, y, note) in STATES.items():
        canvas.box((x - 44, y - 20), (88, 40), name + (f'\n{note}' if note else ''),
                   FILLS.get(name, PALE))
    for at, words, colour in WORDS:
        canvas.text(at, words, colour=colour, size=11)
    for number, words in enumerate(NOTES):
        canvas.text((24, 560 + 17 * number), words, 'start', size=12)
    return canvas


FIGURES = {'element': element, 'hierarchy': hierarchy, 'sweep': sweep, 'conductor': conductor}


def main():
    folder = pathlib.Path(sys.argv[1])
    for name, draw in FIGURES.items():
        draw().write(folder / f'{name}.svg')


if __name__ == '__main__':
    main()

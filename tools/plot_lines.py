#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""plot_lines.py TITLE X_LABEL Y_LABEL <table >picture.svg

Draws lines in a plane with logarithmic axes. Each line of the table is "series x y ..."; lines that
begin with # are left out. A series whose name begins with "slope" is dashed.
"""
import math
import sys

WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 720, 440, 70, 50, 40, 150
# Okabe and Ito's, with black; then of Tol's muted ones.
COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000',
           '#882255', '#999933', '#332288']


def read_series(lines):
    series = {}
    for line in lines:
        words = line.split()
        if len(words) >= 3 and not line.startswith('#') and float(words[2]) > 0:
            series.setdefault(words[0], []).append((float(words[1]), float(words[2])))
    return series


def ticks(low, high):
    """1, 2 and 5 times powers of ten; only the powers if there are many."""
    steps = [1] if math.log10(high / low) > 2.5 else [1, 2, 5]
    exponents = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    values = [step * 10 ** exponent for exponent in exponents for step in steps]
    return [value for value in values if low <= value <= high]


def label(value):
    if value < 1e5:
        return f'{value:,g}'
    exponent = math.floor(math.log10(value) + 1e-9)
    lead = round(value / 10 ** exponent)
    return f'10^{exponent}' if lead == 1 else f'{lead} 10^{exponent}'


def place_names(ends):
    """Where the names of lines that end there stand, from the top down, none on another."""
    placed = []
    for x, y, name, colour in sorted(ends, key=lambda end: end[1]):
        while any(abs(x - other[0]) < 60 and abs(y - other[1]) < 14 for other in placed):
            y += 1
        placed.append((x, y, name, colour))
    return placed


def main():
    title, x_label, y_label = sys.argv[1:4]
    series = read_series(sys.stdin)
    points = [point for line in series.values() for point in line]
    x_low, x_high = min(x for x, _ in points), max(x for x, _ in points)
    y_low, y_high = min(y for _, y in points), max(y for _, y in points)

    def x_of(value):
        return LEFT + (WIDTH - LEFT - RIGHT) * math.log(value / x_low) / math.log(x_high / x_low)

    def y_of(value):
        return HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * (
            math.log(value / y_low) / math.log(y_high / y_low))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
           'font-family="sans-serif" font-size="12" fill="#222">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
           f'<text x="{LEFT}" y="22" font-size="15">{title}</text>']
    for value in ticks(x_low, x_high):
        out.append(f'<path d="M{x_of(value):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                   f'<text x="{x_of(value):.1f}" y="{HEIGHT - BOTTOM + 18}" '
                   f'text-anchor="middle">{label(value)}</text>')
    for value in ticks(y_low, y_high):
        out.append(f'<path d="M{LEFT} {y_of(value):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 6}" y="{y_of(value) + 4:.1f}" '
                   f'text-anchor="end">{label(value)}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" '
               f'text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(16 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" '
               f'text-anchor="middle">{y_label}</text>')
    ends = []
    for i, (name, line) in enumerate(series.items()):
        is_slope = name.startswith('slope')
        colour = '#888' if is_slope else COLOURS[i % len(COLOURS)]
        path = 'M' + 'L'.join(f'{x_of(x):.1f} {y_of(y):.1f}' for x, y in line)
        dash = ' stroke-dasharray="5 4"' if is_slope else ''
        out.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
        if not is_slope:
            out += [f'<circle cx="{x_of(x):.1f}" cy="{y_of(y):.1f}" r="3" fill="{colour}"/>'
                    for x, y in line]
        ends.append((x_of(line[-1][0]) + 8, y_of(line[-1][1]) + 4, name, colour))
    out += [f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}">{name}</text>'
            for x, y, name, colour in place_names(ends)]
    out.append('</svg>')
    print('\n'.join(out))


main()

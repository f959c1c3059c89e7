# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Structures whose answers follow from statics: each gives the formula beside the structure.

W is the weight of a module, n modules reach n pitches, so a lateral arm of n modules has the moment
W L n^2 / 2 in the middle of the connection at its root, and the load ratio W n^2 / strength with
half a pitch as the lever. make.py compares every formula with frame.py where that knows the robot.
"""
import math

from frame import Frame

G, MASS = 9.81, 0.06106
W = MASS * G
LATERAL, VERTICAL = 14.97, 11.98
LEVER = 20.0
FIXED = {'cell': [0, 0, 0], 'fixed': True}
found = []


def add(kind, name, modules, verdict=None, *, source='closed form', formula='', figures=None,
        question='check', **keys):
    """A structure; what stands in `figures` and `verdict` is by `formula`, the rest by frame.py."""
    found.append({'kind': kind, 'name': name, 'formula': formula, 'source': source,
                  'question': question, 'verdict': verdict, 'figures': figures or {},
                  'structure': {'modules': modules, **keys}})


def by_ratio(ratio):
    return 'safe' if ratio < 1 else 'overload'


def add_by_ratio(kind, name, modules, ratio, formula, **keys):
    add(kind, name, modules, by_ratio(ratio), formula=formula,
        figures={'load_ratio_max': ratio}, **keys)


def row(start, step, count):
    return [[a + i * b for a, b in zip(start, step)] for i in range(count)]


X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def arms():
    for n in range(1, 7):
        add_by_ratio('arms', f'arm_{n}', [FIXED, *row((1, 0, 0), X, n)], W * n * n / LATERAL,
                     'W n^2 / lateral strength', support_z=None)
    for axis, step in (('minus_x', (-1, 0, 0)), ('y', Y), ('minus_y', (0, -1, 0))):
        add_by_ratio('arms', f'arm_4_along_{axis}', [FIXED, *row(step, step, 4)],
                     16 * W / LATERAL, 'W n^2 / lateral strength', support_z=None)
    add_by_ratio('arms', 'arm_3_and_2_planned', [FIXED, *row(X, X, 3)], 25 * W / LATERAL,
                 'W n^2 / lateral strength, planned modules counted', support_z=None,
                 planned=row((4, 0, 0), X, 2))
    for n, k in ((2, 2), (3, 1), (3, 2), (4, 1)):
        ratio = max(W * (n * n + 2 * k * (n - 0.5)), W * k * k) / LATERAL
        add_by_ratio('arms', f'elbow_{n}_{k}',
                     [FIXED, *row(X, X, n), *row((n, 1, 0), Y, k)], ratio,
                     'bending at the root: W (n^2 + 2 k (n - 1/2)) / strength; torsion is free',
                     support_z=None)
    for n in (10, 20, 21):
        add_by_ratio('arms', f'chain_hangs_{n}', [FIXED, *row((0, 0, -1), (0, 0, -1), n)],
                     n * W / VERTICAL, 'n W / vertical strength', support_z=None)
    for distance in (1e-2, 1e-3, 1e-4, -1e-4, -1e-3, -1e-2):
        strength = round(16 * W / (1 + distance), 9)
        add_by_ratio('near the limit', f'arm_4_at_{1 + distance:.4f}', [FIXED, *row(X, X, 4)],
                     16 * W / strength, 'W n^2 / strength', support_z=None,
                     material={'strength_lateral_n': strength})


def cranes():
    """A column of h modules on one foot, an arm of n at its top: upright while n^2 < h."""
    for h, n in ((4, 1), (5, 2), (3, 2), (10, 3), (8, 3), (20, 4), (15, 4), (30, 5)):
        margin = LEVER - 20.0 * n * (n + 1) / (h + n)
        modules = row((0, 0, 0), Z, h) + row((1, 0, h - 1), X, n)
        # The arm's root, or the column's uppermost connection, with n + 1 modules above it.
        ratio = max(W * n * n / LATERAL, W * (n * n - 1) / VERTICAL)
        figures = {'margin_mm': margin}
        if margin > 0:
            figures['load_ratio_max'] = ratio
        add('arms', f'crane_{h}_{n}', modules, by_ratio(ratio) if margin > 0 else 'unstable',
            formula='margin 20 mm (1 - n (n + 1) / (h + n)); W n^2 / lateral strength',
            figures=figures)
    for h, n in ((4, 2), (9, 3)):
        add('ties and undecided', f'crane_tie_{h}_{n}',
            row((0, 0, 0), Z, h) + row((1, 0, h - 1), X, n), ['unstable', 'safe'],
            formula='the margin is exactly 0: n^2 = h', figures={'margin_mm': 0.0})


def towers():
    for n in (2, 10, 40):
        add('towers', f'tower_{n}', row((0, 0, 0), Z, n), 'safe',
            formula='nothing is pulled; half a face to the edge',
            figures={'load_ratio_max': 0.0, 'margin_mm': 20.0})
    for side, height in ((2, 5), (3, 2)):
        add('towers', f'block_{side}_{height}',
            [[x, y, z] for z in range(height) for y in range(side) for x in range(side)], 'safe',
            formula='by symmetry all columns are the same',
            figures={'load_ratio_max': 0.0, 'margin_mm': 20.0 * side})
    for n in (1, 2, 3):
        beam = [[x, 0, 4] for x in range(-n, n + 1)]
        ratio = max(W * n * n / LATERAL, 0)
        add('towers', f'balance_{n}', row((0, 0, 0), Z, 4) + beam, by_ratio(ratio),
            formula='the arms balance: W n^2 / lateral strength',
            figures={'load_ratio_max': ratio, 'margin_mm': 20.0})


def topples():
    """Beyond the edge of the support polygon nothing else matters."""
    def on_floor(name, modules, **keys):
        margin = Frame({'modules': modules, **keys}).margin_mm()
        assert abs(margin) > 1e-6, name
        if margin < 0:
            add('toppling', name, modules, 'unstable', figures={'margin_mm': margin},
                formula='the centre of mass and the convex hull of the feet', **keys)
    for n in (2, 4, 7):
        on_floor(f'stairs_{n}', [cell for i in range(n) for cell in ([i, 0, i], [i + 1, 0, i])])
    on_floor('flag', row((0, 0, 0), Z, 5) + [[x, 0, z] for x in (1, 2) for z in (3, 4)])
    on_floor('gallows', row((0, 0, 0), Z, 6) + row((1, 0, 5), X, 4) + [[4, 0, 4], [4, 0, 3]])
    on_floor('diagonal_arms', row((0, 0, 0), Z, 3) + row((1, 0, 2), X, 2) + row((0, 1, 2), Y, 2))
    on_floor('wide_foot_wrong_side', [[0, 0, 0], [-1, 0, 0], [-2, 0, 0], [0, 0, 1]] +
             row((0, 0, 2), X, 6))
    on_floor('battery_at_the_tip', [[0, 0, 0], [-1, 0, 0], [0, 0, 1], [1, 0, 1],
                                    {'cell': [2, 0, 1], 'mass_kg': 0.3}])
    on_floor('two_feet_in_line', [[0, 0, 0], [0, 2, 0], [0, 0, 1], [0, 1, 1], [0, 2, 1],
                                  [1, 1, 1], [2, 1, 1]])
    on_floor('small_faces', [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2]],
             material={'facet_mm': 18})
    on_floor('planned_tips', [[0, 0, 0], [0, 0, 1], [0, 0, 2]], planned=[[1, 0, 2], [2, 0, 2]])


def supports():
    """Several feet, fixed modules, walls and ceilings; numbers by frame.py alone."""
    def solved(kind, name, modules, **keys):
        add(kind, name, modules, source='second method', **keys)
    for span, height in ((3, 2), (5, 3), (7, 3)):
        for depth in (1, 2):
            legs = [[x, y, z] for z in range(height) for x in (0, span + 1) for y in range(depth)]
            deck = [[x, y, height] for x in range(span + 2) for y in range(depth)]
            solved('several supports', f'bridge_{span}_{height}_{depth}', legs + deck)
    solved('several supports', 'table', [[x, y, z] for z in (0, 1) for x in (0, 3)
                                         for y in (0, 3)] +
           [[x, y, 2] for x in range(4) for y in range(4) if x in (0, 3) or y in (0, 3)])
    solved('several supports', 'bridge_with_load', [[0, 0, 0], [4, 0, 0]] + row((0, 0, 1), X, 5),
           loads=[{'cell': [2, 0, 1], 'force_n': [0, 0, -3]}])
    for span in (3, 5, 7, 9, 13):
        solved('fixed modules', f'beam_between_{span}', [FIXED, *row(X, X, span),
               {'cell': [span + 1, 0, 0], 'fixed': True}], support_z=None)
    solved('fixed modules', 'ring_on_fixed', [FIXED, *row(X, X, 3), [3, 1, 0], [3, 2, 0], [2, 2, 0],
                                              [1, 2, 0], [0, 2, 0], [0, 1, 0]], support_z=None)
    solved('fixed modules', 'plate_on_fixed', [
        {'cell': [x, y, 0], 'fixed': True} if x == 0 else [x, y, 0]
        for x in range(5) for y in range(3)], support_z=None)
    wall = {'from': [0, -2, -2], 'to': [0, 2, 3], 'hold': 'bonded'}
    for n in (2, 4, 6):
        add_by_ratio('walls and ceilings', f'shelf_{n}', row(X, X, n),
                     W * (n - 1) ** 2 / LATERAL, 'the wall holds: W (n - 1)^2 / lateral strength',
                     support_z=None, obstacles=[wall])
    solved('walls and ceilings', 'bracket', row(X, X, 4) + [[1, 0, -1], [1, 0, -2], [2, 0, -1]],
           support_z=None, obstacles=[wall])
    solved('walls and ceilings', 'double_shelf', [[x, y, 0] for x in (1, 2, 3) for y in (0, 1)],
           support_z=None, obstacles=[wall])
    ceiling = {'from': [-2, -2, 1], 'to': [6, 2, 1], 'hold': 'bonded'}
    for n in (12, 21, 22):
        add_by_ratio('walls and ceilings', f'chain_under_ceiling_{n}',
                     row((0, 0, 0), (0, 0, -1), n), (n - 1) * W / VERTICAL,
                     '(n - 1) W / vertical strength', support_z=None, obstacles=[ceiling])
    solved('walls and ceilings', 'hook_under_ceiling', row((0, 0, 0), (0, 0, -1), 4) +
           row((1, 0, -3), X, 3), support_z=None, obstacles=[ceiling])
    solved('walls and ceilings', 'swing', row((0, 0, 0), (0, 0, -1), 3) +
           row((4, 0, 0), (0, 0, -1), 3) + row((1, 0, -2), X, 3), support_z=None,
           obstacles=[ceiling])


def obstacles():
    """A row of m modules, the first s of them on a step."""
    for m, s in ((5, 3), (6, 4), (7, 3), (9, 4)):
        out, margin = m - s, min(20.0, 40.0 * (s - 0.5) - 20.0 * (m - 1))
        figures = {'load_ratio_max': W * out * out / LATERAL} if margin > 0 else {}
        add('obstacles', f'over_edge_{m}_{s}', row((0, 0, 1), X, m),
            'safe' if margin > 0 else 'unstable', figures={**figures, 'margin_mm': margin},
            formula='margin 40 mm (s - 1/2) - 20 mm (m - 1), or half a face; '
            'W (m - s)^2 / lateral strength',
            support_z=None, obstacles=[{'from': [-1, -1, 0], 'to': [s - 1, 1, 0]}])
    add('obstacles', 'between_blocks', row((0, 0, 1), X, 4), source='second method',
        support_z=None, obstacles=[{'cells': [[0, 0, 0]]}, {'cells': [[3, 0, 0]]}])
    add('obstacles', 'one_leg_on_a_block', [[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2],
                                            [3, 0, 2], [3, 0, 1]], source='second method',
        obstacles=[{'cells': [[3, 0, 0]]}])


def slopes():
    """A tower of n modules on a slope: slides beyond the friction, tips beyond 1 : n."""
    for n, degrees, friction in ((1, 20, 0.4), (2, 10, 0.5), (2, 20, 0.3), (3, 15, 0.6),
                                 (3, 20, 0.6), (5, 10, 0.9), (5, 12, 0.9), (4, 5, 0.08)):
        angle = math.radians(degrees)
        limit = math.atan(min(friction, 1 / n))
        figures = {'friction_needed': math.tan(angle)} if math.tan(angle) < 1 / n else {}
        if angle < limit:
            figures['tilt_margin_deg'] = math.degrees(limit - angle)
            figures['load_ratio_max'] = 0.0
        add('friction', f'slope_{n}_{degrees}_{friction}', row((0, 0, 0), Z, n),
            'safe' if angle < limit else 'unstable', figures=figures,
            formula='slides where tan(slope) > friction, tips where it is > 1 / n',
            floor={'friction': friction},
            gravity_m_s2=[round(G * math.sin(angle), 12), 0, round(-G * math.cos(angle), 12)])


def slippery():
    """A bridge on a rough floor, and on one where its feet push each other apart."""
    legs = [[x, 0, z] for z in range(3) for x in (0, 4)]
    bridge = legs + row((0, 0, 3), X, 5)
    needed = Frame({'modules': bridge}).friction_used()
    add('friction', 'bridge_on_a_rough_floor', bridge, source='second method',
        formula=f'the feet use {needed:.3f}', floor={'friction': round(2 * needed, 2)})
    add('ties and undecided', 'bridge_on_a_smooth_floor', bridge, ['undecided', 'safe'],
        source='second method',
        formula=f'elastic feet push each other apart with {needed:.3f} of their load and slip; '
        'as a rigid body it needs no friction', floor={'friction': round(needed / 2, 3)})


def kinds_and_payloads():
    held = [FIXED, *row(X, X, 3)]
    for mass in (0.1, 0.2, 0.35):
        add_by_ratio('kinds and masses', f'battery_{mass}',
                     [*held, {'cell': [4, 0, 0], 'kind': 'battery'}],
                     (9 * W + 7 * mass * G) / LATERAL, '(9 W + 7 m g) / lateral strength',
                     support_z=None, kinds={'battery': {'mass_kg': mass}})
    for strength in (9.0, 2.0):
        ratio = max(16 * W / LATERAL, 4 * W / strength)
        add_by_ratio('kinds and masses', f'weak_at_the_end_{strength:g}',
                     [*held[:3], {'cell': [3, 0, 0], 'kind': 'weak'}, [4, 0, 0]],
                     max(ratio, W / strength), 'the largest of 16 W / S, 4 W / s and W / s',
                     support_z=None, kinds={'weak': {'strength_lateral_n': strength}})
    for mass in (0.05, 0.15):
        modules = row((0, 0, 0), Z, 3) + row((1, 0, 2), X, 2) + [
            {'cell': [-1, 0, 2], 'mass_kg': mass}]
        margin = Frame({'modules': modules}).margin_mm()
        ratio = max(4 * W, mass * G) / LATERAL
        add('kinds and masses', f'counterweight_{mass}', modules,
            'safe' if margin > 0 else 'unstable', formula='centre of mass; 4 W / lateral strength',
            figures={'margin_mm': margin, **({'load_ratio_max': ratio} if margin > 0 else {})})
    for force in (1.0, 2.0):
        add_by_ratio('payloads', f'tip_force_{force:g}', held, (9 * W + 5 * force) / LATERAL,
                     '(9 W + 5 F) / lateral strength', support_z=None,
                     loads=[{'cell': [3, 0, 0], 'force_n': [0, 0, -force]}])
    add_by_ratio('payloads', 'tip_force_up', held, (9 * W - 5 * 0.5) / LATERAL,
                 '(9 W - 5 F) / lateral strength', support_z=None,
                 loads=[{'cell': [3, 0, 0], 'force_n': [0, 0, 0.5]}])
    for torque in (100, 250):
        add_by_ratio('payloads', f'tip_torque_{torque}', held,
                     (9 * W + torque / LEVER) / LATERAL, '(9 W + T / 20 mm) / lateral strength',
                     support_z=None, loads=[{'cell': [3, 0, 0], 'torque_nmm': [0, torque, 0]}])
    for n, force in ((4, 0.3), (4, 0.4), (8, 0.3), (8, 0.33)):
        holds = (2 * n - 1) * force < n * W
        add('payloads', f'wind_{n}_{force}', row((0, 0, 0), Z, n),
            'safe' if holds else 'unstable', formula='tips where (2 n - 1) F > n W',
            figures={'load_ratio_max': 0.0} if holds else {},
            loads=[{'cell': [0, 0, n - 1], 'force_n': [force, 0, 0]}])
    add_by_ratio('payloads', 'wind_on_a_fixed_tower', [FIXED, *row(Z, Z, 4)],
                 (7 * 1.5 - 4 * W) / VERTICAL, '((2 n - 1) F - n W) / vertical strength',
                 support_z=None, loads=[{'cell': [0, 0, 4], 'force_n': [1.5, 0, 0]}])


def laws():
    """Elbows of 2 and 2 modules; at the root V = 4 W, M = 5 W L, T = 3 W L."""
    elbow = [FIXED, *row(X, X, 2), *row((2, 1, 0), Y, 2)]
    opens, shear, torsion = 10 * W / LATERAL, 4 * W, 3 * W * 40
    for name, law, ratio, formula in (
            ('shear_2', {'shear_strength_n': 2.0}, shear / 2.0, '4 W / shear strength'),
            ('shear_5', {'shear_strength_n': 5.0}, shear / 5.0, '4 W / shear strength'),
            ('twist_40', {'torsion_strength_nmm': 40.0}, torsion / 40, '3 W L / torsion strength'),
            ('twist_90', {'torsion_strength_nmm': 90.0}, torsion / 90, '3 W L / torsion strength'),
            ('slip', {'friction': 0.4}, shear / 0.4 / LATERAL, '4 W / friction / strength'),
            ('slip_and_turn', {'friction': 0.4, 'torsion_radius_mm': 15.0},
             (shear + torsion / 15) / 0.4 / LATERAL, '(4 W + 3 W L / r) / friction / strength'),
            ('short_lever', {'lever_mm': 8.0}, opens * LEVER / 8, 'M / lever / strength')):
        add_by_ratio('connector laws', f'elbow_{name}', elbow, max(opens, ratio), formula,
                     support_z=None, material=law)
    for bending, factor in (('square', 1.0), ('round', math.sqrt(2))):
        add_by_ratio('connector laws', f'bent_both_ways_{bending}', [FIXED, [1, 0, 0], [2, 0, 0]],
                     4 * W * factor / LATERAL, 'W n^2 / strength in both directions',
                     support_z=None, gravity_m_s2=[0, G, -G], material={'bending': bending})
    add_by_ratio('connector laws', 'strengths_by_direction', [FIXED, [0, 1, 0], [0, 2, 0]],
                 4 * W / 5, 'W n^2 / strength along y', support_z=None,
                 material={'strength_n': [20.0, 5.0, 12.0]})


def lattices():
    """Arms, chains and rings; numbers by frame.py, the straight arms by W n^2 / strength too."""
    for name, cells in (('hexagonal', row(X, X, 4)), ('hexagonal-prism', row(X, X, 5)),
                        ('face-centred', row(X, X, 3))):
        n = len(cells)
        add_by_ratio('other lattices', f'{name}_arm_{n}', [FIXED, *cells], W * n * n / LATERAL,
                     'W n^2 / lateral strength', support_z=None, lattice=name)
    more = {
        'hexagonal': [[[0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2]],
                      [[1, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 2]],
                      [[-1, 0, -1], [0, 0, -2], [-1, 0, -3], [0, 0, -4]]],
        'hexagonal-prism': [[[0, 1, 0], [-1, 2, 0], [-2, 3, 0]],
                            [[1, 0, 0], [2, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [2, 1, 1]],
                            [[0, 0, -1], [0, 0, -2], [1, 0, -2], [1, 1, -2]]],
        'face-centred': [[[0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2]],
                         [[1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 1, 2]],
                         [[-1, -1, -1], [0, 0, -2], [-1, -1, -3], [-2, -1, -3]]]}
    for name, shapes in more.items():
        for number, cells in enumerate(shapes):
            add('other lattices', f'{name}_{number}', [FIXED, *cells], source='second method',
                support_z=None, lattice=name)


def limits():
    """Where forces are determinate the limit load is 1 over the load ratio; else by hand."""
    for n in (3, 4, 5):
        ratio = W * n * n / LATERAL
        add('limit loads', f'limit_arm_{n}', [FIXED, *row((0, 1, 0), Y, n)], by_ratio(ratio),
            formula='determinate: lateral strength / (W n^2)', support_z=None,
            figures={'load_ratio_max': ratio, 'limit_load_factor': 1 / ratio})
    add('limit loads', 'limit_chain', [FIXED, *row((0, 0, -1), (0, 0, -1), 15)], 'safe',
        formula='determinate: vertical strength / (n W)', support_z=None,
        figures={'load_ratio_max': 15 * W / VERTICAL, 'limit_load_factor': VERTICAL / 15 / W})
    add('limit loads', 'limit_tower', row((0, 0, 0), Z, 6), 'safe',
        formula='only pressed: no limit',
        figures={'load_ratio_max': 0.0, 'limit_load_factor': 'unbounded'})
    ends = [{'cell': [-1, 0, 0], 'kind': 'left', 'fixed': True}, [0, 0, 0],
            {'cell': [1, 0, 0], 'kind': 'right', 'fixed': True}]
    for left, right in ((60.0, 60.0), (60.0, 120.0), (40.0, 300.0)):
        add('limit loads', f'limit_twist_{left:g}_{right:g}', ends,
            by_ratio(50 / min(left, right)),
            formula='each end takes half of 100 N mm; at the limit both give what they have',
            figures={'load_ratio_max': 50 / min(left, right),
                     'limit_load_factor': (left + right) / 100}, support_z=None,
            gravity_m_s2=[0, 0, -1e-9], loads=[{'cell': [0, 0, 0], 'torque_nmm': [100, 0, 0]}],
            material={'strength_n': 1e3},
            kinds={'left': {'torsion_strength_nmm': left, 'strength_n': 1e3},
                   'right': {'torsion_strength_nmm': right, 'strength_n': 1e3}})
    for left, right in ((2.0, 2.0), (1.25, 3.0)):
        add('limit loads', f'limit_shear_{left:g}_{right:g}', ends,
            by_ratio(1 / min(left, right)),
            formula='each end takes half of 2 N; at the limit both give what they have',
            figures={'load_ratio_max': 1 / min(left, right),
                     'limit_load_factor': (left + right) / 2}, support_z=None,
            gravity_m_s2=[0, 0, -1e-9], loads=[{'cell': [0, 0, 0], 'force_n': [0, 2, 0]}],
            material={'strength_n': 1e3},
            kinds={'left': {'shear_strength_n': left, 'strength_n': 1e3},
                   'right': {'shear_strength_n': right, 'strength_n': 1e3}})


def steps():
    """Sequences; the first unsafe stage counts steps from 0."""
    def sequence(name, modules, plan, verdict, first, formula, **keys):
        add('planned steps', name, modules, verdict, question='steps', formula=formula,
            figures={'first_unsafe': first}, steps=plan, **keys)
    sequence('arm_grows', [FIXED, [1, 0, 0]], [{'attach': [[n, 0, 0]]} for n in range(2, 7)],
             'overload', '3 connect', 'W n^2 > strength with the fifth module', support_z=None)
    sequence('arm_grows_to_4', [FIXED, [1, 0, 0]], [{'attach': [[n, 0, 0]]} for n in (2, 3, 4)],
             'safe', 'none', 'W n^2 < strength up to the fourth module', support_z=None)
    post = row((0, 0, 0), Z, 4)
    sequence('one_side_first', post[:3], [{'attach': [[1, 0, 2]]}, {'attach': [[2, 0, 2]]},
             {'attach': [[-1, 0, 2]]}], 'unstable', '1 connect',
             'a column of h topples with an arm of n where n^2 > h')
    sequence('side_by_side', post[:3], [{'attach': [[1, 0, 2]]}, {'attach': [[-1, 0, 2]]},
             {'attach': [[2, 0, 2]]}, {'attach': [[-2, 0, 2]]}], 'safe', 'none',
             'the margin is 20 mm (1 - 2 (sum of x) / modules) and positive all the way')
    sequence('both_at_once', post[:3], [{'attach': [[1, 0, 2], [-1, 0, 2]]},
             {'attach': [[2, 0, 2], [-2, 0, 2]]}], 'safe', 'none', 'balanced')
    beam = [[x, 0, 3] for x in (-3, -2, -1, 1, 2, 3)]
    sequence('counterweight_taken', post + beam, [{'detach': [[-3, 0, 3]]},
             {'detach': [[-2, 0, 3]]}], 'unstable', '1 shift',
             'sum of x / modules is 3 / 9, then 5 / 8 > 1/2; what is detached is gone in shift')
    sequence('weight_walks_out', [FIXED, *row(X, X, 3), {'cell': [1, 0, 1], 'mass_kg': 0.2}],
             [{'move': [{'from': [1, 0, 1], 'to': [2, 0, 1]}]},
              {'move': [{'from': [2, 0, 1], 'to': [3, 0, 1]}]}], 'overload', '1 shift',
             '9 W + 2 m g (x - 1/2) > strength between x = 2 and 3', support_z=None)
    sequence('layers', [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
             [{'attach': [[x, y, z] for x in (0, 1) for y in (0, 1)]} for z in (1, 2, 3)],
             'safe', 'none', 'only pressed')


def all_families():
    for family in (arms, cranes, towers, topples, supports, obstacles, slopes, slippery,
                   kinds_and_payloads, laws, lattices, limits, steps):
        family()
    return found

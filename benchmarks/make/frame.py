# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""A dense frame solver in plain Python, written for these answers; it shares nothing with holdfast.

Every connection is six springs in its middle (E A / L along it, 12 E I / L^3 across, E I / L and
E Jv / L about it), which is the beam of docs/theory.md; a facet on a floor or obstacle is the same
to a node that does not move, with the contact law of Eqs. (9)-(12) of [Piranda 2021]. Newton's
method finds the contact states, and raises Unknown where it does not. Units: N, mm, MPa, kg.
"""
import math

TABLE_I = {'elastic_modulus_mpa': 100.0, 'pitch_mm': 40.0, 'section_area_mm2': 1600.0,
           'moment_x_mm4': 40.0 ** 4 / 12, 'moment_y_mm4': 40.0 ** 4 / 12, 'torsion_mm4': 360000.0,
           'poisson_ratio': 0.3, 'mass_kg': 0.06106, 'gravity_m_s2': 9.81,
           'strength_vertical_n': 11.98, 'strength_lateral_n': 14.97, 'facet_mm': 40.0}

# Base vectors by axial coordinates, and the steps to half of the neighbours.
HALF = math.sqrt(0.5)
LATTICES = {
    'cubic': (((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((1, 0, 0), (0, 1, 0), (0, 0, 1))),
    'face-centred': (((1, 0, 0), (0, 1, 0), (0.5, 0.5, HALF)),
                     ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 1), (0, -1, 1), (-1, -1, 1))),
    'hexagonal': (((1, 0, 0), (0, 1, 0), (0.5, 0, math.sqrt(0.75))),
                  ((1, 0, 0), (0, 0, 1), (-1, 0, 1))),
    'hexagonal-prism': (((1, 0, 0), (0.5, math.sqrt(0.75), 0), (0, 0, 1)),
                        ((1, 0, 0), (0, 1, 0), (-1, 1, 0), (0, 0, 1)))}
GAMMA = 1e-4
NEWTON_STEPS_MAX = 30
UPRIGHT = ('cubic', 'hexagonal-prism')  # Lattices in which a module may be straight above another.


class Unknown(Exception):
    """This solver does not know the robot."""


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def axial(lattice, cell):
    x, y, z = cell
    if lattice == 'face-centred':
        return x - z // 2, y - z // 2, z
    return (x - z // 2, y, z) if lattice == 'hexagonal' else (x, y, z)


def entries(modules):
    """A list of modules as objects with a tuple for a cell."""
    objects = [one if isinstance(one, dict) else {'cell': one} for one in modules]
    return [{**one, 'cell': tuple(one['cell'])} for one in objects]


def cells_of(obstacle):
    if 'cells' in obstacle:
        return [tuple(cell) for cell in obstacle['cells']]
    ranges = [range(low, high + 1) for low, high in zip(obstacle['from'], obstacle['to'])]
    return [(x, y, z) for x in ranges[0] for y in ranges[1] for z in ranges[2]]


class Frame:
    """A robot: its modules, supports, loads and springs."""

    def __init__(self, structure):
        self.structure = structure
        self.material = {**TABLE_I, **structure.get('material', {})}
        self.kinds = structure.get('kinds', {})
        self.lattice = structure.get('lattice', 'cubic')
        self.modules = entries(structure['modules']) + entries(structure.get('planned', []))
        gravity = structure.get('gravity_m_s2', [0, 0, -self.material['gravity_m_s2']])
        self.weights = [[self.mass(one) * g for g in gravity] for one in self.modules]
        self.base, self.steps = LATTICES[self.lattice]
        self.index = {axial(self.lattice, one['cell']): i for i, one in enumerate(self.modules)}
        self.pairs = []
        for place, i in self.index.items():
            for step in self.steps:
                other = self.index.get(tuple(a + b for a, b in zip(place, step)))
                if other is not None:
                    self.pairs.append((i, other, self.direction(step)))
        self.half = self.material['facet_mm'] / 2 if self.lattice == 'cubic' else (
            self.material.get('foot_mm', self.material['pitch_mm'] / 2) / 2)
        self.facets = self.find_facets(structure)
        self.forces = [weight + [0, 0, 0] for weight in self.weights]
        for load in structure.get('loads', []):
            force = self.forces[self.index[axial(self.lattice, load['cell'])]]
            for k, value in enumerate(load.get('force_n', [0] * 3) +
                                      load.get('torque_nmm', [0] * 3)):
                force[k] += value

    def mass(self, module):
        kind = self.kinds.get(module.get('kind'), {})
        return module.get('mass_kg', kind.get('mass_kg', self.material['mass_kg']))

    def direction(self, step):
        return unit([sum(s * b[k] for s, b in zip(step, self.base)) for k in range(3)])

    def pair_of(self, n):
        """The pair of opposite directions that n belongs to, in the order of docs/formats.md."""
        return max(range(len(self.steps)),
                   key=lambda k: abs(dot(n, self.direction(self.steps[k]))))

    def find_facets(self, structure):
        """Module, direction and whether the facet holds like a connector."""
        holds = {}
        for obstacle in structure.get('obstacles', []):
            for cell in cells_of(obstacle):
                holds.setdefault(axial(self.lattice, cell), obstacle.get('hold') == 'bonded')
        floor = structure.get('support_z', 0)
        facets = []
        for place, i in self.index.items():
            if self.modules[i].get('fixed'):
                continue
            below = tuple(a - b for a, b in zip(place, (0, 0, 1)))
            is_replaced = below in holds and self.lattice in UPRIGHT
            for step in [*self.steps, *(tuple(-s for s in step) for step in self.steps)]:
                there = tuple(a + b for a, b in zip(place, step))
                if there in holds:
                    facets.append((i, self.direction(step), holds[there]))
            if floor is not None and self.modules[i]['cell'][2] == floor and not is_replaced:
                facets.append((i, [0.0, 0.0, -1.0], False))
        return facets

    def springs(self, n):
        """Directions of the six springs across a facet with normal n, and their stiffness."""
        m = self.material
        up = [1.0, 0.0, 0.0] if abs(n[2]) > 1 - 1e-12 else unit(
            [(k == 2) - n[2] * n[k] for k in range(3)])
        side = cross([-x for x in n], up)
        e, length = m['elastic_modulus_mpa'], m['pitch_mm']
        twist = e * m['torsion_mm4'] / (2 * (1 + m['poisson_ratio'])) / length
        bend_x, bend_y = (e * m[key] / length for key in ('moment_x_mm4', 'moment_y_mm4'))
        return (((n, e * m['section_area_mm2'] / length), (up, 12 * bend_x / length ** 2),
                 (side, 12 * bend_y / length ** 2)),
                ((n, twist), (up, bend_y), (side, bend_x)))

    def rows(self, n):
        """Rows of the strains by the displacements of both ends, with the stiffness."""
        arm = [self.material['pitch_mm'] / 2 * x for x in n]
        shifts, turns = self.springs(n)
        for axis, k in shifts:
            # axis . (theta x arm) = theta . (arm x axis); the gap is that of the two faces.
            lever = cross(arm, axis)
            yield ([-x for x in axis] + [-x for x in lever], list(axis) + [-x for x in lever], k)
        for axis, k in turns:
            yield [0.0] * 3 + [-x for x in axis], [0.0] * 3 + list(axis), k

    def law(self, state):
        """What makes the forces of a facet of its trial forces, Eqs. (10)-(12): N, two shears,
        torsion, two moments in its middle. A state is None (off), or the signs of two tilts."""
        if state is None:
            return [[GAMMA * (i == j) for j in range(6)] for i in range(6)]
        matrix = [[float(i == j) for j in range(6)] for i in range(6)]
        for row, sign in zip((4, 5), state):
            if sign:
                matrix[row][row] = GAMMA
                matrix[row][0] = -(1 - GAMMA) * sign * self.half
        return matrix

    def state(self, u, facet):
        """The state that displacements prescribe, Eq. (9)."""
        i, n, is_bonded = facet
        force, _, _, _, bend_x, bend_y = self.carried(u, i, None, n)
        if is_bonded:
            return 0, 0
        if force >= 0:
            return None
        return tuple(0 if abs(m) <= -force * self.half else 1 if m > 0 else -1
                     for m in (bend_x, bend_y))

    def solve(self, states):
        """Displacements of all modules, with the facets in these states."""
        free = [i for i, one in enumerate(self.modules) if not one.get('fixed')]
        place = {i: 6 * k for k, i in enumerate(free)}
        size = 6 * len(free)
        matrix = [[0.0] * (size + 1) for _ in range(size)]
        whole = self.law((0, 0))
        springs = [(p, q, n, whole) for p, q, n in self.pairs]
        springs += [(i, None, n, self.law(state)) for (i, n, _), state in zip(self.facets, states)]
        for p, q, n, law in springs:
            strains = [([(place[i] + c, value) for i, values in ((p, at_p), (q, at_q))
                         if i in place for c, value in enumerate(values) if value], k)
                       for at_p, at_q, k in self.rows(n)]
            for (row, _), factors in zip(strains, law):
                for (column, k), factor in zip(strains, factors):
                    for i, a in row if factor else ():
                        for j, b in column:
                            matrix[i][j] += factor * k * a * b
        for i, start in place.items():
            for c in range(6):
                matrix[start + c][size] = self.forces[i][c]
        solution = eliminate(matrix)
        return [solution[place[i]:place[i] + 6] if i in place else [0.0] * 6
                for i in range(len(self.modules))]

    def equilibrium(self, states=None):
        """Displacements and contact states that prescribe each other, by Newton's method."""
        states = states or [(0, 0)] * len(self.facets)
        for _ in range(NEWTON_STEPS_MAX):
            u = self.solve(states)
            prescribed = [self.state(u, facet) for facet in self.facets]
            if prescribed == states:
                return u, states
            states = prescribed
        raise Unknown('the contact states do not settle')

    def carried(self, u, p, q, n):
        """Axial force, two shears, torsion, two bending moments in the middle of p and q."""
        other = u[q] if q is not None else [0.0] * 6
        return [k * (dot(at_p, u[p]) + dot(at_q, other)) for at_p, at_q, k in self.rows(n)]

    def limits(self, p, q, n):
        """Limits of a connection, each the smaller of its two modules'."""
        is_vertical = abs(n[2]) > 1 - 1e-12 and self.lattice in UPRIGHT
        name = 'vertical' if is_vertical else 'lateral'
        found = {}
        for i in (p, q):
            law = {'strength_n': None, **self.material}
            own = self.kinds.get(self.modules[i].get('kind'), {})
            if f'strength_{name}_n' in own:
                law['strength_n'] = None
            law.update(own)
            law['strength_n'] = law['strength_n'] or law[f'strength_{name}_n']
            for key in ('strength_n', 'lever_mm', 'shear_strength_n', 'torsion_strength_nmm',
                        'friction', 'torsion_radius_mm'):
                value = law.get(key)
                value = value.get(name) if isinstance(value, dict) else value
                value = value[self.pair_of(n)] if isinstance(value, list) else value
                if value is not None:
                    found[key] = min(found.get(key, value), value)
        found.setdefault('lever_mm', self.material['facet_mm'] / 2)
        return found

    def load_ratio(self, u, p, q, n):
        axial_n, across, aside, torsion, bend_x, bend_y = self.carried(u, p, q, n)
        limit = self.limits(p, q, n)
        is_round = self.material.get('bending') == 'round'
        bending = math.hypot(bend_x, bend_y) if is_round else max(abs(bend_x), abs(bend_y))
        shear, strength = math.hypot(across, aside), limit['strength_n']
        ratios = [(axial_n + bending / limit['lever_mm']) / strength]
        if 'shear_strength_n' in limit:
            ratios.append(shear / limit['shear_strength_n'])
        if 'torsion_strength_nmm' in limit:
            ratios.append(abs(torsion) / limit['torsion_strength_nmm'])
        if 'friction' in limit:
            slip = axial_n + shear / limit['friction']
            if 'torsion_radius_mm' in limit:
                slip += abs(torsion) / limit['friction'] / limit['torsion_radius_mm']
            ratios.append(slip / strength)
        return max(ratios)

    def answer(self, states=None):
        """The largest load ratio, 0 if nothing is pulled, and all connections that have it."""
        u, _ = self.equilibrium(states)
        ratios = [(self.load_ratio(u, p, q, n), p, q) for p, q, n in self.pairs]
        largest = max([ratio for ratio, _, _ in ratios], default=0)
        if largest < 1e-9:
            return 0.0, None
        return largest, [[list(self.modules[i]['cell']) for i in (p, q)]
                         for ratio, p, q in ratios if ratio > largest * (1 - 1e-6)]

    def is_held(self):
        """A fixed module or a connector holds it, or all facets press with all of their face."""
        if any(one.get('fixed') for one in self.modules) or any(f[2] for f in self.facets):
            return True
        return set(self.equilibrium()[1]) == {(0, 0)}

    def friction_used(self):
        """The largest |ft| / |fn| of all facets."""
        u, _ = self.equilibrium()
        forces = [self.carried(u, i, None, n)[:3] for i, n, _ in self.facets]
        return max(math.hypot(across, aside) / abs(push) for push, across, aside in forces)

    def is_on_level_floor(self):
        """Cubes whose support polygon decides: nothing but a floor, and nothing but weight."""
        return (self.lattice == 'cubic' and not {'obstacles', 'loads', 'gravity_m_s2', 'floor'} &
                self.structure.keys() and self.structure.get('support_z', 0) is not None and
                not any(one.get('fixed') for one in self.modules))

    def margin_mm(self):
        """From the centre of mass to the nearest edge of the feet of cubes on a level floor."""
        pitch, half = self.material['pitch_mm'], self.material['facet_mm'] / 2
        feet = [self.modules[i]['cell'] for i, _, _ in self.facets]
        corners = [(pitch * x + sx * half, pitch * y + sy * half)
                   for x, y, _ in feet for sx in (-1, 1) for sy in (-1, 1)]
        total = sum(self.mass(one) for one in self.modules)
        centre = [pitch * sum(self.mass(one) * one['cell'][k] for one in self.modules) / total
                  for k in (0, 1)]
        return min(((b[0] - a[0]) * (centre[1] - a[1]) - (b[1] - a[1]) * (centre[0] - a[0])) /
                   math.dist(a, b) for a, b in edges_of(corners))


def edges_of(points):
    """The edges of the convex hull, counterclockwise [Andrew 1979]."""
    points = sorted(set(points))

    def chain(order):
        hull = []
        for point in order:
            while len(hull) > 1 and ((hull[-1][0] - hull[-2][0]) * (point[1] - hull[-2][1]) -
                                     (hull[-1][1] - hull[-2][1]) * (point[0] - hull[-2][0])) <= 0:
                hull.pop()
            hull.append(point)
        return hull[:-1]
    hull = chain(points) + chain(reversed(points))
    return list(zip(hull, hull[1:] + hull[:1]))


def eliminate(matrix):
    """Gauss with partial pivoting; the last column is the right-hand side."""
    size = len(matrix)
    for column in range(size):
        pivot = max(range(column, size), key=lambda row: abs(matrix[row][column]))
        matrix[column], matrix[pivot] = matrix[pivot], matrix[column]
        top = matrix[column]
        if abs(top[column]) < 1e-9:
            raise Unknown('nothing holds the robot')
        for row in matrix[column + 1:]:
            factor = row[column] / top[column]
            if factor:
                row[column:] = [a - factor * b for a, b in zip(row[column:], top[column:])]
    solution = [0.0] * size
    for i in reversed(range(size)):
        known = dot(matrix[i][i + 1:size], solution[i + 1:])
        solution[i] = (matrix[i][size] - known) / matrix[i][i]
    return solution

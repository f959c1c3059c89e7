# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Fig. 7: how many iterations the paper's scheme needs
#
# Fixed arms of growing length, solved by weighted Jacobi, Eq. (14) of Piranda et al. 2021. The
# scheme is written here in numpy after Eqs. (1)-(5); `holdfast` gives the exact displacements with
# which it is compared, so this also checks one against the other.

# %%
from typing import Any

import holdfast
import numpy as np
import numpy.typing as npt
from matplotlib import pyplot

Array = npt.NDArray[np.float64]


def arm(size: int) -> holdfast.Robot:
    """The arm of Fig. 6 #4 (a), of so many modules and a planned one; its foot is fixed."""
    foot = [[x, 1, 0] for x in (1, 2, 3)]
    post = [[1, 1, 1], [2, 1, 1], [1, 1, 2], [2, 1, 2]]
    reach = [[x, 1, 2] for x in range(3, size - 4)]
    return holdfast.Robot(foot + post + reach, planned=[[size - 4, 1, 2]], fixed=foot)


# %% [markdown]
# The blocks of a beam whose module p lies above q, Eqs. (1) and (2), and their rotation, Eqs. (3)
# and (4).


# %%
def blocks(material: dict[str, float]) -> tuple[Array, Array]:
    """K11 and K12."""
    length, modulus = material['pitch_mm'], material['elastic_modulus_mpa']
    area, moment = material['section_area_mm2'], material['moment_x_mm4']
    torsion = material['torsion_mm4'] / 2 / (1 + material['poisson_ratio'])
    k11 = np.diag([12 * moment, 12 * moment, area * length**2, 4 * moment * length**2,
                   4 * moment * length**2, torsion * length**2])
    k11[0, 4] = k11[4, 0] = -6 * moment * length
    k11[1, 3] = k11[3, 1] = 6 * moment * length
    k12 = np.diag([-1, -1, -1, 0.5, 0.5, -1.0]) * k11
    k12[0, 4], k12[4, 0] = -6 * moment * length, 6 * moment * length
    k12[1, 3], k12[3, 1] = 6 * moment * length, -6 * moment * length
    return modulus / length**3 * k11, modulus / length**3 * k12


def rotation(way: Array) -> Array:
    """R of a connection that runs along `way` from p to q, twice on the diagonal."""
    x = np.eye(3)[0] if way[2] else np.eye(3)[2]
    axes = np.stack([x, np.cross(-way, x), -way], axis=1)
    return np.kron(np.eye(2), axes)


def system(robot: holdfast.Robot) -> tuple[Array, Array]:
    """K and F of Eq. (5), of the modules that are not fixed."""
    count = len(robot)
    k11, k12 = blocks(robot.material)
    matrix = np.zeros((count, 6, count, 6))
    for a, b, direction in robot.connections.tolist():
        for p, q, sign in ((a, b, 1), (b, a, -1)):
            turn = rotation(sign * robot.directions[direction])
            matrix[p, :, p] += turn @ k11 @ turn.T
            matrix[p, :, q] += turn @ k12 @ turn.T
    force = np.zeros((count, 6))
    force[:, 2] = -9.81 * robot.masses
    free = np.flatnonzero(robot.modules['support'] != 2)
    size = 6 * len(free)
    return matrix[free][:, :, free].reshape(size, size), force[free].ravel()


# %% [markdown]
# The exact displacements are those of `holdfast`, to rounding:


# %%
def exact(robot: holdfast.Robot) -> Array:
    found = robot.check().displacements
    free = robot.modules['support'] != 2
    parts = [found['translation_mm'][free], found['rotation_rad'][free]]
    together: Array = np.concatenate(parts, axis=1).ravel()
    return together


stiffness, weight = system(arm(10))
own = np.linalg.solve(stiffness, weight)
difference = np.linalg.norm(own - exact(arm(10))) / np.linalg.norm(own)
print(f'numpy and holdfast differ by less than 1e-9: {difference < 1e-9}')


# %%
def errors(robot: holdfast.Robot, goal: float) -> Array:
    """The relative error after every iteration of Eq. (14), beta = 2/3, down to the goal."""
    stiffness, weight = system(robot)
    solution = exact(robot)
    share = (2 / 3) / np.diag(stiffness)
    u = np.zeros_like(solution)
    found = [1.0]
    while found[-1] > goal:
        u += share * (weight - stiffness @ u)
        found.append(float(np.linalg.norm(u - solution) / np.linalg.norm(solution)))
    return np.array(found)


SIZES = (8, 9, 10, 11, 12)
curves = {size: errors(arm(size), 0.01) for size in SIZES}
print('size  to 0.1  to 0.01')
for size, curve in curves.items():
    print(f'{size:4} {np.argmax(curve <= 0.1):7} {len(curve) - 1:8}')

# %% [markdown]
# Iterations grow much faster than with the square of the size that the paper gives: bending makes
# the condition of K grow with the fourth power of an arm's length.


# %%
def draw() -> Any:
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6), layout='constrained')
    for size, curve in curves.items():
        left.semilogy(curve, label=f'size {size}')
    left.set(xlabel='iteration', ylabel='relative error', title='(a)')
    left.legend()
    for goal in (0.1, 0.01):
        counts = [int(np.argmax(curve <= goal)) for curve in curves.values()]
        right.plot(SIZES, counts, 'o-', label=f'to {goal:g}')
    right.set(xlabel='size', ylabel='iterations', title='(b)', xticks=SIZES)
    right.legend()
    return figure


figure = draw()

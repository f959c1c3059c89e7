# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Which strength does a robot need?
#
# 10,000 random robots of 30 modules, checked at once: how many of those that stand would break with
# Blinky Blocks' connections, and how strong would connections have to be so that 99 of 100 hold?

# %%
import time

import holdfast
import numpy as np
from matplotlib import pyplot

COUNT, SIZE = 10_000, 30
STEPS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])


def random_robot(random: np.random.Generator) -> holdfast.Robot:
    """Modules attached one after the other to any free face, upwards from a foot of 3 x 3."""
    cells = [(x, y, 0) for x in range(3) for y in range(3)]
    taken = set(cells)
    while len(cells) < SIZE:
        x, y, z = np.array(cells[random.integers(len(cells))]) + STEPS[random.integers(6)]
        if z > 0 and (x, y, z) not in taken:
            cells.append((int(x), int(y), int(z)))
            taken.add(cells[-1])
    return holdfast.Robot(cells)


random = np.random.default_rng(2021)
robots = [random_robot(random) for _ in range(COUNT)]

# %%
begin = time.perf_counter()
reports = holdfast.check_many(robots)
seconds = time.perf_counter() - begin
results = holdfast.table(reports)
names = [verdict.value for verdict in holdfast.Verdict]
counts = np.bincount(results['verdict'], minlength=len(names))
print(', '.join(f'{count} {name}' for name, count in zip(names, counts) if count))

# %% [markdown]
# Forces do not depend on strengths, so a load ratio of 2 says that connections of twice the
# strength are needed. Shares of the robots that stand:

# %%
strength = robots[0].material['strength_lateral_n']
needed = np.sort(results['load_ratio_max'][results['verdict'] < 2]) * strength
for share in (0.5, 0.9, 0.99, 0.999):
    print(f'{share:6.1%} hold with connections of {np.quantile(needed, share):5.1f} N')

# %% [markdown]
# The robot that needs most holds with a little more strength, and not with a little less:

# %%
hardest = robots[int(np.nanargmax(np.where(results['verdict'] < 2, results['load_ratio_max'], 0)))]
vertical = hardest.material['strength_vertical_n'] / strength
for factor in (1.001, 0.999):
    lateral = float(needed[-1] * factor)
    material = {'strength_lateral_n': lateral, 'strength_vertical_n': lateral * vertical}
    robot = holdfast.Robot(hardest.cells, material=material)
    print(f'{factor} times: {robot.check().verdict.value}')

# %%
figure, axes = pyplot.subplots(figsize=(7, 3.5), layout='constrained')
axes.plot(needed, np.arange(1, len(needed) + 1) / len(needed))
axes.axvline(strength, linestyle='--', color='gray')
axes.annotate(' Blinky Blocks', (strength, 0.02))
axes.set(xlabel='strength of lateral connections, N', ylabel='share of robots that hold',
         xlim=(0, None), ylim=(0, 1));

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # What if?
#
# A crane of nine modules is safe as planned: no connection carries half of its strength. How sure
# is that?

# %%
import holdfast
from matplotlib import pyplot

CELLS = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2],
         [3, 0, 2]]
crane = holdfast.Robot(CELLS, name='crane')
report = crane.check()
print(f'{report.verdict}, load ratio {report.load_ratio_max or 0:.2f}')

# %% [markdown]
# No two magnets are alike. If strengths scatter by 20 % nearly all such cranes hold, and with 30 %
# one of 500 breaks:

# %%
for scatter in (0.1, 0.2, 0.3):
    found = report.reliability(scatter)
    print(f'{scatter:.0%}: fails with probability {found.probability_fails or 0:.1e}')

# %% [markdown]
# Magnets fail, too. Which single connection can the crane not do without? Where nothing holds a
# part any more it falls; where nothing falls the crane topples.

# %%
lost = crane.lose_one(parts=['connection'])
print(f'{len(lost.fatal)} of {lost.losses} losses are fatal')
for loss in lost.fatal:
    print(tuple(loss['a']), tuple(loss['b']), 'modules that fall:', loss['fallen'])

# %% [markdown]
# Modules of soft plastic bend. The softer they are, the earlier the tip of the arm touches the foot
# below it; what follows then is not known, so the verdict is undecided.

# %%
figure, axes = pyplot.subplots(figsize=(6, 3), layout='constrained')
for modulus in (1, 0.5, 0.2):
    soft = holdfast.Robot(CELLS, material={'elastic_modulus_mpa': modulus}).check(deformed=True)
    print(f'{modulus:3} MPa: {soft.verdict}')
    path = (soft.deformed or {})['path']
    axes.plot(path[:, 0], path[:, 2], label=f'{modulus} MPa')
axes.set(xlabel='factor of all loads', ylabel='displacement, mm')
axes.legend();

# %% [markdown]
# Several robots can stand in one file. Each is judged by itself, and is a robot of its own again:

# %%
both = crane.union(holdfast.generate('tower', 2).translated([8, 0, 0]))
print([(piece['modules'], str(piece['verdict'])) for piece in both.check().pieces])
print(both.pieces(), both.largest_piece().check().verdict)

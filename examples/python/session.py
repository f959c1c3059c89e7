# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A session
#
# A robot as the last line of a cell's output shows itself: the page, in which it can be turned,
# changed and checked again, without network. Where the page is not built it is a picture.

# %%
import holdfast

robot = holdfast.Robot([[0, 0, 0], [1, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2],
                        [3, 0, 2], [3, 1, 2]], planned=[[4, 0, 2]], name='crane')
report = robot.check()
report

# %% [markdown]
# The same in words:

# %%
print(report.verdict.value, *report.reasons, sep='\n')

# %% [markdown]
# Where may the next module go instead? Every free cell beside the robot, best first:

# %%
places = robot.planning([]).next()
print(repr(places))
print(places.safe[:3].tolist())

# %% [markdown]
# With a counterweight attached together with it, the planned module is safe. Which one leaves the
# largest margin?

# %%
plans = [robot.planning([[4, 0, 2], cell]) for cell in places.safe.tolist()]
safe = [one for one in holdfast.check_many(plans) if one.verdict is holdfast.Verdict.SAFE]
best = max(safe, key=lambda one: float(one.stability['margin_mm']))
print(f'{len(safe)} of {len(plans)} do; best is {best.robot.planned[1].tolist()}, margin '
      f'{best.stability["margin_mm"]:.2f} mm')
best

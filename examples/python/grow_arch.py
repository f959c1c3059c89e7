# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A planner of 30 lines
#
# It grows an arch module by module so that every state on the way is safe: of all cells of the arch
# that are beside the robot it takes the one with the least load, and goes back where none is safe.

# %%
import holdfast

Cell = tuple[int, int, int]


def arch(span: int, height: int) -> set[Cell]:
    """Two legs of 2 x 2 modules with feet outwards, and a beam two modules wide."""
    legs = {(x, y, z) for x in (0, 1, span + 2, span + 3) for y in (0, 1) for z in range(height)}
    feet = {(x, y, 0) for x in (-1, span + 4) for y in (0, 1)}
    return legs | feet | {(x, y, height - 1) for x in range(span + 4) for y in (0, 1)}


def beside(cells: list[Cell], target: set[Cell]) -> list[list[Cell]]:
    """Cells of the target that are free and share a face with the robot, each alone."""
    steps = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
    near = {(x + dx, y + dy, z + dz) for x, y, z in cells for dx, dy, dz in steps}
    return [[cell] for cell in sorted(near & target - set(cells))]


def grow(target: set[Cell], start: Cell) -> list[Cell]:
    """An order in which every state is safe, depth first; empty if there is none."""
    seen: set[frozenset[Cell]] = set()
    ways: list[list[Cell]] = [[start]]
    while ways:
        cells = ways.pop()
        if len(cells) == len(target):
            return cells
        steps = [step for step in beside(cells, target) if frozenset(cells + step) not in seen]
        seen.update(frozenset(cells + step) for step in steps)
        reports = holdfast.check_many(holdfast.Robot(cells, planned=step) for step in steps)
        judged = sorted(((report.load_ratio_max or 0, step) for report, step in zip(reports, steps)
                         if report.verdict is holdfast.Verdict.SAFE), reverse=True)
        ways += [cells + step for _, step in judged]
    return []


# %%
target = arch(span=3, height=4)
order = grow(target, (-1, 0, 0))
print(f'{len(order)} of {len(target)} modules attached')

# %% [markdown]
# `holdfast.steps` judges the plan once more, each step before, during and after the attachment:

# %%
plan = [{'attach': [cell]} for cell in order[1:]]
judged = holdfast.steps(holdfast.Robot(order[:1], name='arch'), plan)
print(f'{judged.verdict.value}; largest load ratio {judged.load_ratio_max:.4f}, smallest margin '
      f'{judged.margin_min_mm:.2f} mm')
figure = holdfast.plot_steps(judged)

# %%
finished = holdfast.Robot(order, name='arch').check()
axes = finished.plot()

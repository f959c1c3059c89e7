# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Fig. 6: six tests on Blinky Blocks
#
# Each test of Piranda et al. 2021 plans a step that holds (a), then one that topples the robot (#1
# to #3) or breaks a connection (#4 to #6) (b). The structures are those of `scenarios/`.

# %%
import pathlib

import holdfast
from matplotlib import pyplot

HERE = pathlib.Path.cwd()
SCENARIOS = next(folder / 'scenarios' for folder in (HERE, *HERE.parents)
                 if (folder / 'scenarios').is_dir())
TESTS = {'#1': 'arm_tips', '#4': 'arm_breaks', '#2': 'bush_tips', '#5': 'crane_breaks',
         '#3': 'scary_tips', '#6': 'angle_breaks'}

# %%
figure = pyplot.figure(figsize=(13, 11))
figure.subplots_adjust(0.02, 0, 0.98, 0.9, 0.1, 0.35)
print('test    verdict    margin, mm  largest load ratio')
for index, (test, name) in enumerate(TESTS.items()):
    for column, stage in enumerate('ab'):
        report = holdfast.load(SCENARIOS / f'{name}_{stage}.json').check()
        axes = figure.add_subplot(3, 4, 2 * index + column + 1, projection='3d')
        report.plot(axes, title=f'{test} ({stage})', legend=False)
        ratio = '' if report.verdict.name == 'UNSTABLE' else f'{report.load_ratio_max:.4f}'
        print(f'{test} ({stage})  {report.verdict.value:9} {report.stability["margin_mm"]:+11.2f}'
              f'  {ratio:>18}')

# %% [markdown]
# The colours say how much of its strength a module's worst connection carries, from green to
# orange; red ones break, and a robot that topples is purple. Planned modules are dashed.

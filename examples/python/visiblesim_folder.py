# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A folder of VisibleSim files as a table
#
# Every configuration in a folder is checked, several at a time. A file that cannot be read is named
# with what is wrong in it, and the others are checked all the same.

# %%
import pathlib
import sys
import tempfile

import holdfast

HERE = pathlib.Path.cwd()
SCENARIOS = next((folder / 'scenarios' for folder in (HERE, *HERE.parents)
                  if (folder / 'scenarios').is_dir()), HERE)


def table_of(folder: pathlib.Path) -> None:
    """Prints a line for every .xml file of a folder, worst first, then what could not be read."""
    robots, faults = [], []
    for path in sorted(folder.glob('*.xml')):
        try:
            robots.append(holdfast.load(path))
        except holdfast.Error as error:
            faults.append(str(error).replace(f'{folder}/', ''))
    reports = holdfast.check_many(robots)
    rows = holdfast.table(reports)
    print('file            modules  verdict    largest load ratio  margin, mm')
    for index in (-rows['load_ratio_max']).argsort(kind='stable'):
        row, robot, report = rows[index], robots[index], reports[index]
        print(f'{robot.name:15} {row["modules"]:7}  {report.verdict.value:9} '
              f'{row["load_ratio_max"]:19.4f} {row["margin_mm"]:+11.2f}')
    print(*faults, sep='\n')


# %% [markdown]
# With a folder as the argument it is that folder's; here the paper's structures are written as
# VisibleSim files first, and one is spoilt.

# %%
def example(folder: pathlib.Path) -> None:
    for path in sorted(SCENARIOS.glob('*_b.json')):
        holdfast.load(path).save(folder / f'{path.stem}.xml')
    (folder / 'spoilt.xml').write_text('<world gridSize="4,4,4"><blockList><block position="a,b"/>')


if len(sys.argv) == 2 and pathlib.Path(sys.argv[1]).is_dir():
    table_of(pathlib.Path(sys.argv[1]))
else:
    with tempfile.TemporaryDirectory() as name:
        example(pathlib.Path(name))
        table_of(pathlib.Path(name))

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""shown_test.py HOLDFAST REPOSITORY IMAGES [--renew]
The documents show what emulated modules do, and how large the images are. IMAGES is build/firmware.

- the rows of the scenarios in docs/evidence/firmware.md: seconds are simulated, from the plan
  (or the start) to the last module's verdict, on both boards' lines; printed as they are measured
- the command in docs/tour.md that needs the firmware prints what is shown
- sizes of images and of the library, wherever a sentence or a table gives them

What the published method takes stays as it is: preset iterations x 110.5 ms [Piranda 2021].
With --renew all of it is written anew; look at the difference.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from documents_test import is_same, renewed, shown_commands  # noqa: E402

CYCLES_PER_MS = 48e3


class Documents:
    """The texts, what differs in them, and what they should be."""

    def __init__(self, repository):
        self.repository = repository
        self.texts = {name: (repository / name).read_text()
                      for name in ('docs/tour.md', 'docs/firmware.md', 'docs/porting.md',
                                   'docs/evidence/firmware.md')}
        self.faults = []

    def expect(self, name, pattern, value):
        """The only group of `pattern`, which is somewhere in the document, is `value`."""
        text = self.texts[name]
        found = re.search(pattern, text, re.M)
        if not found:
            self.faults.append(f'{name}: nothing like {pattern}')
        elif found[1] != value:
            self.faults.append(f'{name}: {found[0]}\n  it is {value}')
            self.texts[name] = text[:found.start(1)] + value + text[found.end(1):]

    def expect_output(self, name, command, printed):
        """The shown command that ends with `command` prints these lines."""
        for full, shown in shown_commands(self.texts[name]):
            if full.endswith(command):
                if not is_same(shown, printed):
                    self.faults.append(f'{name}: {command}\n  ' + '\n  '.join(printed))
                    self.texts[name] = renewed(self.texts[name], shown, printed)
                return
        self.faults.append(f'{name}: {command} is not shown')

    def write(self):
        for name, text in self.texts.items():
            (self.repository / name).write_text(text)


def emulate(holdfast, scenario, board):
    run = subprocess.run([holdfast, 'emulate', scenario, '--board', board, '--quiet',
                          '--json', '-'], capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


def check_scenario(documents, scenario, v2, v1):
    """The row of a scenario, by the reports of both boards."""
    image, robot = v2['firmware'], v2['distributed']
    seconds_v1 = v1['firmware']['verdict_after_s']
    ratio = robot['load_ratio_max']
    begin = [str(len(json.loads(scenario.read_text())['modules'])),
             robot['verdict'] + (f' {round(ratio, 4) + 0:.4f}' if ratio is not None else ''),
             f'{image["verdict_after_s"]:.2f}']
    longest = f'{image["step_cycles_max"] / CYCLES_PER_MS:.1f}'
    end = [f'{image["stack_bytes_max"]:,}', 'NO' if image['steps_unlike_host'] else 'yes']
    full = begin + [f'{seconds_v1:.2f}', longest, f'{image["step_cycles_mean"]:,}'] + end
    print(f'| {scenario.stem} | ' + ' | '.join(full) + ' |', flush=True)
    row = rf'^\| {scenario.stem} \| (\d[^\n]*) \| [\d,]+ \|$'
    documents.expect('docs/evidence/firmware.md', row, ' | '.join(full))


def sizes_of(program, image):
    sizes = subprocess.run([program, image], capture_output=True, text=True, check=True).stdout
    return map(int, sizes.split('\n')[1].split()[:3])


def check_sizes(documents, images, v2, v1):
    measured = 'docs/evidence/firmware.md'
    flash, ram, agent = (f'{v2[key]:,}' for key in ('flash_bytes', 'ram_bytes', 'agent_bytes'))
    documents.expect('docs/firmware.md', r'the image \(the 62 KB .*\| ([\d,]+) \|$', flash)
    documents.expect(measured, r'^\| flash at most 60 KB .*\| ([\d,]+) \| met', flash)
    documents.expect(measured, r'^\| RAM at most 8 KB .*\| (.*), program around it',
                     f'{ram} bytes: agent {agent}')
    documents.expect('docs/firmware.md', r'It takes (.* of RAM: agent [\d,]+\d)',
                     f'{v1["flash_bytes"]:,} bytes of flash and {v1["ram_bytes"]:,} of RAM: '
                     f'agent {v1["agent_bytes"]:,}')
    text, data, bss = sizes_of('arm-none-eabi-size', images / 'module_stm32f091xc.elf')
    documents.expect('docs/firmware.md', r'^\| the image, data included .*?\| (\d.*) \|$',
                     f'{text + data:,} | {data + bss:,}')
    text, data, bss = sizes_of('avr-size', images / 'avr/module_atxmega256a3.elf')
    documents.expect('docs/firmware.md',
                     r'bits: ([\d,]+ bytes of flash of [\d,]+, [\d,]+ of RAM) '
                     r'\(`module_atxmega256a3.elf`\)',
                     f'{text + data:,} bytes of flash of 262,144, {data + bss:,} of RAM')


def check_library(documents, images):
    for line in (images / 'library/sizes').read_text().splitlines():
        core, flash = line.split()
        documents.expect('docs/porting.md', rf'{core}\.cmake\) \| ([\d,]+) \|$', f'{int(flash):,}')


def main():
    holdfast, repository, images = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    documents = Documents(repository)
    scenarios = sorted((repository / 'scenarios').glob('*.json'))
    runs = [(scenario, board) for scenario in scenarios for board in ('v2', 'v1')]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        reports = pool.map(lambda run: emulate(holdfast, *run), runs)
        for scenario in scenarios:
            v2, v1 = next(reports), next(reports)
            check_scenario(documents, scenario, v2, v1)
    check_sizes(documents, images, v2['firmware'], v1['firmware'])
    check_library(documents, images)
    shown = 'emulate scenarios/arm_breaks_b.json'
    printed = subprocess.run([holdfast, *shown.split()], cwd=repository, capture_output=True,
                             text=True, check=False).stdout.rstrip('\n').split('\n')
    documents.expect_output('docs/tour.md', shown, printed)
    if '--renew' in sys.argv:
        documents.write()
    print('\n'.join(documents.faults) or f'{len(scenarios)} scenarios are as shown')
    sys.exit(1 if documents.faults else 0)


if __name__ == '__main__':
    main()

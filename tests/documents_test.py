#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""documents_test.py HOLDFAST CHECKER REPOSITORY [--renew]
The documents show what the program does.

- every command with an output ("$ build/release/holdfast ..." in an indented block) prints that
  output; times are not compared, and a line of dots stands for any number of lines
- every ```json block with a name is a file of that name to these commands
- the figures are those that tools/draw_figures.py draws
- the rounds, packets and seconds of the scenarios' table are those of `holdfast simulate`

With --renew outputs without dots, tables and figures are written anew; look at the difference.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

DOCUMENTS = ['README.md', *(f'docs/{name}.md' for name in (
    'first_robot', 'first_plan', 'bring_your_file', 'tour', 'theory', 'second_order', 'solver',
    'distributed', 'proof', 'page', 'formats', 'planning', 'reliability', 'cascade',
    'evidence/solver', 'evidence/distributed', 'evidence/planning'))]
# These need the firmware's compilers; tests/firmware checks what they show.
NOT_RUN = './dev firmware'

faults = []
renewals = {}  # Document -> its new text.


def fault(message):
    faults.append(message)


def shown_commands(text):
    """Command -> the lines it is shown to print."""
    blocks = re.findall(r'(?:^    .*\n|^\n(?=    ))+', text, re.M)
    for block in blocks:
        lines = [line[4:].rstrip() for line in block.rstrip('\n').split('\n')]
        while lines:
            line = lines.pop(0)
            if not line.startswith('$ '):
                continue
            command = line[2:]
            while command.endswith('\\'):
                command = command[:-1] + lines.pop(0).strip()
            end = next((i for i, other in enumerate(lines) if other.startswith('$ ')), len(lines))
            shown, lines = lines[:end], lines[end:]
            while shown and not shown[-1]:
                shown.pop()
            yield command, shown


def masked(line):
    """Without times."""
    return re.sub(r'in [\d.]+ (us|ms|s)\b', 'in N s', line.rstrip())


def renewed(text, shown, printed):
    """The document with a new output; lines that differ in a time alone stay."""
    if any(line.strip() == '...' for line in shown):
        return text
    known = {masked(line): line for line in shown}
    lines = [known.get(masked(line), line) for line in printed]

    def block(these):
        return '\n'.join('    ' + line if line else '' for line in these)
    return text.replace(block(shown), block(lines))


def is_same(shown, printed):
    if not shown:
        return not printed
    if shown[0].strip() == '...':
        return any(is_same(shown[1:], printed[i:]) for i in range(len(printed) + 1))
    return bool(printed) and masked(shown[0]) == masked(printed[0]) and is_same(
        shown[1:], printed[1:])


def check_outputs(document, text, folder):
    for block in re.findall(r'```json\n(.*?)```', text, re.S):
        name = re.search(r'"name": "([^"]*)"', block)
        if name:
            json.loads(block)
            (folder / f'{name[1].replace(" ", "_")}.json').write_text(block)
    count = 0
    for command, shown in shown_commands(text):
        if NOT_RUN in command:
            print(f'{document}: not run here: {command}')
            continue
        printed = subprocess.run(['bash', '-c', command], cwd=folder, capture_output=True,
                                 text=True, check=False).stdout.rstrip('\n').split('\n')
        if not is_same(shown or [''], printed):
            fault(f'{document}: {command}\n  shown:\n    ' + '\n    '.join(shown) +
                  '\n  printed:\n    ' + '\n    '.join(printed))
            renewals[document] = renewed(renewals.get(document, text), shown, printed)
        count += 1
    return count


def check_figures(repository, folder):
    subprocess.run([sys.executable, repository / 'tools/draw_figures.py', folder], check=True)
    for figure in folder.glob('*.svg'):
        if figure.read_bytes() != (repository / 'docs' / figure.name).read_bytes():
            fault(f'docs/{figure.name} is not what tools/draw_figures.py draws')


def measured(program, repository):
    """Scenario -> rounds, packets, seconds of the robot's own verdict."""
    costs = {}
    for file in sorted((repository / 'scenarios').glob('*.json')):
        out = subprocess.run([program, 'simulate', file], capture_output=True, text=True,
                             check=False).stdout
        cost = re.search(r'cost +([\d.]+) s, (\d+) rounds, (\d+) packets', out)
        costs[file.stem] = (f'{int(cost[2]):,}', f'{int(cost[3]):,}', f'{float(cost[1]):.1f}')
    return costs


def check_row(repository, document, row, cost):
    """`row` has the cost as its only group."""
    text = renewals.get(document, (repository / document).read_text())
    found = re.search(row, text, re.M)
    if not found:
        fault(f'{document}: no row {row}')
    elif found[1] != cost:
        fault(f'{document}: {found[0]}\n  it takes {cost}')
        renewals[document] = text[:found.start(1)] + cost + text[found.end(1):]


def check_table(repository, costs):
    for name, (rounds, packets, seconds) in costs.items():
        check_row(repository, 'docs/evidence/distributed.md', rf'^\| {name} \|.*\| ([^|]*) \|$',
                  f'{rounds}, {packets}, {seconds}')


def main():
    program, checker, repository = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    if '--renew' in sys.argv:
        subprocess.run([sys.executable, repository / 'tools/draw_figures.py',
                        repository / 'docs'], check=True)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / 'build/release').mkdir(parents=True)
        (folder / 'figures').mkdir()
        check_figures(repository, folder / 'figures')
        os.symlink(program, folder / 'build/release/holdfast')
        os.symlink(checker, folder / 'build/release/holdfast-checker')
        os.symlink(repository / 'scenarios', folder / 'scenarios')
        os.symlink(repository / 'examples', folder / 'examples')
        count = sum(check_outputs(document, (repository / document).read_text(), folder)
                    for document in DOCUMENTS if (repository / document).is_file())
    check_table(repository, measured(program, repository))
    if '--renew' in sys.argv:
        for document, text in renewals.items():
            (repository / document).write_text(text)
    print('\n'.join(faults) if faults else f'{count} commands print what is shown')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

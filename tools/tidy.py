#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""tidy.py ROOT   checks what STYLE.md says and a script can check; prints every breach, exits 1.

- a room includes only itself and the rooms that its CMakeLists.txt links (include direction)
- applications include only the facade, and name only the rooms that it exports
- files stop at 800 lines, lines at 100 characters; functions stop at 70 lines
- every source begins with the two SPDX lines; every header has #pragma once
- no block of /// begins with a word that leaves its subject to the neighbour, such as "Of"
- every room has a README.md of 10 to 40 lines
- no folder of a room keeps more than 25 files, and includes between its folders go one way
- no tab, no trailing blank, no path of a machine, no TODO without an issue number
- a link from one document leads to a file that is there, and to a heading that is there
- what is cited as [Author 1999] has an entry in docs/references.bib
- documents and messages keep to the words of docs/glossary.md (words.py)
"""
import pathlib
import re
import subprocess
import sys

import words

SOURCE_SUFFIXES = {'.cpp', '.hpp'}
# REUSE-IgnoreStart
SPDX = ['SPDX-FileCopyrightText: The holdfast authors', 'SPDX-License-Identifier: Apache-2.0']
# REUSE-IgnoreEnd
FILE_LINES_MAX = 800
FUNCTION_LINES_MAX = 70
COLUMNS_MAX = 100
FOLDER_FILES_MAX = 25
# A block of /// that begins so has no subject, or one that its neighbour has to name.
FRAGMENT = re.compile(r'(After|Also|And|As|At|Before|But|By|False|For|From|In|Its?|None|Null|'
                      r'nullptr|Of|On|So|Such|That|The same|They|Those|To|Towards|Which|Whose?|'
                      r'With|Without)\b')
FREESTANDING = {'base', 'boards', 'mechanics', 'agent', 'module'}
APPLICATIONS = ('apps/', 'examples/', 'python/')
FACADE_HEADERS = {'holdfast', 'distributed', 'emulated', 'exit_code', 'figure_file', 'file_ending',
                  'cascade', 'check_formats', 'deformed_series', 'falling_pieces', 'fit',
                  'instrument', 'losses', 'move', 'order', 'plan_failures', 'reliability',
                  'simulated_next', 'simulated_stages', 'simulated_steps', 'steps', 'trial',
                  'weakened'}
HOSTED_HEADERS = {'string', 'vector', 'map', 'set', 'memory', 'iostream', 'fstream', 'variant',
                  'cstdio', 'cstdlib', 'functional', 'stdexcept'}
# base is freestanding but for what says in its first lines that it is for hosts.
HOSTED_FILES = {'libs/base/include/holdfast/base/result.hpp', 'libs/base/src/check.cpp'}

faults = []


def fault(path, line, message):
    faults.append(f'{path}:{line}: {message}')


def tracked_files(root):
    command = ['git', '-C', root, 'ls-files', '--cached', '--others', '--exclude-standard']
    names = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    return sorted(name for name in set(names) if (pathlib.Path(root) / name).is_file())


def rooms(root):
    return [*(root / 'libs').iterdir(), *(root / 'extras').iterdir()]


def room_links(root):
    """Room -> rooms that it may include: itself and, transitively, what it links."""
    direct = {}
    for room in rooms(root):
        text = (room / 'CMakeLists.txt').read_text()
        if 'holdfast_room(' not in text:
            continue
        room_call = text[text.index('holdfast_room('):]
        room_call = room_call[:room_call.index(')')]
        direct[room.name] = set(re.findall(r'holdfast::(\w+)', room_call))

    def closure(room):
        return {room}.union(*(closure(other) for other in direct[room]))
    return {room: closure(room) for room in direct}


def facade_exports(root):
    """The rooms whose headers the facade's headers export."""
    exported = set()
    for header in FACADE_HEADERS:
        text = ''.join(file.read_text() for file in root.glob(f'*/*/include/holdfast/{header}.hpp'))
        exported |= set(re.findall(r'holdfast/(\w+)/\w+\.hpp" *// IWYU pragma: export', text))
    return exported


def check_named_rooms(name, lines, links, exported):
    if not name.startswith(APPLICATIONS) or name.startswith(('apps/checker/', 'apps/cluster/')):
        return
    for number, line in enumerate(lines, 1):
        for room in re.findall(r'(?<![\w:])(?:holdfast::|hf::)?(\w+)::', line.split('//')[0]):
            if room in links and room not in exported | {'holdfast'}:
                fault(name, number, f'{room} is not exported by the facade, which exports '
                                    f'{sorted(exported)}')


def check_includes(name, lines, links):
    match = re.match(r'(?:libs|extras)/(\w+)/(include|src)/', name)
    allowed = links.get(match[1]) if match else None
    if name.startswith(APPLICATIONS):
        allowed = None
    for number, line in enumerate(lines, 1):
        include = re.match(r'#include ["<]holdfast/(\w+)[/.]', line)
        if (include and allowed is not None and include[1] not in allowed
                and not ('holdfast' in allowed and include[1] in FACADE_HEADERS)):
            fault(name, number, f'{match[1]} may not include {include[1]}, it links '
                                f'{sorted(allowed - {match[1]})}')
        if name.startswith('apps/checker/'):
            if include and include[1] != 'certificate':
                fault(name, number, 'the checker includes only certificate')
        elif name.startswith('apps/cluster/'):
            if include and include[1] != 'cluster':
                fault(name, number, 'holdfast-mpi includes only cluster')
        elif (include and name.startswith(APPLICATIONS)
                and include[1] not in FACADE_HEADERS):
            fault(name, number, 'applications include only the facade, holdfast/holdfast.hpp, '
                                'trial.hpp, distributed.hpp, emulated.hpp, instrument.hpp')
        system = re.match(r'#include <(\w+)>', line)
        if (match and match[1] in FREESTANDING and name not in HOSTED_FILES and system
                and system[1] in HOSTED_HEADERS):
            fault(name, number, f'{match[1]} is freestanding and may not include <{system[1]}>')


def check_functions(root, names):
    """Lines from the name of a function to the brace that ends it, as ctags finds them."""
    command = ['ctags', '-L', '-', '--languages=C++', '--kinds-C++=f', '--fields=+ne', '-x',
               '--_xformat=%F %n %{end} %N']
    found = subprocess.run(command, cwd=root, input='\n'.join(names), capture_output=True,
                           text=True, check=True).stdout.splitlines()
    if len(found) < len(names):
        fault('tools/tidy.py', 1, f'ctags found {len(found)} functions in {len(names)} files')
    for entry in found:
        name, start, end, function = entry.split(' ', 3)
        count = int(end) - int(start) + 1
        if count > FUNCTION_LINES_MAX:
            fault(name, start, f'expected at most {FUNCTION_LINES_MAX} lines in {function}, '
                               f'found {count}')


def check_text(name, lines):
    for number, line in enumerate(lines, 1):
        if '\t' in line or line != line.rstrip():
            fault(name, number, 'tab or trailing blank')
        if len(line) > COLUMNS_MAX and 'http' not in line:
            fault(name, number, f'expected at most {COLUMNS_MAX} columns, found {len(line)}')
        if re.search(r'TODO(?!\(#\d+\))', line) and not name.endswith(('tidy.py', 'STYLE.md')):
            fault(name, number, 'TODO without an issue number')


def check_comments(name, lines):
    is_within = False
    for number, line in enumerate(lines, 1):
        block = re.match(r'\s*///(?!<) ?(.*)', line)
        start = FRAGMENT.match(block[1]) if block and not is_within else None
        if start:
            fault(name, number, f'expected a sentence with its subject, found "{start[0]} ..."')
        is_within = block is not None


def check_source(name, lines, links, exported):
    if [line[3:] for line in lines[:2]] != SPDX:
        fault(name, 1, 'the first two lines are not the SPDX notice')
    if name.endswith('.hpp') and '#pragma once' not in lines:
        fault(name, 1, 'no #pragma once')
    if len(lines) > FILE_LINES_MAX:
        fault(name, len(lines), f'expected at most {FILE_LINES_MAX} lines, found {len(lines)}')
    check_comments(name, lines)
    check_includes(name, lines, links)
    check_named_rooms(name, lines, links, exported)


def check_room_readmes(root):
    for room in rooms(root):
        readme = room / 'README.md'
        count = len(readme.read_text().splitlines()) if readme.is_file() else 0
        if not 10 <= count <= 40:
            fault(readme.relative_to(root), 1, f'expected 10 to 40 lines, found {count}')


def folder_arrows(room):
    """Folder -> folders that its files include; files beside the folders belong to none."""
    public = f'holdfast/{room.name}/'
    arrows = {}
    for top in (room / 'src', room / 'include' / public):
        for file in top.rglob('*.[ch]pp'):
            here = file.parent.relative_to(top).as_posix()
            for include in re.findall(r'#include "([^"]+)"', file.read_text()):
                there = pathlib.PurePosixPath(include.removeprefix(public)).parent.as_posix()
                if not there.startswith('holdfast') and '.' not in (here, there) and there != here:
                    arrows.setdefault(here, set()).add(there)
    return arrows


def check_folders(root):
    for room in rooms(root):
        for folder in [room / 'src', *(room / 'src').rglob('*'), *(room / 'include').rglob('*')]:
            count = sum(path.suffix in SOURCE_SUFFIXES for path in folder.glob('*.[ch]pp'))
            if count > FOLDER_FILES_MAX:
                fault(folder.relative_to(root), 1,
                      f'expected at most {FOLDER_FILES_MAX} files, found {count}')
        arrows = folder_arrows(room)
        while arrows:
            ends = [one for one, others in arrows.items() if not others & arrows.keys()]
            if not ends:
                fault(f'{room.relative_to(root)}/src', 1,
                      f'includes go in a circle between the folders {sorted(arrows)}')
                break
            for one in ends:
                del arrows[one]


def anchors_of(path):
    """As forges make them from headings: small letters, blanks as dashes, no other signs."""
    headings = re.findall(r'^#+ (.*)$', path.read_text(), re.M)
    return {re.sub(r'[^\w -]', '', heading.lower()).replace(' ', '-') for heading in headings}


def check_links(root, name, lines):
    for number, line in enumerate(lines, 1):
        for link in re.findall(r'\]\(([^)\s]+)\)', line):
            if re.match(r'[a-z]+:', link):
                continue
            file, _, anchor = link.partition('#')
            target = (root / name).parent / file if file else root / name
            if not target.exists():
                fault(name, number, f'nothing is at {link}')
            elif anchor and anchor not in anchors_of(target):
                fault(name, number, f'no heading makes #{anchor}')


def check_citations(name, lines, known):
    for number, line in enumerate(lines, 1):
        for brackets in re.findall(r'\[[A-Z][^\[\]]* (?:19|20)\d\d[^\[\]]*\]', line):
            for author, year in re.findall(r'([A-Z][a-z]+)[^;\d]*? ((?:19|20)\d\d)', brackets):
                if author + year not in known:
                    fault(name, number, f'docs/references.bib has no {author}{year}')


def check_words(table, name, text):
    for line, avoided, instead in words.breaches(table, name, text):
        fault(name, line, f'"{avoided}" is a word that we do not use; instead: {instead}')


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    links = room_links(root)
    cited = set(re.findall(r'^@\w+{(\w+),', (root / 'docs/references.bib').read_text(), re.M))
    exported = facade_exports(root)
    table = words.read_table(root)
    names = tracked_files(root)
    check_functions(root, [name for name in names if pathlib.Path(name).suffix in SOURCE_SUFFIXES])
    for name in names:
        path = root / name
        if path.suffix in SOURCE_SUFFIXES | {'.md'}:
            check_words(table, name, path.read_text())
        if path.suffix in SOURCE_SUFFIXES:
            lines = path.read_text().splitlines()
            check_source(name, lines, links, exported)
            check_text(name, lines)
            check_citations(name, lines, cited)
        elif path.suffix in {'.py', '.sh', '.cmake'} or path.name == 'CMakeLists.txt':
            check_text(name, path.read_text().splitlines())
        elif path.suffix == '.md':
            check_links(root, name, path.read_text().splitlines())
            if name != 'STYLE.md':
                check_citations(name, path.read_text().splitlines(), cited)
    check_room_readmes(root)
    check_folders(root)
    print('\n'.join(faults) if faults else 'tidy: no breach')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""lint.py BUILD [--since COMMIT] [--analyze]   clang-tidy over the sources of a build folder.

Looks at libraries, extras, applications and examples, not at tests, in the groups in which they are
compiled (UNITY_BUILD); checks and options stand in .clang-tidy. Prints every finding once; exits 1
if there is any.

--since COMMIT  only groups with a source that has changed since then, or a header of their room;
                'day' is the last commit that is a day older than HEAD, or all if there is none
--analyze       with the static analyzer of clang, which takes as long again
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

SOURCES = re.compile(r'^(libs|extras|apps|examples|integrations)/.*\.cpp$')
# In a group of files each #include of a source is suspicious.
WITHOUT = '-bugprone-suspicious-include'


def git(root, *arguments):
    return subprocess.run(['git', '-C', root, *arguments], capture_output=True, text=True,
                          check=True).stdout


def commands(build):
    """The compile commands of all that are no tests. A test that compiles a library's source again
    reads headers precompiled by GCC, which clang cannot."""
    return [entry for entry in json.loads((build / 'compile_commands.json').read_text())
            if 'verify_interface_header_sets' not in entry['file']
            and '_test.dir' not in entry['command']]


def groups(root, build, entries):
    """Translation unit -> the sources of the repository in it."""
    found = {}
    for entry in entries:
        unit = pathlib.Path(entry['file'])
        sources = [unit]
        if unit.is_relative_to(build):
            sources = [pathlib.Path(name)
                       for name in re.findall(r'^#include "(/.*)"', unit.read_text(), re.M)]
        names = {source.relative_to(root).as_posix() for source in sources
                 if source.is_relative_to(root)}
        if names and all(SOURCES.match(name) and '/test/' not in name for name in names):
            found[unit] = names
    return found


def room(name):
    return '/'.join(name.split('/')[:2])


def changed_since(root, commit):
    if commit == 'day':
        day = int(git(root, 'log', '-1', '--format=%ct')) - 24 * 3600
        commit = git(root, 'rev-list', '-1', f'--before={day}', 'HEAD').strip()
    return set(git(root, 'diff', '--name-only', commit).splitlines()) if commit else None


def is_changed(names, changed):
    headers = {room(name) for name in changed if name.endswith('.hpp') and '/test/' not in name}
    return any(name in changed or room(name) in headers for name in names)


def findings_of(unit, database, root, analyze):
    without = WITHOUT if analyze else WITHOUT + ',-clang-analyzer-*'
    run = subprocess.run(['clang-tidy', '-quiet', f'-checks={without}', '-p', database,
                          '-extra-arg=-Wno-unknown-warning-option', unit], cwd=root,
                         capture_output=True, text=True, check=False)
    found = re.findall(r'^((?:/.*: )?(?:error|warning): .*)$', run.stdout, re.M)
    if run.returncode != 0 and not found:
        found = [f'{unit}: clang-tidy exits {run.returncode}: {run.stderr.strip()[-400:]}']
    return {line.removeprefix(f'{root}/') for line in found}


def main():
    parser = argparse.ArgumentParser(description='clang-tidy over the sources of a build folder')
    parser.add_argument('build', type=pathlib.Path)
    parser.add_argument('--since')
    parser.add_argument('--analyze', action='store_true')
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parent.parent
    build = options.build.resolve()
    entries = commands(build)
    units = groups(root, build, entries)
    changed = changed_since(root, options.since) if options.since else None
    chosen = [unit for unit, names in units.items()
              if changed is None or is_changed(names, changed)]
    print(f'clang-tidy: {len(chosen)} of {len(units)} groups of sources', flush=True)
    database = build / 'lint'
    database.mkdir(exist_ok=True)
    (database / 'compile_commands.json').write_text(json.dumps(entries))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        lists = pool.map(lambda unit: findings_of(unit, database, root, options.analyze), chosen)
        found = sorted(set().union(*lists))
    print('\n'.join(found) if found else 'clang-tidy: nothing found')
    sys.exit(1 if found else 0)


if __name__ == '__main__':
    main()

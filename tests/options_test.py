#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""options_test.py CACHE DOCUMENT   the options in CMake's cache are those in the document's
table "CMake options", and the other way round but for what the table says is Emscripten's."""
import pathlib
import re
import sys


def cached_options(text):
    """Those that a user sees: not internal, not advanced."""
    advanced = set(re.findall(r'^(\w+)-ADVANCED:INTERNAL=1', text, re.MULTILINE))
    names = set(re.findall(r'^(HOLDFAST_\w+):(?!INTERNAL|STATIC)', text, re.MULTILINE))
    return names - advanced


def documented_options(text):
    """Option -> what the table says of it."""
    section = text.split('## CMake options')[1].split('\n## ')[0]
    return dict(re.findall(r'^\| `(HOLDFAST_\w+)` \|[^|]*\|(.*)\|$', section, re.MULTILINE))


def main():
    cached = cached_options(pathlib.Path(sys.argv[1]).read_text())
    documented = documented_options(pathlib.Path(sys.argv[2]).read_text())
    faults = [f'{name} is in no table' for name in sorted(cached - documented.keys())]
    faults += [f'{name} is in the table, but CMake does not know it'
               for name in sorted(documented.keys() - cached)
               if not documented[name].strip().startswith('Emscripten only')]
    print('\n'.join(faults) if faults else f'options: {len(cached)}, all in the table')
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

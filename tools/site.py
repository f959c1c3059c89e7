#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""site.py REPOSITORY HOLDFAST FOLDER   lays out in FOLDER what Sphinx makes the site of.

- the documents of docs/, links out of docs/ turned into names of files
- index.md and a page for each kind of document, from SECTIONS
- commands.md: what --help says of every command; reports.md: the keys of docs/schemas
- gallery.md: twenty robots with their pictures
- cpp_api.md and python_api.md: the facade's names, from Doxygen's XML, and the package's

Every document of docs/ has to be in SECTIONS, once.
"""
import pathlib
import re
import shutil
import subprocess
import sys

from gallery_page import lay_gallery
from reports_page import reports_page

SECTIONS = [
    ('Tutorials', 'From nothing to an answer, step by step.',
     ['first_robot', 'first_plan', 'bring_your_file', 'python_examples', 'tour', 'gallery',
      'porting']),
    ('How to', 'One task each.',
     ['install', 'python', 'serve', 'page', 'visiblesim', 'firmware', 'instrument', 'cluster']),
    ('Reference', 'What there is, complete.',
     ['commands', 'formats', 'reports', 'robots', 'python_api', 'cpp_api', 'wire', 'building',
      'glossary']),
    ('Explanation', 'Why it works.',
     ['theory', 'second_order', 'general', 'limit', 'reliability', 'cascade', 'proof', 'solver',
      'planning', 'distributed']),
    ('Evidence', 'Measurements, each made by a command.',
     ['evidence/solver', 'evidence/distributed', 'evidence/planning', 'evidence/cluster',
      'evidence/firmware', 'evidence/wire', 'evidence/visiblesim', 'evidence/page',
      'evidence/python', 'evidence/general', 'evidence/second_order', 'evidence/reliability',
      'evidence/proof', 'evidence/limit', 'evidence/elastic_and_limit', 'evidence/supports',
      'evidence/test6', 'evidence/printed_frames', 'evidence/libraries']),
]

INDEX = '''# holdfast

A modular robot is built of many small modules. Before one is attached or moved: *will the robot
hold?* holdfast predicts which connections would break and whether the robot would topple, on a
workstation and inside the robot.

```{image} arm_breaks_b.svg
:alt: An arm of modules with two planned ones; one connection would carry 1.20 of its strength
```

| you are | begin with |
|---|---|
| new here, a student | [Your first robot](first_robot.md), [the page](page.md) in a browser |
| writing Python | [Python](python.md), [examples](python_examples.md), [its names](python_api.md) |
| writing C++ | [install](install.md), [the facade](cpp_api.md) |
| building a robot | [firmware](firmware.md), [how the robot decides](distributed.md) |
| reading the paper | [theory](theory.md), [its sixth test, revisited](evidence/test6.md) |

'''


def without_ways_out(text, depth):
    """Links out of docs/ become their words, as there is nothing on the site to go to. The document
    is `depth` folders below docs/."""
    up = r'\.\./' * (depth + 1)
    return re.sub(rf'(?<!!)\[([^\]]+)\]\({up}[^)]*\)', r'\1', text)


def lay_documents(docs, folder):
    shutil.copytree(docs, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns('site'))
    for document in folder.rglob('*.md'):
        depth = len(document.relative_to(folder).parts) - 1
        document.write_text(without_ways_out(document.read_text(), depth))


def commands_of(program):
    listed = subprocess.run([program, '--help'], capture_output=True, text=True, check=True).stdout
    body = listed[listed.index('Commands:'):].split('\n')[1:]
    return [line.split()[0] for line in body if re.match(r'  \w', line)]


def commands_page(program):
    parts = ['# Commands\n\nWhat `holdfast COMMAND --help` says; the manual page has the same.\n']
    for command in commands_of(program):
        text = subprocess.run([program, command, '--help'], capture_output=True, text=True,
                              check=True).stdout
        parts += [f'## holdfast {command}', '', '```text', text.rstrip(), '```', '']
    return '\n'.join(parts)


CPP_PAGE = '''# Names of the C++ library

The facade, `#include "holdfast/holdfast.hpp"` and its neighbours: everything that an application
includes.

```{doxygennamespace} holdfast
:project: holdfast
:content-only:
:members:
```
'''

PYTHON_PAGE = '''# Names of the Python package

```{eval-rst}
.. automodule:: holdfast
   :members:
   :imported-members:
```
'''


def lay_sections(folder):
    index = [INDEX]
    for title, line, names in SECTIONS:
        index += [f'```{{toctree}}\n:caption: {title}\n:maxdepth: 1\n'] + names + ['```\n']
    (folder / 'index.md').write_text('\n'.join(index))
    listed = [name for _, _, names in SECTIONS for name in names]
    there = {str(path.relative_to(folder).with_suffix('')) for path in folder.rglob('*.md')}
    there -= {'index'}
    if sorted(listed) != sorted(there):
        sys.exit(f'site.py: SECTIONS and docs/ differ: {sorted(there ^ set(listed))}')


def main():
    repository, program = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    folder = pathlib.Path(sys.argv[3])
    shutil.rmtree(folder, ignore_errors=True)
    lay_documents(repository / 'docs', folder)
    (folder / 'commands.md').write_text(commands_page(program))
    (folder / 'reports.md').write_text(reports_page(repository / 'docs/schemas'))
    (folder / 'cpp_api.md').write_text(CPP_PAGE)
    (folder / 'python_api.md').write_text(PYTHON_PAGE)
    lay_gallery(repository, program, folder)
    lay_sections(folder)


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""notebooks.py ROOT [--renew]
The examples of the Python package are scripts in cells; notebooks and a document come of them.

- examples/python/NAME.ipynb is NAME.py in cells, without outputs
- every notebook runs, and prints what docs/python_examples.md shows

With --renew notebooks, document and its pictures are written anew; look at the difference. Needs
python3-nbclient, python3-ipykernel, python3-matplotlib, and the package on PYTHONPATH.
"""
import difflib
import json
import os
import pathlib
import re
import sys

ORDER = ('session', 'figure_6', 'figure_7', 'grow_arch', 'strength_needed', 'visiblesim_folder')
DOCUMENT = 'docs/python_examples.md'
# Pictures as SVG with texts as texts, the same in every run; not a part of the notebook.
PREPARATION = '''import matplotlib
from matplotlib_inline.backend_inline import set_matplotlib_formats
matplotlib.rcParams.update({'svg.fonttype': 'none', 'svg.hashsalt': 'holdfast'})
set_matplotlib_formats('svg', metadata={'Date': None}, bbox_inches=None)'''
HEAD = '''# Examples in Python

Made by `tools/notebooks.py` of the scripts in [examples/python](../examples/python), each of which
is there as a notebook, too. What is shown is what the notebooks print; `./dev test python`
compares.
'''


def cells_of(script):
    """(kind, source) of every cell."""
    parts = re.split(r'^# %%(.*)\n', script, flags=re.M)[1:]
    for kind, source in zip(parts[::2], parts[1::2]):
        if 'markdown' in kind:
            lines = [line[2:] for line in source.strip().splitlines()]
            yield 'markdown', '\n'.join(lines)
        else:
            yield 'code', source.strip()


def notebook_of(script):
    """A notebook without outputs, as a dictionary."""
    cells = []
    for kind, source in cells_of(script):
        cell = {'cell_type': kind, 'metadata': {}, 'source': source.splitlines(keepends=True)}
        if kind == 'code':
            cell.update(execution_count=None, outputs=[])
        cells.append(cell)
    kernel = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}
    return {'cells': cells, 'metadata': {'kernelspec': kernel}, 'nbformat': 4, 'nbformat_minor': 4}


def notebook_text(script):
    return json.dumps(notebook_of(script), indent=1, ensure_ascii=False) + '\n'


def executed(root, script):
    """The cells of the notebook with what they put out."""
    import nbclient
    import nbformat
    os.environ['PYDEVD_DISABLE_FILE_VALIDATION'] = '1'  # Of the kernel's debugger.
    notebook = nbformat.reads(notebook_text(script), as_version=4)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(PREPARATION))
    nbclient.NotebookClient(notebook, timeout=300, kernel_name='python3').execute(
        cwd=str(root))
    return notebook.cells[1:]


def shown(name, cells):
    """The example as markdown, and its pictures by file name."""
    parts, pictures = [], {}
    for cell in cells:
        if cell.cell_type == 'markdown':
            parts.append(re.sub('^# ', '## ', cell.source))
            continue
        parts.append(f'```python\n{cell.source}\n```')
        # A kernel sends what is printed in pieces, by chance.
        printed = ''.join(output.get('text', '') for output in cell.outputs)
        if printed:
            lines = '\n'.join(line.rstrip() for line in printed.rstrip().splitlines())
            parts.append(f'```text\n{lines}\n```')
        for output in cell.outputs:
            data = output.get('data', {})
            if 'image/svg+xml' in data:
                file = f'python_{name}_{len(pictures) + 1}.svg'
                pictures[file] = data['image/svg+xml']
                parts.append(f'![{name}]({file})')
            elif 'text/plain' in data:
                parts.append(f'```text\n{data["text/plain"]}\n```')
    return '\n\n'.join(parts) + '\n', pictures


def document(root):
    """The whole document, and all pictures."""
    parts, pictures = [HEAD], {}
    for name in ORDER:
        script = (root / f'examples/python/{name}.py').read_text()
        text, own = shown(name, executed(root, script))
        parts.append(text)
        pictures.update(own)
    return '\n'.join(parts), pictures


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    renews = '--renew' in sys.argv
    faults = []
    for path in sorted(root.glob('examples/python/*.py')):
        notebook = path.with_suffix('.ipynb')
        text = notebook_text(path.read_text())
        if renews:
            notebook.write_text(text)
        elif not notebook.is_file() or notebook.read_text() != text:
            faults.append(f'{notebook.name} is not what {path.name} makes')
    text, pictures = document(root)
    if renews:
        (root / DOCUMENT).write_text(text)
        for name, picture in pictures.items():
            (root / 'docs' / name).write_text(picture)
    else:
        lines = [one.splitlines() for one in ((root / DOCUMENT).read_text(), text)]
        faults += difflib.unified_diff(*lines, DOCUMENT, 'what the notebooks print', lineterm='')
    print('\n'.join(faults))
    sys.exit(1 if faults else 0)


if __name__ == '__main__':
    main()

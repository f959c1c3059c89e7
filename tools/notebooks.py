#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""notebooks.py ROOT [--renew]
The examples of the Python package are scripts in cells; notebooks and a document come of them.

- examples/python/NAME.ipynb is NAME.py in cells, with what they put out
- every notebook runs, and puts that out; docs/python_examples.md shows the same

Pictures are not compared. With --renew notebooks, document and its pictures are written again; look
at the difference. Needs
python3-nbclient, python3-ipykernel, python3-matplotlib, and the package on PYTHONPATH.
"""
import difflib
import json
import os
import pathlib
import re
import sys

ORDER = ('session', 'figure_6', 'figure_7', 'grow_arch', 'strength_needed', 'what_if',
         'visiblesim_folder')
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


def outputs_of(cell):
    """What a cell has put out, the same in every run: what is printed, then texts and pictures."""
    outputs = []
    # A kernel sends what is printed in pieces, by chance.
    printed = ''.join(output.get('text', '') for output in cell.outputs).rstrip()
    if printed:
        lines = [line.rstrip() + '\n' for line in printed.splitlines()]
        outputs.append({'output_type': 'stream', 'name': 'stdout', 'text': lines})
    for output in cell.outputs:
        data = {kind: output['data'][kind].splitlines(keepends=True)
                for kind in ('image/svg+xml', 'text/plain') if kind in output.get('data', {})}
        if data:
            outputs.append({'output_type': 'display_data', 'metadata': {}, 'data': data})
    return outputs


def notebook_of(script, outputs=None):
    """A notebook as a dictionary; `outputs` by cell, or none."""
    cells = []
    for index, (kind, source) in enumerate(cells_of(script)):
        cell = {'cell_type': kind, 'metadata': {}, 'source': source.splitlines(keepends=True)}
        if kind == 'code':
            cell.update(execution_count=None, outputs=outputs[index] if outputs else [])
        cells.append(cell)
    kernel = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}
    return {'cells': cells, 'metadata': {'kernelspec': kernel}, 'nbformat': 4, 'nbformat_minor': 4}


def notebook_text(notebook):
    return json.dumps(notebook, indent=1, ensure_ascii=False) + '\n'


def without_pictures(text):
    """Of a notebook, for comparisons."""
    notebook = json.loads(text)
    for cell in notebook['cells']:
        for output in cell.get('outputs', []):
            if 'image/svg+xml' in output.get('data', {}):
                output['data']['image/svg+xml'] = []
    return notebook_text(notebook)


def executed(root, script):
    """The notebook with what its cells put out, as a dictionary."""
    import nbclient
    import nbformat
    os.environ['PYDEVD_DISABLE_FILE_VALIDATION'] = '1'  # Of the kernel's debugger.
    notebook = nbformat.reads(notebook_text(notebook_of(script)), as_version=4)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(PREPARATION))
    nbclient.NotebookClient(notebook, timeout=300, kernel_name='python3').execute(
        cwd=str(root))
    return notebook_of(script, [outputs_of(cell) if cell.cell_type == 'code' else []
                                for cell in notebook.cells[1:]])


def shown(name, notebook):
    """The example as markdown, and its pictures by file name."""
    parts, pictures = [], {}
    for cell in notebook['cells']:
        source = ''.join(cell['source'])
        if cell['cell_type'] == 'markdown':
            parts.append(re.sub('^# ', '## ', source))
            continue
        parts.append(f'```python\n{source}\n```')
        for output in cell['outputs']:
            data = output.get('data', {})
            if 'image/svg+xml' in data:
                file = f'python_{name}_{len(pictures) + 1}.svg'
                pictures[file] = ''.join(data['image/svg+xml'])
                parts.append(f'![{name}]({file})')
            else:
                text = ''.join(output.get('text', data.get('text/plain'))).rstrip()
                parts.append(f'```text\n{text}\n```')
    return '\n\n'.join(parts) + '\n', pictures


def document(notebooks):
    """The whole document, and all pictures."""
    parts, pictures = [HEAD], {}
    for name, notebook in notebooks.items():
        text, own = shown(name, notebook)
        parts.append(text)
        pictures.update(own)
    return '\n'.join(parts), pictures


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    renews = '--renew' in sys.argv
    faults = [f'{path.name} is not in ORDER' for path in root.glob('examples/python/*.py')
              if path.stem not in ORDER]
    notebooks = {name: executed(root, (root / f'examples/python/{name}.py').read_text())
                 for name in ORDER}
    for name, notebook in notebooks.items():
        path, text = root / f'examples/python/{name}.ipynb', notebook_text(notebook)
        if renews:
            path.write_text(text)
        elif not path.is_file() or without_pictures(path.read_text()) != without_pictures(text):
            faults.append(f'{path.name} is not what {name}.py makes and puts out')
    text, pictures = document(notebooks)
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

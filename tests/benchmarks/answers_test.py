#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""answers_test.py HOLDFAST ROOT   holdfast on all structures of benchmarks/

Every structure has an answer and fits the schema, and holdfast's answers are right, with a
twentieth of the tolerances: the figures are known to 1e-6, and limit loads are sought to that.
"""
import json
import pathlib
import subprocess
import sys

MODULES_MAX = 400
BYTES_MAX = 2_000_000


def check_structures(root):
    folder = root / 'benchmarks'
    answers = json.loads((folder / 'answers.json').read_text())['answers']
    files = sorted((folder / 'structures').glob('*.json'))
    assert sorted(one['name'] for one in answers) == [path.stem for path in files]
    assert len(files) >= 200, len(files)
    assert sum(path.stat().st_size for path in files) < BYTES_MAX
    structures = [json.loads(path.read_text()) for path in files]
    for structure in structures:
        count = len(structure['modules']) + len(structure.get('planned', []))
        assert count <= MODULES_MAX, structure['name']
        assert 'known_answer' not in structure, structure['name']
    try:
        import jsonschema
    except ImportError:
        return  # holdfast reads them all below, and refuses what the schema does.
    validator = jsonschema.Draft202012Validator(
        json.loads((root / 'docs/structure.schema.json').read_text()))
    for structure in structures:
        faults = [error.message for error in validator.iter_errors(structure)]
        assert not faults, (structure['name'], faults)


def main():
    holdfast, root = sys.argv[1], pathlib.Path(sys.argv[2])
    check_structures(root)
    folder = root / 'benchmarks'
    rows = subprocess.run([sys.executable, folder / 'answer_with_holdfast.py', holdfast],
                          check=True, capture_output=True, text=True).stdout
    score = subprocess.run([sys.executable, folder / 'score.py', '-', '--tolerance', '0.05'],
                           check=False, input=rows, capture_output=True, text=True)
    print(score.stdout, score.stderr)
    total = score.stdout[score.stdout.index('total'):].split()
    # All right, none undecided where the answer is known, and every figure given.
    if score.returncode != 0 or total[1] != total[2] or total[8] != '0':
        sys.exit('answers_test.py: expected all verdicts right and all figures given')


if __name__ == '__main__':
    main()

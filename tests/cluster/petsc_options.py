#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""PETSc's options: what docs/cluster.md says works, and what is refused.

    petsc_options.py HOLDFAST HOLDFAST_MPI

None may change the verdict or the load ratio, and none may crash.
"""
import json
import os
import subprocess
import sys
import tempfile

import compare

RANKS = 2
# Options, and what PETSc prints for them.
WORKING = [
    ('-ksp_monitor -ksp_monitor_true_residual -ksp_view -log_view',
     ['KSP Residual norm', 'true resid norm', 'type: holdfast', 'holdfast: one K-cycle',
      'holdfast cycle']),
    ('-ksp_monitor_solution -ksp_converged_reason', ['KSP Solution norm', 'converged due to']),
    ('-ksp_type fcg -ksp_view', ['type: fcg', 'holdfast: one K-cycle']),
    ('-pc_type hypre -ksp_view', ['type: fcg', 'BoomerAMG']),
]
REFUSED = [('-pc_type jacobi', 'getdiagonal'), ('-pc_type gamg', 'getinfo'),
           ('-ksp_monitor_solution ascii::ascii_info', 'format')]


def check(program, file, options, report):
    return subprocess.run([program, '--ranks', str(RANKS), 'check', file, '--alone-max', '0',
                           '--json', report, *options.split()],
                          text=True, capture_output=True, timeout=60, env=compare.ENVIRONMENT)


def main():
    holdfast, program = sys.argv[1:3]
    document = compare.generated(holdfast, 'scaffold', 8)
    one = compare.one_machine(holdfast, document, [])
    file = compare.written(document)
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, 'report.json')
        for options, texts in WORKING:
            done = check(program, file, options, report)
            if done.returncode != 0 or not os.path.exists(report):
                faults.append(f'{options}: exit {done.returncode}, {done.stderr}')
                continue
            with open(report, encoding='utf-8') as read:
                faults += compare.compare(one, json.load(read), options)
            os.unlink(report)
            faults += [f'{options}: no {text!r}' for text in texts if text not in done.stdout]
        for options, text in REFUSED:
            done = check(program, file, options, report)
            if done.returncode != 70 or text not in done.stderr or os.path.exists(report):
                faults.append(f'{options}: exit {done.returncode}, {done.stderr}')
    os.unlink(file)
    for fault in faults:
        print(fault)
    print(f"{len(WORKING) + len(REFUSED)} runs with PETSc's options, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())

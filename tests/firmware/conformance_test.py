#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""conformance_test.py HOLDFAST MODULE QEMU_IMAGE   'holdfast conformance' at modules of two kinds.

MODULE is examples/module/on_terminals.c as a process, QEMU_IMAGE the example for a Cortex-M4 (-
leaves it out): all cases pass. On lines that are spoiled the cases that are about it fail.
Bytes that the program expects of the conversation are those of docs/evidence/wire.md.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from joined_terminals import joined

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent))
from schemas_test import Schemas, places_of  # noqa: E402

CONFIGURATION_ADDRESS = 0x080E0000
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMA = 'conformance.schema.json'

faults = []
schemas = Schemas(ROOT / 'docs/schemas')
places = set()


def expect(is_so, what):
    if not is_so:
        faults.append(what)
        print(f'FAULT: {what}', flush=True)


def conformance(holdfast, device, *options):
    done = subprocess.run([holdfast, 'conformance', device, '--json', '-', *options],
                          capture_output=True, text=True, check=False, timeout=600)
    if done.returncode == 65:
        return done.returncode, done.stderr
    report = json.loads(done.stdout)
    found = schemas.check(SCHEMA + '#', report)
    places.update(found.places)
    expect(not found.faults, f'the schema: {found.faults[:3]}')
    expect(done.returncode == (1 if report['failed'] else 0), 'the exit code')
    expect(report['passed'] + report['failed'] + report['absent'] == len(report['cases']), 'a sum')
    return done.returncode, report


def show(report):
    for case in report['cases']:
        if case['outcome'] != 'passed':
            print(json.dumps(case, indent=2), flush=True)


def at_process(holdfast, module, page, *options, spoil=lambda data: data):
    here, there = joined(spoil)
    with subprocess.Popen([module, page, f'0={here}'], stdout=subprocess.DEVNULL) as process:
        try:
            return conformance(holdfast, there, *options)
        finally:
            process.kill()


def at_qemu(holdfast, image, page):
    command = ['qemu-system-arm', '-machine', 'netduinoplus2', '-display', 'none', '-kernel', image,
               '-device', f'loader,file={page},addr={CONFIGURATION_ADDRESS:#x},force-raw=on',
               '-serial', 'pty']
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True) as process:
        try:
            device = re.search(r'/dev/pts/\d+', process.stdout.readline())[0]
            time.sleep(1)
            return conformance(holdfast, device)
        finally:
            process.kill()


def drops_hello(data):
    """A port that does not send single bytes."""
    return b'' if data == b'\x05' else data


def spoils_escapes(data):
    """A port that takes the mark for an escape to be another one."""
    return data.replace(b'\x7d', b'\x7c')


def swaps_sums(data):
    """A port whose frames have the bytes of the sum in the other order."""
    return re.sub(rb'([^\x7d])([^\x7d])\.', rb'\2\1.', data)


def is_worked(line, worked):
    """Whether the page of worked bytes has this line, with epoch 1 where the run had another."""
    words = line.split()
    if words and words[0] in ('01', '02') and len(words) > 3:
        words[1:3] = ['01', '00']
    return ' '.join(words) in worked


def expected_lines():
    """The answers of the conversation, as the source has them."""
    text = (ROOT / 'extras/instrument/src/conformance/round_cases.cpp').read_text()
    table = text[text.index('kTurns[] ='):]
    table = table[:table.index('};')]
    joined_text = re.sub(r'"\s*\n\s*"', '', table)
    return re.findall(r'"([0-9a-f ]+)"', joined_text)


def main():
    holdfast, module, image = sys.argv[1:]
    worked = re.sub(r'\s+', ' ', (ROOT / 'docs/evidence/wire.md').read_text())
    lines = expected_lines()
    expect(len(lines) == 20, f'10 turns of the conversation, found {len(lines)} lines')
    for line in lines:
        expect(is_worked(line, worked), f'a line of the conversation: {line}')
    with tempfile.TemporaryDirectory() as folder:
        page = f'{folder}/page.bin'
        done = subprocess.run([holdfast, 'conformance', '--page', page], check=False)
        expect(done.returncode == 0, 'the page is written')
        code, report = at_process(holdfast, module, page)
        print(f'process: {report["passed"]} passed, {report["failed"]} failed', flush=True)
        show(report)
        expect(code == 0 and report['absent'] == 0 and report['passed'] > 70, 'the process passes')
        names = {case['name'] for case in report['cases']}
        expect(len(names) == len(report['cases']), 'every case has a name of its own')
        for spoil, failing in [(drops_hello, 'says hello bytes'),
                               (spoils_escapes, 'escapes marks both ways'),
                               (swaps_sums, 'greets whoever says hello')]:
            # A number that the module draws may need an escape: then it cannot even greet.
            for _ in range(5):
                code, report = at_process(holdfast, module, page, '--section', 'line', spoil=spoil)
                if code != 65 or spoil != spoils_escapes:
                    break
            if code == 65:
                expect(failing == 'greets whoever says hello', f'{spoil.__name__}: nobody greets')
                continue
            failed = {case['name'] for case in report['cases'] if case['outcome'] == 'failed'}
            print(f'{spoil.__name__}: {len(failed)} failed', flush=True)
            expect(code == 1 and failing in failed, f'{spoil.__name__} is noticed')
        if image != '-':
            code, report = at_qemu(holdfast, image, page)
            print(f'QEMU: {report["passed"]} passed, {report["failed"]} failed', flush=True)
            show(report)
            expect(code == 0 and report['absent'] == 0, 'the Cortex-M4 in QEMU passes')
        done = subprocess.run([holdfast, 'conformance', '/dev/null'], capture_output=True,
                              text=True, check=False)
        expect(done.returncode == 65 and 'no serial device' in done.stderr, 'no device')
        for arguments in ([], ['/dev/null', '--page', page]):
            done = subprocess.run([holdfast, 'conformance', *arguments], capture_output=True,
                                  text=True, check=False)
            expect(done.returncode == 64 and 'either DEVICE or --page' in done.stderr, 'usage')
        silent, device = joined(lambda data: data)
        del silent
        done = subprocess.run([holdfast, 'conformance', device], capture_output=True, text=True,
                              check=False)
        expect(done.returncode == 65 and 'nobody greets' in done.stderr, 'nobody is there')
    for place in places_of(SCHEMA, schemas.file(SCHEMA)):
        expect(place in places, f'occurs in no report: {place}')
    print(f'{len(faults)} faults' if faults else 'modules keep to the wire format')
    sys.exit(1 if faults else 0)


main()

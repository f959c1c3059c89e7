#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""qemu_test.py HOLDFAST IMAGE STRUCTURE...   the firmware with interrupts, one QEMU per module.

Each module is QEMU's machine netduinoplus2 (an STM32F405) in a process of its own; faces are joined
by socket pairs, handed over as character devices. The plan is written to a free face. Every
module's verdict is then read from its memory and must be the exact one of 'holdfast check'.
"""
import json
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time

from joined_terminals import DIRECTIONS

VERDICTS = ['none', 'safe', 'overload', 'unstable', 'undecided']
CONFIGURATION_ADDRESS = 0x080E0000
TIMEOUT_S = 120
STATUS_WORDS = 10


def checksum(data):
    """CRC-16/CCITT from 0xffff."""
    value = 0xffff
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021 if value & 0x8000 else value << 1) & 0xffff
    return value


def plan_frame(cell):
    """A plan as libs/module/include/holdfast/module/frame.hpp describes it."""
    body = struct.pack('<BBH3i', 2, 0, 12, *cell)
    body += struct.pack('<H', checksum(body))
    escaped = b''.join(bytes([0x7d, byte ^ 0x20]) if byte in b'~.}' else bytes([byte])
                       for byte in body)
    return b'~' + escaped + b'.'


class Module:
    """One QEMU, its control channel and where its status lies."""

    def __init__(self, image, page, lines, status_pointer):
        command = ['qemu-system-arm', '-machine', 'netduinoplus2', '-display', 'none',
                   '-qmp', 'stdio', '-kernel', image,
                   '-device', f'loader,file={page},addr={CONFIGURATION_ADDRESS:#x},force-raw=on']
        for face, line in enumerate(lines):
            if line is None:
                command += ['-serial', 'null']
            else:
                command += ['-chardev', f'socket,fd={line.fileno()},id=face{face}',
                            '-serial', f'chardev:face{face}']
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            pass_fds=[line.fileno() for line in lines if line is not None])
        self.status_pointer = status_pointer
        self.process.stdout.readline()
        self.ask('qmp_capabilities')

    def ask(self, command, **arguments):
        self.process.stdin.write(json.dumps({'execute': command, 'arguments': arguments}) + '\n')
        self.process.stdin.flush()
        while True:
            answer = json.loads(self.process.stdout.readline())
            if 'return' in answer or 'error' in answer:
                return answer.get('return')

    def words(self, address, count):
        text = self.ask('human-monitor-command', **{'command-line': f'xp /{count}xw {address:#x}'})
        return [int(word, 16) for line in text.splitlines()
                for word in re.findall(r'0x[0-9a-f]{8}', line.split(':', 1)[1])]

    def status(self):
        """Plans announced, verdict and largest load ratio."""
        address = self.words(self.status_pointer, 1)[0]
        if address == 0:
            return 0, 'none', 0.0
        words = self.words(address, STATUS_WORDS)
        return (words[1], VERDICTS[words[2] & 0xff],
                struct.unpack('<f', struct.pack('<I', words[3]))[0])

    def end(self):
        self.process.kill()
        self.process.wait()


def symbol(image, name):
    text = subprocess.run(['arm-none-eabi-nm', image], capture_output=True, text=True,
                          check=True).stdout
    return int(re.search(rf'^([0-9a-f]+) \w {name}$', text, re.MULTILINE)[1], 16)


def wire(cells):
    """Lines by module and face; one free end is kept for plans."""
    lines = [[None] * 6 for _ in cells]
    outside = None
    for i, cell in enumerate(cells):
        for face, step in enumerate(DIRECTIONS):
            other = tuple(a + b for a, b in zip(cell, step))
            if other in cells:
                k = cells.index(other)
                if lines[i][face] is None:
                    lines[i][face], lines[k][face ^ 1] = socket.socketpair()
            elif outside is None and i == 0:
                outside, lines[i][face] = socket.socketpair()
    return lines, outside


def await_verdicts(modules, plan_count):
    deadline = time.monotonic() + TIMEOUT_S
    while time.monotonic() < deadline:
        time.sleep(0.2)
        statuses = [module.status() for module in modules]
        if statuses[0][0] == plan_count and all(status[1] != 'none' for status in statuses):
            return statuses
    return [module.status() for module in modules]


def run(holdfast, image, path):
    """Faults found, as text."""
    document = json.loads(pathlib.Path(path).read_text())
    cells = [tuple(module['cell'] if isinstance(module, dict) else module)
             for module in document['modules']]
    exact = json.loads(subprocess.run([holdfast, 'check', path, '--json', '-'], capture_output=True,
                                      text=True, check=False).stdout)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([holdfast, 'emulate', path, '--pages', folder], check=True,
                       stdout=subprocess.DEVNULL)
        lines, outside = wire(cells)
        modules = []
        begin = time.monotonic()
        try:
            for i in range(len(cells)):
                modules.append(Module(image, f'{folder}/module_{i}.bin', lines[i],
                                      symbol(image, 'holdfast_status')))
            time.sleep(1)  # A UART that is not enabled yet drops what comes in.
            for cell in document['planned']:
                outside.sendall(plan_frame(cell))
            statuses = await_verdicts(modules, len(document['planned']))
        finally:
            for module in modules:
                module.end()
    faults = [f'module {i}: {status[1]}, exact is {exact["verdict"]}'
              for i, status in enumerate(statuses) if status[1] != exact['verdict']]
    ratio = max(status[2] for status in statuses)
    print(f'{document["name"]}: {len(cells)} modules, {exact["verdict"]} {ratio:.4f}, '
          f'{time.monotonic() - begin:.1f} s', flush=True)
    return faults


def main():
    holdfast, image, *paths = sys.argv[1:]
    faults = [f'{path}: {fault}' for path in paths for fault in run(holdfast, image, path)]
    print('\n'.join(faults) if faults else f'{len(paths)} robots decided like the exact answer')
    sys.exit(1 if faults else 0)


main()

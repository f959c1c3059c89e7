#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What must fail, and how: files that are cut or wrong, ranks that die or have no memory.

    failures.py HOLDFAST HOLDFAST_MPI

Each ends within seconds, says one line that names place or rank, and gives no verdict.
"""
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time

import compare

RANKS = 2
BAD_INPUT = 65
FAILURE = 70
USAGE = 64
# A hang is longer than this; a million modules beside fifteen other programs took a minute.
SECONDS_MAX = 300


def run(program, arguments, limit_bytes=None):
    def limit():
        if limit_bytes:
            resource.setrlimit(resource.RLIMIT_AS, (limit_bytes, limit_bytes))
    return subprocess.run(['mpirun', '-n', str(RANKS), program, *arguments], capture_output=True,
                          timeout=SECONDS_MAX, env=compare.ENVIRONMENT, preexec_fn=limit,
                          text=True)


def lines_of_ours(text):
    return [line for line in text.splitlines() if line.startswith('holdfast-mpi: ')]


class Failures:
    def __init__(self, holdfast, program, folder):
        self.program = program
        self.folder = folder
        self.faults = []
        self.count = 0
        self.text = os.path.join(folder, 'cube.json')
        self.binary = os.path.join(folder, 'cube.holdfast')
        subprocess.run([holdfast, 'generate', 'cube', '20', '-o', self.text], check=True)
        self.expect('convert', run(program, ['convert', self.text, self.binary]), 0, '')

    def expect(self, name, done, code, word):
        self.count += 1
        said = lines_of_ours(done.stderr)
        is_said = len(said) == 1 and word in said[0] if word else not said
        if done.returncode != code or not is_said:
            self.faults.append(f'{name}: exit {done.returncode}, expected {code}; said {said}, '
                               f'expected one line with "{word}"')
        if code and 'SAFE' in done.stdout:
            self.faults.append(f'{name}: a verdict in spite of the failure')

    def check_changed(self, name, change, word):
        with open(self.binary, 'rb') as file:
            data = bytearray(file.read())
        data = change(data)
        path = os.path.join(self.folder, 'changed.holdfast')
        with open(path, 'wb') as file:
            file.write(data)
        self.expect(name, run(self.program, ['check', path]), BAD_INPUT, word)

    def check_files(self):
        self.expect('binary', run(self.program, ['check', self.binary]), 0, '')

        def flipped(place):
            def change(data):
                data[place] ^= 1
                return data
            return change

        def swapped(data):
            data[-32:-16], data[-16:] = data[-16:], data[-32:-16]
            return data

        self.check_changed('cut', lambda data: data[:-20], 'byte')
        self.check_changed('cut in the head', lambda data: data[:50], 'byte 50')
        self.check_changed('longer', lambda data: data + b'0' * 16, 'byte')
        self.check_changed('another version', flipped(8), 'byte 8')
        self.check_changed('head changed', flipped(17), 'byte 64')
        self.check_changed('text changed', flipped(100), 'byte 48')
        self.check_changed('module changed', flipped(-16), 'module')
        self.check_changed('modules swapped', swapped, 'module 7999')
        self.expect('no such file', run(self.program, ['check', self.folder + '/none']), BAD_INPUT,
                    'none')
        with open(os.path.join(self.folder, 'bad.json'), 'w') as file:
            json.dump({'format': 'holdfast-structure', 'version': 1,
                       'modules': [[0, 0, 0], [0, 0, 5]] + [[i, 0, 0] for i in range(1, 9)]}, file)
        self.expect('in pieces', run(self.program, ['check', file.name, '--alone-max', '0']),
                    BAD_INPUT, 'pieces')

    def check_memory(self):
        """A million modules where there is room for them, and where there is not: 400 to 500 MB of
        address space, of which MPI takes 300. A rank says this and no more; the first one, if
        only the other does, may have been ended from outside before."""
        large = os.path.join(self.folder, 'large.json')
        subprocess.run([sys.argv[1], 'generate', 'cube', '100', '-o', large], check=True)
        line = 'holdfast-mpi: rank {}: out of memory; no verdict'
        from_outside = 'holdfast-mpi: ended from outside, as when another rank dies; no verdict'
        allowed = [[line.format(0)], [line.format(1)], [line.format(0), line.format(1)],
                   sorted([line.format(1), from_outside])]
        for limit_mb, code in ((None, 0), (400, FAILURE), (450, FAILURE), (500, FAILURE)):
            done = run(self.program, ['check', large, '--quiet'],
                       limit_bytes=limit_mb and limit_mb << 20)
            self.count += 1
            said = lines_of_ours(done.stderr)
            is_said = sorted(said) in allowed if code else not said
            if done.returncode != code or not is_said or done.stdout:
                self.faults.append(f'{limit_mb} MB: exit {done.returncode}, expected {code}; said '
                                   f'{said}, {done.stdout}')

    def check_launcher(self):
        """--ranks: the code is the answer's, and of a failure only one line is said."""
        def launched(*arguments):
            return subprocess.run([self.program, '--ranks', str(RANKS), *arguments], text=True,
                                  capture_output=True, timeout=60, env=compare.ENVIRONMENT)
        arm = os.path.join(self.folder, 'arm.json')
        subprocess.run([sys.argv[1], 'generate', 'arm', '60', '-o', arm], check=True)
        for name, file, code in (('safe', self.binary, 0), ('unsafe, as it tips over', arm, 1),
                                 ('no file', self.folder + '/none', BAD_INPUT)):
            done = launched('check', file)
            self.count += 1
            if done.returncode != code or len(done.stderr.splitlines()) != (code > 1):
                self.faults.append(f'--ranks, {name}: exit {done.returncode}, {done.stderr}')
        done = launched('check', self.binary, '--ranks', '2')
        self.expect('--ranks twice', done, USAGE, 'once')
        done = subprocess.run([self.program, 'check', self.binary, '--ranks', 'two'], text=True,
                              capture_output=True, timeout=60)
        self.expect('--ranks no number', done, USAGE, 'two')

        tight = {name: value for name, value in compare.ENVIRONMENT.items()
                 if 'subscribe' not in name}
        done = subprocess.run([self.program, 'check', self.binary, '--ranks', '9999'], text=True,
                              capture_output=True, timeout=60, env=tight)
        self.expect('--ranks beyond all cores', done, FAILURE, 'has not enough slots')

    def check_death_launched(self):
        """The same with --ranks: one line, and exit code 70."""
        large = os.path.join(self.folder, 'large.json')
        job = subprocess.Popen([self.program, '--ranks', str(RANKS), 'check', large], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               env=compare.ENVIRONMENT)
        ranks = self.ranks_of(self.ranks_of(job.pid, 1)[0], RANKS)
        time.sleep(0.3)
        os.kill(int(ranks[-1]), signal.SIGKILL)
        out, said = job.communicate(timeout=30)
        self.count += 1
        lines = said.splitlines()
        if job.returncode != FAILURE or out or len(lines) != 1 or 'signal 9' not in lines[0]:
            self.faults.append(f'--ranks, a rank killed: exit {job.returncode}, {out}, {said}')

    @staticmethod
    def ranks_of(pid, count):
        """The ids of a process's children, when it has so many."""
        children = f'/proc/{pid}/task/{pid}/children'
        found = []
        begin = time.monotonic()
        while len(found) < count and time.monotonic() < begin + 20:
            with open(children, encoding='ascii') as file:
                found = file.read().split()
            time.sleep(0.01)
        return found

    def check_death(self):
        """One rank is killed while it waits; all end, without a verdict."""
        large = os.path.join(self.folder, 'large.json')
        job = subprocess.Popen(['mpirun', '-n', str(RANKS), self.program, 'check', large],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env=compare.ENVIRONMENT)
        ranks = self.ranks_of(job.pid, RANKS)
        time.sleep(0.3)
        os.kill(int(ranks[-1]), signal.SIGKILL)
        out, _ = job.communicate(timeout=30)
        self.count += 1
        if job.returncode == 0 or 'SAFE' in out:
            self.faults.append(f'a rank killed: exit {job.returncode}, {out}')


def main():
    with tempfile.TemporaryDirectory() as folder:
        failures = Failures(sys.argv[1], sys.argv[2], folder)
        failures.check_files()
        failures.check_memory()
        failures.check_launcher()
        failures.check_death()
        failures.check_death_launched()
    for fault in failures.faults:
        print(fault)
    print(f'{failures.count} failures tried, {len(failures.faults)} faults')
    return 1 if failures.faults else 0


if __name__ == '__main__':
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What holdfast-mpi writes: structures that all ranks write, pieces for ParaView, checkpoints.

    outputs.py HOLDFAST HOLDFAST_MPI

Files are compared with what one process writes, counts of cells with closed forms, and answers of
runs that go on with those of runs that were never ended.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

import compare

RANKS = 3


class Outputs:
    def __init__(self, holdfast, program, folder):
        self.holdfast = holdfast
        self.program = program
        self.folder = folder
        self.faults = []
        self.count = 0

    def expect(self, name, found, expected):
        self.count += 1
        if found != expected:
            self.faults.append(f'{name}: {found}, expected {expected}')

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *arguments, ranks=RANKS):
        return subprocess.run([self.program, '--ranks', str(ranks), *arguments], text=True,
                              capture_output=True, timeout=60, env=compare.ENVIRONMENT)

    def generate(self, family, size):
        """By one process, and by the ranks; returns the name of the binary file of these."""
        text, one, parts = (self.path(name) for name in ('one.json', 'one.bin', 'parts.bin'))
        subprocess.run([self.holdfast, 'generate', family, str(size), '-o', text], check=True)
        subprocess.run([self.program, 'convert', text, one], check=True, capture_output=True,
                       env=compare.ENVIRONMENT)
        done = self.run('generate', family, str(size), '-o', parts)
        self.expect(f'generate {family}: exit', done.returncode, 0)
        with open(one, 'rb') as a, open(parts, 'rb') as b:
            self.expect(f'generate {family}: the same bytes', a.read() == b.read(), True)
        return parts

    def check_generated(self):
        for family, size in (('arm', 9), ('tower', 17), ('scaffold', 14), ('shell', 11),
                             ('portal', 21), ('bridge', 13), ('cube', 12)):
            file = self.generate(family, size)
        done = self.run('generate', 'growth', '9', '-o', file)
        self.expect('generate growth', (done.returncode, 'convert' in done.stderr), (65, True))
        done = self.run('generate', 'cube', '9', '-o', self.path('none/x.bin'))
        self.expect('generate into no folder', (done.returncode, 'written' in done.stderr),
                    (65, True))
        return file

    def check_words(self):
        """The version, and the lattice of a file that does not say it, as of holdfast."""
        done = self.run('--version')
        said = subprocess.run([self.holdfast, '--version'], text=True, capture_output=True,
                              check=True).stdout
        self.expect('version', (done.returncode, done.stdout),
                    (0, said.replace('holdfast', 'holdfast-mpi')))
        file, one, parts = (self.path(name) for name in ('catoms.xml', 'one.holdfast',
                                                         'parts.holdfast'))
        with open(file, 'w', encoding='ascii') as xml:
            xml.write('<world><blockList><block position="0,0,0" orientation="1"/>'
                      '<block position="0,0,1" orientation="2"/></blockList></world>')
        subprocess.run([self.holdfast, 'convert', '--lattice', 'catoms3D', file, one], check=True,
                       capture_output=True)
        done = self.run('convert', '--lattice', 'catoms3D', file, parts)
        self.expect('convert --lattice: exit', done.returncode, 0)
        with open(one, 'rb') as a, open(parts, 'rb') as b:
            self.expect('convert --lattice: the same bytes', a.read() == b.read(), True)
        self.expect('check --lattice', self.run('check', '--lattice', 'hexagonal', one).returncode,
                    65)
        self.expect('no lattice', self.run('check', '--lattice', 'fcc', file).returncode, 64)

    def check_notes(self):
        """In parts a report has the notes that it has of the whole, as holdfast check."""
        file = self.path('noted.json')
        with open(file, 'w', encoding='ascii') as text:
            text.write('{"format": "holdfast-structure", "version": 1, "oops": 1, '
                       '"modules": [[0,0,0], [1,0,0], [2,0,0]]}')
        said = subprocess.run([self.holdfast, 'check', '--allow-unknown', file],
                              text=True, capture_output=True,
                              check=True).stdout
        notes = [line for line in said.splitlines() if line.startswith('  note ')]
        self.expect('notes of the whole', len(notes), 1)
        done = self.run('check', '--allow-unknown', file, '--alone-max', '0')
        found = [line for line in done.stdout.splitlines() if line.startswith('  note ')]
        self.expect('notes in parts', found, notes)

    def check_picture(self, cube, size):
        """Each module, connection and facet of a cube is a cell of one piece."""
        picture = self.path('cube.pvtu')
        done = self.run('check', cube, '--alone-max', '0', '--vtk', picture)
        self.expect('picture: exit and verdict', (done.returncode, done.stdout[:4]), (0, 'SAFE'))
        with open(picture, encoding='ascii') as file:
            index = file.read()
        pieces = re.findall(r'<Piece Source="([^"]+)"', index)
        self.expect('pieces', pieces, [f'cube_{rank}.vtu' for rank in range(RANKS)])
        arrays = sorted(re.findall(r'<PDataArray type="(\w+)" Name="(\w+)"', index))
        cells = 0
        for piece in pieces:
            with open(self.path(piece), 'rb') as file:
                head = file.read(20000).split(b'<AppendedData')[0].decode('ascii')
            cells += int(re.search(r'NumberOfCells="(\d+)"', head)[1])
            mine = re.findall(r'<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents', head)
            own = {'connectivity', 'offsets', 'types', 'gravity_m_s2'}
            self.expect(f'arrays of {piece}', sorted(a for a in mine if a[1] not in own), arrays)
        self.expect('cells', cells, size ** 3 + 3 * size ** 2 * (size - 1) + size ** 2)

    def report(self, file, *options, ranks=RANKS):
        done = self.run('check', file, '--alone-max', '0', '--json', '-', *options, ranks=ranks)
        return json.loads(done.stdout) if done.stdout else {'verdict': done.stderr}

    def early_checkpoint(self, file, checkpoint):
        """The checkpoint of a run after one of its first steps."""
        job = subprocess.Popen([self.program, '--ranks', str(RANKS), 'check', file, '--alone-max',
                                '0', '--checkpoint', checkpoint], env=compare.ENVIRONMENT,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        copy = checkpoint + '.copy'
        while job.poll() is None and not os.path.exists(copy):
            if os.path.exists(checkpoint):
                shutil.copyfile(checkpoint, copy)
            time.sleep(0.0005)
        job.wait(timeout=60)
        self.expect('a checkpoint is removed in the end', os.path.exists(checkpoint), False)
        return copy

    def check_checkpoint(self):
        """A scaffold on a slope, whose feet lift one after the other."""
        document = compare.generated(self.holdfast, 'scaffold', 17)
        document.update(version=2, gravity_m_s2=[2, 1, -9.5])
        file = compare.written(document)
        whole = self.report(file)
        copy = self.early_checkpoint(file, self.path('run.step'))
        used = self.path('used.step')
        for ranks in (RANKS, 2):
            shutil.copyfile(copy, used)
            again = self.report(file, '--checkpoint', used, ranks=ranks)
            self.expect('gone on: verdict', again['verdict'], whole['verdict'])
            if 'overload' not in again:
                self.faults.append(f'gone on: {again}')
                continue
            ratio, expected = (one['overload']['load_ratio_max'] for one in (again, whole))
            self.expect('gone on: load ratio', abs(ratio - expected) < compare.LOAD_RATIO_ERROR,
                        True)
            self.expect('gone on: fewer steps', again['solver']['iterations'] <
                        whole['solver']['iterations'], True)
        with open(copy, 'rb') as read:
            data = bytearray(read.read())
        data[40] ^= 1
        with open(used, 'wb') as changed:
            changed.write(data)
        self.expect('a damaged checkpoint', 'checksum' in self.report(
            file, '--checkpoint', used)['verdict'], True)
        document['gravity_m_s2'][0] = 2.5
        other = compare.written(document)
        shutil.copyfile(copy, used)
        self.expect("another structure's checkpoint", 'another structure' in self.report(
            other, '--checkpoint', used)['verdict'], True)
        os.unlink(file)
        os.unlink(other)


def main():
    with tempfile.TemporaryDirectory() as folder:
        outputs = Outputs(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), folder)
        outputs.check_words()
        outputs.check_notes()
        cube = outputs.check_generated()
        outputs.check_picture(cube, 12)
        outputs.check_checkpoint()
    for fault in outputs.faults:
        print(fault)
    print(f'{outputs.count} facts of what is written, {len(outputs.faults)} faults')
    return 1 if outputs.faults or outputs.count == 0 else 0


if __name__ == '__main__':
    sys.exit(main())

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Pseudo-terminals between a program and modules, and the faces of a module."""
import os
import threading
import tty

NAMES = ['+x', '-x', '+y', '-y', '+z', '-z']
DIRECTIONS = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def joined(spoil=lambda data: data):
    """Two terminals whose bytes go from one to the other; those of the first are spoiled."""
    ends = [os.openpty() for _ in range(2)]
    for _, terminal in ends:
        tty.setraw(terminal)

    def carry(source, target, change):
        try:
            while True:
                os.write(target, change(os.read(source, 4096)))
        except OSError:
            pass
    for k, change in ((0, spoil), (1, lambda data: data)):
        threading.Thread(target=carry, args=(ends[k][0], ends[1 - k][0], change),
                         daemon=True).start()
    return [os.ttyname(terminal) for _, terminal in ends]

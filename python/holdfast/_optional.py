# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What the package uses if it is there: the Debian package of a module that is not."""
from __future__ import annotations

import importlib

_PACKAGES = {'matplotlib': 'python3-matplotlib', 'PIL': 'python3-pil', 'vtkmodules': 'python3-vtk9',
             'networkx': 'python3-networkx'}


def need(module: str, what: str) -> None:
    """Raises ImportError, which says what to install, if the module is not there."""
    try:
        importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f'{what} needs {module}, which is not installed: on Debian '
                          f'apt install {_PACKAGES[module]}', name=module) from error

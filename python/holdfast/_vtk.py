# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""A report as a grid of VTK."""
from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # type: ignore[import]

if TYPE_CHECKING:
    from ._report import Report


def to_vtk(report: Report) -> Any:
    """What VTK reads of the report's .vtu file: there is one writer of these arrays."""
    with tempfile.TemporaryDirectory(prefix='holdfast-') as folder:
        path = os.path.join(folder, 'report.vtu')
        report.save_vtu(path)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput()

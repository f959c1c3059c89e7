# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests have in common."""
import pathlib

import pytest


@pytest.fixture(scope='session')
def root():
    """The repository."""
    return pathlib.Path(__file__).resolve().parents[2]

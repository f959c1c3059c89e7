# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""How far long work is: a function of the caller's, or a bar of tqdm's."""
from __future__ import annotations

import contextlib
import importlib
import warnings
from collections.abc import Callable, Iterator
from typing import Any, Optional, Union

Progress = Union[None, bool, Callable[..., object]]
"""None: nothing is told; True: a bar, if tqdm is there; or what is called with numbers."""


@contextlib.contextmanager
def told(progress: Progress, what: str,
         is_counted: bool = False) -> Iterator[Optional[Callable[..., object]]]:
    """What is to be called. Counted work says how much is done, of how much."""
    if not isinstance(progress, bool):
        if progress is not None and not callable(progress):
            raise TypeError('progress: expected a function, True or None, found '
                            f'{type(progress).__name__}')
        yield progress
        return
    try:
        tqdm = importlib.import_module('tqdm').tqdm if progress else None
    except ImportError:
        tqdm = None
        warnings.warn('no progress is shown, as tqdm is not installed', stacklevel=4)
    if tqdm is None:
        yield None
        return
    with tqdm(desc=what) as bar:
        def tell(*numbers: Any) -> None:
            if is_counted:
                bar.n, bar.total = numbers
                bar.refresh()
            else:
                bar.n = numbers[0]
                bar.set_postfix_str(', '.join(f'{number:.4g}' for number in numbers[1:]))
        yield tell

# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What a check can say."""
from __future__ import annotations

import enum


class Name(str, enum.Enum):
    """A name out of a few: a string, and printed as one whatever the version of Python."""

    def __str__(self) -> str:
        return str(self.value)

    def __format__(self, format_spec: str) -> str:
        return format(str(self.value), format_spec)


class Verdict(Name):
    """Will the robot hold? Each verdict is also its name, a string.

    >>> Verdict.SAFE == 'safe'
    True
    """

    SAFE = 'safe'
    """Stable, and every connection carries less than its strength."""
    OVERLOAD = 'overload'
    """Stable, but at least one connection carries its strength or more (Eq. 17)."""
    UNSTABLE = 'unstable'
    """Topples, or has nothing to spare against toppling."""
    UNDECIDED = 'undecided'
    """Not certain; the reasons say why."""

    @staticmethod
    def from_code(code: int) -> Verdict:
        """The verdict that arrays and tables have a number for, 0 to 3.

        >>> Verdict.from_code(0)
        <Verdict.SAFE: 'safe'>

        Raises ValueError for any other number.
        """
        if not 0 <= code < len(VERDICTS):
            raise ValueError(f'code: expected 0 to {len(VERDICTS) - 1}, found {code}')
        return VERDICTS[code]


VERDICTS = tuple(Verdict)
"""By the number that the arrays have for them."""


class Stage(Name):
    """The three stages of a step (Sec. II-B)."""

    RELEASE = 'release'
    SHIFT = 'shift'
    CONNECT = 'connect'


class Judged:
    """What has a verdict. It has no truth value, as only one of the four verdicts is good news."""

    __slots__ = ()

    @property
    def verdict(self) -> Verdict:
        raise NotImplementedError

    @property
    def is_safe(self) -> bool:
        """Whether the verdict is SAFE: neither unsafe nor uncertain."""
        return self.verdict is Verdict.SAFE

    def __bool__(self) -> bool:
        raise TypeError(f'a {type(self).__name__} is neither true nor false; '
                        'ask for its is_safe or its verdict')

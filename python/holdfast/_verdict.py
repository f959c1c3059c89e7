# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""What a check can say."""
import enum


class Verdict(enum.Enum):
    """Will the robot hold?

    >>> Verdict.SAFE.value
    'safe'
    """

    SAFE = 'safe'
    """Stable, and every connection carries less than its strength."""
    OVERLOAD = 'overload'
    """Stable, but at least one connection carries its strength or more (Eq. 17)."""
    UNSTABLE = 'unstable'
    """Topples, or has nothing to spare against toppling."""
    UNDECIDED = 'undecided'
    """Not certain; the reasons say why."""


VERDICTS = tuple(Verdict)
"""By the number that the arrays have for them."""

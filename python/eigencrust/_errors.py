# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong, as exceptions that say where, why, and what to do about it."""

from __future__ import annotations

from typing import Any, Optional


class Error(Exception):
    """What every function of eigencrust raises when it cannot do what it promises.

    Attributes
    ----------
    stage: the step, argument or file where it happened
    cause: what is wrong
    remedy: what you can do about it
    status: the exit status of the command for such errors
    """

    status: int = 1

    def __init__(self, stage: str, cause: str, remedy: str) -> None:
        super().__init__(f"{cause} ({stage}); {remedy}")
        self.stage = stage
        self.cause = cause
        self.remedy = remedy

    def __reduce__(self) -> Any:
        return type(self), (self.stage, self.cause, self.remedy)


class UsageError(Error, ValueError):
    """Options or arguments that make no sense."""

    status = 2


class InputError(Error, ValueError):
    """Input that is unreadable or unusable, or output that cannot be written."""

    status = 3


class MemoryLimitError(Error, MemoryError):
    """More memory is forecast than `max_memory` allows."""

    status = 4


class NoSurfaceError(Error):
    """The labels leave no surface, or a scrap of one."""

    status = 5


class GuaranteeError(Error):
    """A promised property of the result does not hold: a fault of the program.

    Attributes
    ----------
    result: the Result that is not what it should be
    """

    status = 6
    result: Optional[Any] = None


class Cancelled(Error):
    """The run was cancelled, through its progress callback or a Cancellation."""

    status = 130


_by_status = {
    kind.status: kind
    for kind in (UsageError, InputError, MemoryLimitError, NoSurfaceError, GuaranteeError, Cancelled)
}


def make_error(status: int, stage: str, cause: str, remedy: str) -> Error:
    """The exception for an error of the library, which calls this."""
    return _by_status.get(status, Error)(stage, cause, remedy)

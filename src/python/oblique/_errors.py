# SPDX-License-Identifier: MIT
"""What goes wrong, with the same fields for all stages: where, what, what was expected, the remedy."""

from __future__ import annotations

import sys
import warnings
from typing import Any, NamedTuple, Optional, Sequence, TypeVar

_E = TypeVar("_E", bound="Error")


class Diagnostic(NamedTuple):
    """One finding about what was given. Every part but `what` may be empty.

    >>> Diagnostic("leg.toml", 3, 1, "there is no point 'X'").message
    "leg.toml:3:1: there is no point 'X'"
    """

    file: str
    line: int
    """Counted from 1; 0: not known."""
    column: int
    what: str
    expected: str = ""
    remedy: str = ""
    text: str = ""

    @property
    def message(self) -> str:
        """All of it in words, as the command line has it."""
        if self.text:
            return self.text
        where = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        message = f"{where}: {self.what}" if where else self.what
        if self.expected:
            message += f"; expected {self.expected}"
        if self.remedy:
            message += f"\n  remedy: {self.remedy}"
        return message

    def __str__(self) -> str:
        return self.message


class Error(Exception):
    """Base of all that Oblique throws. The findings are `diagnostics`; the fields are those of the first of them.

    >>> import oblique as ob
    >>> try:
    ...     ob.Diagram(text='format = "oblique-diagram/1"\\n[blocks]\\nx = { type = "integrater", in = "-x" }\\n').run()
    ... except ob.DiagramError as error:
    ...     print(error.line, error.what)
    ...     print(error.remedy)
    3 block 'x': there is no block type 'integrater'
    did you mean 'integrator'?
    """

    diagnostics: tuple[Diagnostic, ...]
    kind: Optional[str]
    """Which question went wrong, where the stage tells several apart."""
    time: Optional[float]
    """Where a run stopped [s]."""

    def __init__(self, what: str = "", expected: str = "", remedy: str = "", *, file: str = "", line: int = 0,
                 column: int = 0, diagnostics: Sequence[Diagnostic] = (), kind: Optional[str] = None,
                 time: Optional[float] = None) -> None:
        self.diagnostics = tuple(diagnostics) or (Diagnostic(file, line, column, what, expected, remedy),)
        self.kind = kind
        self.time = time
        super().__init__("\n".join(found.message for found in self.diagnostics))

    @classmethod
    def _from_library(cls: type[_E], found: Sequence[tuple[Any, ...]], kind: Optional[str],
                      time: Optional[float]) -> _E:
        return cls(diagnostics=[Diagnostic(*one) for one in found], kind=kind, time=time)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self.diagnostics, self.kind, self.time))

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def file(self) -> str:
        """Where it was found; empty where it came from nowhere in particular."""
        return self.diagnostics[0].file

    @property
    def line(self) -> int:
        """Counted from 1; 0: not known."""
        return self.diagnostics[0].line

    @property
    def column(self) -> int:
        """Counted from 1; 0: not known."""
        return self.diagnostics[0].column

    @property
    def what(self) -> str:
        """What is wrong."""
        return self.diagnostics[0].what

    @property
    def expected(self) -> str:
        """What was expected, or nothing."""
        return self.diagnostics[0].expected

    @property
    def remedy(self) -> str:
        """What would help, or nothing."""
        return self.diagnostics[0].remedy


def _restored(cls: type[_E], diagnostics: tuple[Diagnostic, ...], kind: Optional[str], time: Optional[float]) -> _E:
    return cls(diagnostics=diagnostics, kind=kind, time=time)


class ReadError(Error):
    """A file that cannot be opened, broken TOML, a malformed value."""


class DiagramError(Error):
    """A diagram or block that is wrong, or wiring that is."""


class NetworkError(Error):
    """A diagram whose equations make no network."""


class SolveError(Error):
    """A diagram that is well formed, but whose equations could not be solved; `kind` is one of `singular_loop`,
    `no_rest`, `blow_up`, `step_budget`, `chatter`, `other`, and `time` is where the run stopped [s]."""


class MechanismError(Error):
    """A mechanism; `kind` is one of `file`, `request`, `mobility`, `constraint`, `sketch`, `assembly`."""


class PatchError(Error):
    """A mechanism that cannot be turned into a diagram; `kind` is `obstacle` or `request`."""


class RealiseError(Error):
    """A diagram that cannot be put into a machine's elements."""


class SynthesisError(Error):
    """A fit; `kind` is `request` or `nowhere`."""


class ConsoleError(Error):
    """What a console cannot do: a name that there is not, a time that is over, a console that is closed."""


class PlanError(Error):
    """A plan of an ensemble that is wrong, a chunk that does not belong to it, or what cannot be had of them."""


class RequestError(Error, ValueError):
    """An argument from Python that makes no sense: NaN, a wrong shape, a wrong type, options that contradict each other."""


class RunWarning(UserWarning):
    """What a run, a console, a motion or a comparison has not seen, or has done in another way than asked. It is raised
    as a warning of Python, so that it is seen, and kept in the result."""


def warn(message: str) -> None:
    """Warns of it in the line outside of this package that has led to it."""
    depth = 2
    frame = sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).split(".")[0] == "oblique":
        frame = frame.f_back
        depth += 1
    warnings.warn(message, RunWarning, stacklevel=depth)


class UnknownNameError(RequestError, KeyError):
    """A name that there is not, of a column, a block, a machine; with the nearest that there is."""

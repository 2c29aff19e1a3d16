# SPDX-License-Identifier: MIT
"""What came out of a run."""

from __future__ import annotations

import html
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional

from . import _arguments, _oblique
from ._arguments import PathLike
from ._errors import Diagnostic
from ._tables import Table
from .pictures import Picture


class Event(NamedTuple):
    """Something that happened between two smooth pieces of a run."""

    time: float
    """[s]"""
    what: str


class Overload(NamedTuple):
    """A signal that left ±1 machine unit."""

    signal: str
    first: float
    """When it left the range for the first time [s]."""
    duration: float
    """Outside the range, all times together [s]."""
    peak: float
    """The largest value, with its sign [machine unit]."""
    peak_time: float
    suggested_scale: float
    """The factor that brings it back into the range."""


class Expected(NamedTuple):
    """A line of `[expect]`, held against what came out."""

    text: str
    actual: float
    value: float
    within: float
    met: bool


class OutputError(NamedTuple):
    """How far an output may be from the solution of its equations, in its unit."""

    name: str
    size: float
    """The largest magnitude at the rows."""
    largest: float
    """Error over all rows."""
    digits: int
    """Decimal digits of `size` that stand."""
    at_end: float
    """Error over the last twentieth of the rows."""
    digits_at_end: int
    lost: Optional[float]
    """The first time [s] from which no digit stands, if there is one."""


class Trust(NamedTuple):
    """The error of the solver, estimated by finer runs."""

    outputs: tuple[OutputError, ...]
    event_shift: float
    """By which the times of events differ at most [s]."""
    events_part: Optional[float]
    """From where on the runs do not have the same events [s]."""
    failure: str
    """Why a check did not come to its end, or nothing."""
    text: str


class State:
    """All that a run or a console needs to be gone on with: the text of a state file (oblique-state/1)."""

    def __init__(self, text: str) -> None:
        self.text = _arguments.text("text", text)

    @staticmethod
    def load(path: PathLike) -> "State":
        """Reads what `save`, or `oblique run --save`, has written. Throws ReadError."""
        return State(_arguments.read(_arguments.path("path", path)))

    def save(self, path: PathLike) -> None:
        """Writes a state file, which `oblique run --from` reads too."""
        _oblique.write_file(_arguments.path("path", path), self.text)

    def __repr__(self) -> str:
        return f"<State: {len(self.text)} characters>"


class Run(Table):
    """A run: its outputs over time, one row a sample, and what it tells of itself.

    >>> import oblique as ob
    >>> d = ob.Diagram(until=1)
    >>> x = d.integrator(initial=1, name="x")
    >>> x.input = -x
    >>> run = d.run()
    >>> run["x"].shape, run.units["x"]
    ((1001,), 'machine unit')
    >>> print(f"{run['x'][-1]:.6f}")
    0.367879
    """

    def __init__(self, raw: "_oblique.Run") -> None:
        super().__init__(raw.columns, raw.rows)
        self._raw = raw

    @property
    def title(self) -> str:
        """Of the diagram."""
        return self._raw.title

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened, the first thousand; `event_count` is how many there were."""
        return tuple(Event(*event) for event in self._raw.events)

    @property
    def event_count(self) -> int:
        """How many events there were."""
        return self._raw.event_count

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What the run may not have seen, or did in another way than asked. Look at them."""
        return tuple(Diagnostic(*warning) for warning in self._raw.warnings)

    @property
    def overloads(self) -> tuple[Overload, ...]:
        """Signals beyond ±1 machine unit, where they were watched: on a machine, or with `watch_overloads`."""
        return tuple(Overload(*overload) for overload in self._raw.overloads)

    @property
    def halted(self) -> bool:
        """Whether it ended at the first overload (`halt_on_overload`)."""
        return self._raw.halted

    @property
    def statistics(self) -> dict[str, Any]:
        """What it cost: steps, evaluations, …, `method` with its `reason`, and the `seconds` it took."""
        return self._raw.statistics

    @property
    def state(self) -> State:
        """The state at the end, with which another run or a console can go on."""
        return State(self._raw.state)

    @property
    def trust(self) -> Optional[Trust]:
        """How many digits stand, where asked for (`trust=True`)."""
        raw = self._raw.trust
        if raw is None:
            return None
        outputs, shift, part, failure, text = raw
        return Trust(tuple(OutputError(*output) for output in outputs), shift, part, failure, text)

    @property
    def expectations(self) -> tuple[Expected, ...]:
        """The lines of `[expect]`, where asked for (`check=True`)."""
        return tuple(Expected(*one) for one in self._raw.expectations)

    def draw(self, *names: str, against: str = "t", theme: str = "auto") -> Picture:
        """The curves as `oblique run --plot` draws them, without Matplotlib."""
        against = "" if against == "t" else _arguments.text("against", against)
        for name in names:
            self[name]
        return Picture(self._raw.chart(list(names), against, _arguments.text("theme", theme)))

    def _repr_html_(self) -> str:
        notes: Sequence[str] = [f"warning: {warning.message}" for warning in self.warnings] + [
            f"overload: {o.signal} reaches {o.peak:.6g} at t = {o.peak_time:.6g} s" for o in self.overloads]
        listed = "".join(f"<li>{html.escape(note)}</li>" for note in notes)
        return self._table_html(self.title) + (f"<ul>{listed}</ul>" if listed else "")

    def __str__(self) -> str:
        return self._raw.table(8) + self._raw.solver_text()

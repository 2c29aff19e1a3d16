# SPDX-License-Identifier: MIT
"""A machine that is held."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from types import TracebackType
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _oblique
from ._arguments import PathLike, Quantity
from ._errors import ConsoleError, Diagnostic, RequestError, warn
from ._tables import Table
from .diagram import Diagram
from .run import Event, State


class Reading(NamedTuple):
    """What the voltmeter shows."""

    value: float
    unit: str


class Trace(Table):
    """What a probe has recorded from one trigger on: a table with `t` [s] first."""

    def __init__(self, begin: float, columns: Sequence[tuple[str, str]], rows: npt.NDArray[np.float64]) -> None:
        super().__init__(columns, rows)
        self.begin = begin
        """When it was triggered [s]."""


class Probe:
    """A probe of a console: its oscilloscope. Made by `console.probe`."""

    def __init__(self, console: "Console", number: int, columns: Sequence[tuple[str, str]]) -> None:
        self._console = console
        self._number = number
        self._columns = columns

    @property
    def traces(self) -> tuple[Trace, ...]:
        """What was recorded so far, one trace a trigger; without a trigger a single one."""
        return tuple(Trace(begin, self._columns, rows)
                     for begin, rows in self._console._held().traces(self._number))

    def remove(self) -> None:
        """Takes it away."""
        self._console._held().remove_probe(self._number)


class Console:
    """A diagram as a machine that one holds: it runs as far as it is asked to, is read as with a voltmeter, and its
    pots are turned while it runs.

    Between two turns its steps are those of a run, wherever and however often it is read. Several threads may use one
    console; each waits for the other. It ends with `close`, or with its `with` statement.

    >>> import oblique as ob
    >>> d = ob.Diagram()
    >>> x = d.integrator(initial=1, name="x")
    >>> x.input = -x
    >>> with ob.Console(d) as machine:
    ...     machine.advance(1)
    ...     machine["x.rate"] = 3          # turns a pot
    ...     machine.advance(2)
    ...     print(f"{machine['x']:.6f}")   # exp(-4)
    0.018316
    """

    def __init__(self, diagram: Union[Diagram, PathLike]) -> None:
        """Begins at t = 0 as a run does: settled, and computing unless its timeline says otherwise. Throws
        DiagramError, NetworkError and SolveError."""
        self._diagram = diagram if isinstance(diagram, Diagram) else Diagram(diagram)
        self._changes = self._diagram._changes
        self._told: set[str] = set()
        self._raw: Optional[_oblique.Console] = _oblique.Console(self._diagram._model)

    def _held(self) -> "_oblique.Console":
        if self._raw is None:
            raise ConsoleError("the console is closed", remedy="make another: oblique.Console(diagram)")
        if self._changes != self._diagram._changes:
            raise ConsoleError("the diagram was changed since the console was made of it",
                               remedy="make a new console; a pot is turned by console.turn(…)")
        return self._raw

    def close(self) -> None:
        """Ends it; what was read stays."""
        self._raw = None

    def __enter__(self) -> "Console":
        self._held()
        return self

    def __exit__(self, kind: Optional[type[BaseException]], thrown: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    @property
    def diagram(self) -> Diagram:
        """Of which it is made."""
        return self._diagram

    @property
    def time(self) -> float:
        """Where it stands [s]."""
        return self._held().time

    def advance(self, until: Quantity) -> None:
        """Runs until that time [s]. Ctrl-C stops it on its way, where it then stands. Throws ConsoleError for a time
        that is over, and SolveError; it then stands where the machine failed."""
        time = _arguments.quantity("until", until, "s")
        if not math.isfinite(time):
            raise RequestError(f"until={_arguments.shown(until)}", "a finite time [s]")
        self._held().advance(time)
        self._tell()

    def _tell(self) -> None:
        """Warns of what it has not warned of yet."""
        for warning in self.warnings:
            if warning.message not in self._told:
                self._told.add(warning.message)
                warn(warning.message)

    def read(self, name: str) -> Reading:
        """An output of the diagram in its unit, a signal in machine units, or a pot in the unit of the parameter.
        Throws ConsoleError for a name that there is not."""
        return Reading(*self._held().read(_arguments.text("name", name)))

    def __getitem__(self, name: str) -> float:
        """The number that `read` gives."""
        return self.read(name).value

    def turn(self, pot: str, value: Quantity) -> bool:
        """Turns a pot ("c.gain") or the weight of a wire ("c.in[2]") to a number in the unit of the parameter, or to a
        quantity ("20 ms"). The machine goes on as it stands when it next runs or is read. True: the equations stay, with
        another number; False: they are others (an infinite gain, a factor that becomes 0 or 1), and were compiled anew.
        Throws DiagramError, and is then as it was."""
        return self._held().turn(_arguments.text("pot", pot), _arguments.setting(f"the value of {pot}", value))

    def __setitem__(self, pot: str, value: Quantity) -> None:
        """The same as `turn`."""
        self.turn(pot, value)

    def initial(self) -> None:
        """Puts all integrators into initial condition. Throws ConsoleError where the diagram has a timeline."""
        self._held().set_mode("initial")

    def operate(self) -> None:
        """Lets all integrators compute."""
        self._held().set_mode("operate")

    def hold(self) -> None:
        """Lets all integrators keep their values."""
        self._held().set_mode("hold")

    def set_mode(self, mode: str) -> None:
        """"potset", "initial", "operate" or "hold"."""
        self._held().set_mode(_arguments.text("mode", mode))

    def repeat(self, initial: Quantity, operate: Quantity) -> None:
        """Repetitive operation from now on: so long in initial condition [s], then so long in operation, and again, until
        a mode is set."""
        self._held().repeat(_arguments.positive("initial", initial, "s"), _arguments.positive("operate", operate, "s"))

    def scope(self, names: Union[str, Sequence[str]], until: Quantity, samples: int = 241) -> Table:
        """Runs until that time [s] and records outputs, signals or pots at equal distances of time, both ends
        included: a table with `t` [s] first."""
        probes = _arguments.names("names", names)
        if not probes:
            raise RequestError("names=[] names nothing to record", "an output, a signal or a pot")
        time = _arguments.quantity("until", until, "s")
        rows = _arguments.count("samples", samples, 2)
        held = self._held()
        units = [self.read(name).unit for name in probes]
        if not (math.isfinite(time) and time > held.time):
            raise ConsoleError(f"the scope cannot run until {time} s", f"a time after {held.time} s, where it stands")
        times = np.linspace(held.time, time, rows)
        values = held.scope(probes, times.tolist())
        self._tell()
        return Table([("t", "s"), *zip(probes, units)], np.column_stack([times, values]))

    def probe(self, names: Union[str, Sequence[str]], *, interval: Quantity = 0, trigger: Optional[str] = None,
              level: float = 0, slope: str = "rising", hold_off: Quantity = 0, length: Quantity = math.inf,
              single: bool = False) -> Probe:
        """Records outputs and signals from now on, at every step, or `interval` [s] apart.

        With a `trigger`, an output or a signal, it begins a trace of `length` [s] wherever that one passes `level` on its
        `slope` ("rising", "falling" or "either"), but not within `hold_off` [s] of the last; `single`: only once. Throws
        ConsoleError for a name that there is not.

        >>> import oblique as ob
        >>> d = ob.Diagram()
        >>> x, v = d.integrator(name="x"), d.integrator(initial=1, name="v")
        >>> x.input, v.input = v, -x
        >>> machine = ob.Console(d)
        >>> scope = machine.probe("x", interval=0.1, trigger="x", length=1)
        >>> machine.advance(20)
        >>> [f"{trace.begin:.6f}" for trace in scope.traces]   # a turn apart
        ['0.000000', '6.283185', '12.566371', '18.849556']
        """
        probes = _arguments.names("names", names)
        options = {"interval": _arguments.quantity("interval", interval, "s"),
                   "length": _arguments.quantity("length", length, "s"),
                   "most_traces": 1 if single else None,
                   "trigger": None if trigger is None else _arguments.text("trigger", trigger),
                   "level": _arguments.quantity("level", level, "1"),
                   "slope": _arguments.choice("slope", slope, ("rising", "falling", "either")),
                   "hold_off": _arguments.quantity("hold_off", hold_off, "s")}
        held = self._held()
        number = held.set_probe(probes, options)
        return Probe(self, number, [("t", "s"), *((name, self.read(name).unit) for name in probes)])

    def save(self) -> State:
        """The state where it stands, with which a run or any console of the same diagram can go on."""
        return State(self._held().save())

    def restore(self, state: State) -> None:
        """Goes on from such a state; pots stay as they are turned. Throws ReadError where it is another diagram's."""
        if not isinstance(state, State):
            raise RequestError(f"state={_arguments.shown(state)} is no state", "a State, as save() gives it")
        self._held().restore(state.text)

    @property
    def outputs(self) -> tuple[str, ...]:
        """The names of all outputs."""
        return tuple(self._held().outputs())

    @property
    def signals(self) -> tuple[str, ...]:
        """The names of all signals."""
        return tuple(self._held().signals())

    @property
    def pots(self) -> tuple[str, ...]:
        """The names of all pots."""
        return tuple(self._held().pots())

    @property
    def overloads(self) -> dict[str, float]:
        """The lamps: signals beyond ±1 machine unit at this moment, with their values [machine unit]."""
        return dict(self._held().overloads())

    @property
    def events(self) -> tuple[Event, ...]:
        """What has happened so far."""
        return tuple(Event(*event) for event in self._held().events())

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What could not be seen so far."""
        return tuple(Diagnostic(*one) for one in self._held().warnings())

    def __repr__(self) -> str:
        if self._raw is None:
            return "<Console: closed>"
        return f"<Console of {self._diagram.title!r} at t = {self._raw.time:.6g} s>"

# SPDX-License-Identifier: MIT
"""Diagrams: read, built, run, checked, drawn."""

from __future__ import annotations

import html
import json
import tomllib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _oblique, _toml
from ._arguments import PathLike, Quantity
from ._errors import DiagramError, Diagnostic, RequestError, warn
from ._blocks import BlockLibrary, blocks as shipped_blocks
from .pictures import Picture
from .run import Run, State
from .signals import Signal, Sum, Wire, UnknownBlockError, wire_text, wired_terms

_METHODS = ("auto", "bdf", "adams", "rodas")
_RUN_KEYS = ("until", "tolerance", "absolute_tolerance", "max_step", "method", "samples", "max_steps", "settle")


class DiagramCheck:
    """What a check finds: `data` (docs/check.md has its keys), `text`, and the picture of the eigenvalues, `poles`."""

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.text: str = found["text"]
        self.data: dict[str, Any] = json.loads(found["json"])
        self.poles = Picture(found["poles"])
        self.failure: tuple[Diagnostic, ...] = tuple(Diagnostic(*one) for one in found["failure"])
        """Why the trial run came to no end, or nothing."""

    @property
    def verdict(self) -> str:
        """Of its stability: "stable", "grows", "undamped" …"""
        return str(self.data["stability"]["verdict"])

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<DiagramCheck: {self.verdict}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class Diagram:
    """A block diagram: from a file, from a text, or built block by block.

    ``Diagram("leg.toml")`` and ``Diagram(pathlib.Path("leg.toml"))`` read a file; ``Diagram(text="…")``, or a text of
    several lines, is the content of one. ``Diagram(title="…", until=10)`` is empty: each block type is a method of it
    (`-` is written `_`), which adds a block and gives its output as a `Signal`. Signals are added, weighted and
    multiplied like numbers; functions of NumPy make the blocks of these functions.

    >>> import numpy as np
    >>> import oblique as ob
    >>> d = ob.Diagram(title="Pendulum", until=10)
    >>> angle = d.integrator(name="angle", initial=0.5)
    >>> speed = d.integrator(name="speed")
    >>> angle.input = speed
    >>> speed.input = -np.sin(angle) - 0.1 * speed
    >>> print(d.toml())
    format = "oblique-diagram/1"
    title = "Pendulum"
    ...
    >>> run = d.run()
    >>> print(f"{run['angle'].min():.4f}")
    -0.4255
    """

    def __init__(self, source: Optional[PathLike] = None, *, text: Optional[str] = None, file: Optional[str] = None,
                 title: Optional[str] = None, blocks: Optional[Union[BlockLibrary, PathLike]] = None,
                 machine: Optional[str] = None, inverting: Optional[bool] = None, until: Optional[Quantity] = None,
                 tolerance: Optional[float] = None, method: Optional[str] = None,
                 samples: Optional[int] = None) -> None:
        """`blocks` is a library with blocks of one's own, or their folder. `title`, `machine`, `inverting`, `until`
        [s], `tolerance`, `method` and `samples` are those of an empty diagram. Throws ReadError and DiagramError."""
        if blocks is None:
            blocks = shipped_blocks
        self._blocks = blocks if isinstance(blocks, BlockLibrary) else BlockLibrary(blocks)
        self._changes = 0
        self._made: Optional[tuple[int, _oblique.Diagram]] = None
        self._data: Optional[dict[str, Any]] = None
        self._signals: dict[str, Signal] = {}
        if source is not None and text is None and isinstance(source, str) and "\n" in source:
            source, text = None, source
        if source is not None and text is not None:
            raise RequestError("a diagram cannot be both from a file and a text", "one of the two")
        new = {"title": title, "machine": machine, "inverting": inverting, "until": until, "tolerance": tolerance,
               "method": method, "samples": samples}
        if source is not None or text is not None:
            given = [name for name, value in new.items() if value is not None]
            if given:
                raise RequestError(f"{given[0]}= is for a diagram that is built, and this one is read",
                                   remedy="give it to run(), or change the file" if given[0] in _RUN_KEYS else "")
            if source is not None:
                self._file = _arguments.path("source", source)
                self._text = _arguments.read(self._file)
            else:
                self._file = file or "text"
                self._text = _arguments.text("text", text)
            self._model
            return
        self._file = file or "diagram built in Python"
        self._text = ""
        self._data = {"format": "oblique-diagram/1", "title": title or "Built in Python"}
        on: dict[str, Any] = {}
        if machine is not None:
            on["profile"] = _arguments.text("machine", machine)
        if inverting is not None:
            on["inverting"] = bool(inverting)
        if on:
            self._data["machine"] = on
        how: dict[str, Any] = {}
        if until is not None:
            _arguments.positive("until", until, "s")
            how["until"] = _toml.plain("until", until)
        if tolerance is not None:
            how["tolerance"] = _arguments.positive("tolerance", tolerance, "1")
        if method is not None:
            how["method"] = _arguments.choice("method", method, _METHODS)
        if samples is not None:
            how["samples"] = _arguments.count("samples", samples, 2)
        if how:
            self._data["run"] = how
        self._data["blocks"] = {}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": None, "_signals": {}}

    # --- the text and what is made of it

    @property
    def _model(self) -> "_oblique.Diagram":
        if self._made is None or self._made[0] != self._changes:
            self._made = (self._changes, _oblique.Diagram(self.text, self._file, self._blocks._raw))
        return self._made[1]

    @property
    def text(self) -> str:
        """The text of its file: as it was read, or as it was built. Lines in messages are those of it."""
        return self._text if self._data is None else _toml.document(self._data)

    def toml(self) -> str:
        """The same diagram in the tidy form in which Oblique writes one. Throws DiagramError."""
        return self._model.toml()

    def save(self, path: PathLike) -> None:
        """Writes the diagram as a file: as it was read, or in the form of `toml`."""
        _oblique.write_file(_arguments.path("path", path), self._text if self._data is None else self.toml())

    @property
    def file(self) -> str:
        """The name that messages give."""
        return self._file

    @property
    def title(self) -> str:
        """As its file has it."""
        return self._model.title

    @property
    def machine(self) -> str:
        """The profile of the machine that it is for; "ideal" where there is none."""
        return self._model.machine

    @property
    def until(self) -> float:
        """The end of its run [s]."""
        return self._model.until

    @property
    def block_types(self) -> dict[str, str]:
        """The type of each block, by its name."""
        return dict(self._model.blocks)

    @property
    def columns(self) -> dict[str, str]:
        """The unit of each column of a run, by its name. Throws DiagramError."""
        return dict(self._model.columns())

    # --- building

    def _change(self) -> dict[str, Any]:
        """The parts of the file, to be changed."""
        if self._data is None:
            self._data = tomllib.loads(self._text)
        self._changes += 1
        return self._data

    def block(self, type: str, *inputs: Wire, name: Optional[str] = None, label: Optional[str] = None,
              **settings: Any) -> Signal:
        """Adds a block and gives its output.

        `inputs` are signals, sums of them, or texts as in a file ("-2*x"): those of a summing input are added, those
        of other blocks go to its inputs one by one. `settings` are inputs and parameters by their names, numbers in
        the unit of the parameter or texts with a unit ("10 Hz"); `in_` stands for `in`. Throws RequestError.
        """
        definition = self._blocks[type]
        ports = [port.name for port in definition.inputs]
        parameters = [parameter.name for parameter in definition.parameters]
        values: dict[str, Any] = {}
        for key, value in settings.items():
            setting = key[:-1] if key.endswith("_") else key
            if setting not in ports and setting not in parameters:
                raise _arguments.unknown("input or parameter", setting, ports + parameters, type)
            values[setting] = value
        if inputs:
            summing = [port.name for port in definition.inputs if port.sum]
            if summing:
                if summing[0] in values:
                    raise RequestError(f"the input '{summing[0]}' of '{type}' is given twice", "once")
                values[summing[0]] = list(inputs)
            elif len(inputs) > len(ports):
                raise RequestError(f"{len(inputs)} signals for '{type}'", f"at most {len(ports)}: {', '.join(ports)}")
            else:
                for port, signal in zip(ports, inputs):
                    if port in values:
                        raise RequestError(f"the input '{port}' of '{type}' is given twice", "once")
                    values[port] = signal
        entry: dict[str, Any] = {"type": type}
        if label is not None:
            entry["label"] = _arguments.text("label", label)
        for setting, value in values.items():
            if setting in ports:
                entry[setting] = self._wire(type, setting, value)
            else:
                entry[setting] = _toml.plain(f"{setting} of '{type}'", value)
        known = self._blocks_of_file()
        if name is None:
            stem = type.replace("-", "_")
            name = next(candidate for number in range(1, len(known) + 2)
                        if (candidate := f"{stem}_{number}") not in known)
        elif not isinstance(name, str) or not name.isidentifier() or not name.isascii():
            raise RequestError(f"name={_arguments.shown(name)} is no name of a block", "letters, digits and '_'")
        elif name in known:
            raise RequestError(f"there is a block '{name}' already", "another name")
        self._change().setdefault("blocks", {})[name] = entry
        return self.signal(name)

    def _blocks_of_file(self) -> Mapping[str, Any]:
        if self._data is not None:
            found: Mapping[str, Any] = self._data.get("blocks", {})
            return found
        return self.block_types

    def _type_of(self, name: str) -> str:
        entry = self._blocks_of_file()[name]
        return str(entry["type"]) if isinstance(entry, Mapping) else str(entry)

    def signal(self, name: str) -> Signal:
        """The output of a block that is there, by the block's name. Throws UnknownNameError."""
        known = self._blocks_of_file()
        if name not in known:
            raise _arguments.unknown("block", name, list(known))
        if name not in self._signals:
            self._signals[name] = Signal(self, name)
        return self._signals[name]

    def _wire(self, type: str, port: str, value: Any) -> Any:
        definition = self._blocks[type]
        sums = next(one.sum for one in definition.inputs if one.name == port)
        what = f"the input '{port}' of '{type}'"
        if isinstance(value, str):
            return [value] if sums else value
        if not sums:
            return wire_text(self._as_one(what, value))
        several: Sequence[Any] = list(value) if isinstance(value, (list, tuple)) else [value]
        return [text for one in several
                for text in ([one] if isinstance(one, str) else wired_terms(self, what, one))]

    def _as_one(self, what: str, value: Any) -> Sum:
        """A sum of one signal: of several a summer makes one."""
        total = Sum.of(self, what, value).with_constant()
        if len(total.terms) == 1:
            return total
        if not total.terms:
            return Sum(self, {self._reference().name: 0.0}, 0.0)
        sign = -1.0 if self._inverts() else 1.0
        return Sum.of(self, what, self.block("summer", sign * total))

    def _inverts(self) -> bool:
        on = (self._data or tomllib.loads(self._text)).get("machine", {})
        if "inverting" in on:
            return bool(on["inverting"])
        profile = on.get("profile", "ideal")
        from ._machines import machines
        return profile != "ideal" and bool(machines[profile].data.get("inverting", True))

    def _reference(self) -> Signal:
        """The signal of 1 machine unit."""
        known = self._blocks_of_file()
        name = "one"
        while name in known:
            entry = known[name]
            if isinstance(entry, Mapping) and entry.get("type") == "constant" and entry.get("value") == 1:
                return self.signal(name)
            name = "unit_" + name
        return self.block("constant", name=name, value=1)

    def connect(self, source: Wire, target: Signal, weight: float = 1.0, port: Optional[str] = None) -> None:
        """Adds a weighted signal to an input of the block of `target`; without `port` to its first."""
        if not isinstance(target, Signal) or target.diagram is not self:
            raise RequestError(f"target={_arguments.shown(target)} is no block of this diagram", "the signal of a block")
        weight = _arguments.quantity("weight", weight, "1")
        type = self._type_of(target.block)
        ports = self._blocks[type].inputs
        place = next((one for one in ports if one.name == port), None) if port else (ports[0] if ports else None)
        if place is None:
            raise _arguments.unknown("input", port or "in", [one.name for one in ports], type)
        if isinstance(source, str):
            source = self.signal(source) if source in self._blocks_of_file() else Sum.of_text(self, source)
        new = self._wire(type, place.name, weight * source if weight != 1 else source)
        data = self._change()
        entry = data["blocks"][target.block]
        if place.sum:
            old = entry.get(place.name, [])
            entry[place.name] = ([old] if isinstance(old, str) else list(old)) + new
        elif place.name in entry:
            raise RequestError(f"the input '{place.name}' of '{target.block}' takes one signal and has one",
                               f"a free input, or {target.block}.input = …")
        else:
            entry[place.name] = new

    def set_input(self, target: Signal, value: Union[Wire, Sequence[Wire]], port: Optional[str] = None) -> None:
        """Wires an input of the block of `target` anew; without `port` its first. `target.input = value` does this."""
        type = self._type_of(target.block)
        ports = [one.name for one in self._blocks[type].inputs]
        if not ports or (port is not None and port not in ports):
            raise _arguments.unknown("input", port or "in", ports, type)
        place = port or ports[0]
        wired = self._wire(type, place, value)
        self._change()["blocks"][target.block][place] = wired

    def output(self, name: str, signal: Union[Wire, None] = None, *, scale: float = 1.0, unit: Optional[str] = None,
               offset: float = 0.0) -> None:
        """Makes a signal (the block of that name, where none is given) a column of the run: scale · signal + offset,
        in `unit`. Without any output all blocks are columns."""
        outputs = self._data.get("outputs", {}) if self._data is not None else tomllib.loads(self._text).get("outputs", {})
        if _arguments.text("name", name) in outputs:
            raise RequestError(f"there is an output '{name}' already", "another name")
        if signal is None:
            signal = self.signal(name)
        if isinstance(signal, str):
            shown, weight = signal, 1.0
        else:
            one = self._as_one(f"the output '{name}'", signal)
            (shown, weight), = one.terms.items()
        entry: dict[str, Any] = {"signal": shown,
                                 "scale": weight * _arguments.quantity("scale", scale, "of the output")}
        if unit is not None:
            entry["unit"] = _arguments.text("unit", unit)
        if offset:
            entry["offset"] = _arguments.quantity("offset", offset, "of the output")
        self._change().setdefault("outputs", {})[name] = entry

    def expect(self, what: str, value: float, within: float) -> None:
        """Adds a line of `[expect]`: "x at 1", "x maximum", "x minimum"; `run(check=True)` holds the run against it."""
        self._change().setdefault("expect", {})[_arguments.text("what", what)] = {
            "value": _arguments.quantity("value", value, "of the output"),
            "within": _arguments.quantity("within", within, "of the output")}

    def __getattr__(self, name: str) -> Callable[..., Signal]:
        """The block types are methods: `d.servo_amplifier(…)`."""
        if name.startswith("_"):
            raise AttributeError(name)
        type = name.replace("_", "-")
        if type not in self._blocks:
            known = [one.replace("-", "_") for one in self._blocks]
            members = [one for one in dir(Diagram) if not one.startswith("_")]
            remedy = _oblique.suggest(name, members) if _oblique.suggest(name, members).startswith("did") else ""
            raise UnknownBlockError(f"a diagram has no method and no block type '{name}'",
                                    remedy=remedy or _oblique.suggest(name, known))

        def add(*inputs: Wire, **settings: Any) -> Signal:
            return self.block(type, *inputs, **settings)

        add.__name__ = name
        add.__doc__ = self._blocks[type].text
        return add

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name.replace("-", "_") for name in self._blocks)]

    # --- running

    def run(self, until: Optional[Quantity] = None, *, gain: Optional[float] = None,
            set: Optional[Mapping[str, Quantity]] = None, tolerance: Optional[float] = None,
            absolute_tolerance: Optional[float] = None, max_step: Optional[Quantity] = None,
            method: Optional[str] = None, samples: Optional[int] = None, max_steps: Optional[int] = None,
            settle: Optional[bool] = None, state: Optional[State] = None, check: bool = False, trust: bool = False,
            sensitivity: Union[str, Sequence[str]] = (),
            watch_overloads: Optional[bool] = None, halt_on_overload: bool = False) -> Run:
        """Runs the diagram from t = 0, or from `state`, to `until` [s]; what is not given is as its `[run]` says.

        `set` turns pots and weights for this run: ``{"c.gain": 1e4, "b.in[2]": -0.5, "lag.time_constant": "20 ms"}``;
        `gain` is that of every servo amplifier. `method` is "auto", "bdf", "adams" or "rodas"; `samples` is the number of rows.
        `check` holds it against `[expect]`, `trust` estimates the error of each output. `sensitivity` names parameters
        ("c.gain", "x.in[1]"); the derivative of the output x by one is the column "d(x)/d(c.gain)".

        What the run warns of is a RunWarning of Python, too. Python's lock is released meanwhile, so runs in threads go
        side by side; Ctrl-C ends a run. Throws RequestError, DiagramError, NetworkError and SolveError.

        >>> import oblique as ob
        >>> side = ob.Diagram("diagrams/lessons/triangle-side.toml")
        >>> run = side.run(check=True, set={"c.gain": 1e6})
        >>> all(one.met for one in run.expectations)
        True
        """
        model = self._model
        options: dict[str, Any] = {
            "until": _arguments.optional_positive("until", until, "s"),
            "tolerance": _arguments.optional_positive("tolerance", tolerance, "1"),
            "absolute_tolerance": _arguments.optional_positive("absolute_tolerance", absolute_tolerance, "machine unit"),
            "max_step": _arguments.optional_positive("max_step", max_step, "s", finite=False),
            "method": None if method is None else _arguments.choice("method", method, _METHODS),
            "samples": None if samples is None else _arguments.count("samples", samples, 2),
            "max_steps": None if max_steps is None else _arguments.count("max_steps", max_steps),
            "settle": None if settle is None else _arguments.flag("settle", settle),
            "check": _arguments.flag("check", check), "trust": _arguments.flag("trust", trust),
            "sensitivity": _arguments.names("sensitivity", sensitivity) if sensitivity else None, "halt_on_overload": _arguments.flag("halt_on_overload", halt_on_overload),
            "watch_overloads": None if watch_overloads is None else _arguments.flag("watch_overloads", watch_overloads)}
        if state is not None:
            if not isinstance(state, State):
                raise RequestError(f"state={_arguments.shown(state)} is no state", "a State, as of run.state")
            options["state"] = state.text
        if check and not model.expects:
            raise DiagramError("there is nothing to check: the diagram has no [expect]", file=self._file,
                               expected='[expect] with lines such as "x at 1" = { value = 0.7, within = 1e-4 }',
                               remedy="diagram.expect(…) adds one")
        if until is None and not 0 < model.until < float("inf"):
            raise RequestError(f"the run would end at t = {model.until} s", "a finite time above 0", "give until=")
        run = Run(model.run(self._turned(gain, set), options))
        for warning in run.warnings:
            warn(warning.message)
        if watch_overloads is None and run.overloads and not run.halted:
            first = run.overloads[0]
            warn(f"{len(run.overloads)} signal{'s' if len(run.overloads) > 1 else ''} left ±1 machine unit, '{first.signal}' "
                 f"first, at t = {first.first:.6g} s; run.overloads has them")
        return run

    def gradient(self, output: str, by: Union[str, Sequence[str]], *, at: Optional[Quantity] = None,
                 until: Optional[Quantity] = None, gain: Optional[float] = None,
                 set: Optional[Mapping[str, Quantity]] = None) -> tuple[float, npt.NDArray[np.float64]]:
        """A number of a run, and its derivative by each of the parameters, of shape (parameters,): the value of an output
        at a time [s], or without `at` its integral over the run. By the adjoint, which costs little more for many
        parameters than for one, of runs in which nothing turns over; for others there is `run(sensitivity=…)`.

        >>> import oblique as ob
        >>> d = ob.Diagram()
        >>> x = d.integrator(initial=1, name="x")
        >>> x.input = -x
        >>> value, by_rate = d.gradient("x", "x.rate", at=2)   # exp(-2), and -2 exp(-2)
        >>> print(f"{value:.6f} {by_rate[0]:.6f}")
        0.135335 -0.270671
        """
        value, derivatives = self._model.gradient(
            self._turned(gain, set), _arguments.text("output", output), _arguments.optional_positive("at", at, "s"),
            _arguments.optional_positive("until", until, "s"), _arguments.names("by", by))
        return value, np.asarray(derivatives)

    def _turned(self, gain: Optional[float], set: Optional[Mapping[str, Quantity]]) -> list[tuple[str, str]]:
        turned = _arguments.settings("set", set)
        if gain is not None:
            value = repr(_arguments.positive("gain", gain, "1", finite=False))
            amplifiers = self._model.servo_amplifiers()
            if not amplifiers:
                raise RequestError(f"gain={_arguments.shown(gain)}: the diagram has no servo amplifier",
                                   "a diagram with one", 'set={"block.parameter": value} turns any pot')
            given = {name for name, _ in turned}
            turned += [(f"{path}.gain", value) for path in amplifiers if f"{path}.gain" not in given]
        return turned

    def check(self, *, set: Optional[Mapping[str, Quantity]] = None, gain: Optional[float] = None) -> DiagramCheck:
        """Looks at wires, loops, stability, overloads and scaling, by a trial run, as `oblique check` does."""
        return DiagramCheck(self._model.check(self._turned(gain, set)))

    def rescaled(self) -> "Diagram":
        """The same diagram in signals that fill the machine unit, as `oblique check --rescale` writes it."""
        text, _, _ = self._model.rescaled()
        return Diagram(text=text, file=self._file, blocks=self._blocks)

    def static_test(self, *, set: Optional[Mapping[str, Quantity]] = None) -> dict[str, tuple[float, Optional[float]]]:
        """Every element's output [machine unit] and, of a state, its derivative [machine unit/s], in initial condition;
        nothing is run."""
        return {signal: (output, derivative)
                for signal, output, derivative, _ in self._model.static_test(self._turned(None, set))}

    # --- pictures

    def draw(self, *, symbols: str = "classic", depth: int = 0, theme: str = "auto") -> Picture:
        """The diagram in the notation of analog computers. `symbols`: "classic" or "din"; `depth`: levels of
        composites shown open."""
        return Picture(self._model.draw(_arguments.choice("symbols", symbols, ("classic", "din")),
                                        _arguments.count("depth", depth, 0), _arguments.text("theme", theme)))

    def _repr_svg_(self) -> Optional[str]:
        try:
            return self.draw().svg
        except DiagramError:  # not wired to its end yet
            return None

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self._blocks_of_file())} blocks, {self._file}>"

# SPDX-License-Identifier: MIT
"""Ensembles: one diagram or mechanism many times, each machine with other values."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _oblique, _toml
from ._arguments import Number, PathLike, Quantity, shown
from ._blocks import BlockLibrary, blocks as shipped_blocks
from ._errors import RequestError, warn
from ._tables import FloatArray, Table
from .diagram import Diagram
from .mechanism import Mechanism

if TYPE_CHECKING:
    import matplotlib.axes

Values = Union[Quantity, Iterable[Quantity]]
"""Of a varied name: a list or an array of numbers, or a text: "1e2..1e6:41:log", "0.8..1.2:9"."""


class EnsembleRun(Table):
    """What came out of an ensemble: a row a machine, the varied names first, then the measures.

    >>> import oblique as ob
    >>> sides = ob.sweep("diagrams/lessons/triangle-side.toml", vary={"c.gain": "1e2..1e4:3:log"},
    ...                  measure={"largest": "max(side)"})
    >>> sides
    <EnsembleRun: 3 rows of c.gain, largest>
    >>> print(*(f"{side:.4f}" for side in sides["largest"]))      # 0.7 less 1/(2 gain)
    0.6950 0.6995 0.7000
    """

    def __init__(self, columns: Sequence[tuple[str, str]], n_varied: int, rows: FloatArray,
                 failures: Iterable[tuple[int, str]], count: Mapping[str, Any],
                 numbers: Optional[npt.NDArray[np.int64]] = None) -> None:
        super().__init__(columns, rows)
        self.numbers: npt.NDArray[np.int64] = np.arange(len(rows)) if numbers is None else numbers
        """The number of the machine of each row, of shape (machines,): 0, 1, 2 …, unless Ctrl-C ended it."""
        self.varied = self.names[:n_varied]
        """The names that were varied."""
        self.measures = self.names[n_varied:]
        self.failures = dict(failures)
        """The machines that failed, by their numbers, and why; their measures are NaN."""
        self.in_lanes: int = count["in_lanes"]
        """So many machines ran side by side, in lanes."""
        self.by_cvodes: int = count["by_cvodes"]
        """So many ran one by one, by CVODES."""
        self.reasons: dict[str, int] = dict(count["reasons"])
        """Why they did."""

    @property
    def records(self) -> npt.NDArray[Any]:
        """The same as a structured array of NumPy, of shape (machines,), a field a column (the first of equal names)."""
        names = list(self)
        table = np.empty(len(self.rows), dtype=[(name, np.float64) for name in names])
        for name in names:
            table[name] = self[name]
        return table

    def _along(self) -> tuple[str, range, dict[str, str]]:
        return "machine", range(len(self.rows)), {}

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row a machine; its `attrs["units"]` are the units."""
        return super().to_pandas()

    def to_xarray(self) -> Any:
        """An xarray.Dataset along `machine`; each variable has `attrs["units"]`."""
        return super().to_xarray()

    def plot(self, *names: str, against: str = "", ax: Optional["matplotlib.axes.Axes"] = None,
             **style: Any) -> "matplotlib.axes.Axes":
        """Draws measures (all, if none are named) against a varied name (the first), and gives Matplotlib's axes."""
        if not against and not self.varied:
            raise RequestError("nothing was varied that the measures could be drawn against", "against=, the name of a column")
        return super().plot(*(names or self.measures), against=against or self.varied[0], ax=ax, **style)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in the middle of an ensemble: what was done until then is `run`.

    It is a KeyboardInterrupt, so it ends what any other one would. In a notebook ``sys.last_value.run`` has it afterwards.
    """

    def __init__(self, run: EnsembleRun, machines: int, remedy: str = "") -> None:
        super().__init__(f"{len(run.rows)} of {machines} machines were run, and are kept in .run of this exception"
                         f" (at a prompt: sys.last_value.run){remedy}")
        self.run = run
        """The rows that were done; `run.numbers` says of which machines."""


class Missing(NamedTuple):
    """A chunk that is not there: the machines `first` to `first + runs - 1`."""

    number: int
    chunks: int
    first: int
    runs: int


class Status(NamedTuple):
    """What there is of an ensemble in a folder."""

    missing: tuple[Missing, ...]
    damaged: dict[str, str]
    """Files that are no whole chunks, and what is wrong with each."""
    runs_there: int
    complete: bool


class Plan:
    """Everything that defines an ensemble: the same plan gives the same numbers, whoever runs which part of it.

    A plan is a file (`oblique-ensemble/1`, docs/ensembles.md), or made by `Plan.of`.

    >>> import oblique as ob
    >>> plan = ob.Plan.of("diagrams/lessons/triangle-side.toml", vary={"c.gain": [1e2, 1e3, 1e4]},
    ...                   measure={"largest": "max(side)"})
    >>> plan
    <Plan: 3 runs, c.gain, largest>
    >>> plan.run()["largest"].shape
    (3,)
    """

    def __init__(self, source: Optional[PathLike] = None, *, text: Optional[str] = None, file: Optional[str] = None,
                 blocks: Optional[Union[BlockLibrary, PathLike]] = None, threads: int = 0) -> None:
        """`file` is the name that paths in a `text` are meant from; `blocks` as for a Diagram; `threads` run it (0: as
        many as there are processors). Throws PlanError, ReadError and what reading the diagram or mechanism throws."""
        if (source is None) == (text is None):
            raise RequestError("a plan is from a file or a text", "one of the two")
        if source is not None:
            file = _arguments.path("source", source)
            text = _arguments.read(file)
        self._open(_arguments.text("text", text), file or "", None, blocks, threads)

    def _open(self, text: str, file: str, subject: Optional[bytes], blocks: Optional[Union[BlockLibrary, PathLike]],
              threads: int) -> None:
        if blocks is None:
            blocks = shipped_blocks
        self._blocks = blocks if isinstance(blocks, BlockLibrary) else BlockLibrary(blocks)
        self._text = text
        self._file = file
        self._threads = _arguments.count("threads", threads, 0, 4096)
        self._raw = _oblique.Plan(text, file, subject, self._blocks._raw, self._blocks._folders,
                                  self._threads or os.cpu_count() or 1)
        if self._raw.version not in ("", _oblique.__version__):
            warn(f"{file or 'the plan'} was written by version {self._raw.version} of Oblique, this is "
                 f"{_oblique.__version__}: the numbers may differ from those it was made for")

    @classmethod
    def _of_parts(cls, text: str, file: str, subject: Optional[bytes], blocks: Any, threads: int) -> "Plan":
        plan = cls.__new__(cls)
        plan._open(text, file, subject, blocks, threads)
        return plan

    @classmethod
    def of(cls, subject: Union[PathLike, Diagram, Mechanism], *, vary: Optional[Mapping[str, Values]] = None,
           measure: Optional[Mapping[str, str]] = None, scatter: Optional[Mapping[str, Quantity]] = None,
           tolerance_of_elements: Optional[Quantity] = None, machine: Optional[str] = None, runs: Optional[int] = None,
           seed: int = 1, sampling: str = "grid", samples: Optional[int] = None, tolerance: Optional[Number] = None,
           gain: Optional[Quantity] = None, method: Optional[str] = None, title: str = "",
           blocks: Optional[Union[BlockLibrary, PathLike]] = None, threads: int = 0) -> "Plan":
        """A plan without a file.

        `subject` is a Diagram or a Mechanism, or its file. `vary` gives the values of names ("c.gain", "crank.length"),
        `measure` names the columns and gives an expression over the run for each ("max(abs(side - exact))"), `scatter` half
        the width of a parameter of all blocks of a type ({"multiplier.error": "0.1%"}), `tolerance_of_elements` that of
        all elements, `machine` the one whose figures scatter. The rest are the keys of a plan. Throws as Plan does."""
        data: dict[str, Any] = {"format": "oblique-ensemble/1"}
        if title:
            data["title"] = _arguments.text("title", title)
        text: Optional[str] = None
        if isinstance(subject, (Diagram, Mechanism)):
            text, file = subject.text, subject.file
            is_mechanism = isinstance(subject, Mechanism)
            if blocks is None and isinstance(subject, Diagram):
                blocks = subject._blocks
        else:
            file = _arguments.path("subject", subject)
            text = _arguments.read(file)
            is_mechanism = 'oblique-mechanism/' in text
        data["mechanism" if is_mechanism else "diagram"] = file
        if runs is not None:
            data["runs"] = _arguments.count("runs", runs, 1, 2**53)
        data["seed"] = str(_arguments.count("seed", seed, 0, 2**64 - 1))
        data["sampling"] = _arguments.choice("sampling", sampling, ("grid", "latin-hypercube", "sobol"))
        if samples is not None:
            data["samples"] = _arguments.count("samples", samples, 2, 10**7)
        if tolerance is not None:
            data["tolerance"] = _arguments.positive("tolerance", tolerance, "1")
        if gain is not None:
            data["gain"] = _arguments.positive("gain", gain, "1")
        if method is not None:
            data["method"] = _arguments.text("method", method)
        if vary is not None:
            data["vary"] = {name: _values(f"vary[{name!r}]", values) for name, values in _names("vary", vary)}
        spread = {name: _toml.plain(f"scatter[{name!r}]", width) for name, width in _names("scatter", scatter or {})}
        if tolerance_of_elements is not None:
            spread["tolerance"] = _arguments.positive("tolerance_of_elements", tolerance_of_elements, "1")
        if machine is not None:
            spread["machine"] = _arguments.text("machine", machine)
        if spread:
            data["scatter"] = spread
        if measure is not None:
            data["measure"] = {name: _arguments.text(f"measure[{name!r}]", one) for name, one in _names("measure", measure)}
        return cls._of_parts(_text_of(data), "", text.encode("utf-8", "surrogateescape"), blocks, threads)

    def __getstate__(self) -> dict[str, Any]:
        return {"text": self._text, "file": self._file, "subject": self._raw.subject, "blocks": self._blocks,
                "threads": self._threads}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._open(state["text"], state["file"], state["subject"], state["blocks"], state["threads"])

    @property
    def runs(self) -> int:
        """So many machines."""
        return self._raw.runs

    @property
    def columns(self) -> dict[str, str]:
        """The names of the columns and their units."""
        return dict(self._raw.columns)

    @property
    def varied(self) -> tuple[str, ...]:
        """The names that are varied."""
        return tuple(name for name, _ in self._raw.columns[:self._raw.n_varied])

    @property
    def seed(self) -> int:
        """Of all that is drawn."""
        return self._raw.seed

    @property
    def title(self) -> str:
        """As its file has it."""
        return self._raw.title

    def toml(self) -> str:
        """The plan as a file has it, with the version of Oblique."""
        return self._raw.toml("")

    def save(self, path: PathLike) -> None:
        """Writes the plan. Its diagram or mechanism must be a file."""
        name = _arguments.path("path", path)
        _oblique.write_file(name, self._raw.toml(name))

    def chunks(self, chunks: Optional[int] = None) -> int:
        """Into how many chunks the ensemble is cut: as many as are asked for, or of about 1000 runs."""
        if chunks is None:
            return self._raw.usual_chunks()
        number = _arguments.count("chunks", chunks)
        self._raw.check_chunks(number)
        return number

    def run(self, progress: Optional[Callable[[int, int], object]] = None) -> EnsembleRun:
        """Runs all machines here, and gives their rows. `progress(done, machines)` is called five times a second. Ctrl-C
        throws Interrupted, which has the rows that were done; what `progress` throws ends the runs too."""
        if progress is not None and not callable(progress):
            raise RequestError(f"progress={shown(progress)} cannot be called", "a function of two numbers")
        rows, failures, count, numbers, stop = self._raw.run(progress)
        run = EnsembleRun(self._raw.columns, self._raw.n_varied, rows, failures, count, numbers)
        if stop is None:
            return run
        if isinstance(stop, KeyboardInterrupt):
            raise Interrupted(run, self.runs) from None
        raise stop

    def make_chunk(self, number: int, chunks: int, folder: PathLike) -> bool:
        """Makes the file of a chunk, which `oblique ensemble gather` knows too; False where it is there already. The chunk
        `number` of `chunks` counts from 0, or from 1."""
        return self._raw.make_chunk(_arguments.count("number", number, 0), _arguments.count("chunks", chunks),
                                    _arguments.path("folder", folder))

    def status(self, folder: PathLike) -> Status:
        """What there is of it in a folder. Throws PlanError where there is a chunk of something else."""
        missing, damaged, runs_there, complete = self._raw.status(_arguments.path("folder", folder))
        return Status(tuple(Missing(*one) for one in missing), dict(damaged), runs_there, complete)

    def gather(self, folder: PathLike, table: Optional[PathLike] = None) -> EnsembleRun:
        """All rows, from the chunks in a folder; with `table` they are written to that file as well. Throws PlanError where
        chunks are missing, or do not belong to the plan."""
        name = _arguments.path("folder", folder)
        found = self.status(name)
        if not found.complete:
            raise _incomplete(name, found)
        return self._result(self._raw.gather(name, "" if table is None else _arguments.path("table", table)))

    def _result(self, found: tuple[FloatArray, Iterable[tuple[int, str]], Mapping[str, Any]]) -> EnsembleRun:
        rows, failures, count = found
        return EnsembleRun(self._raw.columns, self._raw.n_varied, rows, failures, count)

    def __repr__(self) -> str:
        return f"<Plan: {self.runs} runs, {', '.join(name for name, _ in self._raw.columns)}>"


def sweep(subject: Union[PathLike, Diagram, Mechanism], *, vary: Optional[Mapping[str, Values]] = None,
          measure: Optional[Mapping[str, str]] = None, scatter: Optional[Mapping[str, Quantity]] = None,
          tolerance_of_elements: Optional[Quantity] = None, machine: Optional[str] = None, runs: Optional[int] = None,
          seed: int = 1, sampling: str = "grid", samples: Optional[int] = None, tolerance: Optional[Number] = None,
          gain: Optional[Quantity] = None, method: Optional[str] = None, title: str = "",
          blocks: Optional[Union[BlockLibrary, PathLike]] = None, threads: int = 0,
          progress: Optional[Callable[[int, int], object]] = None) -> EnsembleRun:
    """Runs a diagram or a mechanism many times, and gives a row a machine: ``Plan.of(subject, …).run(progress)``. The
    numbers are those of `oblique sweep`, bit for bit, with however many threads. Ctrl-C throws Interrupted, which has the
    rows that were done.

    >>> import oblique as ob
    >>> rates = ob.sweep("diagrams/lessons/triangle-side.toml", vary={"c.gain": "1e3,1e4"}, measure={"last": "end(side)"})
    >>> rates.varied, rates.measures, rates.failures
    (('c.gain',), ('last',), {})
    """
    plan = Plan.of(subject, vary=vary, measure=measure, scatter=scatter, tolerance_of_elements=tolerance_of_elements,
                   machine=machine, runs=runs, seed=seed, sampling=sampling, samples=samples, tolerance=tolerance, gain=gain,
                   method=method, title=title, blocks=blocks, threads=threads)
    return plan.run(progress)


def _incomplete(folder: str, found: Status) -> Exception:
    from ._errors import PlanError
    named = ", ".join(f"{one.number}/{one.chunks}" for one in found.missing[:20])
    more = f" and {len(found.missing) - 20} more" if len(found.missing) > 20 else ""
    if not found.missing:
        return PlanError("there is no chunk of the plan here", file=folder, remedy="make_chunk() makes one")
    return PlanError(f"chunks are missing: {named}{more}", file=folder, remedy="make_chunk() makes them")


def _names(name: str, given: Any) -> list[tuple[str, Any]]:
    if not isinstance(given, Mapping):
        raise RequestError(f"{name}={shown(given)} names nothing", "a dict")
    return [(_arguments.text(f"a name in {name}", one), value) for one, value in given.items()]


def _values(name: str, values: Any) -> Any:
    if isinstance(values, str):
        return values
    listed = [values] if np.ndim(values) == 0 else list(values)
    if not listed:
        raise RequestError(f"{name} is empty", "values")
    return [_toml.plain(name, value) if isinstance(value, str) else _arguments.quantity(name, value, "in its unit")
            for value in listed]


def _text_of(data: Mapping[str, Any]) -> str:
    """TOML, a section a table."""
    lines = [f"{_toml.key(key)} = {_toml.value_text(value)}" for key, value in data.items() if not isinstance(value, dict)]
    for key, value in data.items():
        if isinstance(value, dict):
            lines += ["", f"[{key}]"] + [f"{_toml.key(name)} = {_toml.value_text(entry)}" for name, entry in value.items()]
    return "\n".join(lines) + "\n"

# SPDX-License-Identifier: MIT
"""Mechanisms: read, built, solved, patched, compared, drawn."""

from __future__ import annotations

import html
import json
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments, _oblique, _toml
from ._arguments import PathLike, Quantity
from ._errors import MechanismError, RequestError, warn
from ._blocks import BlockLibrary, blocks as shipped_blocks
from .comparison import Comparison
from .diagram import Diagram
from ._machines import machines
from .motion import Motion
from .pictures import Animation, Page, Picture
from .run import Expected, Run

_METHODS = ("triangles", "gradient", "paper")


class MechanismCheck:
    """What a check finds: `data` (docs/check.md has its keys) and `text`; `finding` is what keeps it from moving."""

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.text: str = found["text"]
        self.data: dict[str, Any] = json.loads(found["json"])
        self.finding: Optional[str] = found["finding"]

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<MechanismCheck: {self.finding or 'it moves'}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class AssemblyMode(NamedTuple):
    points: dict[str, tuple[float, float]]
    """The places of the points that the group places [length unit]."""
    selected: bool
    """Whether it is the one that the sketch picks."""


class GroupModes(NamedTuple):
    """The ways to put a group of links together."""

    name: str
    assur_class: int
    bodies: tuple[str, ...]
    complete: bool
    """False: found by a search, so there are at least these."""
    modes: tuple[AssemblyMode, ...]


class Sheet(NamedTuple):
    """A table for a machine room."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    csv: str

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{html.escape(one)}</th>" for one in self.columns)
        body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in self.rows)
        return f"<table><caption>{html.escape(self.title)}</caption><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class Component(NamedTuple):
    """A kind of element: what a patch needs of it and what the machine has."""

    element: str
    needed: float
    available: Optional[float]
    """None: not published; inf: as many as it takes."""
    missing: float
    exists: bool


class Patch(Diagram):
    """The diagram that simulates a mechanism, and what was found about it."""

    def __init__(self, found: Mapping[str, Any], blocks: BlockLibrary) -> None:
        super().__init__(text=found["text"], file="patch", blocks=blocks)
        self.options: dict[str, Any] = found["options"]
        """With which it was made: method, gain, bandwidth [Hz], slower, split."""
        self.judgement: dict[str, Any] = found["judgement"]
        """Whether its loops come to rest: "good", "well_damped", "slowest_pole" [1/s], "damping", "largest" [machine
        unit] of its signals with its name, "text"."""
        self.components = tuple(Component(*row) for row in found.get("components", ()))
        """On a machine: the elements that it takes."""
        self.fits: Optional[bool] = found.get("fits")
        """On a machine: whether it has them all; None where there is no machine, or it is not told."""
        self.components_text: str = found.get("components_text", "") + found.get("bandwidth_text", "")
        self.sheets = tuple(Sheet(title, tuple(columns), tuple(tuple(row) for row in rows), csv)
                            for title, columns, rows, csv in found.get("sheets", ()))
        """On a machine: the connections, the settings of potentiometers, the static test, the function generators (without
        rows where there are none)."""


class FittedDimension(NamedTuple):
    name: str
    before: float
    after: float
    lower: float
    upper: float
    at_bound: bool


class Fit:
    """The mechanism nearest to a path that was found; distances in its length unit."""

    def __init__(self, found: Mapping[str, Any], file: str) -> None:
        self.rms_before, self.largest_before = found["before"]
        self.rms, self.largest = found["after"]
        """The root mean square and the largest distance from the targets."""
        self.dimensions = tuple(FittedDimension(*one) for one in found["dimensions"])
        self.improved: bool = found["improved"]
        self.turns_fully: bool = found["turns_fully"]
        self.sketch_moved: bool = found["sketch_moved"]
        self.mechanisms_tried: int = found["mechanisms_tried"]
        self.mechanism = Mechanism(text=found["text"], file=file)
        """The fitted one; the old one where nothing nearer was found."""

    def __repr__(self) -> str:
        return f"<Fit: {self.rms_before:.4g} → {self.rms:.4g}, {self.mechanisms_tried} mechanisms tried>"


class Mechanism:
    """A plane mechanism: from a file, from a text, or built part by part.

    >>> import oblique as ob
    >>> leg = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    >>> study = leg.compare(gains=[1e3, 1e4, 1e5])
    >>> print(f"{study.order:.2f}")
    -1.00

    ``Mechanism(title="…", length="mm")`` is empty:

    >>> m = ob.Mechanism(title="Slider-crank")
    >>> m.frame(O=(0, 0), P=(1, 0))
    >>> m.body("crank", "O", "A", length=1)
    >>> m.body("rod", "A", "B", length=2)
    >>> m.slide("guide", point="B", along=("O", "P"))
    >>> m.drive("motor", turns="crank", about="O", speed=1)
    >>> m.sketch(A=(1, 0), B=(3, 0))
    >>> motion = m.solve(361)
    >>> print(f"{motion['B.x'][90]:.9f}")       # sqrt(3): the crank stands upright
    1.732050808
    """

    def __init__(self, source: Optional[PathLike] = None, *, text: Optional[str] = None, file: Optional[str] = None,
                 title: Optional[str] = None, length: Optional[str] = None) -> None:
        """`title` and the unit of `length` are those of an empty one. Throws ReadError and MechanismError."""
        self._changes = 0
        self._made: Optional[tuple[int, _oblique.Mechanism]] = None
        self._data: Optional[dict[str, Any]] = None
        if source is not None and text is None and isinstance(source, str) and "\n" in source:
            source, text = None, source
        if source is not None and text is not None:
            raise RequestError("a mechanism cannot be both from a file and a text", "one of the two")
        if source is not None or text is not None:
            if title is not None or length is not None:
                raise RequestError("title= and length= are for a mechanism that is built, and this one is read")
            if source is not None:
                self._file = _arguments.path("source", source)
                self._text = _arguments.read(self._file)
            else:
                self._file = file or "text"
                self._text = _arguments.text("text", text)
            self._model
            return
        self._file = file or "mechanism built in Python"
        self._text = ""
        self._data = {"format": "oblique-mechanism/1", "title": title or "Built in Python"}
        if length is not None:
            self._data["units"] = {"length": _arguments.text("length", length)}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": None}

    @property
    def _model(self) -> "_oblique.Mechanism":
        if self._made is None or self._made[0] != self._changes:
            self._made = (self._changes, _oblique.Mechanism(self.text, self._file))
        return self._made[1]

    @property
    def text(self) -> str:
        """The text of its file: as it was read, or as it was built."""
        return self._text if self._data is None else _toml.document(self._data)

    def save(self, path: PathLike) -> None:
        """Writes the mechanism as a file. Throws MechanismError where it is none."""
        self._model
        _oblique.write_file(_arguments.path("path", path), self.text)

    @property
    def file(self) -> str:
        """The name that messages give."""
        return self._file

    @property
    def title(self) -> str:
        """As its file has it."""
        return self._model.title

    @property
    def length_unit(self) -> str:
        """Of all its lengths and coordinates."""
        return self._model.length_unit

    @property
    def points(self) -> tuple[str, ...]:
        """The names of all points, those of the frame first."""
        return tuple(self._model.points)

    @property
    def bodies(self) -> tuple[str, ...]:
        """The names of all links."""
        return tuple(self._model.bodies)

    @property
    def slides(self) -> tuple[str, ...]:
        """The names of all slides."""
        return tuple(self._model.slides)

    @property
    def drives(self) -> tuple[str, ...]:
        """The names of all drives."""
        return tuple(self._model.drives)

    # --- building

    def _section(self, name: str) -> dict[str, Any]:
        if self._data is None:
            self._data = tomllib.loads(self._text)
        self._changes += 1
        section: dict[str, Any] = self._data.setdefault(name, {})
        return section

    def _places(self, what: str, points: Mapping[str, Any]) -> dict[str, list[Any]]:
        places = {}
        for name, place in points.items():
            if isinstance(place, str) or len(tuple(place)) != 2:
                raise RequestError(f"{what} {name}={_arguments.shown(place)}", "two coordinates, (x, y)")
            places[name] = [_toml.plain(f"{what} {name}", one) for one in place]
        return places

    def frame(self, **points: Sequence[Quantity]) -> None:
        """Points fixed in the frame: ``frame(A=(0, 0), D=(200, 0))`` [length unit]."""
        self._section("frame").update(self._places("the point", points))

    def body(self, name: str, *points: str, **settings: Any) -> None:
        """A rigid body through two or three points: `length`, or `sides` and `turn`, and `marks`, as in a file
        (docs/mechanisms.md). Bodies that name the same point are joined there."""
        marks = settings.pop("marks", None)
        entry: dict[str, Any] = {"points": list(points), **{key: _toml.plain(key, value) for key, value in settings.items()}}
        if marks is not None:
            entry["marks"] = self._places("the mark", marks)
        self._section("bodies")[_arguments.text("name", name)] = entry

    def slide(self, name: str, **settings: Any) -> None:
        """A point that stays on a line: `point`, `along`, `offset`, `angle`, `of`, as in a file."""
        self._section("slides")[_arguments.text("name", name)] = {
            key: _toml.plain(key, value) for key, value in settings.items()}

    def drive(self, name: str, **settings: Any) -> None:
        """What moves it: `turns` and `about`, or `slides`, with `speed` and `start`, as in a file."""
        self._section("drives")[_arguments.text("name", name)] = {
            key: _toml.plain(key, value) for key, value in settings.items()}

    def sketch(self, **points: Sequence[Quantity]) -> None:
        """Rough places at the start, which pick the assembly mode and nothing else [length unit]."""
        self._section("sketch").update(self._places("the sketched point", points))

    # --- exact

    def solve(self, positions: int = 361, *, until: Optional[Quantity] = None, at_limit: Optional[str] = None,
              analysis: bool = False) -> Motion:
        """The exact motion over a turn of the first drive, or to `until` [s], in so many rows, both ends included.

        `at_limit` says what happens where it can go no further: "open", "stop" or "reverse"; `analysis` adds columns of
        transmission angles and others. Throws MechanismError.
        """
        limit = "" if at_limit is None else _arguments.choice("at_limit", at_limit, ("open", "stop", "reverse"))
        motion = Motion(self._model.solve(_arguments.count("positions", positions, 2, 10_000_000),
                                          _arguments.optional_positive("until", until, "s"), limit, _arguments.flag("analysis", analysis)))
        if (motion.status == "open").any():
            warn(motion.remarks.strip())
        return motion

    def expectations(self) -> tuple[Expected, ...]:
        """The lines of `[expect]`, held against the motion. Throws MechanismError where there are none."""
        if not self._model.expects:
            raise MechanismError("there is nothing to check: the mechanism has no [expect]", file=self._file, kind="request")
        return tuple(Expected(*one) for one in self._model.expectations())

    def check(self) -> MechanismCheck:
        """Whether it moves, its groups, range, transmission angles and paths, as `oblique check`. Throws MechanismError."""
        return MechanismCheck(self._model.check())

    def modes(self, at: Optional[Quantity] = None) -> tuple[GroupModes, ...]:
        """Every way to put each of its groups together, where the first drive stands at `at` [rad or length unit]."""
        where = None if at is None else _arguments.quantity("at", at, self._model.drive_unit)
        _, found = self._model.modes(where)
        return tuple(
            GroupModes(group["name"], group["class"], tuple(group["bodies"]), group["complete"],
                       tuple(AssemblyMode({name: (place[0], place[1]) for name, place in mode["points"].items()},
                                          mode["selected"]) for mode in group["modes"]))
            for group in json.loads(found)["groups"])

    # --- analog

    def _patching(self, gain: Any, bandwidth: Any, method: Any, split: Any, slower: Any) -> dict[str, Any]:
        options: dict[str, Any] = {
            "gain": None if gain is None else _arguments.positive("gain", gain, "1", finite=False),
            "bandwidth": _arguments.optional_positive("bandwidth", bandwidth, "Hz", finite=False),
            "method": _arguments.choice("method", method, _METHODS),
            "split": None if split is None else _arguments.names("split", split),
            "slower": _arguments.optional_positive("slower", slower, "1")}
        if options["method"] == "gradient" and (split is not None or slower is not None):
            raise RequestError(f"{'split' if split is not None else 'slower'}= with method=\"gradient\", which takes no "
                               "group apart", 'method="triangles" or "paper" beside it')
        return options

    def patch(self, *, gain: Optional[float] = None, bandwidth: Optional[Quantity] = None, method: str = "triangles",
              split: Optional[Sequence[str]] = None, slower: Optional[float] = None, derivatives: bool = False,
              unit: Optional[Quantity] = None, period: Optional[Quantity] = None, machine: Optional[str] = None,
              force: bool = False, blocks: Optional[BlockLibrary] = None) -> Patch:
        """The diagram that simulates it, by servo amplifiers of `gain` (1e6) and `bandwidth` [Hz], proved to come to
        rest; with `machine` in the elements of one.

        `derivatives` adds velocities and accelerations; `unit` is 1 machine unit of a coordinate [length unit], `period`
        the machine time of the motion [s]; `split` and `slower` take a triad apart. Throws PatchError.
        """
        options = self._patching(gain, bandwidth, method, split, slower)
        options.update(derivatives=_arguments.flag("derivatives", derivatives), force=_arguments.flag("force", force),
                       unit=_arguments.optional_positive("unit", unit, self.length_unit),
                       period=_arguments.optional_positive("period", period, "s"))
        library = shipped_blocks if blocks is None else blocks
        if machine is None:
            return Patch(self._model.patch(library._raw, options), library)
        return Patch(self._model.patch_on(library._raw, machines[machine].name, options), library)

    def run(self, until: Optional[Quantity] = None, *, gain: Optional[float] = None,
            bandwidth: Optional[Quantity] = None, method: str = "triangles", split: Optional[Sequence[str]] = None,
            slower: Optional[float] = None, machine: Optional[str] = None, **settings: Any) -> Run:
        """Patches it and runs the patch: the same as ``patch(…).run(until, …)``, with the settings of Diagram.run."""
        patch = self.patch(gain=gain, bandwidth=bandwidth, method=method, split=split, slower=slower, machine=machine)
        return patch.run(until, **settings)

    def compare(self, gains: Union[None, float, Sequence[float], npt.NDArray[np.float64]] = None, *,
                bandwidths: Union[None, Quantity, Sequence[Quantity]] = None,
                methods: Union[str, Sequence[str]] = "triangles", split: Optional[Sequence[str]] = None,
                slower: Optional[float] = None, positions: int = 361, machine: Optional[str] = None,
                monte_carlo: int = 0, tolerance: Optional[Quantity] = None, seed: int = 1, first_run: int = 0,
                threads: int = 0, good_below: Optional[Quantity] = None, until_within: Optional[Quantity] = None,
                budget: bool = False, blocks: Optional[BlockLibrary] = None) -> Comparison:
        """Patches it with each method, bandwidth [Hz] and gain (1e2 … 1e6), runs the diagrams over the motion, and
        holds them against the exact one.

        With `machine`, with the figures of one besides; with `monte_carlo`, so many runs with elements drawn anew within
        `tolerance` (a part: 0.001, "0.1 %"), or as the machine's scatter: then one gain, bandwidth and method (a gain of
        1e6 where none is given). Machines that err by less than `good_below` (of the largest link: "1 %"; or a length) are good,
        and `.monte_carlo.yield_` says how many are; `until_within` ends the runs where their part is known within ± that
        ("2 %"). `budget` says whose tolerances the errors come from. `threads` is how many work at that, 0 as many as there
        are processors; the result does not depend on it. Throws RequestError, PatchError, SolveError.
        """
        wanted = [_arguments.choice("methods", one, _METHODS) for one in _arguments.names("methods", methods)]
        wanted = list(dict.fromkeys(wanted))
        options: dict[str, Any] = {
            "gains": None if gains is None else _arguments.numbers("gains", gains, "1"),
            "bandwidths": None if bandwidths is None else _arguments.numbers("bandwidths", bandwidths, "Hz"),
            "methods": wanted,
            "positions": _arguments.count("positions", positions, 2, 10_000_000),
            "threads": _arguments.count("threads", threads, 0, 4096)}
        chosen = self._patching(None, None, "gradient" if wanted == ["gradient"] else "triangles", split, slower)
        options.update(split=chosen["split"], slower=chosen["slower"])
        runs = _arguments.count("monte_carlo", monte_carlo, 0)
        draws: Optional[dict[str, Any]] = None
        part = None if tolerance is None else _arguments.positive("tolerance", tolerance, "1")
        if part is not None and part > 0.5:
            raise RequestError(f"tolerance={_arguments.shown(tolerance)}", "a number above 0 and up to 0.5")
        if budget:
            options.update(budget=True, tolerance=part)
        if runs or budget or machine is not None:
            what = "machine=" if machine is not None else "budget=" if budget else "monte_carlo="
            for name, several in (("gains", options["gains"]), ("bandwidths", options["bandwidths"]),
                                  ("methods", wanted)):
                if several is not None and len(several) > 1:
                    raise RequestError(f"{what} with {len(several)} {name}", "one")
            options["gains"] = options["gains"] or [1e6]
        if runs:
            draws = {"runs": runs, "tolerance": part, "seed": _arguments.count("seed", seed, 0, 2**63 - 1),
                     "first_run": _arguments.count("first_run", first_run, 0, 2**63 - 1), "threads": options["threads"]}
            draws.update(_good(good_below, until_within, self.length_unit))
        elif good_below is not None or until_within is not None:
            name = "good_below" if good_below is not None else "until_within"
            raise RequestError(f"{name}= without elements that are drawn", "monte_carlo=1000 beside it")
        elif tolerance is not None and not budget:
            raise RequestError("tolerance= without elements that are drawn", "monte_carlo=1000 or budget=True beside it")
        library = shipped_blocks if blocks is None else blocks
        name = "" if machine is None else machines[machine].name
        study = Comparison(self._model.compare(library._raw, options, name, draws))
        for one in study.refused:
            gain = "" if one["gain"] is None else f", gain {one['gain']:g}"
            warn(f"method {one['method']}{gain} is left out: {one['why']}")
        for run in study.runs:
            if run.left_branch is not None:
                warn(f"{run.method}, gain {run.gain:g}: its loops hold another assembly mode from {run.left_branch:.4g} "
                     f"{study.drive_unit} of the first drive on; that is no error of the gain, and not in its order")
            if not run.stable:
                warn(f"{run.method}, gain {run.gain:g}: not every servo loop would return to rest")
        return study

    # --- dimensions that fit

    def fit(self, path: Union[PathLike, Mapping[str, Any]], free: Union[str, Sequence[str]], *, starts: int = 8) -> Fit:
        """Looks for the dimensions `free` ("rod", "rod=40..60", docs/synthesis.md) that bring the path of a point
        nearest to targets: a CSV file, or columns by their names, ``{"P.x": x, "P.y": y}`` [length unit], maybe with `t`
        [s] or a drive [rad]. Throws SynthesisError."""
        if isinstance(path, Mapping):
            columns = {name: np.asarray(values, dtype=float) for name, values in path.items()}
            shapes = {values.shape for values in columns.values()}
            if len(shapes) != 1 or len(next(iter(shapes))) != 1:
                listed = ", ".join(f"{name}: {values.shape}" for name, values in columns.items())
                raise RequestError(f"the columns of a path have the shapes {listed or 'of nothing'}", "one length of one dimension")
            for name, values in columns.items():
                if not np.isfinite(values).all():
                    raise RequestError(f"the column {name} of the path has values that are not finite", "finite numbers")
            csv = ",".join(columns) + "\n" + "".join(
                ",".join(repr(float(value)) for value in row) + "\n" for row in zip(*columns.values()))
            file = "path"
        else:
            file = _arguments.path("path", path)
            csv = _arguments.read(file)
        found = self._model.fit(csv, file, _arguments.names("free", free), _arguments.count("starts", starts))
        return Fit(found, self._file)

    # --- pictures

    def _overlay(self, magnify: Optional[float], gain: Any, bandwidth: Any, method: str) -> Optional[dict[str, Any]]:
        if magnify is None:
            if gain is not None or bandwidth is not None:
                raise RequestError("gain= and bandwidth= are those of a patch that is drawn over it", "magnify= beside them")
            return None
        return self._patching(gain, bandwidth, method, None, None)

    def draw(self, *, at: Optional[Quantity] = None, positions: int = 1, trace: Union[None, str, Sequence[str]] = None,
             magnify: Optional[float] = None, gain: Optional[float] = None, bandwidth: Optional[Quantity] = None,
             method: str = "triangles", theme: str = "auto") -> Picture:
        """The mechanism to scale, where the first drive stands at `at` [rad or length unit], with further `positions`
        faintly, and the paths of the points of `trace` (None: those worth it; "none"). With `magnify` its patch is drawn
        over it, with errors that many times as large."""
        time = None
        if at is not None:
            time = self._model.time_at(_arguments.quantity("at", at, self._model.drive_unit))
        patch = self._overlay(magnify, gain, bandwidth, method)
        return Picture(*self._model.draw(
            shipped_blocks._raw, time, _arguments.count("positions", positions),
            [] if trace is None else _arguments.names("trace", trace),
            _arguments.optional_positive("magnify", magnify, "1"), patch, _arguments.text("theme", theme)))

    def plots(self, point: str, *, theme: str = "auto") -> Picture:
        """The path, velocity and acceleration of a point, in six plots."""
        return Picture(self._model.plots(_arguments.text("point", point), _arguments.text("theme", theme)))

    def animate(self, *, frames: int = 120, duration: Quantity = 4, size: int = 0,
                trace: Union[None, str, Sequence[str]] = None, magnify: Optional[float] = None,
                gain: Optional[float] = None, bandwidth: Optional[Quantity] = None, method: str = "triangles",
                theme: str = "auto") -> Animation:
        """The mechanism moving, a round in `duration` [s], `size` pixels broad; `magnify` as in `draw`."""
        patch = self._overlay(magnify, gain, bandwidth, method)
        return Animation(*self._model.animate(
            shipped_blocks._raw, _arguments.count("frames", frames, 8, 3600),
            _arguments.positive("duration", duration, "s"), _arguments.count("size", size, 0, 65535),
            [] if trace is None else _arguments.names("trace", trace),
            _arguments.optional_positive("magnify", magnify, "1"), patch, _arguments.text("theme", theme)))

    def report(self, *, gain: Optional[float] = None, bandwidth: Optional[Quantity] = None, method: str = "triangles",
               machine: Optional[str] = None, theme: str = "auto") -> Page:
        """All that is known of it on one page: drawing, groups, motion, patch, convergence, with a machine its sheets."""
        options = self._patching(gain, bandwidth, method, None, None)
        name = "" if machine is None else machines[machine].name
        return Page(self._model.report(shipped_blocks._raw, options, name, _arguments.text("theme", theme)))

    def _repr_svg_(self) -> Optional[str]:
        try:
            return self.draw().svg
        except MechanismError:  # not put together to its end yet
            return None

    def __repr__(self) -> str:
        return f"<Mechanism: {self._file}>"


def _good(below: Optional[Quantity], within: Optional[Quantity], unit: str) -> dict[str, Any]:
    """What says which machines are good, and how well their part is to be known."""
    found: dict[str, Any] = {}
    if below is not None:
        of_the_largest = isinstance(below, str) and below.endswith("%")
        found["good_below"] = _arguments.positive("good_below", below, "1" if of_the_largest else unit)
        found["of_the_largest"] = of_the_largest
    if within is not None:
        if below is None:
            raise RequestError("until_within= without a yield", 'good_below= beside it, such as good_below="1 %"')
        part = _arguments.positive("until_within", within, "1")
        if part >= 1:
            raise RequestError(f"until_within={_arguments.shown(within)}", "a part above 0 and below 1, such as 0.02")
        found["until_within"] = part
    return found

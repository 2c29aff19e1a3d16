# SPDX-License-Identifier: MIT
"""Analog against exact."""

from __future__ import annotations

import html
import json
import math
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple, Optional

import numpy as np

from ._tables import FloatArray, _missing
from .pictures import Picture

if TYPE_CHECKING:
    import matplotlib.axes


class ComparedRun:
    """One patch, run and held against the exact motion; errors in the mechanism's length unit."""

    def __init__(self, data: Mapping[str, Any], along: FloatArray, overloads: Any, unit: str) -> None:
        self.method: str = data["method"]
        self.gain: float = _number(data["gain"])
        self.bandwidth: float = _number(data["bandwidth"])
        """Of the servo amplifiers [Hz]."""
        self.max_error: float = _number(data["max_error"])
        """The largest distance of any moving point from its exact place."""
        self.rms_error: float = _number(data["rms_error"])
        self.error_along = along
        """The largest distance in each row, of shape (rows,)."""
        self.parts: Optional[dict[str, float]] = data["parts"]
        """Of the largest error: "static", "lag", "solver"; None where they are not known."""
        self.worst: dict[str, Any] = data["worst"]
        """The "point", "time" [s], "drive" and "reason" of the largest error."""
        self.left_branch: Optional[float] = data["left_branch"]
        """Where its loops first hold another assembly mode (value of the first drive), or None."""
        self.stable: bool = data["stable"]
        self.steps: int = data["steps"]
        self.seconds: float = data["seconds"]
        self.overloads: tuple[tuple[str, float, float], ...] = tuple(overloads)
        """(signal, peak [machine unit], time [s]) of each that left the machine unit."""
        self.unit = unit

    def __repr__(self) -> str:
        return f"<ComparedRun: {self.method}, gain {self.gain:g}, error {self.max_error:.4g} {self.unit}>"


class Yield(NamedTuple):
    """How many of the machines that were drawn are good, and what that tells of all machines."""

    below: float
    """The error below which one is good [length unit]."""
    good: int
    machines: int
    part: float
    """good / machines."""
    low: float
    """With 95 % confidence the part of all machines lies between this and `high`, by Wilson's interval."""
    high: float


class MonteCarlo:
    """The largest errors of many machines that differ in the tolerances of their elements."""

    def __init__(self, data: Mapping[str, Any], unit: str) -> None:
        self.unit = unit
        self.errors: FloatArray = np.array([_number(error) for error in data["errors"]])
        """The largest error of each run, of shape (runs,); NaN: the run failed."""
        self.drawn: int = data["drawn"]
        """How many parameters every run draws."""
        self.seed: int = data["seed"]
        self.worst_run: Optional[int] = data["worst_run"]
        self.failures: list[dict[str, Any]] = data["failures"]
        drawn_yield = data.get("yield")
        self.yield_: Optional[Yield] = None if drawn_yield is None else Yield(**drawn_yield)
        """Where `good_below` asked for it."""
        self.data = dict(data)

    def percentile(self, percent: float) -> float:
        """The error that this part [%] of the runs does not exceed: that of a run, by the nearest rank; NaN where all
        failed."""
        known = np.sort(self.errors[np.isfinite(self.errors)])
        if not known.size:
            return math.nan
        rank = math.ceil(percent / 100 * known.size)
        return float(known[min(max(rank - 1, 0), known.size - 1)])

    def __repr__(self) -> str:
        return (f"<MonteCarlo: {self.errors.size} runs, median {self.percentile(50):.4g} {self.unit}, "
                f"95 % within {self.percentile(95):.4g} {self.unit}{self._yield_text()}>")

    def _yield_text(self) -> str:
        if self.yield_ is None:
            return ""
        return f", {100 * self.yield_.part:.3g} % below {self.yield_.below:.4g} {self.unit}"


class Comparison:
    """A mechanism's patches against its exact motion: one run for each method, bandwidth and gain.

    `text` is what `oblique compare` prints, `data` what it writes as JSON (docs/trust.md has the keys).
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        self.text: str = found["text"]
        self.data: dict[str, Any] = json.loads(found["json"])
        self.unit: str = self.data["unit"]
        """Of all lengths and errors."""
        self.size: float = self.data["size"]
        """The largest link."""
        self.drive: FloatArray = found["drive"]
        """The value of the first drive in each row of `error_along`, of shape (rows,) [`drive_unit`]."""
        self.drive_unit: str = found["drive_unit"]
        self.runs = tuple(
            ComparedRun(run, along, overloads, self.unit)
            for run, along, overloads in zip(self.data["runs"], found["error_along"], found["overloads"]))
        self.refused: list[dict[str, Any]] = self.data["refused"]
        """What was asked for and could not be had, with "why"."""
        drawn = self.data.get("monte_carlo")
        self.monte_carlo = None if drawn is None else MonteCarlo(drawn, self.unit)
        self.budget: Optional[dict[str, Any]] = self.data.get("budget")
        """Whose tolerances the errors come from, the largest share first (docs/trust.md has the keys)."""
        self.machine: Optional[dict[str, Any]] = self.data.get("machine")
        """The errors on a machine's elements, figure by figure."""
        self._chart = found["chart"]

    @property
    def gains(self) -> FloatArray:
        """The gain of each run, of shape (runs,)."""
        return np.array([run.gain for run in self.runs])

    @property
    def errors(self) -> FloatArray:
        """The largest error of each run [`unit`], of shape (runs,)."""
        return np.array([run.max_error for run in self.runs])

    @property
    def rms_errors(self) -> FloatArray:
        """The root mean square error of each run [`unit`], of shape (runs,)."""
        return np.array([run.rms_error for run in self.runs])

    @property
    def order(self) -> Optional[float]:
        """The slope of log error over log gain, about −1; of the first method and bandwidth (`orders` has all). None
        where fewer than two runs stand above what the solver leaves."""
        return next(iter(self.orders.values()), None)

    @property
    def orders(self) -> dict[tuple[str, float], Optional[float]]:
        """The order of each (method, bandwidth [Hz])."""
        return {(one["method"], _number(one["bandwidth"])): one["order"] for one in self.data["series"]}

    @property
    def floors(self) -> dict[tuple[str, float], Optional[float]]:
        """What the tolerance of the solver alone leaves of each (method, bandwidth) [`unit`]."""
        return {(one["method"], _number(one["bandwidth"])): one["floor"] for one in self.data["series"]}

    def plot(self, ax: Optional["matplotlib.axes.Axes"] = None, **style: Any) -> "matplotlib.axes.Axes":
        """The error over the gain, both logarithmic, with the fitted order; gives Matplotlib's axes."""
        from . import plots
        return plots.convergence(self, ax=ax, **style)

    def plot_along(self, ax: Optional["matplotlib.axes.Axes"] = None, **style: Any) -> "matplotlib.axes.Axes":
        """The error along the motion, a curve a run; gives Matplotlib's axes."""
        from . import plots
        return plots.errors_along(self, ax=ax, **style)

    def draw(self) -> Picture:
        """The chart as `oblique compare --plot` draws it, without Matplotlib."""
        return Picture(self._chart)

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, a row a run."""
        try:
            import pandas
        except ImportError:
            raise _missing("pandas") from None
        frame = pandas.DataFrame([
            {"method": run.method, "bandwidth": run.bandwidth, "gain": run.gain, "max_error": run.max_error,
             "rms_error": run.rms_error, "steps": run.steps, "seconds": run.seconds, "stable": run.stable,
             "overloads": len(run.overloads)} for run in self.runs])
        frame.attrs["units"] = {"bandwidth": "Hz", "max_error": self.unit, "rms_error": self.unit, "seconds": "s"}
        return frame

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        order = self.order
        return f"<Comparison: {len(self.runs)} runs, order {'not known' if order is None else f'{order:.3f}'}>"

    def _repr_html_(self) -> str:
        return f"{self._chart}<pre>{html.escape(self.text)}</pre>"


def _number(value: Any) -> float:
    """JSON has null for what is no finite number."""
    return math.nan if value is None else float(value)

# SPDX-License-Identifier: MIT
"""Figures with Matplotlib: each function draws into `ax`, or into new axes, and gives them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Sequence

import numpy as np

from ._tables import _missing

if TYPE_CHECKING:
    import matplotlib.axes

    from ._tables import Table
    from .comparison import Comparison, MonteCarlo


def _axes(ax: Optional["matplotlib.axes.Axes"]) -> "matplotlib.axes.Axes":
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot
    except ImportError:
        raise _missing("matplotlib") from None
    return matplotlib.pyplot.subplots()[1]


def _labelled(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def curves(table: "Table", names: Sequence[str] = (), *, against: str = "t",
           ax: Optional["matplotlib.axes.Axes"] = None, **style: Any) -> "matplotlib.axes.Axes":
    """Columns of a table over another; all of them where none are named."""
    x = table[against]
    chosen = list(names) or [name for name in table if name not in ("t", against)]
    columns = [(name, table[name]) for name in chosen]
    ax = _axes(ax)
    units = table.units
    for name, y in columns:
        ax.plot(x, y, **{"label": name, **style})
    shared = {units[name] for name in chosen}
    ax.set_xlabel(_labelled(against, units[against]))
    if len(chosen) == 1:
        ax.set_ylabel(_labelled(chosen[0], units[chosen[0]]))
    else:
        ax.set_ylabel(f"[{shared.pop()}]" if len(shared) == 1 else "")
        ax.legend()
    if against != "t" and len(chosen) == 1 and units[against] == units[chosen[0]]:
        ax.set_aspect("equal", adjustable="datalim")
    return ax


def convergence(comparison: "Comparison", *, ax: Optional["matplotlib.axes.Axes"] = None,
                **style: Any) -> "matplotlib.axes.Axes":
    """The largest error over the gain, a line a method and bandwidth, with its order; dashed what the solver leaves."""
    ax = _axes(ax)
    several = len(comparison.orders) > 1
    told = False
    for (method, bandwidth), order in comparison.orders.items():
        runs = [run for run in comparison.runs if (run.method, run.bandwidth) == (method, bandwidth)]
        label = f"{method}, {bandwidth:g} Hz" if several else "largest error"
        if order is not None:
            label += f": order {order:.3f}"
        line, = ax.loglog([run.gain for run in runs], [run.max_error for run in runs],
                          **{"marker": "o", "label": label, **style})
        floor = comparison.floors[method, bandwidth]
        if floor:
            ax.axhline(floor, color=line.get_color(), linestyle="--", linewidth=0.8,
                       label=None if told else "the solver's tolerance")
            told = True
    ax.set_xlabel("gain of the servo amplifiers")
    ax.set_ylabel(f"largest error [{comparison.unit}]")
    ax.grid(True, which="major", alpha=0.3)
    ax.legend()
    return ax


def errors_along(comparison: "Comparison", *, ax: Optional["matplotlib.axes.Axes"] = None,
                 **style: Any) -> "matplotlib.axes.Axes":
    """The largest error of any point along the motion, a curve a run, logarithmic."""
    ax = _axes(ax)
    turning = comparison.drive_unit == "rad"
    x = np.degrees(comparison.drive) if turning else comparison.drive
    several = len({run.method for run in comparison.runs}) > 1
    for run in comparison.runs:
        label = f"{run.method}, gain {run.gain:.3g}" if several else f"gain {run.gain:.3g}"
        ax.semilogy(x, run.error_along, **{"label": label, **style})
    ax.set_xlabel("first drive [°]" if turning else f"first drive [{comparison.drive_unit}]")
    ax.set_ylabel(f"largest error [{comparison.unit}]")
    ax.grid(True, which="major", alpha=0.3)
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return ax


def histogram(draws: "MonteCarlo", *, ax: Optional["matplotlib.axes.Axes"] = None, bins: int = 30,
              **style: Any) -> "matplotlib.axes.Axes":
    """How often machines err how much, with the errors that half and 95 % of them do not exceed."""
    ax = _axes(ax)
    ax.hist(draws.errors[np.isfinite(draws.errors)], bins=bins, **style)
    for percent, dashes in ((50, "-"), (95, "--")):
        error = draws.percentile(percent)
        ax.axvline(error, color="black", linestyle=dashes, linewidth=1,
                   label=f"{percent} % within {error:.3g} {draws.unit}")
    ax.set_xlabel(f"largest error [{draws.unit}]")
    ax.set_ylabel("machines")
    ax.legend()
    return ax

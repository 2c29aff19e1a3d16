# SPDX-License-Identifier: MIT
"""Tables of numbers whose columns have names and units."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arguments
from ._errors import RequestError

if TYPE_CHECKING:
    import matplotlib.axes

FloatArray = npt.NDArray[np.float64]


class Table(Mapping[str, FloatArray]):
    """Columns of one length by their names, one row a sample.

    ``table["x"]`` is a view of the column as a NumPy array of shape (rows,): nothing is copied, and so it cannot be
    written to; ``table["x"].copy()`` can. ``table.rows`` is all of it, of shape (rows, columns).
    """

    def __init__(self, columns: Sequence[tuple[str, str]], rows: FloatArray) -> None:
        rows.setflags(write=False)
        self._rows = rows
        self._columns = tuple(columns)
        self._places: dict[str, int] = {}
        for place, (name, _) in enumerate(self._columns):
            self._places.setdefault(name, place)

    @property
    def rows(self) -> FloatArray:
        """All values, of shape (rows, columns)."""
        return self._rows

    @property
    def t(self) -> FloatArray:
        """The times of the rows [s]."""
        return self["t"]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the columns, in their order; the first is `t`."""
        return tuple(name for name, _ in self._columns)

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column, empty where it has none."""
        return {name: unit for name, unit in reversed(self._columns)}

    def __getitem__(self, name: str) -> FloatArray:
        """The column of that name. Throws UnknownNameError, which is a KeyError too."""
        try:
            place = self._places[name]
        except (KeyError, TypeError):
            raise _arguments.unknown("column", name, self.names) from None
        return self._rows[:, place]

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> npt.NDArray[Any]:
        return np.array(self._rows, dtype=dtype) if copy else np.asarray(self._rows, dtype=dtype)

    def _along(self) -> tuple[str, Union[FloatArray, range], dict[str, str]]:
        """What the rows are told apart by: its name, its values, and its attributes."""
        return "t", self.t, {"units": "s"}

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with the index `t` [s]; its `attrs["units"]` are the units."""
        try:
            import pandas
        except ImportError:
            raise _missing("pandas") from None
        along, values, _ = self._along()
        frame = pandas.DataFrame({name: self[name] for name in self if name != along},
                                 index=pandas.Index(values, name=along))
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self) -> Any:
        """An xarray.Dataset with the coordinate `t` [s]; each variable has `attrs["units"]`."""
        try:
            import xarray
        except ImportError:
            raise _missing("xarray") from None
        units = self.units
        along, values, attributes = self._along()
        return xarray.Dataset(
            {name: (along, self[name], {"units": units[name]}) for name in self if name != along},
            coords={along: (along, np.asarray(values), attributes)})

    def plot(self, *names: str, against: str = "t", ax: Optional["matplotlib.axes.Axes"] = None,
             **style: Any) -> "matplotlib.axes.Axes":
        """Draws columns (all, if none are named) against another with Matplotlib, and gives the axes."""
        from . import plots
        return plots.curves(self, names, against=against, ax=ax, **style)

    def _table_html(self, caption: str = "", most_rows: int = 11, most_columns: int = 12) -> str:
        columns = self._columns[:most_columns]
        places = np.unique(np.linspace(0, max(len(self._rows) - 1, 0), most_rows).astype(int))
        head = "".join(f"<th>{html.escape(name)}<br><small>{html.escape(unit)}</small></th>" for name, unit in columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{_short(self._rows[row, column])}</td>" for column in range(len(columns))) + "</tr>"
            for row in places if len(self._rows))
        more = len(self._columns) - len(columns)
        foot = f"{len(self._rows)} rows, {len(self._columns)} columns" + (f", {more} of them not shown" if more else "")
        title = f"<caption>{html.escape(caption)}</caption>" if caption else ""
        return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><small>{foot}</small>"

    def _repr_html_(self) -> str:
        return self._table_html()

    def __repr__(self) -> str:
        shown = ", ".join(self.names[:8]) + (", …" if len(self._columns) > 8 else "")
        return f"<{type(self).__name__}: {len(self._rows)} rows of {shown}>"


def _short(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.6g}"


def _missing(package: str) -> RequestError:
    return RequestError(f"the Python package {package} is not installed", remedy=f"install it, on Debian python3-{package}")

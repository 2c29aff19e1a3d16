# SPDX-License-Identifier: MIT
"""The exact motion of a mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._tables import FloatArray, Table

_STATUS = np.array(["ok", "dead-centre", "open"])


class Motion(Table):
    """A motion, exact to rounding, one row a position: `t` [s]; each drive; `P.x P.y P.vx P.vy P.ax P.ay` of every
    moving point; `b.angle b.omega b.alpha` of every link; `s.position s.velocity s.acceleration` of every slide. What
    has no value is NaN."""

    def __init__(self, found: Mapping[str, Any]) -> None:
        super().__init__(found["columns"], found["rows"])
        self.status: npt.NDArray[np.str_] = _STATUS[np.array(found["status"], dtype=int)]
        """Of each row, of shape (rows,): "ok", "dead-centre" (rates of a group have no value) or "open" (it cannot be
        assembled)."""
        self.events: str = found["events"]
        """Where it meets a limit or a change point, in words."""
        self.remarks: str = found["remarks"]

    def point(self, name: str) -> FloatArray:
        """The places of a moving point, of shape (rows, 2) [length unit]."""
        return np.column_stack([self[f"{name}.x"], self[f"{name}.y"]])

# SPDX-License-Identifier: MIT
"""The real machines that a diagram can be for."""

from __future__ import annotations

import html
import json
from typing import Any, Optional

from . import _oblique
from ._libraries import Library


class Machine:
    """A machine as far as it is published: `data` has its figures (docs/machines.md has the keys), `text` all of it."""

    def __init__(self, name: str, title: str, text: str, data: str) -> None:
        self.name = name
        self.title = title
        self.text = text
        self.data: dict[str, Any] = json.loads(data)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<Machine {self.name}: {self.title}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class MachineLibrary(Library[Machine]):
    """Machines by their names.

    >>> import oblique as ob
    >>> ob.machines["tr-10"].data["unit"]
    10.0
    """

    def __init__(self) -> None:
        super().__init__("machine", _oblique.machine_names())

    def _made(self, name: str) -> Optional[Machine]:
        found = _oblique.machine(name)
        return None if found is None else Machine(name, *found)

    def _line(self, item: Machine) -> str:
        return item.title

    def __repr__(self) -> str:
        return f"<MachineLibrary of {len(self)} machines>"


machines = MachineLibrary()
"""The machines that there are."""

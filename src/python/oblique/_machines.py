# SPDX-License-Identifier: MIT
"""The real machines that a diagram can be for."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Mapping
from typing import Any

from . import _arguments, _oblique


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


class MachineLibrary(Mapping[str, Machine]):
    """Machines by their names.

    >>> import oblique as ob
    >>> ob.machines["tr-10"].data["unit"]
    10.0
    """

    def __init__(self) -> None:
        self._names = tuple(_oblique.machine_names())
        self._known: dict[str, Machine] = {}

    def __getitem__(self, name: str) -> Machine:
        if name not in self._known:
            found = _oblique.machine(name) if isinstance(name, str) else None
            if found is None:
                raise _arguments.unknown("machine", name, self._names)
            self._known[name] = Machine(name, *found)
        return self._known[name]

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<MachineLibrary of {len(self)} machines>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(self[name].title)}</td></tr>" for name in self)
        return f"<table><thead><tr><th>name</th><th>machine</th></tr></thead><tbody>{rows}</tbody></table>"


machines = MachineLibrary()
"""The machines that there are."""

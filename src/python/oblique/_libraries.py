# SPDX-License-Identifier: MIT
"""What is looked up by its name: blocks, machines."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence
from typing import Generic, Optional, TypeVar

from . import _arguments

Item = TypeVar("Item")


class Library(Mapping[str, Item], Generic[Item]):
    """Items by their names, each made when it is first asked for. Throws UnknownNameError, with the nearest name."""

    def __init__(self, kind: str, names: Sequence[str]) -> None:
        self._kind = kind
        self._names = tuple(names)
        self._known: dict[str, Item] = {}

    def _made(self, name: str) -> Optional[Item]:
        raise NotImplementedError

    def _line(self, item: Item) -> str:
        """What stands beside the name in a table."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> Item:
        if name not in self._known:
            made = self._made(name) if isinstance(name, str) else None
            if made is None:
                raise _arguments.unknown(self._kind, name, self._names)
            self._known[name] = made
        return self._known[name]

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(self._line(self[name]))}</td></tr>"
                       for name in self)
        return f"<table><thead><tr><th>{self._kind}</th><th>what it is</th></tr></thead><tbody>{rows}</tbody></table>"

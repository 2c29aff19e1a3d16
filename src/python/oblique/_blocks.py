# SPDX-License-Identifier: MIT
"""The kinds of blocks that a diagram is made of."""

from __future__ import annotations

import html
from typing import Any, NamedTuple, Optional

from . import _arguments, _oblique
from ._arguments import PathLike
from ._libraries import Library


class Input(NamedTuple):
    name: str
    sum: bool
    """Whether it adds several weighted signals."""
    default: Optional[float]
    """What it sees where it is not wired; None: it must be."""
    doc: str


class Output(NamedTuple):
    name: str
    doc: str


class Parameter(NamedTuple):
    name: str
    default: Optional[float]
    """None for a function given by points or by a formula."""
    unit: str
    by_points: bool
    doc: str


class Block:
    """A kind of block: its ports and parameters; `text` is all that is known of it."""

    def __init__(self, name: str, found: "_oblique.BlockDescription") -> None:
        self.name = name
        self.title = found["title"]
        self.summary = found["summary"]
        self.text = found["text"]
        self.inputs = tuple(Input(*port) for port in found["inputs"])
        self.outputs = tuple(Output(*port) for port in found["outputs"])
        self.parameters = tuple(Parameter(*one) for one in found["parameters"])

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<Block {self.name}: {self.summary}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class BlockLibrary(Library[Block]):
    """Blocks by their names: those that are shipped, and those of the folders that are given, which replace shipped
    ones of their names.

    >>> import oblique as ob
    >>> ob.blocks["integrator"].summary
    'Integrates the weighted sum of its inputs over time.'
    >>> own = ob.BlockLibrary("diagrams/own-blocks/blocks")
    >>> "schmitt-trigger" in own
    True
    """

    def __init__(self, *folders: PathLike) -> None:
        """Throws DiagramError with all that is wrong in the files of the folders."""
        self._folders = [_arguments.path("a folder of blocks", folder) for folder in folders]
        self._raw = _oblique.BlockLibrary(self._folders)
        super().__init__("block type", self._raw.names())

    def __reduce__(self) -> tuple[Any, ...]:
        return (BlockLibrary, tuple(self._folders))

    def _made(self, name: str) -> Optional[Block]:
        found = self._raw.describe(name)
        return None if found is None else Block(name, found)

    def _line(self, item: Block) -> str:
        return item.summary

    def __repr__(self) -> str:
        return f"<BlockLibrary of {len(self)} blocks>"


blocks = BlockLibrary()
"""The shipped blocks."""

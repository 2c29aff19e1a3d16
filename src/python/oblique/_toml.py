# SPDX-License-Identifier: MIT
"""Writes what is built in Python as the text that the library reads."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arguments import shown
from ._errors import RequestError

_BARE = re.compile(r"[A-Za-z0-9_-]+")
# Sections that hold entries of one line each, in the order in which they are written.
_LAST = ("blocks", "outputs", "expect", "layout", "bodies", "slides", "drives", "sketch")


def plain(name: str, value: Any) -> Any:
    """A value as TOML has it: numbers of NumPy become Python's, arrays lists. Throws RequestError for NaN and others."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        if math.isnan(value):
            raise RequestError(f"{name}=nan is not a number", "a number")
        return float(value)
    if isinstance(value, str):
        return value
    if isinstance(value, np.ndarray):
        return plain(name, value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(f"{name}[{key!r}]", entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(name, entry) for entry in value]
    raise RequestError(f"{name}={shown(value)} has no place in a file", "a number, a text, a list or an array")


def key(name: str) -> str:
    return name if _BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def value_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key(name)} = {value_text(entry)}" for name, entry in value.items())
        return "{ " + inner + " }" if inner else "{}"
    return "[" + ", ".join(value_text(entry) for entry in value) + "]"


def document(data: Mapping[str, Any]) -> str:
    """A whole file: plain keys first, then sections of one line an entry."""
    lines = [f"{key(name)} = {value_text(value)}" for name, value in data.items() if not isinstance(value, Mapping)]
    sections = [name for name, value in data.items() if isinstance(value, Mapping)]
    sections.sort(key=lambda name: _LAST.index(name) if name in _LAST else -1)
    for section in sections:
        lines += ["", f"[{key(section)}]"]
        lines += [f"{key(name)} = {value_text(value)}" for name, value in data[section].items()]
    return "\n".join(lines) + "\n"

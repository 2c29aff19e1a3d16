# SPDX-License-Identifier: MIT
"""The checks of arguments: each gives the value as the library takes it, or throws a RequestError that names it."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional, Union

from . import _oblique
from ._errors import RequestError, UnknownNameError

Number = Union[int, float]
Quantity = Union[int, float, str]
"""A number in the unit that is documented, or a text with a unit: ``"20 ms"``, ``"2*pi"``."""
PathLike = Union[str, "os.PathLike[str]"]


def shown(value: object) -> str:
    """As it stands in a message, short."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"


def number_in(unit: str, kind: str = "a number") -> str:
    """What is expected: "a number above 0 [s]"."""
    if unit == "1":
        return kind
    return f"{kind} {unit}" if unit.startswith(("in ", "of ")) else f"{kind} [{unit}]"


def quantity(name: str, value: Any, unit: str) -> float:
    """A number, maybe infinite, never NaN."""
    if isinstance(value, str):
        return float(_oblique.quantity(name, value, unit))
    if isinstance(value, (bool, complex)) or getattr(value, "shape", ()) != ():
        raise RequestError(f"{name}={shown(value)} is no number", number_in(unit) + " or a text with a unit")
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise RequestError(f"{name}={shown(value)} is no number", number_in(unit) + " or a text with a unit") from None
    except OverflowError:
        raise RequestError(f"{name}={shown(value)} is too large", number_in(unit, "a number up to 1.8e308")) from None
    if math.isnan(number):
        raise RequestError(f"{name}=nan is not a number", number_in(unit))
    return number


def positive(name: str, value: Any, unit: str, *, finite: bool = True) -> float:
    number = quantity(name, value, unit)
    if number > 0 and (math.isfinite(number) or not finite):
        return number
    raise RequestError(f"{name}={shown(value)}", number_in(unit, "a finite number above 0" if finite else "a number above 0"))


def optional_positive(name: str, value: Any, unit: str, *, finite: bool = True) -> Optional[float]:
    return None if value is None else positive(name, value, unit, finite=finite)


def count(name: str, value: Any, least: int = 1, most: int = 1_000_000_000) -> int:
    number: Any = None
    if not isinstance(value, (bool, str)):
        try:
            number = int(value)
        except (TypeError, ValueError, OverflowError):
            number = None
    if number is None or number != value:
        raise RequestError(f"{name}={shown(value)} is no whole number", f"a whole number from {least} on")
    if not least <= number <= most:
        raise RequestError(f"{name}={shown(value)}", f"a whole number from {least} to {most}")
    return int(number)


def flag(name: str, value: Any) -> bool:
    """True or False, of Python or NumPy."""
    if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"):
        return bool(value)
    raise RequestError(f"{name}={shown(value)}", "True or False")


def choice(name: str, value: Any, known: Sequence[str]) -> str:
    if isinstance(value, str) and value in known:
        return value
    remedy = _oblique.suggest(value, list(known)) if isinstance(value, str) else ""
    raise RequestError(f"{name}={shown(value)}", " or ".join((", ".join(known[:-1]), known[-1])), remedy)


def text(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    raise RequestError(f"{name}={shown(value)} is no text", "a str")


def names(name: str, value: Any) -> list[str]:
    """One name, or several."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, Iterable):
        several = list(value)
        if all(isinstance(one, str) for one in several):
            return several
    raise RequestError(f"{name}={shown(value)} holds no names", "a name, or a list of names")


def numbers(name: str, value: Any, unit: str) -> list[float]:
    """Positive finite numbers, each once: one, a list, or an array of one dimension."""
    if isinstance(value, str) or not isinstance(value, Iterable):
        return [positive(name, value, unit)]
    shape = getattr(value, "shape", (0,))
    if len(shape) != 1:
        raise RequestError(f"{name} has the shape {shape}", "one dimension")
    found: list[float] = []
    for one in value:
        number = positive(name, one, unit)
        if number not in found:
            found.append(number)
    if not found:
        raise RequestError(f"{name} is empty", number_in(unit, "numbers above 0"))
    return found


def path(name: str, value: Any) -> str:
    try:
        found = os.fspath(value)
    except TypeError:
        raise RequestError(f"{name}={shown(value)} is no path", "a str or a pathlib.Path") from None
    return os.fsdecode(found)


def settings(name: str, value: Any) -> list[tuple[str, str]]:
    """Pots by their names: numbers in the unit of the parameter, or texts with a unit."""
    if value is None:
        return []
    if not isinstance(value, Mapping):
        raise RequestError(f"{name}={shown(value)} sets nothing", 'a dict, such as {"c.gain": 1e4}')
    return [(text(f"a name in {name}", pot), setting(f"{name}[{pot!r}]", to)) for pot, to in value.items()]


def setting(name: str, value: Any) -> str:
    """A value as a text that reads back to the same number."""
    return value if isinstance(value, str) else repr(quantity(name, value, "in the unit of the parameter"))


def unknown(what: str, name: Any, known: Sequence[str], of: str = "") -> UnknownNameError:
    remedy = _oblique.suggest(name, list(known)) if isinstance(name, str) else ""
    said = f"'{of}' has no {what} {shown(name)}" if of else f"there is no {what} {shown(name)}"
    return UnknownNameError(said, remedy=remedy)


def read(source: str) -> str:
    """The text of a file."""
    content: bytes = _oblique.read_file(source)
    return content.decode("utf-8", "surrogateescape")

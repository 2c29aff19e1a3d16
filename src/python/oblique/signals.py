# SPDX-License-Identifier: MIT
"""Signals of a diagram that is built: they are added, weighted and multiplied like numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _arguments
from ._errors import RequestError, UnknownNameError

if TYPE_CHECKING:
    from .diagram import Diagram

_FUNCTIONS: dict[Any, str] = {
    np.sin: "sine", np.cos: "cosine", np.exp: "exponential", np.log: "logarithm", np.sqrt: "square-root",
    np.absolute: "absolute-value", np.sign: "sign", np.arctan: "arc-tangent", np.square: "squarer",
    np.maximum: "maximum", np.minimum: "minimum"}
_OPERATORS: dict[Any, Callable[[Any, Any], Any]] = {
    np.add: lambda a, b: a + b, np.subtract: lambda a, b: a - b, np.multiply: lambda a, b: a * b,
    np.divide: lambda a, b: a / b, np.power: lambda a, b: a ** b}


class UnknownBlockError(UnknownNameError, AttributeError):
    """A block type that there is not."""


class Sum:
    """Weighted signals and a constant [machine unit]: what a wire carries. It makes no block until it is wired to an
    input that takes one signal."""

    __slots__ = ("diagram", "terms", "constant")

    def __init__(self, diagram: "Diagram", terms: Mapping[str, float], constant: float) -> None:
        self.diagram = diagram
        self.terms = dict(terms)
        self.constant = constant

    @staticmethod
    def of(diagram: "Diagram", what: str, value: Any) -> "Sum":
        """A signal, a sum or a number as a sum. Throws RequestError."""
        if isinstance(value, Sum):
            if value.diagram is not diagram:
                raise RequestError(f"{what}: the signal is of another diagram", "signals of one diagram")
            return value
        if isinstance(value, str):
            return Sum.of_text(diagram, value)
        number = _arguments.quantity(what, value, "machine unit")
        return Sum(diagram, {}, number)

    @staticmethod
    def of_text(diagram: "Diagram", text: str) -> "Sum":
        """"-2*x", as a file has it."""
        weight, times, signal = text.strip().rpartition("*")
        sign = 1.0
        if not times and signal.startswith(("-", "+")):
            sign, signal = (-1.0 if signal[0] == "-" else 1.0), signal[1:]
        factor = _arguments.quantity("the weight of a signal", weight.strip(), "1") if times else 1.0
        diagram.signal(signal.strip().partition(".")[0])
        return Sum(diagram, {signal.strip(): sign * factor}, 0.0)

    def with_constant(self) -> "Sum":
        """The same, with the constant as a signal: the reference of 1 machine unit."""
        if self.constant == 0:
            return self
        terms = dict(self.terms)
        one = self.diagram._reference().name
        terms[one] = terms.get(one, 0.0) + self.constant
        return Sum(self.diagram, terms, 0.0)

    # --- operators

    def _with(self, other: Any, sign: float) -> "Sum":
        added = Sum.of(self.diagram, "a signal and what is added to it", other)
        terms = dict(self.terms)
        for name, weight in added.terms.items():
            terms[name] = terms.get(name, 0.0) + sign * weight
        return Sum(self.diagram, terms, self.constant + sign * added.constant)

    def _scaled(self, factor: float) -> "Sum":
        return Sum(self.diagram, {name: factor * weight for name, weight in self.terms.items()},
                   factor * self.constant)

    def _block(self, type: str, *operands: Any) -> "Sum":
        """A block of one output; weights of factors go before its output."""
        return self.diagram.block(type, *operands)

    def __add__(self, other: Any) -> "Sum":
        return self._with(other, 1.0)

    def __radd__(self, other: Any) -> "Sum":
        return self._with(other, 1.0)

    def __sub__(self, other: Any) -> "Sum":
        return self._with(other, -1.0)

    def __rsub__(self, other: Any) -> "Sum":
        return (-self)._with(other, 1.0)

    def __neg__(self) -> "Sum":
        return self._scaled(-1.0)

    def __pos__(self) -> "Sum":
        return self

    def __mul__(self, other: Any) -> "Sum":
        if not isinstance(other, Sum):
            return self._scaled(_arguments.quantity("a factor of a signal", other, "1"))
        if other.diagram is not self.diagram:
            raise RequestError("a product of signals of two diagrams", "signals of one diagram")
        for factor, rest in ((self, other), (other, self)):
            if not factor.terms:
                return rest._scaled(factor.constant)
        (a, first), (b, second) = self._single(), other._single()
        product = self._block("squarer", a) if a.terms == b.terms else self._block("multiplier", a, b)
        return product._scaled(first * second) if first * second != 1 else product

    def _single(self) -> tuple["Sum", float]:
        """A single signal, and what it is weighted with."""
        one = self.diagram._as_one("a factor", self)
        (name, weight), = one.terms.items()
        return Sum(self.diagram, {name: 1.0}, 0.0), weight

    def __rmul__(self, other: Any) -> "Sum":
        return self.__mul__(other)

    def __truediv__(self, other: Any) -> "Sum":
        if not isinstance(other, Sum):
            divisor = _arguments.quantity("a divisor of a signal", other, "1")
            if divisor == 0:
                raise RequestError("a signal is divided by 0", "another divisor")
            return self._scaled(1 / divisor)
        return self._block("divider", self, other)

    def __rtruediv__(self, other: Any) -> "Sum":
        return Sum.of(self.diagram, "a dividend", other) / self

    def __pow__(self, exponent: float) -> "Sum":
        if exponent == 0.5:
            return self._block("square-root", self)
        power = _arguments.count("the exponent of a signal", exponent, 1, 16)
        if power == 1:
            return self
        half = self ** (power // 2)
        squared: Sum = half * half
        return squared * self if power % 2 else squared

    def __abs__(self) -> "Sum":
        return self._block("absolute-value", self)

    def __gt__(self, other: Any) -> "Sum":
        """A comparator: 1 where it is greater, 0 where not."""
        return self._block("comparator", self - other)

    def __lt__(self, other: Any) -> "Sum":
        return self._block("comparator", (-self) + other)

    def __bool__(self) -> bool:
        raise RequestError("a signal has no truth value: it has another value at each moment", "a value of a run")

    def __float__(self) -> float:
        raise RequestError("a signal is no number: it has another value at each moment", "a value of a run")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        """Functions of NumPy are blocks: np.sin(x)."""
        if method != "__call__" or options:
            return NotImplemented
        if any(getattr(one, "shape", ()) != () for one in inputs):
            raise RequestError(f"np.{ufunc.__name__} of a signal and an array", "signals and single numbers")
        if ufunc in _FUNCTIONS:
            operands = [Sum.of(self.diagram, f"np.{ufunc.__name__}", one) for one in inputs]
            return self._block(_FUNCTIONS[ufunc], *operands)
        if ufunc is np.negative:
            return -self
        if ufunc in _OPERATORS:
            return _OPERATORS[ufunc](*(one if isinstance(one, Sum) else float(one) for one in inputs))
        known = ", ".join(sorted(f"np.{one.__name__}" for one in _FUNCTIONS))
        raise RequestError(f"no block is np.{ufunc.__name__}", f"one of {known}")

    def __repr__(self) -> str:
        parts = [term_text(name, weight) for name, weight in self.terms.items()]
        if self.constant or not parts:
            parts.append(repr(self.constant))
        return f"<{' + '.join(parts)}>"


class Signal(Sum):
    """The output of a block. `signal["cos"]` is another output of it; `signal.input = …` wires its first input, and
    `signal.wire(port=…)` any."""

    __slots__ = ("block", "name")

    def __init__(self, diagram: "Diagram", block: str, port: Optional[str] = None) -> None:
        self.block = block
        """The name of the block."""
        self.name = block if port is None else f"{block}.{port}"
        """The name of the signal in the file."""
        super().__init__(diagram, {self.name: 1.0}, 0.0)

    def __getitem__(self, port: str) -> "Signal":
        outputs = [one.name for one in self.diagram._blocks[self.diagram._type_of(self.block)].outputs]
        if port not in outputs:
            raise _arguments.unknown("output", port, outputs, self.block)
        return Signal(self.diagram, self.block, port if len(outputs) > 1 else None)

    @property
    def input(self) -> Any:
        """What its first input is wired to, as the file has it."""
        type = self.diagram._type_of(self.block)
        data = self.diagram._data or {}
        return data.get("blocks", {}).get(self.block, {}).get(self.diagram._blocks[type].inputs[0].name)

    @input.setter
    def input(self, value: "Union[Wire, Sequence[Wire]]") -> None:
        self.diagram.set_input(self, value)

    def wire(self, **inputs: "Union[Wire, Sequence[Wire]]") -> None:
        """Wires inputs by their names; `in_` stands for `in`."""
        for port, value in inputs.items():
            self.diagram.set_input(self, value, port[:-1] if port.endswith("_") else port)


Wire = Union[Sum, str, int, float]
"""What an input takes: a signal, a sum of signals, a number, or a text as in a file."""


def term_text(signal: str, weight: float) -> str:
    if weight == 1:
        return signal
    return f"-{signal}" if weight == -1 else f"{weight!r}*{signal}"


def wire_text(one: Sum) -> str:
    (name, weight), = one.terms.items()
    return term_text(name, weight)


def wired_terms(diagram: "Diagram", what: str, value: Any) -> list[str]:
    """The terms of a summing input, as the file has them."""
    total = Sum.of(diagram, what, value).with_constant()
    return [term_text(name, weight) for name, weight in total.terms.items()]

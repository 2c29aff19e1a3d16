#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Solves the problems of this folder without Oblique and prints what their [expect] ought to say; so too those of
../findings for which there is a function of their name.

By hand, with Debian's python3-scipy and python3-mpmath:  python3 solutions.py [--growth] [NAME…]

A line that does not agree with the diagram is marked; the status is then 1. The truths are closed forms, mpmath, or
SciPy's integrators at a relative tolerance of 1e-12 whose events are handled by hand (truth/tools.py).

How `within` was chosen, before any run: a run sums the errors of some hundred to some ten thousand steps, each below
its tolerance, so 1000 times the tolerance times the size of the signal, and where a deviation grows on its way, times
that growth (which --growth prints for the problems without events); the comment of the diagram says so where it is
another number. Counts must be right.
"""
import inspect
import pathlib
import sys
import tomllib

sys.dont_write_bytecode = True

from truth import (arrivals, beginnings, beside, big, contacts, edges, hysteresis, impacts, implicit, late, loops,
                   mechanics, operation, pulses, regulators, seeds, shapes, slides, smooth, stiff, stores, switching)
from truth.tools import latest_growth


def problems():
    for module in (late, pulses, switching, hysteresis, mechanics, smooth, stiff, big, operation, arrivals, stores,
                   loops, impacts, slides, implicit, seeds, shapes, beginnings, regulators, contacts, edges, beside):
        for name, function in list(vars(module).items()):
            if inspect.isfunction(function) and function.__module__ == module.__name__ and not name.startswith("_"):
                yield name, function


def main(arguments):
    wanted = [argument for argument in arguments if argument != "--growth"]
    folder = pathlib.Path(__file__).parent
    disagreements = 0
    for name, function in problems():
        if wanted and name not in wanted:
            continue
        paths = [path for path in (folder / f"{name}.toml", folder.parent / f"findings/{name}.toml") if path.exists()]
        written = tomllib.loads(paths[0].read_text(encoding="utf-8"))["expect"] if paths else {}
        print(name)
        for key, value in function().items():
            line = written.get(key)
            # A tenth of `within`: the constants of the diagrams are rounded, and SciPy's versions differ.
            agrees = not written or line and abs(line["value"] - value) <= 0.1 * line["within"]
            disagreements += not agrees
            print(f"  {key!r}: {value!r}{'' if agrees else '   <-- not in the diagram'}")
        if "--growth" in arguments and (growth := latest_growth()) is not None:
            print(f"  growth of a deviation of the start until the end: {growth:.3g}")
    return 1 if disagreements else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

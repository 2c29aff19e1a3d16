# SPDX-License-Identifier: MIT
"""Oblique: an analog computer in software, from Python.

>>> import oblique as ob
>>> run = ob.Diagram("diagrams/lessons/triangle-side.toml").run()
>>> print(f"{run['side'].max():.4f} {run.units['side']}")
0.7000 m

`Diagram` runs, checks and draws block diagrams, and builds them; `Mechanism` solves plane linkages exactly, patches them
into diagrams and compares the two; `Console` is a machine that one holds; `blocks` and `machines` are the libraries. All
that goes wrong is an `Error`. docs/python.md is the page about it.
"""

try:
    from . import _oblique
except ImportError as error:
    import sys
    _found = "" if "cannot import name" in str(error) else f": {error}"
    raise ImportError(
        f"the compiled part of oblique is not for this Python ({sys.version.split()[0]}, {sys.executable}){_found}\n"
        "  remedy: use the Python that it was built with (./bootstrap python: /usr/bin/python3), or build it for this "
        "one: pip install .") from error

from . import plots
from ._errors import (ConsoleError, Diagnostic, DiagramError, Error, MechanismError, NetworkError, PatchError, PlanError,
                      ReadError, RealiseError, RequestError, RunWarning, SolveError, SynthesisError, UnknownNameError)
from ._oblique import __version__
from ._tables import Table
from ._blocks import Block, BlockLibrary, blocks
from .comparison import ComparedRun, Comparison, MonteCarlo, Yield
from .console import Console, Probe, Reading, Trace
from .diagram import Diagram, DiagramCheck
from .ensemble import EnsembleRun, Interrupted, Plan, sweep
from ._machines import Machine, machines
from .mechanism import Fit, Mechanism, MechanismCheck, Patch
from .motion import Motion
from .pictures import Animation, Page, Picture
from .run import Event, Overload, Run, State, Trust
from .signals import Signal, Sum

__all__ = [
    "Animation", "Block", "BlockLibrary", "ComparedRun", "Comparison", "Console", "ConsoleError", "Diagnostic", "Diagram",
    "DiagramCheck", "DiagramError", "EnsembleRun", "Error", "Event", "Fit", "Interrupted", "Machine", "Mechanism",
    "MechanismCheck", "MechanismError", "MonteCarlo", "Motion", "NetworkError", "Overload", "Page", "Patch", "PatchError",
    "Picture", "Plan", "PlanError", "Probe", "ReadError", "Reading", "RealiseError", "RequestError", "Run", "RunWarning",
    "Signal", "SolveError", "State", "Sum", "SynthesisError", "Table", "Trace", "Trust", "UnknownNameError", "Yield",
    "__version__", "blocks", "machines", "plots", "sweep"]

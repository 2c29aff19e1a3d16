# SPDX-License-Identifier: MIT
"""Integration with events by hand, and extremes."""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

RTOL, ATOL = 1e-12, 1e-15


class Motion:
    """Pieces of dense output, one after the other."""

    def __init__(self, y):
        self.pieces = []
        self.events = []  # (time, what) of every change of mode
        self.y = np.array(y, dtype=float)
        self.t = 0.0

    def go(self, f, until, guards=(), method="DOP853", max_step=np.inf, **options):
        """Integrates to `until` or to the first guard (g(t, y), direction); its index, or None at the end."""
        functions = []
        for g, direction in guards:
            function = (lambda g: lambda t, y: g(t, y))(g)
            function.terminal, function.direction = True, direction
            functions.append(function)
        if until <= self.t:
            return None
        part = solve_ivp(f, (self.t, until), self.y, method=method, rtol=RTOL, atol=options.pop("atol", ATOL),
                         dense_output=True, events=functions or None, max_step=max_step, **options)
        assert part.success, part.message
        self.pieces.append((self.t, part.t[-1], part.sol))
        self.t, self.y = part.t[-1], part.y[:, -1].copy()
        if part.status == 1:
            hit = [i for i, times in enumerate(part.t_events) if len(times)][0]
            self.events.append((self.t, hit))
            return hit
        return None

    def __call__(self, t):
        for begin, end, sol in self.pieces:
            if begin <= t <= end:
                return sol(t)
        raise ValueError(t)

    def largest(self, what, samples=400):
        """Greatest value of what(t, y) over the whole motion."""
        best = -np.inf
        for begin, end, sol in self.pieces:
            times = np.linspace(begin, end, samples)
            values = [what(t, sol(t)) for t in times]
            k = int(np.argmax(values))
            low, high = times[max(k - 1, 0)], times[min(k + 1, samples - 1)]
            best = max(best, max(values))
            if high > low:
                found = minimize_scalar(lambda t: -what(t, sol(t)), bounds=(low, high), method="bounded",
                                        options={"xatol": 1e-12})
                best = max(best, -found.fun)
        return best


_latest = {}  # what `ode` was last asked for


def ode(f, y, until, method="DOP853", breaks=(), **options):
    """A motion without events; `breaks` are the times at which f jumps."""
    _latest.update(f=f, y=y, until=until, method=method, breaks=breaks, **options)
    motion = Motion(y)
    for end in [*breaks, until]:
        motion.go(f, end, method=method, **options)
    return motion


def latest_growth(deviation=1e-8):
    """How much larger a deviation of the start of the latest `ode` is at its end, at most over the coordinates; None
    where there was none."""
    if not _latest:
        return None
    problem = dict(_latest)
    start, until = np.array(problem["y"], dtype=float), problem["until"]
    plain = ode(**problem)(until)
    worst = 0.0
    for k in range(len(start)):
        problem["y"] = start.copy()
        problem["y"][k] += deviation
        worst = max(worst, np.abs(ode(**problem)(until) - plain).max() / deviation)
    _latest.clear()
    return worst

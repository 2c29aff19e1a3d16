# SPDX-License-Identifier: MIT
"""What has no value beyond the edge of its branch, and a power by squarers."""
import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.special import gammaln

from .tools import Motion


def hixson_crowell():
    return {"m at 1.5": 0.5**3, "m at 6": 0.0}


def hertz_contact():
    """Flight and contact in turns."""
    flight = lambda t, y: [y[1], -1]
    contact = lambda t, y: [y[1], -1 + 1e5 * max(-y[0], 0)**1.5]
    height = lambda t, y: y[0]
    motion = Motion([1, 0])
    inside = False
    while motion.go(contact if inside else flight, 12, [(height, 1 if inside else -1)]) is not None:
        inside = not inside
    return {f"{name} at {t}": motion(t)[i] for t in (3, 12) for i, name in enumerate("xv")}


def chapman_ozone():
    """By days and nights."""
    def rates(t):
        sun = np.sin(np.pi / 43200 * t)
        return (np.exp(-22.62 / sun), np.exp(-7.601 / sun)) if sun > 0 else (0.0, 0.0)

    def f(t, y):
        k3, k4 = rates(t)
        return [-6.031 * y[0] - 4.66e-4 * y[0] * y[1] + 7.4e10 * k3 + 1e6 * k4 * y[1],
                6.031e-6 * y[0] - 4.66e-10 * y[0] * y[1] - k4 * y[1]]

    parts, y = [], [1.0, 1.0]
    for k in range(4):
        parts.append(solve_ivp(f, (43200 * k, 43200 * (k + 1)), y, method="Radau", rtol=1e-11, atol=1e-16, max_step=300,
                               dense_output=True).sol)
        y = parts[-1](43200 * (k + 1))
    return {"y2 at 21600": parts[0](21600)[1], "y1 at 21600": parts[0](21600)[0], "y1 at 64800": parts[1](64800)[0],
            "y2 at 172800": y[1]}


def reservoir_that_dries():
    fill = lambda s: solve_ivp(lambda t, y: [1 - max(y[0], 0)**0.6], (0, 1), [s], method="Radau", rtol=1e-12, atol=1e-15,
                               dense_output=True).sol
    drain = lambda s, t: max(s**0.4 - 0.4 * t, 0)**2.5
    full = fill(0)
    assert drain(full(1)[0], 4) == 0
    return {"S at 1": full(1)[0], "S at 2": drain(full(1)[0], 1), "S at 4": drain(full(1)[0], 3),
            "S at 35.5": full(0.5)[0]}


def root_drag():
    return {"v at 1": 0.25, "v at 5": 0.0}


def edges_of_branches():
    """Four turns and three quarters and what is left of the next half, over which each half turn is mirrored."""
    def integral(f, until):
        bounds = [0, np.arcsin(1 / 1.5), np.pi / 2, np.pi - np.arcsin(1 / 1.5), np.pi]
        bounds = [b for b in bounds if b < until] + [until]
        return sum(quad(f, a, b, epsabs=1e-14, epsrel=1e-13, limit=400)[0] for a, b in zip(bounds, bounds[1:]))

    angle = lambda sign: lambda t: np.arccos(np.clip(sign * 1.5 * np.sin(t), -1, 1))
    left = 31 - 9 * np.pi  # in the half turn after nine of them, where the sine is below zero
    of_angle = 5 * integral(angle(1), np.pi) + 4 * integral(angle(-1), np.pi) + integral(angle(-1), left)
    half = lambda f: 5 * integral(lambda t: f(np.sin(t)) if 0 < np.sin(t) else 0.0, np.pi)
    return {"a at 31": of_angle, "e at 31": half(lambda s: s * np.log(s)), "r at 31": half(lambda s: np.sin(s) / s),
            "l at 31": half(lambda s: np.exp(-1 / s)), "p at 31": half(lambda s: s**0.3)}


def pulses_by_sixteen_squarers():
    n = 2.0**15
    return {"s at 100": 31.5 * np.sqrt(np.pi) * np.exp(gammaln(n + 0.5) - gammaln(n + 1))}

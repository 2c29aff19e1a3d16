# SPDX-License-Identifier: MIT
"""Contacts: friction in a row, play with stiff flanks."""
import numpy as np
from scipy.optimize import brentq

from .mechanics import _friction
from .tools import Motion


def block_on_block():
    """A block of 0.8 on one of 1.5 on a rough floor, pushed and held by a spring: both frictions may stick."""
    push = lambda t, x: 1.3 * np.sin(0.9 * t) + 0.4 * np.sin(2.3 * t) - 1.1 * x
    motion = _friction([0, 0, 0.3, 0], 30,
                       lambda t, y, q: [(push(t, y[2]) + q[0] - q[1]) / 1.5, q[1] / 0.8, y[0], y[1]],
                       lambda y: np.array([y[0], y[1] - y[0]]), [lambda w: 0.5, lambda w: 0.24])
    return {f"x{k} at {t}": motion(t)[1 + k] for t in (5, 12, 20, 30) for k in (1, 2)}


def drill_string():
    """φ′ = Ω − w, w′ = φ/2 + 0.1 (Ω − w) − friction, which falls from 1 to 0.4 with the speed; Ω = 0.3 + 0.02 t."""
    drive = lambda t: 0.3 + 0.02 * t
    motion = _friction([0, 0], 40, lambda t, y, q: [drive(t) - y[1], 0.5 * y[0] + 0.1 * (drive(t) - y[1]) + q[0]],
                       lambda y: y[1:2], [lambda w: 0.4 + 0.6 * np.exp(-2 * w)])
    return {"phi at 10": motion(10)[0], "phi at 40": motion(40)[0], "w at 40": motion(40)[1]}


def stiff_backlash():
    """Two masses and a play of ±0.05 between flanks of 4000: from one contact to the next."""
    motion, contact = Motion([0, 0, 0, 0]), 0
    off = lambda y: y[0] - y[2]

    def rates(t, y):
        force = 4000 * (off(y) - 0.05 * contact) if contact else 0.0
        return [y[1], np.sin(2 * t) - force - 0.1 * y[1], y[3], 2 * (force - 0.3 * y[3])]

    while motion.t < 6:
        if contact:
            leaves = motion.go(rates, 6, [(lambda t, y: contact * off(y) - 0.05, -1)], max_step=0.005)
            contact = contact if leaves is None else 0
        else:
            hit = motion.go(rates, 6, [(lambda t, y: off(y) - 0.05, 1), (lambda t, y: off(y) + 0.05, -1)],
                            max_step=0.005)
            contact = (1, -1)[hit] if hit is not None else 0
    return {"x1 at 2": motion(2)[0], "x2 at 6": motion(6)[2], "v2 at 6": motion(6)[3]}


def shaken_for_long():
    """v = v0 + 5 (cos 2πt0 − cos 2πt)/2π ∓ (t − t0) from one zero of v to the next; stuck while |5 sin 2πt| < 1."""
    w = 2 * np.pi
    t, v, x, sign = np.arcsin(0.2) / w, 0.0, 0.0, 1
    while True:
        speed = lambda s: v + 5 * (np.cos(w * t) - np.cos(w * s)) / w - sign * (s - t)
        way = lambda s: ((v + 5 * np.cos(w * t) / w) * (s - t) - 5 * (np.sin(w * s) - np.sin(w * t)) / w**2
                         - sign * (s - t)**2 / 2)
        places = t + np.linspace(1e-6, 1, 2001)
        after = next(k for k, s in enumerate(places) if sign * speed(s) < 0)
        end = brentq(speed, places[after - 1], places[after], xtol=1e-15)
        if end > 1000:
            return {"v at 1000": speed(1000), "x at 1000": x + way(1000)}
        x += way(end)
        t, v, sign = end, 0.0, -sign
        assert abs(5 * np.sin(w * t)) > 1 and sign * np.sin(w * t) > 0  # it does not stick again


def stuck_for_long():
    return {"x at 100": 0.0003, "v at 100": 0.0}

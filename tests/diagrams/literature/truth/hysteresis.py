# SPDX-License-Identifier: MIT
"""Hysteresis, friction in a row, sliding that ends, switching that comes to rest."""
import numpy as np
from scipy.optimize import brentq

from .mechanics import _friction
from .tools import Motion, ode


def leaving_a_sliding_mode():
    """x′ = 1.6 sin t − sign x: it slides where |1.6 sin t| ≤ 1 and leaves beyond. Integrals of u, and of u² =
    1."""
    motion = _friction([0.3, 0, 0], 20, lambda t, y, q: [1.6 * np.sin(t) + q[0], -q[0], 1], lambda y: y[0:1],
                       [lambda w: 1.0])
    return {"x at 2": motion(2)[0], "x at 5": motion(5)[0], "x at 20": motion(20)[0],
            "mean at 20": motion(20)[1], "square at 20": 20.0}


def burridge_knopoff_three():
    """Three blocks on springs between a plate that moves at 0.1 and a rough floor (R. Burridge and L. Knopoff
    1967)."""
    def rates(t, y, q):
        x, v = y[:3], y[3:]
        pull = 0.1 * t - x
        chain = np.array([x[1] - x[0], x[0] - 2 * x[1] + x[2], x[1] - x[2]])
        return [*v, *(pull + 1.5 * chain + q)]

    size = lambda top: lambda w: 0.5 * top + 0.5 * top * np.exp(-2 * w)
    motion = _friction([0, 0.05, -0.05, 0, 0, 0], 40, rates, lambda y: y[3:],
                       [size(0.5), size(0.55), size(0.6)])
    return {"x1 at 20": motion(20)[0], "x2 at 20": motion(20)[1], "x3 at 40": motion(40)[2],
            "x1 at 40": motion(40)[0]}


def elastoplastic_oscillator():
    """W. D. Iwan 1966: x″ + 0.2 x + 0.8 z = 1.2 cos 0.9t, z′ = x′ while |z| < 0.5 or coming back."""
    motion, part = Motion([0, 0, 0]), 0
    f = lambda part: lambda t, y: [y[1], 1.2 * np.cos(0.9 * t) - 0.2 * y[0] - 0.8 * y[2], 0.0 if part else y[1]]
    while motion.t < 30:
        if part:
            hit = motion.go(f(part), 30, [(lambda t, y: part * y[1], -1)], max_step=0.1)
            part = 0
        else:
            hit = motion.go(f(0), 30, [(lambda t, y: y[2] - 0.5, 1), (lambda t, y: y[2] + 0.5, -1)],
                            max_step=0.1)
            part = (1, -1)[hit] if hit is not None else 0
            if part:
                motion.y[2] = 0.5 * part
        if hit is None:
            break
    return {"x at 10": motion(10)[0], "x at 30": motion(30)[0], "z at 30": motion(30)[2]}


def bouc_wen():
    """R. Bouc 1967, Y. K. Wen 1976: z′ = v − 0.5 |v| z − 0.3 v |z|; from one corner to the next."""
    motion = Motion([0, 0.2, 0])

    def f(sv, sz):
        return lambda t, y: [y[1], 0.8 * np.sin(0.7 * t) - 0.1 * y[1] - 0.3 * y[0] - 0.7 * y[2],
                             y[1] - 0.5 * sv * y[1] * y[2] - 0.3 * y[1] * sz * y[2]]

    sv = sz = 1
    while motion.t < 30:
        hit = motion.go(f(sv, sz), 30,
                        [(lambda t, y: sv * y[1] + 1e-13, -1),
                         (lambda t, y: sz * y[2] + 1e-13, -1)], max_step=0.1)
        if hit is None:
            break
        sv, sz = (-sv, sz) if hit == 0 else (sv, -sz)
    return {"x at 10": motion(10)[0], "x at 30": motion(30)[0], "z at 30": motion(30)[2]}


def twisting_controller():
    """x″ = −2 sign x − sign v from (1, 0): each half turn leaves a third; at rest after 4/3 √2/(1 − 1/√3)."""
    end = 4 / 3 * np.sqrt(2) / (1 - 1 / np.sqrt(3))
    assert end < 4.5
    # First a = −1 to x = 0 at √2, then a = 3 to rest in x = −1/3 at 4/3 √2; from there a = 1 until x = 0,
    # √(2/3) later.
    t = 2.9 - np.sqrt(2) * 4 / 3 - np.sqrt(2 / 3)
    assert 0 < t < np.sqrt(2 / 3) / 3
    return {"x at 1": 0.5, "x at 2.9": np.sqrt(2 / 3) * t - 1.5 * t * t, "x at 6": 0.0, "v at 6": 0.0}


def andronov_clock():
    """A clock with dry friction and a blow of 0.2 at each rise through zero (A. A. Andronov 1937): half turns
    of circles."""
    motion, blows = Motion([0.3, 0]), 0
    rates = lambda side: lambda t, y: [y[1], -y[0] - 0.02 * side]
    top, bottom, middle = (lambda t, y: y[1], -1), (lambda t, y: y[1], 1), (lambda t, y: y[0], 1)
    motion.go(rates(-1), 60, [bottom], max_step=0.05)
    motion.go(rates(1), 60, [middle], max_step=0.05)
    while True:
        motion.y = np.array([0, motion.y[1] + 0.2])
        blows += 1
        for side, guard in ((1, top), (-1, bottom), (1, middle)):
            if motion.go(rates(side), 60, [guard], max_step=0.05) is None:
                return {"x at 20": motion(20)[0], "x at 60": motion(60)[0], "v at 60": motion(60)[1],
                        "blows at 60": float(blows)}


def pursuit_curve():
    """P. Bouguer 1732: a dog from (1, 0) runs at speed 1.2 at a hare that runs from (0, 0) upwards at speed
    1."""
    def f(t, y):
        dx, dy = -y[0], t - y[1]
        r = np.hypot(dx, dy)
        return [1.2 * dx / r, 1.2 * dy / r]

    motion = ode(f, [1, 0], 2.7)  # caught at 1.2/0.44 = 2.727
    return {"x at 1": motion(1)[0], "y at 2": motion(2)[1], "x at 2.7": motion(2.7)[0],
            "y at 2.7": motion(2.7)[1]}


def half_wave_rectifier():
    """sin t until v′ = −v/10, then a decay until the sine is as high."""
    off = np.pi - np.arctan(10)

    def v(t):
        n = np.floor((t - off) / (2 * np.pi))
        if n < 0:
            return np.sin(t)
        begin = off + 2 * np.pi * n
        decay = lambda at: np.sin(off) * np.exp(-0.1 * (at - begin))
        on = brentq(lambda at: np.sin(at) - decay(at), begin + 1.5 * np.pi - off, begin + 2 * np.pi)
        return decay(t) if t < on else np.sin(t)

    return {f"v at {t:g}": v(t) for t in (5, 8.5, 10, 15, 29)}


def prandtl_ishlinskii():
    """The play operator from one turning point of e^(−t/20) sin t to the next."""
    u = lambda t: np.exp(-t / 20) * np.sin(t)
    turns = np.arctan(20) + np.pi * np.arange(4)

    def w(t):
        out = np.zeros(3)
        for at in [*turns[turns < t], t]:
            out = np.clip(out, u(at) - np.array([0.1, 0.25, 0.4]), u(at) + np.array([0.1, 0.25, 0.4]))
        return out.sum()

    return {f"w at {t:g}": w(t) for t in (1, 2, 4, 6, 9.5)}


def slope_by_a_fast_lag():
    """cos t < 0 from π/2 to 3π/2 in each turn."""
    falling = lambda t: np.pi * (t // (2 * np.pi)) + np.clip(t % (2 * np.pi) - np.pi / 2, 0, np.pi)
    return {"n at 39": 6.0, "falling at 20": falling(20), "falling at 40": falling(40)}

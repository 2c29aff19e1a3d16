# SPDX-License-Identifier: MIT
"""Equations that ideal amplifiers solve: folds, quotients at 0/0, roots at their ends."""
import mpmath
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from .tools import Motion, ode


def torricelli_cascade():
    """√h1 = 1 − t/2 until t = 2; h2′ = √h1 − √h2, and when h1 is dry √h2 falls by 1/2 a second."""
    left = ode(lambda t, y: [1 - t / 2 - np.sqrt(y[0])], [0.5], 2)(2)[0]
    return {"h1 at 1": 0.25, "h1 at 2.5": 0.0, "h2 at 2": left, "h2 at 2.5": (np.sqrt(left) - 0.25)**2, "h2 at 5": 0.0}


def relaxation_singular():
    """x′ = −y on y³/3 − y = x: from y = 2 the time is 2 − y²/2 − ln(2/y), until the fold at 1, from where it jumps to
    −2."""
    half = 1.5 - np.log(2)

    def y(t):
        k, rest = divmod(t, half)
        return (-1)**k * brentq(lambda v: 2 - v * v / 2 - np.log(2 / v) - rest, 1, 2, xtol=1e-15)

    out = {}
    for t in (1, 10, 100):
        out |= {f"y at {t}": y(t), f"x at {t}": y(t)**3 / 3 - y(t)}
    return out | {"n at 100": float(np.floor(100 / (2 * half)))}


def fold_by_a_limiter():
    """v − 2 clip v = i, i′ = −v: v = ∓3 e^(−t) down to ∓1 in ln 3, then to the other side; every other jump is a
    rise."""
    def v(t):
        k, rest = divmod(t, np.log(3))
        return -(-1)**k * 3 * np.exp(-rest)

    jumps = 20 // np.log(3)
    return {"v at 1": v(1), "v at 10": v(10), "v at 20": v(20), "n at 20": (jumps + 1) // 2}


def eccles_jordan():
    """a = clip(s − 3b), b = clip(−s − 3a), s = 3.5 cos t: a falls where s falls below −2, and b = −a; it rises where
    s rises above 2."""
    down, up = np.arccos(-2 / 3.5), 2 * np.pi - np.arccos(2 / 3.5)
    a = lambda t: -1.0 if down < t < up else 1.0
    return {"a at 2.17": a(2.17), "a at 2.19": a(2.19), "b at 2.19": -a(2.19), "a at 5.31": a(5.31),
            "a at 5.33": a(5.33)}


def two_amplifiers_to_a_fold():
    """x (1 − x) = p, p = 0.05 + 0.02 t, the smaller root."""
    x = lambda t: (1 - np.sqrt(0.8 - 0.08 * t)) / 2
    return {"x at 5": x(5), "x at 9.9": x(9.9)}


def schlogl_hysteresis():
    """x′ = 100 (3x − 4x³ + 1.5 sin 0.01t) and the integral of 0.01 x; LSODA is exact where a part of it ends."""
    motion = ode(lambda t, y: [100 * (3 * y[0] - 4 * y[0]**3 + 1.5 * np.sin(0.01 * t)), 0.01 * y[0]],
                 [-np.sqrt(0.75), 0], 1300, method="LSODA", atol=1e-13, breaks=(70, 200, 700))
    out = {}
    for t in (70, 200, 700, 1300):
        out |= {f"x at {t}": motion(t)[0], f"a at {t}": motion(t)[1]}
    return out


def sinc_through_zero():
    """t is 5 where x is 0."""
    return {"q at 5.5": np.sin(0.5) / 0.5, "q at 10": np.sin(5) / 5, "I at 10": float(2 * mpmath.si(5))}


def coulomb_wave():
    return {f"u at {r}": float(mpmath.coulombf(0, 1, r)) for r in (1, 5, 20)}


def lane_emden_three():
    """A. S. Eddington's star: y″ + 2 y′/ξ + y³ = 0, from its series (S. Chandrasekhar 1939) at ξ = 0.01; it ends at
    6.89685."""
    h = 0.01
    motion = Motion([1 - h**2 / 6 + h**4 / 40 - 19 * h**6 / 5040, -h / 3 + h**3 / 10 - 19 * h**5 / 840])
    motion.t = h
    f = lambda t, y: [y[1], -2 * y[1] / t - y[0]**3]
    motion.go(f, 6.8)
    out = {"y at 1": motion(1)[0], "y at 6.8": motion(6.8)[0], "v at 6.8": motion(6.8)[1]}
    motion.go(f, 7, [(lambda t, y: y[0], -1)])
    assert abs(motion.t - 6.89684862) < 1e-7
    return out


def pendulum_in_cartesian():
    """By the angle, from the side."""
    motion = ode(lambda t, y: [y[1], -9.81 * np.sin(y[0])], [np.pi / 2, 0], 20)
    out = {}
    for t in (1, 10, 20):
        out |= {f"x at {t}": np.sin(motion(t)[0]), f"y at {t}": -np.cos(motion(t)[0])}
    return out


def diode_clipper():
    """x − y = 2e-6 sinh 40y, x = 5 sin t."""
    y = lambda t: brentq(lambda y: 5 * np.sin(t) - y - 2e-6 * np.sinh(40 * y), -1, 1, xtol=1e-15)
    return {"y at 0.001": y(0.001), "y at 0.5*pi": y(np.pi / 2),
            "i at pi": quad(lambda t: y(t)**2, 0, np.pi, epsabs=1e-12, epsrel=1e-12, limit=400)[0]}


def hilbert_by_feedback():
    """D. Hilbert's matrix as the diagram says it, in doubles."""
    with mpmath.workdps(40):
        rows = [[mpmath.mpf(1 / (i + j + 1)) for j in range(4)] for i in range(4)]
        x = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix([mpmath.sin(2), mpmath.cos(2), 1, 0.5]))
        return {f"x{k} at 2": float(x[k]) for k in range(4)}


def root_of_a_distance():
    """d′ = −2 √d."""
    return {"d at 0.5": 0.25, "d at 0.8": (1 - 0.8)**2}


def root_of_a_rectified_sine():
    """∫ √cos from 0 to π/2 is B(3/4, 1/2)/2."""
    return {"r at 1": np.sqrt(np.cos(1)), "r at 4": 0.0, "i at 4": float(mpmath.beta(0.75, 0.5) / 2)}


def two_tanks_level_out():
    """d = h₁ − h₂: d′ = −2 √d, so √d = 1 − t until 1; from 2 on d′ = 0.1 − 2 √d, which comes to √d = 0.05 within
    e^(−40)."""
    d = 0.05**2
    return {"h1 at 0.5": 0.5 + 0.5**2 / 2, "h1 at 1.5": 0.5, "h2 at 1.5": 0.5, "h1 at 4": 0.6 + d / 2,
            "h2 at 4": 0.6 - d / 2}


def tank_runs_dry():
    """s = √h: 2 s s′ = q − 0.5 s, so s = 1 − t/4 at first; with q = 0.3 the time is −4 s − 2.4 ln(1 − s/0.6)."""
    s = brentq(lambda s: -4 * s - 2.4 * np.log1p(-s / 0.6) - 1, 0, 0.59, xtol=1e-16)
    return {"h at 2": 0.5**2, "h at 8": 0.0, "h at 11": s * s, "h at 12": (s - 0.25)**2, "h at 20": 0.0}


def tantalus_cup():
    """Filled at 0.1 up to 0.9; while the siphon runs, s = √h needs ∫ 2s/(0.1 − 0.5 s) ds, down to h = 0.1."""
    way = lambda s: -4 * s - 0.8 * np.log(0.5 * s - 0.1)
    high, low = np.sqrt(0.9), np.sqrt(0.1)
    drain = way(low) - way(high)
    n, rest = divmod(200 - 4, drain + 8)  # since it first was full; a round drains and fills
    assert rest < drain
    s = brentq(lambda s: way(s) - way(high) - rest, low, high, xtol=1e-15)
    return {"h at 200": s * s, "n at 200": n + 1}


def weak_acid_titration():
    def ph(t):
        balance = lambda p: 10**-p - 1e-14 * 10**p + 0.02 * t - 1.8e-7 / (1.8e-5 + 10**-p)
        return brentq(balance, 0, 14, xtol=1e-15)

    return {f"ph at {t}": ph(t) for t in (0.25, 0.5, 0.6, 1)} | {"hydrogen minimum": 10**-ph(1)}


def positive_root_of_a_sine():
    root = lambda b: (b + np.sqrt(b * b + 0.004)) / 2 if b > 0 else 0.002 / (np.sqrt(b * b + 0.004) - b)
    return {f"x at {t}": root(3 * np.sin(5 * t)) for t in (0.9, 2.2, 10)} | {"x minimum": root(-3)}


def shortest_path_by_minima():
    first, second = lambda t: 1 + 0.9 * np.sin(t), lambda t: 1.2 + 0.8 * np.cos(1.7 * t)
    d1, d2 = lambda t: min(first(t), 0.2 + second(t)), lambda t: min(second(t), 0.2 + first(t))
    return {"d1 at 2": d1(2), "d2 at 2": d2(2), "d1 at 11": d1(11), "d2 at 17.3": d2(17.3)}


def turbulent_pipe_by_an_amplifier():
    def q(t):
        p = 2 * np.cos(t)
        return np.sign(p) * (np.sqrt(1 + 4 * abs(p)) - 1) / 2

    zeros = [np.pi / 2 + k * np.pi for k in range(6)]
    volume = sum(quad(q, a, b, epsabs=1e-13)[0] for a, b in zip([0] + zeros, zeros + [20]))
    return {"q at 0": q(0), "q at 4": q(4), "volume at 20": volume}


def angle_from_row_to_row():
    return {f"angle at {t}": np.arcsin(0.95 * np.sin(5 * t)) for t in (1, 7, 10)}


def tank_with_a_float():
    """The valve moves where the float, which follows in 2 s, comes to 0.6 or 0.3; dry and closed, h stays at 0."""
    motion, valve, dry = Motion([0.5, 0.5]), 1, False
    while motion.t < 50:
        flow = lambda t, y: [0 if dry else 1.08 * valve - np.sqrt(max(y[0], 0)), (y[0] - y[1]) / 2]
        guards = [(lambda t, y: y[1] - 0.6, 1) if valve else (lambda t, y: y[1] - 0.3, -1)]
        if not valve and not dry:
            guards.append((lambda t, y: y[0], -1))
        hit = motion.go(flow, 50, guards, max_step=0.05)
        if hit == 0:
            valve, dry = 1 - valve, False
        elif hit == 1:
            dry, motion.y[0] = True, 0
    return {f"{name} at {t}": motion(t)[k] for t in (3.1, 8, 20) for k, name in enumerate("hf")} | {"f at 50": motion(50)[1]}


def mean_angle_of_a_turning_vector():
    return {"angle at 5": 45, "angle at 10": 90, "z at 10": 0.1 * 9 * 10**2 / 2}


def arc_sine_between_rows():
    truths = {f"a at {t}": np.arcsin(0.999 * np.sin(11 * t)) for t in (1.3, 9.1, 10)}
    return truths | {"a maximum": np.arcsin(0.999)}


def angle_of_the_mains():
    return {"angle at 1": 100 * np.pi, "z at 1": 50 * np.pi}

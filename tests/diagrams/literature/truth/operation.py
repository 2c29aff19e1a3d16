# SPDX-License-Identifier: MIT
"""Sampling, modes of operation, iteration, noise."""
import numpy as np
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.optimize import fsolve

from .tools import ode


def deadbeat_double_integrator():
    """x″ = u, u constant for 1 s each: u = −x − 1.5 v brings (1, 0.5), which it has at the first sample, t =
    1, to rest in
    two more (J. R. Ragazzini and G. F. Franklin 1958)."""
    x, v = 1.0, 0.5
    states = [(x, v)]
    for _ in range(2):
        u = -x - 1.5 * v
        x, v = x + v + u / 2, v + u
        states.append((x, v))
    assert max(map(abs, states[2])) < 1e-15
    u = -1.0 - 0.75
    return {"x at 1.5": 1 + 0.25 + u / 8, "x at 2": states[1][0], "v at 2": states[1][1], "x at 3.5": 0.0,
            "v at 3.5": 0.0, "x at 9.5": 0.0}


def dottie_iteration():
    x = 0.3
    out = {}
    for n in range(1, 31):
        x = np.cos(x)
        if n in (1, 5):
            out[f"x at {n + 0.4:g}"] = float(x)
    return out | {"x at 30.4": float(x)}


def logistic_map():
    """R. May 1976: xₙ₊₁ = 3.9 xₙ (1 − xₙ); after 25 rounds roundings have grown to 1e-9."""
    x, out = 0.3, {}
    for n in range(1, 26):
        x = 3.9 * x * (1 - x)
        if n in (1, 10, 25):
            out[f"x at {n + 0.4:g}"] = x
    return out


def bratu_by_shooting():
    """y″ + 2 e^y = 0, y(0) = y(1) = 0: y = −2 ln(cosh((t − 1/2) θ/2)/cosh(θ/4)), θ = √4 cosh(θ/4); the lower
    of two solutions."""
    theta = float(fsolve(lambda q: q - 2 * np.cosh(q / 4), 2.3, xtol=1e-14)[0])
    return {"slope at 21": theta * np.tanh(theta / 4), "y at 21": 0.0}


def repeated_decay():
    """250 times 10 ms of initial condition and 40 ms of a decay with 20 ms; an integrator and a counter of all
    runs."""
    return {"x at 0.03": float(np.exp(-1)), "x at 12.453": 1.0, "x at 12.487": float(np.exp(-0.027 / 0.02)),
            "runs at 12.49": 250.0,
            "area at 12.453": float(249 * 0.02 * (1 - np.exp(-2)))}


def buck_converter():
    """L i′ = 12 s − v, C v′ = i − v/R, 100 kHz with a duty of 0.4: the periodic state by the matrix
    exponential."""
    l, c, r, period, duty = 100e-6, 10e-6, 5.0, 10e-6, 0.4
    a = np.array([[0, -1 / l], [1 / c, -1 / (r * c)]])
    b = np.array([12 / l, 0])

    def part(y, tau, s):
        e = expm(a * tau)
        return e @ y + np.linalg.solve(a, (e - np.eye(2)) @ (b * s))

    y, out = np.zeros(2), {}
    for k in range(200):
        if k == 20:
            out["v at 202e-6"] = part(y, 2e-6, 1)[1]
        y = part(part(y, duty * period, 1), (1 - duty) * period, 0)
    out |= {"i at 2e-3": y[0], "v at 2e-3": y[1]}
    return out


def rice_crossings():
    """S. O. Rice 1944: Gaussian noise rises through zero √(−R″/R)/2π times a second; spectrum as the block's
    page says."""
    sinc = lambda f: np.sinc(0.1863 * f)**12
    m0, m2 = quad(sinc, 0, 1 / 0.1863)[0], quad(lambda f: f * f * sinc(f), 0, 1 / 0.1863)[0]
    return {"rate at 400": float(np.sqrt(m2 / m0))}


def noise_through_a_lag():
    """Variance behind a lag of 0.1 s of noise of 1 rms and 10 Hz: ∫ S |H|²."""
    s = lambda f: np.sinc(0.01863 * f)**12
    top = 400
    h = lambda f: 1 / (1 + (0.2 * np.pi * f)**2)
    variance = quad(lambda f: s(f) * h(f), 0, top, limit=1000)[0] / quad(s, 0, top, limit=1000)[0]
    return {"variance at 100": float(variance), "source at 100": 1.0}


def poincare_store():
    """Ueda's oscillator, its x and v stored where cos t rises through zero, t = 3π/2 + 2πk."""
    motion = ode(lambda t, y: [y[1], 7.5 * np.cos(t) - 0.05 * y[1] - y[0]**3], [2.5, 0], 18)
    one, two = motion(1.5 * np.pi), motion(3.5 * np.pi)
    return {"x at 5": one[0], "v at 5": one[1], "x at 13": two[0], "v at 13": two[1]}


def tracks_in_nanoseconds():
    signal = lambda t: np.sin(0.014 * np.pi * t)  # t in ns
    return {"held at 133e-9": signal(133), "held at 180e-9": signal(150), "held at 921e-9": signal(921),
            "held at 980e-9": signal(950)}

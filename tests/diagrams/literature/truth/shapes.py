# SPDX-License-Identifier: MIT
"""Extremes between the rows, and functions of the time that have no value on the edges of where they act."""
import numpy as np
from mpmath import mp, quad
from scipy.integrate import quad as integral
from scipy.optimize import brentq, minimize_scalar
from scipy.special import sici

from .tools import ode


def _greatest(f, begin, end, samples=400001):
    """Greatest value of f, which takes arrays."""
    times = np.linspace(begin, end, samples)
    k = int(np.argmax(f(times)))
    found = minimize_scalar(lambda t: -f(t), bounds=(times[k - 1], times[k + 1]), method="bounded",
                            options={"xatol": 1e-14})
    return max(float(f(times[k])), -found.fun)


def burst_between_rows():
    burst = lambda t: np.sin(37 * t) * np.exp(-100 * (t - 5.123)**2)
    return {"burst maximum": _greatest(burst, 4, 6), "burst minimum": -_greatest(lambda t: -burst(t), 4, 6)}


def ripple_on_a_level():
    return {"supply maximum": 1.1, "supply minimum": 0.9}


def resonance_curve():
    return {"line maximum": 1.0, "area at 20": (np.arctan(1000 * 12.23) + np.arctan(1000 * 7.77)) / 1000}


def window_of_a_half_circle():
    """s = sin φ takes the roots at the edges away."""
    pulse = lambda phi: 0.3 * np.cos(phi)**2
    lag = lambda t: integral(lambda phi: pulse(phi) * 2 * np.exp(-2 * (t - 1.7 - 0.3 * np.sin(phi))), -np.pi / 2,
                             np.arcsin(min((t - 1.7) / 0.3, 1)), epsabs=1e-14)[0]
    return {"area at 5": np.pi / 2 * 0.3, "lag at 1.8": lag(1.8), "lag at 3": lag(3)}


def smooth_window():
    area = 0.01 * float(quad(lambda s: mp.exp(-1 / (1 - s * s)), [-1, -0.9, 0, 0.9, 1]))
    return {"area at 77.6": 0.0, "area at 78": area, "area at 100": area}


def sine_integral_begins_late():
    b = lambda s: s * s / 2 * np.log(s) - s * s / 4
    return {"a at 1": float(sici(0.7)[0]), "a at 3": float(sici(2.7)[0]), "b at 1": b(0.7), "b at 3": b(2.7)}


def clock_by_a_decay():
    ten = 100 * np.log(5)
    a = float(quad(lambda t: 100 * mp.exp(-mp.mpf(10)**9 * (mp.exp(-t / 100) - mp.mpf(1) / 5)**2),
                   [ten + d for d in (-0.3, -0.1, -0.03, 0, 0.03, 0.1, 0.3)]))
    at = brentq(lambda t: t + 0.5 * (1 - np.cos(t)) - 200, 190, 200, xtol=1e-14)
    b = float(quad(lambda t: 100 * mp.exp(-mp.mpf(10)**6 * (t + 0.5 * (1 - mp.cos(t)) - 200)**2),
                   [at + d for d in (-0.01, -0.003, 0, 0.003, 0.01)]))
    return {"a at 160": 0.0, "a at 162": a, "b at 199": 0.0, "b at 400": b}


def grazing_beats():
    f = lambda t: np.sin(t) * np.sin(31.7 * t) - 0.9999
    times = np.linspace(0, 600, 6_000_001)
    values = f(times)
    tops = np.nonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]) & (values[1:-1] > -1e-3))[0] + 1
    long = 0.0
    for k in tops:
        top = minimize_scalar(lambda t: -f(t), bounds=(times[k - 1], times[k + 1]), method="bounded",
                              options={"xatol": 1e-14}).x
        if f(top) > 0:
            long += brentq(f, top, top + 0.02, xtol=1e-14) - brentq(f, top - 0.02, top, xtol=1e-14)
    return {"long at 600": long}


def pulse_to_a_butterworth_filter():
    f = lambda on: lambda t, y: [2 * y[1], 2 * y[2], 2 * (1000 * on - 2 * y[2] - 2 * y[1] - y[0])]
    motion = ode(f(0), ode(f(1), [0, 0, 0], 1e-4).y, 10)
    a = lambda t: float(motion(t - 731.2341)[0])
    return {"a at 731.2": 0.0, "a at 731.5": a(731.5), "a at 733": a(733), "a at 740": a(740)}

# SPDX-License-Identifier: MIT
"""Stimuli that come late to a system at rest, and what counters make of fast or fleeting signals."""
import numpy as np
from scipy.special import j0, jn_zeros

from .tools import ode


def late_pulse_rc_ladder():
    def f(on):
        return lambda t, x: [100 * on - 2 * x[0] + x[1], x[0] - 2 * x[1] + x[2], x[1] - x[2]]

    motion = ode(f(1), [0, 0, 0], 0.001)
    rest = ode(f(0), motion.y, 60)
    return {"x1 at 700.0005": float(ode(f(1), [0, 0, 0], 0.0005)(0.0005)[0]),
            "x1 at 701": float(rest(0.999)[0]),
            "x3 at 703": float(rest(2.999)[2]), "x3 maximum": rest.largest(lambda t, x: x[2])}


def late_gaussian_oscillator():
    """Behind the blow x is the impulse response times the Gaussian's transform at the complex frequency."""
    damping = 0.05
    root = -damping + 1j * np.sqrt(1 - damping**2)
    blow = np.exp((root * 0.02)**2 / 2)
    x = lambda tau: float(np.imag(blow * np.exp(root * tau)) / root.imag)
    top = (np.pi - np.angle(root * blow)) / root.imag  # where x' = 0
    return {"x at 301": x(1), "x at 305": x(5), "x at 320": x(20), "x maximum": x(top)}


def rosen_zener():
    """Closed form behind the pulse (N. Rosen and C. Zener 1932), SciPy on its flank."""
    amplitude, width, detuning = 1.5, 0.8, 1.0

    def f(t, bloch):
        u, v, w = bloch
        pulse = amplitude / np.cosh(t / width)
        return [-detuning * v, detuning * u + pulse * w, -pulse * v]

    p = np.sin(np.pi * amplitude * width / 2)**2 / np.cosh(np.pi * detuning * width / 2)**2
    flank = ode(lambda t, bloch: f(t - 20, bloch), [0, 0, -1], 18)
    return {"w at 398": float(flank(18)[2]), "w at 430": 2 * p - 1}


def late_alpha_synapse():
    def f(t, v):
        s = t / 2
        return [(-v[0] + 10 * s * np.exp(1 - s)) / 20]

    motion = ode(f, [0], 100)
    return {"v at 405": float(motion(5)[0]), "v at 450": float(motion(50)[0]),
            "v maximum": motion.largest(lambda t, v: v[0])}


def nigam_jennings():
    points = [(0, 0), (50, 0), (50.02, 0.12), (50.06, -0.31), (50.1, 0.28), (50.15, -0.22), (50.2, 0.17),
              (50.26, -0.05),
              (50.3, 0), (60, 0)]
    times, values = zip(*points)

    def f(t, x):
        a = np.interp(t + 50, times, values)
        return [x[1], -9.81 * a - 2 * 0.05 * 15 * x[1] - 225 * x[0]]

    motion = ode(f, [0, 0], 4, breaks=[t - 50 for t, _ in points[2:-1]])
    return {"x at 50.2": float(motion(0.2)[0]), "x at 51": float(motion(1)[0]), "x at 53": float(motion(3)[0]),
            "x maximum": motion.largest(lambda t, x: x[0]), "x minimum": -motion.largest(lambda t, x: -x[0])}


def charge_by_needles():
    charge = (1 - np.exp(-0.5e-6)) / 0.5e-6  # at the end of a needle
    x = charge * sum(np.exp(-0.5 * (39.5 - 1e-6 - k)) for k in range(40))
    return {"x at 39.5": float(x), "area at 39.5": 40.0}


def pulse_height_counter():
    return {"lower at 400": 3.0, "upper at 400": 1.0, "window at 400": 2.0}


def peak_comparator():
    return {"n at 50": 50.0}


def beats_counted():
    t = np.linspace(0, 40, 40_000_001)
    high = np.sin(30 * t) + np.sin(31 * t) > 1.99
    return {"n at 40": float(np.count_nonzero(high[1:] & ~high[:-1]))}


def exponential_sweep_counted():
    turns = 10 / np.log(1000) * (1000 - 1)  # at t = 10; −cos rises through 0 at a quarter of each turn
    return {"n at 10": float(np.floor(turns - 0.25) + 1)}


def chirp_through_resonance():
    w = 10 * np.pi
    motion = ode(lambda t, y: [y[1], w * w * (np.sin(0.1 * np.pi * t * t) - y[0]) - 0.4 * y[1]], [0, 0], 60,
                 max_step=0.02)
    return {"x at 40": float(motion(40)[0]), "x at 55": float(motion(55)[0]), "x at 60": float(motion(60)[0]),
            "x maximum": motion.largest(lambda t, y: y[0], samples=200_000)}


def mains_clock():
    return {"seconds at 60.01": 60.0, "ticks at 60.01": 1.0}


def near_graze():
    return {"above at 20": 20.0, "below at 20": 0.0}


def bessel_zeros_counted():
    zeros = jn_zeros(0, 120)
    rises = zeros[1::2]  # J0 starts positive: it rises through its 2nd, 4th, … zero
    return {"n at 300": float(np.count_nonzero(rises < 301)), "x at 300": float(j0(301)),
            "x at 100": float(j0(101))}


def adler_slips():
    def theta(t):
        # tan(θ/2) = (1 + √(Δ² − 1) tan(√(Δ² − 1) t/2 − c))/Δ
        d = 1.0001
        s = np.sqrt(d * d - 1)
        c = np.arctan(1 / s)
        phase = s * t / 2 - c
        return 2 * (np.arctan((1 + s * np.tan(phase)) / d) + np.pi * np.round(phase / np.pi))

    return {"theta at 400": float(theta(400)), "theta at 1000": float(theta(1000)),
            "slips at 2000": float(np.floor(theta(2000) / (2 * np.pi) + 0.25))}


def saddle_node_ghost():
    return {"x at 290": float(0.01 * np.tan(0.01 * 290 + np.arctan(-100))),
            "x at 310": float(0.01 * np.tan(0.01 * 310 + np.arctan(-100)))}


def monostable_train():
    # Edges at (asin 0.9 + 2πk)/2π; a pulse of 1.3 that is not retriggerable swallows every second edge.
    first = np.arcsin(0.9) / (2 * np.pi)
    area = lambda length, period: sum(max(0, min(length, 100.4 - t)) for t in np.arange(first, 100.4, period))
    return {"short at 100.4": float(area(0.3, 1)), "long at 100.4": float(area(1.3, 2)),
            "retriggered at 100.4": float(100.4 - first)}


def sigma_delta():
    x, area, u = 0.05, 0.0, 1 / np.pi
    y = -1
    for _ in range(1000):  # a clock period each; the clock rises at its end
        x += 0.01 * (u - y)
        area += 0.01 * y
        y = 1 if x > 0 else -1
    return {"area at 10.005": float(area + 0.005 * y), "x at 10.005": float(x + 0.005 * (u - y))}

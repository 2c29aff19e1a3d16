# SPDX-License-Identifier: MIT
"""Stores, flip-flops, counters, converters: recursions from clock to clock."""
import math

import numpy as np
from scipy.optimize import brentq

from .tools import Motion


def euclid_by_stores():
    a, b, out = 1071, 462, {}
    for k in range(14):
        if k in (0, 3, 8):
            out |= {f"a at {k}.9": a / 1e4, f"b at {k}.9": b / 1e4}
        a, b = abs(a - b), min(a, b)
    assert {a, b} == {math.gcd(1071, 462), 0}
    return out | {"a at 15": max(a, b) / 1e4, "b at 15": 0.0}


def peaks_in_a_store():
    """x″ + 0.1 x′ + x = 0 from 1 has its peaks after whole turns."""
    turn = 2 * np.pi / np.sqrt(1 - 0.05**2)
    peak = lambda n: np.exp(-0.05 * n * turn)
    return {"p at 8": peak(1), "q at 11": peak(1), "p at 57": peak(9), "q at 60": peak(9), "n at 60": 60 // turn}


def highest_so_far():
    """The greatest of 0.5 (cos 1.05t − cos t) so far, from a grid and its parabola; x is below it at the times asked
    for."""
    out = {}
    for until in (20, 45, 100, 300):
        t = np.arange(0, until, 1e-3)
        x = 0.5 * (np.cos(1.05 * t) - np.cos(t))
        k = int(np.argmax(x))
        assert 0 < k < len(t) - 100
        before, top, after = x[k - 1:k + 2]
        out[f"h at {until}"] = top - (after - before)**2 / 8 / (before - 2 * top + after)
    return out


def ring_of_three_swapped():
    """At each second (a, b, c) ← (c, a, b), between them a gains 0.1."""
    a, b, c, out = 0.1, 0.0, 0.0, {}
    for k in range(1, 10):
        a, b, c = c, a, b
        if k in (3, 9):
            out |= {f"a at {k}.5": a + 0.05, f"b at {k}.5": b, f"c at {k}.5": c}
        a += 0.1
    return out


def sampled_pi():
    """x′ = u − x between samples at 0.1 + 0.2 k; u = 1.2 e + I, I ← I + 0.3 e."""
    x, integral, out = 0.0, 0.0, {}
    after = lambda span: u + (x - u) * np.exp(-span)
    for k in range(21):
        e = 1 - x
        integral += 0.3 * e
        u = 1.2 * e + integral
        if k in (0, 4, 20):
            at = f"{0.2 + 0.2 * k:g}"
            out |= {f"x at {at}": after(0.1), f"u at {at}": u}
        x = after(0.2)
    return out


def secant_shooting():
    """s ← s + 0.9 (0.5 − s sin 1), a round in 1.2 s."""
    s, out = 0.45, {}
    for k in range(10):
        if k in (0, 3, 9):
            out |= {f"s at {1.2 * k + 0.5:g}": s, f"y at {1.2 * k + 1.15:g}": s * np.sin(1)}
        s += 0.9 * (0.5 - s * np.sin(1))
    return out


def memory_pair_started():
    x, out = 0.3, {"x at 0.09": 0.3}
    for k in range(12):
        x = 3.5 * x * (1 - x)
        if k == 0:
            out["x at 0.29"] = x
    return out | {"x at 2.49": x}


def water_level_monitor():
    """R. Alur and others 1995: up from 1 to 12 in 11 s, down again in 5.5; it passes 5 downwards at 14.5, which is
    counted."""
    y = lambda t: 1 + t % 16.5 if t % 16.5 < 11 else 12 - 2 * (t % 16.5 - 11)
    return {"y at 10.5": y(10.5), "y at 500": y(500), "y at 1000": y(1000), "n at 1000": (1000 - 14.5) // 16.5 + 1}


def lfsr():
    """S. W. Golomb 1967: x⁷ + x⁶ + 1, the first clock at 1 s."""
    bits, states = [1, 0, 0, 0, 0, 0, 0], []
    for _ in range(1000):
        bits = [bits[6] ^ bits[5], *bits[:6]]
        states.append(bits)
    out = {f"q{q} at {t}.6": float(states[t - 1][q]) for t in (300, 1000) for q in (0, 3, 6)}
    return out | {"high at 1000.75": sum(state[6] for state in states[:-1]) + 0.75 * states[-1][6]}


def dual_slope():
    """0.32174 s for the way back; pulses at 0.5 ms and every millisecond."""
    return {"n at 2": float(np.floor((0.32174 - 0.0005) / 0.001) + 1), "v at 2": 0.0, "done at 2": 0.32174}


def tracking_converter():
    """One step of 1/63 every 10 ms, towards 0.5 + 0.4 sin 3t."""
    steps = 32
    for k in range(1, 500):
        steps += 1 if 0.5 + 0.4 * np.sin(0.03 * k) > steps / 63 else -1
    return {"dac at 4.998": steps / 63}


def staircase_converter():
    """⌊8x⌋/8 of x = 0.95 sin t cos 0.3t, by the passages of its levels."""
    x = lambda t: 7.6 * np.sin(t) * np.cos(0.3 * t)
    t = np.linspace(0, 30, 400001)
    passages = []
    for level in range(-8, 9):
        above = x(t) > level
        for k in np.nonzero(above[:-1] != above[1:])[0]:
            passages.append(brentq(lambda t: x(t) - level, t[k], t[k + 1], xtol=1e-15))
    ends = [0, *sorted(passages), 30]
    area = sum((b - a) * np.floor(x((a + b) / 2)) / 8 for a, b in zip(ends, ends[1:]))
    return {"i at 30": area, "q at 30": np.floor(x(30)) / 8}


def nor_latch():
    """Set at 1 and at 3, reset at the start and at 2."""
    return {"q at 0.8": 0.0, "nq at 0.8": 1.0, "q at 1.5": 1.0, "q at 2.5": 0.0, "on at 4": (2 - 1.0) + (4 - 3.0)}


def stroboscope():
    """Rounds of 0.1 s of initial condition, x′ = 1 + 0.5 sin t up to 0.7, 0.05 s of hold."""
    way = lambda t: t - 0.5 * np.cos(t)

    def at(t):
        start = 0.1
        while True:
            if t <= start:
                return 0.0
            end = brentq(lambda s: way(s) - way(start) - 0.7, start, start + 3, xtol=1e-15)
            if t <= end + 0.05:
                return way(min(t, end)) - way(start)
            start = end + 0.15

    return {"x at 40": at(40), "x at 40.3": at(40.3)}


def clegg_integrator():
    """J. C. Clegg 1958: c′ = e, zero wherever e passes zero, in front of 1/(s (s + 0.2))."""
    motion, side = Motion([0, 0, 0]), 1
    f = lambda t, s: [1 - s[2], s[0] + 1 - s[2] - 0.2 * s[1], s[1]]
    while motion.go(f, 30, [(lambda t, s: side * (1 - s[2]) + 1e-13, -1)], max_step=0.1) is not None:
        motion.y[0], side = 0.0, -side
    return {"y at 30": motion(30)[2], "c at 30": motion(30)[0]}


def blowflies_on_a_delay_line():
    """From sample to sample of the delay line: what it gives is a straight line, so what is integrated is smooth
    between the corners of the table, and Gauss's rule takes each piece."""
    x, y = [-14.4, -8, -5, -3, -2, -1, -0.45], [0.0003, 0.0003, 0.0067, 0.0498, 0.135, 0.368, 0.6376]
    nodes, weights = np.polynomial.legendre.leggauss(12)
    stages, decay, until = 24, 0.175, 120
    h = 14.8 / stages

    def eggs(late):
        k = min(max(np.searchsorted(x, -late / 600, side="right") - 1, 0), len(x) - 2)
        return 8 * late * (y[k] + (y[k + 1] - y[k]) / (x[k + 1] - x[k]) * (-late / 600 - x[k]))

    def after(n, first, last, t):
        corners = [(-600 * corner - first) / (last - first) * h for corner in x] if first != last else []
        ends = sorted({0, t, *(corner for corner in corners if 0 < corner < t)})
        born = 0
        for a, b in zip(ends, ends[1:]):
            for s, w in zip((a + b) / 2 + (b - a) / 2 * nodes, (b - a) / 2 * weights):
                born += w * np.exp(-decay * (t - s)) * eggs(first + (last - first) * s / h)
        return n * np.exp(-decay * t) + born

    samples = [300.0] * (stages + 1)
    for k in range(int(until / h)):
        samples.append(after(samples[-1], samples[k], samples[k + 1], h))
    at = lambda t: (lambda k: after(samples[stages + k], samples[k], samples[k + 1], t - k * h))(int(t / h))
    return {"N at 95.5": at(95.5), "N at 120": at(120)}

# SPDX-License-Identifier: MIT
"""Pulses, counted and made."""
import numpy as np

from .tools import Motion


def oscillator_peaks_counted():
    """x = cos t from two integrators passes 0.9999 upwards before each of its tops at 2π, 4π, …"""
    return {"n at 630": 100.0, "x at 630": float(np.cos(630))}


def vernier_coincidences():
    """Trains of 1 ms at distances of 1 and of 1.0103 s: both high at once."""
    a, b, width = 1.0, 1.0103, 1e-3
    count, area = 0, 0.0
    for k in range(1000):
        s = 0.25 + k * b
        for n in (np.floor(s / a), np.floor(s / a) + 1):
            low, high = max(s, n * a), min(s + width, n * a + width)
            if high > low and high < 999.9:
                count += 1
                area += high - low
    return {"n at 999.9": float(count), "area at 999.9": float(area)}


def tone_burst():
    """Ten periods of 10 kHz at t = 5 into a resonator of 10 kHz: x″ + 200 x′ + w² x = w² e."""
    w = 2e4 * np.pi
    f = lambda on: lambda t, y: [w * y[1], w * (on * np.sin(w * t) - y[0]) - 200 * y[1]]
    motion = Motion([0, 0])
    motion.go(f(1), 1e-3, max_step=1e-5)
    motion.go(f(0), 5e-3, max_step=1e-5)
    return {"x at 5.001": motion(1e-3)[0], "x at 5.003": motion(3e-3)[0], "x at 5.005": motion(5e-3)[0]}


def relaxation_sawtooth():
    return {"x at 9.9996": 0.6, "n at 9.9996": 9999.0}


def pulse_frequency_modulator():
    """x′ = 100 (1 + 0.9 sin t), back to 0 at 1: the whole part of the integral is counted."""
    way = lambda t: 100 * (t + 0.9 * (1 - np.cos(t)))
    return {"n at 20": float(np.floor(way(20))), "x at 20": float(way(20) % 1)}


def relay_ignores_short_pulses():
    """Delay 0.1: of pulses of 0.05 nothing comes through, of those of 0.25 each, 0.1 late."""
    return {"n at 50": 25.0, "short at 50": 0.0, "on at 50": 25 * 0.25}


def peak_detector():
    """v′ = 1e5 max(e − v, 0) − 0.01 v, e: three Gaussian pulses of 2 ms; between them it holds."""
    tops = ((100.0, 0.5), (200.0, 0.3), (300.0, 0.8))
    e = lambda t: sum(h * np.exp(-((t - c) / 0.002)**2) for c, h in tops)
    motion = Motion([0])
    for c, _ in tops:
        motion.go(lambda t, v: [-0.01 * v[0]], c - 0.015, method="DOP853")
        for _ in range(20):
            charging = e(motion.t) > motion.y[0]
            f = (lambda t, v: [1e5 * (e(t) - v[0]) - 0.01 * v[0]]) if charging else (lambda t,
                                                                                     v: [-0.01 * v[0]])
            if motion.go(f, c + 0.015, [(lambda t, v: e(t) - v[0], -1 if charging else 1)], method="Radau",
                         max_step=1e-4) is None:
                break
            motion.y = motion.y + (1e-13 if charging else -1e-13)  # past the corner
    motion.go(lambda t, v: [-0.01 * v[0]], 400)
    return {"v at 150": motion(150)[0], "v at 250": motion(250)[0], "v at 350": motion(350)[0]}

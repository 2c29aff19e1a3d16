# SPDX-License-Identifier: MIT
"""Relays that regulate: in minimum time, with variable structure, by turns, as amplifiers."""
import numpy as np
from scipy.optimize import brentq

from .tools import Motion


def time_optimal_unequal():
    """x″ = −1 or 0.5 from x = 1: parabolas, that of arrival x = v²; the origin at t = 3 √(2/3), and rest there."""
    turns = np.sqrt(2 / 3)
    return {"x at 0.8": 1 - 0.8**2 / 2, "v at 1.5": -turns + 0.5 * (1.5 - turns), "x at 4": 0.0, "v at 4": 0.0}


def time_optimal_by_switch():
    """x″ = 0.4 or −0.8 from (−0.5, 0.3): up to x = −0.625 v², then along it. At rest in the origin the relay is up for
    two thirds of the time, so that its magnitude has the mean 8/15."""
    x = lambda t: -0.5 + 0.3 * t + 0.2 * t * t
    turns = brentq(lambda t: x(t) + 0.625 * (0.3 + 0.4 * t)**2, 0, 5, xtol=1e-15)
    ends = turns + (0.3 + 0.4 * turns) / 0.8
    return {"x at 1": -0.4 * (ends - 1)**2, "v at 1": 0.8 * (ends - 1), "x at 4": 0.0, "v at 4": 0.0,
            "f at 4": 0.4 * turns + 0.8 * (ends - turns) + 8 / 15 * (4 - ends)}


def bang_off_bang():
    """x″ = −1 from x = 1 to x = 2 v², a coast to x = v²/2, x″ = 1 into the origin."""
    off = np.sqrt(0.4)
    on = off + (0.8 - 0.2) / off
    ends = on + off
    return {"x at 0.5": 1 - 0.5**2 / 2, "x at 1.2": 0.8 - off * (1.2 - off), "x at 2": (ends - 2)**2 / 2,
            "x at 4": 0.0, "v at 4": 0.0}


def variable_structure():
    """x″ = −4 x while x (x′ + 0.8 x) > 0, else 4 x, from (1, 0.5): a circle's part to x′ = −0.8 x, then down that line
    as e^(−0.8 t), with the mean −0.64 of the factor."""
    start = np.array([1, 0.5 / 2])  # of x = a cos 2t + b sin 2t
    x = lambda t: start @ [np.cos(2 * t), np.sin(2 * t)]
    v = lambda t: 2 * start @ [-np.sin(2 * t), np.cos(2 * t)]
    slides = brentq(lambda t: v(t) + 0.8 * x(t), 0, 1, xtol=1e-15)
    later = lambda t: x(slides) * np.exp(-0.8 * (t - slides))
    return {"x at 2": later(2), "x at 6": later(6), "v at 4": -0.8 * later(4), "p at 6": 4 * slides - 0.64 * (6 - slides)}


def slide_through_many():
    """x′ = 0.3 + 0.2 sin t − u, u = −1 or 2: while x slides u is 2 for the part (1.3 + 0.2 sin t)/3 of the time, and so
    is all that is made of it."""
    slides = brentq(lambda t: 0.4 - 1.7 * t + 0.2 * (1 - np.cos(t)), 0, 2, xtol=1e-15)
    up = (1.3 * (10 - slides) + 0.2 * (np.cos(slides) - np.cos(10))) / 3
    area = lambda high, low: high * (slides + up) + low * (10 - slides - up)
    return {"m at 10": area(2, 0.5), "g at 10": area(4, 1), "c at 10": area(1, 0), "e at 10": area(np.exp(-2), np.e)}


def switched_server():
    """The tank that is emptied falls to 0 in x/(1 − ρ), while the others fill; then comes the next one."""
    fills, x, t, tank, rounds, out = np.array([0.31, 0.27, 0.42]), np.array([0.5, 0.8, 0.3]), 0.0, 0, 0, {}
    while t < 12:
        rates = fills - np.eye(3)[tank]
        ends = t - x[tank] / rates[tank]
        for at in (3.3, 11.9):
            if t <= at < ends:
                out |= {f"x{k + 1} at {at}": x[k] + rates[k] * (at - t) for k in range(3)}
        x, t, tank = x + rates * (ends - t), ends, (tank + 1) % 3
        rounds += tank == 0 and t < 12
    return out | {"n at 12": float(rounds)}


def class_d_amplifier():
    """y′ = 10 (r − u), u = ±1 with a hysteresis of ±0.02 on y, through a filter of second order."""
    motion, u, count = Motion([0, 0, 0]), -1, 0
    while motion.t < 6:
        rates = lambda t, y: [10 * (0.6 * np.sin(1.3 * t) - u), y[2], 25 * (u - y[1]) - 6 * y[2]]
        if motion.go(rates, 6, [(lambda t, y: u * y[0] + 0.02, -1)]) is None:
            break
        u = -u
        count += u > 0
    return {"v at 3": motion(3)[1], "v at 6": motion(6)[1], "n at 6": float(count)}


def coupled_multivibrators():
    """Two relaxation oscillators of 1 and 1.37 1/s, each with a hysteresis of ±0.4, coupled by 0.3."""
    motion, q, counts = Motion([0.1, -0.2]), [1, 1], [0, 0]
    while motion.t < 40:
        rates = lambda t, x: [q[0] - x[0] + 0.3 * (x[1] - x[0]), 1.37 * (q[1] - x[1]) + 0.3 * (x[0] - x[1])]
        hit = motion.go(rates, 40, [(lambda t, x, k=k: q[k] * x[k] - 0.4, 1) for k in range(2)])
        if hit is None:
            break
        q[hit] = -q[hit]
        counts[hit] += q[hit] > 0
    return {"a at 17": motion(17)[0], "a at 39": motion(39)[0], "b at 39": motion(39)[1], "na at 40": float(counts[0]),
            "nb at 40": float(counts[1])}

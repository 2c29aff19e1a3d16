# SPDX-License-Identifier: MIT
"""Power converters, phase-locked loops, servos with limits: from switch to switch."""
import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from .tools import Motion, ode


def peak_current_buck():
    """In microseconds: from 0.5 up by 0.06 to 1, down by 0.04 until the next clock; clocks at 0, 10, … 10090."""
    def at(t):
        valley = 0.5
        for _ in range(int(t // 10)):
            valley = 1 - (10 - (1 - valley) / 0.06) * 0.04
        on = (1 - valley) / 0.06
        return valley + 0.06 * (t % 10) if t % 10 < on else 1 - 0.04 * (t % 10 - on)

    return {"i at 25e-6": at(25), "i at 0.010095": at(10095), "n at 0.010095": 1010.0}


def boost_discontinuous():
    """i′ = 2 for 0.3 of each second, then 2 (1 − v) until the diode blocks; 4 v′ is its current less v/10."""
    motion = Motion([0, 1])
    load = lambda rate: lambda t, y: [rate, -y[1] / 40]
    while motion.t < 30.5:
        k = round(motion.t)
        motion.go(load(2), k + 0.3)
        end = min(k + 1, 30.5)
        if motion.go(lambda t, y: [2 * (1 - y[1]), y[0] / 4 - y[1] / 40], end, [(lambda t, y: y[0], -1)],
                     max_step=0.05) is not None:
            motion.y[0] = 0
            motion.go(load(0), end)
    return {"i at 30.5": motion(30.5)[0], "v at 30.5": motion(30.5)[1]}


def dickson_charge_pump():
    """J. F. Dickson 1976: three diodes with 0.1, each open or not."""
    motion = Motion([0, 0, 0])
    while motion.t < 20.25:
        half = round(2 * motion.t)
        clock = 1 - half % 2
        end = min((half + 1) / 2, 20.25)
        drops = lambda q: np.array([1 - q[0] - clock, q[0] + 2 * clock - q[1] - 1, q[1] + 1 - clock - q[2]])
        conducts = drops(motion.y) > 0

        def f(t, q):
            i = 10 * np.where(conducts, drops(q), 0)
            return [i[0] - i[1], i[1] - i[2], i[2] - q[2] / 20]

        while True:
            guards = [(lambda t, q, k=k: (1 if conducts[k] else -1) * drops(q)[k] + 1e-13, -1) for k in range(3)]
            hit = motion.go(f, end, guards, max_step=0.05)
            if hit is None:
                break
            turned = not conducts[hit]
            conducts = drops(motion.y) > 0  # others may turn at the same time
            conducts[hit] = turned
    return {f"q{k + 1} at 20.25": motion(20.25)[k] for k in range(3)}


def thyristor():
    """0.3 i′ = sin 2πt − i from 1 rad of each turn until i falls to zero."""
    w = 2 * np.pi
    steady = lambda t: np.imag(np.exp(1j * w * t) / (1 + 0.3j * w))
    fires = 1 / w
    current = lambda t: steady(t) - steady(fires) * np.exp(-(t - fires) / 0.3)
    blocks = brentq(current, fires + 0.2, fires + 0.95, xtol=1e-15)
    assert blocks < 1 and 0.6 < blocks
    # The charge is the integral of the voltage less 0.3 i.
    voltage = lambda t: (np.cos(1) - np.cos(w * t)) / w
    return {"q at 20.6": 20 * voltage(blocks) + voltage(0.6) - 0.3 * current(0.6), "i at 20.6": current(0.6)}


def dimmer():
    """Thyristors fire at 0.2 and 0.7 of each period; 0.3 i′ = sin 2πt − i until i comes to zero, before the other."""
    w = 2 * np.pi
    steady = lambda t: np.imag(np.exp(1j * w * t) / (1 + 0.3j * w))
    fires = 0.2
    current = lambda t: steady(t) - steady(fires) * np.exp(-(t - fires) / 0.3)
    blocks = brentq(current, 0.5, 0.7, xtol=1e-15)
    # The charge is the integral of the voltage less 0.3 i; that of the other half-waves takes it back.
    voltage = lambda t: (np.cos(w * fires) - np.cos(w * t)) / w
    return {"i at 7.4": current(0.4), "q at 7.4": voltage(0.4) - 0.3 * current(0.4), "i at 7.69": 0.0,
            "q at 7.69": voltage(blocks), "i at 7.9": -current(0.4)}


def pwm_natural():
    """H. S. Black 1953: 0.8 sin 2πt against a triangle of 50 Hz, whose slopes are passed once each."""
    triangle = lambda t: 2 / np.pi * np.arcsin(np.sin(100 * np.pi * t))
    above = lambda t: 0.8 * np.sin(2 * np.pi * t) - triangle(t)
    corners = [1e-12, *((k + 0.5) / 100 for k in range(203)), 2.03]
    edges = [brentq(above, a, b, xtol=1e-16, rtol=1e-15) for a, b in zip(corners, corners[1:])
             if above(a) * above(b) < 0]
    side = -1 if above(1e-6) < 0 else 1
    i = on = t = n = 0.0
    for edge in [*edges, 2.03]:
        i = side + (i - side) * np.exp(-(edge - t) / 0.05)
        on += (edge - t) * (side > 0)
        n += side < 0 and edge < 2.03
        t, side = edge, -side
    return {"i at 2.03": i, "on at 2.03": on, "n at 2.03": n}


def phase_locked_loop():
    """θ′ = 6 + 4z, 0.8 z′ = sign sin 7t · sign sin θ − z: exponentials from edge to edge; θ only rises."""
    z, theta, t, reference, own = 0.0, 0.4, 0.0, 1, 1  # the edges still to come, in half turns
    while True:
        product = (-1)**(reference + own)
        phase = lambda s: theta + (6 + 4 * product) * s - 3.2 * (z - product) * np.expm1(-s / 0.8)
        span = min(reference * np.pi / 7, 60) - t
        late = phase(span) < own * np.pi
        if not late:
            span = brentq(lambda s: phase(s) - own * np.pi, 0, span, xtol=1e-16, rtol=1e-15)
        theta, z, t = phase(span), product + (z - product) * np.exp(-span / 0.8), t + span
        if not late:
            own += 1
        elif t < 60:
            reference += 1
        else:
            return {"z at 60": z, "th at 60": theta}


def charge_pump_pll():
    """F. M. Gardner 1980: q′ = 0.3 p, φ′ = 0.8 + q + 0.6 p with the pump p; φ starts anew at 1, and n counts that."""
    q = phase = t = 0.0
    pump, reference, n = 0, 1, 0
    while True:
        speed, bend = 0.8 + q + 0.6 * pump, 0.15 * pump
        roots = np.roots([bend, speed, phase - 1]) if pump else [(1 - phase) / speed]
        span = min((r.real for r in roots if np.isreal(r) and r.real > 0), default=np.inf)
        next_edge = min(reference, 30.3) - t
        full = span < next_edge
        span = min(span, next_edge)
        phase, q, t = phase + (speed + bend * span) * span, q + 0.3 * pump * span, t + span
        if full:
            phase, n, pump = 0.0, n + 1, pump - 1 if pump >= 0 else pump
        elif reference < 30.3:
            pump, t, reference = pump + 1 if pump <= 0 else pump, float(reference), reference + 1
        else:
            return {"q at 30.3": q, "ph at 30.3": phase, "n at 30.3": float(n)}


def bang_bang_with_dead_zone_and_lag():
    """x″ + x′ = u, u = −sign x outside ±0.1 and 0 within."""
    motion, u = Motion([2, 0]), -1
    while True:
        if u:
            guards = [(lambda t, y: -u * y[0] - 0.1 + 1e-13, -1)]
        else:
            guards = [(lambda t, y: 0.1 - y[0] + 1e-13, -1), (lambda t, y: 0.1 + y[0] + 1e-13, -1)]
        hit = motion.go(lambda t, y: [y[1], u - y[1]], 20, guards, max_step=0.1)
        if hit is None:
            return {"x at 20": motion(20)[0], "v at 20": motion(20)[1]}
        u = 0 if u else (-1, 1)[hit]


def saturation_limit_cycle():
    """Three lags behind clip(−20 c): linear within, and outside of it with a constant input."""
    motion, side = Motion([0.3, 0, 0]), 0
    chain = np.array([[-1, 0, 0], [1, -1, 0], [0, 1, -1.0]])
    while True:
        if side:
            guards = [(lambda t, y: -20 * side * y[2] - 1 + 1e-13, -1)]
        else:
            guards = [(lambda t, y: 1 + 20 * y[2] + 1e-13, -1), (lambda t, y: 1 - 20 * y[2] + 1e-13, -1)]
        drive = lambda y: side or -20 * y[2]
        hit = motion.go(lambda t, y: chain @ y + [drive(y), 0, 0], 60, guards, max_step=0.2)
        if hit is None:
            return {"a at 60": motion(60)[0], "c at 60": motion(60)[2]}
        side = 0 if side else (1, -1)[hit]


def saturated_integrator():
    """y′ = 2 cos t between ±1.2: from each turn of sin t on, straight back from the limit."""
    top, bottom = lambda t: 1.2 - 2 * (1 - np.sin(t)), lambda t: -1.2 + 2 * (1 + np.sin(t))
    y = lambda t: (min(2 * np.sin(t), 1.2) if t < np.pi / 2 else
                   max(top(t), -1.2) if (t - np.pi / 2) % (2 * np.pi) < np.pi else min(bottom(t), 1.2))
    return {"x at 1": -10 * y(1)} | {f"y at {t}": y(t) for t in (1, 2, 4.5, 9, 10)}


def saturating_oscillator():
    """x′ = v, v′ = v − 2x, each held at ±1.2 while it is driven further."""
    motion, held = Motion([0.5, 0]), [0, 0]
    rates = lambda y: np.array([y[1], y[1] - 2 * y[0]])
    while motion.t < 20:
        guards = []
        for k in range(2):
            if held[k]:
                guards.append((lambda t, y, k=k: held[k] * rates(y)[k], -1))
            else:
                guards.append((lambda t, y, k=k: 1.2 - abs(y[k]) + 1e-13, -1))
        hit = motion.go(lambda t, y: np.where(held, 0, rates(y)), 20, guards, max_step=0.05)
        if hit is not None:
            held[hit] = 0 if held[hit] else int(np.sign(motion.y[hit]))
            motion.y[hit] = np.clip(motion.y[hit], -1.2, 1.2)
    out = {}
    for t in (1, 2.5, 4, 10, 20):
        out |= {f"x at {t}": motion(t)[0], f"v at {t}": motion(t)[1]}
    return out


def preisach_four():
    """F. Preisach 1935: ±0.25 from each of four relays, which turn where x passes −h or h."""
    x = lambda t: np.exp(-t / 20) * np.cos(2 * np.pi * t / 3.7)
    # Between the extremes, 1.85 apart, x only rises or falls.
    first = 3.7 / (2 * np.pi) * (np.pi - np.arctan(3.7 / (40 * np.pi)))
    ends = [0, *(first + 1.85 * k for k in range(32) if first + 1.85 * k < 60), 60]
    area, last = 0.0, 0.0
    for h in (0.1, 0.3, 0.5, 0.7):
        state, since = 1, 0.0
        for a, b in zip(ends, ends[1:]):
            if state * x(b) < -h < state * x(a):
                t = brentq(lambda t: state * x(t) + h, a, b, xtol=1e-14)
                area, since, state = area + 0.25 * state * (t - since), t, -state
        area += 0.25 * state * (60 - since)
        last += 0.25 * state
    return {"m at 60": last, "im at 60": area}


def pade_delay():
    """y = x − 12 w′, w″ = −12 w − 6 w′ + x, x′ = −1.2 y."""
    a = np.array([[0, 1, 0], [-12, -6, 1], [0, 14.4, -1.2]])
    return {f"x at {t}": expm(a * t)[2, 2] for t in (5, 30)}


def sawtooth_phase_detector():
    """θ′ = 4 − θ from 0, then from −π, up to π each; the phase is not wrapped."""
    first, period = -np.log(1 - np.pi / 4), np.log((4 + np.pi) / (4 - np.pi))

    def phase(t):
        slips, since = divmod(t - first, period)
        return 2 * np.pi * (slips + 1) + 4 - (4 + np.pi) * np.exp(-since)

    return {"phase at 10": phase(10), "phase at 60": phase(60)}


def angle_of_an_oscillation():
    wrapped = lambda t: (t + np.pi) % (2 * np.pi) - np.pi
    return {"angle at 20": wrapped(20), "area at 20": wrapped(20)**2 / 2, "area at 50": wrapped(50)**2 / 2,
            "turns at 50": np.floor((50 + np.pi) / (2 * np.pi))}


def homing_by_straight_lines():
    """The angle of the line of sight from its equation at every moment, by the straight lines."""
    corners = np.linspace(0.39, 0.53, 11)
    line = lambda f, phi: np.interp(phi, corners, f(corners))

    def angle(dx, dy):
        return brentq(lambda phi: dx * line(np.sin, phi) - dy * line(np.cos, phi), 0.39, 0.53, xtol=1e-15)

    def f(t, y):
        dx, dy, head = y
        vx, vy, phi = 600 * np.cos(head), 600 * np.sin(head), angle(dx, dy)
        length = dx * line(np.cos, phi) + dy * line(np.sin, phi)
        return [-250 - vx, -vy, 4 * (-dx * vy - dy * (-250 - vx)) / length**2]

    dx, dy, head = ode(f, [6000, 2500, 0.2], 7, max_step=0.01)(7)
    phi = angle(dx, dy)
    return {"los at 7": phi, "head at 7": head, "range at 7": dx * line(np.cos, phi) + dy * line(np.sin, phi)}

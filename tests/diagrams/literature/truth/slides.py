# SPDX-License-Identifier: MIT
"""Relays that slide, several of them and along surfaces that others make."""
import numpy as np
from scipy.optimize import brentq

from .mechanics import _friction
from .tools import Motion

_ONE = lambda w: 1.0  # the size of a relay, which acts as −sign of its input like a friction


def energy_relay():
    """x″ = −x − sign(x² + x′² − 1) x′: an undamped spiral to the unit circle, then round it."""
    motion = Motion([0.5, 0])
    motion.go(lambda t, y: [y[1], -y[0] + y[1]], 10, [(lambda t, y: y @ y - 1, 1)])
    motion.go(lambda t, y: [y[1], -y[0]], 30)
    out = {}
    for t in ("0.65", "10", "30"):
        x, v = motion(float(t))
        out |= {f"x at {t}": x, f"v at {t}": v}
    return out


def lasso_flow():
    """x′ = b − A x − 0.5 sign x (R. Tibshirani 1996) ends in the lasso: x₁ = 0.35 alone, the slopes of the others are
    below 0.5."""
    a = np.array([[2, 0.5, 0.3], [0.5, 1.5, 0.4], [0.3, 0.4, 1]])
    b = np.array([1.2, 0.1, -0.2])
    rest = np.array([(1.2 - 0.5) / 2, 0, 0])
    assert max(abs(b - a @ rest)[1:]) < 0.5
    motion = _friction([-0.5, 0.8, 0.4], 2, lambda t, x, q: b - a @ x + 0.5 * q, lambda x: x, [_ONE] * 3)
    out = {f"x{k + 1} at {t:g}": motion(t)[k] for t in (0.3, 1, 2) for k in range(3)}
    return out | {f"x{k + 1} at 40": rest[k] for k in range(3)}


def bowling_ball():
    """v′ = −0.2 g s − g a, u′ = 0.5 g s, s = sign(v − u), up a ramp that steepens as a = 0.1 (t − 3)."""
    g = 9.81
    motion = _friction([8, 0], 12,
                       lambda t, y, q: [0.2 * g * q[0] - g * 0.1 * max(t - 3, 0), -0.5 * g * q[0]],
                       lambda y: np.array([y[0] - y[1]]), [_ONE])
    assert abs(motion(2)[0] - 40 / 7) < 1e-9  # it rolls with 5/7 of its speed
    return {"v at 0.5": motion(0.5)[0], "v at 2": motion(2)[0], "v at 8": motion(8)[0],
            "d at 8": motion(8)[0] - motion(8)[1], "v at 12": motion(12)[0], "u at 12": motion(12)[1]}


def relay_follows_van_der_pol():
    """y′ = 1.5 sign(x − y) behind van der Pol's oscillator with μ = 2; sign² is 1 on both sides, so also while it
    slides."""
    motion = _friction([2, 0, 0], 25,
                       lambda t, y, q: [y[1], 2 * (1 - y[0]**2) * y[1] - y[0], -1.5 * q[0]],
                       lambda y: np.array([y[0] - y[2]]), [_ONE])
    out = {}
    for t in (0.5, 8, 16, 25):
        out |= {f"x at {t}": motion(t)[0], f"y at {t}": motion(t)[2]}
    return out | {"E at 25": 25.0}


def three_coupled_relays():
    """x′ = b(t) − A sign x (V. I. Utkin 1992); the means of those that slide solve linear equations."""
    a = np.array([[1, 0.3, -0.2], [0.2, 1, 0.3], [-0.3, 0.2, 1]])
    b = lambda t: np.array([0.5 * np.sin(t), 0.4 * np.cos(t), 1.2 * np.sin(0.5 * t)])
    motion = _friction([0.5, -0.4, 0.3], 10, lambda t, x, q: b(t) + a @ q, lambda x: x, [_ONE] * 3)
    x = motion(10)
    assert max(abs(x[:2])) < 1e-9 and x[2] < 0
    u = np.linalg.solve(a[:2, :2], b(10)[:2] + a[:2, 2])
    return {"x1 at 10": x[0], "x2 at 10": x[1], "x3 at 10": x[2], "u1 at 10": u[0], "u3 at 10": -1.0}


def parallel_relays():
    """Only the sum of three equal relays is determined: it carries 0.5 cos t."""
    return {"x at 5": 0.0, "sum at 5": 0.5 * np.cos(5)}


def median_by_relays():
    """The third of five sines, and from 0.5 s on the integral of its square, by the trapezoidal rule."""
    sines = lambda t: [0.8 * np.sin(t + 2 * np.pi * k / 5 + 0.1 * k) + 0.03 * (k - 2) for k in range(5)]
    median = lambda t: np.sort(np.array(sines(t)), axis=0)[2]
    t = np.linspace(0.5, 12, 200001)
    square = median(t)**2
    area = (square.sum() - (square[0] + square[-1]) / 2) * (t[1] - t[0])
    return {f"x at {at}": float(median(at)) for at in (1, 3.3, 7, 12)} | {"i at 12": area}


def linear_program():
    """I. B. Pyne 1956: y = 2 t until 0.6, x = t until 0.4; the relays of 20 carry 1 and 1, before 0 and 2."""
    return {"x at 0.35": 0.35, "y at 0.35": 0.6, "s2 at 0.35": 0.1, "x at 2": 0.4, "y at 2": 0.6, "s1 at 2": 0.05,
            "s2 at 2": 0.05}


def spiral_of_two_relays():
    """x′ = −sign x + 2 sign y, y′ = −2 sign x − sign y from (1, 0.5): by straight lines; each turn leaves 1/81 of the
    distance, the time is a geometric series."""
    z, t, out = np.array([1.0, 0.5]), 0.0, {}
    while max(abs(z)) > 1e-14:
        # On an axis the side to which the other one's relay drives.
        sx = np.sign(z[0]) or np.sign(z[1])
        sy = np.sign(z[1]) or -np.sign(z[0])
        speed = np.array([-sx + 2 * sy, -2 * sx - sy])
        span, arrives = min((-z[k] / speed[k], k) for k in range(2) if z[k] * speed[k] < 0)
        for at in (0.1, 0.3):
            if t <= at < t + span:
                out[at] = z + speed * (at - t)
        z, t = z + speed * span, t + span
        z[arrives] = 0.0
    assert abs(t - 0.75) < 1e-9
    return {"x at 0.1": out[0.1][0], "x at 0.3": out[0.3][0], "y at 0.3": out[0.3][1], "x at 2": 0.0, "y at 4": 0.0}


def _arrives():
    """When x, which is 0.5 − t + 0.15 t² while the relay is 1, comes to 0, and when it leaves, as 0.3 t is 1."""
    return brentq(lambda t: 0.5 - t + 0.15 * t * t, 0, 1, xtol=1e-15), 1 / 0.3


def slide_that_is_held():
    """x′ = 0.3 t − sign x, held from 1 to 2 s, at 0."""
    free = lambda t: 0.15 * t * t - t
    begins, ends = _arrives()
    assert begins < 0.8
    return {"x at 0.4": 0.5 + free(0.4), "x at 1.5": 0.0, "u at 0.8": 0.3 * 0.8, "u at 3": 0.9,
            "x at 4": free(4) - free(ends), "e at 4": 4.0}


def slide_behind_an_amplifier():
    """The same without a hold; e^u is e or 1/e, with the mean cosh 1 + 0.3 t sinh 1 while u has the mean 0.3 t."""
    free = lambda t: 0.15 * t * t - t
    begins, ends = _arrives()
    mean = np.cosh(1) * (ends - begins) + 0.15 * np.sinh(1) * (ends**2 - begins**2)
    return {"e at 4": np.e * (begins + 4 - ends) + mean, "x at 4": free(4) - free(ends)}


def two_surfaces_in_small_units():
    """x′ = −u − v/2 + 0.6 sin t, y′ = 0.4 u − v + 1.1 cos 0.7 t with u = sign x, v = sign y (A. F. Filippov 1960), which
    slides along both lines, leaves them tangentially, and comes back; in units of 1e-5."""
    motion = _friction([0.5, -0.3], 20,
                       lambda t, y, q: [q[0] + 0.5 * q[1] + 0.6 * np.sin(t),
                                        -0.4 * q[0] + q[1] + 1.1 * np.cos(0.7 * t)],
                       lambda y: y, [_ONE] * 2)
    return {f"{name} at {t}": motion(t)[k] for t in (0.3, 5.5, 5.78, 7, 9.4, 15) for k, name in enumerate("xy")}


def three_blocks_in_small_units():
    """Blocks of masses 2, 1 and 1/2 on each other with dry friction 1.2 (on the ground, the lowest on a spring of 1/2), 0.6
    and 0.25, the middle one pulled by 3 sin 1.3 t; in units of 1e-6."""
    motion = _friction([0, 0, 0, 0], 25,
                       lambda t, y, q: [y[1], (-0.5 * y[0] + q[0] - q[1]) / 2, 3 * np.sin(1.3 * t) + q[1] - q[2],
                                        2 * q[2]],
                       lambda y: np.array([y[1], y[2] - y[1], y[3] - y[2]]),
                       [lambda w: 1.2, lambda w: 0.6, lambda w: 0.25])
    return {f"{name} at {t}": motion(t)[k] for t in (1, 3, 5, 10, 20, 25) for k, name in ((2, "v2"), (3, "v3"))}


def relay_with_a_dead_zone():
    """v′ = −1.78 w + 0.3 sin 1.3t with w = ±1 beyond ±0.2 of e = x + v/2. Along an edge e′ = v + v′/2 = 0, so v′ = −2v,
    for as long as that takes a w of the sign of the edge."""
    u = lambda t: 0.3 * np.sin(1.3 * t)
    e = lambda t, y: y[0] + y[1] / 2
    mean = lambda t, y: (u(t) + 2 * y[1]) / 1.78
    motion = Motion([-1, 0, 0])
    side, slides = -1, False
    while motion.t < 10:
        if slides:
            motion.go(lambda t, y: [y[1], -2 * y[1], side * mean(t, y)], 10, [(lambda t, y: side * mean(t, y), -1)])
            side, slides = 0, False
        elif side:
            motion.go(lambda t, y: [y[1], -1.78 * side + u(t), 1], 10, [(lambda t, y: side * e(t, y) - 0.2, -1)])
            if motion.t < 10:  # in the zone e goes on, or back to the edge
                v = motion.y[1]
                slides = side * (v + u(motion.t) / 2) > 0
                side = side if slides else 0
        else:
            hit = motion.go(lambda t, y: [y[1], u(t), 0], 10,
                            [(lambda t, y: e(t, y) - 0.2, 1), (lambda t, y: -e(t, y) - 0.2, 1)])
            if hit is None:
                break
            side = 1 if hit == 0 else -1
            beyond = side * (motion.y[1] + (u(motion.t) - 1.78 * side) / 2)
            slides = beyond < 0
    out = {}
    for t in ("4", "8", "10"):
        x, v, q = motion(float(t))
        out |= {f"x at {t}": x, f"v at {t}": v, f"q at {t}": q}
    return out

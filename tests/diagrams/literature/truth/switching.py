# SPDX-License-Identifier: MIT
"""Relays, sliding modes, limiters: solved piece by piece, sliding after A. F. Filippov."""
import numpy as np
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.optimize import brentq

from .tools import Motion, ode


def equivalent_control():
    """x″ = u + d, u = ∓2 on x + x′ ≷ 0, d = 0.5 sin t; on the line u is −x′ − d on average, |u| 2 and u² 4."""
    drive = lambda u: lambda t, y: [y[1], u + 0.5 * np.sin(t), u, abs(u), u * u, u * np.cos(t)]
    motion = Motion([1, 0.5, 0, 0, 0, 0])
    motion.go(drive(-2), 50, [(lambda t, y: y[0] + y[1], -1)])

    def slide(t, y):
        u = y[0] - 0.5 * np.sin(t)  # x′ = −x, so x″ = x = u + d
        return [-y[0], y[0], u, 2, 4, u * np.cos(t)]

    motion.go(slide, 10)
    x, _, mean, size, square, product = motion(10)
    return {"x at 10": x, "mean at 10": mean, "size at 10": size, "square at 10": square,
            "product at 10": product,
            "x at 0.5": motion(0.5)[0]}


def terminal_surface():
    """x″ = −2 sign(x′ + x|x|): on the surface x′ = −x², x = x₁/(1 + x₁ (t − t₁))."""
    motion = Motion([0.8, 0])
    motion.go(lambda t, y: [y[1], -2], 5, [(lambda t, y: y[1] + y[0] * abs(y[0]), -1)])
    x1, t1 = motion.y[0], motion.t
    x = x1 / (1 + x1 * (8 - t1))
    return {"x at 8": x, "v at 8": -x * x, "u at 8": 2 * x**3, "x at 0.2": 0.8 - 0.2**2}


def two_sliding_surfaces():
    """x₁′ = 0.4 sin t + u₁ + 0.3 u₂, x₂′ = 0.3 cos 2t − 0.2 u₁ + u₂, uᵢ = −sign xᵢ; both end on their
    surfaces."""
    d = lambda t: np.array([0.4 * np.sin(t), 0.3 * np.cos(2 * t)])
    b = np.array([[1, 0.3], [-0.2, 1]])
    motion = Motion([0.5, -1.3, 0, 0])

    def free(u):
        return lambda t, y: [*(d(t) + b @ u), *u]

    motion.go(free(np.array([-1.0, 1.0])), 9, [(lambda t, y: y[0], -1), (lambda t, y: y[1], 1)])
    assert motion.events[-1][1] == 0  # x₁ arrives first and slides

    def first(t, y):
        u = np.array([-(d(t)[0] + 0.3), 1.0])
        return [0, (d(t) + b @ u)[1], *u]

    motion.go(first, 9, [(lambda t, y: y[1], 1)])
    assert len(motion.events) == 2
    motion.go(lambda t, y: [0, 0, *np.linalg.solve(b, -d(t))], 9)
    last = np.linalg.solve(b, -d(9))
    return {"x1 at 9": 0.0, "x2 at 9": 0.0, "mean1 at 9": motion(9)[2], "mean2 at 9": motion(9)[3],
            "u1 at 9": last[0],
            "u2 at 9": last[1]}


def tsypkin_relay():
    """A relay and 1/(s + 1)³: half a period by the exact condition of Tsypkin and Hamel, solved for its fixed
    point."""
    a = np.array([[-1.0, 1, 0], [0, -1, 1], [0, 0, -1]])
    b = np.array([0, 0, 1.0])

    def half(tau, x):  # u = +1 for tau
        return expm(a * tau) @ x + np.linalg.solve(a, (expm(a * tau) - np.eye(3)) @ b)

    def start(tau):  # x with half(x) = −x
        return np.linalg.solve(expm(a * tau) + np.eye(3), -np.linalg.solve(a, (expm(a * tau) - np.eye(3)) @ b))

    tau = brentq(lambda tau: start(tau)[0], 1, 6)
    # From x = (1, 0, 0) on, piece by piece.
    motion, u = Motion([1, 0, 0]), -1
    while motion.t < 40:
        if motion.go(lambda t, x: a @ x + b * u, 40, [(lambda t, x: x[0], np.sign(u))], max_step=0.1) is None:
            break
        u = -u
    times = [t for t, _ in motion.events]
    assert abs(times[-1] - times[-2] - tau) < 1e-6
    return {"x at 10": motion(10)[0], "x at 40": motion(40)[0],
            "n at 40": float(sum(1 for t in times[1::2] if t < 40))}


def thermostat_cycles():
    """T′ = −T + 2 q, on below 0.95, off above 1.05."""
    heat = -np.log((2 - 1.05) / (2 - 0.95))
    cool = np.log(1.05 / 0.95)
    first = -np.log((2 - 1.05) / 2)
    cycles = int((30 - first) // (heat + cool))
    rest = 30 - first - cycles * (heat + cool)
    on = first + cycles * heat + max(0, rest - cool)
    end = 1.05 * np.exp(-rest) if rest < cool else 2 - (2 - 0.95) * np.exp(-(rest - cool))
    return {"T at 30": end, "on at 30": on, "n at 30": float(cycles + (rest > cool))}


def thermostat_ideal():
    """T′ = −T + q c, c = 1 or 0, held on r(t) = 0.5 + 0.1 sin t: the mean of c is (r′ + r)/q, q = 2 + cos t."""
    r = lambda t: 0.5 + 0.1 * np.sin(t)
    share = lambda t: (0.1 * np.cos(t) + r(t)) / (2 + np.cos(t))
    motion = ode(lambda t, y: [-y[0] + 2 + np.cos(t), 1], [0, 0], 5)
    t1 = brentq(lambda t: motion(t)[0] - r(t), 0.01, 1)
    return {"T at 12": r(12), "fuel at 12": t1 + quad(share, t1, 12, epsabs=1e-12)[0],
            "cost at 12": quad(lambda t: (1 + 0.5 * np.sin(2 * t)), 0, t1)[0]
            + quad(lambda t: share(t) * (1 + 0.5 * np.sin(2 * t)), t1, 12, epsabs=1e-12)[0],
            "off at 12": 12 - quad(share, t1, 12, epsabs=1e-12)[0] - t1}


def minimum_time_double_integrator():
    """x″ = u, |u| ≤ 1 from (2, 1): u = −1 until v = −√(2x), then +1."""
    v1 = -np.sqrt(2 + 0.5)  # x + v²/2 is 2.5 on the way, half of it at the switch
    t1 = 1 - v1
    end = t1 - v1
    return {"x at 1": 2.5, "x at 2.5": 2 + 2.5 - 2.5**2 / 2, "x at 5": 0.0, "v at 5": 0.0,
            "x at 4": (4 - end)**2 / 2, "v at 4": 4 - end}


def bushaw_oscillator():
    """x″ + x = u, |u| ≤ 1 (D. Bushaw 1953): circles about (u, 0); the switching curve near the origin is of
    radius 1."""
    s = lambda y: y[1] * abs(y[1]) + y[0] * (2 - abs(y[0]))
    f = lambda u: lambda t, y: [y[1], u - y[0]]
    motion = Motion([1.5, 0.5])
    motion.go(f(-1), 10, [(lambda t, y: s(y), -1)])
    x1, v1, t1 = *motion.y, motion.t
    assert x1 > 0 > v1
    end = t1 + np.arctan2(-v1, 1 - x1)  # on the circle about (1, 0), clockwise to the origin
    motion.go(f(1), end)
    return {"x at 1": motion(1)[0], "x at 2": motion(2)[0], "v at 2": motion(2)[1], "x at 4": 0.0,
            "v at 4": 0.0}


def satellite_deadband():
    """θ″ = −u, u = ±1 beyond ±0.1 of θ + 0.5 θ′; along the edge it slides: θ′ = 2 (0.1 − θ), θ″ = −2 θ′."""
    s = lambda y: y[0] + 0.5 * y[1]
    motion = Motion([0.5, 0.2, 0])
    motion.go(lambda t, y: [y[1], -1, 1], 20, [(lambda t, y: s(y) - 0.1, -1)])
    out = {"theta at 0.4": motion(0.4)[0]}
    # Below +0.1 with θ′ < 0 it drifts freely to the other edge, overshoots it (θ′ < −0.5), and comes back.
    motion.go(lambda t, y: [y[1], 0, 0], 20, [(lambda t, y: s(y) + 0.1, -1)])
    assert motion.y[1] < -0.5
    motion.go(lambda t, y: [y[1], 1, 1], 20, [(lambda t, y: s(y) + 0.1, 1)])
    # Outside s′ = θ′ + 0.5 > 0, inside s′ = θ′ < 0: it slides.
    assert -0.5 < motion.y[1] < 0 and motion.t < 3
    motion.go(lambda t, y: [y[1], -2 * y[1], abs(2 * y[1])], 20)
    out |= {"theta at 3": motion(3)[0], "theta at 20": motion(20)[0], "rate at 3": motion(3)[1],
            "fuel at 20": motion(20)[2]}
    return out


def schmitt_by_feedback():
    """y = clip(10 (x + 0.2 y), ±1): up where x rises through 0.1, down where it falls through −0.1; x = −0.5
    cos t."""
    up = np.arccos(-0.2)
    area = -up + np.pi - np.pi + np.pi - (12 - up - 3 * np.pi)  # low, high, low, high, low
    return {"y at 1.77": -1.0, "y at 1.78": 1.0, "y at 4.91": 1.0, "y at 4.92": -1.0, "y at 12": -1.0,
            "area at 12": area}


def limiter_astable():
    """v′ = u − v, u = clip(10 (u/2 − v), ±1): jumps where v = ±0.4."""
    half = np.log(1.4 / 0.6)
    n, rest = divmod(10 - np.log(1.45 / 0.6), half)
    sign = -1 if n % 2 == 0 else 1
    return {"v at 10": sign * (1 - 1.4 * np.exp(-rest)), "u at 10": float(sign), "v maximum": 0.4,
            "u maximum": 1.0,
            "u minimum": -1.0, "n at 10": float((n + 1) // 2)}


def relay_with_delay():
    """x′ = −u, the contact follows the sign of x after 0.1 s: a triangle of amplitude 0.1 and period 0.4."""
    # The contact starts at −1: x = 0.35 + t until 0.1; then it falls, through 0 at 0.55 and to −0.1 at 0.65.
    def x(t):
        phase = (t - 0.65) % 0.4
        return -0.1 + phase if phase < 0.2 else 0.1 - (phase - 0.2)

    return {"x at 7.3": x(7.3), "x at 19.9": x(19.9), "n at 19.9": float(np.floor((19.9 - 0.75) / 0.4) + 1)}


def antiwindup_back_calculation():
    """Plant 1/(s + 1)², PI with back calculation (Åström and Hägglund): I′ = 2 e + 4 (u − asked), u =
    clip(asked, 0, 1.2)."""
    asked = lambda y: 4 * (1 - y[0]) + y[2]

    def f(fixed):
        def rates(t, y):
            a = asked(y)
            u = a if fixed is None else fixed
            return [y[1], u - 2 * y[1] - y[0], 2 * (1 - y[0]) + 4 * (u - a)]
        return rates

    motion, mode = Motion([0, 0, 0]), 1.2
    while motion.t < 12:
        if mode is None:
            hit = motion.go(f(None), 12, [(lambda t, y: asked(y) - 1.2, 1), (lambda t, y: asked(y), -1)])
            mode = [1.2, 0.0][hit] if hit is not None else None
        else:
            hit = motion.go(f(mode), 12, [(lambda t, y: asked(y) - mode, -1 if mode else 1)])
            mode = None
        if hit is None:
            break
    return {"x at 2": motion(2)[0], "x at 4": motion(4)[0], "x at 12": motion(12)[0], "I at 4": motion(4)[2],
            "x maximum": motion.largest(lambda t, y: y[0])}


def backlash_limit_cycle():
    """A motor 1/(s (s + 1)) with gain 4 behind a gear with play 0.2; the driven side follows as the block's
    page says."""
    gap = lambda y: y[0] - y[2]
    f = lambda part: lambda t, y: [y[1], -y[1] - 4 * y[2], 1000 * (gap(y) - 0.1 * part) if part else 0.0]
    motion, part = Motion([1, 0, 0.95]), 0
    while motion.t < 12:
        guards = [(lambda t, y: gap(y) - 0.1, 1), (lambda t, y: gap(y) + 0.1, -1)] if part == 0 else [
            (lambda t, y: gap(y) - 0.1 * part, -part)]
        hit = motion.go(f(part), 12, guards, method="Radau", max_step=0.02, atol=1e-13)
        if hit is None:
            break
        part = (1, -1)[hit] if part == 0 else 0
    return {"x at 2": motion(2)[0], "x at 6": motion(6)[0], "y at 12": motion(12)[2]}


def saturating_time_optimal():
    """Time-optimal with a saturating amplifier instead of the relay: x″ = −clip(5 (x + v|v|/2), ±1)."""
    s = lambda y: 5 * (y[0] + y[1] * abs(y[1]) / 2)
    motion, mode = Motion([1, 0]), 1
    f = lambda mode: lambda t, y: [y[1], -s(y) if mode == 0 else -mode]
    while motion.t < 10:
        if mode == 0:
            hit = motion.go(f(0), 10, [(lambda t, y: s(y) - 1, 1), (lambda t, y: s(y) + 1, -1)], max_step=0.05)
            mode = (1, -1)[hit] if hit is not None else 0
        else:
            hit = motion.go(f(mode), 10, [(lambda t, y: s(y) - mode, -mode)], max_step=0.05)
            mode = 0 if hit is not None else mode
        if hit is None:
            break
    return {"x at 1.5": motion(1.5)[0], "x at 3": motion(3)[0], "v at 3": motion(3)[1],
            "x at 10": motion(10)[0]}

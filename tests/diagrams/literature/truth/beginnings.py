# SPDX-License-Identifier: MIT
"""Where a run begins: singular points, circles of initial values, roots beside others; small units and decays."""
import numpy as np
from mpmath import mp
from scipy.optimize import brentq
from scipy.special import eval_legendre, hyp1f1, sici

from .tools import ode


def initial_values_in_a_circle():
    dottie = brentq(lambda x: np.cos(x) - x, 0, 1, xtol=1e-16)
    return {"p at 0": dottie, "u at 0": 50.0, "p at 2": dottie * np.exp(-2), "q at 2": dottie * np.exp(-4)}


def amplifier_beside_a_ridge():
    y = brentq(lambda y: y - np.arctan(3 * y), -3, -0.5, xtol=1e-15)
    return {"y at 0": y, "y at 1": y, "z at 1": 1.0}


def oscillator_of_nanoamperes():
    w = np.sqrt(1 - 0.05**2)
    x = lambda t: 1e-9 * np.exp(-0.05 * t) * (np.cos(w * t) + 0.05 / w * np.sin(w * t))
    return {"x at 1": x(1), "x at 30": x(30), "u at 10": 1e-9 / 11, "u at 30": 1e-9 / 31}


def traces_beside_a_unit():
    """The forced oscillation, and from it the free one that makes x and x′ zero at the start."""
    forced = 1e-13 / (3 + 0.1j)
    w = np.sqrt(4 - 0.05**2)
    free = -forced.real + 1j * (0.05 * forced.real - forced.imag) / w

    def x(t):
        return float((forced * np.exp(1j * t)).real + (free * np.exp((-0.05 + 1j * w) * t)).real)

    return {"b at 50": np.cos(50), "d at 20": 1e-9 * np.cos(40), "d at 50": 1e-9 * np.cos(100),
            "x at 20": x(20), "x at 50": x(50)}


def sine_integral():
    return {"q at 0": 1.0, "y at 10": float(sici(10)[0]), "y at 100": float(sici(100)[0])}


def cusp_of_an_amplifier():
    y = lambda t: abs(t - 1)**(2 / 3)
    return {"y at 0": 1.0, "y at 0.9": y(0.9), "y at 1.1": y(1.1), "y at 2": 1.0}


def hysteresis_of_a_cubic():
    end = np.arcsin(2 / np.sqrt(27) / 0.8)

    def y(t):
        upper = np.floor((t - end) / np.pi) % 2 == 0  # it is left at π + end, taken at 2π + end, …
        u = 0.8 * np.sin(t)
        roots = np.roots([1, 0, -1, -u])
        real = sorted(roots[abs(roots.imag) < 1e-7].real)
        root = real[-1] if upper else real[0]
        return float(root - (root**3 - root - u) / (3 * root**2 - 1))

    return {f"y at {t:g}": y(t) for t in (1, 3.5, 4, 6.2, 7, 10.2, 20)}


def kummer_from_zero():
    return {f"y at {t:g}": float(hyp1f1(0.7, 1.6, t)) for t in (0.5, 2, 4)}


def legendre_from_its_end():
    return {f"y at {t:g}": float(eval_legendre(6, 1 - t)) for t in (0.5, 1, 1.9)}


def three_seeds():
    def f(t, u):
        x, y, z = np.exp(u)
        return [1 - x - 2 * y, 1 - y - 2 * z, 0.8 - z]

    motion = ode(f, np.log([1e-5, 1e-12, 1e-20]), 80)
    at = lambda name, t: float(np.exp(motion(t)["xyz".index(name)]))
    return {f"{name} at {t}": at(name, t) for name, t in (("x", 20), ("x", 30), ("y", 40), ("z", 60), ("x", 80))}


def painleve_towards_a_pole():
    motion = ode(lambda t, y: [y[1], 6 * y[0]**2 + t], [0, 0], 2.4)
    return {f"y at {t:g}": float(motion(t)[0]) for t in (1, 2, 2.4)}


def toda_lattice():
    def f(t, y):
        first, middle, last = np.exp(-y[0]), np.exp(y[0] - y[1]), np.exp(y[1])
        return [y[2], y[3], first - middle, middle - last]

    start = [0.5, -0.3, 0.2, 0.1]
    motion = ode(f, start, 20)
    energy = (0.2**2 + 0.1**2) / 2 + np.exp(-0.5) + np.exp(0.8) + np.exp(-0.3)
    return {"q1 at 5": float(motion(5)[0]), "q1 at 20": float(motion(20)[0]), "q2 at 20": float(motion(20)[1]),
            "energy at 20": energy}


def bateman_chain():
    rates = [mp.mpf(10)**(-mp.mpf(i) / 4) for i in range(8)]

    def n(k, t):
        with mp.workdps(40):
            terms = [mp.exp(-rates[i] * t) / mp.fprod(rates[j] - rates[i] for j in range(k + 1) if j != i)
                     for i in range(k + 1)]
            return float(mp.fprod(rates[:k]) * mp.fsum(terms))

    return {"n3 at 1": n(3, 1), "n3 at 10": n(3, 10), "n7 at 100": n(7, 100), "n7 at 1000": n(7, 1000)}


def logarithm_of_a_decay():
    return {"log_x at 20": -20.0, "log_x at 60": -60.0, **{f"log_y at {t}": 30 * np.sin(t) for t in (5, 11, 60)}}


def resistor_of_straight_lines():
    """On the third line until x = −1, at 1.9, and then on the first."""
    line = lambda t: (0.9 - t + 3) / 2
    return {"y at 0": line(0), "y at 1": line(1), "z at 1": 1.95 - 0.25, "y at 2.5": (0.9 - 2.5 - 3) / 2}


def cubic_by_straight_lines():
    """From −1, where the cubic is 0, to −0.9, where it is 0.171."""
    y = -1 + 0.1 * 0.1 / (0.9 - 0.9**3)
    return {"y at 0": y, "y at 1": y}


def comparator_by_its_amplifier():
    return {"y at 0": 2.5, "y at 1": 2.5}


def schmitt_trigger_of_a_real_amplifier():
    turns = [np.pi / 6 + k * np.pi for k in range(4)]
    z, sign = 0.0, 1
    for begin, end in zip([0, *turns], [*turns, 10]):
        z, sign = z + sign * (end - begin), -sign
    return {"c at 0": 1.0, "c at 5": 1.0, "z at 10": z}

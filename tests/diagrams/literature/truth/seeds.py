# SPDX-License-Identifier: MIT
"""What falls far below the tolerance and grows again, and problems in units that make everything small."""
import numpy as np
from scipy.special import expit

from .tools import ode


def _logit(p):
    return np.log(p) - np.log1p(-p)


def mutant_behind_a_switch():
    """x′ = ∓x (1 − x), the sign turned at 40: a logistic function there and back."""
    x = lambda t: float(expit(_logit(1e-12) + abs(t - 40) - 40))
    return {f"x at {t}": x(t) for t in (30, 100, 106, 110, 150)}


def cascade_of_seeds():
    """The logit of each grows by the integral of the one before; that of the first, ln(1 + 1e-13 (e^t − 1)), is a
    closed form."""
    y = lambda t: float(expit(_logit(1e-18) + np.log1p(1e-13 * np.expm1(t))))
    motion = ode(lambda t, s: [y(t)], [0], 200, max_step=0.5)
    z = lambda t: float(expit(_logit(1e-25) + motion(t)[0]))
    return {"x at 30": float(expit(_logit(1e-13) + 30)), "y at 70": y(70), "y at 72": y(72), "z at 126": z(126),
            "z at 129": z(129), "z at 200": z(200)}


def hyperbolic_growth():
    """H. von Foerster 1960: 1/x = 1e12 − t."""
    return {"x at 0.5e12": 2e-12, "x at 0.99999e12": 1 / (1e12 - 0.99999e12)}


def lotka_volterra_deep():
    """In logarithms; x − ln x + y − ln y is kept."""
    motion = ode(lambda t, u: [-np.expm1(u[1]), np.expm1(u[0])], np.log([30, 30]), 300, atol=1e-13)
    kept = lambda u: np.exp(u).sum() - u.sum()
    assert abs(kept(motion(300)) - kept(motion(0))) < 1e-8
    out = {}
    for t in (5, 50, 60.6, 150, 300):
        x, y = np.exp(motion(t))
        out |= {f"x at {t}": x, f"y at {t}": y}
    return out


def sir_with_births():
    """i in its logarithm; LSODA is exact where a part of it ends."""
    def f(t, y):
        new = 1800 * y[0] * np.exp(y[1])
        return [0.02 * (1 - y[0]) - new, 1800 * y[0] - 100, new]

    motion = ode(f, [0.9, np.log(1e-4), 0], 30, method="LSODA", atol=1e-13, breaks=(1, 10, 20))
    out = {}
    for t in (1, 10, 20, 30):
        s, i, c = motion(t)
        out |= {f"s at {t}": s, f"i at {t}": np.exp(i), f"c at {t}": c}
    return out


def synapse_in_siemens():
    """In nS and in mV above the rest of −70 mV: with 0.1 nF, 10 nS and the synapse's way of 70 mV."""
    motion = ode(lambda t, y: [-200 * y[0], (-10 * y[1] + y[0] * (70 - y[1])) / 0.1], [0.2, 0], 0.05)
    return {f"mV at {t}": motion(t)[1] for t in (0.005, 0.01, 0.03, 0.05)}


def enzyme_in_molar():
    """L. Michaelis and M. L. Menten's equations in nM; e + c = 1 and s + c + p = 1000 are kept."""
    def f(t, y):
        c, p = y
        bind = 0.1 * (1 - c) * (1000 - c - p)
        return [bind - 110 * c, 100 * c]

    motion = ode(f, [0, 0], 20, method="LSODA", atol=1e-13, breaks=(1, 10))
    out = {}
    for t in (1, 10, 20):
        out |= {f"P at {t}": motion(t)[1] / 1000, f"c at {t}": motion(t)[0]}
    return out


def pulse_upon_an_unstable_rest():
    """x/√(1 − x²) = ε e^t, ε by completing the square of −t − ((t − 10)/0.1)²."""
    seed = 1e-10 * 0.1 * np.sqrt(np.pi) * np.exp(-10 + 0.0025)
    x = lambda t: seed * np.exp(t) / np.sqrt(1 + (seed * np.exp(t))**2)
    return {f"x at {t}": x(t) for t in (30, 34, 42)}

# SPDX-License-Identifier: MIT
"""Independent parts in one diagram, and functions that saturate."""
import mpmath as mp
from scipy.special import iv

from .tools import ode


def band_by_two_logistics():
    """The window in the variable d = exp(-t/20), of which dt = -20 dd/d."""
    with mp.workdps(30):
        window = lambda d: 40 / (1 + mp.exp(-(d - 0.1) * 7500)) - 40 / (1 + mp.exp(-(d - 0.101) * 7500))
        area = mp.quad(lambda d: 20 * window(d) / d, [mp.exp(-3.5), 0.09, 0.0995, 0.1, 0.1005, 0.101, 0.1015, 0.11, 1])
    return {"v at 40": 1.0, "v at 70": float(1 + area)}


def logistic_far_beyond():
    return {"v at 10": float(mp.log(2) / 200), "v at 1": float(mp.log(2) / 200)}


def transcritical_beside_a_clock():
    """logit(x) goes with the integral of 3 (t - 5)."""
    logit = lambda t: mp.log(mp.mpf("1e-3") / (1 - mp.mpf("1e-3"))) + 1.5 * ((t - 5)**2 - 25)
    return {f"x at {t}": float(1 / (1 + mp.exp(-logit(mp.mpf(t))))) for t in (2, 9.9, 10.1, 14)}


def fed_rest_beside_a_relay():
    y = ode(lambda t, y: [3 * y[0] - 3 * y[0]**3 + 1e-11], [0.0], 12, atol=1e-22)
    return {f"y at {t}": float(y(t)[0]) for t in (8.4, 8.7, 12)}


def logistic_seed_in_a_short_run():
    logistic = lambda t: 1 / (1 + (mp.mpf(10)**13 - 1) * mp.exp(-mp.mpf(t)))
    return {"y at 14.2": float(logistic("14.2"))}


def logarithm_of_a_decay_beside_a_swing():
    level = lambda t: mp.log(mp.mpf("1e-18") + (1 - mp.mpf("1e-18")) * mp.exp(-t))
    return {f"l at {t}": float(level(t)) for t in (20, 27, 30)}


def latch_beside_a_sign_at_zero():
    return {"size at 0": 1.0, "size at 3": 1.0, "v at 3": 0.0}


def friction_beside_a_triangle():
    """A triangle within +-0.4 by 1 a second, from its lower corner."""
    x = lambda t: 0.4 - abs(t % 1.6 - 0.8)
    return {"x at 0.4": x(0.4), "x at 1.1": x(1.1), "x at 3": x(3), "v at 3": 0.0}


def bessel_beside_a_servo():
    """I0, and a servo that follows at once to 1 in its gain."""
    return {"y at 1": float(iv(0, 1)), "y at 2": float(iv(0, 2))}


def slide_beside_a_sawtooth():
    """x falls at 1 with what the sine adds, then slides: |0.4 sin 2t| < 1."""
    fall = lambda t: 1 - t + 0.2 * (1 - mp.cos(2 * t))
    end = mp.findroot(fall, 1.2)
    assert 0 < end < 2
    return {"x at 0.5": float(fall(mp.mpf("0.5"))), "x at 2": 0.0, "x at 12": 0.0}


def angle_beside_a_swing():
    return {f"angle at {t}": float(mp.asin(0.95 * mp.sin(5 * t))) for t in (1, 7, 10)}

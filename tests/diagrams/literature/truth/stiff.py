# SPDX-License-Identifier: MIT
"""Stiff problems, most of them of the test set of F. Mazzia and C. Magherini (Bari 2008), by Radau IIA."""
import numpy as np

from .tools import ode


def _stiff(f, y, until, **options):
    return ode(f, y, until, method="Radau", **options)


def robertson():
    f = lambda t, y: [-0.04 * y[0] + 1e4 * y[1] * y[2], 0.04 * y[0] - 1e4 * y[1] * y[2] - 3e7 * y[1]**2,
                      3e7 * y[1]**2]
    motion = _stiff(f, [1, 0, 0], 4e4)
    return {"y1 at 0.4": motion(0.4)[0], "y2 at 0.4": motion(0.4)[1], "y1 at 400": motion(400)[0],
            "y1 at 4e4": motion(4e4)[0],
            "y3 at 4e4": motion(4e4)[2]}


def hires():
    def f(t, y):
        a, b, c, d, e, g, h, k = y
        return [-1.71 * a + 0.43 * b + 8.32 * c + 0.0007, 1.71 * a - 8.75 * b,
                -10.03 * c + 0.43 * d + 0.035 * e,
                8.32 * b + 1.71 * c - 1.12 * d, -1.745 * e + 0.43 * g + 0.43 * h,
                -280 * g * k + 0.69 * d + 1.71 * e - 0.43 * g + 0.69 * h, 280 * g * k - 1.81 * h, -280 * g * k + 1.81 * h]

    motion = _stiff(f, [1, 0, 0, 0, 0, 0, 0, 0.0057], 321.8122)
    assert abs(motion(321.8122)[0] - 0.7371312573325668e-3) < 1e-10  # the test set's
    return {"y1 at 321.8122": motion(321.8122)[0], "y5 at 321.8122": motion(321.8122)[4],
            "y7 at 321.8122": motion(321.8122)[6],
            "y6 at 10": motion(10)[5]}


def oregonator():
    f = lambda t, y: [77.27 * (y[1] + y[0] * (1 - 8.375e-6 * y[0] - y[1])), (y[2] - (1 + y[0]) * y[1]) / 77.27,
                      0.161 * (y[0] - y[2])]
    motion = _stiff(f, [1, 2, 3], 360, atol=1e-10)
    assert abs(motion(360)[1] - 1228.178521549917) < 1e-4  # the test set's
    # y₁ scaled by 1e5, y₂ by 1e4, y₃ by 1e5, as on a machine
    return {"y1 at 5": motion(5)[0], "y3 at 30": motion(30)[2], "y1 at 360": motion(360)[0],
            "y2 at 360": motion(360)[1], "y3 at 360": motion(360)[2]}


def van_der_pol_1000():
    motion = _stiff(lambda t, y: [y[1], 1000 * (1 - y[0]**2) * y[1] - y[0]], [2, 0], 2000)
    assert abs(motion(2000)[0] - 1.706167732170483) < 1e-7  # the test set's
    return {"x at 800": motion(800)[0], "x at 1000": motion(1000)[0], "x at 2000": motion(2000)[0]}


def prothero_robinson():
    return {"y at 1": float(np.cos(1)), "y at 10": float(np.cos(10))}


def michaelis_menten():
    """s′ = −s + (s + 0.5) c, ε c′ = s − (s + 1) c with ε = 1e-5 (L. Segel and M. Slemrod 1989)."""
    motion = _stiff(lambda t, y: [-y[0] + (y[0] + 0.5) * y[1], 1e5 * (y[0] - (y[0] + 1) * y[1])], [1, 0], 5)
    return {"s at 1": motion(1)[0], "c at 1": motion(1)[1], "c at 1e-5": motion(1e-5)[1],
            "s at 5": motion(5)[0]}


def diode_rectifier():
    f = lambda t, v: [1e4 * 1e-9 * (np.exp((5 * np.sin(100 * np.pi * t) - v[0]) / 0.026) - 1) - 10 * v[0]]
    motion = _stiff(f, [0], 0.1, max_step=1e-4)
    return {"v at 0.005": motion(0.005)[0], "v at 0.02": motion(0.02)[0], "v at 0.1": motion(0.1)[0],
            "v maximum": motion.largest(lambda t, v: v[0], samples=20001)}


def pollution():
    """J. G. Verwer 1994: 20 species, 25 reactions."""
    k = [.35, .266e2, .123e5, .86e-3, .82e-3, .15e5, .13e-3, .24e5, .165e5, .9e4, .22e-1, .12e5, .188e1,
         .163e5, .48e7, .35e-3,
         .175e-1, .1e9, .444e12, .124e4, .21e1, .578e1, .474e-1, .178e4, .312e1]

    def f(t, y):
        y = [None, *y]
        r = [None, k[0] * y[1], k[1] * y[2] * y[4], k[2] * y[5] * y[2], k[3] * y[7], k[4] * y[7],
             k[5] * y[7] * y[6], k[6] * y[9],
             k[7] * y[9] * y[6], k[8] * y[11] * y[2], k[9] * y[11] * y[1], k[10] * y[13], k[11] * y[10] * y[2], k[12] * y[14],
             k[13] * y[1] * y[6], k[14] * y[3], k[15] * y[4], k[16] * y[4], k[17] * y[16], k[18] * y[16], k[19] * y[17] * y[6],
             k[20] * y[19], k[21] * y[19], k[22] * y[1] * y[4], k[23] * y[19] * y[1], k[24] * y[20]]
        return [-r[1] - r[10] - r[14] - r[23] - r[24] + r[2] + r[3] + r[9] + r[11] + r[12] + r[22] + r[25],
                -r[2] - r[3] - r[9] - r[12] + r[1] + r[21], -r[15] + r[1] + r[17] + r[19] + r[22], -r[2] - r[16] - r[17] - r[23] + r[15],
                -r[3] + 2 * r[4] + r[6] + r[7] + r[13] + r[20], -r[6] - r[8] - r[14] - r[20] + r[3] + 2 * r[18], -r[4] - r[5] - r[6] + r[13],
                r[4] + r[5] + r[6] + r[7], -r[7] - r[8], -r[12] + r[7] + r[9], -r[9] - r[10] + r[8] + r[11], r[9], -r[11] + r[10],
                -r[13] + r[12], r[14], -r[18] - r[19] + r[16], -r[20], r[20], -r[21] - r[22] - r[24] + r[23] + r[25], -r[25] + r[24]]

    y = np.zeros(20)
    y[[1, 3, 6, 7, 8, 16]] = 0.2, 0.04, 0.1, 0.3, 0.01, 0.007
    motion = _stiff(f, y, 60)
    assert abs(motion(60)[0] - 0.5646255480022769e-1) < 1e-9  # the test set's
    return {"y1 at 60": motion(60)[0], "y2 at 60": motion(60)[1], "y4 at 60": motion(60)[3],
            "y19 at 60": motion(60)[18], "y7 at 5": motion(5)[6]}


def scaled_chain_e5():
    """E5 of W. H. Enright, T. E. Hull and B. Lindberg 1975, each species in units of its own greatest size."""
    a, b, c, m = 7.89e-10, 1.1e7, 1.13e3, 1e6

    def f(t, y):
        r1, r2, r3, r4 = a * y[0], b * y[0] * y[2], m * c * y[1] * y[2], c * y[3]
        return [-r1 - r2, r1 - r3, r1 - r2 - r3 + r4, r2 - r4]

    motion = _stiff(f, [1.76e-3, 0, 0, 0], 1e5, atol=1e-28)
    return {"y1 at 1000": motion(1000)[0] / 1.76e-3, "y2 at 1000": motion(1000)[1] / 1e-9,
            "y2 at 1e5": motion(1e5)[1] / 1e-9,
            "y1 at 1e5": motion(1e5)[0] / 1.76e-3}


def van_der_pol_million():
    f = lambda t, y: [y[1], 1e6 * ((1 - y[0]**2) * y[1] - y[0])]
    motion = ode(f, [2, 0], 2, method="LSODA", atol=1e-13)
    assert abs(motion(2)[0] - 1.706167732170483) < 1e-9  # the test set's
    return {"x at 2": motion(2)[0], "v at 2": motion(2)[1]}


def akzo_nobel():
    """The test set's index 1 with y₆ = 115.83 y₁ y₄ put in."""
    def f(t, y):
        a, b, c, d, e = y
        root = np.sqrt(b)
        r1, r2, r3, r4 = 18.7 * a**4 * root, 0.58 * c * d, 0.58 / 34.4 * a * e, 0.09 * a * d * d
        r5 = 0.42 * (115.83 * a * d)**2 * root
        return [-2 * r1 + r2 - r3 - r4, -0.5 * r1 - r4 - 0.5 * r5 + 3.3 * (0.9 / 737 - b), r1 - r2 + r3,
                -r2 + r3 - 2 * r4, r2 - r3 + r5]

    y = _stiff(f, [0.444, 0.00123, 0, 0.007, 0], 180)(180)
    assert abs(y[0] - 0.1150794920661702) < 1e-10  # the test set's
    return {f"y{k + 1} at 180": y[k] for k in range(5)} | {"y6 at 180": 115.83 * y[0] * y[3]}


def melting_slab():
    place = np.arange(1, 10) / 10

    def f(_, y):
        s, u = y[0], np.concatenate([[1], y[1:], [0]])
        speed = (4 * u[9] - u[8]) / (0.2 * s)
        return np.concatenate([[speed], (u[2:] - 2 * u[1:-1] + u[:-2]) * 100 / s**2
                               + place * speed / s * (u[2:] - u[:-2]) * 5])

    motion = _stiff(f, np.concatenate([[1e-3], 1 - place]), 5)
    return {f"{name} at {t}": motion(t)[i] for t in (0.1, 5) for name, i in (("front", 0), ("middle", 5))}

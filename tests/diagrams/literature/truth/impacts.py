# SPDX-License-Identifier: MIT
"""Impacts, and what else starts anew from one instant to the next."""
import numpy as np


def _galperin(ratio):
    """G. Galperin 2003: with the heavy ball's way √ratio times as long, the two balls are a point that moves straight
    through a wedge of the angle θ, reflected at each passage of a multiple of θ. It passes at the distance 1, at t =
    2."""
    root = np.sqrt(ratio)
    theta = np.arctan(1 / root)
    n = int(np.ceil(np.pi / theta)) - 1
    assert 2 - 1 / (np.tan(n * theta) * root) < 10  # the last impact
    rest = np.pi - n * theta if n % 2 == 0 else (n + 1) * theta - np.pi
    return {"n at 10": float(n), "v1 at 10": root * np.sin(rest), "v2 at 10": np.cos(rest)}


def galperin_314():
    return _galperin(1e4)


def galperin_3141():
    return _galperin(1e6)


def galperin_31415():
    return _galperin(1e8)


def rocking_block():
    """G. W. Housner 1963: φ″ = 4 (φ − sign φ) from 0.5. Each passage leaves 0.64 of ω² = 4 (1 − (1 − top)²), so the
    tops follow from each other, and between two passages φ = 1 − (1 − top) cosh 2(t − middle)."""
    tops = [1 - np.sqrt(1 - 0.64**n * 0.75) for n in range(60)]
    quarters = [np.arccosh(1 / (1 - top)) / 2 for top in tops]
    ends = np.cumsum([quarters[0], *(2 * quarter for quarter in quarters[1:])])

    def count(t):
        return int(np.searchsorted(ends, t))

    def angle(t):
        n = count(t)
        return (-1)**n * (1 - (1 - tops[n]) * np.cosh(2 * (t - ends[n] + quarters[n])))

    return {"angle at 2": angle(2), "angle at 3.5": angle(3.5), "n at 3": float(count(3)),
            "n at 4": float(count(4)), "angle at 4": angle(4)}


def ball_by_integrators():
    """1 − t² until t = 1, then flights v s − s², each with 0.8 of the speed before."""
    def at(t):
        if t <= 1:
            return 1 - t * t, 0
        start, v, n = 1.0, 1.6, 1
        while start + v < t:
            start, v, n = start + v, 0.8 * v, n + 1
        return v * (t - start) - (t - start)**2, n

    out = {}
    for t in (2, 5, 8.5):
        y, n = at(t)
        out |= {f"y at {t}": y, f"n at {t}": float(n)}
    return out


def two_tanks_zeno():
    """J. Zhang and others 2001: the tank with the hose gains 0.25, the other loses 0.5 a second; the hose goes to the
    one that is empty. Counted are the times at which it comes to the second tank."""
    levels, t, hose, n = [1.0, 1.0], 0.0, 0, 0
    while True:
        other = 1 - hose
        span = min(levels[other] / 0.5, 7.9 - t)
        t += span
        levels[hose] += 0.25 * span
        levels[other] -= 0.5 * span
        if t >= 7.9:
            return {"x1 at 7.9": levels[0], "x2 at 7.9": levels[1], "n at 7.9": float(n)}
        levels[other], hose = 0.0, other
        n += hose == 1


def two_neurons_locked():
    """R. E. Mirollo and S. H. Strogatz 1990: x′ = 1.2 − x, from firing to firing; the one that is pushed above 1
    fires too, and from then on both are one."""
    v, fired, t, out = np.array([0.3, 0.0]), np.array([0, 0]), 0.0, {}
    after = lambda span: 1.2 - (1.2 - v) * np.exp(-span)
    while t < 30:
        first = int(np.argmax(v))
        span = np.log((1.2 - v[first]) / 0.2)
        for at in (3.1, 6.2, 20, 30):
            if t <= at < t + span:
                now = after(at - t)
                out |= {f"x at {at}": now[0], f"y at {at}": now[1], f"n at {at}": float(fired[0]),
                        f"m at {at}": float(fired[1])}
        other, v, t = 1 - first, after(span), t + span
        v[first] = 0
        fired[first] += 1
        v[other] += 0.05
        if v[other] > 1:
            v[other] = 0
            fired[other] += 1
    return out


def hopfield_converter():
    """D. W. Tank and J. J. Hopfield 1986, with ideal thresholds: exponentials from threshold to threshold."""
    w = -np.array([[0, 2, 4, 8], [2, 0, 8, 16], [4, 8, 0, 32], [8, 16, 32, 0]])
    u, c, t = np.array([-0.01, -0.02, -0.03, -0.04]), np.zeros(4), 0.0
    while True:
        aim = w @ c + [10.7, 20.4, 36.8, 57.6]
        goes = [k for k in range(4) if aim[k] * (c[k] - 0.5) < 0]  # to the other side of its threshold
        spans = {np.log1p(-u[k] / aim[k]): k for k in goes}
        span = min(spans, default=np.inf)
        if t + span > 5:
            u = aim + (u - aim) * np.exp(t - 5)
            return {f"c{k} at 5": c[k] for k in range(4)} | {"u0 at 5": u[0]}
        k, t = spans[span], t + span
        u = aim + (u - aim) * np.exp(-span)
        u[k], c[k] = 0.0, 1 - c[k]


def ring_oscillator():
    """a′ = −sign c − a and round the ring (L. Glass 1975): exponentials from threshold to threshold."""
    x, s, t, n = np.array([0.5, -0.2, 0.1]), np.array([1, -1, 1]), 0.0, 0
    while True:
        aim = -s[[2, 0, 1]]
        spans = {np.log1p(-x[k] / aim[k]): k for k in range(3) if aim[k] != s[k]}
        span = min(spans)
        if t + span > 100:
            x = aim + (x - aim) * np.exp(t - 100)
            return {"a at 100": x[0], "b at 100": x[1], "n at 100": float(n)}
        k, t = spans[span], t + span
        x = aim + (x - aim) * np.exp(-span)
        x[k], s[k] = 0.0, -s[k]
        n += k == 0 and s[0] > 0

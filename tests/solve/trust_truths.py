#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes lorenz_truths.inc: x of Lorenz's equations from (1, 1, 1), by Taylor series in 60 digits.

    python3 trust_truths.py > lorenz_truths.inc        needs mpmath
"""
import mpmath as mp

mp.mp.dps = 60
ORDER = 40
BETA = mp.mpf(8 / 3)  # the double that Oblique has


def step(state, h):
    """The series of the solution: of a product, the sums of Cauchy."""
    x, y, z = ([v] for v in state)
    for n in range(ORDER):
        xz = sum(x[k] * z[n - k] for k in range(n + 1))
        xy = sum(x[k] * y[n - k] for k in range(n + 1))
        x.append(10 * (y[n] - x[n]) / (n + 1))
        y.append((28 * x[n] - y[n] - xz) / (n + 1))
        z.append((xy - BETA * z[n]) / (n + 1))
    return [mp.polyval(c[::-1], h) for c in (x, y, z)]


def solve(steps_a_second):
    state, found = [mp.mpf(1)] * 3, []
    for k in range(1, 40 * steps_a_second + 1):
        state = step(state, mp.mpf(1) / steps_a_second)
        if k % (5 * steps_a_second) == 0:
            found.append((k // steps_a_second, state[0]))
    return found


coarse, fine = solve(50), solve(70)
assert all(abs(a[1] - b[1]) < mp.mpf("1e-16") for a, b in zip(coarse, fine))
for t, value in fine:
    print(f"{{{t}.0, {float(value)!r}}},")

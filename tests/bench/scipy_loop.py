#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Four-bars whose crank errs in x and in y, as its two weights do: by SciPy in a loop of Python, and by `oblique sweep` in one thread.

    tests/bench/scipy_loop.py build/release/src/cli/oblique

Needs NumPy and SciPy (Debian: python3-scipy). The equations are those of the patched four-bar: the crank's circle, and
the five servo amplifiers of a triangle. SciPy gets the exact Jacobian, the start at rest, and of its stiff methods the
fastest one; both sides are measured where their largest error is 1e-6 of a machine unit.
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.integrate import solve_ivp

ROOT = pathlib.Path(__file__).resolve().parents[2]
MECHANISM = ROOT / "diagrams/mechanisms/four-bar.toml"
RATE = 2 * math.pi * 20  # 1/τ of the amplifiers [1/s]
GAIN = RATE * 1e6 * 10  # times their gain and the weight of the residuals
CRANK, R1, R2, REACH = 0.25, 0.875, 0.75, 1.25
SCATTER = 0.005
UNTIL = 2 * math.pi
ERROR = 1e-6
LEAST = 300  # times faster


def equations(bx, by):
    """dx/dt and its Jacobian; states: cos and sin of the crank, then L, cos ψ, sin ψ, cos γ, sin γ."""
    adjacent, opposite = R1 / REACH, (R2 / REACH) ** 2
    half = 1 / (2 * adjacent)

    def rates(_, x):
        c, s, length, cos, sin, cos_angle, sin_angle = x
        hold = 0.1 * (1 - c * c - s * s)
        dx, dy = (1 - bx * c) / REACH, -by * s / REACH
        return [-s + hold * c, c + hold * s,
                -RATE * length - GAIN * (length * length - dx * dx - dy * dy),
                -RATE * cos - GAIN * (length * cos - dx),
                -RATE * sin - GAIN * (length * sin - dy),
                -RATE * cos_angle - GAIN * (length * cos_angle - half * (length * length - opposite) - adjacent / 2),
                -RATE * sin_angle - GAIN * (sin_angle * sin_angle + cos_angle * cos_angle - 1)]

    def jacobian(_, x):
        c, s, length, cos, sin, cos_angle, sin_angle = x
        dx, dy, to_x, to_y = (1 - bx * c) / REACH, -by * s / REACH, -bx / REACH, -by / REACH
        j = np.zeros((7, 7))
        j[0, 0], j[0, 1] = 0.1 * (1 - 3 * c * c - s * s), -1 - 0.2 * c * s
        j[1, 0], j[1, 1] = 1 - 0.2 * c * s, 0.1 * (1 - c * c - 3 * s * s)
        j[2, 0], j[2, 1], j[2, 2] = GAIN * 2 * dx * to_x, GAIN * 2 * dy * to_y, -RATE - GAIN * 2 * length
        j[3, 0], j[3, 2], j[3, 3] = GAIN * to_x, -GAIN * cos, -RATE - GAIN * length
        j[4, 1], j[4, 2], j[4, 4] = GAIN * to_y, -GAIN * sin, -RATE - GAIN * length
        j[5, 2], j[5, 5] = -GAIN * (cos_angle - 2 * half * length), -RATE - GAIN * length
        j[6, 5], j[6, 6] = -GAIN * 2 * cos_angle, -RATE - GAIN * 2 * sin_angle
        return j

    return rates, jacobian


def at_rest(rates, jacobian):
    """The start: the crank at 0, the amplifiers at rest, by Newton's method from the ideal triangle."""
    x = np.array([1, 0, 0.75 / REACH, 1, 0, 0.6, 0.8])
    for _ in range(50):
        step = np.linalg.solve(jacobian(0, x)[2:, 2:], np.array(rates(0, x))[2:])
        x[2:] -= step
        if np.max(np.abs(step)) < 1e-14:
            break
    return x


def point(x, bx, by):
    """M, the coupler point, in machine units."""
    b = np.array([bx * x[0], by * x[1]])
    c = b + R1 * np.array([x[3] * x[5] - x[4] * x[6], x[4] * x[5] + x[3] * x[6]])
    along = c - b
    return b + 0.5 * along + np.array([-along[1], along[0]]) / 3.5


def runs(machines, method, tolerance):
    """The rows of all machines, and the seconds of one."""
    times = np.linspace(0, UNTIL, 73)
    rows, seconds = [], 0
    for bx, by in machines:
        rates, jacobian = equations(bx, by)
        start = at_rest(rates, jacobian)
        before = time.process_time()
        solution = solve_ivp(rates, (0, UNTIL), start, method=method, t_eval=times, jac=jacobian, rtol=tolerance,
                             atol=tolerance / 100)
        seconds += time.process_time() - before
        assert solution.success, solution.message
        rows.append(np.array([point(x, bx, by) for x in solution.y.T]))
    return rows, seconds / len(machines)


def seconds_at(points, error):
    """Between measured (error, seconds), on logarithmic scales."""
    points = sorted(points)
    for (e1, s1), (e2, s2) in zip(points, points[1:]):
        if e1 <= error <= e2:
            part = math.log(error / e1) / math.log(e2 / e1)
            return s1 * (s2 / s1) ** part
    return math.nan


def by_oblique(program, folder, count, tolerance):
    """A table of machines, and the seconds of one, of the whole command."""
    patched, table = folder / "four-bar.toml", folder / "table.csv"
    with patched.open("w") as out:
        subprocess.run([program, "patch", MECHANISM], check=True, stdout=out, stderr=subprocess.DEVNULL)
    low, high = 1 - SCATTER, 1 + SCATTER
    before = time.perf_counter()
    subprocess.run(
        [program, "sweep", patched, "--vary", f"B_x.in[1]={CRANK * low}..{CRANK * high}",
         "--vary", f"B_y.in[1]={CRANK * low}..{CRANK * high}",
         "--latin", "--runs", str(count), "--measure", "end(M.x)", "--measure", "end(M.y)", "--samples", "73", "--jobs", "1",
         "--tolerance", str(tolerance), "-o", table],
        check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    seconds = time.perf_counter() - before
    with table.open() as file:
        rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
    return rows, seconds / count


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        points = []
        for tolerance in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
            rows, seconds = by_oblique(program, folder, 100000, tolerance)
            machines = [(row[0], row[1]) for row in rows[:6]]
            truth, _ = runs(machines, "Radau", 1e-12)
            # metres: a machine unit is 4 m
            error = max(max(abs(row[2] / 4 - t[-1, 0]), abs(row[3] / 4 - t[-1, 1])) for row, t in zip(rows, truth))
            print(f"  oblique  tolerance {tolerance:.0e}: {1e6 * seconds:9.1f} µs a machine, error {error:.1e}")
            points.append((error, seconds))
        ours = seconds_at(points, ERROR)
        truth, _ = runs(machines, "Radau", 1e-12)
        best = math.nan
        for method in ("LSODA", "BDF", "Radau"):
            points = []
            for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8):
                rows, seconds = runs(machines, method, tolerance)
                error = max(np.max(np.abs(a - b)) for a, b in zip(rows, truth))
                print(f"  {method:<8} tolerance {tolerance:.0e}: {1e6 * seconds:9.1f} µs a machine, error {error:.1e}")
                points.append((error, seconds))
            found = seconds_at(points, ERROR)
            best = found if math.isnan(best) or found < best else best
    ratio = best / ours
    print(f"four-bars in lanes, the whole command, against SciPy's best in a loop, error {ERROR:.0e}: {ratio:.0f} times faster "
          f"({1e6 * ours:.1f} µs, {1e6 * best:.0f} µs)  {'met' if ratio >= LEAST else 'MISSED'}: at least {LEAST}")


if __name__ == "__main__":
    main()

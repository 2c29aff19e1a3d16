#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes smooth_problems.inc: initial value problems whose solutions share no code with Oblique.

Truths are closed forms where there are any, else Gragg's extrapolated midpoint rule in 30 digits at two tolerances
that must agree, else (stiff) SciPy's Radau at its finest, checked against the published solutions of the test set of
Mazzia and Magherini. Sources: Hull, Enright, Fellen, Sedgwick 1972 (DETEST A to E); Hairer, Norsett, Wanner, Solving
Ordinary Differential Equations I and II.

    python3 smooth_problems.py > smooth_problems.inc        needs mpmath, NumPy, SciPy; takes some minutes
"""
import sys

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

mp.mp.dps = 30
TIMES = 5  # of the truths: evenly spaced, the last at the end
ROWS = 20  # of an extrapolation
PROBLEMS = []


def names_of(lib):
    return {n: getattr(lib, n) for n in ("sin", "cos", "sqrt", "exp")} | {"time": 0, "pi": lib.pi}


class Problem:
    """Equations as {state: (derivative in Oblique's expressions, start)}."""

    def __init__(self, name, until, equations, exact=None, stiff=False, published=None, shown=None):
        self.name, self.until, self.stiff = name, mp.mpf(until), stiff
        self.states = list(equations)
        self.texts = [equations[s][0] for s in self.states]
        self.starts = [mp.mpf(float(equations[s][1])) for s in self.states]  # as Oblique reads them
        self.exact, self.published = exact, published
        self.shown = shown or self.states[:4]
        code = "(" + ",".join(t.replace("^", "**") for t in self.texts) + ",)"
        self.code = compile(code, name, "eval")
        PROBLEMS.append(self)

    def function(self, lib):
        scope = names_of(lib)

        def f(t, x):
            scope.update(zip(self.states, x))
            scope["time"] = t
            return eval(self.code, scope)

        return f

    def times(self):
        return [self.until * k / TIMES for k in range(1, TIMES + 1)]

    def truths(self):
        if self.exact:
            solution = [dict(zip(self.shown, self.exact(t))) for t in self.times()]
        elif self.stiff:
            solution = self.by_radau()
        else:
            solution = self.by_extrapolation(mp.mpf("1e-25"))
            coarser = self.by_extrapolation(mp.mpf("1e-22"))
            worst = max(abs(a[s] - b[s]) / (1 + abs(a[s])) for a, b in zip(solution, coarser) for s in self.states)
            assert worst < mp.mpf("1e-16"), (self.name, worst)
        return [[row[s] for s in self.shown] for row in solution]

    def by_extrapolation(self, tolerance):
        f, x, t, rows = self.function(mp), list(self.starts), mp.mpf(0), []
        step = self.until / 1000
        for end in self.times():
            while t < end:
                h = min(step, end - t)
                x_next, error = extrapolated(f, t, x, h)
                step = h * min(2, (tolerance / (error + tolerance / 10**9)) ** mp.mpf(1 / 17) * mp.mpf("0.7"))
                if error < tolerance:
                    x, t = x_next, (end if h == end - t else t + h)
            rows.append(dict(zip(self.states, x)))
        return rows

    def by_radau(self):
        f = self.function(np)
        ends = [float(t) for t in self.times()]
        got = solve_ivp(f, (0, ends[-1]), [float(s) for s in self.starts], "Radau", ends, rtol=1e-13, atol=1e-18)
        rows = [dict(zip(self.states, map(mp.mpf, got.y[:, k]))) for k in range(TIMES)]
        for state, value in (self.published or {}).items():
            assert abs(rows[-1][state] - value) < 1e-9 * abs(value), (self.name, state, rows[-1][state])
        return rows


def extrapolated(f, t, x, big):
    """One step of Gragg's midpoint rule, extrapolated (Hairer, Norsett, Wanner I, II.9), and its error."""
    table = []
    for j in range(1, ROWS // 2 + 1):
        n = 2 * j
        h = big / n
        before, now = x, [a + h * b for a, b in zip(x, f(t, x))]
        for k in range(1, n):
            before, now = now, [a + 2 * h * b for a, b in zip(before, f(t + k * h, now))]
        row = [[(a + b + h * c) / 2 for a, b, c in zip(before, now, f(t + big, now))]]
        for k in range(1, j):
            ratio = (mp.mpf(j) / (j - k)) ** 2 - 1
            row.append([a + (a - b) / ratio for a, b in zip(row[k - 1], table[-1][k - 1])])
        table.append(row)
    best, other = table[-1][-1], table[-1][-2]
    return best, max(abs(a - b) / (1 + abs(a)) for a, b in zip(best, other))


def kepler(e):
    def position(t):
        anomaly = mp.findroot(lambda u: u - e * mp.sin(u) - t, t + e * mp.sin(t), tol=1e-50)
        return (mp.cos(anomaly) - e, mp.sqrt(1 - e**2) * mp.sin(anomaly))

    return position


def add_kepler(name, e, until):
    e = mp.mpf(e)
    Problem(name, until,
            {"x": ("u", 1 - e), "y": ("v", 0),
             "u": ("-x/sqrt(x^2 + y^2)^3", 0), "v": ("-y/sqrt(x^2 + y^2)^3", mp.sqrt((1 + e) / (1 - e)))},
            exact=kepler(e), shown=["x", "y"])


def add_all():
    turn = 2 * mp.pi
    Problem("decay", 10, {"x": ("-x", 1)}, exact=lambda t: [mp.exp(-t)])
    Problem("growth", 10, {"x": ("x", "1e-4")}, exact=lambda t: [mp.exp(t) / 10**4])
    Problem("logistic", 20, {"x": ("x*(1 - x)", "0.01")}, exact=lambda t: [1 / (1 + 99 * mp.exp(-t))])
    Problem("lag", 30, {"x": ("sin(time) - x", 0)}, exact=lambda t: [(mp.sin(t) - mp.cos(t) + mp.exp(-t)) / 2])
    Problem("modulated", 20, {"x": ("x*cos(time)", 1)}, exact=lambda t: [mp.exp(mp.sin(t))])
    Problem("riccati", 20, {"x": ("-x^3/2", 1)}, exact=lambda t: [1 / mp.sqrt(1 + t)])
    Problem("circle10", 10 * turn - 1, {"x": ("-y", 1), "y": ("x", 0)}, exact=lambda t: [mp.cos(t), mp.sin(t)])
    Problem("circle1000", 1000 * turn - 1, {"x": ("-y", 1), "y": ("x", 0)}, exact=lambda t: [mp.cos(t), mp.sin(t)])
    Problem("damped", 50, {"x": ("v", 1), "v": ("-x - 0.2*v", 0)},
            exact=lambda t: [mp.exp(-t / 10) * (mp.cos(mp.sqrt(0.99) * t) + mp.sin(mp.sqrt(0.99) * t) / mp.sqrt(99))],
            shown=["x"])
    # x(0) = J(0.5, 1) and its slope: x = sqrt(2/(pi t)) sin t of t = time + 1
    Problem("bessel", 19, {"x": ("v", mp.sqrt(2 / mp.pi) * mp.sin(1)),
                           "v": ("-v/(time + 1) - (1 - 0.25/(time + 1)^2)*x",
                                 mp.sqrt(2 / mp.pi) * (mp.cos(1) - mp.sin(1) / 2))},
            exact=lambda t: [mp.sqrt(2 / (mp.pi * (t + 1))) * mp.sin(t + 1)], shown=["x"])
    add_kepler("kepler03", "0.3", 50)
    add_kepler("kepler09", "0.9", 20)
    k = mp.sin(mp.mpf(3) / 2)  # amplitude 3 rad, from the lowest point
    Problem("pendulum", 50, {"x": ("v", 0), "v": ("-sin(x)", 2 * k)},
            exact=lambda t: [2 * mp.asin(k * mp.ellipfun("sn", t, m=k**2))], shown=["x"])
    Problem("spiral", 20, {"x": ("(x - time)/(x + time)", 4)})
    Problem("eulerbody", 20, {"x": ("-2*y*z", 1), "y": ("1.25*x*z", 0), "z": ("-0.5*x*y", "0.9")})
    Problem("volterra", 20, {"x": ("2*(x - x*y)", 1), "y": ("-(y - x*y)", 3)})
    Problem("chain", 20, {f"x{i}": (("" if i == 0 else f"x{i - 1} ") + ("" if i == 9 else f"- x{i}"), int(i == 0))
                          for i in range(10)}, shown=["x0", "x4", "x9"])
    Problem("vanderpol1", 20, {"x": ("v", 2), "v": ("(1 - x^2)*v - x", 0)})
    Problem("vanderpol10", 50, {"x": ("v", 2), "v": ("10*(1 - x^2)*v - x", 0)}, shown=["x"])
    Problem("duffing", 20, {"x": ("v", 0), "v": ("x^3/6 - x + 2*sin(2.78535*time)", 0)})
    Problem("falling", 20, {"x": ("v", 30), "v": ("0.032 - 0.4*v^2", 0)})
    Problem("pursuit", 20, {"x": ("v", 0), "v": ("sqrt(1 + v^2)/(25 - time)", 0)})
    Problem("lorenz10", 10, {"x": ("10*(y - x)", 1), "y": ("x*(28 - z) - y", 1), "z": ("x*y - 8/3*z", 1)})
    Problem("roessler", 30, {"x": ("-y - z", 1), "y": ("x + 0.2*y", 1), "z": ("0.2 + z*(x - 5.7)", 1)})
    Problem("brusselator", 20, {"x": ("1 + x^2*y - 4*x", "1.5"), "y": ("3*x - x^2*y", 3)})
    Problem("nagumo", 60, {"v": ("v - v^3/3 - w + 0.5", -1), "w": ("0.08*(v + 0.7 - 0.8*w)", 1)})
    Problem("epidemic", 40, {"s": ("-1.2*s*i", "0.99"), "i": ("1.2*s*i - 0.4*i", "0.01")})
    Problem("henonheiles", 100, {"x": ("u", 0), "y": ("v", "0.1"), "u": ("-x - 2*x*y", "0.5"),
                                 "v": ("-y - x^2 + y^2", 0)}, shown=["x", "y"])
    springs = {f"x{i}": (f"v{i}", int(i == 0)) for i in range(6)}
    springs |= {f"v{i}": (" ".join(([f"x{i - 1} +"] if i else []) + ([f"x{i + 1}"] if i < 5 else ["0"]) + [f"- 2*x{i}"]), 0)
                for i in range(6)}
    Problem("springs", 60, springs, shown=["x0", "x3", "x5"])
    # Hairer, Norsett, Wanner I, II.0; its period is 17.0652165601579625588917206249
    m, n = "0.012277471", "(1 - 0.012277471)"
    earth, moon = f"sqrt((x + {m})^2 + y^2)^3", f"sqrt((x - {n})^2 + y^2)^3"
    Problem("arenstorf", "17.0652165601579625588917206249",
            {"x": ("u", "0.994"), "y": ("v", 0),
             "u": (f"x + 2*v - {n}*(x + {m})/{earth} - {m}*(x - {n})/{moon}", 0),
             "v": (f"y - 2*u - {n}*y/{earth} - {m}*y/{moon}", "-2.00158510637908252240537862224")},
            shown=["x", "y"])
    # Chenciner and Montgomery 2000; three equal masses on one figure of eight
    bodies = {}
    places = [("0.97000436", "-0.24308753"), ("-0.97000436", "0.24308753"), ("0", "0")]
    speeds = [("0.466203685", "0.43236573")] * 2 + [("-0.93240737", "-0.86473146")]
    for i in range(3):
        for axis, c in ((0, "x"), (1, "y")):
            bodies[f"{c}{i}"] = (f"{'uv'[axis]}{i}", places[i][axis])
    for i in range(3):
        for axis, c in ((0, "x"), (1, "y")):
            force = " + ".join(f"({c}{j} - {c}{i})/sqrt((x{j} - x{i})^2 + (y{j} - y{i})^2)^3" for j in range(3) if j != i)
            bodies[f"{'uv'[axis]}{i}"] = (force, speeds[i][axis])
    Problem("figure8", 6, bodies, shown=["x0", "y0", "x2"])

    Problem("robinson", 10, {"x": ("-1e6*(x - cos(time)) - sin(time)", 1)}, exact=lambda t: [mp.cos(t)], stiff=True)
    Problem("twodecays", 10, {"x": ("-1001*x + 999*y", 2), "y": ("999*x - 1001*y", 0)}, stiff=True,
            exact=lambda t: [mp.exp(-2 * t) + mp.exp(-2000 * t), mp.exp(-2 * t) - mp.exp(-2000 * t)])
    Problem("vanderpol1000", 2000, {"x": ("v", 2), "v": ("1000*(1 - x^2)*v - x", 0)}, stiff=True, shown=["x"],
            published={"x": 1.706167732170483})
    Problem("robertson", 40, {"x": ("-0.04*x + 1e4*y*z", 1), "y": ("0.04*x - 1e4*y*z - 3e7*y^2", 0),
                              "z": ("3e7*y^2", 0)}, stiff=True, published={"x": 0.7158270687})
    Problem("hires", "321.8122",
            {"a": ("-1.71*a + 0.43*b + 8.32*c + 0.0007", 1), "b": ("1.71*a - 8.75*b", 0),
             "c": ("-10.03*c + 0.43*d + 0.035*e", 0), "d": ("8.32*b + 1.71*c - 1.12*d", 0),
             "e": ("-1.745*e + 0.43*f + 0.43*g", 0),
             "f": ("-280*f*h + 0.69*d + 1.71*e - 0.43*f + 0.69*g", 0), "g": ("280*f*h - 1.81*g", 0),
             "h": ("-280*f*h + 1.81*g", "0.0057")}, stiff=True, shown=["a", "d", "f", "h"],
            published={"a": 0.7371312573325668e-3, "h": 0.2850001604814231e-2})


def quoted(words):
    return "{" + ", ".join(f'"{w}"' for w in words) + "}"


def write(problem):
    print(f'{{"{problem.name}", {float(problem.until)!r}, {"true" if problem.stiff else "false"},')
    print(" {" + ",\n  ".join(f'{{"{state}", "{text}", {float(start)!r}}}'
                             for state, text, start in zip(problem.states, problem.texts, problem.starts)) + "},")
    print(f" {quoted(problem.shown)},")
    rows = ["{" + ", ".join(repr(float(v)) for v in row) + "}" for row in problem.truths()]
    print(" {" + ",\n  ".join(rows) + "}},")


if __name__ == "__main__":
    add_all()
    print("// Written by smooth_problems.py, which says where the truths come from.")
    for problem in PROBLEMS:
        if len(sys.argv) < 2 or problem.name in sys.argv[1:]:
            write(problem)

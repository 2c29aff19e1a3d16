# SPDX-License-Identifier: MIT
"""Rods, chains and ladders of many states."""
import numpy as np
from scipy.linalg import eigh
from scipy.special import jv

from .tools import ode


def heat_rod_of_50():
    """uₖ′ = 2500 (uₖ₋₁ − 2uₖ + uₖ₊₁), u₀ = 1 from 0.02 to 0.021, u₅₁ = 0: by eigenvalues, piece by piece."""
    n = 50
    a = 2500 * (np.diag(-2 * np.ones(n)) + np.diag(np.ones(n - 1), 1) + np.diag(np.ones(n - 1), -1))
    values, vectors = eigh(a)
    b = np.zeros(n)
    b[0] = 2500

    def step(u, tau, source):
        c, d = vectors.T @ u, vectors.T @ (source * b)
        return vectors @ (np.exp(values * tau) * c + np.expm1(values * tau) / values * d)

    after = step(np.zeros(n), 0.001, 1)
    return {"u1 at 0.021": after[0], "u25 at 0.1": step(after, 0.079, 0)[24],
            "u50 at 0.3": step(after, 0.279, 0)[49]}


def schroedinger_chain():
    """E. Schrödinger 1914: xₙ(t) = J₂ₙ(2t) in an endless chain, of which the ends of 1000 masses tell nothing
    until t = 500."""
    return {"x0 at 10": jv(0, 20), "x0 at 40": jv(0, 80), "x7 at 40": jv(14, 80), "x38 at 40": jv(76, 80)}


def idle_beside_busy():
    """Duffing's oscillator, with a rod of 400 cells at rest beside it."""
    motion = ode(lambda t, y: [y[1], 0.3 * np.cos(t) + y[0] - y[0]**3 - 0.25 * y[1]], [1, 0], 40)
    return {"x at 20": motion(20)[0], "x at 40": motion(40)[0], "v at 40": motion(40)[1], "u200 at 40": 0.0}


def fisher_front():
    """R. A. Fisher 1937, A. Kolmogorov, I. Petrovsky and N. Piskunov 1937: 60 cells, u₀ = 1, all others
    empty."""
    def f(t, u):
        left, right = np.concatenate([[1], u[:-1]]), np.concatenate([u[1:], u[-1:]])
        return left - 2 * u + right + u * (1 - u)

    motion = ode(f, np.zeros(60), 28)
    return {"u10 at 5": motion(5)[9], "u30 at 13": motion(13)[29], "u60 at 20": motion(20)[59],
            "u60 at 28": motion(28)[59]}


def delay_line_of_40():
    """A Gaussian pulse through 40 sections of L and C (O. Heaviside's loading coils), closed by its
    resistance."""
    n = 40

    def f(t, y):
        i, v = y[:n], y[n:]
        e = np.exp(-((t - 10) / 1.5)**2)
        before = np.concatenate([[e], v[:-1]])
        di = before - v
        di[0] -= i[0]
        dv = np.empty(n)
        dv[:-1] = i[:-1] - i[1:]
        dv[-1] = i[-1] - v[-1]
        return np.concatenate([di, dv])

    motion = ode(f, np.zeros(2 * n), 80)
    return {"v20 at 32": motion(32)[n + 19], "v40 at 51": motion(51)[n + 39], "v40 at 80": motion(80)[n + 39],
            "v40 maximum": motion.largest(lambda t, y: y[2 * n - 1], samples=2000)}


def brusselator_ring():
    """I. Prigogine and R. Lefever 1968, 20 cells in a ring (A. M. Turing 1952), from a seed of 1e-3 in one."""
    n = 20

    def f(t, y):
        u, v = y[:n], y[n:]
        du = 0.5 * (np.roll(u, 1) + np.roll(u, -1) - 2 * u)
        dv = 6 * (np.roll(v, 1) + np.roll(v, -1) - 2 * v)
        return np.concatenate([1 - 2.8 * u + u * u * v + du, 1.8 * u - u * u * v + dv])

    y = np.concatenate([np.ones(n), 1.8 * np.ones(n)])
    y[3] += 1e-3
    motion = ode(f, y, 60)
    return {"u1 at 20": motion(20)[0], "u4 at 60": motion(60)[3], "v11 at 60": motion(60)[n + 10]}

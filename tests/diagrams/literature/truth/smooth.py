# SPDX-License-Identifier: MIT
"""Seeds that grow, boundary layers, implicit functions, functions of physics, chaos for a short time."""
import mpmath
import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import airy, lambertw

from .tools import Motion, ode


def lorenz_short():
    motion = ode(lambda t, y: [10 * (y[1] - y[0]), y[0] * (28 - y[2]) - y[1], y[0] * y[1] - 8 / 3 * y[2]],
                 [1, 1, 1], 12)
    return {"x at 3": motion(3)[0], "x at 12": motion(12)[0], "z at 12": motion(12)[2]}


def roessler_short():
    motion = ode(lambda t, y: [-y[1] - y[2], y[0] + 0.2 * y[1], 0.2 + y[2] * (y[0] - 5.7)], [1, 1, 0], 40)
    return {"x at 20": motion(20)[0], "x at 40": motion(40)[0], "z at 40": motion(40)[2]}


def ueda_short():
    motion = ode(lambda t, y: [y[1], 7.5 * np.cos(t) - 0.05 * y[1] - y[0]**3], [2.5, 0], 20)
    return {"x at 10": motion(10)[0], "x at 20": motion(20)[0], "v at 20": motion(20)[1]}


def epidemic_of_one_case():
    """W. O. Kermack and A. G. McKendrick 1927: from one case in 100 millions, R₀ = 2.5."""
    motion = ode(lambda t, y: [-2.5 * y[0] * y[1], 2.5 * y[0] * y[1] - y[1]], [1 - 1e-8, 1e-8], 40)
    return {"i at 8": motion(8)[1], "i at 12": motion(12)[1], "s at 40": motion(40)[0],
            "i maximum": 1 - (1 + np.log(2.5 * (1 - 1e-8))) / 2.5}


def q_switched_laser():
    """W. G. Wagner and B. A. Lengyel 1963: φ′ = φ (n − 1), n′ = −n φ; φ + n − ln n is kept."""
    top = 1e-9 + 3 - np.log(3) - 1
    left = brentq(lambda n: n - np.log(n) - (1e-9 + 3 - np.log(3)), 1e-6, 1)
    motion = ode(lambda t, y: [y[0] * (y[1] - 1), -y[0] * y[1]], [1e-9, 3], 14)
    return {"phi at 8": motion(8)[0], "phi at 10": motion(10)[0], "n at 40": left, "phi maximum": top}


def _pitchfork(start, rate, seed, times):
    """x′ = μ x − x³, μ = start + rate t: Bernoulli's equation in closed form."""
    g = lambda t: start * t + rate * t * t / 2
    out = []
    for t in times:
        middle = [p for p in (-start / rate,) if p < t]
        # 1/x² = e^(−2g) (1/seed² + 2 ∫ e^(2g))
        integral = quad(lambda s: np.exp(2 * (g(s) - g(t))), 0, t, points=middle or None, epsabs=0,
                        epsrel=1e-12, limit=500)[0]
        out.append(1 / np.sqrt(np.exp(-2 * g(t)) / seed**2 + 2 * integral))
    return out


def slow_passage():
    a, b, c = _pitchfork(-0.6, 0.02, 0.1, (30, 55, 70))
    return {"x at 30": a, "x at 55": b, "x at 70": c}


def delayed_loss_of_stability():
    a, b = _pitchfork(-1, 0.02, 0.1, (95, 110))
    return {"x at 95": a, "x at 110": b}


def may_leonard():
    """R. May and W. Leonard 1975, α = 0.8, β = 1.3, in logarithms, so that the small species are as exact as
    the large ones."""
    def f(t, u):
        n = np.exp(u)
        return [1 - n[0] - 0.8 * n[1] - 1.3 * n[2], 1 - 1.3 * n[0] - n[1] - 0.8 * n[2],
                1 - 0.8 * n[0] - 1.3 * n[1] - n[2]]

    motion = ode(f, np.log([0.5, 0.2, 0.1]), 200)
    n = lambda t: np.exp(motion(t))
    return {"n1 at 50": n(50)[0], "n1 at 120": n(120)[0], "n2 at 200": n(200)[1], "n1 at 200": n(200)[0],
            "n3 at 200": n(200)[2]}


def canard():
    """van der Pol with ε = 0.05 near the explosion (E. Benoît, J.-L. Callot, F. and M. Diener 1981)."""
    f = lambda t, y: [(y[1] - y[0]**3 / 3 + y[0]) / 0.05, 0.9935 - y[0]]
    motion = ode(f, [1.2, -0.6], 20)
    return {"x at 2": motion(2)[0], "x at 5": motion(5)[0], "x at 20": motion(20)[0],
            "x minimum": -motion.largest(lambda t, y: -y[0])}


def flame():
    """L. F. Shampine's flame, from 1e-4: y = 1/(W(a e^(a − t)) + 1), a = 1/1e-4 − 1."""
    a = mpmath.mpf(9999)
    y = lambda t: float(1 / (mpmath.lambertw(a * mpmath.exp(a - t)) + 1))
    return {"y at 9000": y(9000), "y at 9999": y(9999), "y at 10010": y(10010), "y at 20000": y(20000)}


def flame_at_the_default_tolerance():
    return flame()


def boundary_layer():
    """ε y″ + (1 + ε) y′ + y = 0, y(0) = 0, y(1) = 1 (C. M. Bender and S. A. Orszag, section 9.1)."""
    y = lambda t: (np.exp(-t) - np.exp(-t / 1e-4)) / np.exp(-1)
    return {"y at 1e-4": y(1e-4), "y at 0.5": y(0.5), "y at 1": 1.0,
            "y maximum": y(np.log(1e4) * 1e-4 / (1 - 1e-4))}


def blasius():
    motion = ode(lambda t, f: [f[1], f[2], -f[0] * f[2] / 2], [0, 0, 0.332057336215196], 10)
    assert abs(motion(10)[1] - 1) < 1e-7
    return {"f at 5": motion(5)[0], "slope at 5": motion(5)[1], "slope at 10": motion(10)[1]}


def airy_backwards():
    return {"ai at 5": float(airy(-5)[0]), "ai at 20": float(airy(-20)[0]), "slope at 20": float(-airy(-20)[1])}


def lane_emden_five():
    """A star of polytropic index 5: θ = 1/√(1 + ξ²/3), from ξ = 0.1."""
    theta = lambda xi: 1 / np.sqrt(1 + xi * xi / 3)
    return {"theta at 1": theta(1.1), "theta at 10": theta(10.1), "theta at 30": theta(30.1)}


def landau_zener():
    """L. D. Landau and C. Zener 1932: the Bloch vector while the levels cross at t = 30."""
    def f(t, s):
        u, v, w = s
        d = 1.0 * (t - 30)
        return [-d * v, d * u + 0.7 * w, -0.7 * v]

    motion = ode(f, [0, 0, -1], 60, max_step=0.05)
    return {"w at 30": motion(30)[2], "w at 60": motion(60)[2], "u at 60": motion(60)[0]}


def kepler_equation_servo():
    e = lambda m: brentq(lambda x: x - 0.9 * np.sin(x) - m, -1, 10, xtol=1e-15)
    return {"anomaly at 0.1": e(0.1), "anomaly at 1": e(1), "anomaly at 6": e(6)}


def lambert_w_servo():
    return {"w at 0.5": float(lambertw(0.5).real), "w at 10": float(lambertw(10).real)}


def cube_root_servo():
    return {"y at 0.5": 1.5**(1 / 3), "y at 3": float(np.cbrt(-1.0)), "y at 1.9": float(np.cbrt(0.1))}


def quotient_of_sines():
    return {"q at 1": float(np.sin(1) / (2 + np.cos(1))), "q at pi": 0.0,
            "q at 20": float(np.sin(20) / (2 + np.cos(20)))}


def joukowski_map():
    """w = z + 1/z of a circle about −0.1 + 0.1i through 1."""
    r = abs(1.1 - 0.1j)
    z = lambda t: -0.1 + 0.1j + r * np.exp(1j * t)
    w = lambda t: z(t) + 1 / z(t)
    return {"x at 1": w(1).real, "y at 1": w(1).imag, "x at 4": w(4).real, "y at 4": w(4).imag,
            "y at 6": w(6).imag}


def polar_of_a_spiral():
    """(x, y) = e^(−t/10) (cos 3t, sin 3t) + (0.02, 0): length and continuous angle."""
    z = lambda t: np.exp(-t / 10 + 3j * t) + 0.02
    turns = np.unwrap(np.angle(z(np.linspace(0, 15, 100001))))
    return {"length at 5": abs(z(5)), "angle at 5": float(np.interp(5, np.linspace(0, 15, 100001), turns)),
            "length at 15": abs(z(15)), "angle at 15": turns[-1]}


def steep_table():
    """x″ = −f(x), f a table that rises from −1 to 1 between −1e-6 and 1e-6: from one corner to the next."""
    width = 1e-6
    motion, part = Motion([0.5, 0]), 1
    while motion.t < 20.3:
        if part:
            hit = motion.go(lambda t, y: [y[1], -part], 20.3, [(lambda t, y: part * y[0] - width, -1)],
                            max_step=0.1)
            part = 0
        else:
            hit = motion.go(lambda t, y: [y[1], -y[0] / width], 20.3,
                            [(lambda t, y: y[0] - width, 1), (lambda t, y: y[0] + width, -1)])
            part = (1, -1)[hit] if hit is not None else 0
        if hit is None:
            break
    return {"x at 2.7": motion(2.7)[0], "x at 20.3": motion(20.3)[0], "v at 20.3": motion(20.3)[1]}


def rectified_mean():
    """x′ = |sin(2π·200 t)| − x after 5 s: the mean 2/π and the small ripple, by Fourier's series."""
    w = 400 * np.pi
    x = 2 / np.pi * (1 - np.exp(-5.0))
    for k in range(1, 2000):
        c = -4 / np.pi / (4 * k * k - 1)
        z = 1 / (1 + 2j * k * w)
        x += np.real(c * z * (np.exp(2j * k * w * 5) - np.exp(-5.0)))
    return {"x at 5": float(x)}


def resonance_at_a_kilohertz():
    """x″ + w² x = w² sin wt, w = 2000π, from rest: x = (sin wt − wt cos wt)/2."""
    w = 2000 * np.pi
    x = lambda t: (np.sin(w * t) - w * t * np.cos(w * t)) / 2
    return {"x at 0.05": x(0.05), "x at 0.20025": x(0.20025), "x at 0.2": x(0.2)}


def am_detector():
    """A carrier of 1 kHz with a modulation of 20 Hz, a diode (a maximum with zero) and a lag of 2 ms: half
    wave by half wave."""
    e = lambda t: (1 + 0.5 * np.sin(40 * np.pi * t)) * np.sin(2000 * np.pi * t)

    def x(end):
        total = 0.0
        for start in np.arange(0, end, 1e-3):
            total += quad(lambda s: np.exp(-(end - s) / 2e-3) / 2e-3 * e(s), start, min(start + 0.5e-3, end),
                          epsabs=1e-14)[0]
        return float(total)

    return {"x at 0.0125": x(0.0125), "x at 0.0999": x(0.0999)}


def morris_lecar():
    """C. Morris and H. Lecar 1981 (class I values of J. Rinzel and B. Ermentrout), a current of 60 that comes
    at 400 ms."""
    def f(current):
        def rates(t, y):
            v, w = y
            m = (1 + np.tanh((v + 1.2) / 18)) / 2
            inf = (1 + np.tanh((v - 12) / 17.4)) / 2
            return [(current - 4 * m * (v - 120) - 8 * w * (v + 84) - 2 * (v + 60)) / 20,
                    0.0666667 * (inf - w) * np.cosh((v - 12) / 34.8)]
        return rates

    motion = Motion([-60, 0])
    motion.go(f(0), 400)
    motion.go(f(60), 500)
    return {"v at 390": motion(390)[0], "v at 420": motion(420)[0], "v at 500": motion(500)[0],
            "v maximum": motion.largest(lambda t, y: y[0], samples=4000)}


def hindmarsh_rose():
    f = lambda t, y: [y[1] - y[0]**3 + 3 * y[0]**2 - y[2] + 2, 1 - 5 * y[0]**2 - y[1],
                      0.006 * (4 * (y[0] + 1.6) - y[2])]
    motion = ode(f, [-1.6, -12, 1.5], 120, max_step=0.5)
    return {"x at 20": motion(20)[0], "x at 60": motion(60)[0], "x at 120": motion(120)[0],
            "z at 120": motion(120)[2]}


def leaky_integrate_and_fire():
    """L. Lapicque 1907, R. Stein 1965: v′ = −v + I, I = 1.2 from t = 100 on, a spike and v = 0 at v = 1."""
    period = np.log(1.2 / 0.2)
    n, rest = divmod(50.0, period)
    return {"spikes at 150": n, "v at 150": 1.2 * (1 - np.exp(-rest)), "v at 99": 0.0}


def izhikevich():
    """E. M. Izhikevich 2003, regular spiking: v′ = 0.04 v² + 5v + 140 − u + I; at 30: v = −65, u + 8."""
    motion = Motion([-70, -14])
    motion.go(lambda t, y: [0.04 * y[0]**2 + 5 * y[0] + 140 - y[1], 0.02 * (0.2 * y[0] - y[1])], 50)
    n = 0
    while motion.go(lambda t, y: [0.04 * y[0]**2 + 5 * y[0] + 140 - y[1] + 10, 0.02 * (0.2 * y[0] - y[1])],
                    250, [(lambda t, y: y[0] - 30, 1)]) is not None:
        motion.y = np.array([-65, motion.y[1] + 8])
        n += 1
    return {"spikes at 250": float(n), "u at 250": motion(250)[1], "v at 250": motion(250)[0]}


def duffing_elliptic():
    """x″ = −x − 2x³ from 1: C. G. J. Jacobi's cn(√3 t | 1/3)."""
    x = lambda t: float(mpmath.ellipfun("cn", mpmath.sqrt(3) * t, m=mpmath.mpf(1) / 3))
    return {"x at 10": x(10), "x at 100": x(100)}

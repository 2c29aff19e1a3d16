# SPDX-License-Identifier: MIT
"""Dry friction, impacts, and the motions of books on mechanics."""
import itertools

import mpmath
import numpy as np
from scipy.optimize import brentq

from .tools import Motion, ode


def _friction(y, until, rates, sliding, greatest):
    """Coulomb friction in several contacts. `sliding(y)`: the contacts' speeds; `rates(t, y, force)`: y′, in which
    the contacts' forces act; `greatest[i](speed)`: their sizes. A contact that sticks carries what keeps its speed
    at zero, up to its greatest force at rest, and then tears."""
    n = len(greatest)
    motion = Motion(y)

    def changes(t, y, force):
        slope = np.array(rates(t, y, force), dtype=float)
        h = 1e-6
        return (sliding(y + h * slope) - sliding(y - h * slope)) / (2 * h)  # `sliding` is linear: exact

    def forces(t, y, mode):
        w = sliding(y)
        force = np.array([-m * greatest[i](abs(w[i])) for i, m in enumerate(mode)])
        stuck = [i for i, m in enumerate(mode) if m == 0]
        if stuck:
            base = changes(t, y, force)[stuck]
            columns = []
            for i in stuck:
                unit = force.copy()
                unit[i] += 1
                columns.append(changes(t, y, unit)[stuck] - base)
            force[stuck] = -np.linalg.solve(np.array(columns).T, base)
        return force

    def consistent(t, y, at_rest, mode):
        force = forces(t, y, mode)
        change = changes(t, y, force)
        for i in at_rest:
            if mode[i] == 0 and abs(force[i]) > greatest[i](0) * (1 + 1e-9):
                return False
            if mode[i] != 0 and mode[i] * change[i] < -1e-9:
                return False
        return True

    mode = [int(np.sign(w)) for w in sliding(np.array(y, dtype=float))]
    at_rest = [i for i in range(n) if mode[i] == 0]
    while motion.t < until:
        for trial in itertools.product((0, 1, -1), repeat=len(at_rest)):
            for i, m in zip(at_rest, trial):
                mode[i] = m
            if consistent(motion.t, motion.y, at_rest, mode):
                break
        else:
            raise RuntimeError("no mode agrees")
        now = list(mode)
        guards = []
        for i in range(n):
            if now[i]:  # a hair beyond zero, for contacts that have just torn
                guards.append((lambda t, y, i=i: now[i] * sliding(y)[i] + 1e-13, -1))
            else:
                guards.append((lambda t, y, i=i: greatest[i](0) - abs(forces(t, y, now)[i]), -1))
        hit = motion.go(lambda t, y: rates(t, y, forces(t, y, now)), until, guards, max_step=0.05)
        at_rest = [i for i in range(n) if now[i] == 0]
        if hit is not None and now[hit]:
            at_rest.append(hit)
        elif hit is not None:  # torn: it slides against the force that held it
            mode[hit] = -int(np.sign(forces(motion.t, motion.y, now)[hit]))
            at_rest.remove(hit)
    return motion


def den_hartog_friction():
    motion = _friction([1, 0], 40, lambda t, y, q: [y[1], np.cos(0.5 * t) - y[0] + q[0]], lambda y: y[1:2],
                       [lambda w: 0.8])
    assert abs(motion(40)[1]) < 1e-12  # it sticks
    return {"x at 5": motion(5)[0], "x at 20": motion(20)[0], "x at 40": motion(40)[0], "v at 40": 0.0}


def two_masses_dry():
    def rates(t, y, q):
        x1, x2, v1, v2 = y
        return [v1, v2, -2 * x1 + x2 + q[0], x1 - x2 + 1.2 * np.sin(0.7 * t) + q[1]]

    motion = _friction([0, 0, 0, 0], 30, rates, lambda y: y[2:4], [lambda w: 0.3, lambda w: 0.4])
    return {"x1 at 10": motion(10)[0], "x2 at 10": motion(10)[1], "x1 at 30": motion(30)[0],
            "x2 at 30": motion(30)[1]}


def box_on_a_plate():
    def rates(t, y, q):
        force = 1.5 * np.sin(1.5 * t)
        return [force + q[0], (-q[0] + q[1]) / 2, y[0], y[1]]

    motion = _friction([0.2, 0.1, 0, 0], 12, rates, lambda y: np.array([y[0] - y[1], y[1]]),
                       [lambda w: 0.6, lambda w: 0.3])
    return {"x1 at 5": motion(5)[2], "x2 at 5": motion(5)[3], "x1 at 12": motion(12)[2],
            "x2 at 12": motion(12)[3],
            "v1 at 12": motion(12)[0], "v2 at 12": motion(12)[1]}


def stribeck_belt():
    force = lambda w: 0.6 + 0.4 * np.exp(-3 * w)
    motion = _friction([0, 0.1], 30, lambda t, y, q: [y[1], -y[0] - q[0]], lambda y: np.array([0.2 - y[1]]),
                       [force])
    return {"x at 3": motion(3)[0], "x at 10": motion(10)[0], "x at 30": motion(30)[0],
            "x maximum": motion.largest(lambda t, y: y[0]), "v minimum": -motion.largest(lambda t, y: -y[1])}


def ball_on_a_table():
    """P. J. Holmes 1982, with the height of the table kept; it settles to one impact a turn."""
    a, w, e, g = 0.1, 2 * np.pi, 0.8, 9.81
    phase = lambda t: w * (t - 0.5) + 0.522
    motion = Motion([1.3, 0])
    while motion.go(lambda t, y: [y[1], -g], 15.2, [(lambda t, y: y[0] - a * np.sin(phase(t)), -1)],
                    max_step=0.05) is not None:
        speed = a * w * np.cos(phase(motion.t))
        motion.y[1] = speed + e * (speed - motion.y[1])
    return {"y at 5": motion(5)[0], "y at 15.2": motion(15.2)[0], "n at 15.2": float(len(motion.events))}


def impact_oscillator():
    """S. W. Shaw and P. J. Holmes 1983: a stop at 0.5 that gives back 0.7 of the speed."""
    motion = Motion([0, 0])
    while motion.t < 40:
        assert len(motion.events) < 100
        hit = motion.go(lambda t, y: [y[1], np.cos(1.4 * t) - y[0] - 0.1 * y[1]], 40,
                        [(lambda t, y: y[0] - 0.5, 1)], max_step=0.05)
        if hit is None:
            break
        motion.y = np.array([0.5, -0.7 * motion.y[1]])
    times = [t for t, _ in motion.events]
    assert min(np.diff(times)) > 0.05, np.diff(times)
    return {"x at 10": motion(10)[0], "x at 40": motion(40)[0], "v at 40": motion(40)[1],
            "n at 40": float(len(times))}


def _orbit(t, e):
    mean = t
    anomaly = brentq(lambda u: u - e * np.sin(u) - mean, mean - 1, mean + 1, xtol=1e-15)
    return np.cos(anomaly) - e, np.sqrt(1 - e * e) * np.sin(anomaly)


def kepler_eccentric():
    x, y = _orbit(15, 0.9)
    return {"x at 5*pi": -1.9, "y at 5*pi": 0.0, "x at 15": x, "y at 15": y, "energy at 20": -0.5,
            "momentum at 20": np.sqrt(0.19)}


def arenstorf():
    mu = 0.012277471

    def f(t, s):
        x, y, u, v = s
        a, b = ((x + mu)**2 + y * y)**1.5, ((x - 1 + mu)**2 + y * y)**1.5
        return [u, v, x + 2 * v - (1 - mu) * (x + mu) / a - mu * (x - 1 + mu) / b,
                y - 2 * u - (1 - mu) * y / a - mu * y / b]

    motion = ode(f, [0.994, 0, 0, -2.00158510637908252240537862224], 17.0652165601)
    # R. F. Arenstorf 1963; E. Hairer, S. P. Nørsett and G. Wanner give the period, after which it is where it began.
    return {"x at 5": motion(5)[0], "y at 5": motion(5)[1], "x at 17.065216560157963": 0.994,
            "y at 17.065216560157963": 0.0}


def figure_of_eight():
    """A. Chenciner and R. Montgomery 2000; C. Simó's initial values. After a third of the period the bodies
    change places."""
    def f(t, s):
        r, v = s[:6].reshape(3, 2), s[6:]
        a = np.zeros((3, 2))
        for i in range(3):
            for j in range(3):
                if i != j:
                    d = r[j] - r[i]
                    a[i] += d / np.linalg.norm(d)**3
        return [*v, *a.ravel()]

    p, q, u, w = 0.97000436, -0.24308753, 0.93240737, 0.86473146
    motion = ode(f, [p, q, -p, -q, 0, 0, u / 2, w / 2, u / 2, w / 2, -u, -w], 6.32591398)
    return {"x1 at 2": motion(2)[0], "y1 at 2": motion(2)[1], "x3 at 2": motion(2)[4],
            "x1 at 6.32591398": motion(6.32591398)[0],
            "y1 at 6.32591398": motion(6.32591398)[1]}


def euler_rigid_body():
    """Free rotation near the middle axis: Jacobi's functions. I = 1, 2, 3; ω = (0.01, 1, 0.01)."""
    def f(t, w):
        return [-w[1] * w[2], w[2] * w[0], -w[0] * w[1] / 3]

    # The integrals of energy and of angular momentum give the amplitudes.
    w0 = np.array([0.01, 1, 0.02])
    inertia = np.array([1, 2, 3.0])
    energy2, momentum2 = np.sum(inertia * w0**2), np.sum((inertia * w0)**2)
    motion = ode(f, w0, 40)
    at = lambda t: motion(t)
    for t in (10, 25, 40):
        assert abs(np.sum(inertia * at(t)**2) - energy2) < 1e-10 and abs(np.sum((inertia * at(t))**2) - momentum2) < 1e-10
    return {"w1 at 10": at(10)[0], "w2 at 10": at(10)[1], "w2 at 25": at(25)[1], "w3 at 40": at(40)[2],
            "w2 at 40": at(40)[1]}


def pendulum_near_the_top():
    """Let go 1e-4 before the top: θ = 2 asin(k sn(K − t)), k = sin(θ₀/2); the quarter period is K."""
    mpmath.mp.dps = 40
    k = mpmath.cos(mpmath.mpf("1e-4") / 2)
    quarter = mpmath.ellipk(k * k)
    theta = lambda t: float(2 * mpmath.asin(k * mpmath.ellipfun("sn", quarter - t, m=k * k)))
    return {"theta at 5": theta(5), "theta at 10": theta(10), "theta at 15": theta(15),
            "theta at 20": theta(20), "quarter at 25": float(quarter)}


def henon_heiles():
    f = lambda t, s: [s[2], s[3], -s[0] - 2 * s[0] * s[1], -s[1] - s[0]**2 + s[1]**2]
    s = [0.1, 0.2, 0.3, 0.1]
    energy = (s[2]**2 + s[3]**2 + s[0]**2 + s[1]**2) / 2 + s[0]**2 * s[1] - s[1]**3 / 3
    motion = ode(f, s, 60)
    return {"x at 30": motion(30)[0], "x at 60": motion(60)[0], "y at 60": motion(60)[1],
            "energy at 60": energy}


def double_pendulum():
    """Two equal rods without mass of length 1 with masses 1, g = 9.81; the 2×2 equations solved for the
    accelerations."""
    def f(t, s):
        a, b, p, q = s
        c, d = np.cos(a - b), np.sin(a - b)
        acceleration = np.linalg.solve([[2, c], [c, 1]],
                                       [-d * q * q - 2 * 9.81 * np.sin(a), d * p * p - 9.81 * np.sin(b)])
        return [p, q, *acceleration]

    motion = ode(f, [1.5, 2.0, 0, 0], 4)
    return {"a at 1": motion(1)[0], "b at 1": motion(1)[1], "a at 4": motion(4)[0], "b at 4": motion(4)[1]}


def kapitza_pendulum():
    """θ measured from the top: θ″ = (1 − 30 cos 30t) sin θ − 0.4 θ′."""
    motion = ode(lambda t, s: [s[1], (1 - 60 * np.cos(30 * t)) * np.sin(s[0]) - 0.4 * s[1]], [0.5, 0], 30,
                 max_step=0.02)
    return {"theta at 5": motion(5)[0], "theta at 15": motion(15)[0], "theta at 30": motion(30)[0]}


def spring_pendulum():
    """A mass on a spring that swings (A. Vitt and G. Gorelik 1933), tuned 2:1: ω² = 4 and g/l = 1, l = 1 with
    the load."""
    def f(t, s):
        x, y, u, v = s  # y downwards from the hook
        r = np.hypot(x, y)
        pull = 4 * (r - 0.75) / r
        return [u, v, -pull * x, 1 - pull * y]

    motion = ode(f, [0.05, 1.2, 0, 0], 40)
    return {"x at 20": motion(20)[0], "x at 40": motion(40)[0], "y at 40": motion(40)[1]}


def foucault_pendulum():
    """Linear: z = x + iy, z″ + 2iΩ z′ + z = 0 with Ω = 0.05."""
    roots = np.roots([1, 0.1j, 1])
    # z(0) = 1, z′(0) = 0
    c = np.linalg.solve([[1, 1], roots], [1, 0])
    z = lambda t: np.sum(c * np.exp(roots * t))
    return {"x at 10": z(10).real, "x at 100": z(100).real, "y at 100": z(100).imag}


def mathieu_tongue():
    """ÿ + (1 + 0.4 cos 2t) y = 0 grows; ÿ + (1.5 + 0.4 cos 2t) y = 0 does not."""
    f = lambda a: lambda t, s: [s[1], -(a + 0.4 * np.cos(2 * t)) * s[0]]
    one, two = ode(f(1), [1e-3, 0], 60), ode(f(1.5), [1e-3, 0], 60)
    return {"grows at 30": one(30)[0], "grows at 60": one(60)[0], "stays at 60": two(60)[0]}


def rocket_in_two_stages():
    """K. E. Tsiolkovsky 1903, without gravity and air: the speed is the sum of the logarithms, the way in
    closed form."""
    # m from 1 to 0.5 in 10 s, jet 3; coasting until 20; m from 0.4 to 0.15 in 10 s, jet 4; coasting until 40.
    v1 = 3 * np.log(2)
    v2 = v1 + 4 * np.log(0.4 / 0.15)
    way = lambda jet, m, q, t: jet * ((m / q - t) * np.log(1 - q * t / m) + t)
    s = way(3, 1, 0.05, 10) + 10 * v1 + way(4, 0.4, 0.025, 10) + 10 * v1 + 10 * v2
    return {"v at 5": 3 * np.log(1 / 0.75), "v at 10": v1, "v at 40": v2, "s at 40": s}


def elastic_chain():
    def f(_, y):
        points, speeds = np.vstack([[0, 0], y[:6].reshape(3, 2)]), y[6:]
        links = np.diff(points, axis=0)
        lengths = np.hypot(links[:, 0], links[:, 1])
        pulls = (400 * (lengths - 1) / lengths)[:, None] * links  # of each link on its first end
        forces = np.vstack([pulls[1:], [[0, 0]]]) - pulls - [0, 1]
        return np.concatenate([speeds, forces.ravel()])

    motion = ode(f, [1, 0, 2, 0, 3, 0] + [0] * 6, 6)
    return {f"{name} at {t}": motion(t)[i] for t in (3, 6) for name, i in (("x", 4), ("y", 5))}

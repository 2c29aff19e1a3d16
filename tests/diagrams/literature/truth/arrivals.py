# SPDX-License-Identifier: MIT
"""Pulses that signals make, to systems at rest, and what clocks do after long times."""
import mpmath
import numpy as np

_GAUSS = np.sqrt(np.pi)  # the area of exp(−t²)


def bloch_gated_pulse():
    """∫ of the product of two logistic functions, one up at 0 and one down at d, of width s: d/(1 − e^(−d/s)); by 40
    times that the Bloch vector turns."""
    angle = 40 * 0.05 / -np.expm1(-0.05 / 0.002)
    return {"w at 1000": -np.cos(angle), "v at 1000": -np.sin(angle), "v at 400": 0.0}


def state_clock_pulse():
    """A Gaussian of width s at 700 leaves x″ = −x with the amplitude s √π exp(−s²/4)."""
    swing = 0.05 * _GAUSS * np.exp(-0.05**2 / 4)
    return {"x at 690": 0.0, "x at 760": swing * np.sin(60), "x at 1000": swing * np.sin(300), "e maximum": 1.0}


def time_base_pulse():
    swing = _GAUSS * np.exp(-0.25)
    return {"x at 100": swing * np.sin(40), "x at 200": swing * np.sin(140)}


def arrival_kept_by_an_integrator():
    return {"q at 200": _GAUSS, "x at 200": time_base_pulse()["x at 200"]}


def delayed_synapse():
    """A Gaussian of width s at 150 into q′ = syn and v′ = 100 syn − v."""
    area = 0.01 * _GAUSS
    return {"q at 149": 0.0, "q at 400": area, "v at 155": 100 * area * np.exp(-5 + 0.01**2 / 4)}


def spike_in_a_table():
    """A triangle of height 1e5 on 2e-5."""
    return {"q at 600": 0.0, "q at 1000": 0.5 * 1e5 * 2e-5}


def _turn(k):
    """∫ exp(k (cos t − 1)) over a turn (R. von Mises 1918)."""
    return float(2 * mpmath.pi * mpmath.exp(-k) * mpmath.besseli(0, k))


def von_mises_kicks():
    """Kicks at 3 + 2πn, added up, and with a leak of 100 s."""
    kick = 1000 * _turn(mpmath.mpf(10)**6)
    times = 3 + 2 * np.pi * np.arange(100)
    count = lambda t: np.count_nonzero(times < t)
    assert count(628.3) == 100
    return {"s at 300": kick * count(300), "s at 628.3": kick * 100,
            "m at 628.3": kick * np.exp((times - 628.3) / 100).sum()}


def _tops(t):
    """How many tops −cos has had, at π + 2πn."""
    return float(np.floor((t - np.pi) / (2 * np.pi)) + 1)


def cam_pulses():
    area = 100 * _turn(mpmath.mpf(20000))
    return {"m at 500": area * _tops(500), "m at 1000": area * _tops(1000)}


def formed_pulses_counted():
    return {"n at 1000": _tops(1000)}


def hyperbolic_chirp():
    """−cos of the phase −1000 ln(1 − t) rises through zero at π/2 + 2πn."""
    n = float(np.floor((1000 * np.log(1e6) - np.pi / 2) / (2 * np.pi)) + 1)
    return {"n at 0.999999": n, "np at 0.999999": n}


def microsecond_pulses_after_a_million():
    """At 0, 1, … 10 ms after a million seconds, each of the area 1."""
    return {"a at 1000000.0105": 11.0, "b at 1000000.0105": 11.0, "n at 1000000.0105": 11.0}


def picosecond_pulses_after_a_million():
    """At 5000 + 10⁴ n; where cos(t/10⁴) rises through zero; the coil is on from 810 000 to 910 000 s."""
    clock = lambda t: float(np.floor((t - 5e3) / 1e4) + 1)
    rises = float(np.floor((100 - 1.5 * np.pi) / (2 * np.pi)) + 1)
    return {"x at 50000": clock(5e4), "x at 1000000": clock(1e6), "y at 1000000": rises, "z at 900000": 1.0,
            "z at 1000000": 0.0}


def timer_after_a_million():
    """In microseconds: from 0 to 2/3 in ln 3, down to 1/3 in ln 2, the first rise; then one in 2 ln 2."""
    return {"n at 1000000.0010005": float(np.floor((1000.5 - np.log(6)) / (2 * np.log(2))) + 1)}


def edges_of_two_clocks():
    """Edges at n/10 and at 3n/10, from 0 on: every one of the slow clock is one of the fast one."""
    fast, slow = [{k * step for k in range(400) if k * step <= 300.5} for step in (1, 3)]
    both = len(fast & slow)
    return {"nf at 30.05": float(len(fast)), "ns at 30.05": float(len(slow)), "nb at 30.05": float(both),
            "area at 30.05": both * 0.04}


def nanosecond_clock():
    """At 500, 1500, … 99500 s, each of the area 1."""
    return {"q at 1e5": 100.0, "n at 1e5": 100.0}


def antenna_tank():
    """1e9 rad/s: 1.1, 10.2 and 99.3 turns."""
    turn = 2e-9 * np.pi
    return {f"uV at {turns * turn!r}": np.cos(2 * np.pi * turns) for turns in (1.1, 10.2, 99.3)}


def signals_below_the_absolute_tolerance():
    return {"y at 50": np.cos(50), "y at 100": np.cos(100)}


def level_of_a_decay():
    """e^(−t) is below 10^(−n) from n ln 10 on."""
    return {"i at 40": 40 - 10 * np.log(10)}


def level_of_a_decay_12():
    return {"i at 40": 40 - 12 * np.log(10)}


def level_of_a_decay_14():
    return {"i at 40": 40 - 14 * np.log(10)}

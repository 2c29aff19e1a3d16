# SPDX-License-Identifier: MIT
"""Consoles: held, read, turned, saved, closed."""

import math

import numpy as np
import pytest

import oblique as ob


def test_goes_on_as_it_is_turned(decay):
    with ob.Console(decay) as machine:
        machine.advance(1)
        machine["x.rate"] = 3
        machine.advance("2 s")
        assert machine["x"] == pytest.approx(math.exp(-4), abs=1e-7)  # the tolerance of 1e-8, tenfold
        assert machine.read("x.rate") == ob.Reading(3, "1/s")
        machine.hold()
        machine.advance(9)
        assert machine["x"] == pytest.approx(math.exp(-4), abs=1e-7)
        machine.initial()
        machine.advance(10)
        assert machine["x"] == 1
        machine.operate()
        assert machine.time == 10


def test_shows_what_a_run_has(decay):
    run = decay.run()
    machine = ob.Console(decay)
    for row in (100, 500, 1000):
        machine.advance(run["t"][row])
        assert machine["x"] == run["x"][row]


def test_names_what_there_is(decay):
    machine = ob.Console(decay)
    assert machine.outputs == ("x",) and machine.signals == ("x",) and "x.rate" in machine.pots
    assert machine.overloads == {} and machine.events == () and machine.warnings == ()
    assert "t = 0 s" in repr(machine)


def test_records_with_a_scope(decay):
    machine = ob.Console(decay)
    curve = machine.scope("x", 2, samples=5)
    assert curve.names == ("t", "x") and curve.units["x"] == "machine unit"
    np.testing.assert_allclose(curve["x"], np.exp(-np.linspace(0, 2, 5)), atol=1e-7)
    assert machine.time == 2
    assert ob.Console(decay).scope(["x", "x.rate"], 1).rows.shape == (241, 3)


def test_repeats(decay):
    machine = ob.Console(decay)
    machine.repeat(0.5, "2 s")
    machine.advance(2.5 + 0.5 + 1)
    assert machine["x"] == pytest.approx(math.exp(-1), abs=1e-7)
    with pytest.raises(ob.RequestError, match="operate"):
        machine.repeat(0.5, 0)


def test_says_how_a_pot_was_turned(decay):
    machine = ob.Console(decay)
    assert machine.turn("x.rate", 3) is False  # a factor of 1 was left out
    assert machine.turn("x.rate", 4) is True
    machine.advance(0.5)
    assert machine["x"] == pytest.approx(math.exp(-2), abs=1e-7)


def test_records_with_a_probe(decay):
    machine = ob.Console(decay)
    steps, rows = machine.probe("x"), machine.probe(["x"], interval=0.5)
    shot = machine.probe("x", trigger="x", level=0.5, slope="falling", interval=0.1, length=0.25, single=True)
    machine.advance(2)
    assert steps.traces[0]["t"][0] == 0 and steps.traces[0].rows.shape[0] > 10
    np.testing.assert_allclose(rows.traces[0]["x"], np.exp(-0.5 * np.arange(5)), atol=1e-7)
    assert rows.traces[0].units["x"] == "machine unit"
    trace, = shot.traces
    assert trace.begin == pytest.approx(math.log(2), abs=1e-7)
    assert trace.rows.shape == (3, 2)
    rows.remove()
    with pytest.raises(ob.ConsoleError, match="no probe number"):
        rows.traces
    with pytest.raises(ob.ConsoleError, match="no signal 'y'"):
        machine.probe("y")
    with pytest.raises(ob.ConsoleError, match="no length"):
        machine.probe("x", length=0)
    with pytest.raises(ob.RequestError, match="slope"):
        machine.probe("x", trigger="x", slope="up")


def test_saves_and_restores(decay):
    machine = ob.Console(decay)
    machine.advance(1)
    state = machine.save()
    machine.advance(2)
    machine.restore(state)
    assert machine.time == 1
    other = ob.Console(decay)
    other.restore(state)
    other.advance(2)
    assert other["x"] == pytest.approx(math.exp(-2), abs=1e-7)


def test_refuses(decay):
    machine = ob.Console(decay)
    machine.advance(1)
    for work in (lambda: machine.advance(0.5), lambda: machine["y"], lambda: machine.set_mode("stop"),
                 lambda: machine.scope("x", 1)):
        with pytest.raises(ob.ConsoleError):
            work()
    for work in (lambda: machine.advance(math.nan), lambda: machine.advance(math.inf), lambda: machine.read(3),
                 lambda: machine.turn("x.rate", math.nan), lambda: machine.restore("x"), lambda: machine.scope([3], 2),
                 lambda: machine.scope([], 2)):
        with pytest.raises(ob.RequestError):
            work()
    with pytest.raises(ob.DiagramError):
        machine.turn("x.leakage", -1)
    assert machine.time == 1


def test_is_closed(decay):
    machine = ob.Console(decay)
    machine.close()
    machine.close()
    for work in (lambda: machine.time, lambda: machine.advance(1), lambda: machine["x"], machine.save,
                 lambda: machine.turn("x.rate", 1), machine.__enter__):
        with pytest.raises(ob.ConsoleError) as thrown:
            work()
        assert thrown.value.what == "the console is closed" and thrown.value.remedy
    assert repr(machine) == "<Console: closed>"


def test_notices_that_its_diagram_was_changed(decay):
    machine = ob.Console(decay)
    decay.integrator("x", name="y")
    with pytest.raises(ob.ConsoleError, match="was changed since"):
        machine.advance(1)
    fresh = ob.Console(decay)
    fresh.advance(1)
    assert fresh["y"] == pytest.approx(1 - math.exp(-1), abs=1e-7)


def test_takes_a_file():
    machine = ob.Console("diagrams/lessons/circle.toml")
    machine.advance(1)
    assert machine["x"] == pytest.approx(math.cos(1), abs=1e-7)

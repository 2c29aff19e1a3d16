# SPDX-License-Identifier: MIT
"""Runs: numbers, names, units, and what becomes of them in NumPy, pandas, xarray and Matplotlib."""

import gc
import math
import pathlib
import xml.etree.ElementTree

import numpy as np
import pytest

import oblique as ob


def test_gives_the_solution(decay):
    run = decay.run()
    assert run.names == ("t", "x")
    assert run.units == {"t": "s", "x": "machine unit"}
    # the tolerance of a run is 1e-8 of its results; errors of the steps add up to at most some of it
    np.testing.assert_allclose(run["x"], np.exp(-run["t"]), rtol=0, atol=3e-8)


def test_gives_the_bits_of_the_program(program, tmp_path):
    file = tmp_path / "side.npy"
    program("run", "diagrams/lessons/triangle-side.toml", "-o", file)
    written = np.load(file)
    run = ob.Diagram("diagrams/lessons/triangle-side.toml").run()
    for name in run:
        np.testing.assert_array_equal(run[name], written[name])


def test_columns_are_views_that_outlive_the_run(decay):
    run = decay.run()
    x, rows = run["x"], run.rows
    assert np.shares_memory(x, rows)
    assert rows.shape == (1001, 2) and x.shape == (1001,)
    kept = x.copy()
    del run, rows
    gc.collect()
    ob.Diagram("diagrams/lessons/circle.toml").run()
    np.testing.assert_array_equal(x, kept)


def test_columns_are_not_written_to(decay):
    with pytest.raises(ValueError):
        decay.run()["x"][0] = 3


def test_is_a_mapping_and_an_array(decay):
    run = decay.run(samples=11)
    assert list(run) == ["t", "x"] and len(run) == 2 and "x" in run and "y" not in run
    assert dict(run)["x"] is not None
    np.testing.assert_array_equal(np.asarray(run)[:, 1], run["x"])
    assert run.t[-1] == 2


def test_options_are_those_of_the_file_or_the_call(decay):
    run = decay.run("500 ms", samples=3, tolerance=1e-10, method="bdf")
    np.testing.assert_allclose(run["t"], [0, 0.25, 0.5])
    # a hundred times as fine as 1e-8
    np.testing.assert_allclose(run["x"], np.exp(-run["t"]), rtol=0, atol=1e-9)
    assert run.statistics["method"] == "bdf"
    assert decay.run()["t"][-1] == 2


def test_turns_pots_and_weights(decay):
    # d x/dt = -rate · weight · x, solved by hand
    for settings, rate in (({"x.rate": 3}, 3), ({"x.rate": "2"}, 2), ({"x.in[1]": -0.5}, 0.5)):
        run = decay.run(1, set=settings)
        assert run["x"][-1] == pytest.approx(np.exp(-rate), abs=1e-7)  # the tolerance, tenfold
    assert decay.run(1)["x"][-1] == pytest.approx(np.exp(-1), abs=1e-7)


def test_sets_the_gain_of_all_servo_amplifiers():
    side = ob.Diagram("diagrams/lessons/triangle-side.toml")
    # at phi = pi c² - (a + b)² = c/gain at rest, so that c is off by -1/(2 gain); the next term is 1/gain²
    for gain in (1e3, 1e4):
        side_at_pi = side.run(gain=gain, until="pi", tolerance=1e-10)["side"][-1]
        assert side_at_pi - 0.7 == pytest.approx(-0.5 / gain, abs=2 / gain**2)


def test_holds_expectations(program):
    run = ob.Diagram("diagrams/lessons/triangle-side.toml").run(check=True)
    assert run.expectations and all(one.met for one in run.expectations)
    assert len(run.expectations) == program("run", "diagrams/lessons/triangle-side.toml", "--check").count("\nok")


def test_tells_events_warnings_and_overloads():
    bouncing = ob.Diagram("diagrams/lessons/bouncing-ball.toml").run()
    assert bouncing.event_count >= len(bouncing.events) > 0
    assert all(isinstance(event.time, float) and event.what for event in bouncing.events)
    d = ob.Diagram(until=1)
    d.integrator(2, name="x")
    run = d.run(watch_overloads=True)
    (overload,) = run.overloads
    assert overload.signal == "x"
    assert overload.first == pytest.approx(0.5, abs=1e-7)  # x = 2 t; the tolerance, tenfold
    halted = d.run(halt_on_overload=True)
    assert halted.halted and halted["t"][-1] < 1


def test_estimates_its_error(decay):
    trust = decay.run(trust=True).trust
    (output,) = trust.outputs
    assert output.name == "x" and output.size == 1
    assert output.digits >= 7
    assert "digits" in trust.text


def test_goes_on_from_a_state(decay, tmp_path):
    first = decay.run(1)
    first.state.save(tmp_path / "state.toml")
    rest = decay.run(2, state=ob.State.load(tmp_path / "state.toml"))
    assert rest["x"][-1] == pytest.approx(np.exp(-2), abs=1e-7)  # the tolerance, tenfold


def test_becomes_pandas(decay):
    pandas = pytest.importorskip("pandas")
    run = decay.run()
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t"
    np.testing.assert_array_equal(frame["x"].to_numpy(), run["x"])
    assert frame.attrs["units"]["x"] == "machine unit"


def test_becomes_xarray(decay):
    pytest.importorskip("xarray")
    run = decay.run()
    dataset = run.to_xarray()
    np.testing.assert_array_equal(dataset["x"].values, run["x"])
    assert dataset["x"].attrs["units"] == "machine unit" and dataset["t"].attrs["units"] == "s"


def test_is_drawn(decay):
    pytest.importorskip("matplotlib")
    run = decay.run()
    axes = run.plot()
    assert axes.get_xlabel() == "t [s]" and axes.get_ylabel() == "x [machine unit]"
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), run["x"])
    assert run.plot("x", ax=axes) is axes and len(axes.lines) == 2
    xml.etree.ElementTree.fromstring(run.draw().svg)


def test_shows_itself_in_a_notebook(decay):
    run = decay.run()
    page = run._repr_html_()
    assert "<th>x<br><small>machine unit</small></th>" in page and "1001 rows" in page
    assert "1001 rows of t, x" in repr(run)
    assert "steps" in str(run)


def test_saves_pictures(decay, tmp_path):
    picture = decay.draw()
    for name in (tmp_path / "a.svg", str(tmp_path / "b.svg")):
        picture.save(name)
        assert pathlib.Path(name).read_text(encoding="utf-8") == picture.svg
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_differentiates_by_parameters(decay):
    run = decay.run(2, sensitivity=["x.rate", "x.initial"], tolerance=1e-9)
    t = run["t"]
    np.testing.assert_allclose(run["d(x)/d(x.rate)"], -t * np.exp(-t), atol=1e-7)  # a hundred times the tolerance
    np.testing.assert_allclose(run["d(x)/d(x.initial)"], np.exp(-t), atol=1e-7)
    value, gradient = decay.gradient("x", ["x.rate", "x.initial"], at=2)
    assert value == pytest.approx(math.exp(-2), abs=1e-6)
    np.testing.assert_allclose(gradient, [-2 * math.exp(-2), math.exp(-2)], atol=1e-6)
    integral, (by_initial,) = decay.gradient("x", "x.initial", until=2)
    assert integral == pytest.approx(1 - math.exp(-2), abs=1e-6) and by_initial == pytest.approx(integral, abs=1e-6)
    with pytest.raises(ob.ReadError, match="no sensitivity to 'x.rat'"):
        decay.run(2, sensitivity="x.rat")
    with pytest.raises(ob.ReadError, match="no output 'y'"):
        decay.gradient("y", "x.rate", at=1)

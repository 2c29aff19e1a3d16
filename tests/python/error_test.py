# SPDX-License-Identifier: MIT
"""What goes wrong: one clear exception each, with its fields."""

import copy
import math
import pickle
import sys

import numpy as np
import pytest

import oblique as ob


def refused(kind, work):
    """The exception, which is of the kind and says what is wrong in words of Python."""
    with pytest.raises(kind) as thrown:
        work()
    error = thrown.value
    assert isinstance(error, ob.Error) and error.what
    assert "--" not in str(error), "an option of the command line"
    assert "`oblique " not in str(error), "a verb of the command line"
    return error


def test_has_the_fields_of_the_finding():
    error = refused(ob.DiagramError, lambda: ob.Diagram(
        text='format = "oblique-diagram/1"\n[blocks]\nx = { type = "integrater", in = "-x" }\n', file="leg.toml").run())
    assert (error.file, error.line) == ("leg.toml", 3)
    assert "integrater" in error.what and error.remedy == "did you mean 'integrator'?"
    assert str(error).startswith("leg.toml:3:")


def test_tells_all_findings_together():
    error = refused(ob.DiagramError, lambda: ob.Diagram(
        text='format = "oblique-diagram/1"\n[blocks]\nx = { type = "cosine", in = "y" }\nz = { type = "sine", in = "w" }\n'
    ).run())
    assert [found.line for found in error.diagnostics] == [3, 4]


def test_survives_pickling_and_copying():
    error = refused(ob.ReadError, lambda: ob.Diagram("there-is-none.toml"))
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert type(again) is ob.ReadError and str(again) == str(error) and again.diagnostics == error.diagnostics


def test_of_files():
    assert "there-is-none.toml" in str(refused(ob.ReadError, lambda: ob.Diagram("there-is-none.toml")))
    refused(ob.ReadError, lambda: ob.Mechanism("diagrams"))
    refused(ob.ReadError, lambda: ob.Diagram(text="format = "))
    refused(ob.Error, lambda: ob.Diagram("diagrams/mechanisms/four-bar.toml"))
    refused(ob.Error, lambda: ob.Mechanism("diagrams/lessons/circle.toml"))
    refused(ob.RequestError, lambda: ob.Diagram(3))
    refused(ob.RequestError, lambda: ob.Diagram("a.toml", text="b"))
    refused(ob.ReadError, lambda: ob.State.load("diagrams"))


def test_of_names(decay):
    run = decay.run()
    error = refused(ob.UnknownNameError, lambda: ob.Diagram("diagrams/lessons/triangle-side.toml").run()["sied"])
    assert isinstance(error, KeyError) and isinstance(error, ValueError)
    assert str(error) == "there is no column 'sied'\n  remedy: did you mean 'side'?"
    refused(ob.UnknownNameError, lambda: run[3])
    refused(ob.UnknownNameError, lambda: run.plot("y"))
    refused(ob.UnknownNameError, lambda: run.draw("y"))
    assert "integrator" in refused(ob.UnknownNameError, lambda: ob.blocks["integrater"]).remedy
    assert "tr-10" in refused(ob.UnknownNameError, lambda: ob.machines["tr-1O"]).remedy
    refused(ob.DiagramError, lambda: decay.run(set={"y.rate": 1}))
    refused(ob.DiagramError, lambda: decay.run(set={"x.rat": 1}))


def test_of_numbers(decay):
    for until in (math.nan, -1, 0, math.inf, "3 m", "soon", None, [1], True, 1j, np.array([1.0, 2.0])):
        if until is not None:
            assert "until" in str(refused(ob.Error, lambda: decay.run(until)))
    for samples in (1, 2.5, "many", math.nan, math.inf, None, 10**12):
        if samples is not None:
            refused(ob.RequestError, lambda: decay.run(samples=samples))
    refused(ob.RequestError, lambda: decay.run(set={"x.rate": math.nan}))
    refused(ob.RequestError, lambda: decay.run(set={"x.rate": [1, 2]}))
    refused(ob.RequestError, lambda: decay.run(set=["x.rate", 1]))
    refused(ob.RequestError, lambda: decay.run(set={3: 1}))
    refused(ob.DiagramError, lambda: decay.run(set={"x.leakage": -1}))
    assert "is too large" in str(refused(ob.RequestError, lambda: decay.run(set={"x.rate": 10**400})))
    for wrong in ("x", 1, 0.0):
        assert "True or False" in str(refused(ob.RequestError, lambda: decay.run(settle=wrong)))
    decay.run(settle=np.bool_(False))
    refused(ob.RequestError, lambda: decay.run(tolerance=-1))
    assert refused(ob.RequestError, lambda: decay.run(method="bfd")).remedy == "did you mean 'bdf'?"
    refused(ob.RequestError, lambda: decay.run(gain=1e4))
    refused(ob.RequestError, lambda: decay.run(state="x"))
    assert decay.run(np.float64(1), samples=np.int64(3))["t"][-1] == 1
    assert decay.run(np.array(1.0))["t"][-1] == 1


def test_of_options_that_contradict_each_other(decay):
    refused(ob.DiagramError, lambda: decay.run(check=True))
    refused(ob.RequestError, lambda: ob.Diagram("diagrams/lessons/circle.toml", until=3))
    state = decay.run(2).state
    error = refused(ob.ReadError, lambda: decay.run(1, state=state))
    assert "until=" in error.remedy


def test_of_the_solver():
    d = ob.Diagram(until=10)
    x = d.integrator(initial=1, name="x")
    x.input = x * x
    error = refused(ob.SolveError, d.run)
    assert error.kind == "blow_up" or error.kind == "step_budget"
    assert error.time == pytest.approx(1, abs=1e-3)  # x = 1/(1 - t)
    assert refused(ob.SolveError, lambda: ob.Diagram("diagrams/lessons/circle.toml").run(max_steps=3)).kind == "step_budget"


def test_of_mechanisms():
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    for gains in ([], [1e3, math.nan], [-1], [math.inf], np.ones((2, 2)), "many", [None]):
        refused(ob.Error, lambda: four_bar.compare(gains))
    refused(ob.RequestError, lambda: four_bar.compare(methods=["triangles", "gradeint"]))
    refused(ob.RequestError, lambda: four_bar.compare([1e3, 1e4], monte_carlo=10, tolerance=1e-3))
    refused(ob.RequestError, lambda: four_bar.compare(1e4, monte_carlo=10, tolerance=0.9))
    assert "tolerance" in str(refused(ob.Error, lambda: four_bar.compare(1e4, monte_carlo=10)))
    refused(ob.RequestError, lambda: four_bar.compare(1e4, tolerance=1e-3))
    refused(ob.RequestError, lambda: four_bar.solve(1))
    refused(ob.RequestError, lambda: four_bar.solve(at_limit="halt"))
    refused(ob.UnknownNameError, lambda: four_bar.solve(11)["Q.x"])
    refused(ob.UnknownNameError, lambda: four_bar.patch(machine="tr10"))
    refused(ob.RequestError, lambda: four_bar.patch(gain=0))
    refused(ob.RequestError, lambda: four_bar.patch(method="gradient", slower=3))
    refused(ob.RequestError, lambda: four_bar.draw(gain=3))
    refused(ob.Error, lambda: four_bar.draw(trace="Q"))
    refused(ob.Error, lambda: four_bar.plots("Q"))
    refused(ob.Error, lambda: four_bar.draw(theme="dim"))
    refused(ob.RequestError, lambda: four_bar.animate(frames=3))
    refused(ob.RequestError, lambda: four_bar.animate().save("leg.gif"))
    refused(ob.RequestError, lambda: four_bar.draw().save("leg.jpg"))
    refused(ob.RequestError, lambda: four_bar.report().save("leg.pdf"))


def test_of_a_fit():
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    refused(ob.RequestError, lambda: four_bar.fit({"M.x": [1, 2, 3], "M.y": [1, 2]}, "AB=0.5..2"))
    refused(ob.RequestError, lambda: four_bar.fit({"M.x": [1, math.nan], "M.y": [1, 2]}, "AB=0.5..2"))
    refused(ob.RequestError, lambda: four_bar.fit({}, "AB=0.5..2"))
    refused(ob.RequestError, lambda: four_bar.fit({"M.x": [[1, 2]], "M.y": [[1, 2]]}, "AB=0.5..2"))
    refused(ob.Error, lambda: four_bar.fit({"Q.x": [1, 2, 3], "Q.y": [1, 2, 3]}, "AB=0.5..2"))


def test_warnings_are_seen():
    circle = ob.Diagram("diagrams/lessons/circle.toml")
    with pytest.warns(ob.RunWarning) as told:  # Adams at such a tolerance lets oscillations grow
        run = circle.run(method="adams", tolerance=1e-2)
    assert told[0].filename == __file__, "the line of the user"
    assert [str(one.message) for one in told] == [one.message for one in run.warnings]
    d = ob.Diagram(until=1, machine="tr-10")
    d.integrator(2, name="x")
    with pytest.warns(ob.RunWarning, match="left ±1 machine unit, 'x' first"):
        assert d.run().overloads
    with pytest.warns(ob.RunWarning, match="cannot be assembled"):
        assert (ob.Mechanism("diagrams/mechanisms/double-rocker.toml").solve(91, at_limit="open").status == "open").any()


def test_of_packages_that_are_not_there(decay, monkeypatch):
    run = decay.run()
    for package, work in (("pandas", run.to_pandas), ("xarray", run.to_xarray)):
        monkeypatch.setitem(sys.modules, package, None)
        assert f"python3-{package}" in refused(ob.RequestError, work).remedy
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    assert "python3-matplotlib" in refused(ob.RequestError, run.plot).remedy


def test_what_stands_in_the_way_is_told_with_the_remedy():
    # at its change points the parallelogram has two ways to go on
    error = refused(ob.PatchError, lambda: ob.Mechanism("diagrams/mechanisms/parallelogram.toml").patch())
    assert error.kind == "obstacle"

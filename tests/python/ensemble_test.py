# SPDX-License-Identifier: MIT
"""Plans and ensembles from Python."""

import copy
import math
import pickle

import numpy as np
import pytest

import oblique as ob

from conftest import DECAY

PLAN = """format = "oblique-ensemble/1"
title = "Decays"
diagram = "decay.toml"
[vary]
"x.initial" = "1..2:30"
"x.in[1]" = [-1, -2]
[measure]
last = "end(x)"
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "decay.toml").write_text(DECAY, encoding="utf-8")
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf-8")
    return tmp_path


def refused(kind, what):
    with pytest.raises(kind) as caught:
        what()
    return caught.value


def test_a_plan_is_run(folder):
    plan = ob.Plan(folder / "plan.toml")
    assert (plan.runs, plan.title, plan.seed, plan.varied) == (60, "Decays", 1, ("x.initial", "x.in[1]"))
    assert list(plan.columns) == ["x.initial", "x.in[1]", "last"]
    run = plan.run()
    assert run.rows.shape == (60, 3)
    # x(2) = h exp(2 r); the solver's tolerance is 1e-8, and errors of steps add up (docs/running.md)
    np.testing.assert_allclose(run["last"], run["x.initial"] * np.exp(2 * run["x.in[1]"]), atol=1e-7)
    assert run.failures == {} and run.in_lanes + run.by_cvodes == 60
    assert run.records["last"][7] == run["last"][7] and run.records.dtype.names == tuple(plan.columns)


def test_the_bytes_are_those_of_the_program(folder, program):
    program("ensemble", "run", folder / "plan.toml", "-o", folder / "all", "--table", folder / "all.npy")
    plan = ob.Plan(folder / "plan.toml", threads=2)
    for number in (2, 0, 1):
        assert plan.make_chunk(number, 3, folder / "mine")
    assert not plan.make_chunk(3, 3, folder / "mine")  # 3 of 3 is 0 of 3
    run = plan.gather(folder / "mine", folder / "mine.npy")
    assert (folder / "mine.npy").read_bytes() == (folder / "all.npy").read_bytes()
    assert run.rows.tobytes() == plan.run().rows.tobytes()
    assert np.load(folder / "all.npy")["last"].tobytes() == run["last"].tobytes()
    # and of what the program makes, Python gathers
    assert plan.gather(folder / "all").rows.tobytes() == run.rows.tobytes()


def test_a_plan_without_a_file(folder):
    by_file = ob.Plan(folder / "plan.toml").run()
    lists = {"x.initial": np.linspace(1, 2, 30), "x.in[1]": [-1, -2]}
    for subject in (folder / "decay.toml", ob.Diagram(folder / "decay.toml"), ob.Diagram(text=DECAY)):
        run = ob.sweep(subject, vary=lists, measure={"last": "end(x)"})
        np.testing.assert_allclose(run.rows, by_file.rows, rtol=1e-9)
    d = ob.Diagram(until=1)
    x = d.integrator(name="x", initial=1)
    x.input = -1 * x
    run = ob.sweep(d, scatter={"integrator.initial": 0.5}, runs=20, seed=2**64 - 1, measure={"last": "end(x)"})
    assert run.rows.shape == (20, 1) and run.varied == ()
    assert np.all(np.abs(run["last"] * math.e - 1) <= 0.5 + 1e-6) and np.ptp(run["last"]) > 0.01


@pytest.mark.parametrize("arguments, options", [
    (("diagrams/lessons/triangle-side.toml", "--vary", "c.gain=1e2..1e5:7:log", "--vary", "a.value=0.2,0.3",
      "--scatter", "multiplier.error=0.1%", "--runs", "3", "--seed", "7", "--measure", "largest = max(side)"),
     {"vary": {"c.gain": "1e2..1e5:7:log", "a.value": "0.2,0.3"}, "scatter": {"multiplier.error": "0.1%"}, "runs": 3, "seed": 7,
      "measure": {"largest": "max(side)"}}),
    (("diagrams/mechanisms/four-bar.toml", "--vary", "AB=0.8..1.2", "--vary", "gain=1e3..1e6:log", "--sobol", "--runs", "12",
      "--measure", "worst = error()"),
     {"vary": {"AB": "0.8..1.2", "gain": "1e3..1e6:log"}, "sampling": "sobol", "runs": 12, "measure": {"worst": "error()"}}),
    (("diagrams/mechanisms/four-bar.toml", "--tolerance-of-elements", "0.1%", "--runs", "40", "--samples", "91",
      "--measure", "worst = error()"),
     {"tolerance_of_elements": "0.1%", "runs": 40, "samples": 91, "measure": {"worst": "error()"}}),
])
def test_a_sweep_is_that_of_the_program(tmp_path, program, arguments, options):
    program("sweep", *arguments, "-o", tmp_path / "swept.npy")
    swept = np.load(tmp_path / "swept.npy")
    for threads in (1, 3):
        for subject in (arguments[0], ob.Mechanism(arguments[0]) if "mech" in arguments[0] else ob.Diagram(arguments[0])):
            run = ob.sweep(subject, threads=threads, **options)
            assert run.names == swept.dtype.names
            for name in run:
                assert run[name].tobytes() == swept[name].tobytes()
            assert list(run.numbers) == list(range(len(swept)))


def test_progress_is_told_and_may_end_it(folder):
    many = {"vary": {"x.initial": "1..2:100000"}, "measure": {"last": "end(x)"}, "threads": 1}
    seen = []

    def tell(done, machines):
        seen.append((done, machines))
        if len(seen) == 2:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        ob.sweep(folder / "decay.toml", progress=tell, **many)
    assert len(seen) == 2 and 0 < seen[0][0] <= seen[1][0] < 100_000 and seen[0][1] == 100_000

    def stop(done, _):
        raise KeyboardInterrupt

    with pytest.raises(ob.Interrupted, match="of 100000 machines were run") as caught:
        ob.sweep(folder / "decay.toml", progress=stop, **many)
    run = caught.value.run
    assert 0 < len(run.rows) < 100_000 and len(run.numbers) == len(run.rows)
    # what was done is done: x(2) = x(0) exp(-2), with the tolerance of 1e-8 as above
    np.testing.assert_allclose(run["x.initial"], 1 + run.numbers / 99_999, rtol=1e-12)
    np.testing.assert_allclose(run["last"], run["x.initial"] * math.exp(-2), atol=1e-7)


def test_a_plan_is_written_and_copied(folder):
    plan = ob.Plan(folder / "plan.toml")
    plan.save(folder / "again.toml")
    again = ob.Plan(folder / "again.toml")
    assert again._raw.identity == plan._raw.identity
    for other in (pickle.loads(pickle.dumps(plan)), copy.deepcopy(plan)):
        assert other._raw.identity == plan._raw.identity and other.runs == 60
    (folder / "decay.toml").write_text(DECAY.replace("initial = 1", "initial = 3"), encoding="utf-8")
    assert ob.Plan(folder / "plan.toml")._raw.identity != plan._raw.identity


def test_a_machine_that_fails_is_told_of():
    d = ob.Diagram(until=10)
    x = d.integrator(name="x", initial=1)
    x.input = x * x
    run = ob.sweep(d, vary={"x.initial": [0.01, 1]}, measure={"last": "end(x)"})
    assert run["last"][0] == pytest.approx(1 / (1 / 0.01 - 10), rel=1e-6)  # x = 1/(1/x0 - t)
    assert math.isnan(run["last"][1]) and list(run.failures) == [1] and run.failures[1]


def test_what_is_there_is_known(folder):
    plan = ob.Plan(folder / "plan.toml")
    plan.make_chunk(1, 4, folder / "c")
    status = plan.status(folder / "c")
    assert [(one.number, one.first, one.runs) for one in status.missing] == [(0, 0, 15), (2, 30, 15), (3, 45, 15)]
    assert status.runs_there == 15 and not status.complete and status.damaged == {}
    error = refused(ob.PlanError, lambda: plan.gather(folder / "c"))
    assert "chunks are missing: 0/4, 2/4, 3/4" in str(error)
    (one,) = (folder / "c").iterdir()
    one.write_bytes(one.read_bytes()[:-1])
    assert "it is not whole" in plan.status(folder / "c").damaged[str(one)]
    other = ob.Plan(text=PLAN.replace("1..2", "1..3"), file=str(folder / "other.toml"))
    other.make_chunk(1, 4, folder / "c")
    assert "this chunk is of another plan" in str(refused(ob.PlanError, lambda: plan.status(folder / "c")))


def test_what_makes_no_sense_is_refused(folder):
    plan = ob.Plan(folder / "plan.toml")
    sides = {"vary": {"x.initial": [1, 2]}, "measure": {"last": "end(x)"}}
    refused(ob.RequestError, ob.Plan)
    refused(ob.RequestError, lambda: ob.Plan("a", text="b"))
    refused(ob.ReadError, lambda: ob.Plan(folder / "nowhere.toml"))
    refused(ob.PlanError, lambda: ob.Plan(text="format = 'oblique-ensemble/1'\n"))
    assert "this is a diagram" in str(refused(ob.PlanError, lambda: ob.Plan(folder / "decay.toml")))
    assert "did you mean 'initial'" in str(refused(ob.PlanError, lambda: ob.sweep(
        ob.Diagram(text=DECAY), vary={"x.initail": [1, 2]}, measure={"last": "end(x)"})))
    for wrong in ({"vary": [1]}, {"vary": {3: [1]}}, {"vary": {"x.initial": []}}, {"vary": {"x.initial": [math.nan]}},
                  {"measure": "end(x)"}, {"seed": -1}, {"seed": 1.5}, {"sampling": "sobel"}, {"runs": 0}, {"samples": 1},
                  {"tolerance": 0}, {"threads": -1}, {"tolerance_of_elements": math.nan}):
        refused(ob.RequestError, lambda: ob.sweep(ob.Diagram(text=DECAY), **{**sides, **wrong}))
    refused(ob.PlanError, lambda: ob.sweep(ob.Diagram(text=DECAY), **{**sides, "measure": {}}))
    refused(ob.PlanError, lambda: ob.sweep(ob.Diagram(text=DECAY), **{**sides, "gain": 1e4}))
    refused(ob.PlanError, lambda: plan.make_chunk(4, 3, folder / "c"))
    refused(ob.PlanError, lambda: plan.make_chunk(0, 61, folder / "c"))
    refused(ob.RequestError, lambda: plan.make_chunk(0, 0, folder / "c"))
    refused(ob.RequestError, lambda: plan.make_chunk("one", 3, folder / "c"))
    refused(ob.ReadError, lambda: plan.make_chunk(0, 3, folder / "plan.toml"))
    refused(ob.ReadError, lambda: plan.status(folder / "nowhere"))
    with pytest.warns(ob.RunWarning, match="written by version 0.0.7"):
        ob.Plan(text='version = "0.0.7"\n' + PLAN, file=str(folder / "p.toml"))


def test_refuses_a_progress_that_is_no_function(folder):
    with pytest.raises(ob.RequestError, match="progress=3 cannot be called"):
        ob.sweep(folder / "decay.toml", vary={"x.initial": "1..2:3"}, measure={"last": "end(x)"}, progress=3)

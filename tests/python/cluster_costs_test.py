# SPDX-License-Identifier: MIT
"""The simulation behind the figures of docs/ensembles.md, where its answer is known without it."""

import importlib.util
import io
import json
import os
import subprocess
import sys

import pytest

from conftest import DECAY, ROOT

_spec = importlib.util.spec_from_file_location("cluster_costs", ROOT / "tests/bench/cluster_costs.py")
costs = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(costs)

TIMES = {"start": 2.0, "chunk": 1.0, "run": 0.01, "spread": 0.0}
NEVER = 1e12


@pytest.mark.parametrize("size, cores", [(1000, 2), (10_000, 64), (100_000, 64), (100_000, 1024)])
def test_without_failures_cores_work_in_rounds(size, cores):
    chunks = costs.RUNS // size
    hours, busy, lost = costs.makespan(TIMES, size, cores, (0.0, 0.0, True), NEVER, 1)
    each = 1.0 + 0.01 * size
    assert lost == 0
    assert busy * 3600 == pytest.approx(chunks * each)
    assert hours * 3600 == pytest.approx(2.0 + -(-chunks // cores) * each)


def test_a_scheduler_that_is_slow_is_the_limit():
    hours, _, _ = costs.makespan(TIMES, 1000, 1024, (0.5, 0.0, False), NEVER, 1)
    # the last of 1000 chunks is given out after 1000 turns of half a second
    assert hours * 3600 == pytest.approx(1000 * 0.5 + 2.0 + 10.0)


def test_what_is_lost_is_run_again():
    hours, busy, lost = costs.makespan(TIMES, 10_000, 2, (0.0, 0.0, True), 0.5, 1)
    calm, without, _ = costs.makespan(TIMES, 10_000, 2, (0.0, 0.0, True), NEVER, 1)
    assert lost > 0
    assert busy > without and hours > calm
    # a chunk that is lost has cost no more than a whole one, and a node is away for ten minutes each time
    assert busy - without <= lost * 101 / 3600
    assert hours - calm <= lost * (101 + costs.AWAY) / 3600


def test_a_plan_is_timed(tmp_path):
    (tmp_path / "decay.toml").write_text(DECAY, encoding="utf-8")
    (tmp_path / "decays.toml").write_text('format = "oblique-ensemble/1"\ndiagram = "decay.toml"\nsampling = "latin-hypercube"\n[vary]\n'
                                          '"x.initial" = "1..2"\n', encoding="utf-8")
    command = [sys.executable, ROOT / "tests/bench/cluster_costs.py", "measure", "--program", os.environ["OBLIQUE_PROGRAM"],
               "--repeats", "2", "--plan"]
    done = subprocess.run([*command, tmp_path / "decays.toml"], capture_output=True, text=True, check=False, timeout=100)
    assert done.returncode == 1 and "this one says runs = None" in done.stderr
    (tmp_path / "decays.toml").write_text((tmp_path / "decays.toml").read_text().replace("[vary]", "runs = 3000\n[vary]"))
    done = subprocess.run([*command, tmp_path / "decays.toml"], capture_output=True, text=True, check=False, timeout=100)
    times = json.loads(done.stdout)["decays"]
    assert 0 < times["run"] < times["start"] and 0 <= times["chunk"] and 0 <= times["spread"]
    # runs of some microseconds: a process for a thousand of them is a waste, and that is told
    assert "MISSED: a chunk of 1000 runs as a process of its own" in done.stderr and done.returncode == 0


@pytest.mark.parametrize("start, chunk, words", [(0.04, 0.001, ["met", "met"]), (0.05, 0.001, ["met", "MISSED"]),
                                                 (0.0, 0.06, ["MISSED", "MISSED"])])
def test_a_chunk_that_costs_too_much_is_told_of(start, chunk, words):
    said = io.StringIO()
    costs.judge({"any": {"start": start, "chunk": chunk, "run": 1e-3, "spread": 0.0}}, said)
    assert [line.split(":")[0].strip() for line in said.getvalue().splitlines()[1:]] == words

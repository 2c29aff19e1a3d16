# SPDX-License-Identifier: MIT
"""The simulation behind the figures of docs/ensembles.md, where its answer is known without it."""

import importlib.util

import pytest

from conftest import ROOT

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

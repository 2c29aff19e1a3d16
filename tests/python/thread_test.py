# SPDX-License-Identifier: MIT
"""Threads: Python's lock is released, and what they share is not disturbed."""

import copy
import multiprocessing
import pickle
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import oblique as ob


def long_run():
    """About half a second and more of work: a circle of many turns."""
    return ob.Diagram("diagrams/lessons/circle.toml").run(until=20_000)


def many_runs():
    """The same of an ensemble."""
    return ob.sweep("diagrams/mechanisms/four-bar.toml", tolerance_of_elements=1e-3, runs=2000, threads=1)


@pytest.mark.parametrize("work", [long_run, many_runs])
def test_python_goes_on_while_the_machine_runs(work):
    done = threading.Event()
    runner = threading.Thread(target=lambda: (work(), done.set()))
    runner.start()
    beats = 0
    while not done.is_set():
        time.sleep(0.001)
        beats += 1
    runner.join()
    # Some hundreds; were the lock held all the while, one before and one after the run.
    assert beats > 5


def test_threads_share_a_diagram():
    diagram = ob.Diagram("diagrams/lessons/triangle-side.toml")
    gains = [10.0**power for power in (3, 4, 5, 6)] * 4
    with ThreadPoolExecutor(8) as pool:
        runs = list(pool.map(lambda gain: diagram.run(gain=gain)["side"], gains))
    for gain, side in zip(gains, runs):
        np.testing.assert_array_equal(side, ob.Diagram("diagrams/lessons/triangle-side.toml").run(gain=gain)["side"])


def test_threads_share_a_console(decay):
    machine = ob.Console(decay)
    machine.advance(1)

    def look(_):
        return machine["x"], machine.read("x.rate").value

    with ThreadPoolExecutor(8) as pool:
        readings = set(pool.map(look, range(200)))
    assert len(readings) == 1


def test_processes_take_copies():
    diagram = ob.Diagram(until=1)
    x = diagram.integrator(initial=1, name="x")
    x.input = -x
    own = ob.Diagram("diagrams/own-blocks/triangle-wave.toml", blocks="diagrams/own-blocks/blocks")
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    for again in (pickle.loads(pickle.dumps((diagram, own, four_bar))), copy.deepcopy((diagram, own, four_bar))):
        np.testing.assert_array_equal(again[0].run()["x"], diagram.run()["x"])
        np.testing.assert_array_equal(again[1].run().rows, own.run().rows)
        np.testing.assert_array_equal(again[2].solve(9).rows, four_bar.solve(9).rows)
        again[0].integrator("x", name="y")
        assert "y" not in diagram.block_types
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        ends = [table[-1] for table in pool.map(end_of, [diagram] * 2, [1.0, 2.0])]
    assert ends == [diagram.run(end)["x"][-1] for end in (1.0, 2.0)]


def end_of(diagram, until):
    return diagram.run(until)["x"].copy()


def test_threads_compare_mechanisms():
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    with ThreadPoolExecutor(4) as pool:
        orders = list(pool.map(lambda _: four_bar.compare([1e3, 1e4]).order, range(4)))
    assert len(set(orders)) == 1

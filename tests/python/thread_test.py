# SPDX-License-Identifier: MIT
"""Threads: Python's lock is released, and what they share is not disturbed."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import oblique as ob


def long_run():
    """About half a second and more of work: a circle of many turns."""
    return ob.Diagram("diagrams/lessons/circle.toml").run(until=20_000)


def test_python_goes_on_while_the_machine_runs():
    begin = time.perf_counter()
    long_run()
    alone = time.perf_counter() - begin
    done = threading.Event()
    runner = threading.Thread(target=lambda: (long_run(), done.set()))
    runner.start()
    beats = 0
    while not done.is_set():
        time.sleep(0.001)
        beats += 1
    runner.join()
    # Were the lock held, there would be a beat or two; on a busy machine at least one each 50 ms can be had.
    assert beats > 20 * alone


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


def test_threads_compare_mechanisms():
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    with ThreadPoolExecutor(4) as pool:
        orders = list(pool.map(lambda _: four_bar.compare([1e3, 1e4]).order, range(4)))
    assert len(set(orders)) == 1

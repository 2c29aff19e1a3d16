# SPDX-License-Identifier: MIT
"""Ctrl-C ends what takes long, and Python goes on."""

import signal
import subprocess
import sys
import time

import pytest

from conftest import ROOT

SHELL = """
import oblique as ob
{prepare}
print("begun", flush=True)
try:
    {work}
except KeyboardInterrupt as error:
    stop = error
    print("interrupted")
print("goes on:", {after})
"""


@pytest.mark.parametrize("prepare, work, after", [
    ("d = ob.Diagram('diagrams/lessons/circle.toml')", "d.run(1e9, max_steps=10**9)", "d.run()['t'][0] == 0"),
    ("d = ob.Diagram('diagrams/lessons/circle.toml')", "d.run(1e9, max_steps=10**9, samples=2)", "d.run()['t'][0] == 0"),
    ("d = ob.Diagram('diagrams/lessons/circle.toml')", "d.run(1e9, max_steps=10**9, trust=True)", "d.run()['t'][0] == 0"),
    ("c = ob.Console('diagrams/lessons/circle.toml')", "c.advance(1e9)", "c.time < 1e9 and abs(c['x']) < 1.01"),
    ("c = ob.Console('diagrams/lessons/circle.toml')", "c.scope('x', 1e9)", "c.time < 1e9 and abs(c['x']) < 1.01"),
    ("m = ob.Mechanism('diagrams/mechanisms/four-bar.toml')",
     "m.compare(1e6, monte_carlo=10**6, tolerance=1e-3, threads=2)", "m.compare(1e4).order is None"),
    ("m = ob.Mechanism('diagrams/mechanisms/four-bar.toml')",
     "ob.sweep(m, tolerance_of_elements=1e-3, runs=10**6)", "0 < len(stop.run.rows) < 10**6"),
    ("m = ob.Mechanism('diagrams/mechanisms/four-bar.toml')",
     "[m.compare([1e3, 1e4]) for _ in range(10**6)]", "m.compare(1e4).order is None"),
    ("m = ob.Mechanism('diagrams/mechanisms/four-bar.toml')", "m.solve(10**7)", "len(m.solve(3).t) == 3"),
])
def test_is_interrupted(prepare, work, after):
    with subprocess.Popen([sys.executable, "-c", SHELL.format(prepare=prepare, work=work, after=after)], cwd=ROOT,
                          stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(1)  # in half of it a busy machine has no member of a sweep yet
        process.send_signal(signal.SIGINT)
        begin = time.perf_counter()
        try:
            printed, _ = process.communicate(timeout=60)
        finally:
            process.kill()
        took = time.perf_counter() - begin
    assert printed == "interrupted\ngoes on: True\n"
    # It looks every twentieth of a second; a run of a comparison is over in less. A busy machine takes longer.
    assert took < 20

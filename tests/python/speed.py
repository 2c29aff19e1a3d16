# SPDX-License-Identifier: MIT
"""How fast a run is from Python, beside the program: prints the ratios, and fails where they are not kept.

    PYTHONPATH=build/release/src/python /usr/bin/python3 tests/python/speed.py [RUNS]
"""

import pathlib
import subprocess
import sys
import time

import oblique as ob

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/src/cli/oblique"
LONG = ROOT / "diagrams/lessons/circle.toml"
LONG_END = 100_000  # [s]: some seconds of work
TURNED = ROOT / "diagrams/lessons/triangle-side.toml"


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def program(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True)


def one_run(repetitions=10):
    """A run of some seconds, reading the file and taking the rows included, in turns with the program."""
    pairs = [(seconds(lambda: ob.Diagram(LONG).run(LONG_END).rows),
              seconds(lambda: program("run", LONG, "--until", LONG_END))) for _ in range(repetitions)]
    python, command = (min(times) for times in zip(*pairs))  # on a busy machine the least disturbed
    return python, command


def turned_pots(runs):
    """As many runs, each with another gain; the program is started for each."""
    diagram = ob.Diagram(TURNED)
    gains = [1e3 * 1.01**k for k in range(runs)]
    python = seconds(lambda: [diagram.run(set={"c.gain": gain}) for gain in gains])
    command = seconds(lambda: [program("run", TURNED, "--set", f"c.gain={gain!r}") for gain in gains])
    return python, command


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    python, command = one_run()
    ratio = python / command
    print(f"one run: {python:.3f} s from Python, {command:.3f} s by the program: {ratio:.3f} times as long (at most 1.05)")
    python, command = turned_pots(runs)
    faster = command / python
    print(f"{runs} turned pots: {1e3 * python / runs:.2f} ms a run from Python, {1e3 * command / runs:.2f} ms a start of "
          f"the program: {faster:.1f} times as fast (at least 5)")
    return 0 if ratio <= 1.05 and faster >= 5 else 1


if __name__ == "__main__":
    sys.exit(main())

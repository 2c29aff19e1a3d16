#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What an ensemble costs on a cluster: chunks are timed here, and a cluster with failures is simulated from that.

    tests/bench/cluster_costs.py measure --program build/release/src/cli/oblique > times.json
    tests/bench/cluster_costs.py simulate times.json                # the tables of docs/ensembles.md, "A million runs"

A chunk of r runs takes a + b r as a process of its own: a for the start of the program, the reading, the patch, the file;
b a run. `measure` takes both from chunks of 1 to 1000 runs of the plans below, by least squares on the shortest of several
times. In a process that goes on, as a worker of Dask, a chunk takes c + b r, and a is there once: c comes from short
runs of a diagram of one block, in one chunk and in many. `simulate` then gives chunks to cores as they come free, through a
scheduler that needs some time for each, and lets nodes fail at random: what ran there is lost and run again, and the node is
away for a while. A chunk's time is drawn from a normal distribution of the measured spread.
"""

from __future__ import annotations

import argparse
import heapq
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections import deque

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLANS = {"Jansen's leg": "jansen", "four-bar": "four-bar"}
RUNS = 1_000_000
# Cores, in nodes of so many at the most.
CLUSTERS = (2, 64, 1024)
NODE = 64
# A node fails once in so many hours (in a machine room; where it is given to others and taken away), and is away so long [s].
BETWEEN_FAILURES, AWAY = (1000.0, 2.0), 600.0
# What a scheduler needs for a chunk [s], one after the other for all cores; what each chunk waits for beside that; whether its
# workers go on from chunk to chunk.
SCHEDULERS = {"Dask": (0.001, 0.01, True), "Slurm": (0.02, 1.0, False)}
SIZES = (100, 1000, 10_000, 100_000)
TRIALS = 5


def measure(program: str, repeats: int, most: int) -> dict[str, dict[str, float]]:
    """a, b and the spread of each plan, from chunks that one core makes."""
    found = {}
    c = more_for_many(program, repeats)
    sizes = [runs for runs in (1, 10, 100, 1000) if runs <= most]
    for name, mechanism in PLANS.items():
        with tempfile.TemporaryDirectory() as folder:
            plan = pathlib.Path(folder) / "plan.toml"
            plan.write_text(
                f'format = "oblique-ensemble/1"\nmechanism = "{ROOT}/diagrams/mechanisms/{mechanism}.toml"\nruns = {RUNS}\n'
                '[scatter]\ntolerance = "0.1%"\n[measure]\nworst = "error()"\n', encoding="utf-8")
            shortest, spread = [], 0.0
            for runs in sizes:
                times = []
                for k in range(repeats):
                    begin = time.perf_counter()
                    subprocess.run([program, "ensemble", "run", str(plan), "--chunk", f"{k}/{RUNS // runs}", "--jobs", "1", "-o",
                                    f"{folder}/chunks"], check=True, capture_output=True)
                    times.append(time.perf_counter() - begin)
                shortest.append(min(times))
                spread = statistics.stdev(times) / statistics.mean(times) if repeats > 1 else 0.0
            # weighted by 1/time², so that each size counts for its part alike
            weights = [1 / t**2 for t in shortest]
            total = sum(weights)
            mean_r = sum(w * r for w, r in zip(weights, sizes)) / total
            mean_t = sum(w * t for w, t in zip(weights, shortest)) / total
            b = (sum(w * (r - mean_r) * (t - mean_t) for w, r, t in zip(weights, sizes, shortest)) /
                 sum(w * (r - mean_r)**2 for w, r in zip(weights, sizes)))
            a = max(0.0, mean_t - b * mean_r)
            found[name] = {"start": a, "chunk": 0.0, "run": b, "spread": spread}
    for name, times in found.items():
        times["chunk"] = c
        a, b = times["start"], times["run"]
        print(f"{name}: {1e3 * b:.3f} ms a run, {1e3 * c:.2f} ms a chunk, {1e3 * a:.1f} ms a process; beyond its runs a chunk of "
              f"1000 costs {100 * c / (1000 * b):.2f} % in a process that goes on (at most 5 %), {100 * a / (1000 * b):.2f} % as "
              "one of its own", file=sys.stderr)
    return found


def more_for_many(program: str, repeats: int) -> float:
    """What a chunk costs beyond its runs in a process that makes many: short runs in a chunk each, and in one [s]."""
    runs = 500
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "decay.toml").write_text('format = "oblique-diagram/1"\n[run]\nsamples = 2\n[blocks]\n'
                                           'x = { type = "integrator", in = ["-x"], initial = 1 }\n', encoding="utf-8")
        (folder / "plan.toml").write_text('format = "oblique-ensemble/1"\ndiagram = "decay.toml"\n[vary]\n'
                                          f'"x.initial" = "1..2:{runs}"\n', encoding="utf-8")
        took = {1: math.inf, runs: math.inf}
        for k in range(repeats):
            for chunks in took:
                begin = time.perf_counter()
                subprocess.run([program, "ensemble", "run", str(folder / "plan.toml"), "--chunks", str(chunks), "--jobs", "1",
                                "-o", str(folder / f"{chunks}-{k}")], check=True, capture_output=True)
                took[chunks] = min(took[chunks], time.perf_counter() - begin)
    return max(0.0, (took[runs] - took[1]) / (runs - 1))


def makespan(times: dict[str, float], size: int, cores: int, scheduler: tuple[float, float, bool], between: float,
             seed: int) -> tuple[float, float, int]:
    """Hours until all is done, core hours that were busy, chunks that were lost."""
    draw = random.Random(seed)
    each, beside, goes_on = scheduler
    duration = times["chunk" if goes_on else "start"] + size * times["run"] + beside
    waiting = deque([size] * (RUNS // size))
    nodes = max(1, cores // NODE)
    per_node = cores // nodes
    rate = 1 / (3600 * between)
    fails_at = [draw.expovariate(rate) for _ in range(nodes)]
    free = [(times["start"] if goes_on else 0.0, core % nodes) for core in range(per_node * nodes)]
    heapq.heapify(free)
    scheduler_free, end, busy, lost = 0.0, 0.0, 0.0, 0
    while waiting:
        now, node = heapq.heappop(free)
        while now >= fails_at[node] + AWAY:
            fails_at[node] += AWAY + draw.expovariate(rate)
        if now >= fails_at[node]:  # away
            heapq.heappush(free, (fails_at[node] + AWAY, node))
            continue
        begin = max(now, scheduler_free)
        scheduler_free = begin + each
        begin += each
        took = duration * max(0.1, draw.gauss(1, times["spread"]))
        if begin + took > fails_at[node]:  # lost, and given out again when that is known
            broken = max(begin, fails_at[node])
            busy += broken - begin
            lost += 1
            heapq.heappush(free, (fails_at[node] + AWAY, node))
            continue
        waiting.popleft()
        busy += took
        end = max(end, begin + took)
        heapq.heappush(free, (begin + took, node))
    return end / 3600, busy / 3600, lost


def lifetime(hours: float) -> str:
    if hours < 1 / 60:
        return f"{3600 * hours:.0f} s"
    return f"{60 * hours:.1f} min" if hours < 1 else f"{hours:.1f} h"


def simulate(found: dict[str, dict[str, float]]) -> None:
    """Tables in Markdown."""
    for name, times in found.items():
        ideal = RUNS * times["run"] / 3600
        print(f"{name}: {1e3 * times['run']:.3g} ms a run, {1e3 * times['chunk']:.2g} ms a chunk, {1e3 * times['start']:.3g} ms a "
              f"process; {RUNS} runs are {ideal:.3g} core hours")
        for between in BETWEEN_FAILURES:
            print(f"\nA node fails every {between:g} h:\n")
            heads = [f"{label}, {cores} cores" for label in SCHEDULERS for cores in CLUSTERS]
            print("| runs a chunk | " + " | ".join(heads) + " |\n|" + "---|" * (len(heads) + 1))
            for size in SIZES:
                cells = []
                for scheduler in SCHEDULERS.values():
                    for cores in CLUSTERS:
                        trials = [makespan(times, size, cores, scheduler, between, seed) for seed in range(TRIALS)]
                        hours = statistics.median(trial[0] for trial in trials)
                        lost = statistics.median(trial[2] for trial in trials)
                        cells.append(f"{lifetime(hours)}, {100 * min(1.0, ideal / (hours * cores)):.0f} %" +
                                     (f", {lost:.0f} lost" if lost else ""))
                print(f"| {size} | " + " | ".join(cells) + " |")
        print()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    timing = verbs.add_parser("measure", help="times chunks here, and prints JSON")
    timing.add_argument("--program", default=str(ROOT / "build/release/src/cli/oblique"))
    timing.add_argument("--repeats", type=int, default=3)
    timing.add_argument("--most", type=int, default=1000, help="runs of the longest chunk")
    simulation = verbs.add_parser("simulate", help="prints tables")
    simulation.add_argument("times", help="what `measure` printed; - for stdin")
    simulation.add_argument("--run", type=float, help="in place of the measured time of a run [s]")
    asked = parser.parse_args()
    if asked.verb == "measure":
        print(json.dumps(measure(asked.program, asked.repeats, asked.most), indent=1))
    else:
        text = sys.stdin.read() if asked.times == "-" else pathlib.Path(asked.times).read_text(encoding="utf-8")
        found = json.loads(text)
        if not all(math.isfinite(value) for times in found.values() for value in times.values()):
            sys.exit("these are no times")
        if asked.run is not None:
            found = {name: {**times, "run": asked.run} for name, times in found.items()}
        simulate(found)


if __name__ == "__main__":
    main()

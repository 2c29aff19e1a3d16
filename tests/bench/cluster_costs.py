#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What an ensemble costs on a cluster: chunks are timed here, and a cluster with failures is simulated from that.

    tests/bench/cluster_costs.py measure > times.json               # on a quiet machine
    tests/bench/cluster_costs.py measure --plan plan.toml …         # of a plan of one's own
    tests/bench/cluster_costs.py simulate times.json                # the tables of docs/ensembles.md, "A million runs"

A chunk of r runs takes a + b r as a process of its own: a for the start of the program, the reading, the patch, the first
run, from which the lanes are made; b a run. a is the processor's time of `oblique ensemble status`, which does all that and
runs nothing, b that of a chunk of 1000 runs without a, the shortest of several. In a process that goes on, as `oblique
ensemble run` for all chunks, or a worker of Dask, a chunk takes c + b r, and a is there once: c, until the file is on the
disk, comes from short runs of a diagram of one block, in one chunk and in many. `simulate` then gives chunks to cores as they
come free, through a scheduler that needs some time for each, and lets nodes fail at random: what ran there is lost and run
again, and the node is away for a while. A chunk's time is drawn from a normal distribution of the measured spread.
"""

from __future__ import annotations

import argparse
import heapq
import json
import math
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib
from collections import deque
from collections.abc import Sequence
from typing import IO

ROOT = pathlib.Path(__file__).resolve().parents[2]
# A mechanism each, and what else the plan says. A patch's own tolerance is 1e-10, finer than a scatter of 0.1 % asks for.
PLANS = {"Jansen's leg": ("jansen", ""), "Jansen's leg, tolerance 1e-6": ("jansen", "tolerance = 1e-6\n"), "four-bar": ("four-bar", "")}
RUNS = 1_000_000
# What a chunk costs beside its runs is held at so many of them, to such a part of them.
LEAST, MOST_BESIDE = 1000, 0.05
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


def measure(program: str, plans: dict[str, str], repeats: int, size: int) -> dict[str, dict[str, float]]:
    """a, b, c and the spread of each plan, by chunks of `size` runs that one core makes; all in seconds."""
    found = {}
    all_runs = [runs_of(text) for text in plans.values()]
    c = more_for_many(program, repeats)
    for (name, text), runs in zip(plans.items(), all_runs):
        with tempfile.TemporaryDirectory() as folder:
            plan = pathlib.Path(folder) / "plan.toml"
            plan.write_text(text, encoding="utf-8")
            (pathlib.Path(folder) / "none").mkdir()
            a = min(cpu([program, "ensemble", "status", plan, "-o", f"{folder}/none"], 1) for _ in range(3 * repeats))
            chunks = max(1, runs // size)
            taken = [cpu([program, "ensemble", "run", plan, "--chunk", f"{k % chunks}/{chunks}", "--jobs", "1", "-o",
                          f"{folder}/{k}"]) for k in range(repeats)]
            spread = statistics.stdev(taken) / statistics.mean(taken) if repeats > 1 else 0.0
            found[name] = {"start": a, "chunk": c, "run": max(0.0, min(taken) - a) * chunks / runs, "spread": spread}
    return found


def cpu(command: Sequence[object], status: int = 0) -> float:
    """The processor's time of a command [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != status:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr.decode()}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def runs_of(plan: str) -> int:
    """So many runs a plan has by its `runs`."""
    found = tomllib.loads(plan).get("runs")
    if not isinstance(found, int) or found < LEAST:
        sys.exit(f"a plan with at least {LEAST} runs is needed, and this one says runs = {found}")
    return found


def judge(found: dict[str, dict[str, float]], file: IO[str]) -> None:
    """Says what a chunk of 1000 runs costs beside them, and whether that is little enough."""
    for name, times in found.items():
        runs = LEAST * times["run"]
        print(f"{name}: {1e3 * times['run']:.3f} ms a run, {1e3 * times['chunk']:.2f} ms a chunk, {1e3 * times['start']:.1f} ms a "
              "process", file=file)
        for what, part in (("in a process that goes on", times["chunk"] / runs),
                           ("as a process of its own", (times["start"] + times["chunk"]) / runs)):
            print(f"  {'met' if part < MOST_BESIDE else 'MISSED'}: a chunk of {LEAST} runs {what} costs {100 * part:.2f} % beside them (less than "
                  f"{100 * MOST_BESIDE:.0f} %)", file=file)


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


def shipped(mechanism: str, more: str) -> str:
    return (f'format = "oblique-ensemble/1"\nmechanism = "{ROOT}/diagrams/mechanisms/{mechanism}.toml"\nruns = {RUNS}\n{more}'
            '[scatter]\ntolerance = "0.1%"\n[measure]\nworst = "error()"\n')


def plan_at(file: str) -> tuple[str, str]:
    """A name and the text of a plan, which may lie elsewhere."""
    path = pathlib.Path(file).resolve()
    text = path.read_text(encoding="utf-8")
    for key in ("diagram", "mechanism"):
        subject = tomllib.loads(text).get(key)
        if isinstance(subject, str):
            text = text.replace(f'"{subject}"', json.dumps(str(path.parent / subject)), 1)
    return path.stem, text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    timing = verbs.add_parser("measure", help="times chunks here, and prints JSON")
    timing.add_argument("--program", default=str(ROOT / "build/release/src/cli/oblique"))
    timing.add_argument("--plan", action="append", default=[], help="in place of Jansen's leg and the four-bar")
    timing.add_argument("--repeats", type=int, default=5)
    timing.add_argument("--size", type=int, default=LEAST, help="runs of a chunk that is timed")
    simulation = verbs.add_parser("simulate", help="prints tables")
    simulation.add_argument("times", help="what `measure` printed; - for stdin")
    simulation.add_argument("--run", type=float, help="in place of the measured time of a run [s]")
    asked = parser.parse_args()
    if asked.verb == "measure":
        plans = dict(map(plan_at, asked.plan)) or {name: shipped(*plan) for name, plan in PLANS.items()}
        found = measure(asked.program, plans, asked.repeats, asked.size)
        print(json.dumps(found, indent=1))
        judge(found, sys.stderr)
        return
    text = sys.stdin.read() if asked.times == "-" else pathlib.Path(asked.times).read_text(encoding="utf-8")
    found = json.loads(text)
    if not all(math.isfinite(value) for times in found.values() for value in times.values()):
        sys.exit("these are no times")
    if asked.run is not None:
        found = {name: {**times, "run": asked.run} for name, times in found.items()}
    simulate(found)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants small faults in the library and asks whether the tests catch them.

The faults (faults.py) stand in one build of a clone of the last commit, all asleep, and an environment variable lets
one loose. Every test runs once without any, which tells what it reaches; then, for each fault, the tests that reach it
run, those of its own stage first and the quick before the slow, until one fails. What cannot sleep is planted by itself. A
fault that no test catches has survived: either a test is missing, or the change means nothing, which is then said in
equivalent.toml with the reason.

The seed fixes which faults are planted. The results file gets a line as soon as a fault is judged, and a run that is
started again with the same files goes on where it was.
"""
import argparse
import hashlib
import json
import math
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue

sys.dont_write_bytecode = True  # nothing is left in the tree
from faults import mutants_of, with_faults  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MOST = 4096  # faults in one build, as in planted.cpp
MEMORY = 4 << 20  # [KiB] that a test may take, and
FILES = 1 << 20   # [KiB] that a file may become, so that a fault that runs away does not take the machine with it


def all_mutants(tree):
    for path in sorted((tree / "src").rglob("*")):
        # What the page asks of the engine is reached by the tests in a browser, where no fault can sleep.
        if path.suffix in (".cpp", ".h") and (tree / "src/studio") not in path.parents:
            yield from mutants_of(path.relative_to(tree).as_posix(), path.read_text())


def test_program_of(path):
    """The test program of a file's own stage."""
    parts = Path(path).parts
    return f"{parts[2] if parts[1] == 'oblique' and len(parts) > 3 else 'cli'}_test"


def run_test(command, folder, seconds, **environment):
    """Whether a test passes, in a folder of its own, within so many seconds of the processor (the machine may have more to
    do); None where it does not end at all."""
    for name in ("TMPDIR", "TEST_TMPDIR"):
        environment[name] = str(folder)
    # The seconds softly: a test may give what it starts a limit of its own, which is then not above a hard one.
    limits = f"ulimit -v {MEMORY} -f {FILES} -c 0; ulimit -S -t {math.ceil(seconds)}"
    limited = ["bash", "-c", f'{limits}; exec "$@"', "test", *command]
    # In a session of its own, so that what it starts ends with it.
    process = subprocess.Popen(limited, cwd=folder, env=os.environ | environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        return process.wait(30 * seconds) == 0
    except subprocess.TimeoutExpired:
        return None
    finally:
        try:
            os.killpg(process.pid, 9)
        except ProcessLookupError:
            pass
        process.wait()


class Scratch:
    """A clone of a commit with a build in which faults sleep."""

    def __init__(self, folder, commit, faults, workers):
        self.folder, self.build = folder, folder / "build/release"
        self.faults = dict(enumerate(faults, 1))
        self.folders = Queue()
        for worker in range(workers):
            self.folders.put(folder / f"build/worker{worker}")
        self.workers = workers
        self.asleep = {}  # file: {number: lines from and to}
        for number, fault in self.faults.items():
            self.asleep.setdefault(fault["file"], {})[number] = None
        self.sources = {path: self.git("show", f"{commit}:{path}", where=ROOT) for path in self.asleep}
        self.prepare(commit)
        # What an earlier run with the same faults learnt.
        self.notes = folder / "build/notes.json"
        key = hashlib.sha256(json.dumps([commit, faults], sort_keys=True).encode()).hexdigest()
        known = json.loads(self.notes.read_text()) if self.notes.exists() else {}
        known = known if known.get("key") == key else {"key": key}
        self.fit = set(known.get("fit", self.faults))
        self.build_asleep()
        known["fit"] = sorted(self.fit)
        self.tests = known.setdefault("tests", {})
        try:
            self.record_tests()
        finally:
            self.notes.write_text(json.dumps(known))

    def git(self, *arguments, where=None):
        return subprocess.run(["git", *arguments], cwd=where or self.folder, check=True, capture_output=True, text=True).stdout

    def prepare(self, commit):
        if not (self.folder / ".git").exists():
            self.folder.parent.mkdir(parents=True, exist_ok=True)
            self.git("clone", "-q", str(ROOT), str(self.folder), where=ROOT)
        if self.git("rev-parse", "HEAD").strip() != commit:
            self.git("fetch", "-q", str(ROOT), commit)
            self.git("checkout", "-q", "--force", "--detach", commit)
        # What stands there from an earlier run may stay, for what is written anew is built anew.
        for path in self.git("diff", "--name-only").splitlines():
            if path not in self.asleep:
                self.git("checkout", "-q", "--", path)
        marks = self.folder / "planted.o"
        subprocess.run(["c++", "-O2", "-fPIC", "-c", str(HERE / "planted.cpp"), "-o", str(marks)], check=True)
        subprocess.run(["cmake", "--preset", "release", "-DOBLIQUE_BUILD_BENCH=OFF", f"-DCMAKE_EXE_LINKER_FLAGS={marks}",
                        f"-DCMAKE_MODULE_LINKER_FLAGS={marks}"],
                       cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def write(self, path, text):
        if (self.folder / path).read_text() != text:
            (self.folder / path).write_text(text)

    def write_asleep(self, path):
        fit = {number: self.faults[number] for number in self.asleep[path] if number in self.fit}
        text, self.asleep[path] = with_faults(path, self.sources[path], fit)
        self.fit -= fit.keys() - self.asleep[path].keys()
        self.write(path, text)

    def ninja(self, *arguments):
        """Whether all is built, and what was said."""
        done = subprocess.run(["ninja", "-C", str(self.build), *arguments], capture_output=True, text=True)
        return done.returncode == 0, done.stdout

    def build_asleep(self):
        """Builds everything, without the faults that the compiler does not let sleep."""
        for path in self.asleep:
            self.write_asleep(path)
        while True:
            built, said = self.ninja("-k", "0")
            if built:
                return
            unfit = self.unfit(said, "error") or self.unfit(said, "[a-z ]+")
            if not unfit:
                sys.exit(f"the commit cannot be built:\n{said[-3000:]}")
            print(f"{len(unfit)} faults cannot sleep where they are", flush=True)
            self.fit -= unfit
            for path in {self.faults[number]["file"] for number in unfit}:
                self.write_asleep(path)

    def unfit(self, said, kind):
        """The faults on the lines that the compiler speaks of; where it speaks of none, those of the files."""
        # A compiler cache may have made the path one that begins in the folder of the build.
        places = re.findall(rf"^(?:\S*/)?(src/[\w./]+):(\d+):\d+:\s+{kind}", said, re.MULTILINE)
        on_line = {number for path, line in places for number, (first, last) in self.asleep.get(path, {}).items()
                   if first <= int(line) <= last}
        return on_line or {number for path, _ in places for number in self.asleep.get(path, {})}

    def test_commands(self):
        shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.build, capture_output=True, check=True)
        commands = {}
        for test in json.loads(shown.stdout)["tests"]:
            command = test["command"]
            if command[0].endswith("_test"):
                commands[test["name"]] = command
            elif "pytest" in command:  # the others look at the tree or build it anew
                properties = {one["name"]: one["value"] for one in test["properties"]}
                commands[test["name"]] = ["env", *properties["ENVIRONMENT"], *command]
        return commands

    def in_a_folder(self, work):
        """Does a piece of work in a folder that nobody else uses meanwhile."""
        folder = self.folders.get()
        try:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            return work(folder)
        finally:
            self.folders.put(folder)

    def record_tests(self):
        """What each test reaches without a fault, and how long it takes."""
        def record(name):
            def work(folder):
                marks = folder.with_suffix(".marks")
                marks.write_bytes(bytes(MOST))
                begin = time.monotonic()
                passes = run_test(self.commands[name], folder, 600, OBLIQUE_PLANTED_REACHED=str(marks))
                seconds = time.monotonic() - begin
                self.tests[name] = {"passes": passes, "seconds": round(seconds, 3),
                                    "reaches": [i for i, mark in enumerate(marks.read_bytes()) if mark]}
            self.in_a_folder(work)
        self.commands = self.test_commands()
        with ThreadPoolExecutor(self.workers) as pool:
            list(pool.map(record, [name for name in self.commands if name not in self.tests]))
        broken = [name for name in self.commands if not self.tests[name]["passes"]]
        if broken:
            print("these fail without any fault, and are left out:", *broken, sep="\n  ", flush=True)

    def ordered_tests(self, fault, names):
        """Those that pass without a fault, in the order in which they are asked."""
        own = test_program_of(fault["file"])
        return sorted((name for name in names if name in self.commands and self.tests[name]["passes"]),
                      key=lambda name: (Path(self.commands[name][0]).name != own, self.tests[name]["seconds"]))

    def ask(self, fault, names, **environment):
        """(outcome, the test that caught the fault) by these tests."""
        def work(folder):
            for name in self.ordered_tests(fault, names):
                limit = max(10, 10 * self.tests[name]["seconds"])
                passed = run_test(self.commands[name], folder, limit, **environment)
                if not passed:
                    return "killed", name + (" (time)" if passed is None else "")
            return "survived", ""
        return self.in_a_folder(work)

    def judge_asleep(self, number):
        names = [name for name, test in self.tests.items() if number in test["reaches"]]
        if not names:
            return "not reached", ""
        return self.ask(self.faults[number], names, OBLIQUE_PLANTED=str(number))

    def judge_alone(self, number):
        """Plants a fault that cannot sleep: nobody knows which tests reach it, so all are asked."""
        fault = self.faults[number]
        source = self.sources[fault["file"]]
        self.write(fault["file"], source[:fault["from"]] + fault["by"] + source[fault["to"]:])
        try:
            return self.ask(fault, self.tests) if self.ninja()[0] else ("does not compile", "")
        finally:
            self.write_asleep(fault["file"])


def judged_equivalent():
    with open(HERE / "equivalent.toml", "rb") as file:
        entries = tomllib.load(file).get("equivalent", [])
    return {(entry["file"], entry["before"], entry["after"]) for entry in entries}


def read_results(path, commit=None):
    """The results of earlier runs: outcomes by fault."""
    results = {}
    if path.exists():
        for text in path.read_text().splitlines():
            result = json.loads(text)
            if commit and result["commit"] != commit:
                sys.exit(f"{path}: this is of commit {result['commit'][:10]}, and the last one is {commit[:10]}\n"
                         "  remedy: name another file, or go back to that commit")
            results[key_of(result)] = result
    return results


def key_of(mutant):
    return mutant["file"], mutant["line"], mutant["column"], mutant["after"]


def summary(results):
    equivalent = judged_equivalent()
    counts = {"killed": 0, "survived": 0, "not reached": 0, "does not compile": 0, "equivalent": 0}
    for result in results:
        same = (result["file"], result["before"], result["after"]) in equivalent
        counts["equivalent" if same and result["outcome"] in ("survived", "not reached") else result["outcome"]] += 1
    change = counts["killed"] + counts["survived"] + counts["not reached"]
    caught = f"; {100 * counts['killed'] / change:.1f} % of those that change behaviour are caught" if change else ""
    return ", ".join(f"{number} {name}" for name, number in counts.items()) + caught


def stands_at(mutant, place):
    path, _, lines = place.partition(":")
    first, _, last = lines.partition("-")
    return mutant["file"].endswith(path) and (not lines or int(first) <= mutant["line"] <= int(last or first))


def chosen_mutants(options):
    mutants = list(all_mutants(ROOT))
    if options.again:
        survivors = {(r["file"], r["before"], r["after"]) for r in read_results(options.again).values()
                     if r["outcome"] in ("survived", "not reached")}
        return [m for m in mutants if (m["file"], m["before"], m["after"]) in survivors]
    if options.at:
        return [m for m in mutants if any(stands_at(m, place) for place in options.at)]
    random.Random(options.seed).shuffle(mutants)
    return mutants[:options.count]


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="faults to plant (default 100)")
    parser.add_argument("--seed", type=int, default=1, help="chooses them (default 1)")
    parser.add_argument("--at", metavar="FILE[:LINE[-LAST]]", action="append",
                        help="all faults of a file, or of lines of it, instead; more than once: of all of these")
    parser.add_argument("--again", type=Path, metavar="RESULTS", help="what survived there, instead")
    parser.add_argument("--list", action="store_true", help="print the faults and plant none")
    parser.add_argument("--results", type=Path, help="file of the results, a line a fault")
    parser.add_argument("--scratch", type=Path, help="folder of the clone; it stays, for the next time")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="faults that are judged at a time")
    options = parser.parse_args()
    if not options.list:
        for name, path in ("--results", options.results), ("--scratch", options.scratch):
            if path is None:
                parser.error(f"{name} is required")
            if path.resolve().is_relative_to(ROOT) and not path.resolve().is_relative_to(ROOT / "build"):
                parser.error(f"{name} {path}: this is inside the source tree; name a place outside it, or in build/")
    return options


def main():
    # Started in the background it may have been told to ignore the interrupt; the tests are to be reached by theirs.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    options = parse_options()
    mutants = chosen_mutants(options)
    if options.list:
        for m in mutants:
            print(f"{m['file']}:{m['line']}:{m['column']}\n  - {m['before']}\n  + {m['after']}")
        return
    if os.geteuid() == 0:  # a fault in what guards devices has replaced /dev/full by a file
        sys.exit("started by root, a fault may write and remove whatever there is\n  remedy: start it as another user")
    if len(mutants) >= MOST:
        sys.exit(f"{len(mutants)} faults are too many for one build, which holds {MOST - 1}")
    if subprocess.run(["git", "status", "--porcelain", "src"], cwd=ROOT, capture_output=True, check=True).stdout:
        sys.exit("src has changes that are not committed, and faults are planted in a clone of the last commit\n"
                 "  remedy: commit them first")
    commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, check=True, text=True).stdout.strip()
    results = read_results(options.results, commit)
    scratch = Scratch(options.scratch.resolve(), commit, mutants, options.workers)
    with open(options.results, "a") as file:
        def judge(judged, number):
            begin = time.monotonic()
            mutant = scratch.faults[number]
            outcome, test = judged(number)
            result = {**mutant, "outcome": outcome, "test": test, "seconds": round(time.monotonic() - begin, 1),
                      "seed": options.seed, "commit": commit}
            results[key_of(mutant)] = result
            print(json.dumps(result), file=file, flush=True)
            print(f"{outcome:16}  {mutant['file']}:{mutant['line']}  {test}\n  - {mutant['before']}\n  + {mutant['after']}",
                  flush=True)

        open_ones = [number for number, mutant in scratch.faults.items() if key_of(mutant) not in results]
        with ThreadPoolExecutor(options.workers) as pool:
            list(pool.map(lambda number: judge(scratch.judge_asleep, number), [n for n in open_ones if n in scratch.fit]))
        for number in open_ones:
            if number not in scratch.fit:
                judge(scratch.judge_alone, number)
    print(summary([results[key_of(mutant)] for mutant in mutants]))


if __name__ == "__main__":
    main()

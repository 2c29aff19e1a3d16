#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plants small faults in the library, one at a time, and asks whether the tests catch them.

A fault is an operator swapped, a constant changed, a sign turned, a condition negated, a statement taken out. Each is
planted in a scratch clone of the last commit; what it touches is built, and the tests of its stage run, then those of
the stages above it, until one fails. A fault that none catches has survived: either a test is missing, or the change
means nothing, which is then said in equivalent.toml with the reason.

The seed fixes which faults are planted. The results file gets a line as soon as a fault is judged, and a run that is
started again with the same file goes on where it was.
"""
import argparse
import json
import os
import random
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# The stages from below to above, each with those that it is made of.
STAGES = {
    "text": [],
    "diagram": ["text"],
    "network": ["diagram"],
    "solve": ["network"],
    "mechanism": ["text"],
    "patch": ["mechanism", "diagram"],
    "machine": ["solve"],
    "synthesis": ["mechanism"],
    "compare": ["solve", "patch", "machine"],
    "draw": ["mechanism", "diagram"],
    "cli": ["compare", "draw", "machine", "synthesis"],
}
# Test programs besides a stage's own, run after it.
MORE_TESTS = {"text": ["fuzz"], "solve": ["blocks", "diagrams"]}

# What is replaced, and by what. The tree is formatted: an operator of two operands stands between spaces.
SWAPS = [
    (r"(?<= )<(?= )", "<="), (r"(?<= )<=(?= )", "<"), (r"(?<= )>(?= )", ">="), (r"(?<= )>=(?= )", ">"),
    (r"(?<= )==(?= )", "!="), (r"(?<= )!=(?= )", "=="), (r"(?<= )&&(?= )", "||"), (r"(?<= )\|\|(?= )", "&&"),
    (r"(?<= )\+(?= )", "-"), (r"(?<= )-(?= )", "+"), (r"(?<= )\*(?= )", "/"), (r"(?<= )/(?= )", "*"),
    (r"(?<= )\+=(?= )", "-="), (r"(?<= )-=(?= )", "+="), (r"(?<= )\*=(?= )", "/="),
    (r"\bstd::min\b", "std::max"), (r"\bstd::max\b", "std::min"), (r"\bstd::sin\b", "std::cos"),
    (r"\bstd::cos\b", "std::sin"), (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"(?<=[(,=?:] )-(?=[A-Za-z0-9(])", ""), (r"(?<=\()-(?=[A-Za-z0-9(])", ""), (r"(?<=return )-(?=[A-Za-z0-9(])", ""),
    (r"(?<=[(!]|\s)!(?=[A-Za-z(])", ""), (r"\bcontinue;", "break;"), (r"\bbreak;", "continue;"),
]
NUMBER = re.compile(r"(?<![\w.'])(\d+)(\.\d+)?(e-?\d+)?(?![\w.'])")
CONDITION = re.compile(r"\b(if|while) \((?!const |auto )([^;]*)\)(?= \{$| [a-z].*;$)")
STATEMENT = re.compile(r"^ +[A-Za-z_][\w.:\[\]\->*()]*( [-+*/|&]?= .*|\(.*\));$")
# Lines whose change says nothing of behaviour, or that are no code.
LEFT_OUT = re.compile(r"^\s*(#|template|using |static_assert|friend |\}?\s*//)|\boperator\b|Diagnostic|fmt::format|"
                      r"\breserve\(|= default|= delete|static_cast<void>")


def hidden_text(source):
    """The source with its comments, texts and characters blanked, of the same length."""
    kept = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((.*?)\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Za-z])\'(?:\\.|[^\'\\\n])+\'',
                      re.DOTALL)
    return kept.sub(lambda m: re.sub(r"[^\n]", "\x01", m.group()), source)


def changed_number(match):
    whole, part, power = match.groups()
    if part is None and power is None:
        return str(int(whole) + 1)
    if float(match.group()) == 0:
        return "1" + (part or "")
    if power:
        return f"{whole}{part or ''}e{int(power[1:]) + 1}"
    return str(float(match.group()) * 2)


def changes_of(line, blank):
    """(column, end, replacement) of every small fault of a line."""
    for pattern, after in SWAPS:
        for match in re.finditer(pattern, blank):
            yield match.start(), match.end(), after
    for match in NUMBER.finditer(blank):
        yield match.start(), match.end(), changed_number(match)
    match = CONDITION.search(blank)
    if match and match.group(2).count("(") == match.group(2).count(")"):
        yield match.start(2), match.end(2), f"!({line[match.start(2):match.end(2)]})"


def mutants_of(path, source):
    """Every small fault of a file."""
    lines, blanks = source.split("\n"), hidden_text(source).split("\n")
    for number, (line, blank) in enumerate(zip(lines, blanks)):
        if LEFT_OUT.search(blank) or not blank.strip("\x01 "):
            continue
        found = [(line[:a] + after + line[b:], a) for a, b, after in changes_of(line, blank)]
        above = blanks[number - 1].rstrip("\x01 ") if number else ""
        if STATEMENT.match(blank) and above.endswith((";", "{", "}", ":")):
            found.append((line[:len(line) - len(line.lstrip())] + ";", 0))
        for after, column in found:
            yield {"file": path, "line": number + 1, "column": column + 1, "before": line.strip(), "after": after.strip()}


def all_mutants(tree):
    for path in sorted((tree / "src").rglob("*")):
        if path.suffix in (".cpp", ".h"):
            yield from mutants_of(path.relative_to(tree).as_posix(), path.read_text())


def stage_of(path):
    parts = Path(path).parts
    return parts[2] if parts[1] == "oblique" and len(parts) > 3 else "cli"


def stages_from(stage):
    """The stage and all that are made of it, from below to above; the program is the last."""
    reached = [stage]
    for name, parts in STAGES.items():
        if name not in reached and any(part in reached for part in parts):
            reached.append(name)
    return reached


def tests_for(path):
    tests = []
    for stage in stages_from(stage_of(path)):
        tests += [f"{name}_test" for name in [stage, *MORE_TESTS.get(stage, [])]]
    return tests


class Scratch:
    """A clone in which faults are planted."""

    def __init__(self, folder, timeout):
        self.folder, self.timeout = folder, timeout
        self.whole = set()  # test programs that were seen to pass without a fault

    def run(self, *command, timeout=None, **environment):
        """Whether a command ends well; None where it does not end in time."""
        # In a session of its own, so that what it starts ends with it.
        process = subprocess.Popen(command, cwd=self.folder, env=os.environ | environment, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            return process.wait(timeout) == 0
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
            return None

    def prepare(self, commit):
        if not (self.folder / ".git").exists():
            self.folder.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run(["git", "clone", "-q", str(ROOT), str(self.folder)], check=True)
        subprocess.run(["git", "fetch", "-q", str(ROOT), commit], cwd=self.folder, check=True)
        subprocess.run(["git", "checkout", "-q", "--force", "--detach", commit], cwd=self.folder, check=True)
        subprocess.run(["cmake", "--preset", "release", "-DOBLIQUE_BUILD_BENCH=OFF"], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)

    def build(self, target, **environment):
        return self.run("cmake", "--build", "--preset", "release", "--target", target, **environment)

    def passes(self, test):
        """Whether a test program that is built passes; None where it does not end in time."""
        return self.run(f"build/release/tests/{test}", "--gtest_brief=1", "--gtest_fail_fast", timeout=self.timeout)

    def check_whole(self, test):
        """A test program that fails without a fault tells nothing of faults."""
        if not self.build(test) or not self.passes(test):
            sys.exit(f"{test} cannot be built or fails without any fault")
        self.whole.add(test)

    def judge(self, mutant):
        """What becomes of a fault: (outcome, the test program that caught it)."""
        path = self.folder / mutant["file"]
        source = path.read_text()
        lines = source.split("\n")
        line = lines[mutant["line"] - 1]
        lines[mutant["line"] - 1] = line[:len(line) - len(line.lstrip())] + mutant["after"]
        planted = False
        try:
            for test in tests_for(mutant["file"]):
                if test not in self.whole:
                    path.write_text(source)
                    planted = False
                    self.check_whole(test)
                if not planted:  # what is written anew is built anew
                    path.write_text("\n".join(lines))
                    planted = True
                # Nobody asks the compiler's cache for it again.
                if not self.build(test, CCACHE_DISABLE="1"):
                    return "does not compile", ""
                passed = self.passes(test)
                if not passed:
                    return "killed", test + (" (time)" if passed is None else "")
            return "survived", ""
        finally:
            path.write_text(source)


def judged_equivalent():
    with open(Path(__file__).with_name("equivalent.toml"), "rb") as file:
        entries = tomllib.load(file).get("equivalent", [])
    return {(entry["file"], entry["before"], entry["after"]) for entry in entries}


def read_results(path, commit):
    """The results of earlier runs: outcomes by fault."""
    results = {}
    if path.exists():
        for text in path.read_text().splitlines():
            result = json.loads(text)
            if result["commit"] != commit:
                sys.exit(f"{path}: this is of commit {result['commit'][:10]}, and the last one is {commit[:10]}\n"
                         "  remedy: name another file, or go back to that commit")
            results[key_of(result)] = result
    return results


def key_of(mutant):
    return mutant["file"], mutant["line"], mutant["column"], mutant["after"]


def summary(results):
    equivalent = judged_equivalent()
    counts = {"killed": 0, "survived": 0, "does not compile": 0, "equivalent": 0}
    for result in results:
        same = (result["file"], result["before"], result["after"]) in equivalent
        counts["equivalent" if same and result["outcome"] == "survived" else result["outcome"]] += 1
    change = counts["killed"] + counts["survived"]
    caught = f"; {100 * counts['killed'] / change:.1f} % of those that change behaviour are caught" if change else ""
    return ", ".join(f"{number} {name}" for name, number in counts.items()) + caught


def chosen_mutants(options):
    mutants = list(all_mutants(ROOT))
    if options.at:
        path, _, line = options.at.partition(":")
        return [m for m in mutants if m["file"].endswith(path) and (not line or m["line"] == int(line))]
    random.Random(options.seed).shuffle(mutants)
    return mutants[:options.count]


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="faults to plant (default 100)")
    parser.add_argument("--seed", type=int, default=1, help="chooses them (default 1)")
    parser.add_argument("--at", metavar="FILE[:LINE]", help="all faults of a file, or of a line of it, instead")
    parser.add_argument("--list", action="store_true", help="print the faults and plant none")
    parser.add_argument("--results", type=Path, help="file of the results, a line a fault")
    parser.add_argument("--scratch", type=Path, help="folder of the clone; it stays, for the next time")
    parser.add_argument("--timeout", type=float, default=600, help="for one test program [s] (default 600)")
    options = parser.parse_args()
    if not options.list:
        for name, path in ("--results", options.results), ("--scratch", options.scratch):
            if path is None:
                parser.error(f"{name} is required")
            if path.resolve().is_relative_to(ROOT) and not path.resolve().is_relative_to(ROOT / "build"):
                parser.error(f"{name} {path}: this is inside the source tree; name a place outside it, or in build/")
    return options


def main():
    options = parse_options()
    mutants = chosen_mutants(options)
    if options.list:
        for m in mutants:
            print(f"{m['file']}:{m['line']}:{m['column']}\n  - {m['before']}\n  + {m['after']}")
        return
    if subprocess.run(["git", "status", "--porcelain", "src"], cwd=ROOT, capture_output=True, check=True).stdout:
        sys.exit("src has changes that are not committed, and faults are planted in a clone of the last commit\n"
                 "  remedy: commit them first")
    commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, check=True, text=True).stdout.strip()
    results = read_results(options.results, commit)
    scratch = Scratch(options.scratch.resolve(), options.timeout)
    scratch.prepare(commit)
    with open(options.results, "a") as file:
        for mutant in mutants:
            if key_of(mutant) in results:
                continue
            begin = time.monotonic()
            outcome, test = scratch.judge(mutant)
            result = {**mutant, "outcome": outcome, "test": test, "seconds": round(time.monotonic() - begin),
                      "seed": options.seed, "commit": commit}
            results[key_of(mutant)] = result
            file.write(json.dumps(result) + "\n")
            file.flush()
            print(f"{outcome:16}  {mutant['file']}:{mutant['line']}  {test}\n  - {mutant['before']}\n  + {mutant['after']}",
                  flush=True)
    chosen = {key_of(mutant) for mutant in mutants}
    print(summary([result for key, result in results.items() if key in chosen]))


if __name__ == "__main__":
    main()

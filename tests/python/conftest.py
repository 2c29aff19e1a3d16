# SPDX-License-Identifier: MIT
"""What the tests share: the tree, the program, and what a decay is."""

import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def in_the_tree(monkeypatch):
    """Paths such as diagrams/lessons/circle.toml are meant from the root of the tree."""
    monkeypatch.chdir(ROOT)


@pytest.fixture
def program():
    """Runs the command line, and gives what it has printed."""

    def run(*arguments):
        done = subprocess.run([os.environ["OBLIQUE_PROGRAM"], *map(str, arguments)], capture_output=True, text=True,
                              check=True, timeout=120)
        return done.stdout

    return run


DECAY = """format = "oblique-diagram/1"
title = "Decay"
[run]
until = 2
[blocks]
x = { type = "integrator", in = ["-x"], initial = 1 }
"""


@pytest.fixture
def decay():
    import oblique as ob
    return ob.Diagram(text=DECAY)

# SPDX-License-Identifier: MIT
"""The examples of docstrings and of the page are executed."""

import doctest
import importlib
import os
import pathlib

import pytest

from conftest import ROOT

FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
MODULES = sorted("oblique" if path.stem == "__init__" else f"oblique.{path.stem}"
                 for path in pathlib.Path(os.environ["OBLIQUE_PACKAGE"]).glob("*.py"))


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name):
    module = importlib.import_module(name)
    failed, _ = doctest.testmod(module, optionflags=FLAGS)
    assert failed == 0


def test_classes_have_examples():
    import oblique as ob
    for one in (ob.Diagram, ob.Mechanism, ob.Console, ob.Run, ob.Error, ob.BlockLibrary):
        assert ">>>" in one.__doc__, one


@pytest.mark.skipif(not (ROOT / "docs/python.md").exists(), reason="no page")
def test_page():
    failed, tried = doctest.testfile(str(ROOT / "docs/python.md"), module_relative=False, optionflags=FLAGS)
    assert failed == 0 and tried > 10

# SPDX-License-Identifier: MIT
"""The examples of docstrings and of the page are executed."""

import doctest
import importlib
import os
import pathlib
import re

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


def test_page():
    failed, tried = doctest.testfile(str(ROOT / "docs/python.md"), module_relative=False, optionflags=FLAGS)
    assert failed == 0 and tried > 10


def test_readme():
    """The diagram of the README: the side of its triangle at phi = pi, where the cosine is -1."""
    pytest.importorskip("matplotlib")
    (program,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    exec(compile(program, "README.md", "exec"), names)
    assert names["d"].run()["c"][500] == pytest.approx(0.7, abs=1e-5)  # 1/(2 gain), twice


def test_study_of_ten_lines(tmp_path, monkeypatch, capsys):
    """The program of the page that is shown whole: the study, whose figure stands beside it."""
    pytest.importorskip("matplotlib")
    page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len([line for line in program.splitlines() if line]) <= 10
    (tmp_path / "diagrams").symlink_to(ROOT / "diagrams")
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(program, "docs/python.md", "exec"), names)
    assert names["study"].order == pytest.approx(-1, abs=1e-3)  # the method
    assert "order -1.000" in capsys.readouterr().out.replace("-0.9998", "-1.000")
    assert "order -1.000" in (ROOT / "docs/pictures/class-three-order.svg").read_text(encoding="utf-8")
    assert (tmp_path / "class-three-order.svg").stat().st_size > 1000

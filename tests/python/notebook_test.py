# SPDX-License-Identifier: MIT
"""The notebooks: without outputs, and each cell runs. A namespace stands for the kernel, which would bring a hundred packages."""

import ast
import json
import os

import pytest

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))
PICTURES = os.environ.get("OBLIQUE_PICTURES")


def shown(value):
    """As a notebook would show the last value of a cell."""
    if value is None:
        return ""
    for name in ("_repr_html_", "_repr_svg_"):
        if hasattr(value, name):
            text = getattr(value, name)()
            if text:
                return text
    return repr(value)


def run_cell(source, names, file):
    """Runs a cell, and gives its last value."""
    tree = ast.parse(source, file)
    last = None
    if tree.body and isinstance(tree.body[-1], ast.Expr) and not source.rstrip().endswith(";"):
        last = ast.Expression(tree.body.pop().value)
    exec(compile(tree, file, "exec"), names)
    return eval(compile(last, file, "eval"), names) if last is not None else None


def test_there_are_four():
    assert [path.stem for path in NOTEBOOKS] == ["class-three", "jansen-on-tr-10", "one-triangle", "unstable-servo"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs(path, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(path.parent)
    page = json.loads(path.read_text(encoding="utf-8"))
    assert page["nbformat"] == 4 and page["metadata"]["license"] == "SPDX-License-Identifier: MIT"
    names = {"__name__": "__main__"}
    for number, cell in enumerate(page["cells"]):
        if cell["cell_type"] != "code":
            continue
        assert cell["outputs"] == [] and cell["execution_count"] is None, "notebooks are kept without outputs"
        text = shown(run_cell("".join(cell["source"]), names, f"{path.name}, cell {number}"))
        if PICTURES:  # to be looked at
            for place, figure in enumerate(map(pyplot.figure, pyplot.get_fignums())):
                figure.savefig(f"{PICTURES}/{path.stem}-{number}-{place}.png")
            if "<" in text:
                with open(f"{PICTURES}/{path.stem}-{number}.html", "w", encoding="utf-8") as file:
                    file.write(text)
        pyplot.close("all")

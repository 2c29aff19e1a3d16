# SPDX-License-Identifier: MIT
"""Type hints and docstrings: complete, and true to what there is."""

import ast
import inspect
import os
import pathlib
import subprocess
import sys

import oblique as ob
from oblique import _oblique

from conftest import ROOT

PACKAGE = pathlib.Path(os.environ["OBLIQUE_PACKAGE"])

USER = '''
import oblique as ob

study = ob.Mechanism("leg.toml").compare(gains=[1e3, 1e4])
order: float = study.order or 0.0
run: ob.Run = ob.Diagram("side.toml").run(1, set={"c.gain": 1e4, "lag.time_constant": "20 ms"})
top: float = float(run["side"].max())
d = ob.Diagram(title="Built", until=1)
x: ob.Signal = d.integrator(initial=1)
x.input = -0.5 * x
with ob.Console(d) as machine:
    machine["x.rate"] = 3
    value: float = machine["x"]
'''


def test_types_of_the_package_and_for_its_users(tmp_path):
    # In one go, for most of the time goes into what NumPy declares; what may be missing is taken as missing.
    settings, right, wrong = tmp_path / "mypy.ini", tmp_path / "right.py", tmp_path / "wrong.py"
    settings.write_text("[mypy]\nstrict = True\nignore_missing_imports = True\n"
                        "[mypy-distributed.*,xarray.*]\nfollow_imports = skip\n", encoding="utf-8")
    right.write_text(USER, encoding="utf-8")
    wrong.write_text(USER + "n: int = study.order\nob.Diagram(until=[1])\n", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", str(settings), "--cache-dir", os.devnull, str(PACKAGE),
         str(right), str(wrong)],
        capture_output=True, text=True, check=False, cwd=PACKAGE.parent,
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})
    errors = [line for line in done.stdout.splitlines() if "error:" in line]
    assert len(errors) == 2 and all("wrong.py" in line for line in errors), done.stdout + done.stderr


def test_the_stub_knows_what_is_compiled():
    stub = ast.parse((PACKAGE / "_oblique.pyi").read_text(encoding="utf-8"))
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    for name, kind in inspect.getmembers(_oblique, inspect.isclass):
        members = {node.name for node in classes[name].body if isinstance(node, ast.FunctionDef)}
        assert {one for one in vars(kind) if not one.startswith("_")} == members - {"__init__"}, name
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert {name for name, _ in inspect.getmembers(_oblique, inspect.isbuiltin)} == functions


def test_all_that_is_public_is_described():
    for name in ob.__all__:
        one = getattr(ob, name)
        if not inspect.isclass(one):
            continue
        assert inspect.getdoc(one), name
        for member, function in vars(one).items():
            if not member.startswith("_") and (inspect.isfunction(function) or isinstance(function, property)):
                assert inspect.getdoc(function), f"{name}.{member}"


def test_files_have_a_licence():
    for path in [*(ROOT / "src/python").rglob("*.py*"), *(ROOT / "tests/python").glob("*.py")]:
        if path.suffix in (".py", ".pyi"):
            assert path.read_text(encoding="utf-8").startswith("# SPDX-License-Identifier: MIT\n"), path

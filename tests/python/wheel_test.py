# SPDX-License-Identifier: MIT
"""The wheel of `pip install .`: what is in it, and that it works away from the tree."""

import base64
import hashlib
import os
import pathlib
import subprocess
import sys
import zipfile

from conftest import ROOT


def test_works_where_it_is_unpacked(tmp_path):
    folder = pathlib.Path(os.environ["OBLIQUE_PACKAGE"]).parents[2]
    builder = (f"import sys; sys.path.insert(0, {str(ROOT / 'src/python')!r}); import wheel_builder; "
               f"print(wheel_builder.build_wheel({str(tmp_path)!r}, {{'build-folder': {str(folder)!r}}}))")
    name = subprocess.run([sys.executable, "-c", builder], check=True, capture_output=True, text=True).stdout.strip()
    with zipfile.ZipFile(tmp_path / name) as wheel:
        wheel.extractall(tmp_path / "site")
        record = wheel.read("oblique-0.1.0.dist-info/RECORD").decode().splitlines()
        assert {line.split(",")[0] for line in record} == set(wheel.namelist())
        for line in record[:-1]:
            path, digest, size = line.rsplit(",", 2)
            content = wheel.read(path)
            assert len(content) == int(size)
            expected = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            assert digest == f"sha256={expected}"
    done = subprocess.run(
        [sys.executable, "-c", "import oblique; print(oblique.__file__); print(oblique.blocks['integrator'].name)"],
        check=True, capture_output=True, text=True, cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")}).stdout.splitlines()
    assert done == [str(tmp_path / "site/oblique/__init__.py"), "integrator"]


def test_has_every_file_of_the_package():
    sources = {path.name for path in (ROOT / "src/python/oblique").iterdir() if path.is_file()}
    built = {path.name for path in pathlib.Path(os.environ["OBLIQUE_PACKAGE"]).iterdir()}
    assert sources <= built

# SPDX-License-Identifier: MIT
"""Builds the wheel for `pip install .` by CMake (PEP 517), with nothing but Python's own library.

The compiler, CMake, Ninja and the libraries are those of ./bootstrap. The build is kept in build/pip;
`--config-settings=build-folder=build/release` packs what ./bootstrap has built there.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from typing import Any, Optional

ROOT = pathlib.Path(__file__).resolve().parents[2]


def _version() -> str:
    found = re.search(r"project\(oblique VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    if found is None:
        raise RuntimeError("CMakeLists.txt names no version")
    return found.group(1)


def _metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: oblique\nVersion: {_version()}\n"
            "Summary: An analog computer in software\nLicense: MIT\nRequires-Python: >=3.11\nRequires-Dist: numpy>=1.24\n"
            "Description-Content-Type: text/markdown\n\n" + (ROOT / "docs/python.md").read_text(encoding="utf-8"))


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _solver() -> list[str]:
    """The optimised SUNDIALS that ./bootstrap has compiled, if it is there."""
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "oblique"
    found = sorted(cache.glob("sundials-*/lib/cmake/sundials"))
    return [f"-DSUNDIALS_DIR={found[-1]}"] if found else []


def _built(folder: pathlib.Path) -> pathlib.Path:
    """The folder of the package, built."""
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        raise RuntimeError("there is no cmake or no ninja; on Debian ./bootstrap python installs all that is needed")
    subprocess.run(["cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DOBLIQUE_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}", "-DOBLIQUE_BUILD_TESTS=OFF",
                    "-DOBLIQUE_BUILD_BENCH=OFF", *_solver()], check=True)
    subprocess.run(["cmake", "--build", str(folder), "--target", "oblique_python_modules"], check=True)
    return folder / "src/python/oblique"


def build_wheel(wheel_directory: str, config_settings: Optional[dict[str, Any]] = None,
                metadata_directory: Optional[str] = None) -> str:
    """Writes the wheel and gives its name."""
    chosen = (config_settings or {}).get("build-folder")
    package = ROOT / chosen / "src/python/oblique" if chosen else _built(ROOT / "build/pip")
    parts = [part for part in sorted(package.iterdir()) if part.suffix in (".py", ".pyi", ".so", ".typed")]
    if not any(part.suffix == ".so" for part in parts):
        raise RuntimeError(f"{package}: nothing is built here")
    info = f"oblique-{_version()}.dist-info"
    files = {f"oblique/{part.name}": part.read_bytes() for part in parts}
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: oblique\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = "".join(
        f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},{len(content)}\n"
        for name, content in files.items()) + f"{info}/RECORD,,\n"
    files[f"{info}/RECORD"] = record.encode()
    wheel = f"oblique-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel

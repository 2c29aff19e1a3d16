# SPDX-License-Identifier: MIT
"""Pictures that a notebook shows by itself."""

from __future__ import annotations

import html
import shutil
import subprocess
from typing import Optional

from . import _arguments, _oblique
from ._arguments import PathLike
from ._errors import RequestError


class Picture:
    """A drawing as SVG. A notebook shows it; `save` writes it.

    >>> import oblique as ob
    >>> picture = ob.Diagram("diagrams/lessons/triangle-side.toml").draw()
    >>> picture.svg[:4]
    '<svg'
    """

    def __init__(self, svg: str, remark: str = "") -> None:
        self.svg = svg
        """The text of the picture."""
        self.remark = remark
        """What the reader of it should know, or nothing."""

    def save(self, path: PathLike) -> None:
        """Writes an .svg, or a .png where rsvg-convert (Debian's librsvg2-bin) is installed."""
        name = _arguments.path("path", path)
        if name.endswith(".svg"):
            _oblique.write_file(name, self.svg)
            return
        if not name.endswith(".png"):
            raise RequestError(f"a picture cannot be written to {name!r}", "a name that ends in .svg or .png")
        converter = shutil.which("rsvg-convert")
        if converter is None:
            raise RequestError("a PNG is made by rsvg-convert, which is not installed",
                               remedy="install the Debian package librsvg2-bin, or write an .svg")
        done = subprocess.run([converter, "-o", name], input=self.svg.encode(), capture_output=True, check=False)
        if done.returncode != 0:
            raise RequestError(f"{name} cannot be written: {done.stderr.decode(errors='replace').strip()}")

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: SVG of {len(self.svg)} characters>"


class Animation(Picture):
    """A mechanism that moves: as SVG by itself, as a page with a slider and a button."""

    def __init__(self, svg: str, page: str, remark: str = "") -> None:
        super().__init__(svg, remark)
        self.html = page
        """The page, in one file."""

    def save(self, path: PathLike) -> None:
        """Writes an .svg or an .html. (A .gif is written by the program: `oblique animate`.)"""
        name = _arguments.path("path", path)
        if name.endswith(".svg"):
            _oblique.write_file(name, self.svg)
        elif name.endswith(".html"):
            _oblique.write_file(name, self.html)
        else:
            raise RequestError(f"an animation cannot be written to {name!r}", "a name that ends in .svg or .html",
                               "the program writes a .gif: oblique animate" if name.endswith(".gif") else "")

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.html, quote=True)}" width="100%" height="640" '
                'style="border: 0"></iframe>')

    def _repr_svg_(self) -> Optional[str]:  # type: ignore[override]  # a notebook takes the page
        return None


class Page:
    """A report: one HTML page, for a notebook or a file."""

    def __init__(self, page: str) -> None:
        self.html = page

    def save(self, path: PathLike) -> None:
        """Writes an .html."""
        name = _arguments.path("path", path)
        if not name.endswith(".html"):
            raise RequestError(f"a report cannot be written to {name!r}", "a name that ends in .html")
        _oblique.write_file(name, self.html)

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.html, quote=True)}" width="100%" height="720" '
                'style="border: 0"></iframe>')

    def __repr__(self) -> str:
        return f"<Page: HTML of {len(self.html)} characters>"

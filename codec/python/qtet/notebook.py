"""The viewer in a notebook's cell: qtet.show."""
from __future__ import annotations

import html
import os
import pathlib
import tempfile
import urllib.parse
from typing import Any, Sequence

from . import tool
from .hosting import log_of
from .sources import check_readable, log_url

__all__ = ["Shown", "page", "show"]

# Notebooks are files that people mail and commit: a cell holds at most so much.
_MAX_BYTES = 5_000_000
_HEIGHT_PX = 560


class Shown:
    """What a cell shows: the page in a frame. The notebook keeps it, so that it is there without a
    kernel, and after it was saved, sent or exported.

    page    the HTML of the frame
    told    how many bytes it has, and what of the mesh it holds"""

    def __init__(self, page: str, told: str, height: int):
        self.page, self.told, self._height = page, told, height

    def _repr_html_(self) -> str:
        # The frame's page has no address: its scripts, workers and data are within.
        return (
            f'<iframe srcdoc="{html.escape(self.page)}" title="{html.escape(self.told)}" '
            f'style="width: 100%; height: {self._height}px; border: 0" allowfullscreen></iframe>'
        )

    def __repr__(self) -> str:
        return f"<qtet.Shown {self.told}>"


def page(
    source: Any,
    path: str | os.PathLike[str],
    *,
    times: Sequence[float] | None = None,
    max_bytes: int | None = None,
    **view: Any,
) -> str:
    """Writes one HTML file with the viewer and the mesh, which opens from a disk (`qtet page`).
    Returns what was said: its bytes, and the error that is left where it was cut.

    source     a log's or a mesh file's path, a log's URL, its bytes or an open Log, a grid as
               simplify() takes it, or a list of grids
    times      of the grids in a list
    max_bytes  cuts the log so that the file is no larger
    view       what is shown, as in the viewer's address: field="Heat", clip="x:0.5", ...

    Raises QtetError, and OSError for a file that cannot be opened."""
    with tempfile.TemporaryDirectory(prefix="qtet-") as folder:
        # The tool itself makes a log of a file.
        if isinstance(source, (str, os.PathLike)) and log_url(source) is None:
            check_readable(source)
        else:
            source = log_of(source, pathlib.Path(folder), times=times)
        words = ["page", source, "-o", path]
        if max_bytes is not None:
            words += ["--max-bytes", str(max_bytes)]
        if view:
            words += ["--view", urllib.parse.urlencode(view)]
        return (tool.run(words) or "").strip()


def show(
    source: Any,
    *,
    times: Sequence[float] | None = None,
    height: int = _HEIGHT_PX,
    max_bytes: int = _MAX_BYTES,
    **view: Any,
) -> Shown:
    """The viewer in a notebook's cell, with the mesh in it: for the last line of a cell. Arguments
    as those of page(); `height` in pixels."""
    if not height >= 1:
        raise ValueError(f"the height is {height}; give pixels, 1 or more")
    with tempfile.TemporaryDirectory(prefix="qtet-") as folder:
        path = pathlib.Path(folder) / "cell.html"
        told = page(source, path, times=times, max_bytes=max_bytes, **view)
        said = told.split(": ", 1)[-1]
        return Shown(path.read_text("utf-8"), said, height)

"""qtet logs of tetrahedral meshes: made of numpy arrays and of grids, opened, and shown in a browser.

    import qtet
    log = qtet.simplify(points, cells, point_data={"Heat": heat}, target_ratio=0.02)  # bytes
    log = qtet.simplify(grid)  # of PyVista, VTK or meshio
    with qtet.open("part.qtet") as log:  # or a URL, or bytes
        log.refine(0)
        print(log.counts())
    qtet.view("part.vtu")  # in the browser of this machine
    qtet.show(grid, field="Heat")  # in a notebook's cell

Opening needs libqtet.so alone, simplify numpy as well, and qtet.vtk VTK's Python modules."""
from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING, Any

from .library import QtetError, version
from .log import Log

if TYPE_CHECKING:
    from .hosting import serve, view
    from .notebook import page, show
    from .simplifier import Cancelled, simplify

__all__ = ["Cancelled", "Log", "QtetError", "open", "page", "serve", "show", "simplify", "view"]


def open(source: str | os.PathLike[str] | bytes | bytearray | memoryview) -> Log:
    """The log in a file, in bytes or behind a URL (Log); with `with` it is closed again."""
    return Log(source)


# numpy and the rest are imported once they are needed.
_MODULES = {
    "Cancelled": "simplifier",
    "page": "notebook",
    "serve": "hosting",
    "show": "notebook",
    "simplify": "simplifier",
    "view": "hosting",
}


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__")), "__version__"})


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return getattr(importlib.import_module(f".{_MODULES[name]}", __name__), name)
    if name == "__version__":
        return version()
    raise AttributeError(f"module 'qtet' has no attribute {name!r}")

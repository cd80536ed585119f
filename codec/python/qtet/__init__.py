"""qtet logs of tetrahedral meshes: made of numpy arrays, opened from files and URLs.

    import qtet
    log = qtet.simplify(points, cells, point_data={"Heat": heat}, target_ratio=0.02)  # bytes
    with qtet.open("part.qtet") as log:  # or a URL
        log.refine(0)
        print(log.counts())

Opening needs libqtet.so alone, simplify numpy as well, and qtet.vtk VTK's Python modules."""
from .log import Log, QtetError, version

__all__ = ["Cancelled", "Log", "QtetError", "open", "simplify"]


def open(source):
    """The log in a file or behind a URL (Log); with `with` it is closed again."""
    return Log(source)


def __getattr__(name):
    """numpy is imported once it is needed."""
    if name in ("simplify", "Cancelled"):
        from . import simplifier

        return getattr(simplifier, name)
    if name == "__version__":
        return version()
    raise AttributeError(f"module 'qtet' has no attribute {name!r}")

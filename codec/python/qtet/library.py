"""libqtet.so: where it is, and what its structs say (codec/api/qtet.h). In Pyodide a WebAssembly
module takes its place (wasm.py)."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import pathlib
from dataclasses import dataclass, field
from typing import Any, Protocol

_u32, _u64, _f64, _address = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_double, ctypes.c_void_p
POINT, CELL = 0, 1
OUT_OF_MEMORY = 103


class QtetError(RuntimeError):
    """What went wrong, where, and what to do, in the words of the library."""


class _Text(ctypes.c_void_p):
    """The address of a text in the library's memory."""


class Library(Protocol):
    """The functions of libqtet.so by their C names, and access to its memory. Addresses are int."""

    calls_back: bool  # whether C can call Python

    def text_at(self, address: int) -> str:
        """A text that ends in NUL."""

    def bytes_at(self, address: int, size: int) -> bytes:
        """A copy."""

    def place(self, data: Any) -> int:
        """The address of what a packed array of numpy or an object of ctypes holds. The caller
        keeps the object until release(), and does not change it."""

    def release(self, address: int) -> None:
        """Gives a place back."""

    def __getattr__(self, name: str) -> Any:
        """A function of C."""


class CLogInfo(ctypes.Structure):
    _fields_ = [
        ("versionMajor", _u32),
        ("versionMinor", _u32),
        ("bytes", _u64),
        ("chunks", _u32),
        ("levels", _u32),
        ("fields", _u32),
        ("latticeBits", _u32),
        ("latticeStep", _f64),
        ("latticeOrigin", _f64 * 3),
        ("digest", _Text),
        ("source", _Text),
        ("generator", _Text),
        ("timeUnit", _Text),
    ]


class CFieldInfo(ctypes.Structure):
    _fields_ = [
        ("components", _u32),
        ("association", _u32),
        ("bits", _u32),
        ("reserved", _u32),
        ("step", _f64),
        ("minimum", _f64 * 16),
        ("range", _f64 * 2),
        ("bytes", _u64),
        ("name", _Text),
        ("type", _Text),
        ("unit", _Text),
        ("labels", _Text),
        ("largestRoundingError", _f64),
    ]


class CLevelInfo(ctypes.Structure):
    _fields_ = [
        ("tetrahedra", _u32),
        ("vertices", _u32),
        ("boundaryTriangles", _u32),
        ("hasError", _u32),
        ("prefixBytes", _u64),
        ("boundaryDistance", _f64),
        ("toLevelMean", _f64),
        ("toLevelMax", _f64),
        ("toOriginalMean", _f64),
        ("toOriginalMax", _f64),
        ("volumeKept", _f64),
        ("volumeLost", _f64),
        ("volumeGained", _f64),
    ]


class CSeriesInfo(ctypes.Structure):
    _fields_ = [("association", _u32), ("instants", _u32), ("name", _Text)]


# Copies in Python's own types, with the members of qtet.h: they outlive their log.
@dataclass(frozen=True)
class LogInfo:
    versionMajor: int
    versionMinor: int
    bytes: int
    chunks: int
    levels: int
    fields: int
    latticeBits: int
    latticeStep: float
    latticeOrigin: tuple[float, ...]
    digest: str
    source: str
    generator: str
    timeUnit: str  # "" where it is unknown


@dataclass(frozen=True)
class FieldInfo:
    components: int
    association: int
    bits: int
    step: float
    minimum: tuple[float, ...]  # of each component
    range: tuple[float, ...]  # the least and the largest
    bytes: int
    name: str
    type: str
    unit: str  # "" where it is unknown
    # names of values, as far as known; None: the field is no label
    labels: dict[int, str] | None = field(hash=False)
    # the most that a value of the last level may differ from the input's; 0: none does
    largestRoundingError: float


@dataclass(frozen=True)
class LevelInfo:
    tetrahedra: int
    vertices: int
    boundaryTriangles: int
    hasError: bool
    prefixBytes: int
    boundaryDistance: float
    toLevelMean: float
    toLevelMax: float
    toOriginalMean: float
    toOriginalMax: float
    volumeKept: float
    volumeLost: float
    volumeGained: float


def _plain(c: Library, value: Any) -> Any:
    """A member of a struct without the library's memory."""
    if isinstance(value, _Text):
        return c.text_at(value.value or 0)
    return tuple(value) if isinstance(value, ctypes.Array) else value


def members_of(c: Library, struct: ctypes.Structure) -> dict[str, Any]:
    names = (entry[0] for entry in struct._fields_)
    return {name: _plain(c, getattr(struct, name)) for name in names if name != "reserved"}


class _SharedLibrary(ctypes.CDLL):
    """libqtet.so itself, as a Library."""

    calls_back = True

    def text_at(self, address: int) -> str:
        return ctypes.string_at(address).decode(errors="replace")

    def bytes_at(self, address: int, size: int) -> bytes:
        return ctypes.string_at(address, size)

    def place(self, data: Any) -> int:
        return int(data.ctypes.data) if hasattr(data, "ctypes") else ctypes.addressof(data)

    def release(self, address: int) -> None:
        pass


def _candidates() -> list[str]:
    """Where libqtet.so may be: QTET_LIBRARY, in this folder, beside an installed copy of it, where
    the system's linker looks."""
    if os.environ.get("QTET_LIBRARY"):
        return [os.environ["QTET_LIBRARY"]]
    here = pathlib.Path(__file__).resolve().parent
    installed = [str(found) for found in here.glob("libqtet.so")] + [
        str(found)
        for up in list(here.parents)[:4]
        for below in ("lib", "lib64", "lib/*-linux-gnu")
        for found in up.glob(below + "/libqtet.so.0")
    ]
    return [*installed, "libqtet.so.0", ctypes.util.find_library("qtet") or "libqtet.so"]


def _shared_library() -> _SharedLibrary:
    tried = []
    for name in _candidates():
        try:
            c = _SharedLibrary(name)
        except OSError as error:
            tried.append(str(error))
            continue
        for function, result in (
            ("create", _address),
            ("error", _address),
            ("tetrahedra", _address),
            ("boundary", _address),
            ("lattice_points", _address),
            ("field_count", ctypes.c_size_t),
            ("series_count", _u32),
            ("level", _u32),
        ):
            if not hasattr(c, "qtet_log_" + function):
                raise QtetError(
                    f"{name} is older than this module: it has no qtet_log_{function}; "
                    "install the same version of both"
                )
            getattr(c, "qtet_log_" + function).restype = result
        for function in ("version_text", "simplified_create", "simplified_error", "simplified_log"):
            if hasattr(c, "qtet_" + function):
                getattr(c, "qtet_" + function).restype = _address
        return c
    raise QtetError(
        "libqtet.so is not found ("
        + "; ".join(tried)
        + "); install libqtet0, or set QTET_LIBRARY to its path"
    )


_loaded: Library | None = None


def library() -> Library:
    """libqtet.so, loaded once; in Pyodide the module."""
    global _loaded
    from . import wasm

    if wasm.IS_HERE:
        if not isinstance(_loaded, wasm.WasmLibrary) or _loaded.is_broken:
            _loaded = wasm.WasmLibrary()
    elif _loaded is None:
        _loaded = _shared_library()
    return _loaded


def version() -> str:
    """That of libqtet.so: "0.4.0"."""
    c = library()
    return c.text_at(c.qtet_version_text())

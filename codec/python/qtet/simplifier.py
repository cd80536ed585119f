"""qtet.simplify: logs made of numpy arrays (simplify/api/qtet_simplify.h). The same mesh and options
give the same bytes as the program `qtet simplify`."""
from __future__ import annotations

import ctypes
import os
import pathlib
import re
import tempfile
import threading
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

import numpy

from . import tool
from .grids import Grid, grid_of, mesh_array, packed_array, series_of
from .library import OUT_OF_MEMORY, Library, QtetError, library
from .sources import check_output

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Cancelled", "simplify"]

_u32, _u64, _f64, _address = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_double, ctypes.c_void_p
_POINT, _CELL = 0, 1
_CANCELLED = 12
_TYPES = {
    "float32": 1,
    "float64": 2,
    "int8": 3,
    "int16": 4,
    "int32": 5,
    "int64": 6,
    "uint8": 7,
    "uint16": 8,
    "uint32": 9,
    "uint64": 10,
}
_ALGORITHMS = {"qtet": 0, "paper": 1}
_PLACEMENTS = {"auto": 0, "optimal": 1, "vertex": 2}
_MEASURES = {"none": 0, "levels": 1, "all": 2}
_CODECS = {"lifted": 0, "draco": 1, "adaptive": 2}
_STAGES = ("clean", "quantise", "simplify", "measure", "encode", "keep", "reduce")
_MAX_COMPONENTS = 16
_INTEGERS = ("base_cells", "position_bits", "field_bits", "threads")
# A number, and what it is in.
_BOUND = re.compile(r"((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?) *(.*)", re.DOTALL)
# Between two checks of the progress and of Ctrl-C.
_INTERVAL_S = 0.1


class Cancelled(QtetError):
    """The progress callback asked to stop."""


class _Field(ctypes.Structure):
    _fields_ = [
        ("name", _address),
        ("association", _u32),
        ("type", _u32),
        ("components", _u32),
        ("baseCells", _u32),
        ("values", _address),
    ]


class _Mesh(ctypes.Structure):
    _fields_ = [
        ("points", _address),
        ("pointCount", _u64),
        ("tetrahedra", _address),
        ("tetrahedronCount", _u64),
        ("pointType", _u32),
        ("idType", _u32),
        ("fields", _address),
        ("fieldCount", _u32),
        ("fieldBytes", _u32),
    ]


class _NamedNumber(ctypes.Structure):
    _fields_ = [("name", _address), ("value", _f64)]


class _ErrorBound(ctypes.Structure):
    _fields_ = [("name", _address), ("value", _f64), ("unit", _address)]


_Progress = ctypes.CFUNCTYPE(ctypes.c_int, _address, _u32, _f64)


class _Options(ctypes.Structure):
    _fields_ = [
        ("targetRatio", _f64),
        ("boundaryWeight", _f64),
        ("shapeWeight", _f64),
        ("envelopeTolerance", _f64),
        ("positionBits", _u32),
        ("fieldBits", _u32),
        ("algorithm", _u32),
        ("placement", _u32),
        ("measure", _u32),
        ("valueCodec", _u32),
        ("keepOrder", _u32),
        ("lossless", _u32),
        ("exactCoarse", _u32),
        ("threads", _u32),
        ("maxBoundaryError", _f64),
        ("maxFieldErrors", _address),
        ("fieldWeights", _address),
        ("maxFieldErrorCount", _u32),
        ("fieldWeightCount", _u32),
        ("regions", _address),
        ("source", _address),
        ("progress", _Progress),
        ("user", _address),
        ("originalIds", _u32),
        ("baseCells", _u32),
        ("baseError", _f64),
        ("timeStatistics", _u32),
        ("labelWeightCount", _u32),
        ("labelWeights", _address),
        ("errors", _address),
        ("errorCount", _u32),
        ("finest", _u32),
    ]


def _library() -> Library:
    c = library()
    if not hasattr(c, "qtet_simplify"):
        raise QtetError("this libqtet.so makes no logs; install a newer libqtet0")
    return c


class _Places:
    """Data that structs of C point to, until free()."""

    def __init__(self, c: Library) -> None:
        self.c = c
        self.kept: list[tuple[int, Any]] = []

    def of(self, data: Any) -> int:
        """The address of a packed array of numpy, or of an array of ctypes."""
        self.kept.append((self.c.place(data), data))
        return self.kept[-1][0]

    def text(self, text: str) -> int:
        return self.of(ctypes.create_string_buffer(text.encode()))

    def named(self, numbers: Mapping[str, float] | None) -> tuple[int, int]:
        """The address of the entries, and how many there are."""
        entries = [_NamedNumber(self.text(name), x) for name, x in (numbers or {}).items()]
        return self.of((_NamedNumber * len(entries))(*entries)), len(entries)

    def bounds(self, errors: Mapping[str, float | str] | None) -> tuple[int, int]:
        """The same of bounds of fields: numbers, or texts such as "0.1%" and "0.5 K"."""
        entries = []
        for name, bound in (errors or {}).items():
            match = _BOUND.fullmatch(bound if isinstance(bound, str) else repr(float(bound)))
            if match is None:
                raise ValueError(
                    f"errors[{name!r}] is {bound!r}; give a number above 0, '0.1%' or '0.5K'"
                )
            entries.append(_ErrorBound(self.text(name), float(match[1]), self.text(match[2])))
        return self.of((_ErrorBound * len(entries))(*entries)), len(entries)

    def free(self) -> None:
        while self.kept:
            self.c.release(self.kept.pop()[0])


def _points(points: Any) -> NDArray[Any]:
    array = packed_array(mesh_array(points, "points"), "points")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points have the shape {array.shape}; give (points, 3)")
    return array if array.dtype.name in ("float32", "float64") else array.astype("float64")


def _cells(cells: Any) -> NDArray[Any]:
    array = packed_array(mesh_array(cells, "cells"), "cells")
    if array.ndim != 2 or array.shape[1] != 4 or array.dtype.kind not in "iu":
        raise ValueError(
            f"cells are {array.dtype} of the shape {array.shape}; give integers of "
            "the shape (cells, 4), as of tetrahedra (qtet convert splits others)"
        )
    return (
        array
        if array.dtype.name in ("int32", "int64", "uint32", "uint64")
        else (array.astype("int64"))
    )


def _mesh(
    places: _Places,
    points: Any,
    cells: Any,
    point_data: Mapping[str, Any] | None,
    cell_data: Mapping[str, Any] | None,
) -> _Mesh:
    """The C struct of a mesh."""
    points, cells = _points(points), _cells(cells)
    fields = [
        _field(places, name, values, association, tuples)
        for data, association, tuples in (
            (point_data, _POINT, len(points)),
            (cell_data, _CELL, len(cells)),
        )
        for name, values in (data or {}).items()
    ]
    return _Mesh(
        places.of(points),
        len(points),
        places.of(cells),
        len(cells),
        _TYPES[points.dtype.name],
        _TYPES[cells.dtype.name],
        places.of((_Field * len(fields))(*fields)),
        len(fields),
        ctypes.sizeof(_Field),
    )


def _field(places: _Places, name: str, values: Any, association: int, tuples: int) -> _Field:
    if not isinstance(name, str) or "\0" in name:
        raise ValueError(f"the name {name!r} of a field is no str without NUL")
    array = packed_array(values, f"field {name!r}")
    components = int(numpy.prod(array.shape[1:]))
    if array.ndim == 0 or len(array) != tuples or not 1 <= components <= _MAX_COMPONENTS:
        raise ValueError(
            f"field {name!r} has the shape {array.shape}; give ({tuples},) or ({tuples}, "
            f"components), at most {_MAX_COMPONENTS} of these"
        )
    number = _TYPES[array.dtype.name]
    return _Field(places.text(name), association, number, components, 0, places.of(array))


def _check_numbers(numbers: Mapping[str, Any]) -> None:
    """Refuses NaN and negative ones; the library and the tool know the upper bounds. A C integer
    would take -3 for 4 thousand millions, and NaN stands for an option that is not given."""
    for name, value in numbers.items():
        if isinstance(value, Mapping):
            _check_numbers(
                {f"{name}[{key!r}]": x for key, x in value.items() if not isinstance(x, str)}
            )
        elif value is not None and not value >= 0:
            raise ValueError(f"{name} is {value}; give a number of 0 or above")
        elif name in _INTEGERS and value is not None and not (value < 2**32 and value % 1 == 0):
            raise ValueError(f"{name} is {value}; give an integer")


def _choice(choices: Mapping[str, int], word: str, what: str) -> int:
    if word not in choices:
        raise ValueError(f"{what} {word!r} is not known; give one of {', '.join(choices)}")
    return choices[word]


class _Work:
    """One call of qtet_simplify in a thread of its own: Python handles Ctrl-C between two steps of
    the thread that waits, and would lose it in a callback from C."""

    def __init__(self, c: Library, mesh: _Mesh, options: _Options) -> None:
        self.c, self.mesh, self.options = c, mesh, options
        self.stage, self.fraction, self.is_stopped, self.status = 0, 0.0, False, 0
        self.is_over = threading.Event()
        if c.calls_back:
            options.progress = _Progress(self._tell)
        self.made = _address(c.qtet_simplified_create())
        if not self.made:
            raise MemoryError("no memory for a log")

    def _tell(self, _: Any, stage: int, fraction: float) -> int:
        self.stage, self.fraction = stage, fraction
        return int(self.is_stopped)

    def _call(self) -> None:
        try:
            self.status = self.c.qtet_simplify(
                self.made,
                ctypes.c_size_t(ctypes.sizeof(_Mesh)),
                ctypes.pointer(self.mesh),
                ctypes.c_size_t(ctypes.sizeof(_Options)),
                ctypes.pointer(self.options),
            )
        finally:
            self.is_over.set()

    def run(self, progress: Callable[[str, float], bool | None] | None) -> None:
        if not self.c.calls_back:  # nor are there threads
            self._call()
            return self.check(self.status)
        thread = threading.Thread(target=self._call, name="qtet.simplify")
        try:
            thread.start()
            while not self.is_over.wait(_INTERVAL_S):
                if progress and progress(_STAGES[self.stage], self.fraction) is False:
                    break
        finally:
            self.is_stopped = True
            self._wait_for_end(thread)
        return self.check(self.status)

    def _wait_for_end(self, thread: threading.Thread) -> None:
        """Whatever else is interrupted meanwhile: C must not write into memory that is gone."""
        while thread in threading.enumerate() and not self.is_over.is_set():
            try:
                # not join: an interrupted one takes a thread that runs for one that has ended
                self.is_over.wait()
            except KeyboardInterrupt:
                pass

    def check(self, status: int) -> None:
        if status == 0:
            return
        text = self.c.text_at(self.c.qtet_simplified_error(self.made))
        if status == OUT_OF_MEMORY:
            raise MemoryError(text)
        raise (Cancelled if status == _CANCELLED else QtetError)(text)

    def log(self) -> bytes:
        size = (ctypes.c_size_t * 1)()
        address = self.c.qtet_simplified_log(self.made, size)
        return self.c.bytes_at(address, size[0])

    def write(self, path: str | os.PathLike[str]) -> None:
        self.check(self.c.qtet_simplified_write(self.made, os.fsencode(os.path.abspath(path))))

    def close(self) -> None:
        self.c.qtet_simplified_destroy(self.made)


def _tool_words(options: Mapping[str, Any]) -> list[str]:
    """The options of simplify() as words of `qtet simplify`."""
    names = {"regions": "preserve-regions"}
    words: list[str] = []
    for key, value in options.items():
        name = "--" + names.get(key, key.removesuffix("s") if isinstance(value, dict) else key)
        name = name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words += [name]
        elif isinstance(value, dict):
            for field, x in value.items():
                words += [name, f"{field}={x if isinstance(x, str) else float(x)}"]
        else:
            words += [name, str(value)]
    return words


# Bytes of a list of names at most: Linux takes 128 kB a word of a command.
_MAX_NAMES = 100_000


def _all_fields(grid: Grid) -> list[str]:
    """The words by which the tool takes the fields that only number points or cells, too: they are
    given, not found in a file. Where they are too long, it leaves such fields out."""
    names = ",".join(
        f"{association}:{name}".replace(",", "\\,")
        for association, data in (("point", grid.point_data), ("cell", grid.cell_data))
        for name in data
    )
    return ["--fields", names] if 0 < len(names.encode()) <= _MAX_NAMES else []


def _simplify_by_tool(
    grid: Grid,
    path: str | os.PathLike[str] | None,
    progress: Callable[[str, float], bool | None] | None,
    source: str,
    options: Mapping[str, Any],
) -> Any:
    """Cells other than tetrahedra are split by the tool, which reads them from a file."""
    with tempfile.TemporaryDirectory(prefix="qtet-") as folder:
        stem = pathlib.PurePath(source).stem or "grid"
        mesh = pathlib.Path(folder) / (stem + ".vtu")
        log = pathlib.Path(path) if path is not None else mesh.with_suffix(".qtet")
        grid.write_vtu(mesh)
        words = ["simplify", str(mesh), "-o", str(log), "--quiet"]
        words += _all_fields(grid) + _tool_words(options)
        if tool.run(words, goes_on=lambda: progress and progress(_STAGES[2], 0.0)) is None:
            raise Cancelled("cancelled")
        return path if path is not None else log.read_bytes()


def simplify(
    points: Any,
    cells: ArrayLike | None = None,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
    *,
    times: Sequence[float] | None = None,
    time_statistics: bool = False,
    path: str | os.PathLike[str] | None = None,
    progress: Callable[[str, float], bool | None] | None = None,
    source: str = "",
    target_ratio: float | None = None,
    base_cells: int | None = None,
    base_error: float | None = None,
    boundary_weight: float | None = None,
    shape_weight: float | None = None,
    envelope_tolerance: float | None = None,
    position_bits: int | None = None,
    field_bits: int | None = None,
    algorithm: str = "qtet",
    placement: str = "auto",
    measure: str = "levels",
    value_codec: str = "lifted",
    exact_coarse: bool = False,
    finest: int | None = None,
    keep_order: bool = False,
    lossless: bool = False,
    original_ids: bool = False,
    threads: int = 1,
    max_boundary_error: float | None = None,
    max_field_errors: Mapping[str, float] | None = None,
    errors: Mapping[str, float | str] | None = None,
    field_weights: Mapping[str, float] | None = None,
    label_weights: Mapping[str, float] | None = None,
    regions: str | None = None,
) -> Any:
    """Makes the log of a mesh: its bytes, or, with `path`, a file (and the path). The path ends in
    .qtet; a file there is replaced if it is a log.

    points      (n, 3) floats, finite, in any unit of length; or a grid: an unstructured grid of VTK
                or PyVista, or a mesh of meshio, with any volume cells and its own data
    cells       (m, 4) integers: the points of each tetrahedron, counted from 0
    point_data  {name: array}: (n,) or (n, components), float or integer; NaN is a missing value
    cell_data   {name: array}: the same with m. What a mask of numpy.ma covers is missing
    times       of the grids, ascending: a field that changes becomes a series, NAME@TIME. Points
                that move get one, too: Displacement, from where they are first
    time_statistics       of each series: the fields NAME_average, NAME_minimum, NAME_maximum and
                NAME_stddev over all instants
    progress    called about ten times a second with the stage's name and the fraction of it that
                is done, 0 to 1; the answer False ends the work with Cancelled. The fraction of a
                grid with cells other than tetrahedra stays 0
    source      what the log calls its input
    target_ratio          of the base mesh's tetrahedra to the input's; without, base_error chooses
    base_cells            tetrahedra of the base mesh, instead of a ratio
    base_error            how far the base mesh's boundary may be, over the diagonal; 0.01. Volume
                          and fields may be twice that
    boundary_weight       what the boundary's place counts beside the fields; chosen by the mesh
    shape_weight          what badly shaped cells cost; 0.5
    envelope_tolerance    how far the boundary may leave the solid, over the box's diagonal; 0.005
    position_bits, field_bits   of the lattice an axis, 16; of a float field's values, 12
    algorithm, placement, measure, value_codec   the words of `qtet simplify --help`
    exact_coarse          coarse levels keep the best values of their fields, for more bytes
    finest                the last level has so many tetrahedra at most, to which the mesh is
                          reduced before (experimental)
    keep_order, lossless  keep the input's numbering; its own numbers
    original_ids          keep the cell field OriginalCellId (int32) for the last level alone
    threads               the log does not depend on it
    max_boundary_error    coarsest level: the boundary's distance, over the diagonal
    max_field_errors      {name: rms error over the field's range; of a label a share of
                          the volume}
    errors                {name: how far a value of the last level may be from the input's}: 0.5 in
                          the field's unit, "0.5K", or "0.1%" of its range; the step and the bits
                          follow. "all": every float field that is not named
    field_weights         {name: what a point field counts, 1 otherwise}; without, the
                          smoother a field the more, 8 at most
    label_weights         {name: what the interfaces of a cell field of integers count, such as
                          materials; 0 leaves them out}
    regions               the name of a cell field whose values keep their topology

    Raises ValueError (arrays of another shape or type, a word that is not known), OSError (a file
    that cannot be written, FileExistsError where it is no log), QtetError (a mesh that cannot be
    simplified, options out of range), Cancelled, MemoryError. Ctrl-C ends the work soon, and
    KeyboardInterrupt is raised. Other threads of Python run meanwhile; the arrays must not
    change."""
    words = {
        name: value
        for name, value in locals().items()
        if name
        not in ("points", "cells", "point_data", "cell_data", "times", "path", "progress", "source")
    }
    if path is not None:
        check_output(path)
    _check_numbers({name: value for name, value in words.items() if not isinstance(value, str)})
    if times is not None and cells is not None:
        raise ValueError("times are those of grids; call a field of an instant NAME@TIME")
    if cells is None:
        grid = grid_of(points) if times is None else series_of(list(points), times)
        if grid is None:
            raise ValueError(
                f"{type(points).__name__} is no grid; give points and cells, or an unstructured "
                "grid of VTK, PyVista or meshio"
            )
        grid.point_data.update(point_data or {})
        grid.cell_data.update(cell_data or {})
        cells = grid.tetrahedra()
        if cells is None:
            return _simplify_by_tool(grid, path, progress, source, words)
        points, point_data, cell_data = grid.points, grid.point_data, grid.cell_data
    c = _library()
    options = _Options()
    if c.qtet_simplify_defaults(ctypes.c_size_t(ctypes.sizeof(options)), ctypes.pointer(options)):
        raise QtetError(
            "libqtet.so and the package qtet are of different versions; install both again"
        )
    for member, value in (
        ("targetRatio", target_ratio),
        ("boundaryWeight", boundary_weight),
        ("shapeWeight", shape_weight),
        ("envelopeTolerance", envelope_tolerance),
        ("positionBits", position_bits),
        ("fieldBits", field_bits),
        ("maxBoundaryError", max_boundary_error),
        ("baseError", base_error),
    ):
        if value is not None:
            setattr(options, member, int(value) if member.endswith("Bits") else value)
    options.algorithm = _choice(_ALGORITHMS, algorithm, "algorithm")
    options.placement = _choice(_PLACEMENTS, placement, "placement")
    options.measure = _choice(_MEASURES, measure, "measure")
    options.valueCodec = _choice(_CODECS, value_codec, "value_codec")
    options.keepOrder, options.lossless = bool(keep_order), bool(lossless)
    options.exactCoarse = bool(exact_coarse)
    options.originalIds = bool(original_ids)
    options.timeStatistics = bool(time_statistics)
    options.baseCells = int(base_cells or 0)
    options.finest = int(finest or 0)
    options.threads = int(threads)
    places = _Places(c)
    try:
        options.maxFieldErrors, options.maxFieldErrorCount = places.named(max_field_errors)
        options.errors, options.errorCount = places.bounds(errors)
        options.fieldWeights, options.fieldWeightCount = places.named(field_weights)
        options.labelWeights, options.labelWeightCount = places.named(label_weights)
        options.regions = places.text(regions) if regions is not None else None
        options.source = places.text(source)
        mesh = _mesh(places, points, cells, point_data, cell_data)
        return _made(c, mesh, options, path, progress)
    finally:
        places.free()


def _made(
    c: Library,
    mesh: _Mesh,
    options: _Options,
    path: str | os.PathLike[str] | None,
    progress: Callable[[str, float], bool | None] | None,
) -> Any:
    """The log, or the path to which it was written."""
    work = _Work(c, mesh, options)
    try:
        work.run(progress)
        if path is None:
            return work.log()
        work.write(path)
        return path
    finally:
        work.close()

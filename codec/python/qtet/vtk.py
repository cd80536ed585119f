"""qtet logs as VTK's grids, for VTK, PyVista and ParaView.

    grid = qtet.vtk.read("part.qtet", tetrahedra=100_000)       # a vtkUnstructuredGrid
    part = "http://localhost:8080/v1/meshes/part"
    mesh = pyvista.wrap(qtet.vtk.read(part, error=("Density", 0.01)))

libqtet.so decodes straight into VTK's own arrays; numpy is not needed."""
from __future__ import annotations

import array
import ctypes
import os
from typing import Any, Iterable

try:
    from vtkmodules import vtkCommonCore as core
    from vtkmodules import vtkCommonDataModel as model
except ImportError as error:
    raise ImportError(
        "VTK's Python modules are needed (Debian: python3-vtk9; or pip install vtk)"
    ) from error

from .library import CELL, POINT, QtetError
from .log import Log

__all__ = ["Log", "QtetError", "grid_of", "read", "surface_of"]

# A float keeps a lattice of this many bits apart where the origin is not far off.
_FLOAT_BITS = 20
_ARRAYS = {
    "float32": core.vtkFloatArray,
    "float64": core.vtkDoubleArray,
    "int8": core.vtkTypeInt8Array,
    "uint8": core.vtkTypeUInt8Array,
    "int16": core.vtkTypeInt16Array,
    "uint16": core.vtkTypeUInt16Array,
    "int32": core.vtkTypeInt32Array,
    "uint32": core.vtkTypeUInt32Array,
    "int64": core.vtkTypeInt64Array,
    "uint64": core.vtkTypeUInt64Array,
}


def _sized(values: Any, components: int, tuples: int) -> Any:
    values.SetNumberOfComponents(components)
    values.SetNumberOfTuples(tuples)
    return values


def _memory(values: Any) -> ctypes.c_void_p:
    """An array's memory for ctypes."""
    return ctypes.cast(
        (ctypes.c_char * (values.GetDataTypeSize() * values.GetNumberOfValues())).from_buffer(
            values
        ),
        ctypes.c_void_p,
    )


def _points(log: Log) -> Any:
    info, vertices = log.info, log.counts()[0]
    far = max(abs(x) for x in info.latticeOrigin) > info.latticeStep * 2**_FLOAT_BITS
    is_double = info.latticeBits > _FLOAT_BITS or far
    values = _sized(core.vtkDoubleArray() if is_double else core.vtkFloatArray(), 3, vertices)
    if vertices:
        log.copy_points(_memory(values), 3 * vertices, is_double)
    points = core.vtkPoints()
    points.SetData(values)
    return points


def _cells(source: Any, corners: int, count: int) -> Any:
    """vtkCellArray of `count` cells, from the library's own indices."""
    connectivity = _sized(core.vtkTypeInt32Array(), 1, corners * count)
    if count:
        ctypes.memmove(_memory(connectivity), source, 4 * corners * count)
    offsets = _sized(core.vtkTypeInt32Array(), 1, count + 1)
    starts = array.array("i", range(0, corners * count + 1, corners))
    ctypes.memmove(_memory(offsets), starts.buffer_info()[0], 4 * len(starts))
    cells = model.vtkCellArray()
    cells.SetData(offsets, connectivity)
    return cells


def _field(log: Log, number: int) -> Any:
    info = log.fields[number]
    kind = info.type
    tuples = log.field_count(number) // info.components
    is_double = kind != "float32"
    values = _sized(
        core.vtkDoubleArray() if is_double else core.vtkFloatArray(), info.components, tuples
    )
    if tuples:
        log.copy_field(number, _memory(values), tuples * info.components, is_double)
    if kind not in ("float32", "float64") and kind in _ARRAYS:
        integers = _ARRAYS[kind]()
        integers.DeepCopy(values)
        values = integers
    return values


def _add_fields(log: Log, grid: Any, associations: tuple[int, ...], *choice: Any) -> None:
    for number, name, info in log.fields_of(*choice):
        if info.association not in associations:
            continue
        data = grid.GetCellData() if info.association == CELL else grid.GetPointData()
        values = _field(log, number)
        values.SetName(name)
        data.AddArray(values)
        if info.components == 1 and data.GetScalars() is None:
            data.SetActiveScalars(values.GetName())


def grid_of(
    log: Log,
    fields: str | Iterable[str] | None = None,
    time: float | None = None,
    method: str | None = None,
) -> Any:
    """The log's present mesh as a vtkUnstructuredGrid of tetrahedra, with the named fields (None:
    all); with a time each series is one field. Arguments and exceptions are those of
    Log.arrays()."""
    grid = model.vtkUnstructuredGrid()
    grid.SetPoints(_points(log))
    cells = _cells(log.c.qtet_log_tetrahedra(log.handle), 4, log.counts()[1])
    grid.SetCells(model.VTK_TETRA, cells)
    _add_fields(log, grid, (POINT, CELL), fields, time, method)
    return grid


def surface_of(
    log: Log,
    fields: str | Iterable[str] | None = None,
    time: float | None = None,
    method: str | None = None,
) -> Any:
    """The log's present boundary as a vtkPolyData of triangles, with the points of the whole mesh
    and its point fields."""
    surface = model.vtkPolyData()
    surface.SetPoints(_points(log))
    surface.SetPolys(_cells(log.c.qtet_log_boundary(log.handle), 3, log.counts()[2]))
    _add_fields(log, surface, (POINT,), fields, time, method)
    return surface


def read(
    source: str | os.PathLike[str] | bytes,
    level: int | None = None,
    tetrahedra: float | None = None,
    error: tuple[str, float] | None = None,
    fields: str | Iterable[str] | None = None,
    time: float | None = None,
    method: str | None = None,
) -> Any:
    """A level of a log (a file, its bytes or a URL) as a vtkUnstructuredGrid.

    level       its number, 0 the coarsest; without anything: the whole mesh
    tetrahedra  or the finest level of at most so many
    error       or ("NAME", E): the coarsest at which the field's rms error is at most E of its
                range, or the distance ("boundary", E)
    fields      names; None: all
    time        series at exactly this time alone, by their names
    method      "nearest": at the nearest time"""
    if sum(choice is not None for choice in (level, tetrahedra, error)) > 1:
        raise ValueError("give one of level, tetrahedra and error")
    with Log(source) as log:
        if tetrahedra is not None:
            level = log.level_of_tetrahedra(tetrahedra)
        elif error is not None:
            level = log.level_of_error(*error)
        log.refine(log.last_level if level is None else level)
        return grid_of(log, fields, time, method)

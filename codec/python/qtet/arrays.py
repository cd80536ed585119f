"""The present mesh of a log as numpy arrays."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy

from .log import POINT, Log

__all__ = ["Arrays", "arrays_of", "field_of"]


@dataclass
class Arrays:
    """points      (n, 3) float64, in the input's unit
    cells       (m, 4) int32: the points of each tetrahedron
    boundary    (k, 3) int32: the points of each triangle, seen from outside against the clock
    point_data  {name: (n,) or (n, components)} in the input's types; NaN where a value is missing
    cell_data   {name: (m,) or (m, components)}
    """

    points: numpy.ndarray
    cells: numpy.ndarray
    boundary: numpy.ndarray
    point_data: dict[str, numpy.ndarray]
    cell_data: dict[str, numpy.ndarray]


def _copied(address, count, width):
    """Indices out of the library's memory."""
    if count == 0:
        return numpy.empty((0, width), "uint32")
    packed = ctypes.string_at(address, 4 * width * count)
    return numpy.frombuffer(packed, "uint32").reshape(-1, width)


def field_of(log: Log, number: int) -> numpy.ndarray:
    """The values of the field with this number, in the input's type."""
    info = log.fields[number]
    kind = info.type
    count = log.field_count(number)
    is_double = kind != "float32"
    values = numpy.empty(count, "float64" if is_double else "float32")
    if count:
        log.copy_field(number, values.ctypes.data_as(ctypes.c_void_p), count, is_double)
    values = values.astype(kind, copy=False)
    return values.reshape(-1, info.components) if info.components > 1 else values


def arrays_of(log: Log, fields=None, time=None) -> Arrays:
    """The log's present mesh, as refine() made it; `fields` and `time` as for Log.arrays(). Raises
    QtetError for a name that the log does not have."""
    wanted = log.fields_of(fields, time)
    vertices, tetrahedra, triangles = log.counts()
    points = numpy.empty((vertices, 3))
    if vertices:
        log.copy_points(points.ctypes.data_as(ctypes.c_void_p), 3 * vertices, True)
    cells = _copied(log.c.qtet_log_tetrahedra(log.handle), tetrahedra, 4)
    boundary = _copied(log.c.qtet_log_boundary(log.handle), triangles, 3)
    out = Arrays(points, cells.view("int32"), boundary.view("int32"), {}, {})
    for number, name, info in wanted:
        data = out.point_data if info.association == POINT else out.cell_data
        data[name] = field_of(log, number)
    return out

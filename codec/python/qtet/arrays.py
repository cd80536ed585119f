"""The present mesh of a log as numpy arrays."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterable

import numpy

from .library import POINT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .log import Log

__all__ = ["Arrays", "arrays_of", "field_of"]


@dataclass(repr=False)
class Arrays:
    """points      (n, 3) float64, in the input's unit
    cells       (m, 4) int32: the points of each tetrahedron
    boundary    (k, 3) int32: the points of each triangle, seen from outside against the clock
    point_data  {name: (n,) or (n, components)} in the input's types; NaN where a value is missing
    cell_data   {name: (m,) or (m, components)}
    """

    points: NDArray[Any]
    cells: NDArray[Any]
    boundary: NDArray[Any]
    point_data: dict[str, NDArray[Any]]
    cell_data: dict[str, NDArray[Any]]

    def __repr__(self) -> str:
        sizes = f"{len(self.points)} points, {len(self.cells)} cells"
        names = ", ".join([*self.point_data, *self.cell_data]) or "none"
        return f"<qtet.Arrays {sizes}, fields: {names}>"


def _copied(log: Log, address: Any, count: int, width: int) -> NDArray[Any]:
    """Indices out of the library's memory."""
    if count == 0:
        return numpy.empty((0, width), "uint32")
    packed = log.c.bytes_at(address, 4 * width * count)
    return numpy.frombuffer(packed, "uint32").reshape(-1, width)


def _memory(values: Any) -> Any:
    """A packed array as one of ctypes, at the same place."""
    return (ctypes.c_char * values.nbytes).from_buffer(values)


def field_of(log: Log, number: int) -> NDArray[Any]:
    """The values of the field with this number, in the input's type."""
    info = log.fields[number]
    kind = info.type
    count = log.field_count(number)
    is_double = kind != "float32"
    values = numpy.empty(count, "float64" if is_double else "float32")
    if count:
        log.copy_field(number, _memory(values), count, is_double)
    values = values.astype(kind, copy=False)
    return values.reshape(-1, info.components) if info.components > 1 else values


def arrays_of(
    log: Log,
    fields: str | Iterable[str] | None = None,
    time: float | None = None,
    method: str | None = None,
) -> Arrays:
    """Log.arrays()."""
    vertices, tetrahedra, triangles = log.counts()
    wanted = log.fields_of(fields, time, method)
    points = numpy.empty((vertices, 3))
    if vertices:
        log.copy_points(_memory(points), 3 * vertices, True)
    cells = _copied(log, log.c.qtet_log_tetrahedra(log.handle), tetrahedra, 4)
    boundary = _copied(log, log.c.qtet_log_boundary(log.handle), triangles, 3)
    out = Arrays(points, cells.view("int32"), boundary.view("int32"), {}, {})
    for number, name, info in wanted:
        data = out.point_data if info.association == POINT else out.cell_data
        data[name] = field_of(log, number)
    return out

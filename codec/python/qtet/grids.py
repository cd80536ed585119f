"""Meshes of other packages as arrays, and as .vtu files for the tool: unstructured grids of VTK and
PyVista, and meshes of meshio."""
from __future__ import annotations

import json
import os
import re
import struct
from typing import TYPE_CHECKING, Any, Mapping, Sequence
from xml.sax.saxutils import quoteattr

import numpy

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Grid", "grid_of", "mesh_array", "packed_array", "series_of"]

_ma: Any = numpy.ma  # which has no types
# VTK's numbers of volume cells by meshio's names. Both order the nodes alike.
_NUMBERS = {
    "tetra": 10,
    "voxel": 11,
    "hexahedron": 12,
    "wedge": 13,
    "pyramid": 14,
    "tetra10": 24,
    "hexahedron20": 25,
    "wedge15": 26,
    "pyramid13": 27,
    "hexahedron27": 29,
    "hexahedron24": 33,
    "wedge12": 31,
    "wedge18": 32,
}
_TETRAHEDRON = 10
_POLYHEDRON = 42
# Types of numbers that a log has, by VTK's names in .vtu files.
_VTU_TYPES = {
    "float32": "Float32",
    "float64": "Float64",
    "int8": "Int8",
    "int16": "Int16",
    "int32": "Int32",
    "int64": "Int64",
    "uint8": "UInt8",
    "uint16": "UInt16",
    "uint32": "UInt32",
    "uint64": "UInt64",
}
# Types that are stored as a wider one.
_WIDENED = {"bool": "uint8", "float16": "float32"}


def field_array(values: Any) -> NDArray[Any]:
    """A field's array. What a mask covers is a missing value, NaN: masked integers become
    float64."""
    is_list = isinstance(values, (list, tuple))
    if is_list and any(_ma.isMaskedArray(part) for part in values):
        values = _ma.array(values)
    if not _ma.is_masked(values):
        return numpy.asarray(values)
    kind = values.dtype if values.dtype.kind in "fc" else numpy.dtype("float64")
    filled: NDArray[Any] = values.astype(kind).filled(numpy.nan)
    return filled


def mesh_array(values: Any, what: str) -> NDArray[Any]:
    """An array of points or cells. Raises ValueError where a mask covers some."""
    array = field_array(values)
    parts = values if isinstance(values, (list, tuple)) else [values]
    if any(_ma.is_masked(part) for part in parts):
        raise ValueError(f"some {what} are masked; leave them out, or fill them")
    return array


def packed_array(values: Any, what: str) -> NDArray[Any]:
    """A packed array of one of the types that a log has, in the machine's order of bytes."""
    array = field_array(values)
    name = array.dtype.newbyteorder("=").name
    name = _WIDENED.get(name, name)
    if name not in _VTU_TYPES:
        raise ValueError(
            f"{what}: no log has numbers of type {array.dtype}; give floats of 32 or "
            "64 bits, or integers"
        )
    return numpy.ascontiguousarray(array, dtype=name)


class Grid:
    """points (n, 3); types (m,), VTK's numbers; connectivity and ends (m,): the nodes of cell i are
    those before ends[i]; point_data and cell_data {name: (n or m, ...)}."""

    def __init__(
        self,
        points: Any,
        types: Any,
        connectivity: Any,
        ends: Any,
        point_data: Mapping[str, Any],
        cell_data: Mapping[str, Any],
    ) -> None:
        self.points, self.types = mesh_array(points, "points"), numpy.asarray(types, "uint8")
        self.connectivity, self.ends = numpy.asarray(connectivity), numpy.asarray(ends)
        self.point_data, self.cell_data = dict(point_data), dict(cell_data)

    def tetrahedra(self) -> NDArray[Any] | None:
        """(m, 4) if all cells are tetrahedra, else None."""
        if (self.types != _TETRAHEDRON).any() or len(self.connectivity) != 4 * len(self.types):
            return None
        return self.connectivity.reshape(-1, 4)

    def write_vtu(self, path: str | os.PathLike[str]) -> None:
        """Uncompressed, in the machine's order of bytes, which is little-endian."""
        blocks: list[NDArray[Any]] = []
        at = 0

        def array(name: str, values: Any) -> str:
            nonlocal at
            values = packed_array(values, f"field {name!r}")
            components = int(numpy.prod(values.shape[1:]))
            text = (
                f'<DataArray type="{_VTU_TYPES[values.dtype.name]}" Name={quoteattr(str(name))} '
                f'NumberOfComponents="{components}" format="appended" offset="{at}"/>'
            )
            blocks.append(values)
            at += 8 + values.nbytes
            return text

        head = "".join(
            [
                '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
                'header_type="UInt64"><UnstructuredGrid>',
                f'<Piece NumberOfPoints="{len(self.points)}" NumberOfCells="{len(self.types)}">',
                "<Points>",
                array("Points", self.points),
                "</Points><Cells>",
                array("connectivity", self.connectivity.astype("int64")),
                array("offsets", self.ends.astype("int64")),
                array("types", self.types),
                "</Cells><PointData>",
                *(array(name, values) for name, values in self.point_data.items()),
                "</PointData><CellData>",
                *(array(name, values) for name, values in self.cell_data.items()),
                '</CellData></Piece></UnstructuredGrid><AppendedData encoding="raw">_',
            ]
        )
        with open(path, "wb") as file:
            file.write(head.encode())
            for values in blocks:
                file.write(struct.pack("<Q", values.nbytes))
                file.write(values.data.cast("B") if values.size else b"")
            file.write(b"</AppendedData></VTKFile>")


def grid_of(source: Any) -> Grid | None:
    """The Grid of a VTK, PyVista or meshio object; None for anything else. Raises ValueError for
    one without volume cells, and for polyhedra."""
    if not hasattr(source, "GetCellTypesArray") and hasattr(source, "cast_to_unstructured_grid"):
        source = source.cast_to_unstructured_grid()
    if hasattr(source, "GetCellTypesArray"):
        return _of_vtk(source)
    if hasattr(source, "points") and hasattr(source, "cells") and hasattr(source, "cell_data"):
        return _of_meshio(source)
    return None


def series_of(grids: Sequence[Any], times: Sequence[float]) -> Grid:
    """One Grid of the instants of a mesh: a field that changes is one NAME@TIME an instant, another
    is there once. Points that move stay where they are first; Displacement@TIME says how far
    they are from there. Raises ValueError for other cells, and for times that are not
    ascending."""
    times = [float(time) for time in times]
    if not grids or len(times) != len(grids):
        raise ValueError(f"there are {len(grids)} grids and {len(times)} times; give one each")
    if not numpy.isfinite(times).all() or (numpy.diff(times) <= 0).any():
        raise ValueError("times are not ascending finite numbers")
    instants = [grid for grid in map(grid_of, grids) if grid is not None]
    if len(instants) < len(grids):
        raise ValueError("an instant is no grid; give unstructured grids of VTK, PyVista or meshio")
    first = instants[0]
    for time, grid in zip(times, instants):
        same = (
            numpy.array_equal(getattr(grid, what), getattr(first, what))
            for what in ("types", "connectivity", "ends")
        )
        if grid.points.shape != first.points.shape or not all(same):
            raise ValueError(
                f"the cells at the time {time:.17g} are not those of the first instant; make a log "
                "a step"
            )
    merged = Grid(first.points, first.types, first.connectivity, first.ends, {}, {})
    for out, data in (
        (merged.point_data, [grid.point_data for grid in instants]),
        (merged.cell_data, [grid.cell_data for grid in instants]),
    ):
        for name in dict.fromkeys(name for fields in data for name in fields):
            _add_instants(out, name, [fields.get(name) for fields in data], times)
    if any(not numpy.array_equal(grid.points, first.points, equal_nan=True) for grid in instants):
        is_narrow = all(grid.points.dtype == numpy.float32 for grid in instants)
        kind = "float32" if is_narrow else "float64"
        moved = [_displacement(first, grid, time, kind) for time, grid in zip(times, instants)]
        _add_instants(merged.point_data, _motion_name(instants), moved, times)
    return merged


def _motion_name(instants: list[Grid]) -> str:
    """As the program calls it (simplify/INPUT.md, "Moving points")."""
    names = {n for grid in instants for data in (grid.point_data, grid.cell_data) for n in data}
    taken = {re.sub(r"(?s)(.)@[^@]*$", r"\1", name) for name in names} | names
    name, again = "Displacement", 0
    while name in taken:
        again += 1
        name = "Motion" if again == 1 else f"Motion-{again}"
    return name


def _displacement(rest: Grid, grid: Grid, time: float, kind: str) -> NDArray[Any]:
    moved: NDArray[Any] = grid.points.astype("float64") - rest.points
    lost = ~numpy.isfinite(moved).all(axis=1)
    used = numpy.intersect1d(numpy.flatnonzero(lost), rest.connectivity)
    if len(used):
        raise ValueError(
            f"point {used[0]} has a coordinate that is NaN or infinite at the time {time:.17g}"
        )
    moved[lost] = 0
    return moved.astype(kind)


def _add_instants(
    out: dict[str, Any], name: str, values: Sequence[Any], times: Sequence[float]
) -> None:
    arrays = [None if v is None else field_array(v) for v in values]
    # An instant whose integers a mask made floats shares its type with the others.
    kind = numpy.result_type(*(array.dtype for array in arrays if array is not None))
    arrays = [None if array is None else array.astype(kind, copy=False) for array in arrays]
    first = arrays[0]
    if first is not None and all(
        v is not None and numpy.array_equal(first, v, equal_nan=first.dtype.kind == "f")
        for v in arrays
    ):
        out[name] = first
        return
    for time, of_time in zip(times, arrays):
        if of_time is not None:
            out[f"{name}@{repr(time).removesuffix('.0')}"] = of_time


def _of_vtk(source: Any) -> Grid:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    def fields(data: Any) -> dict[str, Any]:
        arrays = (data.GetArray(i) for i in range(data.GetNumberOfArrays()))
        return {a.GetName(): vtk_to_numpy(a) for a in arrays if a is not None and a.GetName()}

    if source.GetNumberOfCells() == 0:
        raise ValueError("the grid has no cells")
    types = vtk_to_numpy(source.GetCellTypesArray())
    if (types == _POLYHEDRON).any():
        raise ValueError("the grid has polyhedra; save it as .vtu, and give the file's path")
    cells = source.GetCells()
    return Grid(
        vtk_to_numpy(source.GetPoints().GetData()),
        types,
        vtk_to_numpy(cells.GetConnectivityArray()),
        vtk_to_numpy(cells.GetOffsetsArray())[1:],
        fields(source.GetPointData()),
        fields(source.GetCellData()),
    )


def _of_meshio(source: Any) -> Grid:
    kept = [i for i, block in enumerate(source.cells) if block.type in _NUMBERS]
    if not kept:
        found = sorted({block.type for block in source.cells})
        raise ValueError(f"the mesh has no volume cells, only {json.dumps(found)}")
    blocks = [(source.cells[i].type, mesh_array(source.cells[i].data, "cells")) for i in kept]
    points = mesh_array(source.points, "points")
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points have the shape {points.shape}; give (points, 3)")
    return Grid(
        points,
        numpy.repeat([_NUMBERS[kind] for kind, _ in blocks], [len(nodes) for _, nodes in blocks]),
        numpy.concatenate([nodes.ravel() for _, nodes in blocks]),
        numpy.cumsum(
            numpy.concatenate([numpy.full(len(nodes), nodes.shape[1]) for _, nodes in blocks])
        ),
        source.point_data,
        {
            name: numpy.concatenate([field_array(values[i]) for i in kept])
            for name, values in source.cell_data.items()
        },
    )

"""A log's present mesh for meshio, PyVista and xarray, where they are installed."""
from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Iterable

import numpy

from .arrays import Arrays, field_of
from .library import CELL, POINT, QtetError
from .log import Log, is_called, keys_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["to_meshio", "to_pyvista", "to_xarray"]


def _package(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"the package {name} is needed: pip install {name}") from error


def to_meshio(arrays: Arrays) -> Any:
    return _package("meshio").Mesh(
        arrays.points,
        [("tetra", arrays.cells)],
        arrays.point_data,
        {name: [values] for name, values in arrays.cell_data.items()},
    )


def to_pyvista(log: Log, *fields: Any, **choice: Any) -> Any:
    pyvista = _package("pyvista")
    from .vtk import grid_of

    return pyvista.wrap(grid_of(log, *fields, **choice))


def _over_time(log: Log, instants: dict[float, int]) -> NDArray[Any]:
    """(times, n, ...): NaN at a time that the series does not have."""
    known = {time: field_of(log, number) for time, number in instants.items()}
    some = next(iter(known.values()))
    if len(known) == len(log.times):
        return numpy.stack([known[time] for time in log.times])
    none = numpy.full(some.shape, numpy.nan)
    return numpy.stack([known.get(time, none) for time in log.times])


def _quantities(log: Log) -> dict[tuple[int, str], dict[float, int] | int]:
    """By association and name: a field's number, or those of a series by time."""
    out: dict[tuple[int, str], dict[float, int] | int] = {}
    for number, info in enumerate(log.fields):
        if number not in log.times_of_fields:
            out[info.association, info.name] = number
    for series in log.all_series:
        key = (series.association, series.name)
        # As in files that are extracted: a field keeps its name.
        name = (key[0], key[1] + "@") if key in out else key
        out[name] = dict(zip(series.times, series.fields))
    return out


def to_xarray(log: Log, fields: str | Iterable[str] | None = None) -> Any:
    xarray, arrays = _package("xarray"), log.arrays([])
    keys = None if fields is None else keys_of(fields)
    variables: dict[str, Any] = {
        "points": (("point", "axis"), arrays.points),
        "cells": (("cell", "corner"), arrays.cells),
        "boundary": (("triangle", "side"), arrays.boundary),
    }
    found = {
        key: numbers
        for key, numbers in _quantities(log).items()
        if keys is None or any(is_called(*key, asked) for asked in keys)
    }
    unknown = [k for k in keys or () if not any(is_called(*key, k) for key in found)]
    if unknown:
        raise QtetError(f"the log has no field {unknown}; it has {log.field_names}")
    for (association, name), numbers in found.items():
        is_series = isinstance(numbers, dict)
        values = _over_time(log, numbers) if isinstance(numbers, dict) else field_of(log, numbers)
        dimensions = (*(["time"] if is_series else []), ("point", "cell")[association])
        if values.ndim > len(dimensions):
            dimensions = (*dimensions, f"{name}_component")
        is_taken = name in variables or (association == CELL and (POINT, name) in found)
        variables[f"cell:{name}" if is_taken else name] = (dimensions, values)
    return xarray.Dataset(variables, coords={"time": log.times} if log.times else {})

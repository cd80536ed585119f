"""qtet logs from Python: what a log holds, and its mesh at any level. Standard library alone;
libqtet.so decodes (library.py).

    with Log("part.qtet") as log:
        log.refine(log.level_of_error("Density", 0.01))
        print(log.counts())

A source is a file, a log's bytes, a log's URL on any host, `http://host/v1/meshes/NAME` of a
qtet-server, or the address of its viewer (`http://host/?mesh=NAME`). Of a URL only the bytes that a
level needs are fetched, where the host answers Range requests."""
from __future__ import annotations

import ctypes
import json
import math
import operator
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Iterable, TypeVar

from .library import (
    CELL,
    POINT,
    CFieldInfo,
    CLevelInfo,
    CLogInfo,
    CSeriesInfo,
    FieldInfo,
    LevelInfo,
    LogInfo,
    QtetError,
    library,
    members_of,
)
from .sources import Remote, check_readable, log_url

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .arrays import Arrays

_u32, _u64, _f64 = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_double
_NO_LEVEL = 0xFFFFFFFF
# Times that differ by less than this of the larger are one (proto/series.h).
_NEAR_TIME = 1e-9
# As many times stand in an error.
_TOLD_TIMES = 20
_Opened = TypeVar("_Opened", bound="Log")


@dataclass(frozen=True)
class Series:
    """Fields NAME@TIME of one association, by time."""

    name: str
    association: int
    times: tuple[float, ...]
    fields: tuple[int, ...]

    def place(self, time: float, method: str | None) -> int | None:
        """The instant that is meant, the earlier of two; None: there is none at this time."""
        nearest = min(range(len(self.times)), key=lambda i: abs(self.times[i] - time))
        is_same = math.isclose(self.times[nearest], time, rel_tol=_NEAR_TIME)
        return nearest if is_same or method == "nearest" else None


def keys_of(fields: str | Iterable[str]) -> list[str]:
    """A str is one name."""
    keys = [fields] if isinstance(fields, str) else list(fields)
    if not all(isinstance(key, str) for key in keys):
        raise TypeError(f"fields are {fields!r}; give a name, or a list of names")
    return keys


def is_called(association: int, name: str, key: str) -> bool:
    return key in (name, ("point:", "cell:")[association] + name)


def _check_time(time: float | None, method: str | None) -> None:
    if method not in (None, "nearest"):
        raise ValueError(f"method {method!r} is not known; give 'nearest', or leave it out")
    if time is not None and not math.isfinite(time):
        raise ValueError(f"the time is {time}; give a finite number")


def _no_instant(what: str, time: float, times: Iterable[float]) -> KeyError:
    ascending = sorted(set(times))
    told = ", ".join(repr(t).removesuffix(".0") for t in ascending[:_TOLD_TIMES])
    if len(ascending) > _TOLD_TIMES:
        told += f" ... {ascending[-1]!r} ({len(ascending)} times)"
    return KeyError(
        f"{what} has nothing at the time {time}; its times are {told or 'none'}; "
        "method='nearest' takes the nearest"
    )


def _reopened(kind: type[_Opened], source: str | bytes, level: int | None) -> _Opened:
    log = kind(source)
    if level is not None:
        log.refine(level)
    return log


class Log:
    """One log, opened; close() or `with` gives its memory back. One thread at a time. Pickling and
    copying open it again, at the same level: a file by its path.

    source  the file's path, the URL, or the log's bytes
    info    what the log holds (LogInfo)
    fields  of each field what it is (FieldInfo), by its number
    series  {name: {time: field number}}, times ascending: two and more instants of one quantity;
            where points and cells share a name and a time, the points'
    all_series       the same, those of points and of cells apart (Series)
    times_of_fields  {field number: time} of the fields that are instants

    Raises OSError for a file that cannot be opened, QtetError for anything else."""

    def __init__(self, source: str | os.PathLike[str] | bytes | bytearray | memoryview) -> None:
        self.c = library()
        self._handle: ctypes.c_void_p | None = None
        self.remote: Remote | None = None
        self.source: str | bytes
        if isinstance(source, (bytes, bytearray, memoryview)):
            self.source = bytes(source)
        elif url := log_url(source):
            self.source, self.remote = str(source), Remote(url)
        else:
            check_readable(source)
            self.source = os.path.abspath(os.fspath(source))
        self._open()

    def __enter__(self: _Opened) -> _Opened:
        _ = self.handle  # raises where it is closed
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def __reduce__(self) -> tuple[Any, ...]:
        return _reopened, (type(self), self.source, self.level)

    def __repr__(self) -> str:
        name = f"{len(self.source)} bytes" if isinstance(self.source, bytes) else self.source
        if self._handle is None:
            return f"<qtet.Log {name}, closed>"
        at = "not refined" if self.level is None else f"at level {self.level}"
        names = {n: f"{s.name} ({len(s.times)} times)" for s in self.all_series for n in s.fields}
        told = dict.fromkeys(names.get(i, field.name) for i, field in enumerate(self.fields))
        fields = ", ".join(told) or "none"
        return f"<qtet.Log {name}: {self.info.levels} levels, {at}, fields: {fields}>"

    def close(self) -> None:
        if getattr(self, "_handle", None):
            self.c.qtet_log_destroy(self._handle)
            self._handle = None

    @property
    def handle(self) -> ctypes.c_void_p:
        """For the functions of qtet.h."""
        if self._handle is None:
            raise QtetError("the log is closed; open it again")
        return self._handle

    def _open(self) -> None:
        self.close()
        self._handle = ctypes.c_void_p(self.c.qtet_log_create()) or None
        if self._handle is None:
            raise MemoryError("no memory for a log")
        try:
            if isinstance(self.source, bytes):
                size = ctypes.c_size_t(len(self.source))
                status = self.c.qtet_log_open_memory(self.handle, size, self.source)
            else:
                path = self.remote.file.name if self.remote else self.source
                status = self.c.qtet_log_open_file(self.handle, os.fsencode(path))
            self.check(status)
            self.info = LogInfo(**self._struct(CLogInfo, self.c.qtet_log_get_info))
            self.fields = [self._field_info(f) for f in range(self.info.fields)]
            count = self.c.qtet_log_series_count(self.handle)
            self.all_series = [self._one_series(s) for s in range(count)]
        except BaseException:
            self.close()
            raise
        self.times_of_fields = {f: t for s in self.all_series for f, t in zip(s.fields, s.times)}
        self.series: dict[str, dict[float, int]] = {}
        for s in sorted(self.all_series, key=lambda s: s.association):
            instants = self.series.setdefault(s.name, {})
            for time, number in zip(s.times, s.fields):
                instants.setdefault(time, number)
        for name, instants in self.series.items():
            self.series[name] = dict(sorted(instants.items()))

    def check(self, status: int) -> None:
        if status != 0:
            raise QtetError(self.c.text_at(self.c.qtet_log_error(self.handle)))

    def _struct(
        self, kind: type[ctypes.Structure], function: Callable[..., Any], *arguments: Any
    ) -> dict[str, Any]:
        out = kind()
        self.check(
            function(
                self.handle, *arguments, ctypes.c_size_t(ctypes.sizeof(kind)), ctypes.pointer(out)
            )
        )
        return members_of(self.c, out)

    def _field_info(self, field: int) -> FieldInfo:
        members = self._struct(CFieldInfo, self.c.qtet_log_get_field, _u32(field))
        members["minimum"] = members["minimum"][: members["components"]]
        names = members["labels"]
        members["labels"] = (
            {int(value): name for value, name in json.loads(names).items()} if names else None
        )
        return FieldInfo(**members)

    def _one_series(self, series: int) -> Series:
        info = self._struct(CSeriesInfo, self.c.qtet_log_get_series, _u32(series))
        count = info["instants"]
        times, fields = (_f64 * count)(), (_u32 * count)()
        size = ctypes.c_size_t(count)
        self.check(self.c.qtet_log_copy_series(self.handle, _u32(series), size, times, fields))
        return Series(info["name"], info["association"], tuple(times), tuple(fields))

    def _level(self, function: Callable[..., Any], *arguments: Any) -> int:
        level = (_u32 * 1)()
        self.check(function(self.handle, *arguments, level))
        return level[0]

    def _known_level(self, level: int) -> int:
        number = operator.index(level)
        if not 0 <= number <= self.last_level:
            raise QtetError(f"there is no level {level}; the last is {self.last_level}")
        return number

    @property
    def last_level(self) -> int:
        return self.info.levels - 1

    @property
    def level(self) -> int | None:
        """The mesh's level; None before refine()."""
        level: int = self.c.qtet_log_level(self.handle)
        return None if level == _NO_LEVEL else level

    def level_info(self, level: int) -> LevelInfo:
        number = _u32(self._known_level(level))
        members = self._struct(CLevelInfo, self.c.qtet_log_get_level, number)
        return LevelInfo(**{**members, "hasError": bool(members["hasError"])})

    def level_of_tetrahedra(self, most: float) -> int:
        """The finest level of at most so many tetrahedra; 0 if there is none."""
        if not 0 <= most < 2**64:
            raise ValueError(f"{most} tetrahedra; give a number of 0 or above")
        return self._level(self.c.qtet_log_level_of_tetrahedra, _u64(int(most)))

    def level_of_error(self, field: str, bound: float) -> int:
        """The coarsest level at which a field's rms error is at most `bound` of its range (a
        label's share of the volume); of a series: at every instant. Field "boundary": the distance,
        of the diagonal."""
        if field == "boundary":
            return self._level(self.c.qtet_log_level_of_boundary_error, _f64(bound))
        instants = [n for s in self._called(field) for n in s.fields]
        numbers = instants or [self._level(self.c.qtet_log_find_field, field.encode())]
        return max(
            self._level(self.c.qtet_log_level_of_field_error, _u32(number), _f64(bound))
            for number in numbers
        )

    @property
    def field_names(self) -> list[str]:
        return [info.name for info in self.fields]

    @property
    def times(self) -> list[float]:
        """The instants of all series, each time once, ascending; [] without a series."""
        return sorted(set(self.times_of_fields.values()))

    def _called(self, key: str) -> list[Series]:
        return [s for s in self.all_series if is_called(s.association, s.name, key)]

    def _shown(self, time: float, method: str | None) -> dict[int, str]:
        """{number: name} of the fields without time, and of each series' instant at this time,
        which keeps its own name where a field has that of the series."""
        out = {n: f.name for n, f in enumerate(self.fields) if n not in self.times_of_fields}
        taken = {(self.fields[n].association, name) for n, name in out.items()}
        for s in self.all_series:
            place = s.place(time, method)
            if place is not None:
                number = s.fields[place]
                is_taken = (s.association, s.name) in taken
                out[number] = self.fields[number].name if is_taken else s.name
        return out

    def fields_of(
        self,
        fields: str | Iterable[str] | None = None,
        time: float | None = None,
        method: str | None = None,
    ) -> list[tuple[int, str, FieldInfo]]:
        """[(number, name, FieldInfo)] of the fields with these names; None: of all. NAME means
        fields of points and of cells, "point:NAME" and "cell:NAME" one of them. With a time a
        series is one field, called by its name: its instant at exactly this time (but for 1e-9 of
        it), or with method="nearest" the nearest, the earlier of two.

        Raises QtetError for a name that the log does not have, KeyError for a time at which nothing
        is, ValueError for a time that is no finite number."""
        _check_time(time, method)
        keys = None if fields is None else keys_of(fields)
        found = dict(enumerate(self.field_names)) if time is None else self._shown(time, method)
        out = [
            (number, name, info)
            for number, name in sorted(found.items())
            for info in [self.fields[number]]
            if keys is None or any(is_called(info.association, name, key) for key in keys)
        ]
        if keys is None:
            if time is not None and not any(number in self.times_of_fields for number in found):
                raise _no_instant("the log", time, self.times)
            return out
        unknown = {k for k in keys if not any(is_called(i.association, n, k) for _, n, i in out)}
        for key in sorted(unknown):
            if time is not None and self._called(key):
                times = (t for s in self._called(key) for t in s.times)
                raise _no_instant(f"the series {key!r}", time, times)
        if unknown:
            asked = [] if time is not None else [f"{name} (give a time)" for name in self.series]
            known = {*found.values(), *asked, *(() if time is None else self.series)}
            raise QtetError(f"the log has no field {sorted(unknown)}; it has {sorted(known)}")
        return out

    def refine(self, level: int) -> int:
        """Makes the mesh that of a level, after fetching what is missing of it."""
        number = self._known_level(level)
        if self.remote and self.remote.need(self.level_info(number).prefixBytes):
            # Reopens the file: the library must not see a change of a file that it has open.
            self._open()
        self.check(self.c.qtet_log_refine(self.handle, _u32(number)))
        return number

    def counts(self) -> tuple[int, int, int]:
        """(vertices, tetrahedra, boundary triangles) of the mesh. Raises QtetError before refine()
        and after close()."""
        if self.level is None:
            raise QtetError("there is no mesh yet; call refine(level) first")
        c = self.c
        return (
            c.qtet_log_vertex_count(self.handle),
            c.qtet_log_tetrahedron_count(self.handle),
            c.qtet_log_boundary_count(self.handle),
        )

    def arrays(
        self,
        fields: str | Iterable[str] | None = None,
        time: float | None = None,
        method: str | None = None,
    ) -> Arrays:
        """The mesh as numpy arrays (arrays.Arrays): points, cells, boundary, point_data, cell_data.
        Arguments and exceptions as those of fields_of(); before refine() a QtetError."""
        from .arrays import arrays_of

        return arrays_of(self, fields, time, method)

    def field(
        self, name: str, time: float | None = None, method: str | None = None
    ) -> NDArray[Any]:
        """One field's values on the present mesh as a numpy array: (n,) or (n, components). Where
        points and cells share a name, the points'. Arguments and exceptions as arrays()."""
        from .arrays import field_of

        self.counts()

        def order(found: tuple[int, str, FieldInfo]) -> tuple[float, int]:
            number, _, info = found
            off = 0.0 if time is None else abs(self.times_of_fields.get(number, time) - time)
            return off, info.association

        return field_of(self, min(self.fields_of(keys_of(name), time, method), key=order)[0])

    def to_meshio(self, *fields: Any, **choice: Any) -> Any:
        """The present mesh as a meshio.Mesh; arguments as those of arrays()."""
        from .exports import to_meshio

        return to_meshio(self.arrays(*fields, **choice))

    def to_pyvista(self, *fields: Any, **choice: Any) -> Any:
        """The present mesh as a pyvista.UnstructuredGrid; arguments as those of arrays()."""
        from .exports import to_pyvista

        return to_pyvista(self, *fields, **choice)

    def to_xarray(self, fields: str | Iterable[str] | None = None) -> Any:
        """The present mesh as an xarray.Dataset; a series of one kind has the dimension `time`."""
        from .exports import to_xarray

        return to_xarray(self, fields)

    def copy_points(self, target: Any, count: int, is_double: bool) -> None:
        """Writes 3 numbers a vertex to `target`, an array of ctypes or its address."""
        function = (
            self.c.qtet_log_copy_points_double if is_double else self.c.qtet_log_copy_points_float
        )
        self.check(function(self.handle, ctypes.c_size_t(count), target))

    def field_count(self, field: int) -> int:
        count: int = self.c.qtet_log_field_count(self.handle, _u32(field))
        return count

    def copy_field(self, field: int, target: Any, count: int, is_double: bool) -> None:
        """Writes a field's values to `target`, as copy_points(); NaN where one is missing."""
        function = (
            self.c.qtet_log_copy_field_double if is_double else self.c.qtet_log_copy_field_float
        )
        self.check(function(self.handle, _u32(field), ctypes.c_size_t(count), target))

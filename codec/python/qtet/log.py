"""qtet logs from Python: what a log holds, and which bytes of it a level needs. Standard library
alone; libqtet.so decodes (codec/api/qtet.h).

    with Log("part.qtet") as log:
        log.refine(log.level_of_error("Density", 0.01))
        print(log.counts())

A source is a file, a log's URL on any host, `http://host/v1/meshes/NAME` of a qtet-server, or the
address of its viewer (`http://host/?mesh=NAME`). Of a URL only the bytes that a level needs are
fetched, where the host answers Range requests."""
from __future__ import annotations

import ctypes
import ctypes.util
import errno
import os
import pathlib
import re
import struct
import tempfile
import urllib.error
import urllib.parse
import urllib.request
from dataclasses import dataclass
from typing import Any

_u32, _u64, _f64, _text = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_double, ctypes.c_char_p
_HEADER_BYTES = 64  # FORMAT.md, "Header"
_MAGIC = b"\x89QTET\r\n\x1a"
_TIMEOUT_S = 60
_PIECE_BYTES = 1 << 20  # read from the network at a time
POINT, CELL = 0, 1
# An instant of a series is called NAME@TIME (RECORDS.md, "Series").
_INSTANT = re.compile(r"(?s)(.+)@(-?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)")


class QtetError(RuntimeError):
    """What went wrong, where, and what to do, in the words of the library."""


class _CLogInfo(ctypes.Structure):
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
        ("digest", _text),
        ("source", _text),
        ("generator", _text),
    ]


class _CFieldInfo(ctypes.Structure):
    _fields_ = [
        ("components", _u32),
        ("association", _u32),
        ("bits", _u32),
        ("reserved", _u32),
        ("step", _f64),
        ("minimum", _f64 * 16),
        ("range", _f64 * 2),
        ("bytes", _u64),
        ("name", _text),
        ("type", _text),
    ]


class _CLevelInfo(ctypes.Structure):
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


def _plain(value: Any) -> Any:
    """A member of a struct without the library's memory."""
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return tuple(value) if isinstance(value, ctypes.Array) else value


def _members(struct: ctypes.Structure) -> dict[str, Any]:
    names = (entry[0] for entry in struct._fields_)
    return {name: _plain(getattr(struct, name)) for name in names if name != "reserved"}


def _candidates():
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


_loaded = None


def library():
    """libqtet.so, loaded once."""
    global _loaded
    if _loaded is not None:
        return _loaded
    tried = []
    for name in _candidates():
        try:
            c = ctypes.CDLL(name)
        except OSError as error:
            tried.append(str(error))
            continue
        for function, result in (
            ("create", ctypes.c_void_p),
            ("error", _text),
            ("tetrahedra", ctypes.c_void_p),
            ("boundary", ctypes.c_void_p),
            ("lattice_points", ctypes.c_void_p),
            ("field_count", ctypes.c_size_t),
        ):
            getattr(c, "qtet_log_" + function).restype = result
        _loaded = c
        return c
    raise QtetError(
        "libqtet.so is not found ("
        + "; ".join(tried)
        + "); install libqtet0, or set QTET_LIBRARY to its path"
    )


def version():
    """That of libqtet.so: "0.3.0"."""
    text = library().qtet_version_text
    text.restype = _text
    return text().decode()


def check_output(path: str | os.PathLike[str]) -> None:
    """Refuses a place for a log before the work, as the program `qtet simplify` does, and a file
    that holds something else. Raises ValueError for another ending, and OSError."""
    file = pathlib.Path(path)
    if file.suffix != ".qtet":
        raise ValueError(f"the output {file} must end in .qtet")
    folder = file.resolve().parent
    if not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, "make the output's folder first", str(folder))
    if file.is_dir():
        raise IsADirectoryError(errno.EISDIR, "the output is a folder", str(file))
    if not os.access(folder, os.W_OK):
        raise PermissionError(errno.EACCES, "the output's folder cannot be written", str(folder))
    if file.exists():
        with file.open("rb") as old:
            if old.read(len(_MAGIC)) not in (_MAGIC, b""):
                raise FileExistsError(
                    errno.EEXIST, "the output is no log; choose another name", str(file)
                )


class _Remote:
    """A log behind a URL as a sparse file of which only the front is filled."""

    def __init__(self, url):
        self.url, self.tag, self.have = url, None, 0
        self.file = tempfile.NamedTemporaryFile(prefix="qtet-", suffix=".qtet")
        head = self._get(0, _HEADER_BYTES)
        if len(head) < _HEADER_BYTES or not head.startswith(_MAGIC):
            raise QtetError(
                f"{url} is no qtet log; give the URL of a .qtet file,"
                " or http://host/v1/meshes/NAME of a qtet-server"
            )
        self.bytes, manifest, table = struct.unpack_from("<QII", head, 16)
        self.file.truncate(max(self.bytes, self.have))
        self.need(_HEADER_BYTES + manifest + table)

    def need(self, end):
        """Whether bytes came: the front up to `end` is there afterwards."""
        end = min(end, self.bytes)
        if end <= self.have:
            return False
        self._get(self.have, end)
        return True

    def _get(self, first, end):
        """Writes the bytes [first, end) of the log to the file; the first ones of them are the
        answer."""
        request = urllib.request.Request(
            self.url, headers={"Range": f"bytes={first}-{end - 1}", "Accept-Encoding": "identity"}
        )
        try:
            with urllib.request.urlopen(request, timeout=_TIMEOUT_S) as answer:
                self._same_log(answer)
                return self._store(answer, first if answer.status == 206 else 0, end)
        except (urllib.error.URLError, OSError, ValueError) as error:
            raise QtetError(
                f"{self.url} cannot be fetched: {error}; is the server running, and the name right?"
            ) from error

    def _same_log(self, answer):
        tag = answer.headers.get("ETag")
        if self.tag is not None and tag != self.tag:
            raise QtetError(f"{self.url} was replaced by another log meanwhile; open it again")
        self.tag, self.url = tag, answer.geturl()  # behind a redirection lies one log for ever

    def _store(self, answer, at, end):
        start = b""
        self.file.seek(at)
        while piece := answer.read(_PIECE_BYTES):
            start = start or piece
            self.file.write(piece)
            at += len(piece)
        self.file.flush()
        if self.have and at < end:
            raise QtetError(
                f"{self.url} ended after {at} bytes, {end} were asked for; fetch it again"
            )
        self.have = max(self.have, at)
        return start


def _log_url(source):
    """The URL of the log's bytes, or None for a file."""
    parts = urllib.parse.urlsplit(str(source))
    if parts.scheme not in ("http", "https"):
        return None
    mesh = urllib.parse.parse_qs(parts.query).get("mesh")
    if mesh and not parts.path.startswith("/v1/"):
        folder = parts.path[: parts.path.rfind("/") + 1] or "/"
        parts = parts._replace(
            path=folder + "v1/meshes/" + urllib.parse.quote(mesh[0], safe=""), query="", fragment=""
        )
    if (
        "/v1/meshes/" in parts.path
        and parts.path.rpartition("/v1/meshes/")[2].strip("/").count("/") == 0
    ):
        parts = parts._replace(path=parts.path.rstrip("/") + "/log")
    return urllib.parse.urlunsplit(parts)


def _series_of(fields):
    """{name: {time: field number}}, times ascending: the series of two and more instants."""
    found = {}
    for number, info in enumerate(fields):
        parts = _INSTANT.fullmatch(info.name)
        if parts:
            kind = (parts[1], info.association, info.components, info.type)
            found.setdefault(kind, {}).setdefault(float(parts[2]), number)
    out = {}
    for (name, *_), instants in found.items():
        if len(instants) > 1:
            out.setdefault(name, dict(sorted(instants.items())))
    return out


class Log:
    """One log, opened; close() or `with` gives its memory back. One thread at a time."""

    def __init__(self, source):
        self.c = library()
        self.handle = None
        url = _log_url(source)
        self.remote = _Remote(url) if url else None
        self._open(self.remote.file.name if self.remote else source)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        self.close()

    def close(self):
        if getattr(self, "handle", None):
            self.c.qtet_log_destroy(self.handle)
            self.handle = None

    def _open(self, path):
        self.close()
        self.handle = ctypes.c_void_p(self.c.qtet_log_create())
        if not self.handle:
            raise MemoryError("no memory for a log")
        self.check(self.c.qtet_log_open_file(self.handle, os.fsencode(path)))
        self.info = LogInfo(**self._struct(_CLogInfo, self.c.qtet_log_get_info))
        self.fields = [self._field_info(f) for f in range(self.info.fields)]
        self.series = _series_of(self.fields)

    def check(self, status):
        if status != 0:
            raise QtetError(self.c.qtet_log_error(self.handle).decode(errors="replace"))

    def _struct(self, kind, function, *arguments):
        out = kind()
        self.check(
            function(
                self.handle, *arguments, ctypes.c_size_t(ctypes.sizeof(kind)), ctypes.byref(out)
            )
        )
        return _members(out)

    def _field_info(self, field):
        members = self._struct(_CFieldInfo, self.c.qtet_log_get_field, _u32(field))
        members["minimum"] = members["minimum"][: members["components"]]
        return FieldInfo(**members)

    def _level(self, function, *arguments):
        level = _u32()
        self.check(function(self.handle, *arguments, ctypes.byref(level)))
        return level.value

    @property
    def last_level(self):
        return self.info.levels - 1

    def level_info(self, level):
        members = self._struct(_CLevelInfo, self.c.qtet_log_get_level, _u32(level))
        return LevelInfo(**{**members, "hasError": bool(members["hasError"])})

    def level_of_tetrahedra(self, most):
        """The finest level of at most so many tetrahedra; 0 if there is none."""
        return self._level(self.c.qtet_log_level_of_tetrahedra, _u64(int(most)))

    def level_of_error(self, field, bound):
        """The coarsest level at which a field's rms error is at most `bound` of its range; of a
        series: at every instant. Field "boundary": the distance, of the diagonal."""
        if field == "boundary":
            return self._level(self.c.qtet_log_level_of_boundary_error, _f64(bound))
        if field in self.series:
            return max(
                self._level(self.c.qtet_log_level_of_field_error, _u32(number), _f64(bound))
                for number in self.series[field].values()
            )
        number = self._level(self.c.qtet_log_find_field, field.encode())
        return self._level(self.c.qtet_log_level_of_field_error, _u32(number), _f64(bound))

    @property
    def field_names(self):
        return [info.name for info in self.fields]

    @property
    def times(self):
        """The instants of all series, each time once, ascending; [] without a series."""
        return sorted({time for instants in self.series.values() for time in instants})

    def fields_of(self, names=None, time=None):
        """[(number, name, FieldInfo)] of the fields with these names; None: of all. With a time a
        series is one field, called by its name: the instant that is nearest, the earlier of two.
        Raises QtetError for a name that the log does not have."""
        found = dict(enumerate(self.field_names))
        if time is not None:
            for name, instants in self.series.items():
                shown = instants[min(instants, key=lambda t: (abs(t - time), t))]
                for number in instants.values():
                    found.pop(number)
                found[shown] = name
        unknown = sorted(set(names or ()) - set(found.values()))
        if unknown:
            asked = [] if time is not None else [f"{name} (give a time)" for name in self.series]
            raise QtetError(
                f"the log has no field {unknown}; it has {sorted({*found.values(), *asked})}"
            )
        return [
            (number, name, self.fields[number])
            for number, name in sorted(found.items())
            if names is None or name in names
        ]

    def refine(self, level):
        """Makes the mesh that of a level, after fetching what is missing of it."""
        if not 0 <= level <= self.last_level:
            raise QtetError(f"there is no level {level}; the last is {self.last_level}")
        if self.remote and self.remote.need(self.level_info(level).prefixBytes):
            # Reopens the file: the library must not see a change of a file that it has open.
            self._open(self.remote.file.name)
        self.check(self.c.qtet_log_refine(self.handle, _u32(level)))
        return level

    def counts(self):
        """(vertices, tetrahedra, boundary triangles) of the mesh."""
        c = self.c
        return (
            c.qtet_log_vertex_count(self.handle),
            c.qtet_log_tetrahedron_count(self.handle),
            c.qtet_log_boundary_count(self.handle),
        )

    def arrays(self, fields=None, time=None):
        """The mesh as numpy arrays (arrays.Arrays): points, cells, boundary, point_data, cell_data.
        `fields`: the names of those that are wanted; None: all. `time`: series at this time alone,
        by their names."""
        from .arrays import arrays_of

        return arrays_of(self, fields, time)

    def field(self, name, time=None):
        """One field's values on the present mesh as a numpy array: (n,) or (n, components)."""
        from .arrays import field_of

        return field_of(self, self.fields_of([name], time)[0][0])

    def copy_points(self, target, count, is_double):
        """Writes 3 numbers a vertex to ctypes' `target`."""
        function = (
            self.c.qtet_log_copy_points_double if is_double else self.c.qtet_log_copy_points_float
        )
        self.check(function(self.handle, ctypes.c_size_t(count), target))

    def field_count(self, field):
        return self.c.qtet_log_field_count(self.handle, _u32(field))

    def copy_field(self, field, target, count, is_double):
        """Writes a field's values to ctypes' `target`; NaN where one is missing."""
        function = (
            self.c.qtet_log_copy_field_double if is_double else self.c.qtet_log_copy_field_float
        )
        self.check(function(self.handle, _u32(field), ctypes.c_size_t(count), target))

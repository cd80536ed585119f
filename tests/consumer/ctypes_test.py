"""libqtet.so through ctypes, compared array by array with what `qtet extract` writes.
   ctypes_test.py LIBRARY QTET-PROGRAM FOLDER-OF-LOGS FOLDER-TO-WRITE-TO"""
import array
import ctypes
import pathlib
import subprocess
import sys

import vtu

FULL = 0xFFFFFFFF
u32, u64, f64 = ctypes.c_uint32, ctypes.c_uint64, ctypes.c_double


class LogInfo(ctypes.Structure):
    _fields_ = [
        ("versionMajor", u32),
        ("versionMinor", u32),
        ("bytes", u64),
        ("chunks", u32),
        ("levels", u32),
        ("fields", u32),
        ("latticeBits", u32),
        ("latticeStep", f64),
        ("latticeOrigin", f64 * 3),
        ("digest", ctypes.c_char_p),
        ("source", ctypes.c_char_p),
        ("generator", ctypes.c_char_p),
    ]


class FieldInfo(ctypes.Structure):
    _fields_ = [
        ("components", u32),
        ("association", u32),
        ("bits", u32),
        ("baseCells", u32),
        ("step", f64),
        ("minimum", f64 * 16),
        ("range", f64 * 2),
        ("bytes", u64),
        ("name", ctypes.c_char_p),
        ("type", ctypes.c_char_p),
    ]


class Log:
    def __init__(self, library, path):
        self.c = library
        self.c.qtet_log_create.restype = ctypes.c_void_p
        self.c.qtet_log_error.restype = ctypes.c_char_p
        self.c.qtet_log_tetrahedra.restype = ctypes.POINTER(u32)
        self.c.qtet_log_field_count.restype = ctypes.c_size_t
        self.handle = ctypes.c_void_p(self.c.qtet_log_create())
        self.check(self.c.qtet_log_open_file(self.handle, str(path).encode()))
        self.info = LogInfo()
        self.check(
            self.c.qtet_log_get_info(
                self.handle, ctypes.c_size_t(ctypes.sizeof(LogInfo)), ctypes.byref(self.info)
            )
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.c.qtet_log_destroy(self.handle)

    def check(self, status):
        if status != 0:
            raise RuntimeError(self.c.qtet_log_error(self.handle).decode())

    def refine(self, level):
        self.check(self.c.qtet_log_refine(self.handle, u32(level)))

    def copied(self, letter, count, function, *arguments):
        out = array.array(letter, bytes(count * array.array(letter).itemsize))
        address = ctypes.c_void_p(out.buffer_info()[0])
        self.check(function(self.handle, *arguments, ctypes.c_size_t(count), address))
        return out

    def points(self, letter):
        function = {
            "f": self.c.qtet_log_copy_points_float,
            "d": self.c.qtet_log_copy_points_double,
        }[letter]
        return self.copied(letter, 3 * self.c.qtet_log_vertex_count(self.handle), function)

    def tetrahedra(self):
        return self.c.qtet_log_tetrahedra(self.handle)[
            : 4 * self.c.qtet_log_tetrahedron_count(self.handle)
        ]

    def fields(self):
        """(name, kind, components, values), those of points first, as in a .vtu."""
        out = []
        for f in range(self.info.fields):
            field = FieldInfo()
            self.check(
                self.c.qtet_log_get_field(
                    self.handle,
                    u32(f),
                    ctypes.c_size_t(ctypes.sizeof(FieldInfo)),
                    ctypes.byref(field),
                )
            )
            count = self.c.qtet_log_field_count(self.handle, u32(f))
            letter, function = (
                ("f", self.c.qtet_log_copy_field_float)
                if field.type == b"float32"
                else ("d", self.c.qtet_log_copy_field_double)
            )
            values = self.copied(letter, count, function, u32(f))
            out.append(
                (
                    field.name.decode(),
                    ("PointData", "CellData")[field.association],
                    field.components,
                    list(values),
                )
            )
        return sorted(out, key=lambda field: field[1] == "CellData")


def same(a, b):
    """Equal, where a missing value, which is NaN, equals a missing value."""
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b or (a != a and b != b)


def compare(log, level, mesh):
    assert list(log.points(mesh.point_type)) == list(mesh.points), f"points of level {level}"
    assert log.tetrahedra() == list(mesh.tetrahedra), f"tetrahedra of level {level}"
    extracted = [
        (name, kind, components, list(values)) for name, kind, components, _, values in mesh.fields
    ]
    assert same(log.fields(), extracted), f"fields of level {level}"


def main(library, program, logs, out):
    c = ctypes.CDLL(library)
    c.qtet_version_text.restype = ctypes.c_char_p
    print("libqtet", c.qtet_version_text().decode(), hex(c.qtet_version()))
    compared = 0
    for path in sorted(pathlib.Path(logs).glob("*.qtet")):
        with Log(c, path) as log:
            # Backwards and forwards again: the mesh must not remember where it was.
            # If a log keeps its input, extract returns the input itself at the last level, but the
            # library the mesh on the lattice.
            keepsInput = path.stem in ("kept-input", "original-cells")
            last = [] if keepsInput else [log.info.levels - 1]
            for level in [*last, 2, 3, 0]:
                if level >= log.info.levels:  # some logs have one level
                    continue
                extracted = pathlib.Path(out) / "ctypes.vtu"
                subprocess.run(
                    [program, "extract", path, "--level", str(level), "-o", extracted],
                    check=True,
                    stdout=subprocess.DEVNULL,
                )
                log.refine(level)
                compare(log, level, vtu.Vtu(extracted))
                compared += 1
            try:
                log.refine(log.info.levels)
                raise AssertionError("a level behind the last was accepted")
            except RuntimeError as error:
                assert str(error).startswith("not-found: there is no level"), error
            log.refine(FULL)
    assert compared >= 12, f"only {compared} levels compared"
    print(f"{compared} levels are what qtet extract writes")


if __name__ == "__main__":
    main(*sys.argv[1:])

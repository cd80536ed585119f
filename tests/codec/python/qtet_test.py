"""qtet.simplify: logs as the tool makes them, every wrong argument an exception, Ctrl-C.
   qtet_test.py LIBRARY QTET-PROGRAM MODULES FOLDER-TO-WRITE-TO; ends with 77 without numpy."""
import copy
import dataclasses
import importlib
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

library, program, modules, out = sys.argv[1:]
os.environ["QTET_LIBRARY"] = library
sys.path.insert(0, modules)
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
try:
    import numpy
    import qtet
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

OUT = pathlib.Path(out)
OUT.mkdir(parents=True, exist_ok=True)
_KUHN = [(0, 1, 3, 7), (0, 1, 7, 5), (0, 5, 7, 4), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7)]


def grid(n):
    """A cube of n^3 cells, six tetrahedra each, and fields of every association and shape."""
    ticks = numpy.arange(n + 1)
    z, y, x = (a.ravel() for a in numpy.meshgrid(ticks, ticks, ticks, indexing="ij"))
    points = numpy.stack([x, y, z], axis=1) / n
    corner = (x + (n + 1) * (y + (n + 1) * z))[(x < n) & (y < n) & (z < n)]
    steps = numpy.array(
        [dx + (n + 1) * (dy + (n + 1) * dz) for dz in (0, 1) for dy in (0, 1) for dx in (0, 1)]
    )
    cells = (corner[:, None, None] + steps[numpy.array(_KUHN)]).reshape(-1, 4)
    heat = numpy.sin(3 * points[:, 0]) * points[:, 1] + points[:, 2] ** 2
    middle = points[cells].mean(axis=1)
    return (
        points,
        cells,
        {"Heat": heat.astype("float32"), "Swirl": (points - 0.5)[:, [1, 0, 2]]},
        {"Region": (middle[:, 0] * 3).astype("int16"), "Height": middle[:, 2]},
    )


def write_vtu(path, points, cells, point_data, cell_data):
    """The mesh as a plain .vtu, so that the tool reads what Python has."""
    names = {
        "float32": "Float32",
        "float64": "Float64",
        "int16": "Int16",
        "int64": "Int64",
        "uint8": "UInt8",
    }

    def array(name, values):
        flat = values.reshape(len(values), -1)
        text = " ".join(
            numpy.format_float_scientific(v, unique=True) if values.dtype.kind == "f" else str(v)
            for v in flat.ravel()
        )
        return (
            f'<DataArray type="{names[values.dtype.name]}" Name="{name}" format="ascii" '
            f'NumberOfComponents="{flat.shape[1]}">{text}</DataArray>'
        )

    count = len(cells)
    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        f'header_type="UInt64"><UnstructuredGrid><Piece NumberOfPoints="{len(points)}" '
        f'NumberOfCells="{count}"><Points>{array("Points", points)}</Points><Cells>'
        + array("connectivity", cells.astype("int64").reshape(-1))
        + array("offsets", 4 * numpy.arange(1, count + 1))
        + array("types", numpy.full(count, 10, dtype="uint8"))
        + "</Cells><PointData>"
        + "".join(array(n, v) for n, v in point_data.items())
        + "</PointData><CellData>"
        + "".join(array(n, v) for n, v in cell_data.items())
        + "</CellData></Piece></UnstructuredGrid></VTKFile>"
    )


def refused(kind, word, call):
    try:
        call()
    except kind as error:
        assert word in str(error), error
        return
    raise AssertionError(f"accepted; expected {kind.__name__} with '{word}'")


def logs_are_the_tools():
    points, cells, point_data, cell_data = grid(6)
    vtu, log = OUT / "grid.vtu", OUT / "grid.qtet"
    write_vtu(vtu, points, cells, point_data, cell_data)
    for words, options in (
        ("", {}),
        (
            "--target-ratio 0.2 --field-weight Heat=3 --label-weight Region=5 "
            "--preserve-regions Region --threads 2 "
            "--boundary-weight 9 --shape-weight 0.2 --envelope-tolerance 0.01 --field-bits 10 "
            "--position-bits 18 --placement optimal",
            {
                "target_ratio": 0.2,
                "field_weights": {"Heat": 3},
                "label_weights": {"Region": 5},
                "regions": "Region",
                "threads": 2,
                "boundary_weight": 9,
                "shape_weight": 0.2,
                "envelope_tolerance": 0.01,
                "field_bits": 10,
                "position_bits": 18,
                "placement": "optimal",
            },
        ),
        (
            "--lossless --keep-order --value-codec adaptive --measure all "
            "--max-boundary-error 0.1 --max-field-error Heat=0.1",
            {
                "lossless": True,
                "keep_order": True,
                "value_codec": "adaptive",
                "measure": "all",
                "max_boundary_error": 0.1,
                "max_field_errors": {"Heat": 0.1},
            },
        ),
        ("--algorithm paper", {"algorithm": "paper"}),
        ("--base-cells 300", {"base_cells": 300}),
        ("--base-error 0.02", {"base_error": 0.02}),
        ("--error Heat=0.01 --error all=0.5%", {"errors": {"Heat": 0.01, "all": "0.5%"}}),
    ):
        subprocess.run([program, "simplify", vtu, "-o", log, "-q", *words.split()], check=True)
        made = qtet.simplify(points, cells, point_data, cell_data, source="grid.vtu", **options)
        assert made == log.read_bytes(), words
    path = OUT / "made.qtet"
    assert qtet.simplify(points, cells, point_data, cell_data, path=path) is path
    with qtet.Log(path) as opened:
        opened.refine(opened.last_level)
        assert opened.counts()[:2] == (len(points), len(cells))


def shapes_and_types_do_not_matter():
    points, cells, _, _ = grid(3)
    tensor = numpy.arange(len(points) * 9).reshape(-1, 3, 3)
    expected = qtet.simplify(points, cells, {"T": tensor.reshape(-1, 9)}, {"Flag": cells[:, 0] % 2})
    big = points.astype(">f8")
    odd = numpy.zeros((len(cells), 8), dtype="int64")[:, ::2]
    odd[:] = cells
    flag = cells[:, 0] % 2
    for same_points, same_cells in (
        (points.tolist(), cells.tolist()),
        (big, odd),
        (numpy.asfortranarray(points), cells.astype("uint16")),
    ):
        assert qtet.simplify(same_points, same_cells, {"T": tensor}, {"Flag": flag}) == expected
    flags = qtet.simplify(points, cells, None, {"Flag": cells[:, 0] % 2 == 1})
    assert flags == qtet.simplify(points, cells, None, {"Flag": (cells[:, 0] % 2).astype("uint8")})


def a_mask_is_missing_values():
    points, cells, point_data, cell_data = grid(3)
    heat, part = point_data["Heat"], cell_data["Region"]
    hidden, gone = heat < 0.3, part == 1
    filled = numpy.where(hidden, numpy.float32(9.96921e36), heat)
    masked = numpy.ma.array(filled, mask=hidden)
    parts = numpy.ma.array(part, mask=gone)
    with_nan = {"Heat": numpy.where(hidden, numpy.float32("nan"), heat)}
    part_nan = {"Part": numpy.where(gone, numpy.nan, part)}
    expected = qtet.simplify(points, cells, with_nan, part_nan)
    assert qtet.simplify(points, cells, {"Heat": masked}, {"Part": parts}) == expected
    mesh = Mesh(points, cells, {"Heat": masked}, {"Part": parts})
    assert qtet.simplify(mesh) == expected
    rows = [numpy.ma.array(points[i], mask=hidden[i]) for i in range(len(points))]
    table = numpy.where(hidden[:, None], numpy.nan, points)
    assert qtet.simplify(points, cells, {"P": rows}) == qtet.simplify(points, cells, {"P": table})
    bare = numpy.ma.array(part, mask=False)
    whole = qtet.simplify(points, cells, None, {"Part": part})
    assert qtet.simplify(points, cells, None, {"Part": bare}) == whole
    steps = [Mesh(points, cells, {}, {"Part": values}) for values in (parts, bare)]
    qtet.simplify(steps, times=[0, 1], path=OUT / "masked.qtet")
    with qtet.open(OUT / "masked.qtet") as log:
        assert log.times == [0, 1] and {f.type for f in log.fields} == {"float64"}, log.fields
    some = numpy.ma.array(points, mask=numpy.repeat(hidden[:, None], 3, axis=1))
    few = numpy.ma.array(cells, mask=numpy.repeat(gone[:, None], 4, axis=1))
    for grid_or_points, others in (
        (some, (cells,)),
        (list(some), (cells,)),
        (points, (few,)),
        (Mesh(some, cells, {}, {}), ()),
        (Mesh(points, few, {}, {}), ()),
    ):
        refused(ValueError, "are masked", lambda: qtet.simplify(grid_or_points, *others))


def what_is_wrong_is_an_exception():
    points, cells, point_data, cell_data = grid(3)
    refused(ValueError, "(points, 3)", lambda: qtet.simplify(points[:, :2], cells))
    refused(ValueError, "(cells, 4)", lambda: qtet.simplify(points, cells[:, :3]))
    refused(ValueError, "(cells, 4)", lambda: qtet.simplify(points, cells.astype("float64")))
    refused(ValueError, "complex", lambda: qtet.simplify(points * 1j, cells))
    refused(ValueError, "'Heat'", lambda: qtet.simplify(points, cells, {"Heat": points[1:]}))
    refused(ValueError, "'Heat'", lambda: qtet.simplify(points, cells, {"Heat": 1.0}))
    refused(
        ValueError,
        "'Heat'",
        lambda: qtet.simplify(points, cells, {"Heat": numpy.zeros((len(points), 17))}),
    )
    refused(ValueError, "placement 'best'", lambda: qtet.simplify(points, cells, placement="best"))
    refused(TypeError, "ratio", lambda: qtet.simplify(points, cells, ratio=1))
    refused(
        qtet.QtetError,
        "bad-input: tetrahedron 0 names a point",
        lambda: qtet.simplify(points, cells - 1),
    )
    refused(qtet.QtetError, "not finite", lambda: qtet.simplify(points * numpy.nan, cells))
    refused(
        qtet.QtetError,
        "not-found: ",
        lambda: qtet.simplify(points, cells, field_weights={"Heat": 1}),
    )
    refused(qtet.QtetError, "0..1", lambda: qtet.simplify(points, cells, target_ratio=2))


def only_a_log_is_overwritten():
    points, cells, _, _ = grid(2)
    (OUT / "folder.qtet").mkdir(exist_ok=True)
    (OUT / "link.qtet").unlink(missing_ok=True)
    (OUT / "link.qtet").symlink_to("mesh.vtu")
    for name in ("mesh.vtu", "mesh.qtet"):
        (OUT / name).write_text("<VTKFile>")
    mixed = Mesh(points, cells, {}, {})
    mixed.cells.append(Block("pyramid", numpy.array([[0, 1, 4, 3, 9]])))
    for arguments in ((points, cells), (Mesh(points, cells, {}, {}),), (mixed,)):
        for name, kind, word in (
            ("mesh.vtu", ValueError, "must end in .qtet"),
            ("mesh", ValueError, "must end in .qtet"),
            ("mesh.qtet", FileExistsError, "no log"),
            ("link.qtet", FileExistsError, "no log"),
            ("folder.qtet", IsADirectoryError, "folder.qtet"),
            ("no/log.qtet", FileNotFoundError, "folder first"),
        ):
            refused(kind, word, lambda: qtet.simplify(*arguments, path=OUT / name))
    assert (OUT / "mesh.vtu").read_text() == (OUT / "mesh.qtet").read_text() == "<VTKFile>"
    log = OUT / "again.qtet"
    log.write_bytes(b"")
    for _ in range(2):
        assert qtet.simplify(points, cells, path=str(log)) == str(log)


def what_a_log_holds_outlives_it():
    points, cells, point_data, cell_data = grid(3)
    paths = [OUT / f"{name}.qtet" for name in "abc"]
    for path in paths:
        qtet.simplify(points, cells, point_data, cell_data, source=path.name, path=path)
    infos = [qtet.open(path).info for path in paths]
    assert [info.source for info in infos] == ["a.qtet", "b.qtet", "c.qtet"], infos
    assert all(isinstance(info.digest, str) and len(info.digest) == 64 for info in infos)
    assert all(type(x) in (int, float, str, tuple) for x in vars(infos[0]).values())
    field, level = qtet.open(paths[0]).fields[1], qtet.open(paths[0]).level_info(0)
    assert (field.name, field.type, len(field.minimum)) == ("Swirl", "float64", 3), field
    assert 0.5 * field.step < field.largestRoundingError < 0.501 * field.step, field
    assert qtet.open(paths[0]).fields[2].largestRoundingError == 0
    assert type(level.boundaryDistance) is float and level.hasError is True
    for frozen in (infos[0], field, level):
        refused(dataclasses.FrozenInstanceError, "bytes", lambda: setattr(frozen, "bytes", 0))


class Block:
    def __init__(self, kind, data):
        self.type, self.data = kind, data


class Mesh:
    """What a mesh of meshio looks like."""

    def __init__(self, points, cells, point_data, cell_data):
        self.points, self.cells = points, [Block("tetra", cells)]
        self.point_data = point_data
        self.cell_data = {name: [values] for name, values in cell_data.items()}


def grids_with_times_are_a_series():
    points, cells, point_data, cell_data = grid(4)
    heat, path = point_data["Heat"], OUT / "series.qtet"
    times = [-1, 0.5, 1e-7 + 2]
    grids = [
        Mesh(points, cells, {"Heat": heat * (time + 2), "Fixed": heat}, cell_data) for time in times
    ]
    grids[2].point_data["Late"] = heat
    qtet.simplify(grids, times=times, path=path)
    with qtet.open(path) as log:
        assert log.times == times and list(log.series) == ["Heat"]
        assert {"Heat@-1", "Heat@0.5", "Heat@2.0000001", "Late@2.0000001"} <= set(log.field_names)
        log.refine(max(log.level_of_error("Heat", 0.001), log.last_level))
        near = log.arrays(time=0, method="nearest").point_data
        assert set(near) == {"Heat", "Fixed", "Late@2.0000001"}
        for time, nearest in ((-9, -1), (-0.25, -1), (-0.2, 0.5), (9, 2.0000001)):
            at = log.field("Heat", time, "nearest")
            assert (at == log.field(f"Heat@{nearest}")).all()
            assert abs(at - log.field("Fixed") * (nearest + 2)).max() < 0.003
        refused(qtet.QtetError, "Heat (give a time)", lambda: log.field("Heat"))
        refused(qtet.QtetError, "'Fixed', 'Heat', 'Height'", lambda: log.field("Cold", 0.5))
    qtet.simplify(grids[:2], times=times[:2], time_statistics=True, path=path)
    with qtet.open(path) as log:
        log.refine(log.last_level)
        assert abs(log.field("Heat_average") - log.field("Fixed") * 1.75).max() < 0.003
        assert abs(log.field("Heat_stddev") - abs(log.field("Fixed")) * 0.75).max() < 0.003
    refused(ValueError, "3 grids and 2 times", lambda: qtet.simplify(grids, times=[1, 2]))
    refused(ValueError, "ascending", lambda: qtet.simplify(grids, times=[1, 1, 2]))
    refused(ValueError, "NAME@TIME", lambda: qtet.simplify(points, cells, times=[1]))
    grids[1] = Mesh(points, cells[1:], {}, {})
    refused(ValueError, "cells at the time 0.5", lambda: qtet.simplify(grids, times=times))


def points_that_move_are_taken_as_the_tool_does():
    points, cells, _, _ = grid(4)
    moved = [points, points * [1, 1, 1.25], points + [0, points[:, 0].max() / 8, 0]]
    times, log = [0, 0.5, 1], OUT / "moves.qtet"
    for kind in ("float64", "float32"):
        files = []
        for i, place in enumerate(moved):
            write_vtu(OUT / f"moves-{i}.vtu", place.astype(kind), cells, {}, {})
            files.append(f'<DataSet timestep="{times[i]}" file="moves-{i}.vtu"/>')
        (OUT / "moves.pvd").write_text(
            f'<VTKFile type="Collection"><Collection>{"".join(files)}</Collection></VTKFile>'
        )
        words = ["simplify", OUT / "moves.pvd", "--time", "all", "-o", log, "-q"]
        subprocess.run([program, *words], check=True)
        grids = [Mesh(place.astype(kind), cells, {}, {}) for place in moved]
        assert qtet.simplify(grids, times=times, source="moves.pvd") == log.read_bytes(), kind
    own = [Mesh(place, cells, {"Displacement": points}, {"Motion@5": cells}) for place in moved]
    taken = qtet.open(qtet.simplify(own, times=times))
    assert "Motion-2" in taken.series, taken
    free = numpy.vstack([points, [[9, 9, 9]]])
    lost = numpy.vstack([points * 2, [[numpy.nan] * 3]])
    steps = [Mesh(free, cells, {}, {}), Mesh(lost, cells, {}, {})]
    assert qtet.open(qtet.simplify(steps, times=[0, 1])).series.keys() == {"Displacement"}
    lost[3] = numpy.inf
    refused(ValueError, "point 3 has", lambda: qtet.simplify(steps, times=[0, 1]))


def a_time_is_exact_unless_the_nearest_is_asked_for():
    points, cells, _, _ = grid(2)
    temperature, middle = points[:, 0], points[cells].mean(axis=1)[:, 0]
    point_data = {"T@0": temperature, "T@1": temperature + 1, "Fixed": temperature}
    cell_data = {"T@0.1": middle + 2, "T@1": middle + 3, "U@5": middle, "U@6": middle + 1}
    log = qtet.open(qtet.simplify(points, cells, point_data, cell_data))
    log.refine(log.last_level)
    assert log.series["T"].keys() == {0, 0.1, 1} and log.times == [0, 0.1, 1, 5, 6]
    for name, time, own, choice in (
        ("T", 0, "T@0", {}),
        ("T", 0.1, "T@0.1", {}),
        ("T", 0.1 + 1e-12, "T@0.1", {}),
        ("T", numpy.float32(1), "point:T@1", {}),
        ("cell:T", 1, "cell:T@1", {}),
        ("T", 0.06, "T@0.1", {"method": "nearest"}),
        ("point:T", 0.06, "T@0", {"method": "nearest"}),
        ("T", 99, "point:T@1", {"method": "nearest"}),
        ("Fixed", 99, "Fixed", {}),
    ):
        assert (log.field(name, time, **choice) == log.field(own)).all(), (name, time)
    at = log.arrays("T", time=1)
    assert list(at.point_data) == list(at.cell_data) == ["T"]
    assert not log.arrays(time=0.1).point_data.keys() - {"Fixed"}
    refused(KeyError, "its times are 0, 0.1, 1;", lambda: log.field("T", time=99))
    refused(KeyError, "its times are 0.1, 1;", lambda: log.field("cell:T", time=0))
    refused(KeyError, "its times are 0, 0.1, 1, 5, 6;", lambda: log.arrays(time=99))
    refused(KeyError, "its times are 5, 6;", lambda: log.arrays(["T", "U"], time=1))
    for time in (numpy.nan, numpy.inf):
        for choice in (None, "nearest"):
            refused(ValueError, "finite", lambda: log.field("T", time, choice))
            refused(ValueError, "finite", lambda: log.arrays(time=time, method=choice))
    refused(ValueError, "'linear'", lambda: log.field("T", 0, "linear"))
    plain = qtet.open(qtet.simplify(points, cells, {"Fixed": temperature}))
    plain.refine(0)
    refused(KeyError, "its times are none", lambda: plain.arrays(time=0))


def numbers_out_of_range_are_refused():
    points, cells, point_data, cell_data = grid(2)
    mixed = Mesh(points, cells, point_data, {})
    mixed.cells.append(Block("pyramid", numpy.array([[0, 1, 4, 3, 9]])))
    for name in (
        *("target_ratio", "base_error", "base_cells", "boundary_weight", "shape_weight", "threads"),
        *("envelope_tolerance", "max_boundary_error", "position_bits", "field_bits"),
        *("errors", "max_field_errors", "field_weights", "label_weights"),
    ):
        for value in (numpy.nan, -3, -1e-9):
            option = {name: {"Heat": value} if name.endswith(("errors", "weights")) else value}
            refused(ValueError, name, lambda: qtet.simplify(points, cells, point_data, **option))
            refused(ValueError, name, lambda: qtet.simplify(mixed, **option))
    for value in (2.5, 2**32, numpy.inf):
        refused(ValueError, "integer", lambda: qtet.simplify(points, cells, base_cells=value))
    refused(ValueError, "name 3", lambda: qtet.simplify(points, cells, {3: points}))
    log = qtet.open(qtet.simplify(points, cells, point_data))
    for level in (-3, log.last_level + 1):
        refused(qtet.QtetError, f"no level {level};", lambda: log.refine(level))
        refused(qtet.QtetError, f"no level {level};", lambda: log.level_info(level))
    for level in (numpy.nan, 0.5):
        refused(TypeError, "integer", lambda: log.refine(level))
    for value in (numpy.nan, -3, numpy.inf):
        refused(ValueError, "0 or above", lambda: log.level_of_tetrahedra(value))
    for value in (numpy.nan, -3):
        refused(qtet.QtetError, "bound", lambda: log.level_of_error("Heat", value))
    refused(ValueError, "height", lambda: qtet.show(OUT / "grid.qtet", height=numpy.nan))


def a_log_is_opened_as_files_are():
    names = {"simplify", "show", "page", "view", "serve", "open", "Log", "QtetError", "Cancelled"}
    assert names <= set(dir(qtet)) and "importlib" not in dir(qtet)
    for call in (qtet.open, qtet.show, qtet.serve, lambda path: qtet.page(path, OUT / "a.html")):
        for missing in ("nothing.qtet", "nothing.vtu"):
            refused(FileNotFoundError, missing, lambda: call(OUT / missing))
        refused(IsADirectoryError, "folder.qtet", lambda: call(OUT / "folder.qtet"))
        if os.geteuid() != 0:
            (OUT / "secret.qtet").touch(0)
            refused(PermissionError, "secret.qtet", lambda: call(OUT / "secret.qtet"))
    points, cells, point_data, cell_data = grid(3)
    made, path = qtet.simplify(points, cells, point_data, cell_data), OUT / "opened.qtet"
    path.write_bytes(made)
    for source in (made, bytearray(made), memoryview(made), path, str(path)):
        log = qtet.open(source)
        for early in (log.arrays, log.counts, log.to_meshio, lambda: log.field("Heat")):
            refused(qtet.QtetError, "refine(level) first", early)
        assert "not refined" in repr(log) and "fields: Heat, Swirl, Region, Height" in repr(log)
        with log:
            log.refine(log.last_level)
            is_path = isinstance(source, (str, pathlib.Path))
            name = str(path) if is_path else f"{len(made)} bytes"
            assert repr(log).startswith(f"<qtet.Log {name}: "), log
            for again in (pickle.loads(pickle.dumps(log)), copy.copy(log)):
                assert again.level == log.last_level and again.info == log.info
                assert (again.arrays().points == log.arrays().points).all()
            assert set(log.arrays("Heat").point_data) == {"Heat"}
            assert "27 points" not in repr(log.arrays()) and "Heat, Swirl" in repr(log.arrays())
            refused(qtet.QtetError, "no field ['Temp']", lambda: log.arrays("Temp"))
            refused(TypeError, "a name", lambda: log.arrays([1]))
        log.close()
        assert repr(log).endswith("closed>") and log.info.levels > 0
        for late in (log.arrays, lambda: log.refine(0), lambda: log.field("Heat"), log.__enter__):
            refused(qtet.QtetError, "closed", late)
    refused(qtet.QtetError, "bad-magic", lambda: qtet.open(b"part.qtet" * 9))


class Packages:
    """Stands in for packages that are not installed."""

    @staticmethod
    def wrap(grid):
        return grid

    class Dataset:
        def __init__(self, variables, coords):
            self.sizes = {}
            for dimensions, values in variables.values():
                assert len(dimensions) == numpy.ndim(values), dimensions
                self.sizes.update(zip(dimensions, numpy.shape(values)))
            self.variables, self.coords = variables, coords

        def __getitem__(self, name):
            return self.variables[name][1]


def other_packages_take_the_mesh():
    points, cells, _, cell_data = grid(3)
    data = {"T@0": points[:, 0], "T@1": points[:, 0] + 1, "U@1": points, "U@2": points * 2}
    log = qtet.open(qtet.simplify(points, cells, data, {**cell_data, "T@1": cells, "T@2": cells}))
    log.refine(log.last_level)
    for name in ("meshio", "pyvista", "xarray"):
        kept, sys.modules[name] = sys.modules.get(name), None
        refused(ImportError, f"pip install {name}", getattr(log, f"to_{name}"))
        del sys.modules[name]
        if kept:
            sys.modules[name] = kept
    for name in ("pyvista", "xarray"):
        try:
            importlib.import_module(name)
        except ImportError:
            sys.modules[name] = Packages
    try:
        mesh = log.to_meshio(["T", "Height"], time=1)
        assert mesh.points.shape == points.shape and mesh.cells[0].type == "tetra"
        assert set(mesh.point_data) == {"T"} and set(mesh.cell_data) == {"T", "Height"}
        back = qtet.open(qtet.simplify(mesh))
        assert back.info.fields == 3
    except ImportError as error:
        print("skipped:", error)
    try:
        vtk = log.to_pyvista("T", time=1)
        assert vtk.GetNumberOfCells() == len(cells), vtk
    except ImportError as error:
        print("skipped:", error)
    every = log.to_xarray()
    sizes = {"time": 3, "point": len(points), "cell": len(cells), "U_component": 3}
    assert sizes.items() <= dict(every.sizes).items(), every.sizes
    heat = numpy.asarray(every["T"])
    assert (heat[1] == log.field("T", time=1)).all() and numpy.isnan(heat[2]).all()
    assert numpy.asarray(every["cell:T"]).shape == (3, len(cells), 4)
    one = log.to_xarray("Region")
    assert numpy.asarray(one["Region"]).dtype == numpy.int16
    refused(qtet.QtetError, "no field ['Cold']", lambda: log.to_xarray("Cold"))


def progress_is_told_and_may_end_the_work(mesh):
    told = []
    refused(
        qtet.Cancelled,
        "cancelled: ",
        lambda: qtet.simplify(
            *mesh, progress=lambda stage, done: told.append((stage, done)) or len(told) < 4
        ),
    )
    assert len(told) == 4, told
    assert all(
        stage in ("clean", "quantise", "simplify", "measure", "encode") and 0 <= done <= 1
        for stage, done in told
    ), told

    def fails(stage, done):
        raise OSError("the window is closed")

    refused(OSError, "the window is closed", lambda: qtet.simplify(*mesh, progress=fails))


def ctrl_c_ends_the_work(mesh):
    killer = threading.Timer(0.4, os.kill, (os.getpid(), signal.SIGINT))
    killer.start()
    start = time.monotonic()
    refused(KeyboardInterrupt, "", lambda: qtet.simplify(*mesh, measure="all"))
    print(f"Ctrl-C after 0.4 s ended the work after {time.monotonic() - start:.2f} s")
    killer.join()
    time.sleep(0.2)
    assert [t.name for t in threading.enumerate()] == ["MainThread"], "the work goes on"


logs_are_the_tools()
shapes_and_types_do_not_matter()
what_is_wrong_is_an_exception()
only_a_log_is_overwritten()
a_mask_is_missing_values()
what_a_log_holds_outlives_it()
grids_with_times_are_a_series()
points_that_move_are_taken_as_the_tool_does()
a_time_is_exact_unless_the_nearest_is_asked_for()
numbers_out_of_range_are_refused()
a_log_is_opened_as_files_are()
other_packages_take_the_mesh()
large = grid(32)  # a second and a half: reports come every 0.1 s
progress_is_told_and_may_end_the_work(large)
ctrl_c_ends_the_work(large)
print("qtet.simplify makes the tool's logs")

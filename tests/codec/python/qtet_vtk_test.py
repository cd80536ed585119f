"""The Python modules beside libqtet.so, judged by VTK's own reader of what `qtet extract` writes;
over HTTP, from a host with and without Range.
   qtet_vtk_test.py LIBRARY QTET-PROGRAM MODULES FOLDER-OF-LOGS FOLDER-TO-WRITE-TO
It ends with 77 where VTK is not installed."""
import functools
import http.server
import os
import pathlib
import subprocess
import sys
import threading

library, program, modules, logs, out = sys.argv[1:]
os.environ["QTET_LIBRARY"] = library
sys.path.insert(0, modules)
try:
    from qtet import vtk as qtet_vtk
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

LOGS, OUT = pathlib.Path(logs), pathlib.Path(out)
# At the last level extract gives the input itself, in its own numbering.
EXTRACTED_OTHERWISE = {"kept-input", "original-cells"}


def extracted(log, level):
    path = OUT / "level.vtu"
    subprocess.run(
        [program, "extract", log, "--level", str(level), "-o", path],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def values_of(data):
    """{name: (VTK's type, components, values)} of points or cells; NaN as text, so that it equals
    itself."""
    found = {}
    for i in range(data.GetNumberOfArrays()):
        values = data.GetArray(i)
        numbers = [
            values.GetComponent(t, c)
            for t in range(values.GetNumberOfTuples())
            for c in range(values.GetNumberOfComponents())
        ]
        found[values.GetName()] = (
            values.GetDataTypeAsString(),
            values.GetNumberOfComponents(),
            [x if x == x else "nan" for x in numbers],
        )
    return found


def compare(grid, expected, what):
    assert grid.GetNumberOfPoints() == expected.GetNumberOfPoints() > 0, what
    assert grid.GetNumberOfCells() == expected.GetNumberOfCells() > 0, what
    for i in range(grid.GetNumberOfPoints()):
        assert (
            max(abs(a - b) for a, b in zip(grid.GetPoint(i), expected.GetPoint(i))) < 1e-6
        ), f"{what}: point {i}"
    for i in range(grid.GetNumberOfCells()):
        a, b = grid.GetCell(i), expected.GetCell(i)
        assert a.GetCellType() == b.GetCellType() == 10, what
        assert [a.GetPointId(k) for k in range(4)] == [
            b.GetPointId(k) for k in range(4)
        ], f"{what}: cell {i}"
    assert values_of(grid.GetPointData()) == values_of(expected.GetPointData()), what
    assert values_of(grid.GetCellData()) == values_of(expected.GetCellData()), what


def refused(call, word):
    try:
        call()
    except (qtet_vtk.QtetError, ValueError, OSError) as error:
        assert word in str(error), error
        return
    raise AssertionError(f"accepted; expected a complaint with '{word}'")


def every_log_is_what_extract_writes():
    compared = 0
    for path in sorted(LOGS.glob("*.qtet")):
        with qtet_vtk.Log(path) as log:
            last = [] if path.stem in EXTRACTED_OTHERWISE else [log.last_level]
            for level in [*last, 2, 0]:
                if level > log.last_level:  # some logs have one level
                    continue
                log.refine(level)
                compare(
                    qtet_vtk.grid_of(log), extracted(path, level), f"{path.name}, level {level}"
                )
                surface = qtet_vtk.surface_of(log)
                assert surface.GetNumberOfPolys() == log.level_info(level).boundaryTriangles > 0
                compared += 1
    assert compared >= 20, compared


def levels_are_chosen_and_fields_left_out():
    path = LOGS / "solid.qtet"
    with qtet_vtk.Log(path) as log:
        sizes = [log.level_info(level).tetrahedra for level in range(log.info.levels)]
    middle = sizes[len(sizes) // 2]
    assert qtet_vtk.read(path, tetrahedra=middle).GetNumberOfCells() == max(
        size for size in sizes if size <= middle
    )
    assert qtet_vtk.read(path).GetNumberOfCells() == sizes[-1]
    box = OUT / "box.qtet"
    for words in (
        ["sample", "box", "-o", OUT / "box.vtu"],
        ["simplify", OUT / "box.vtu", "-o", box],
    ):
        subprocess.run([program, *words], check=True, capture_output=True)
    for name, option in (("Scalar", "--error=Scalar=0.01"), ("boundary", "--boundary-error=0.01")):
        subprocess.run(
            [program, "extract", box, option, "-o", OUT / "near.vtu"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        grid = qtet_vtk.read(box, error=(name, 0.01))
        assert grid.GetNumberOfCells() < qtet_vtk.read(box).GetNumberOfCells(), name
        assert (
            f'NumberOfCells="{grid.GetNumberOfCells()}"'.encode()
            in (OUT / "near.vtu").read_bytes()[:1000]
        ), name
    for level in (len(sizes), 500, -1):
        refused(lambda: qtet_vtk.read(path, level=level), f"no level {level}; the last is ")
    none = qtet_vtk.read(path, level=1, fields=[])
    assert none.GetPointData().GetNumberOfArrays() == 0
    assert values_of(qtet_vtk.read(path, fields=["Swirl"]).GetPointData()).keys() == {"Swirl"}
    refused(lambda: qtet_vtk.read(path, fields=["Colour"]), "Colour")
    refused(lambda: qtet_vtk.read(path, level=1, tetrahedra=5), "one of")
    refused(lambda: qtet_vtk.read(LOGS / "nobody.qtet"), "nobody.qtet")
    refused(
        lambda: qtet_vtk.read(LOGS.parent / "must-fail" / "truncated.last-byte.qtet"), "truncated"
    )


def a_time_chooses_an_instant_of_each_series():
    with qtet_vtk.Log(LOGS / "series.qtet") as log:
        log.refine(log.last_level)
        every = {**values_of(qtet_vtk.grid_of(log).GetPointData())}
        for time in log.times:
            grid = qtet_vtk.grid_of(log, time=time)
            points = values_of(grid.GetPointData())
            (name,) = [name for name in points if name in log.series]
            assert points[name] == every[log.field_names[log.series[name][time]]], time


class Host(http.server.SimpleHTTPRequestHandler):
    """Static files with one Range, as nginx has it; under /whole/ without. Counts what it sends."""

    sent = 0

    def do_GET(self):
        whole = self.path.startswith("/whole/")
        path = self.path.removeprefix("/whole").removeprefix("/v1/meshes").removesuffix("/log")
        file = LOGS / (path.lstrip("/").removesuffix(".qtet") + ".qtet")
        if not file.is_file():
            return self.send_error(404)
        data = file.read_bytes()
        start, end = 0, len(data)
        asked = self.headers.get("Range")
        if asked and not whole:
            first, last = asked.removeprefix("bytes=").split("-")
            start, end = int(first), min(int(last) + 1, end)
        self.send_response(206 if asked and not whole else 200)
        self.send_header("ETag", '"1"')
        self.send_header("Content-Length", str(end - start))
        self.end_headers()
        self.wfile.write(data[start:end])
        Host.sent += end - start

    def log_message(self, *_):
        pass


def urls_fetch_what_a_level_needs():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Host)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    root = f"http://127.0.0.1:{server.server_address[1]}"
    path = LOGS / "solid.qtet"
    for url in (f"{root}/solid.qtet", f"{root}/v1/meshes/solid", f"{root}/?mesh=solid&clip=y"):
        Host.sent = 0
        with qtet_vtk.Log(url) as log:
            for level in (0, 2, log.last_level, 1):
                need = log.level_info(level).prefixBytes
                log.refine(level)
                compare(qtet_vtk.grid_of(log), extracted(path, level), f"{url}, level {level}")
                assert Host.sent <= max(
                    need, Host.sent if level == 1 else 0
                ), f"{Host.sent} bytes for {need}"
        assert Host.sent == path.stat().st_size, Host.sent
    whole = qtet_vtk.read(f"{root}/whole/solid.qtet", level=0)
    compare(whole, extracted(path, 0), "a host without Range")
    refused(lambda: qtet_vtk.read(f"{root}/nobody.qtet"), "404")
    server.shutdown()
    refused(lambda: qtet_vtk.read("http://127.0.0.1:1/solid.qtet"), "cannot be fetched")


every_log_is_what_extract_writes()
levels_are_chosen_and_fields_left_out()
a_time_chooses_an_instant_of_each_series()
urls_fetch_what_a_level_needs()
print("levels, choices and URLs agree with qtet extract")

"""The installed package: logs of grids of meshio and VTK with any volume cells, and its own host.
   wheel_test.py FOLDER-WITH-box.vtu-AND-box.qtet"""
import http.client
import os
import pathlib
import sys

os.chdir(sys.argv[1])
import numpy
import qtet


def raised(kind, call):
    try:
        call()
    except kind as error:
        return str(error)
    raise AssertionError(f"no {kind.__name__}")


class Block:
    def __init__(self, kind, data):
        self.type, self.data = kind, data


class Mesh:
    """What a mesh of meshio looks like."""

    def __init__(self, points, cells, point_data=(), cell_data=()):
        self.points, self.cells = points, [Block(*cell) for cell in cells]
        self.point_data, self.cell_data = dict(point_data), dict(cell_data)


def hexahedra(n):
    """A cube of n^3 hexahedra, and a triangle beside them, which is left out."""
    ticks = numpy.arange(n + 1)
    z, y, x = (a.ravel() for a in numpy.meshgrid(ticks, ticks, ticks, indexing="ij"))
    row, layer = n + 1, (n + 1) ** 2
    corner = (x + row * y + layer * z)[(x < n) & (y < n) & (z < n)]
    steps = numpy.array([0, 1, row + 1, row, layer, layer + 1, layer + row + 1, layer + row])
    return Mesh(
        numpy.stack([x, y, z], axis=1).astype(float),
        [("triangle", numpy.array([[0, 1, row]])), ("hexahedron", corner[:, None] + steps)],
        {"T": (x * y + z).astype("float32"), "Flag": x > 1},
        {"Part": [numpy.array([9]), numpy.arange(n**3)]},
    )


def _order(points, others):
    """For each point the number of the nearest of the others."""
    return [numpy.argmin(((others - point) ** 2).sum(axis=1)) for point in points]


def test_hexahedra():
    mesh, told = hexahedra(6), []
    log = qtet.simplify(mesh, progress=lambda *step: told.append(step), field_bits=14)
    pathlib.Path("cube.qtet").write_bytes(log)
    with qtet.open("cube.qtet") as opened:
        opened.refine(opened.info.levels - 1)
        assert opened.counts()[1] in (5 * 216, 6 * 216), opened.counts()
        arrays = opened.arrays()
        assert arrays.points.shape == (343, 3) and arrays.boundary.shape == (2 * 6 * 36, 3)
        assert abs(arrays.points - mesh.points[_order(arrays.points, mesh.points)]).max() < 1e-3
        assert arrays.point_data["T"].dtype == numpy.float32
        assert set(arrays.point_data["Flag"]) == {0, 1}
        assert sorted(set(arrays.cell_data["Part"])) == list(range(216))
        corners = arrays.points[arrays.cells]
        edges = corners[:, 1:] - corners[:, :1]
        assert abs(abs(numpy.linalg.det(edges)).sum() / 6 - 216) < 0.1
        assert set(opened.arrays(["T"]).point_data) == {"T"}
        assert "no field" in raised(qtet.QtetError, lambda: opened.arrays(["U"]))
    assert qtet.simplify(mesh, path="two.qtet", field_bits=14) == "two.qtet"
    assert pathlib.Path("two.qtet").read_bytes() == log
    large = hexahedra(30)
    raised(qtet.Cancelled, lambda: qtet.simplify(large, progress=lambda *_: False))
    assert "position-bits" in raised(qtet.QtetError, lambda: qtet.simplify(mesh, position_bits=99))


def test_refused():
    assert "int is no grid" in raised(ValueError, lambda: qtet.simplify(3))
    flat = Mesh(numpy.zeros((3, 3)), [("triangle", numpy.array([[0, 1, 2]]))])
    assert "no volume cells" in raised(ValueError, lambda: qtet.simplify(flat))


def test_meshio_and_vtk():
    try:
        import meshio
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    except ImportError as error:
        return print("skipped:", error)
    log = qtet.simplify(meshio.read("box.vtu"))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName("box.vtu")
    reader.Update()
    assert qtet.simplify(reader.GetOutput()) == log
    return None


def test_show():
    shown = qtet.show("box.qtet", field="Scalar", clip="x:0.5", height=300)
    text = shown._repr_html_()
    assert text.startswith('<iframe srcdoc="') and "height: 300px" in text
    assert "field=Scalar&amp;amp;clip=x%3A0.5" in text, "the view"
    assert "bytes" in repr(shown) and len(shown.page) < 1_000_000
    cut = qtet.show(hexahedra(24), max_bytes=len(shown.page) + 8000)
    assert "it holds" in cut.told and len(cut.page) <= len(shown.page) + 8000
    qtet.page(pathlib.Path("box.vtu"), "box.html")
    assert pathlib.Path("box.html").read_text().startswith("<!doctype html>")
    assert "nothing.qtet" in raised(FileNotFoundError, lambda: qtet.show("nothing.qtet"))


def test_show_takes_steps_and_open_logs():
    steps = [hexahedra(3), hexahedra(3)]
    steps[1].points = steps[1].points * 1.5
    shown = qtet.show(steps, times=[0, 0.5], time=0.5)
    assert "time=0.5" in shown.page and "bytes" in shown.told
    assert "give times" in raised(ValueError, lambda: qtet.show(steps))
    qtet.page("box.qtet", "path.html")
    for log in (qtet.open("box.qtet"), qtet.open(pathlib.Path("box.qtet").read_bytes())):
        qtet.page(log, "log.html")
        paths = (pathlib.Path("log.html"), pathlib.Path("path.html"))
        sizes = [path.stat().st_size for path in paths]
        assert abs(sizes[0] - sizes[1]) < 100, sizes
    pathlib.Path("box.log").write_bytes(pathlib.Path("box.qtet").read_bytes())
    with qtet.serve(qtet.open("box.log"), hexahedra(2), steps, times=[0, 1]) as server:
        names = sorted(path.name for path in pathlib.Path(server.folder).glob("*.qtet"))
        assert names == ["box.qtet", "mesh-2.qtet", "mesh.qtet"], names
        from_url = qtet.show(server.url + "box.qtet")
        assert "bytes" in from_url.told


def answer(server, path, method="GET", **headers):
    connection = http.client.HTTPConnection(server.url.split("/")[2], timeout=20)
    connection.request(method, path, headers=headers)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def test_host():
    log = pathlib.Path("box.qtet").read_bytes()
    with qtet.serve("box.qtet") as server:
        response, body = answer(server, "/")
        assert response.status == 200 and b"qtet-src" in body
        assert answer(server, "/box.qtet")[1] == log
        for text, first, last in (
            ("bytes=0-9", 0, 9),
            (f"bytes={len(log) - 1}-", len(log) - 1, len(log) - 1),
            ("bytes=5-99999999", 5, len(log) - 1),
            ("bytes=-3", len(log) - 3, len(log) - 1),
        ):
            response, body = answer(server, "/box.qtet", Range=text)
            assert response.status == 206, text
            assert body == log[first : last + 1], text
            assert response.headers["Content-Range"] == f"bytes {first}-{last}/{len(log)}"
        for text in (f"bytes={len(log)}-", "bytes=9-5", "bytes=-0"):
            assert answer(server, "/box.qtet", Range=text)[0].status == 416, text
        response, body = answer(server, "/box.qtet", "HEAD")
        assert int(response.headers["Content-Length"]) == len(log) and body == b""
        os.symlink(os.path.abspath("box.vtu"), pathlib.Path(server.folder) / "link")
        for path in ("/nothing", "/../box.qtet", "/%2e%2e/box.qtet", "/link", "/assets", "/%00"):
            assert answer(server, path)[0].status == 404, path
        assert answer(server, "/", Host="example.org")[0].status == 421
        port = int(server.url.split(":")[2].strip("/"))
        assert str(port) in raised(qtet.QtetError, lambda: qtet.serve("box.qtet", port=port))
    assert not os.path.exists(server.folder)
    assert "nothing.qtet" in raised(FileNotFoundError, lambda: qtet.serve("nothing.qtet"))


for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("ok   ", name)

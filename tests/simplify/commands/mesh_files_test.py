"""Every kind of file that `qtet extract` and `qtet convert` write, read back by VTK, meshio, numpy
and (if installed) Gmsh, and held against the .vtu.
   mesh_files_test.py QTET-PROGRAM FOLDER-OF-LOGS FOLDER-TO-WRITE-TO
It ends with 77 where VTK's Python modules, meshio or numpy are missing."""
import math
import pathlib
import re
import shutil
import subprocess
import sys

try:
    import meshio
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

program, logs, out = sys.argv[1:]
LOGS, OUT = pathlib.Path(logs), pathlib.Path(out)


def qtet(*words):
    return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True)


def read(reader, path):
    reader.SetFileName(str(path))
    if hasattr(reader, "ReadAllScalarsOn"):
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    reader.Update()
    return reader.GetOutput()


def arrays(data):
    return {
        data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
        for i in range(data.GetNumberOfArrays())
    }


class Mesh:
    """points, tetrahedra, and fields of points and cells by name."""

    def __init__(self, points, tetrahedra, point_fields, cell_fields):
        self.points, self.tetrahedra, self.point_fields, self.cell_fields = (
            points,
            tetrahedra,
            point_fields,
            cell_fields,
        )

    @staticmethod
    def of_grid(grid):
        assert set(vtk_to_numpy(grid.GetCellTypesArray())) == {10}
        return Mesh(
            vtk_to_numpy(grid.GetPoints().GetData()),
            vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4),
            arrays(grid.GetPointData()),
            arrays(grid.GetCellData()),
        )

    @staticmethod
    def of_meshio(mesh):
        (block,) = mesh.cells
        assert block.type == "tetra", block.type
        return Mesh(
            mesh.points,
            block.data,
            mesh.point_data,
            {name: values[0] for name, values in mesh.cell_data.items() if ":" not in name},
        )

    def boundary(self):
        """Faces of one cell, each turned so that its smallest vertex is first."""
        t = self.tetrahedra
        faces = np.concatenate([t[:, [1, 2, 3]], t[:, [0, 3, 2]], t[:, [0, 1, 3]], t[:, [0, 2, 1]]])
        _, first, counts = np.unique(
            np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
        )
        return {turned(face) for face in faces[first[counts == 1]]}


def turned(face):
    k = int(np.argmin(face))
    return tuple(int(face[(k + i) % 3]) for i in range(3))


def same_fields(found, expected, what, exact_types):
    assert found.keys() == expected.keys(), (what, found.keys(), expected.keys())
    for name, values in expected.items():
        stored = found[name] if exact_types else found[name].astype(values.dtype)
        assert np.array_equal(stored, values, equal_nan=values.dtype.kind == "f"), (what, name)
        assert not exact_types or found[name].dtype == values.dtype, (
            what,
            name,
            found[name].dtype,
            values.dtype,
        )


def same(found, expected, what, exact_types=True):
    points = found.points if exact_types else found.points.astype(expected.points.dtype)
    assert np.array_equal(points, expected.points), what
    assert np.array_equal(found.tetrahedra, expected.tetrahedra), what
    same_fields(found.point_fields, expected.point_fields, what, exact_types)
    same_fields(found.cell_fields, expected.cell_fields, what, exact_types)


def filled_up(fields):
    """As Gmsh has them: 1, 3 or 9 components."""
    out = {}
    for name, values in fields.items():
        width = 1 if values.ndim == 1 else values.shape[1]
        wide = 1 if width == 1 else 3 if width <= 3 else 9
        out[name] = (
            values
            if wide == width
            else np.hstack([values, np.zeros((len(values), wide - width), values.dtype)])
        )
    return out


def surface(path, polydata, expected, tolerance):
    """Triangles at the same places, counter-clockwise from outside, as the boundary of the
    cells."""
    places = vtk_to_numpy(polydata.GetPoints().GetData())
    corners = vtk_to_numpy(polydata.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    offs = np.linalg.norm(places[:, None, :] - expected.points[None, :, :], axis=2)
    originals = offs.argmin(axis=1)
    off, scale = offs.min(axis=1).max(), np.ptp(expected.points, axis=0).max()
    assert off <= scale * tolerance, (path, off)
    found = {turned(originals[face].tolist()) for face in corners}
    assert found == expected.boundary() and len(found) == len(corners), path
    return places, corners, originals


def usda(path, expected):
    text = path.read_text()
    assert (
        text.startswith("#usda 1.0\n")
        and text.count("{") == text.count("}")
        and 'orientation = "rightHanded"' in text
    )

    prims = dict(re.findall(r'^    def \w+ "(\w+)"\n    \{\n(.*?)^    \}\n', text, re.M | re.S))
    assert list(prims) == ["tetrahedra", "boundary"], path

    def numbers(name, prim="tetrahedra"):
        (found,) = re.findall(rf"^        \S+\[\] {re.escape(name)} = \[(.*)\]", prims[prim], re.M)
        return np.array([float(x) for x in re.findall(r"[^\s,()]+", found)])

    assert np.array_equal(
        numbers("points").reshape(-1, 3).astype(np.float32), expected.points.astype(np.float32)
    ), path
    assert np.array_equal(numbers("tetVertexIndices").reshape(-1, 4), expected.tetrahedra), path
    assert {
        turned(face) for face in numbers("surfaceFaceVertexIndices").reshape(-1, 3).astype(int)
    } == expected.boundary(), path
    for fields, interpolation in (
        (expected.point_fields, "vertex"),
        (expected.cell_fields, "uniform"),
    ):
        count = prims["tetrahedra"].count(f'interpolation = "{interpolation}"')
        assert count == len(fields), path
        for name, values in fields.items():
            # USD has one room for both.
            is_taken = interpolation == "uniform" and name in expected.point_fields
            stored = name + "_" if is_taken else name
            assert np.array_equal(
                numbers("primvars:" + stored).astype(values.dtype), values.ravel(), equal_nan=True
            ), (path, name)
    usda_boundary(path, expected, lambda name: numbers(name, "boundary"))


def usda_boundary(path, expected, numbers):
    """The Mesh prim: the boundary's points in their order, coloured."""
    used = np.array(sorted({v for face in expected.boundary() for v in face}))
    assert np.array_equal(
        numbers("points").reshape(-1, 3).astype(np.float32),
        expected.points[used].astype(np.float32),
    ), path
    assert (numbers("faceVertexCounts") == 3).all(), path
    corners = used[numbers("faceVertexIndices").astype(int).reshape(-1, 3)]
    assert {turned(face) for face in corners} == expected.boundary(), path
    for name, values in expected.point_fields.items():
        assert np.array_equal(
            numbers("primvars:" + name).astype(values.dtype), values[used].ravel(), equal_nan=True
        ), (path, name)
    if not expected.point_fields:
        return
    colours = numbers("primvars:displayColor").reshape(-1, 3)
    first = next(iter(expected.point_fields.values()))[used]
    size = first if first.ndim == 1 else np.linalg.norm(first, axis=1)
    assert len(colours) == len(used) and ((colours >= 0) & (colours <= 1)).all(), path
    # viridis goes from a dark blue to a bright yellow
    assert colours[np.nanargmax(size)][1] > colours[np.nanargmin(size)][1], path


def glb(path, expected):
    """Without Draco: the boundary as VTK reads it, with the fields that glTF can have."""
    blocks = read(vtkGLTFReader(), path)
    while blocks.IsA("vtkMultiBlockDataSet"):
        assert blocks.GetNumberOfBlocks() == 1, path
        blocks = blocks.GetBlock(0)
    _, _, originals = surface(path, blocks, expected, 2e-5)
    found = arrays(blocks.GetPointData())
    named = {
        name: values
        for name, values in expected.point_fields.items()
        if (values.ndim == 1 or values.shape[1] <= 4) and np.isfinite(values).all()
    }
    assert {"_" + name for name in named} == {name for name in found if name.startswith("_")}, (
        path,
        list(found),
    )
    for name, values in named.items():
        half_step = np.ptp(values) / 2**11 or 1  # of fields of 10 bits or more
        assert np.abs(found["_" + name] - values[originals]).max() <= half_step, (path, name)


def gmsh(path, expected):
    same(
        Mesh.of_meshio(meshio.read(path)),
        Mesh(
            expected.points,
            expected.tetrahedra,
            filled_up(expected.point_fields),
            filled_up(expected.cell_fields),
        ),
        path,
        exact_types=False,
    )
    if not shutil.which("gmsh"):
        return print("no gmsh: .msh read by meshio alone")
    again = OUT / "again.mesh"
    said = subprocess.run(
        ["gmsh", path, "-save", "-o", again], capture_output=True, text=True, check=True
    )
    assert "Error" not in said.stdout + said.stderr, said
    count = re.search(r"Tetrahedra\s+(\d+)", again.read_text())
    assert int(count[1]) == len(expected.tetrahedra), said


def check_all(write, expected):
    """`write(ending, words...)` writes a file of that kind, of the mesh `expected`."""
    same(Mesh.of_grid(read(vtkUnstructuredGridReader(), write(".vtk"))), expected, "legacy .vtk")
    gmsh(write(".msh"), expected)
    usda(write(".usda"), expected)
    surface("obj", read(vtkOBJReader(), write(".obj")), expected, 1e-5)
    glb(write(".glb", "--no-draco"), expected)


def main():
    qtet("sample", "box", "-o", OUT / "box.vtu")
    qtet("simplify", OUT / "box.vtu", "-o", OUT / "box.qtet")
    cases = [
        (OUT / "box.qtet", ["--ratio", 0.3]),
        (LOGS / "cell-fields.qtet", ["--level", 9]),
        (LOGS / "gaps.qtet", ["--ratio", 1]),
        (LOGS / "kept-input.qtet", ["--ratio", 1]),
    ]
    for log, choice in cases:

        def extracted(ending, *words):
            qtet("extract", log, *choice, *words, "-o", OUT / ("level" + ending))
            return OUT / ("level" + ending)

        check_all(extracted, Mesh.of_grid(read(vtkXMLUnstructuredGridReader(), extracted(".vtu"))))

    def converted(ending, *words):
        qtet("convert", OUT / "box.vtu", *words, "-o", OUT / ("whole" + ending))
        return OUT / ("whole" + ending)

    whole = Mesh.of_grid(read(vtkXMLUnstructuredGridReader(), OUT / "box.vtu"))
    check_all(converted, whole)
    same(
        Mesh.of_grid(read(vtkXMLUnstructuredGridReader(), converted(".vtu"))),
        whole,
        "convert to .vtu",
    )
    for path in ("level.vtk", "level.msh"):  # and back in again by qtet itself
        assert "refused" not in qtet("check", OUT / path).stdout
    qtet("convert", LOGS / "solid.qtet", "--fields", "Height", "-o", OUT / "one.vtu")
    one = Mesh.of_grid(read(vtkXMLUnstructuredGridReader(), OUT / "one.vtu"))
    assert list(one.point_fields) == ["Height"] and len(one.tetrahedra) == 162
    assert math.isfinite(whole.points.sum())
    print("every kind of file was read back by somebody else")


main()

"""What meshio, Gmsh and VTK write is read by qtet, or refused with advice.
other_programs_test.py QTET-PROGRAM MESHES-FOLDER FOLDER-TO-WRITE-TO"""

import gzip
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import numpy as np

try:
    import meshio
except ImportError:
    meshio = None
try:
    import h5py
except ImportError:
    h5py = None
try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    print("skipped: VTK's Python modules are not installed")
    sys.exit(77)

qtet, meshes, out = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
shutil.rmtree(out, ignore_errors=True)
out.mkdir(parents=True)

FLOAT32 = 1e-6  # what the reader of Fluent keeps of coordinates
BALL = 'SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.7;'
# The corners of a cube from the origin to (1, 1, 1), and six tetrahedra round its diagonal.
CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
TETRAHEDRA = np.array(
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]
)


def run(*words, **options):
    return subprocess.run([qtet, *map(str, words)], capture_output=True, text=True, **options)


def refused(*words):
    """What the tool says where it refuses."""
    done = run(*words)
    assert done.returncode != 0, (words, done.stdout)
    return done.stdout + done.stderr


def arrays_of(path):
    """points, tetrahedra, point_NAME and cell_NAME of a .vtu."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    found = {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "tetrahedra": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4),
    }
    for kind, data in (("point", grid.GetPointData()), ("cell", grid.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            found[f"{kind}_{data.GetArrayName(i)}"] = vtk_to_numpy(data.GetArray(i))
    return {name: array.copy() for name, array in found.items()}


def read(path, *words):
    """The mesh as numpy arrays, and the tool's notes."""
    made = out / "read.vtu"
    made.unlink(missing_ok=True)
    done = run("convert", path, *words, "-o", made)
    assert done.returncode == 0, (path, done.stderr)
    return arrays_of(made), done.stderr


def volume(mesh):
    a, b, c, d = (mesh["points"][mesh["tetrahedra"][:, k]] for k in range(4))
    sizes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    # which way round cells are is for the cleaning behind the readers
    assert (np.abs(sizes) > 0).all(), sizes.min()
    return np.abs(sizes).sum()


def is_whole(mesh, size):
    """One body of this size: each face is one of two cells', or the boundary's."""
    assert abs(volume(mesh) - size) < FLOAT32 * max(1, size), volume(mesh)
    faces = {}
    for cell in mesh["tetrahedra"]:
        for k in range(4):
            face = tuple(sorted(np.delete(cell, k)))
            faces[face] = faces.get(face, 0) + 1
    middle = mesh["points"][[f for f, n in faces.items() if n == 1]].mean(axis=1)
    low, high = mesh["points"].min(axis=0), mesh["points"].max(axis=0)
    assert (np.isclose(middle, low) | np.isclose(middle, high)).any(axis=1).all(), "torn"


def cube(x=0):
    return CORNERS + [x, 0, 0]


def grid_of(points, fields=()):
    grid, places = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(*point)
    grid.SetPoints(places)
    for cell in TETRAHEDRA:
        grid.InsertNextCell(vtk.VTK_TETRA, 4, [int(v) for v in cell])
    for name, values in fields:
        array = vtk.vtkDoubleArray()
        array.SetName(name)
        for value in values:
            array.InsertNextValue(value)
        grid.GetPointData().AddArray(array)
    return grid


def write_vtu(grid, path):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    assert writer.Write() == 1


def gmsh(name, geometry, *words):
    (out / f"{name}.geo").write_text(geometry)
    subprocess.run(
        ["gmsh", out / f"{name}.geo", "-3", *words], check=True, capture_output=True, cwd=out
    )


def medit_files_of_order_three_are_read():
    if not shutil.which("gmsh"):
        return "no gmsh"
    for order in (3, 4):
        made = out / f"ball{order}.mesh"
        gmsh("ball", BALL, "-order", str(order), "-o", made)
        assert abs(volume(read(made)[0]) - 4 * np.pi / 3) < 0.02, order
    text = (out / "ball3.mesh").read_text().split("\n")
    at = next(i for i, line in enumerate(text) if "Tetrahedra" in line)
    text[at + 2] = " ".join(text[at + 2].split()[1:])
    (out / "less.mesh").write_text("\n".join(text))
    assert "line" in refused("check", out / "less.mesh")


def compressed_files_are_read():
    whole, _ = read(meshes / "p_0.vtu")
    for kind, name in (("vtu", "p_0.vtu"), ("vtk", "box.vtk"), ("msh", "gmsh-mixed1.msh")):
        plain = meshes / name
        if kind == "vtk":
            plain = out / name
            assert run("convert", meshes / "p_0.vtu", "-o", plain).returncode == 0
        packed = out / f"{plain.name}.gz"
        packed.write_bytes(gzip.compress(plain.read_bytes()))
        expected, got = read(plain)[0], read(packed)[0]
        assert (got["points"] == expected["points"]).all()
        assert (got["tetrahedra"] == expected["tetrahedra"]).all()
    packed = (out / "p_0.vtu.gz").read_bytes()
    (out / "cut.vtu.gz").write_bytes(packed[:-20])
    assert "was cut off" in refused("check", out / "cut.vtu.gz")
    (out / "plain.vtu.gz").write_bytes((meshes / "p_0.vtu").read_bytes())
    assert "not compressed" in refused("check", out / "plain.vtu.gz")
    (out / "case.foam.gz").write_bytes(packed)
    assert "gunzip" in refused("check", out / "case.foam.gz")
    (out / "bad.vtu.gz").write_bytes(gzip.compress(b"<VTKFile"))
    assert "bad.vtu.gz" in refused("check", out / "bad.vtu.gz")
    assert "qtet-inflate" not in refused("check", out / "bad.vtu.gz")


def a_list_of_files_is_a_series():
    files = [{"name": f"at{i}.vtu", "time": i / 2} for i in range(3)]
    for i in range(3):
        write_vtu(grid_of(cube(), [("T", cube()[:, 0] + i)]), out / f"at{i}.vtu")
    listed = out / "run.vtu.series"
    listed.write_text(json.dumps({"file-series-version": "1.0", "files": files[::-1]}))
    mesh, notes = read(listed)
    assert (mesh["point_T"] == mesh["points"][:, 0] + 2).all() and "the last is read" in notes
    mesh, _ = read(listed, "--time", "0.5")
    assert (mesh["point_T"] == mesh["points"][:, 0] + 1).all()
    mesh, _ = read(listed, "--time", "all")
    assert {"point_T@0", "point_T@0.5", "point_T@1"} <= set(mesh), set(mesh)
    assert "it has 0, 0.5, 1" in refused("check", listed, "--time", "7")
    for text in ("no JSON", "{}", '{"file-series-version": "1.0", "files": [{"name": "at0.vtu"}]}'):
        listed.write_text(text)
        assert "save the series again" in refused("check", listed), text


def write_vtkhdf(path, pieces, steps=None):
    """The pieces' cubes, with T = x. `steps`: the datasets of the group Steps."""
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([1, 0] if steps is None else [2, 0], "i8")
        kind = b"UnstructuredGrid"
        root.attrs.create("Type", kind, dtype=h5py.string_dtype("ascii", len(kind)))
        cells = [TETRAHEDRA for _ in pieces]
        for name, values in (
            ("NumberOfPoints", [len(p) for p in pieces]),
            ("NumberOfCells", [len(c) for c in cells]),
            ("NumberOfConnectivityIds", [c.size for c in cells]),
            ("Connectivity", np.concatenate([c.ravel() for c in cells])),
            ("Offsets", np.concatenate([np.arange(0, c.size + 1, 4) for c in cells])),
        ):
            root[name] = np.array(values, "i8")
        root["Points"] = np.concatenate(pieces)
        root["Types"] = np.full(sum(map(len, cells)), 10, "u1")
        root["PointData/T"] = np.concatenate(pieces)[:, 0].copy()
        if steps is None:
            return
        group = root.create_group("Steps")
        group.attrs["NSteps"] = len(steps["Values"])
        for name, values in steps.items():
            group[name] = np.array(values, "f8" if name == "Values" else "i8")


def partitions_of_vtkhdf_become_one_mesh():
    if not h5py:
        return "no h5py"
    write_vtkhdf(out / "one.vtkhdf", [cube()])
    is_whole(read(out / "one.vtkhdf")[0], 1)
    write_vtkhdf(out / "two.vtkhdf", [cube(), cube(1), cube(2)])
    mesh, notes = read(out / "two.vtkhdf")
    is_whole(mesh, 3)
    assert "3 pieces were joined at 8 points" in notes, notes
    assert np.allclose(mesh["point_T"], mesh["points"][:, 0])
    bytes_ = (out / "two.vtkhdf").read_bytes()
    for at in range(0, len(bytes_), 397):
        (out / "damaged.vtkhdf").write_bytes(bytes_[:at] + b"\xff" * 8 + bytes_[at + 8 :])
        done = run("check", out / "damaged.vtkhdf", "--read-seconds", 10)
        assert done.returncode in (0, 1), (at, done.returncode, done.stderr)
    (out / "cut.vtkhdf").write_bytes(bytes_[:1000])
    assert refused("check", out / "cut.vtkhdf")


def steps_of_vtkhdf_are_read_by_their_offsets():
    if not h5py:
        return "no h5py"
    path = out / "steps.vtkhdf"
    n, m = len(cube()), len(TETRAHEDRA)
    # three steps of two partitions each: the mesh moves in z
    moved = [cube(x) + [0, 0, 5 * s] for s in range(3) for x in range(2)]
    moving = {
        "Values": [0, 0.5, 2],
        "PartOffsets": [0, 2, 4],
        "NumberOfParts": [2, 2, 2],
        "PointOffsets": [0, 2 * n, 4 * n],
        "CellOffsets": [[0], [2 * m], [4 * m]],
        "ConnectivityIdOffsets": [[0], [8 * m], [16 * m]],
    }
    for without in (None, "NumberOfParts"):  # version 2.0 does not have it
        write_vtkhdf(path, moved, {k: v for k, v in moving.items() if k != without})
        for asked, z in (("last", 10), ("0.5", 5), ("first", 0)):
            mesh, notes = read(path, "--time", asked)
            is_whole(mesh, 2)
            assert mesh["points"][:, 2].min() == z and "2 pieces were joined" in notes, notes
        mesh, notes = read(path, "--time", "all")
        is_whole(mesh, 2)
        assert mesh["points"][:, 2].min() == 0
        assert "the points move over its 3 steps" in notes, notes
        for asked, z in (("0", 0), ("0.5", 5), ("2", 10)):
            assert (mesh[f"point_Displacement@{asked}"] == [0, 0, z]).all()
    # one mesh of one partition, whose field alone changes
    static = {
        "Values": [0, 1, 2],
        **{name: [0, 0, 0] for name in ("PartOffsets", "PointOffsets", "CellOffsets")},
        "ConnectivityIdOffsets": [0, 0, 0],
        "NumberOfParts": [1, 1, 1],
        "PointDataOffsets/T": [0, n, 2 * n],
    }
    write_vtkhdf(path, [cube()], static)
    with h5py.File(path, "a") as file:
        del file["VTKHDF/PointData/T"]
        file["VTKHDF/PointData/T"] = np.concatenate([cube()[:, 0] + s for s in range(3)])
    mesh, _ = read(path, "--time", "all")
    is_whole(mesh, 1)
    for s in range(3):
        assert (mesh[f"point_T@{s}"] == mesh["points"][:, 0] + s).all()
    # each number that lies leaves a sentence
    for name, row, value, said in (
        ("PartOffsets", 2, 9, "partitions"),
        ("NumberOfParts", 0, 7, "partitions"),
        ("NumberOfParts", 0, -1, "NumberOfParts"),
        ("PointOffsets", 0, 1 << 62, "Points"),
        ("CellOffsets", 0, m + 1, "Types"),
        ("ConnectivityIdOffsets", 0, 1 << 40, "Connectivity"),
        ("PointDataOffsets/T", 0, 3 * n, "PointData/T"),
        ("Values", 1, float("nan"), "time of its step 1"),
    ):
        changed = {key: list(values) for key, values in static.items()}
        changed[name][row] = value
        write_vtkhdf(path, [cube()], changed)
        wrong = refused("check", path, "--time", "last" if row else "first")
        assert said in wrong, (name, value, wrong)


def fluent_meshes_are_read():
    if meshio:
        meshio.write(
            out / "nodes.msh", meshio.Mesh(cube(), [("tetra", TETRAHEDRA)]), "ansys", binary=False
        )
        assert (out / "nodes.msh").read_bytes().startswith(b"(")
        is_whole(read(out / "nodes.msh")[0], 1)
    faces = {}
    for number, cell in enumerate(TETRAHEDRA):
        a, b, c, d = cell
        for face in ((a, b, c), (a, c, d), (a, d, b), (b, d, c)):
            faces.setdefault(frozenset(face), []).append((face, number + 1))
    inner = [sides for sides in faces.values() if len(sides) == 2]
    outer = [sides for sides in faces.values() if len(sides) == 1]

    def section(zone, kind, first, listed):
        lines = [
            " ".join("%x" % (v + 1) for v in sides[0][0][::-1])
            + " %x %x" % (sides[0][1], sides[1][1] if len(sides) == 2 else 0)
            for sides in listed
        ]
        last = first + len(listed) - 1
        return "(13 (%x %x %x %x 3)(\n%s\n))\n" % (zone, first, last, kind, "\n".join(lines))

    text = '(0 "by hand")\n(2 3)\n(10 (0 1 8 0 3))\n(10 (1 1 8 1 3)(\n'
    text += "\n".join("%g %g %g" % tuple(p) for p in cube()) + "\n))\n"
    text += "(12 (0 1 6 0 0))\n(12 (2 1 6 1 2))\n(13 (0 1 %x 0 0))\n" % len(faces)
    text += section(3, 2, 1, inner) + section(4, 3, len(inner) + 1, outer)
    text += "(45 (2 fluid fluid)())\n(45 (3 interior inside)())\n(45 (4 wall hull)())\n"
    for mark in ("", "\ufeff"):
        for name in ("faces.msh", "faces.cas"):
            (out / name).write_text(mark + text, encoding="utf-8")
            is_whole(read(out / name)[0], 1)


def med_files_with_families_are_read():
    if not meshio or not h5py:
        return "no meshio with h5py"
    families = {-1: ["inlet"], -2: ["body", 'steel & "air"'], -3: ["bad\x01"]}
    mesh = meshio.Mesh(
        cube(),
        [("tetra", TETRAHEDRA), ("triangle", TETRAHEDRA[:1, :3])],
        point_data={"T": cube()[:, 0], "point_tags": np.zeros(8, int)},
        cell_data={"cell_tags": [np.full(6, -2), np.full(1, -1)]},
    )
    mesh.point_tags, mesh.cell_tags = {}, families
    meshio.write(out / "families.med", mesh)
    got, _ = read(out / "families.med")
    is_whole(got, 1)
    assert np.allclose(got["point_T"], got["points"][:, 0])
    assert (got["cell_cell_tags"] == -2).all()
    run("convert", out / "families.med", "-o", out / "families.vtu")
    named = (out / "families.vtu").read_bytes()
    assert b'"cell_tags=body, steel &amp; &quot;air&quot;"' in named, named[:2000]
    if shutil.which("gmsh"):
        try:  # not every Gmsh has MED
            gmsh("physical", BALL + ' Physical Volume("ball") = {1};', "-o", out / "physical.med")
        except subprocess.CalledProcessError:
            return
        assert abs(volume(read(out / "physical.med")[0]) - 4.19) < 0.6


def a_series_of_xdmf_is_read():
    if not meshio:
        return "no meshio"
    for form in ("XML", "HDF", "Binary"):  # meshio itself reads the last
        if form == "HDF" and not h5py:
            continue
        path = out / f"series-{form}.xdmf"
        before = os.getcwd()
        os.chdir(out)
        with meshio.xdmf.TimeSeriesWriter(path.name, data_format=form) as writer:
            writer.write_points_cells(cube(), [("tetra", TETRAHEDRA)])
            for i in range(3):
                writer.write_data(i / 4, point_data={"T": cube()[:, 0] + i})
        os.chdir(before)
        mesh, notes = read(path)
        assert (mesh["point_T"] == mesh["points"][:, 0] + 2).all() and "3 time steps" in notes
        mesh, _ = read(path, "--time", "0.25")
        assert (mesh["point_T"] == mesh["points"][:, 0] + 1).all()
        mesh, _ = read(path, "--time", "all")
        assert {"point_T@0", "point_T@0.25", "point_T@0.5"} <= set(mesh), set(mesh)
        mesh, _ = read(path, "--time", "0,0.5")
        assert {"point_T@0", "point_T@0.5"} == {name for name in mesh if "@" in name}, set(mesh)
        assert "it has 0, 0.25, 0.5" in refused("check", path, "--time", "9")
    (out / "temporary").mkdir(exist_ok=True)
    relative = dict(os.environ, TMPDIR="temporary")
    done = subprocess.run([qtet, "check", path], cwd=out, env=relative, capture_output=True)
    assert done.returncode == 0, done


def xdmf(path, body, head=""):
    body = f'<Xdmf Version="3.0"><Domain>{body}</Domain></Xdmf>'
    path.write_text(f'<?xml version="1.0"?>{head}{body}')


def item(values, kind="Float", precision=8):
    rows = np.asarray(values)
    text = " ".join(repr(x) for x in rows.ravel().tolist())
    return '<DataItem Dimensions="%s" NumberType="%s" Precision="%d" Format="XML">%s</DataItem>' % (
        " ".join(map(str, rows.shape)), kind, precision, text)


def xdmf_of_fenics_is_read_here():
    """As dolfinx and dolfin write it: one mesh, and series that include it."""
    path = out / "fenics.xdmf"
    mesh = '<Topology TopologyType="Tetrahedron" NumberOfElements="6" NodesPerElement="4">'
    mesh += item(TETRAHEDRA, "Int") + '</Topology><Geometry GeometryType="XYZ">'
    mesh += item(cube()) + "</Geometry>"

    def series(name, pointer, values, first=""):
        grids = ""
        for step in range(3):
            inner = first if step == 0 and first else (
                f'<xi:include xpointer="xpointer({pointer}/*[self::Topology or self::Geometry])"/>')
            grids += f'<Grid Name="{name}" GridType="Uniform">{inner}<Time Value="{step / 2}"/>'
            grids += f'<Attribute Name="{name}" AttributeType="Scalar" Center="Node">'
            grids += item(values + step) + "</Attribute></Grid>"
        kind = 'GridType="Collection" CollectionType="Temporal"'
        return f'<Grid Name="{name}" {kind}>{grids}</Grid>'

    x, y = cube()[:, 0], cube()[:, 1:2]
    alone = f'<Grid Name="mesh" GridType="Uniform">{mesh}</Grid>'
    path_x = "/Xdmf/Domain/Grid[@GridType='Uniform'][1]"
    doctype = '<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>'
    xdmf(path, alone + series("u", path_x, x) + series("p", path_x, y), doctype)
    got, notes = read(path)
    is_whole(got, 1)
    assert "of its 3 time steps the last is read, 1" in notes, notes
    assert (got["point_u"] == got["points"][:, 0] + 2).all()
    assert (got["point_p"].ravel() == got["points"][:, 1] + 2).all()
    got, _ = read(path, "--time", "all")
    assert {"point_u@0.5", "point_p@1"} <= set(got), set(got)
    # dolfin: the first step has the mesh itself
    path_x = "//Grid[@Name=&quot;u&quot;]/Grid[1]"
    xdmf(path, series("u", path_x, x, mesh))
    assert (read(path)[0]["point_u"] == got["points"][:, 0] + 2).all()
    # two kinds of cells and a triangle in one list
    points = np.concatenate([cube(), [[0.5, 0.5, 2]]])
    top = [v for v in range(8) if cube()[v, 2] == 1]
    ring = sorted(top, key=lambda v: np.arctan2(*(cube()[v, :2] - 0.5)), reverse=True)
    mixed = [n for cell in TETRAHEDRA for n in (6, *cell)] + [4, 0, 1, 2] + [7, *ring, 8]
    body = '<Grid><Topology TopologyType="Mixed" NumberOfElements="8">' + item(mixed, "Int")
    body += "</Topology><Geometry>" + item(points) + "</Geometry>"
    for name, values in ("a", np.arange(8)), ("v", np.ones((8, 3))):
        body += f'<Attribute Name="{name}" Center="Cell">' + item(values) + "</Attribute>"
    xdmf(path, body + "</Grid>")
    got, notes = read(path)
    assert len(got["tetrahedra"]) == 8 and abs(volume(got) - 4 / 3) < 1e-12
    assert sorted(set(got["cell_a"])) == [0, 1, 2, 3, 4, 5, 7] and "were ignored" in notes
    # what lies, and what XML must not do
    sound = f'<Grid Name="mesh">{mesh}<Attribute Name="u" Center="Node">{item(x)}</Attribute>'
    sound += "</Grid>"
    xdmf(path, sound)
    is_whole(read(path)[0], 1)
    for old, new, said in (
        ('NumberOfElements="6"', 'NumberOfElements="7"', "says 7 cells"),
        ('"6 4"', '"7 4"', "Dimensions"),
        ('"8"', '"-8"', "Dimensions"),
        ("<Geometry", "<Geometry2", None),
        ("0.0 ", "zero ", "is no number"),
        ('Format="XML">0', 'Format="HDF">none.h5:/0', "none.h5"),
        ('Format="XML">0', 'Format="HDF">0', "no FILE.h5:ARRAY"),
        ("</Topology>", "", "mismatched tag"),
    ):
        assert old in sound, old
        xdmf(path, sound.replace(old, new))
        wrong = refused("check", path)
        assert said is None or said in wrong, (old, wrong)
    xdmf(path, sound, '<!DOCTYPE Xdmf [<!ENTITY a "b">]>')
    assert "declares an entity" in refused("check", path)


def abaqus_of_second_order_is_read():
    if not shutil.which("gmsh"):
        return "no gmsh"
    gmsh("second", BALL, "-order", "2", "-o", out / "second.inp")
    assert "C3D10" in (out / "second.inp").read_text()
    assert abs(volume(read(out / "second.inp")[0]) - 4 * np.pi / 3) < 0.05


def unv(path, points, elements, beams=""):
    text = "    -1\n   164\n         1  SI\n    -1\n    -1\n  2411\n"
    for i, p in enumerate(points):
        text += "%10d%10d%10d%10d\n" % (2 * i + 5, 1, 1, 11)
        text += "".join("%25.16E" % x for x in p).replace("E", "D") + "\n"
    text += "    -1\n    -1\n  2412\n" + beams
    for i, (descriptor, nodes) in enumerate(elements):
        text += "%10d%10d%10d%10d%10d%10d\n" % (i + 1, descriptor, 1, 1, 7, len(nodes))
        labels = ["%10d" % (2 * n + 5) for n in nodes]
        text += "".join("".join(labels[k : k + 8]) + "\n" for k in range(0, len(labels), 8))
    path.write_text(text + "    -1\n    -1\n  2467\n         1         0\nwall\n    -1\n")


def universal_files_are_read():
    path = out / "salome.unv"
    beams = "%10d%10d%10d%10d%10d%10d\n%10d%10d%10d\n%10d%10d\n" % (
        99, 11, 2, 1, 7, 2, 0, 0, 0, 5, 7)
    unv(path, cube(), [(111, cell) for cell in TETRAHEDRA] + [(91, (0, 1, 2))], beams)
    mesh, notes = read(path)
    is_whole(mesh, 1)
    assert "2 points, lines and faces" in notes, notes
    square, triangle = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 0), (1, 0), (0, 1)]

    def ring(corners, z):
        """Corner and middle in turn."""
        for i, a in enumerate(corners):
            b = corners[(i + 1) % len(corners)]
            yield from ((*a, z), ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, z))

    def between(corners, share):
        return [(*c, share) for c in corners]

    tetrahedron = [*ring(triangle, 0), *[(x / 2, y / 2, 0.5) for x, y in triangle], (0, 0, 1)]
    for descriptor, nodes, wanted in (
        (115, between(square, 0) + between(square, 1), 1),
        (112, between(triangle, 0) + between(triangle, 1), 1 / 2),
        (118, tetrahedron, 1 / 6),
        (113, [*ring(triangle, 0), *between(triangle, 0.5), *ring(triangle, 1)], 1 / 2),
        (116, [*ring(square, 0), *between(square, 0.5), *ring(square, 1)], 1),
    ):
        unv(path, nodes, [(descriptor, range(len(nodes)))])
        mesh, _ = read(path)
        assert abs(volume(mesh) - wanted) < 1e-6, descriptor
        corners = mesh["points"][mesh["tetrahedra"]]
        edges = corners[:, 1:] - corners[:, :1]
        assert (np.linalg.det(edges) > 0).all(), descriptor
    for elements, said in (
        ([(114, range(5))], "descriptor 114"),
        ([(111, range(5))], "descriptor 111"),
        ([(111, [0, 1, 2, 77])], "without 4 vertices"),
        ([(111, [0, 1, 2, -9])], "no number of a node"),
    ):
        unv(path, cube(), elements)
        assert said in refused("check", path), (said, refused("check", path))
    unv(path, cube(), [(111, cell) for cell in TETRAHEDRA])
    whole = path.read_text()
    at = whole.index("  2412")
    for length in range(at + 10, whole.index("  2467") - 20, 37):
        path.write_text(whole[:length])
        refused("check", path)


def nastrans_bulk_data_need_no_line_before_them():
    if not meshio:
        return "no meshio"
    points = "".join(
        "GRID    %-8d0       %-8.3f%-8.3f%-8.3f\n" % (i + 1, *p) for i, p in enumerate(cube())
    )
    cells = "".join(
        "CTETRA  %-8d1       %-8d%-8d%-8d%-8d\n" % (i + 1, *(c + 1))
        for i, c in enumerate(TETRAHEDRA)
    )
    for head in ("$ Created by Gmsh\n", "SOL 101\nCEND\nBEGIN BULK\n"):
        (out / "bulk.bdf").write_text(head + points + cells + "ENDDATA\n")
        is_whole(read(out / "bulk.bdf")[0], 1)


def fields_of_med_with_times_are_a_series():
    if not meshio or not h5py:
        return "no meshio or h5py"
    path = out / "steps.med"
    mesh = meshio.Mesh(cube(), [("tetra", TETRAHEDRA)], {"u": cube()[:, 0], "still": cube()[:, 1]})
    meshio.write(path, mesh)
    with h5py.File(path, "r+") as file:
        steps = file["CHA"]["u"]
        first = list(steps)[0]
        second = first[:-1] + "9"
        steps.copy(first, second)
        steps[second].attrs["PDT"] = 0.123456789
        for values in (o for o in steps[second]["NOE"].values() if "CO" in o):
            values["CO"][...] += 10
    shown = json.loads(run("check", path, "--json", "--time", "all").stdout)
    names = sorted(field.split()[1] for field in shown["fields"])
    assert names == ["still@0", "still@0.123456789", "u@0", "u@0.123456789"], shown
    assert run("convert", path, "-o", out / "last.vtu").returncode == 0
    assert arrays_of(out / "last.vtu")["point_u"].min() == 10


def meshio_says_why():
    if not meshio:
        return "no meshio"
    (out / "wrong.off").write_text("nonsense\n")
    said = refused("check", out / "wrong.off")
    assert "ReadError" in said and "Couldn't read file" not in said, said


def an_unknown_ending_is_told_what_there_is():
    (out / "mesh.nonsense").write_text("nothing")
    said = refused("check", out / "mesh.nonsense")
    assert "--format" in said and "vtu" in said and "su2" in said, said
    (out / "named.data").write_bytes((meshes / "p_0.vtu").read_bytes())
    is_whole(read(out / "named.data", "--format", "vtu")[0], 2)
    text = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
    text += "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"
    (out / "abaqus.data").write_text(text)
    assert len(read(out / "abaqus.data", "--format", "inp")[0]["tetrahedra"]) == 1


def write_exodus(path, x):
    writer = vtk.vtkExodusIIWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid_of(cube(x), [("T", cube(x)[:, 0])]))
    writer.Write()


def pieces_of_exodus_are_read_together():
    for x in range(3):
        write_exodus(out / f"part.e.3.{x}", x)
    for given in range(3):
        mesh, notes = read(out / f"part.e.3.{given}")
        is_whole(mesh, 3)
        assert "joined at 8 points" in notes, notes
        assert np.allclose(mesh["point_T"], mesh["points"][:, 0])
    (out / "part.e.3.3").write_bytes((out / "part.e.3.0").read_bytes())
    assert "from 0 to N - 1" in refused("check", out / "part.e.3.3")
    (out / "part.e.3.1").unlink()
    said = refused("check", out / "part.e.3.0")
    assert "part.e.3.1 is missing" in said, said


def foam(kind, name, body, place):
    place.mkdir(parents=True, exist_ok=True)
    (place / name).write_text(
        "FoamFile\n{\n version 2.0;\n format ascii;\n class %s;\n object %s;\n}\n%s\n"
        % (kind, name, body)
    )


def foam_list(values):
    return "%d\n(\n%s\n)\n" % (len(values), "\n".join(values))


def write_processor(folder, x):
    """Two cubes of the six from x on; the second shares a face with the next processor."""
    points = np.array([[x + i, j, k] for i in range(3) for k in (0, 1) for j in (0, 1)], float)
    inner, low, high = [4, 5, 7, 6], [0, 2, 3, 1], [8, 9, 11, 10]
    sides = []
    for c in (0, 1):
        b = 4 * c
        for quad in ([0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]):
            sides.append(([b + v for v in quad], c))
    faces = [inner, low] + [quad for quad, _ in sides] + [high]
    owner = [0, 0] + [c for _, c in sides] + [1]
    mesh = folder / "constant" / "polyMesh"
    listed = foam_list(["(%g %g %g)" % tuple(p) for p in points])
    foam("vectorField", "points", listed, mesh)
    foam("faceList", "faces", foam_list(["4(%d %d %d %d)" % tuple(q) for q in faces]), mesh)
    foam("labelList", "owner", foam_list([str(c) for c in owner]), mesh)
    foam("labelList", "neighbour", foam_list(["1"]), mesh)
    patches = "2\n(\n walls { type wall; nFaces %d; startFace 1; }\n" % (len(faces) - 2)
    patches += " procBoundary0to1 { type processor; nFaces 1; startFace %d;" % (len(faces) - 1)
    patches += " myProcNo 0; neighbProcNo 1; }\n)\n"
    foam("polyBoundaryMesh", "boundary", patches, mesh)
    sides = "boundaryField { walls { type zeroGradient; } procBoundary0to1 { type processor; } }\n"
    for time_ in ("0", "0.5"):
        body = "dimensions [0 0 0 1 0 0 0];\ninternalField nonuniform List<scalar> 2(%g %g);\n" % (
            x + float(time_),
            x + 1 + float(time_),
        )
        foam("volScalarField", "T", body + sides, folder / time_)


def a_decomposed_case_is_read_from_its_processors():
    case = write_case(out / "decomposed").parent
    mesh, notes = read(case / "case.foam")
    is_whole(mesh, 6)
    assert "3 processors" in notes and "joined at 8 points" in notes, notes
    for words, at in ((), 0.5), (("--time", "0"), 0):
        mesh, notes = read(case / "case.foam", *words)
        x = mesh["points"][:, 0]  # the mean of the cells at both sides, across the seams, too
        assert np.allclose(mesh["point_T"], np.clip(x - 0.5, 0, 5) + at), (words, mesh["point_T"])
        assert "--fields cell:T keeps those of cells" in notes, notes
        mesh, _ = read(case / "case.foam", "--fields", "cell:T", *words)
        middle = mesh["points"][mesh["tetrahedra"]].mean(axis=1)[:, 0]
        assert np.allclose(mesh["cell_T"], np.floor(middle) + at), (words, mesh["cell_T"])
    shutil.rmtree(case / "processor1")
    assert "processor1 is missing" in refused("check", case / "case.foam")


def write_case(case, processors=(0, 2, 4)):
    control = "startTime 0;\nendTime 0.5;\ndeltaT 0.5;\nwriteControl timeStep;\nwriteInterval 1;\n"
    shutil.rmtree(case, ignore_errors=True)
    foam("dictionary", "controlDict", control, case / "system")
    for number, x in enumerate(processors):
        write_processor(case / f"processor{number}", x)
    (case / "case.foam").write_text("")
    return case / "case.foam"


def meshes_of_openfoam_are_checked():
    case = out / "checked"
    mesh = case / "processor1" / "constant" / "polyMesh"

    def swap(lines, i, j):
        first = lines.index("(") + 1
        lines[first + i], lines[first + j] = lines[first + j], lines[first + i]

    def drop(lines, i):
        del lines[lines.index("(") + 1 + i]

    for name, change, said in (
        ("boundary", lambda lines: lines.clear(), "does not begin with FoamFile"),
        ("boundary", lambda lines: swap(lines, 0, 1), None),
        ("boundary", lambda lines: drop(lines, 1), "1 patches"),
        ("faces", lambda lines: swap(lines, 0, 1), "do not close"),
        ("faces", lambda lines: swap(lines, 2, 7), "do not close"),
        ("faces", lambda lines: drop(lines, 3), "is not an index"),
        ("owner", lambda lines: swap(lines, 2, 6), "do not close"),
        ("owner", lambda lines: drop(lines, 2), "is not an index"),
        ("neighbour", lambda lines: lines.__setitem__(lines.index("(") + 1, "0"), "and itself"),
        ("neighbour", lambda lines: lines.__setitem__(lines.index("(") + 1, "70"), "number 70"),
        ("points", lambda lines: drop(lines, 3), None),
        ("points", lambda lines: lines.clear(), "does not begin with FoamFile"),
    ):
        marker = write_case(case)
        lines = (mesh / name).read_text().split("\n")
        change(lines)
        (mesh / name).write_text("\n".join(lines))
        if said:
            wrong = refused("check", marker)
            assert said in wrong and "processor1/constant/polyMesh/" in wrong, (name, wrong)
    for name in ("points", "faces", "owner", "neighbour", "boundary"):
        marker = write_case(case)
        (mesh / name).unlink()
        assert f"polyMesh/{name}" in refused("check", marker), name
    marker = write_case(case)
    for time_ in ("0", "0.5"):
        (case / "processor1" / time_ / "T").unlink()
    notes = read(marker)[1]
    assert "T is not in 1 of 3 blocks" in notes and "block 1 is the first" in notes, notes
    shutil.rmtree(case / "processor1" / "0.5")
    wrong = refused("check", marker)
    assert "0.5 in piece 0 and 0 in piece 1" in wrong, wrong
    field = case / "processor0" / "0" / "T"
    field.write_text(field.read_text().replace("2(0 1)", "3(0 1)"))
    wrong = refused("check", marker, "--time", 0)
    assert str(case / "processor0") in wrong and "/qtet-" not in wrong, wrong
    # one folder, compressed and binary
    marker = write_case(case, ())
    write_processor(case, 0)
    mesh = case / "constant" / "polyMesh"
    listed = [mesh / name for name in ("points", "faces", "owner", "neighbour")]
    for file in (*listed, case / "0.5" / "T"):
        file.with_name(file.name + ".gz").write_bytes(gzip.compress(file.read_bytes()))
        file.unlink()
    packed, _ = read(marker)
    is_whole(packed, 2)
    assert np.allclose(packed["point_T"], np.clip(packed["points"][:, 0] - 0.5, 0, 1) + 0.5)
    write_processor(case, 0)
    lines = (mesh / "faces").read_text().split("\n")
    faces = [[int(v) for v in line[2:-1].split()] for line in lines if line.startswith("4(")]

    def labels(values):
        return b"%d\n(%s)\n" % (len(values), np.array(values, "<i4").tobytes())

    ends = np.cumsum([0] + [len(face) for face in faces])
    for name, kind, body in (
        ("faces", "faceCompactList", labels(ends) + labels(np.concatenate(faces))),
        ("neighbour", "labelList", labels([1])),
    ):
        (mesh / f"{name}.gz").unlink()
        head = 'FoamFile\n{\n version 2.0;\n format binary;\n class %s;\n object %s;\n'
        head += ' arch "LSB;label=32;scalar=64";\n}\n'
        (mesh / name).write_bytes((head % (kind, name)).encode() + body)
    is_whole(read(marker)[0], 2)
    damaged = (mesh / "faces").read_bytes()
    at = damaged.index(np.array(faces[2], "<i4").tobytes())
    (mesh / "faces").write_bytes(damaged[:at] + damaged[at + 4 : at + 8] + damaged[at : at + 4]
                                 + damaged[at + 8 :])
    assert "do not close" in refused("check", marker)


def an_interrupt_ends_a_reader_that_hangs():
    """A foreign reader that waits for ever goes with the tool."""
    (out / "hangs.cas").write_text('(0 "by hand")\n')
    os.mkfifo(out / "hangs.dat")  # VTK looks for results there
    fake = out / "fake"
    fake.mkdir()
    (fake / "python3").write_text(f"#!/bin/sh\necho $$ >{out.resolve()}/fake/id\nexec sleep 60\n")
    (fake / "python3").chmod(0o755)
    (out / "hangs.med").write_text("nothing")
    environment = dict(os.environ, PATH=f"{fake.resolve()}:{os.environ['PATH']}")
    for words in (
        ("check", "hangs.cas"),
        ("convert", "hangs.cas", "-o", "hung.vtu"),
        ("simplify", "hangs.cas", "-o", "hung.qtet"),
        ("check", "hangs.med"),
        ("simplify", "hangs.med", "-o", "hung.qtet"),
    ):
        tool = subprocess.Popen(
            [qtet, *words], cwd=out, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        readers = []
        for _ in range(100):
            time.sleep(0.05)
            readers = [p for p in os.listdir("/proc") if p.isdigit() and parent_of(p) == tool.pid]
            if readers:
                break
        time.sleep(0.3)
        assert tool.poll() is None and readers, (words, tool.communicate())
        tool.send_signal(signal.SIGINT)
        began = time.monotonic()
        tool.wait(5)
        assert time.monotonic() - began < 2, words
        deadline = time.monotonic() + 5
        while any(is_running(reader) for reader in readers) and time.monotonic() < deadline:
            time.sleep(0.05)
        assert not any(is_running(reader) for reader in readers), (words, readers)
    assert not (out / "hung.vtu").exists() and not (out / "hung.qtet").exists()


def status_of(process):
    """Its state and its parent; a zombie has ended."""
    try:
        words = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError):
        return "Z", 0
    return words[0], int(words[1])


def parent_of(process):
    return status_of(process)[1]


def is_running(process):
    return status_of(process)[0] != "Z"


def pipes_are_read_like_files():
    text = (meshes / "p_0.vtu").read_bytes()
    for words in (("/dev/stdin", "--format", "vtu"), ("-", "--format", "vtu")):
        done = subprocess.run([qtet, "check", *words], input=text, capture_output=True)
        assert done.returncode == 0 and b"simplify takes it" in done.stdout, done
    command = f'"{qtet}" check <(cat "{meshes}/p_0.vtu") --format vtu'
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == 0, done
    pipe = out / "named.vtu"
    os.mkfifo(pipe)
    writer = subprocess.Popen(["cp", meshes / "p_0.vtu", pipe])
    assert run("check", pipe, timeout=60).returncode == 0
    writer.wait()
    said = subprocess.run(
        ["bash", "-c", f'"{qtet}" check <(cat "{meshes}/p_0.vtu")'], capture_output=True, text=True
    )
    assert said.returncode == 2 and "--format" in said.stderr, said


TESTS = [
    medit_files_of_order_three_are_read,
    compressed_files_are_read,
    fluent_meshes_are_read,
    med_files_with_families_are_read,
    partitions_of_vtkhdf_become_one_mesh,
    steps_of_vtkhdf_are_read_by_their_offsets,
    a_series_of_xdmf_is_read,
    xdmf_of_fenics_is_read_here,
    abaqus_of_second_order_is_read,
    universal_files_are_read,
    nastrans_bulk_data_need_no_line_before_them,
    fields_of_med_with_times_are_a_series,
    meshio_says_why,
    an_unknown_ending_is_told_what_there_is,
    a_decomposed_case_is_read_from_its_processors,
    meshes_of_openfoam_are_checked,
    an_interrupt_ends_a_reader_that_hangs,
    pipes_are_read_like_files,
    a_list_of_files_is_a_series,
    pieces_of_exodus_are_read_together,
]
chosen = sys.argv[4:]
failed = 0
for test in TESTS:
    if chosen and test.__name__ not in chosen:
        continue
    try:
        missing = test()
        print(test.__name__, f"skipped: {missing}" if missing else "done")
    except Exception as error:
        failed += 1
        print(test.__name__, "FAILED", type(error).__name__, str(error)[:600])
sys.exit(failed)

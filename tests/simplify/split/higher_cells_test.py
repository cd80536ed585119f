"""Cells of higher degree that VTK's own source makes, and Gmsh where it is installed, through `qtet
convert`: the tetrahedra must fill the same volume and meet face to face.
   higher_cells_test.py QTET-PROGRAM FOLDER-TO-WRITE-TO
It ends with 77 where VTK's Python modules or numpy are missing."""
import math
import pathlib
import shutil
import subprocess
import sys

try:
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import (
        vtkBezierHexahedron,
        vtkHigherOrderHexahedron,
        vtkUnstructuredGrid,
    )
    from vtkmodules.vtkFiltersSources import vtkCellTypeSource
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

program, out = sys.argv[1], pathlib.Path(sys.argv[2])


def write(grid, name):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(out / name))
    assert writer.Write()
    return out / name


def converted(path, *words):
    """Points and tetrahedra of what qtet makes of the file."""
    subprocess.run(
        [program, "convert", path, "-o", out / "split.vtu", *words], check=True, capture_output=True
    )
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(out / "split.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float), vtk_to_numpy(
        grid.GetCells().GetConnectivityArray()
    ).reshape(-1, 4)


def fills(points, tetrahedra, volume, what):
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    assert volumes.min() > 0, (what, "inverted tetrahedra", volumes.min())
    assert volume is None or abs(volumes.sum() - volume) < 1e-5 * volume, (
        what,
        volumes.sum(),
        volume,
    )
    faces = np.sort(np.concatenate([np.delete(tetrahedra, k, axis=1) for k in range(4)]), axis=1)
    faces, counts = np.unique(faces, axis=0, return_counts=True)
    assert counts.max() == 2, (what, "faces of more than two")
    hull = faces[counts == 1]
    _, sides = np.unique(
        np.sort(np.concatenate([np.delete(hull, k, axis=1) for k in range(3)]), axis=1),
        axis=0,
        return_counts=True,
    )
    assert (sides == 2).all(), (what, "the hull is not closed: neighbours cut a face differently")
    return len(hull)


def sources():
    """Lagrange and Bezier tetrahedra, hexahedra, wedges. (Some nodes of the third degree's
    tetrahedra VTK makes twice.)"""
    for kind in (71, 72, 73, 78, 79, 80):
        for degree in (2, 3, 4):
            source = vtkCellTypeSource()
            source.SetCellType(kind)
            source.SetCellOrder(degree)
            source.SetBlocksDimensions(2, 1, 1)
            source.Update()
            hull = fills(
                *converted(write(source.GetOutput(), "higher.vtu"), "--weld", "1e-6"),
                2,
                (kind, degree),
            )
            flat = (
                5 * 2 * 2 * 2 if kind in (71, 78) else 5 * 2 * 2
            )  # triangles on the hull of degree 1: VTK cuts a block into 12 tetrahedra
            assert hull % (degree * degree) == 0 and hull // (degree * degree) in (
                flat,
                5 * 2 * 2,
            ), (kind, degree, hull)


def rational():
    """A quarter of a pipe, exactly: degrees and weights are attributes of the file."""
    degrees = (2, 1, 1)
    points, weights = {}, {}
    for i in range(3):
        for j in range(2):
            for k in range(2):
                at = vtkHigherOrderHexahedron.PointIndexFromIJK(i, j, k, degrees)
                points[at] = ((2 - j) * (i < 2), (2 - j) * (i > 0), k)
                weights[at] = math.sqrt(0.5) if i == 1 else 1
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    for at in sorted(points):
        places.InsertNextPoint(points[at])
    grid.SetPoints(places)
    grid.InsertNextCell(vtkBezierHexahedron().GetCellType(), len(points), range(len(points)))
    for data, set_it, values, name in (
        (
            grid.GetPointData(),
            "SetRationalWeights",
            [weights[at] for at in sorted(weights)],
            "RationalWeights",
        ),
        (grid.GetCellData(), "SetHigherOrderDegrees", [degrees], "HigherOrderDegrees"),
    ):
        array = numpy_to_vtk(np.array(values, float), deep=True)
        array.SetName(name)
        getattr(data, set_it)(array)
    points, tetrahedra = converted(write(grid, "pipe.vtu"), "--fields", "none")
    radii = np.hypot(points[:, 0], points[:, 1])
    assert np.allclose(np.where(radii > 1.5, radii - 2, radii - 1), 0, atol=1e-6), radii
    assert len(tetrahedra) == 12 and fills(points, tetrahedra, None, "rational")


def gmsh():
    if not shutil.which("gmsh"):
        return print("no gmsh: its elements of higher degree were not tried")
    (out / "ball.geo").write_text(
        'SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1}; Mesh.MeshSizeMax = 0.7;'
    )
    (out / "bar.geo").write_text(
        'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 1, 1}; Mesh.MeshSizeMax = 0.6;\n'
        "Extrude {0, 0, 2} { Surface{1}; Layers{2}; Recombine; }"
    )
    (out / "bricks.geo").write_text(
        'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 2}; Transfinite Curve {:} = 3;'
        " Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};"
    )
    for name, degrees, volume in (
        ("ball", (2, 3, 4, 5, 6), None),
        ("bar", (2, 3, 4, 5), 2),
        ("bricks", (2, 3, 4, 5), 2),
    ):
        for degree in degrees:
            made = out / f"{name}{degree}.msh"
            subprocess.run(
                ["gmsh", out / f"{name}.geo", "-3", "-order", str(degree), "-o", made],
                check=True,
                capture_output=True,
            )
            fills(*converted(made, "--fields", "none"), volume, (name, degree))
    mixed()


def mixed():
    """A hexahedron, a pyramid on it, tetrahedra on the pyramid and a prism beside the hexahedron,
    of every degree that there is, and bent."""
    linear = pathlib.Path(__file__).parent.parent / "read" / "meshes" / "gmsh-mixed1.msh"
    for degree in (2, 3, 5, 9):
        made, script = out / f"mixed{degree}.msh", out / "mixed.geo"
        script.write_text(
            f'Merge "{linear}";\nSetOrder {degree};\nMesh.SaveAll = 1;\nSave "{made}";\n'
        )
        subprocess.run(["gmsh", script, "-"], check=True, capture_output=True)
        points, tetrahedra = converted(made, "--fields", "none")
        fills(points, tetrahedra, 1 + 0.6 / 3 + 4 * 0.55 / 6 + 0.5, ("mixed", degree))
        if degree > 2:
            assert len(tetrahedra) == 15 * degree**3, (degree, len(tetrahedra))
        bent = points + 0.05 * np.sin(2 * points[:, [1, 2, 0]])
        fills(bent, tetrahedra, None, ("bent", degree))


sources()
rational()
gmsh()
print("cells of higher degree fill what they filled")

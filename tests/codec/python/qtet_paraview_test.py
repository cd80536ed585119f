"""The ParaView plugin in pvbatch, off-screen: files, levels, errors, fields, URLs, and a picture
that is not empty.
   pvbatch --force-offscreen-rendering qtet_paraview_test.py PLUGIN LOG FOLDER-TO-WRITE-TO [URL]
QTET_LIBRARY names libqtet.so. The log, and what the URL gives, is made of `qtet sample fin`, with
its errors measured."""
import inspect
import os
import pathlib
import sys

from paraview import simple, vtk
from vtkmodules.vtkIOImage import vtkPNGReader

# ParaView 5.11.0 under Python 3.11, as in Debian 12, can load no Python plugin at all without this
# (mended in 5.11.1).
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

plugin, path, out = sys.argv[1:4]
simple.LoadPlugin(plugin, remote=False, ns=globals())
sys.path.insert(0, os.path.dirname(plugin))
from qtet import vtk as qtet_vtk  # noqa: E402

with qtet_vtk.Log(path) as log:
    levels = log.info.levels
    sizes = [log.level_info(level).tetrahedra for level in range(levels)]
    boundary_percent = 100 * log.level_info(2).boundaryDistance
    by_boundary = log.level_of_error("boundary", log.level_info(2).boundaryDistance)


def cells(source):
    source.UpdatePipeline()
    return source.GetDataInformation().GetNumberOfCells()


def has(source, name):
    source.UpdatePipeline()
    return source.PointData.GetArray(name) is not None


def check(source):
    source.UpdatePipelineInformation()
    assert list(source.GetProperty("LevelRange")) == [0, levels - 1], list(
        source.GetProperty("LevelRange")
    )
    slider = source.SMProxy.GetProperty("Level").GetDomain("range")
    assert (slider.GetMinimum(0, vtk.reference(0)), slider.GetMaximum(0, vtk.reference(0))) == (
        0,
        levels - 1,
    ), "the slider's range"
    assert source.Level == 0 and cells(source) == sizes[0], f"opens at level {source.Level}"
    source.Level = levels + 400
    assert cells(source) not in sizes[1:], "a level that there is none of was shown"
    for level in (levels - 1, 0, levels // 2):
        source.Level = level
        assert cells(source) == sizes[level], (level, cells(source), sizes)
    source.ChooseBy, source.ErrorPercent = "Boundary error", boundary_percent * 1.0001
    assert cells(source) == sizes[by_boundary], (cells(source), by_boundary, sizes)
    source.ChooseBy, source.ErrorField, source.ErrorPercent = "Field error", "Density", 0.0
    assert cells(source) == sizes[-1]
    source.ChooseBy = "Level"


reader = simple.OpenDataFile(path)
assert reader.GetXMLName() == "QtetReader", reader
check(reader)
assert has(reader, "Density") and has(reader, "Velocity")
reader.Fields = ["Velocity"]
assert has(reader, "Velocity") and not has(reader, "Density"), "a field that is not wanted was read"
reader.Fields = ["Density", "Velocity"]


def picture_has_colours():
    view = simple.CreateView("RenderView")
    view.ViewSize = [200, 200]
    shown = simple.Show(reader, view)
    simple.ColorBy(shown, ("POINTS", "Density"))
    simple.ResetCamera(view)
    picture = str(pathlib.Path(out) / "paraview.png")
    simple.SaveScreenshot(picture, view)
    loaded = vtkPNGReader()
    loaded.SetFileName(picture)
    loaded.Update()
    scalars = loaded.GetOutput().GetPointData().GetScalars()
    colours = {scalars.GetTuple(i) for i in range(0, scalars.GetNumberOfTuples(), 7)}
    assert len(colours) > 20, f"the picture has {len(colours)} colours"


if os.environ.get("DISPLAY"):
    picture_has_colours()
else:
    print(
        "no picture: Debian's ParaView draws on an X server alone, and DISPLAY names none"
        " (xvfb-run gives one)"
    )

if len(sys.argv) > 4:
    check(QtetURL(Url=sys.argv[4]))  # noqa: F821: LoadPlugin put it here
    check(QtetURL(Url=sys.argv[4], Level=0))  # noqa: F821
print("the plugin shows what qtet_vtk reads")

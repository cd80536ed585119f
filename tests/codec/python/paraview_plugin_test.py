"""The plugin's classes in VTK alone, with a stand-in for ParaView's decorators: the level with which
a log opens, levels that there are none of, and what the slider is told.
   paraview_plugin_test.py LIBRARY QTET-PROGRAM MODULES FOLDER-OF-LOGS FOLDER-TO-WRITE-TO
It ends with 77 where VTK is not installed. paraview.sh runs the plugin in ParaView itself."""
import contextlib
import io
import os
import pathlib
import stat
import subprocess
import sys
import types
import xml.etree.ElementTree as xml

library, program, modules, logs, out = sys.argv[1:]
os.environ["QTET_LIBRARY"] = library
sys.path.insert(0, modules)
try:
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

LOG, OUT = pathlib.Path(logs) / "solid.qtet", pathlib.Path(out)
PROPERTIES = []


class StandIn:
    """smproxy, smproperty, smdomain and smhint: decorators that change nothing."""

    def __getattr__(self, name):
        def of(*texts, **_):
            if name == "xml":
                PROPERTIES.extend(texts)
            return lambda decorated: decorated

        return of


def plugin():
    stand_in = types.ModuleType("paraview.util.vtkAlgorithm")
    stand_in.VTKPythonAlgorithmBase = VTKPythonAlgorithmBase
    for name in ("smproxy", "smproperty", "smdomain", "smhint"):
        setattr(stand_in, name, StandIn())
    for name in ("paraview", "paraview.util"):
        sys.modules[name] = types.ModuleType(name)
    sys.modules[stand_in.__name__] = stand_in
    from qtet import paraview_plugin as qtet_paraview

    return qtet_paraview


def cells(source):
    source.Update()
    return source.GetOutputDataObject(0).GetNumberOfCells()


def a_log_opens_at_its_coarsest_level(module):
    from qtet import vtk as qtet_vtk

    with qtet_vtk.Log(LOG) as log:
        sizes = [log.level_info(level).tetrahedra for level in range(log.info.levels)]
    source = module.QtetReader()
    source.SetFileName(str(LOG))
    assert source.GetLevelRange() == (0, len(sizes) - 1)
    assert cells(source) == sizes[0]
    source.SetLevel(len(sizes) - 1)
    assert cells(source) == sizes[-1]
    return source, sizes


def a_level_that_there_is_none_of_is_an_error(source, sizes):
    said = io.StringIO()
    source.SetLevel(500)
    with contextlib.redirect_stderr(said):
        source.Update()
    assert f"no level 500; the last is {len(sizes) - 1}" in said.getvalue(), said.getvalue()
    source.SetLevel(0)
    assert cells(source) == sizes[0], "an error is the end of it"


def a_series_has_time_steps(module):
    source = module.QtetReader()
    source.SetFileName(str(LOG.with_name("series.qtet")))
    source.UpdateInformation()
    information, steps = source.GetOutputInformation(0), Pipeline.TIME_STEPS()
    times = [information.Get(steps, i) for i in range(information.Length(steps))]
    assert len(times) > 2 and times == sorted(times), times
    found = set()
    for time in times:
        source.UpdateTimeStep(time)
        grid = source.GetOutputDataObject(0)
        assert grid.GetInformation().Get(grid.DATA_TIME_STEP()) == time
        data = grid.GetPointData()
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        assert not any("@" in name for name in names), names
        found.add(tuple(data.GetArray(0).GetValue(i) for i in range(4)))
    assert len(found) == len(times), "every time shows its own values"


def the_slider_begins_at_the_coarsest_level():
    assert len(PROPERTIES) == 2, "files and URLs"
    for text in PROPERTIES:
        (level,) = xml.fromstring(f"<all>{text}</all>").findall(".//*[@command='SetLevel']")
        assert level.get("default_values") == "0"
        assert (
            level.find("IntRangeDomain").get("default_mode") == "min"
        ), "ParaView takes the middle"


def a_grid_is_saved_as_a_log_and_as_a_page(module, source, sizes):
    from qtet import vtk as qtet_vtk

    source.SetLevel(len(sizes) - 1)
    os.environ["PATH"] = f"{pathlib.Path(program).parent}:{os.environ['PATH']}"
    OUT.mkdir(parents=True, exist_ok=True)
    for kind, name in ((module.QtetLogWriter, "saved.qtet"), (module.QtetPageWriter, "saved.html")):
        writer = kind()
        writer.SetInputConnection(source.GetOutputPort())
        writer.SetFileName(str(OUT / name))
        writer.Write()
    with qtet_vtk.Log(OUT / "saved.qtet") as log:
        assert log.level_info(log.last_level).tetrahedra == sizes[-1]
    assert (OUT / "saved.html").read_text().startswith("<!doctype html>")
    said = io.StringIO()
    writer.SetFileName(str(OUT / "no folder" / "saved.html"))
    with contextlib.redirect_stderr(said):
        writer.Write()
    assert "no folder" in said.getvalue(), said.getvalue()


def without_its_module_paraview_is_skipped():
    """A pvbatch that says what Debian's says, and ends with 0."""
    pvbatch = OUT / "stand-in" / "pvbatch"
    pvbatch.parent.mkdir(parents=True, exist_ok=True)
    pvbatch.write_text("#!/bin/sh\necho \"ModuleNotFoundError: No module named 'paraview'\" >&2\n")
    pvbatch.chmod(pvbatch.stat().st_mode | stat.S_IXUSR)
    script = pathlib.Path(__file__).parent / "paraview.sh"
    ran = subprocess.run(
        [script, library, program, modules, OUT],
        env={**os.environ, "PATH": f"{pvbatch.parent}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 77 and "skipped" in ran.stdout, ran


module = plugin()
opened = a_log_opens_at_its_coarsest_level(module)
a_level_that_there_is_none_of_is_an_error(*opened)
a_grid_is_saved_as_a_log_and_as_a_page(module, *opened)
a_series_has_time_steps(module)
the_slider_begins_at_the_coarsest_level()
without_its_module_paraview_is_skipped()
print("the plugin opens logs at their coarsest level and refuses levels that there are none of")

"""ParaView plugin: opens qtet logs, files (File > Open) and URLs (Sources > Qtet URL), with a
slider for the level or the error. Saves grids as logs, and as pages for the browser (File > Save
Data).

Tools > Manage Plugins > Load New... > paraview_plugin.py. It needs the package qtet that it is part
of, and libqtet.so (QTET_LIBRARY names it where it is not installed)."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from paraview.util.vtkAlgorithm import (  # noqa: E402
    VTKPythonAlgorithmBase,
    smdomain,
    smhint,
    smproperty,
    smproxy,
)
from vtkmodules.vtkCommonCore import vtkDataArraySelection  # noqa: E402
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid  # noqa: E402
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline  # noqa: E402

from qtet import vtk as qtet_vtk  # noqa: E402

BY_LEVEL, BY_BOUNDARY_ERROR, BY_FIELD_ERROR = 0, 1, 2

_PROPERTIES = """
  <IntVectorProperty name="LevelRange" command="GetLevelRange" number_of_elements="2"
                     default_values="0 0" information_only="1">
    <SimpleIntInformationHelper/>
  </IntVectorProperty>
  <IntVectorProperty name="ChooseBy" command="SetChooseBy" number_of_elements="1"
                     default_values="0">
    <EnumerationDomain name="enum">
      <Entry text="Level" value="0"/>
      <Entry text="Boundary error" value="1"/>
      <Entry text="Field error" value="2"/>
    </EnumerationDomain>
    <Documentation>What chooses how fine the mesh is.</Documentation>
  </IntVectorProperty>
  <IntVectorProperty name="Level" command="SetLevel" number_of_elements="1" default_values="0">
    <!-- Without a mode ParaView sets the middle level, also where a script said Level=0. -->
    <IntRangeDomain name="range" default_mode="min">
      <RequiredProperties><Property name="LevelRange" function="RangeInfo"/></RequiredProperties>
    </IntRangeDomain>
    <Documentation>0 is the coarsest, with which a log opens; the last one is the whole
    mesh.</Documentation>
    <Hints>
      <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                               property="ChooseBy" value="0"/>
    </Hints>
  </IntVectorProperty>
  <DoubleVectorProperty name="ErrorPercent" command="SetErrorPercent" number_of_elements="1"
                        default_values="1.0">
    <DoubleRangeDomain name="range" min="0" max="10"/>
    <Documentation>The coarsest level that is this good: of the boundary in per cent of the box's
    diagonal, of a field (rms) in per cent of its range.</Documentation>
    <Hints>
      <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                               property="ChooseBy" values="1 2"/>
    </Hints>
  </DoubleVectorProperty>
  <StringVectorProperty name="ErrorField" command="SetErrorField" number_of_elements="1"
                        default_values="">
    <Documentation>The field whose error counts; empty: the first.</Documentation>
    <Hints>
      <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                               property="ChooseBy" value="2"/>
    </Hints>
  </StringVectorProperty>
"""


class _QtetSource(VTKPythonAlgorithmBase):
    """What both proxies share: a log that stays open, a level, and the fields that are wanted."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self._source, self._log = "", None
        self._level, self._choose, self._percent, self._field = 0, BY_LEVEL, 1.0, ""
        self._arrays = vtkDataArraySelection()
        self._arrays.AddObserver("ModifiedEvent", lambda *_: self.Modified())

    def _set(self, name, value):
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def _set_source(self, source):
        if source == self._source:
            return
        self._source, self._log = source, None
        self.Modified()

    def _opened(self):
        if self._log is None and self._source:
            self._log = qtet_vtk.Log(self._source)
            for _, name, _ in self._log.fields_of(time=self._first_time(), method="nearest"):
                self._arrays.AddArray(name)
        return self._log

    def _first_time(self):
        """Of a log without a series: None."""
        return min(self._log.times, default=None)

    def _chosen_level(self, log):
        if self._choose == BY_BOUNDARY_ERROR:
            return log.level_of_error("boundary", self._percent / 100)
        if self._choose == BY_FIELD_ERROR and log.fields:
            first = log.fields_of(time=self._first_time(), method="nearest")[0][1]
            return log.level_of_error(self._field or first, self._percent / 100)
        return self._level

    def SetLevel(self, level):
        self._set("_level", level)

    def GetLevelRange(self):
        try:
            log = self._opened()
        except (qtet_vtk.QtetError, OSError):
            log = None  # told by RequestData, where ParaView shows it
        return (0, log.last_level if log else 0)

    def SetChooseBy(self, choose):
        self._set("_choose", choose)

    def SetErrorPercent(self, percent):
        self._set("_percent", percent)

    def SetErrorField(self, name):
        self._set("_field", name or "")

    def RequestInformation(self, request, inInfo, outInfo):
        try:
            log = self._opened()
        except (qtet_vtk.QtetError, OSError) as error:
            return self._failed(error)
        information, keys = outInfo.GetInformationObject(0), vtkStreamingDemandDrivenPipeline
        information.Remove(keys.TIME_STEPS())
        information.Remove(keys.TIME_RANGE())
        if log is not None and log.times:
            for time in log.times:
                information.Append(keys.TIME_STEPS(), time)
            for time in (log.times[0], log.times[-1]):
                information.Append(keys.TIME_RANGE(), time)
        return 1

    def RequestData(self, request, inInfo, outInfo):
        try:
            log = self._opened()
            if log is None:
                return 1
            log.refine(self._chosen_level(log))
            time, key = self._first_time(), vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()
            if time is not None and outInfo.GetInformationObject(0).Has(key):
                time = outInfo.GetInformationObject(0).Get(key)
            names = [name for _, name, _ in log.fields_of(time=time, method="nearest")]
            wanted = [name for name in names if self._arrays.ArrayIsEnabled(name)]
            grid = qtet_vtk.grid_of(log, wanted, time, "nearest")
            if time is not None:
                grid.GetInformation().Set(grid.DATA_TIME_STEP(), time)
        except (qtet_vtk.QtetError, OSError) as error:
            return self._failed(error)
        vtkUnstructuredGrid.GetData(outInfo, 0).ShallowCopy(grid)
        return 1

    def _failed(self, error):
        print(f"qtet: {error}", file=sys.stderr)  # ParaView's output window
        return 0


@smproxy.reader(name="QtetReader", label="Qtet Log", extensions="qtet", file_description="qtet log")
class QtetReader(_QtetSource):
    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="qtet", file_description="qtet log")
    def SetFileName(self, name):
        self._set_source("" if name in (None, "None") else name)

    @smproperty.xml(_PROPERTIES)
    def SetLevel(self, level):
        super().SetLevel(level)

    @smproperty.dataarrayselection(name="Fields")
    def GetFields(self):
        return self._arrays


@smproxy.source(name="QtetUrl", label="Qtet URL")
class QtetUrl(_QtetSource):
    @smproperty.stringvector(name="Url", default_values="")
    def SetUrl(self, url):
        self._set_source(url or "")

    @smproperty.xml(_PROPERTIES)
    def SetLevel(self, level):
        super().SetLevel(level)

    @smproperty.dataarrayselection(name="Fields")
    def GetFields(self):
        return self._arrays


class _QtetWriter(VTKPythonAlgorithmBase):
    """Saves a grid with all of its arrays, by the usual settings of `qtet simplify`."""

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=0, inputType="vtkUnstructuredGrid")
        self._path = ""

    def SetFileName(self, name):
        self._path = name or ""
        self.Modified()

    def RequestData(self, request, inInfo, outInfo):
        try:
            self._save(vtkUnstructuredGrid.GetData(inInfo[0], 0), self._path)
        except (qtet_vtk.QtetError, OSError, ValueError) as error:
            print(f"qtet: {error}", file=sys.stderr)
            return 0
        return 1

    def Write(self):
        self.Modified()
        self.Update()


@smproxy.writer(extensions="qtet", file_description="qtet log", support_reload=False)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkUnstructuredGrid"], composite_data_supported=False)
class QtetLogWriter(_QtetWriter):
    @smproperty.stringvector(name="FileName", panel_visibility="never")
    @smdomain.filelist()
    def SetFileName(self, name):
        super().SetFileName(name)

    def _save(self, grid, path):
        from qtet import simplify

        simplify(grid, path=path)


@smproxy.writer(extensions="html", file_description="qtet page", support_reload=False)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkUnstructuredGrid"], composite_data_supported=False)
class QtetPageWriter(_QtetWriter):
    @smproperty.stringvector(name="FileName", panel_visibility="never")
    @smdomain.filelist()
    def SetFileName(self, name):
        super().SetFileName(name)

    def _save(self, grid, path):
        from qtet import page

        page(grid, path)

"""The file as VTK reads it."""

import re

try:
    from vtkmodules.vtkCommonCore import (
        vtkDataArray,
        vtkLogger,
        vtkOutputWindow,
        vtkStringArray,
        vtkStringOutputWindow,
    )
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    from vtkmodules.vtkIOGeometry import vtkAVSucdReader, vtkFLUENTReader
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOLegacy import vtkDataSetReader
    from vtkmodules.vtkIOParallel import vtkMultiBlockPLOT3DReader
    from vtkmodules.vtkIOXML import (
        vtkXMLImageDataReader,
        vtkXMLImageDataWriter,
        vtkXMLRectilinearGridReader,
        vtkXMLRectilinearGridWriter,
        vtkXMLStructuredGridReader,
        vtkXMLStructuredGridWriter,
        vtkXMLUnstructuredGridReader,
        vtkXMLUnstructuredGridWriter,
    )
except ImportError:
    sys.exit(NO_MODULE)

window, said = vtkStringOutputWindow(), 0
vtkOutputWindow.SetInstance(window)
# Messages go to the logger too, which would write them in its own form.
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)


def legacy(reader):
    for what in ("Scalars", "Vectors", "Normals", "Tensors", "TCoords", "Fields"):
        getattr(reader, "ReadAll%sOn" % what)()


def exodus(reader):
    reader.SetSqueezePoints(False)  # every block has all points, so that blocks hang together
    reader.ApplyDisplacementsOff()  # the mesh is one over all steps
    # VTK 9.1 crashes where it is to give global ids for all points of a block
    reader.GenerateGlobalElementIdArrayOff()
    reader.GenerateGlobalNodeIdArrayOff()
    reader.UpdateInformation()
    reader.SetAllArrayStatus(vtkExodusIIReader.NODAL, 1)
    reader.SetAllArrayStatus(vtkExodusIIReader.ELEM_BLOCK, 1)


def cgns(reader):
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllPointArrays()
    reader.EnableAllCellArrays()


def fluent(reader):
    reader.UpdateInformation()
    reader.EnableAllCellArrays()


def plot3d(reader):
    PRESSURE, VELOCITY = 110, 200  # functions of the reader, beside density, momentum and energy
    reader.AutoDetectFormatOn()
    if companion:
        reader.SetQFileName(companion)
        reader.AddFunction(PRESSURE)
        reader.AddFunction(VELOCITY)


READERS = {
    "vtu": (vtkXMLUnstructuredGridReader, None),
    "vts": (vtkXMLStructuredGridReader, None),
    "vtr": (vtkXMLRectilinearGridReader, None),
    "vti": (vtkXMLImageDataReader, None),
    "vtk": (vtkDataSetReader, legacy),
    "exodus": (vtkExodusIIReader, exodus),
    "cgns": (vtkCGNSReader, cgns),
    "fluent": (vtkFLUENTReader, fluent),
    "vtkhdf": (vtkHDFReader, None),
    "plot3d": (vtkMultiBlockPLOT3DReader, plot3d),
    "avsucd": (vtkAVSucdReader, None),
}
WRITERS = {
    "vtkUnstructuredGrid": (vtkXMLUnstructuredGridWriter, ".vtu"),
    "vtkStructuredGrid": (vtkXMLStructuredGridWriter, ".vts"),
    "vtkRectilinearGrid": (vtkXMLRectilinearGridWriter, ".vtr"),
    "vtkImageData": (vtkXMLImageDataWriter, ".vti"),
}


def is_of_missing_results(text):
    """A Fluent mesh alone is no fault; VTK looks for a file of results beside it."""
    return kind == "fluent" and text.startswith(
        ("Could not open data file", "Unable to open dat file")
    )


def check_messages():
    """Says VTK's warnings since the last call, and ends with its first error."""
    global said
    text = (window.GetOutput() or "")[said:]
    said += len(text)
    head = r"(ERROR|(?:Generic )?Warning): In [^\n]*, line \d+\n"
    parts = re.split(head, text)
    for level, message in zip(parts[1::2], parts[2::2]):
        message = re.sub(r"^.*? \(0x[0-9a-f]+\): ", "", " ".join(message.split())).rstrip(" .")
        if is_of_missing_results(message):
            continue
        if level != "ERROR":
            say("note", "VTK: " + message)
            continue
        fail(
            "VTK could not read it: %s; export the mesh again or open it in ParaView to see what "
            "it holds" % message
        )


def name_arrays(fields, association):
    """The XML must name every array, and holds numbers and texts alone."""
    for i in reversed(range(fields.GetNumberOfArrays())):
        array = fields.GetAbstractArray(i)
        if not isinstance(array, (vtkDataArray, vtkStringArray)):
            called = "%s field %s" % (association, array.GetName())
            say("note", called + " was ignored: it holds no numbers")
            fields.RemoveArray(i)
        elif not array.GetName():
            name = "unnamed-%d" % i
            say("note", "%s field number %d has no name, and is called %s" % (association, i, name))
            array.SetName(name)


def write(data, name, block):
    data_class = next((known for known in WRITERS if data.IsA(known)), None)
    if data_class is None:
        append = vtkAppendFilter()
        append.AddInputData(data)
        append.Update()
        data, data_class = append.GetOutput(), "vtkUnstructuredGrid"
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    copy.GetFieldData().Initialize()
    name_arrays(copy.GetPointData(), "point")
    name_arrays(copy.GetCellData(), "cell")
    writer_class, ending = WRITERS[data_class]
    writer = writer_class()
    writer.SetFileName(os.path.join(folder, name + ending))
    writer.SetInputData(copy)
    # read once and removed: compressing would take most of the time
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64()
    if not writer.Write():
        fail("no room for what it holds; let TMPDIR name a folder with room")
    say("block", name + ending, block)


def blocks_of(output):
    """The data sets and their names; VTK calls those of Exodus so that have none."""
    if not output.IsA("vtkCompositeDataSet"):
        if not isinstance(output, vtkDataSet):
            fail("VTK found no mesh in it; export the mesh as .vtu")
        yield output, ""
        return
    each = output.NewIterator()
    each.InitTraversal()
    while not each.IsDoneWithTraversal():
        name = None
        if each.HasCurrentMetaData():
            name = each.GetCurrentMetaData().Get(vtkCompositeDataSet.NAME())
        data = each.GetCurrentDataObject()
        if isinstance(data, vtkDataSet):
            yield data, "" if not name or name.startswith("Unnamed block ID:") else name
        each.GoToNextItem()


def times_of(reader):
    info, key = reader.GetOutputInformation(0), vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    return [info.Get(key, i) for i in range(info.Length(key))] if info and info.Has(key) else []


reader_class, prepare = READERS[kind]
reader = reader_class()
(reader.SetXYZFileName if kind == "plot3d" else reader.SetFileName)(source)
if prepare:
    prepare(reader)
reader.UpdateInformation()
times = times_of(reader)


def write_step(number):
    if times:
        reader.UpdateTimeStep(times[number])
    else:
        reader.Update()
    check_messages()
    blocks = [
        block
        for block in blocks_of(reader.GetOutputDataObject(0))
        if block[0].GetNumberOfCells() + block[0].GetNumberOfPoints() > 0
    ]
    for i, (data, name) in enumerate(blocks):
        write(data, "%d-%d" % (number, i), name)
    check_messages()


check_messages()
try:
    serve(times, write_step)
except MemoryError:
    sys.exit(NO_MEMORY)

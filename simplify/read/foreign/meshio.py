"""The file as meshio reads it (https://github.com/nschloe/meshio)."""

try:
    import meshio
except ImportError:
    sys.exit(NO_MODULE)
import shutil
import traceback
import xml.etree.ElementTree as tree
from xml.sax.saxutils import quoteattr


def names_of(mesh):
    """The names of MED's families, as our own files have those of a label's values."""
    if "cell_tags" not in mesh.cell_data:
        return ""
    row = '<DataArray type="Int64" Name=%s NumberOfTuples="1" format="ascii">%d</DataArray>'
    families = getattr(mesh, "cell_tags", {})
    return "".join(
        row % (quoteattr("cell_tags=" + ", ".join(names)), family)
        for family, names in families.items()
        if names and "".join(names).isprintable()
    )


def add_names(names, path):
    """meshio writes no data of the file."""
    with open(path, "rb") as file, open(path + ".named", "wb") as named:
        for line in file:
            named.write(line)
            if line.strip() == b"<UnstructuredGrid>":
                named.write(b"<FieldData>" + names.encode(errors="replace") + b"</FieldData>\n")
                break
        shutil.copyfileobj(file, named)
    os.replace(path + ".named", path)


def write(mesh, number):
    names, path = names_of(mesh), os.path.join(folder, "%d.vtu" % number)
    mesh.cell_sets, mesh.point_sets, mesh.field_data, mesh.info = {}, {}, {}, None
    # read once and removed: compressing would take most of the time
    meshio.write(
        path, mesh, file_format="vtu", binary=True, compression=None, header_type="UInt64"
    )
    if names:
        add_names(names, path)
    say("block", os.path.basename(path), "")


def formats_of(ending):
    helpers = meshio._helpers
    if ending in helpers.reader_map:
        return [ending]
    # a dictionary of lists, or of single formats in older versions
    older = getattr(helpers, "extension_to_filetype", {})
    known = getattr(helpers, "extension_to_filetypes", older)
    formats = known.get("." + ending, [])
    return [formats] if isinstance(formats, str) else formats


def formats_of_name():
    # the longest ending that is known, as in .post.gz
    endings = os.path.basename(source).lower().split(".")[1:]
    return next(filter(None, (formats_of(".".join(endings[i:])) for i in range(len(endings)))), [])


def reason_of(error):
    """meshio often refuses without a word, and Python's own errors need their place."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    place = "%s in line %d of its %s" % (
        type(error).__name__,
        frame.lineno,
        "/".join(frame.filename.split("/")[-2:]),
    )
    text = " ".join(str(error).split())
    return "%s (%s)" % (text, place) if text else place


def read_mesh(formats):
    """As meshio.read, which prints its reason and then exits."""
    readers, reasons = meshio._helpers.reader_map, []
    for name in formats:
        try:
            return readers[name](source)
        except meshio.ReadError as error:
            reasons.append(reason_of(error))
    raise RuntimeError("; ".join(reasons))


def is_series(formats):
    if formats[:1] != ["xdmf"]:
        return False
    domain = tree.parse(source).getroot().find("Domain")
    grids = [] if domain is None else domain.findall("Grid")
    return any(grid.get("CollectionType") == "Temporal" for grid in grids)


def serve_xdmf():
    with meshio.xdmf.TimeSeriesReader(source) as reader:
        points, cells = reader.read_points_cells()

        def time_of(number):
            time = reader.collection[number].find("Time")
            return float(number if time is None else time.get("Value"))

        def write_step(number):
            _, point_data, cell_data = reader.read_data(number)
            write(meshio.Mesh(points, cells, point_data, cell_data), number)

        serve([time_of(number) for number in range(reader.num_steps)], write_step)


def steps_of_med():
    """By time: meshio's names of fields with several times, "u[1] - 0.5", and their own."""
    import h5py

    steps = {}
    with h5py.File(source, "r") as file:
        fields = file["CHA"] if "CHA" in file else {}
        for name, data in fields.items():
            keys = sorted(data.keys())
            for number, key in enumerate(keys if len(keys) > 1 else []):
                time = float(data[key].attrs["PDT"])
                called = name + "[%d] - %s" % (number, format(time, "g"))
                steps.setdefault(time, {})[called] = name
    return sorted(steps.items())


def serve_med(mesh):
    steps = steps_of_med()
    stepped = {called for _, names in steps for called in names}

    def of_step(data, names):
        return {
            names.get(called, called): values
            for called, values in data.items()
            if called in names or called not in stepped
        }

    def write_step(number):
        names = steps[number][1] if steps else {}
        step = meshio.Mesh(
            mesh.points,
            mesh.cells,
            of_step(mesh.point_data, names),
            of_step(mesh.cell_data, names),
        )
        step.cell_tags = getattr(mesh, "cell_tags", {})
        write(step, number)

    serve([time for time, _ in steps], write_step)


def serve_file():
    formats = formats_of(kind) if kind else formats_of_name()
    if not formats:
        sys.exit(NO_SUCH_KIND)
    if is_series(formats):
        return serve_xdmf()
    mesh = read_mesh(formats)
    if formats[:1] == ["med"]:
        return serve_med(mesh)
    serve([], lambda number: write(mesh, number))


try:
    serve_file()
except MemoryError:
    sys.exit(NO_MEMORY)
except SystemExit as end:  # meshio has printed why, but for our own ends
    sys.exit(end.code if end.code in (0, NO_SUCH_KIND) else 1)
except RuntimeError as error:
    fail("meshio could not read it: %s; save the mesh as .vtu" % error)
except BaseException as error:
    fail("meshio could not read it: %s; save the mesh as .vtu" % reason_of(error))

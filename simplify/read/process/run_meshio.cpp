#include "simplify/read/process/run_meshio.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <optional>
#include <string>

#include "simplify/read/options/byte_order_mark.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/read/process/inflate_file.h"
#include "simplify/read/process/watch_process.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr int kNoProgram = 127, kNoMeshio = 77, kUnknownKind = 78;  ///< what the child ends with
constexpr int kKilled = -1, kStuck = -2;                            ///< not by itself
/// Reads, drops what a .vtu cannot hold, and writes. Python would look for meshio in the working
/// folder first, where a mesh's sender may have put one. Words: input, folder, kind, time.
constexpr const char* kScript = R"python(
import sys
sys.path[:] = [folder for folder in sys.path if folder]
try:
    import meshio
except ImportError:
    sys.exit(77)
import os
import shutil
import traceback
import xml.etree.ElementTree as tree
from xml.sax.saxutils import quoteattr

source, folder, kind, wanted = sys.argv[1:5]
os.chdir(os.path.dirname(source))  # meshio looks there for the binary files that an XDMF names

def names_of(mesh):
    """The names of MED's families, as our own files have those of a label's values."""
    if "cell_tags" not in mesh.cell_data:
        return ""
    row = '<DataArray type="Int64" Name=%s NumberOfTuples="1" format="ascii">%d</DataArray>'
    families = getattr(mesh, "cell_tags", {})
    return "".join(row % (quoteattr("cell_tags=" + ", ".join(names)), family)
                   for family, names in families.items() if names and "".join(names).isprintable())

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

def write(mesh, name):
    names = names_of(mesh)
    mesh.cell_sets, mesh.point_sets, mesh.field_data, mesh.info = {}, {}, {}, None
    # read once and removed: compressing would take most of the time
    meshio.write(folder + "/" + name, mesh, file_format="vtu", binary=True, compression=None,
                 header_type="UInt64")
    if names:
        add_names(names, folder + "/" + name)

parts = wanted.split(",")

def is_one(what, time, number, count):
    if ":" in what:  # a range, from which the reader of the result takes steps
        return True
    if what in ("first", "last", "all"):
        return what == "all" or count == 1 or number == (0 if what == "first" else count - 1)
    try:
        other = float(what)
    except ValueError:
        return False
    return abs(time - other) <= 1e-9 * max(abs(time), abs(other))

def is_meant(time, number, count):
    return any(is_one(what, time, number, count) for what in parts)

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
        type(error).__name__, frame.lineno, "/".join(frame.filename.split("/")[-2:]))
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

def write_steps(times, write_step):
    """Of a step that is not meant the time alone counts."""
    series = tree.Element("VTKFile", type="Collection")
    collection = tree.SubElement(series, "Collection")
    for number, time in enumerate(times):
        name = "%d.vtu" % number
        tree.SubElement(collection, "DataSet", timestep=repr(time), file=name)
        if is_meant(time, number, len(times)):
            write_step(number, name)
    tree.ElementTree(series).write(folder + "/mesh.pvd")

def write_series():
    with meshio.xdmf.TimeSeriesReader(source) as reader:
        points, cells = reader.read_points_cells()
        def time_of(number):
            time = reader.collection[number].find("Time")
            return float(number if time is None else time.get("Value"))
        def write_step(number, name):
            _, point_data, cell_data = reader.read_data(number)
            write(meshio.Mesh(points, cells, point_data, cell_data), name)
        write_steps([time_of(number) for number in range(reader.num_steps)], write_step)

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

def write_med(mesh):
    steps = steps_of_med()
    stepped = {called for _, names in steps for called in names}
    def of_step(data, names):
        return {names.get(called, called): values for called, values in data.items()
                if called in names or called not in stepped}
    def write_step(number, name):
        names = steps[number][1]
        step = meshio.Mesh(mesh.points, mesh.cells, of_step(mesh.point_data, names),
                           of_step(mesh.cell_data, names))
        step.cell_tags = getattr(mesh, "cell_tags", {})
        write(step, name)
    if steps:
        write_steps([time for time, _ in steps], write_step)
    else:
        write(mesh, "mesh.vtu")

try:
    formats = formats_of(kind) if kind else formats_of_name()
    if not formats:
        sys.exit(78)
    if is_series(formats):
        write_series()
    elif formats[:1] == ["med"]:
        write_med(read_mesh(formats))
    else:
        write(read_mesh(formats), "mesh.vtu")
except SystemExit as end:  # meshio has said why
    sys.exit(end.code if end.code == 78 else 1)
except RuntimeError as error:
    sys.stdout.flush()
    sys.stderr.write("\n" + str(error))
    sys.exit(1)
except BaseException as error:
    sys.stdout.flush()
    sys.stderr.write("\n" + reason_of(error))
    sys.exit(1)
)python";

/// Returns the program's exit code; kKilled also where it could not be started.
int run(const char* python, const MeshioInput& input, const fs::path& folder,
        const fs::path& words) {
  // whole, since the script leaves this process's folder
  const std::string in = fs::absolute(input.path).string(), out = fs::absolute(folder).string();
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would wait for it
    const int file = ::open(words.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
              nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    boundMemory();
    ::execlp(python, python, "-c", kScript, in.c_str(), out.c_str(), input.kind.c_str(),
             input.time.c_str(), static_cast<char*>(nullptr));
    ::_exit(kNoProgram);
  }
  if (child < 0) return kKilled;
  const std::optional<int> status = watchProcess(child, input.patience);
  if (!status) return kStuck;
  return WIFEXITED(*status) ? WEXITSTATUS(*status) : kKilled;
}

std::string lastLineOf(const fs::path& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last.empty() ? "it ended without a word" : last;
}

}  // namespace

Status throughMeshio(const MeshioInput& input, const std::function<Status(const fs::path&)>& use) {
  // XDMF names files beside it, and Python's parser of XML passes the mark
  if (input.kind != "xdmf" && isMarked(input.path))
    return unmarked(input.path, [&](const fs::path& file) {
      MeshioInput copy = input;
      copy.path = file;
      return throughMeshio(copy, use);
    });
  const GuardedFolder folder("meshio");
  if (Status made = folder.made(); !made) return std::unexpected(made.error());
  const fs::path words = folder.path() / "words.txt";
  // The first python3 may be one of the user's own; Debian's has Debian's meshio.
  int ended = kNoProgram;
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    ended = run(python, input, folder.path(), words);
    if (ended != kNoProgram && ended != kNoMeshio) break;
  }
  const std::string path = input.path.string(),
                    kind = input.kind.empty() ? input.path.extension().string() : input.kind;
  if (ended == kNoProgram || ended == kNoMeshio) {
    return fail(ErrorCode::kNotFound,
                path + ": files of type '" + kind +
                    "' are read through meshio, which is not installed; install it (apt install "
                    "python3-meshio, or pip install meshio), or save the mesh as .vtu; if it is "
                    "one of another kind, say which with `format`: " +
                    knownEndings());
  }
  if (ended == kStuck) {
    return fail(ErrorCode::kBadInput,
                path + ": meshio has neither read nor written anything for " +
                    std::to_string(input.patience.count()) +
                    " s; if the file is only large, give it longer with `readSeconds`, else "
                    "export the mesh again, best as .vtu");
  }
  if (ended == kUnknownKind)
    return fail(ErrorCode::kBadInput, path + ": files of type '" + kind +
                                          "' are not read; say with `format` what it is: " +
                                          knownEndings() + ", or an ending that meshio knows");
  if (ended != 0)
    return fail(ErrorCode::kBadInput, path + ": meshio could not read it: " + lastLineOf(words) +
                                          "; save the mesh as .vtu");
  const fs::path series = folder.path() / "mesh.pvd";
  std::error_code code;
  return use(fs::exists(series, code) ? series : folder.path() / "mesh.vtu");
}

}  // namespace qtet

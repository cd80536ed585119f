#include "simplify/read/options/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "codec/files/unreachable.h"
#include "simplify/read/options/byte_order_mark.h"
#include "simplify/read/options/check_avs.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The root element, after a byte order mark, an XML declaration and comments, stands within this
/// many bytes.
constexpr std::uintmax_t kFrontBytes = 16384;
/// The closing tag stands within this many bytes of the end, with room for a comment after it.
constexpr std::uintmax_t kBackBytes = 4096;

struct FileEnds {
  std::string front;
  std::string back;
};

Result<FileEnds> readEnds(const fs::path& path, std::uintmax_t size) {
  std::ifstream file(path, std::ios::binary);
  FileEnds ends;
  ends.front.resize(std::min(size, kFrontBytes));
  ends.back.resize(std::min(size, kBackBytes));
  file.read(ends.front.data(), static_cast<std::streamsize>(ends.front.size()));
  file.seekg(static_cast<std::streamoff>(size - ends.back.size()));
  file.read(ends.back.data(), static_cast<std::streamsize>(ends.back.size()));
  if (!file)
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + std::strerror(errno));
  return ends;
}

/// The value of the attribute `name`, in quotes of either kind, in the tag that starts at `tag`, or
/// an empty text.
std::string attribute(std::string_view text, std::size_t tag, std::string_view name) {
  constexpr std::string_view kBlanks = " \t\r\n", kNameEnds = " \t\r\n=/>";
  for (std::size_t at = text.find_first_of(kBlanks, tag);;) {
    at = text.find_first_not_of(kBlanks, at);
    const std::size_t end = text.find_first_of(kNameEnds, at),
                      equals = text.find_first_not_of(kBlanks, end);
    // the tag is at its end
    if (equals == std::string_view::npos || text[equals] != '=') return {};
    const std::size_t quote = text.find_first_not_of(kBlanks, equals + 1);
    if (quote == std::string_view::npos || (text[quote] != '"' && text[quote] != '\'')) return {};
    const std::size_t close = text.find(text[quote], quote + 1);
    if (close == std::string_view::npos) return {};
    if (text.substr(at, end - at) == name)
      return std::string(text.substr(quote + 1, close - quote - 1));
    at = close + 1;
  }
}

Status checkXml(const fs::path& path, const FileEnds& ends, std::string_view wanted) {
  const std::size_t root = ends.front.find("<VTKFile");
  if (root == std::string::npos) {
    return fail(ErrorCode::kBadInput,
                path.string() +
                    " is not a VTK XML file: no <VTKFile> in its first bytes; export the mesh as "
                    ".vtu again",
                0);
  }
  const std::string type = attribute(ends.front, root, "type");
  if (type != wanted) {
    return fail(ErrorCode::kBadInput,
                path.string() + " holds a VTK data set of type '" + type + "', not " +
                    std::string(wanted) +
                    " as its name's ending says; rename it, or save a volume mesh as .vtu",
                root);
  }
  if (ends.back.find("</VTKFile>") == std::string::npos) {
    return fail(
        ErrorCode::kTruncated,
        path.string() + " ends without </VTKFile>: the file was cut off; copy or export it again");
  }
  return {};
}

Status checkLegacy(const fs::path& path, const FileEnds& ends) {
  if (!withoutMark(ends.front).starts_with("# vtk DataFile Version")) {
    return fail(ErrorCode::kBadInput,
                path.string() +
                    " is not a legacy VTK file: its first line is not '# vtk DataFile Version ...'",
                0);
  }
  std::string upper = ends.front.substr(0, 1024);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const char* kind :
       {"UNSTRUCTURED_GRID", "STRUCTURED_GRID", "RECTILINEAR_GRID", "STRUCTURED_POINTS"}) {
    if (upper.find(kind) != std::string::npos) return {};
  }
  return fail(ErrorCode::kBadInput, path.string() +
                                        " has no 'DATASET UNSTRUCTURED_GRID' or structured one in "
                                        "its header; save the volume mesh as .vtu");
}

struct Ending {
  std::string_view text;
  MeshFormat format;
};

constexpr std::array<Ending, 39> kEndings{{
    {".vtu", MeshFormat::kVtu},       {".pvtu", MeshFormat::kPvtu},
    {".pvts", MeshFormat::kPvts},     {".pvtr", MeshFormat::kPvtr},
    {".pvti", MeshFormat::kPvti},     {".vtm", MeshFormat::kVtm},
    {".vtmu", MeshFormat::kVtm},      {".vtmb", MeshFormat::kVtm},
    {".pvd", MeshFormat::kPvd},       {".vts", MeshFormat::kVts},
    {".vtr", MeshFormat::kVtr},       {".vti", MeshFormat::kVti},
    {".vtk", MeshFormat::kLegacyVtk}, {".e", MeshFormat::kExodus},
    {".ex2", MeshFormat::kExodus},    {".exo", MeshFormat::kExodus},
    {".exii", MeshFormat::kExodus},   {".g", MeshFormat::kExodus},
    {".case", MeshFormat::kEnSight},  {".encas", MeshFormat::kEnSight},
    {".cgns", MeshFormat::kCgns},     {".inp", MeshFormat::kAvsUcd},
    {".foam", MeshFormat::kOpenFoam}, {".msh", MeshFormat::kGmsh},
    {".mesh", MeshFormat::kMedit},    {".meshb", MeshFormat::kMedit},
    {".node", MeshFormat::kTetgen},   {".ele", MeshFormat::kTetgen},
    {".su2", MeshFormat::kSu2},       {".xyz", MeshFormat::kPlot3d},
    {".series", MeshFormat::kSeries}, {".cas", MeshFormat::kFluent},
    {".vtkhdf", MeshFormat::kVtkHdf}, {".xdmf", MeshFormat::kXdmf},
    {".xmf", MeshFormat::kXdmf},      {".unv", MeshFormat::kUnv},
    {".bdf", MeshFormat::kNastran},   {".fem", MeshFormat::kNastran},
    {".nas", MeshFormat::kNastran},
}};

/// NAME.e.4.0 and the like.
bool isExodusPiece(const fs::path& path) {
  const auto isNumber = [](const std::string& ending) {
    return ending.size() > 1 && ending.find_first_not_of("0123456789", 1) == std::string::npos;
  };
  return isNumber(path.extension().string()) && isNumber(path.stem().extension().string()) &&
         formatOf(path.stem().stem()) == MeshFormat::kExodus;
}

}  // namespace

MeshFormat formatOf(const fs::path& path) {
  if (isExodusPiece(path)) return MeshFormat::kExodusPieces;
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto at = std::ranges::find(kEndings, ending, &Ending::text);
  return at == kEndings.end() ? MeshFormat::kOther : at->format;
}

std::string knownEndings() {
  std::string out;
  for (const Ending& ending : kEndings)
    out += (out.empty() ? "" : ", ") + std::string(ending.text.substr(1));
  return out;
}

bool namesPieces(MeshFormat format) {
  return format >= MeshFormat::kPvtu && format <= MeshFormat::kPvti;
}

std::string_view rootType(MeshFormat format) {
  switch (format) {
    case MeshFormat::kVtu: return "UnstructuredGrid";
    case MeshFormat::kPvtu: return "PUnstructuredGrid";
    case MeshFormat::kPvts: return "PStructuredGrid";
    case MeshFormat::kPvtr: return "PRectilinearGrid";
    case MeshFormat::kPvti: return "PImageData";
    case MeshFormat::kVtm: return "vtkMultiBlockDataSet";
    case MeshFormat::kPvd: return "Collection";
    case MeshFormat::kVts: return "StructuredGrid";
    case MeshFormat::kVtr: return "RectilinearGrid";
    case MeshFormat::kVti: return "ImageData";
    default: return {};
  }
}

Status checkMeshFile(const fs::path& path, MeshFormat format) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found)
    return fail(ErrorCode::kNotFound, "there is no file " + path.string() + "; check the name");
  if (isUnreachable(code))
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + code.message());
  if (!fs::is_regular_file(status))
    return fail(ErrorCode::kIo,
                path.string() + " is not a readable file; give a mesh file such as .vtu");
  if (format == MeshFormat::kOpenFoam) return {};  // an empty file that marks the case's folder
  const std::uintmax_t size = fs::file_size(path, code);
  if (code) return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + code.message());
  if (size == 0)
    return fail(ErrorCode::kTruncated,
                path.string() + " is empty (0 bytes); copy or export it again");

  const Result<FileEnds> ends = readEnds(path, size);
  if (!ends) return std::unexpected(ends.error());
  if (isUtf16(ends->front)) return utf16Refused(path);
  if (const std::string_view type = rootType(format); !type.empty())
    return checkXml(path, *ends, type);
  if (format == MeshFormat::kAvsUcd) return checkAvs(path);
  return format == MeshFormat::kLegacyVtk ? checkLegacy(path, *ends) : Status{};
}

}  // namespace qtet

#include "simplify/read/options/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ranges>
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

constexpr unsigned kAlone = 1, kPart = 2, kStep = 4, kPieces = 8, kLists = 16;
/// A row of the table: the format, its endings, its root, and which of the traits hold.
constexpr FormatTraits traits(MeshFormat format, std::string_view endings, std::string_view root,
                              unsigned which) {
  return {format,
          endings,
          root,
          (which & kAlone) != 0,
          (which & kPart) != 0,
          (which & kStep) != 0,
          (which & kPieces) != 0,
          (which & kLists) != 0};
}

constexpr auto kFormats = std::to_array<FormatTraits>({
    traits(MeshFormat::kVtu, ".vtu", "UnstructuredGrid", kAlone | kPart | kStep),
    traits(MeshFormat::kVts, ".vts", "StructuredGrid", kAlone | kPart | kStep),
    traits(MeshFormat::kVtr, ".vtr", "RectilinearGrid", kAlone | kPart | kStep),
    traits(MeshFormat::kVti, ".vti", "ImageData", kAlone | kPart | kStep),
    traits(MeshFormat::kPvtu, ".pvtu", "PUnstructuredGrid", kPart | kStep | kPieces),
    traits(MeshFormat::kPvts, ".pvts", "PStructuredGrid", kPart | kStep | kPieces),
    traits(MeshFormat::kPvtr, ".pvtr", "PRectilinearGrid", kPart | kStep | kPieces),
    traits(MeshFormat::kPvti, ".pvti", "PImageData", kPart | kStep | kPieces),
    traits(MeshFormat::kVtm, ".vtm .vtmu .vtmb", "vtkMultiBlockDataSet", kPart | kStep),
    traits(MeshFormat::kPvd, ".pvd", "Collection", kLists),
    traits(MeshFormat::kSeries, ".series", "", kLists),
    traits(MeshFormat::kLegacyVtk, ".vtk", "", kAlone | kPart | kStep),
    traits(MeshFormat::kVtkHdf, ".vtkhdf", "", kPart | kStep),
    traits(MeshFormat::kExodus, ".e .ex2 .exo .exii .g", "", kPart | kStep),
    traits(MeshFormat::kExodusPieces, "", "", kPart),
    traits(MeshFormat::kEnSight, ".case .encas", "", kPart | kStep),
    traits(MeshFormat::kCgns, ".cgns", "", kPart | kStep),
    traits(MeshFormat::kAvsUcd, ".inp", "", kAlone | kPart | kStep),
    traits(MeshFormat::kOpenFoam, ".foam", "", kPart),
    traits(MeshFormat::kFluent, ".cas", "", kPart | kStep),
    traits(MeshFormat::kXdmf, ".xdmf .xmf", "", kPart | kStep),
    traits(MeshFormat::kPlot3d, ".xyz", "", kPart),
    traits(MeshFormat::kGmsh, ".msh", "", kAlone),
    traits(MeshFormat::kMedit, ".mesh .meshb", "", kAlone),
    traits(MeshFormat::kTetgen, ".node .ele", "", 0),
    traits(MeshFormat::kSu2, ".su2", "", kAlone),
    traits(MeshFormat::kUnv, ".unv", "", kAlone),
    traits(MeshFormat::kAbaqus, "", "", 0),
    traits(MeshFormat::kNastran, ".bdf .fem .nas", "", 0),
    traits(MeshFormat::kAnsys, "", "", 0),
    traits(MeshFormat::kOther, "", "", 0),
});

/// Calls back with each ending and its format until that returns true.
template <class Visit>
void forEachEnding(const Visit& visit) {
  for (const FormatTraits& format : kFormats)
    for (const auto word : std::views::split(format.endings, ' '))
      if (visit(std::string_view(word), format.format)) return;
}

/// NAME.e.4.0 and the like.
bool isExodusPiece(const fs::path& path) {
  const auto isNumber = [](const std::string& ending) {
    return ending.size() > 1 && ending.find_first_not_of("0123456789", 1) == std::string::npos;
  };
  return isNumber(path.extension().string()) && isNumber(path.stem().extension().string()) &&
         formatOf(path.stem().stem()) == MeshFormat::kExodus;
}

/// The first character of the file's text; 0: there is none.
char firstCharacterOf(const fs::path& path) {
  std::ifstream file(path);
  passMark(file);
  char first = 0;
  file >> first;
  return file ? first : '\0';
}

/// Fluent's own files tell cells by their faces, which VTK reads; other programs list the cells'
/// nodes, which meshio reads.
bool hasFaces(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find_first_not_of(" \t(");
    const std::string_view section =
        begin == std::string::npos ? std::string_view() : std::string_view(line).substr(begin);
    for (const std::string_view faces : {"13", "2013", "3013"})
      if (line.starts_with('(') && section.starts_with(faces) &&
          section.substr(faces.size()).find_first_not_of(" \t(") != std::string_view::npos &&
          std::string_view(" \t(").find(section[faces.size()]) != std::string_view::npos)
        return true;
  }
  return false;
}

}  // namespace

MeshFormat formatOf(const fs::path& path) {
  if (isExodusPiece(path)) return MeshFormat::kExodusPieces;
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  MeshFormat out = MeshFormat::kOther;
  forEachEnding([&](std::string_view known, MeshFormat format) {
    if (known == ending && !ending.empty()) out = format;
    return out != MeshFormat::kOther;
  });
  return out;
}

const FormatTraits& traitsOf(MeshFormat format) {
  return *std::ranges::find(kFormats, format, &FormatTraits::format);
}

MeshFormat formatOfContent(const fs::path& path, MeshFormat named) {
  std::error_code code;
  // opening a pipe would wait for who writes
  if ((named != MeshFormat::kAvsUcd && named != MeshFormat::kGmsh) ||
      !fs::is_regular_file(path, code))
    return named;
  const char first = firstCharacterOf(path);
  if (named == MeshFormat::kAvsUcd) return first == '*' ? MeshFormat::kAbaqus : named;
  if (first != '(') return named;
  return hasFaces(path) ? MeshFormat::kFluent : MeshFormat::kAnsys;
}

std::string knownEndings() {
  std::string out;
  forEachEnding([&](std::string_view ending, MeshFormat) {
    out += (out.empty() ? "" : ", ") + std::string(ending.substr(1));
    return false;
  });
  return out;
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
  if (const std::string_view root = traitsOf(format).root; !root.empty())
    return checkXml(path, *ends, root);
  if (format == MeshFormat::kAvsUcd) return checkAvs(path);
  return format == MeshFormat::kLegacyVtk ? checkLegacy(path, *ends) : Status{};
}

}  // namespace qtet

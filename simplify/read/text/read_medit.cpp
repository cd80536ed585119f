#include <algorithm>
#include <array>
#include <optional>

#include "simplify/read/options/select_fields.h"
#include "simplify/read/text/gmsh_elements.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/text_readers.h"

namespace qtet {
namespace {

/// A keyword that lists cells: its name in .mesh, its number in .meshb, and what a cell of it is.
struct Kind {
  std::string_view word;
  std::uint32_t code;
  std::uint8_t type;  ///< 0: of lower dimension, counted
  std::uint32_t nodes;
};

constexpr std::array<Kind, 11> kKinds{{{"Tetrahedra", 8, kTetrahedronCell, 4},
                                       {"Hexahedra", 10, kHexahedronCell, 8},
                                       {"Hexaedra", 10, kHexahedronCell, 8},
                                       {"Prisms", 9, kWedgeCell, 6},
                                       {"Pentahedra", 9, kWedgeCell, 6},
                                       {"Pyramids", 49, kPyramidCell, 5},
                                       {"TetrahedraP2", 30, kQuadraticTetrahedronCell, 10},
                                       {"Edges", 5, 0, 2},
                                       {"Triangles", 6, 0, 3},
                                       {"Quadrilaterals", 7, 0, 4},
                                       {"Vertices", 4, 0, 0}}};
/// A cell's numbers in text at most: a hexahedron of Gmsh's highest order has 1,000 nodes.
constexpr std::uint64_t kMaxNumbers = 1001;
constexpr std::size_t kShownOfAFirstWord = 24;
constexpr std::uint32_t kDimensionCode = 3, kVerticesCode = 4, kEndCode = 54;
/// Where a .meshb keeps its numbers' widths.
constexpr std::int32_t kDoubles = 2, kWidePlaces = 3, kWideIds = 4;

/// Some programs write the keywords in capitals.
std::string smallLetters(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

class Medit {
 public:
  Medit(std::string_view text, const std::filesystem::path& path, bool bytes, ReadReport& report)
      : in_(text, path, bytes ? '\0' : '#'), bytes_(bytes), report_(report) {
    in_.readsBytes(bytes);
  }

  Result<CellMesh> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    bytes_ ? readBytes() : readText();
    if (in_.failed()) return in_.error();
    addReferences("point", pointReferences_);
    addReferences("cell", cellReferences_);
    return std::move(out_);
  }

 private:
  void readText() {
    knowFirstWord();
    while (!in_.atEnd()) {
      const std::string_view found = in_.word();
      const std::string word = smallLetters(found);
      if (word == "end") return;
      if (word == "meshversionformatted") {
        version_ = in_.number<std::int32_t>("the format's version");
      } else if (word == "dimension") {
        checkDimension(in_.number<std::int32_t>("the dimension"));
      } else if (word == "vertices") {
        readVertices(in_.number<std::uint64_t>("the number of vertices"));
      } else if (const Kind* kind =
                     kindOf([&](const Kind& k) { return smallLetters(k.word) == word; })) {
        readCells(*kind, in_.number<std::uint64_t>("the number of cells"));
      } else if (isCurvedVolume(word)) {
        refuseCurved(found);
      }  // any other word or number belongs to a list that nobody needs here
    }
  }

  /// Other programs call their own formats .mesh, too.
  void knowFirstWord() {
    const std::uint64_t place = in_.place();
    const std::string first(in_.word().substr(0, kShownOfAFirstWord));
    in_.seek(place);
    if (in_.failed() || first.empty()) return;
    constexpr std::string_view kAdvice =
        "; save the mesh as .vtu, or as .mesh of Medit, which begins with MeshVersionFormatted";
    const auto refuse = [&](const std::string& what) {
      in_.fail(ErrorCode::kBadInput, what + std::string(kAdvice));
    };
    if (first == "MFEM") return refuse("it is a mesh of MFEM's own format");
    if (first == "mesh3d") return refuse("it is a mesh of Netgen's own format");
    if (first.find_first_not_of("0123456789") == std::string::npos)
      return refuse("it begins with a number, as Netgen's neutral format does");
  }

  /// A list of curved volume cells that is not read: HexahedraQ2, TetrahedraP3 and so on. Their
  /// other lists, as TetrahedraP3Ordering, are no cells.
  static bool isCurvedVolume(std::string_view word) {
    for (const std::string_view kind : {"tetrahedra", "hexahedra", "prisms", "pyramids"})
      if (word.starts_with(kind) && word.size() == kind.size() + 2 &&
          (word[kind.size()] == 'p' || word[kind.size()] == 'q'))
        return true;
    return false;
  }

  void refuseCurved(std::string_view word) {
    if (in_.number<std::uint64_t>("the number of cells") == 0 || in_.failed()) return;
    in_.fail(ErrorCode::kBadInput, "cells of the kind " + std::string(word) +
                                       " are not read, and leaving them out would leave holes; "
                                       "save the mesh as .msh, or of order 1");
  }

  void readBytes() {
    if (in_.raw<std::int32_t>("the sign of its byte order") != 1 && !in_.failed())
      return in_.fail(ErrorCode::kBadInput,
                      "its first number is not 1: it is no .meshb, or one of big-endian numbers; "
                      "save it as .mesh");
    version_ = in_.raw<std::int32_t>("the format's version");
    if (!in_.failed() && (version_ < 1 || version_ > kWideIds))
      in_.fail(ErrorCode::kBadInput, "version " + std::to_string(version_) +
                                         "; versions 1 to 4 are read, or save it as .mesh");
    while (!in_.failed() && in_.remaining() > 0) {
      const auto code = in_.raw<std::uint32_t>("a keyword");
      if (code == kEndCode) return;
      const std::uint64_t begin = in_.place();
      const std::uint64_t next = version_ >= kWidePlaces
                                     ? in_.raw<std::uint64_t>("the next keyword's place")
                                     : in_.raw<std::uint32_t>("the next keyword's place");
      readKeyword(code);
      if (in_.failed() || next == 0) return;
      if (next <= begin)
        return in_.fail(
            ErrorCode::kBadInput,
            "the next keyword's place lies before this one; the file is damaged, export it again");
      in_.seek(next);
    }
  }

  void readKeyword(std::uint32_t code) {
    if (code == kDimensionCode) return checkDimension(in_.raw<std::int32_t>("the dimension"));
    if (code == kVerticesCode) return readVertices(count());
    if (const Kind* kind = kindOf([&](const Kind& k) { return k.code == code; }))
      readCells(*kind, count());
  }

  template <class Predicate>
  static const Kind* kindOf(Predicate is) {
    const auto at = std::ranges::find_if(kKinds, is);
    return at == kKinds.end() ? nullptr : &*at;
  }

  void checkDimension(std::int32_t dimension) {
    if (!in_.failed() && dimension != 3)
      in_.fail(ErrorCode::kBadInput, "the mesh has " + std::to_string(dimension) +
                                         " dimensions, not 3; give a volume mesh");
  }

  std::uint64_t count() {
    return version_ >= kWideIds ? in_.raw<std::uint64_t>("a count")
                                : in_.raw<std::uint32_t>("a count");
  }
  std::int64_t integer(const char* what) {
    if (!bytes_) return in_.number<std::int64_t>(what);
    return version_ >= kWideIds ? in_.raw<std::int64_t>(what) : in_.raw<std::int32_t>(what);
  }
  double real(const char* what) {
    if (!bytes_) return in_.number<double>(what);
    return version_ >= kDoubles ? in_.raw<double>(what) : static_cast<double>(in_.raw<float>(what));
  }
  [[nodiscard]] std::uint64_t integerBytes() const {
    return !bytes_ ? 2 : version_ >= kWideIds ? 8 : 4;
  }
  [[nodiscard]] std::uint64_t realBytes() const {
    return !bytes_ ? 2 : version_ >= kDoubles ? 8 : 4;
  }

  void readVertices(std::uint64_t number) {
    if (!in_.fits(number, 3 * realBytes() + integerBytes() - (bytes_ ? 0 : 1), "vertices")) return;
    out_.points.reserve(number);
    for (std::uint64_t i = 0; i < number && !in_.failed(); ++i) {
      Position p{};
      for (double& x : p) x = real("a coordinate");
      out_.points.push_back(p);
      pointReferences_.push_back(static_cast<double>(integer("a vertex's reference")));
    }
    if (!bytes_) in_.endsList(number, "vertices");
  }

  /// The integers from here to the next word.
  std::uint64_t integersAhead() {
    const std::uint64_t place = in_.place();
    std::uint64_t count = 0;
    for (std::string_view word = in_.word();
         !word.empty() && word.find_first_not_of("0123456789+-") == std::string_view::npos;
         word = in_.word())
      ++count;
    in_.seek(place);
    return count;
  }

  /// Whether the next line of text has more words.
  bool nextLineHasMore(std::uint64_t words) {
    if (in_.atEnd()) return false;
    const std::uint64_t place = in_.place();
    std::string_view line = in_.line();
    in_.seek(place);
    std::uint64_t count = 0;
    while (!line.empty()) {
      const std::size_t end = line.find_first_of(" \t"), next = line.find_first_not_of(" \t", end);
      line.remove_prefix(std::min(next, line.size()));
      ++count;
    }
    return count > words;
  }

  /// Gmsh writes cells of order 3 and more under the words of linear ones, with all their nodes.
  /// Without nodes: the cells are what the word says.
  GmshElement elementAhead(const Kind& kind, std::uint64_t number) {
    const std::uint64_t expected = kind.nodes + 1;
    if (bytes_ || number == 0 || !nextLineHasMore(expected)) return {};
    const std::uint64_t each = integersAhead() / number;
    if (each <= expected || each > kMaxNumbers) return {};
    const auto nodes = static_cast<std::uint32_t>(each - 1);
    // of lines, triangles and quadrilaterals the number of nodes alone counts
    return kind.type == 0 ? GmshElement{nodes} : higherGmshElement(kind.type, nodes);
  }

  void readCells(const Kind& kind, std::uint64_t number) {
    const GmshElement higher = elementAhead(kind, number);
    const std::uint32_t nodes = higher.nodes > 0 ? higher.nodes : kind.nodes;
    if (!in_.fits(number, (nodes + 1) * integerBytes() - (bytes_ ? 0 : 1), "cells")) return;
    std::vector<VertexId> ids(nodes), ordered;
    for (std::uint64_t i = 0; i < number && !in_.failed(); ++i) {
      for (VertexId& id : ids) {
        const std::int64_t fromOne = integer("a vertex id");
        id = fromOne >= 1 && fromOne <= std::int64_t{kGhost} ? static_cast<VertexId>(fromOne - 1)
                                                             : kGhost;
      }
      const std::int64_t reference = integer("a cell's reference");
      if (kind.type == 0) {
        ++report_.ignoredCells;
        continue;
      }
      ordered = ids;
      for (std::size_t k = 0; k < higher.nodeOf.size(); ++k) ordered[k] = ids[higher.nodeOf[k]];
      out_.addCell(higher.nodes > 0 ? higher.type : kind.type, ordered);
      cellReferences_.push_back(static_cast<double>(reference));
    }
    if (!bytes_) in_.endsList(number, "cells");
  }

  void addReferences(const char* association, std::vector<double>& references) {
    if (std::ranges::all_of(references, [](double r) { return r == 0; })) return;
    // text may hold any number, whatever its version
    const char* type = version_ >= kWideIds ? "int64" : integerTypeOf(references);
    out_.fields.push_back({"medit:ref", 1, type, std::move(references), association});
  }

  MeshScanner in_;
  bool bytes_;
  ReadReport& report_;
  std::int32_t version_ = 1;
  CellMesh out_;
  std::vector<double> pointReferences_, cellReferences_;
};

}  // namespace

Result<CellMesh> readMedit(const std::filesystem::path& path, ReadReport& report,
                           std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  constexpr std::string_view kFirstByte("\1", 1), kFirstByteSwapped("\0", 1);
  const bool bytes = text->starts_with(kFirstByte) || text->starts_with(kFirstByteSwapped);
  return Medit(*text, path, bytes, report).read(patience);
}

}  // namespace qtet

#include <algorithm>
#include <array>
#include <unordered_map>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/text_readers.h"

namespace qtet {
namespace {

/// A kind of solid elements by its descriptor. `order`: which of the file's nodes is VTK's first,
/// second ...: the file goes round each layer, corner and middle in turn.
struct Solid {
  std::uint32_t descriptor;
  std::uint8_t type;
  std::uint8_t nodes;
  std::array<std::uint8_t, 20> order;
};
constexpr std::array<Solid, 6> kSolids{{
    {111, kTetrahedronCell, 4, {0, 1, 2, 3}},
    {112, kWedgeCell, 6, {0, 1, 2, 3, 4, 5}},
    {115, kHexahedronCell, 8, {0, 1, 2, 3, 4, 5, 6, 7}},
    {118, kQuadraticTetrahedronCell, 10, {0, 2, 4, 9, 1, 3, 5, 6, 7, 8}},
    {113, kQuadraticWedgeCell, 15, {0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8}},
    {116, kQuadraticHexahedronCell, 20, {0, 2, 4,  6,  12, 14, 16, 18, 1,  3,
                                         5, 7, 13, 15, 17, 19, 8,  9,  10, 11}},
}};
/// Descriptors from this on are solids; below are rods, beams, shells and membranes.
constexpr std::uint32_t kFirstSolid = 101, kLastSolid = 119;
/// A beam has a line of its own for its cross-sections.
constexpr std::array<std::uint32_t, 5> kBeams{11, 21, 22, 23, 24};
/// No element has more nodes: a count beyond is damage.
constexpr std::uint32_t kMaxNodes = 64;

class Unv {
 public:
  Unv(std::string_view text, const std::filesystem::path& path, ReadReport& report)
      : in_(text, path), report_(report) {}

  Result<CellMesh> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    while (!in_.atEnd() && !in_.failed()) {
      if (in_.line() != "-1") continue;
      const std::string_view dataset = in_.line();
      if (dataset == "2411" || dataset == "781")
        nodes();
      else if (dataset == "2412" || dataset == "780")
        elements(dataset == "780");
      else
        skip();
    }
    if (in_.failed()) return in_.error();
    // elements may stand before nodes
    for (VertexId& id : out_.vertices) {
      const auto at = numbers_.find(id);
      id = at == numbers_.end() ? kGhost : at->second;
    }
    return std::move(out_);
  }

 private:
  /// Passes a dataset that is not read, up to the -1 at its end.
  void skip() {
    while (!in_.atEnd() && in_.line() != "-1") {
    }
  }

  /// The next word as a label, or -1 where the dataset ends.
  std::int64_t label() { return in_.number<std::int64_t>("a label or -1"); }

  /// A number whose exponent Fortran writes with a D.
  double real() {
    const std::string_view word = in_.word();
    std::array<char, 64> text{};
    const std::size_t length = std::min(word.size(), text.size());
    std::ranges::transform(word.substr(0, length), text.begin(),
                           [](char c) { return c == 'D' || c == 'd' ? 'E' : c; });
    const bool isSigned = length > 0 && text[0] == '+';
    double value = 0;
    const auto read = std::from_chars(text.data() + isSigned, text.data() + length, value);
    if (length == 0 || read.ec != std::errc{} || read.ptr != text.data() + length)
      in_.fail(ErrorCode::kBadInput, "'" + std::string(word.substr(0, 20)) +
                                         "' is no coordinate; the file is damaged, export it "
                                         "again");
    return value;
  }

  void nodes() {
    while (!in_.failed()) {
      const std::int64_t node = label();
      if (node == -1) return in_.skipLine();
      in_.skipLine();  // coordinate systems and colour
      Position p{};
      for (double& x : p) x = real();
      in_.skipLine();
      if (in_.failed()) return;
      if (!isId(node)) return;
      if (!numbers_.emplace(static_cast<VertexId>(node), static_cast<VertexId>(out_.points.size()))
               .second)
        return in_.fail(ErrorCode::kBadInput, "node " + std::to_string(node) +
                                                  " is there twice; the file is damaged, export "
                                                  "it again");
      out_.points.push_back(p);
    }
  }

  bool isId(std::int64_t node) {
    if (node >= 0 && node < std::int64_t{kGhost}) return true;
    in_.fail(ErrorCode::kBadInput, std::to_string(node) +
                                       " is no number of a node; the file is damaged, export it "
                                       "again");
    return false;
  }

  /// `isOld`: dataset 780, which has two more numbers in an element's first line.
  void elements(bool isOld) {
    std::array<VertexId, kMaxNodes> nodes{};
    while (!in_.failed()) {
      if (label() == -1) return in_.skipLine();
      const auto descriptor = in_.number<std::uint32_t>("an element's descriptor");
      for (int i = 0; i < (isOld ? 5 : 3); ++i) in_.number<std::int64_t>("a property");
      const auto count = in_.number<std::uint32_t>("an element's number of nodes");
      in_.skipLine();
      if (std::ranges::find(kBeams, descriptor) != kBeams.end()) in_.skipLine();
      if (in_.failed()) return;
      if (count > kMaxNodes)
        return in_.fail(ErrorCode::kBadInput, "an element has " + std::to_string(count) +
                                                  " nodes; the file is damaged, export it again");
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto node = in_.number<std::int64_t>("a node's number");
        if (in_.failed() || !isId(node)) return;
        nodes[i] = static_cast<VertexId>(node);
      }
      in_.skipLine();
      add(descriptor, std::span(nodes).first(count));
    }
  }

  void add(std::uint32_t descriptor, std::span<const VertexId> nodes) {
    if (descriptor < kFirstSolid || descriptor > kLastSolid) {
      ++report_.ignoredCells;
      return;
    }
    const auto solid = std::ranges::find(kSolids, descriptor, &Solid::descriptor);
    if (solid == kSolids.end() || solid->nodes != nodes.size())
      return in_.fail(ErrorCode::kBadInput,
                      "a solid element of " + std::to_string(nodes.size()) +
                          " nodes has the descriptor " + std::to_string(descriptor) +
                          "; tetrahedra, wedges and hexahedra of first and second order are "
                          "read. Save the mesh as .med or .vtu");
    std::array<VertexId, 20> ids{};
    for (std::size_t i = 0; i < nodes.size(); ++i) ids[i] = nodes[solid->order[i]];
    out_.addCell(solid->type, std::span(ids).first(nodes.size()));
  }

  MeshScanner in_;
  ReadReport& report_;
  CellMesh out_;  ///< whose cells name the file's own numbers until all nodes are known
  std::unordered_map<VertexId, VertexId> numbers_;  ///< of the file's own
};

}  // namespace

Result<CellMesh> readUnv(const std::filesystem::path& path, ReadReport& report,
                         std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return Unv(*text, path, report).read(patience);
}

}  // namespace qtet

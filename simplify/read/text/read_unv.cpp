#include <algorithm>
#include <array>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/read/text/set_labels.h"
#include "simplify/read/text/text_readers.h"
#include "simplify/read/text/unv_numbers.h"
#include "simplify/read/text/unv_results.h"

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
/// Datasets of groups by their numbers of an entity. Fields beside its type and label tell nothing.
constexpr auto kGroups = std::to_array<std::string_view>({"2435", "2452", "2467", "2477"});
constexpr std::string_view kOldGroups = "752";
constexpr std::int64_t kElementInGroup = 8;

/// A group's elements by the file's own numbers.
struct Group {
  std::string name;
  std::vector<std::uint32_t> elements;
};

class Unv {
 public:
  Unv(std::string_view text, const std::filesystem::path& path, ReadReport& report)
      : in_(text, path), report_(report), results_(in_, report.notes) {}

  Result<CellMesh> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    while (!in_.atEnd() && !in_.failed()) {
      if (in_.line() != "-1") continue;
      const std::string_view dataset = in_.line();
      if (dataset == "2411" || dataset == "781")
        nodes();
      else if (dataset == "2412" || dataset == "780")
        elements(dataset == "780");
      else if (dataset == kOldGroups || std::ranges::find(kGroups, dataset) != kGroups.end())
        groups(dataset == kOldGroups);
      else if (!results_.read(dataset))
        skipUnvDataset(in_);
    }
    if (in_.failed()) return in_.error();
    // elements may stand before nodes
    for (VertexId& id : out_.vertices) {
      const auto at = numbers_.find(id);
      id = at == numbers_.end() ? kGhost : at->second;
    }
    results_.addTo(out_, numbers_);
    addGroups();
    return std::move(out_);
  }

 private:
  void nodes() {
    while (!in_.failed()) {
      const std::int64_t node = unvLabel(in_);
      if (node == -1) return in_.skipLine();
      in_.skipLine();  // coordinate systems and colour
      Position p{};
      for (double& x : p) x = unvReal(in_);
      in_.skipLine();
      if (in_.failed()) return;
      if (!isUnvNode(in_, node)) return;
      if (!numbers_.emplace(static_cast<VertexId>(node), static_cast<VertexId>(out_.points.size()))
               .second)
        return in_.fail(ErrorCode::kBadInput, "node " + std::to_string(node) +
                                                  " is there twice; the file is damaged, export "
                                                  "it again");
      out_.points.push_back(p);
    }
  }

  /// `isOld`: dataset 780, which has two more numbers in an element's first line.
  void elements(bool isOld) {
    std::array<VertexId, kMaxNodes> nodes{};
    while (!in_.failed()) {
      const std::int64_t element = unvLabel(in_);
      if (element == -1) return in_.skipLine();
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
        if (in_.failed() || !isUnvNode(in_, node)) return;
        nodes[i] = static_cast<VertexId>(node);
      }
      in_.skipLine();
      add(element, descriptor, std::span(nodes).first(count));
    }
  }

  void add(std::int64_t element, std::uint32_t descriptor, std::span<const VertexId> nodes) {
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
    if (std::in_range<std::uint32_t>(element))
      elements_.emplace(static_cast<std::uint32_t>(element),
                        static_cast<std::uint32_t>(out_.cells()));
    out_.addCell(solid->type, std::span(ids).first(nodes.size()));
  }

  /// `isOld`: an entity has two numbers, else four.
  void groups(bool isOld) {
    while (!in_.failed()) {
      const std::int64_t number = unvLabel(in_);
      if (number == -1) return in_.skipLine();
      // the last number of the line
      const std::string_view head = in_.line();
      const std::size_t blank = head.find_last_of(" \t");
      const auto count =
          plainInteger<std::uint32_t>(head.substr(blank == std::string_view::npos ? 0 : blank + 1));
      if (!count && !in_.failed())
        in_.fail(ErrorCode::kBadInput, "group " + std::to_string(number) +
                                           " does not say how many entities it has; export the "
                                           "file again");
      Group group{std::string(in_.line()), {}};
      if (group.name.empty()) group.name = "group " + std::to_string(number);
      if (!count || !in_.fits(*count, kMinTextBytes * (isOld ? 2 : 4), "entities")) return;
      for (std::uint32_t i = 0; i < *count && !in_.failed(); ++i) {
        const auto type = in_.number<std::int64_t>("an entity's type"),
                   entity = in_.number<std::int64_t>("an entity's number");
        for (int k = 0; k < (isOld ? 0 : 2); ++k) in_.number<std::int64_t>("an entity's part");
        if (type == kElementInGroup && std::in_range<std::uint32_t>(entity))
          group.elements.push_back(static_cast<std::uint32_t>(entity));
      }
      if (*count > 0) in_.skipLine();
      if (!group.elements.empty()) groups_.push_back(std::move(group));
    }
  }

  void addGroups() {
    CellSets sets;
    for (const Group& group : groups_) sets.names.push_back(group.name);
    std::vector<std::uint32_t> taken(out_.cells());
    std::uint32_t call = 0;
    sets.cellsOf = [&](std::size_t set, std::vector<std::uint32_t>& cells) {
      ++call;
      for (const std::uint32_t element : groups_[set].elements) {
        const auto at = elements_.find(element);
        if (at == elements_.end() || taken[at->second] == call) continue;
        taken[at->second] = call;
        cells.push_back(at->second);
      }
    };
    if (auto field = labelOfSets("Group", out_.cells(), sets, report_.notes))
      out_.fields.push_back(std::move(*field));
  }

  MeshScanner in_;
  ReadReport& report_;
  CellMesh out_;          ///< whose cells name the file's own numbers until all nodes are known
  NumberTable numbers_;   ///< of the file's own nodes
  NumberTable elements_;  ///< of the file's own solids
  std::vector<Group> groups_;
  UnvResults results_;
};

}  // namespace

Result<CellMesh> readUnv(const std::filesystem::path& path, ReadReport& report,
                         std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return Unv(*text, path, report).read(patience);
}

}  // namespace qtet

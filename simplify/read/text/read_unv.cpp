#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "proto/limits.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/read/text/set_labels.h"
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
/// Datasets of groups by their numbers of an entity. Fields beside its type and label tell nothing.
constexpr auto kGroups = std::to_array<std::string_view>({"2435", "2452", "2467", "2477"});
constexpr std::string_view kOldGroups = "752";
constexpr std::int64_t kElementInGroup = 8;
/// Where results are, and kinds of their numbers, in dataset 2414.
constexpr int kAtNodes = 1;
constexpr int kSingle = 2, kDouble = 4;
/// A result at fewer than one of so many nodes would take memory that the file's size does not
/// bound.
constexpr std::size_t kFewNodes = 16;

/// A group's elements by the file's own numbers.
struct Group {
  std::string name;
  std::vector<std::uint32_t> elements;
};

/// A result at nodes: a tuple for each of `nodes`.
struct Result2414 {
  std::string type;
  std::uint32_t components = 1;
  std::vector<std::uint32_t> nodes;
  std::vector<double> values;
};

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
      else if (dataset == kOldGroups || std::ranges::find(kGroups, dataset) != kGroups.end())
        groups(dataset == kOldGroups);
      else if (dataset == "2414")
        result();
      else
        skip(dataset);
    }
    if (in_.failed()) return in_.error();
    // elements may stand before nodes
    for (VertexId& id : out_.vertices) {
      const auto at = numbers_.find(id);
      id = at == numbers_.end() ? kGhost : at->second;
    }
    for (auto& [name, result] : results_) addResult(name, result);
    addGroups();
    return std::move(out_);
  }

 private:
  /// Passes a dataset that is not read, up to the -1 at its end.
  void skip(std::string_view dataset) {
    constexpr auto kResults = std::to_array<std::string_view>({"55", "56", "57", "2415", "2416"});
    if (std::ranges::find(kResults, dataset) != kResults.end())
      note("results of a dataset " + std::string(dataset) +
           " are not read; those at nodes of dataset 2414 are");
    skip();
  }

  /// A file may have a thousand datasets of which one thing is to be said.
  void note(const std::string& text) {
    if (noted_.insert(text).second) report_.notes.push_back(text);
  }

  void skip() {
    while (!in_.atEnd() && in_.line() != "-1") {
    }
  }

  /// The next word as a label, or -1 where the dataset ends.
  std::int64_t label() { return in_.number<std::int64_t>("a label or -1"); }

  double real() {
    const std::string_view word = in_.word();
    const std::optional<double> value = fortranReal(word);
    if (!value)
      in_.fail(ErrorCode::kBadInput, "'" + std::string(word.substr(0, 20)) +
                                         "' is no number; the file is damaged, export it again");
    return value.value_or(0);
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
      const std::int64_t element = label();
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
        if (in_.failed() || !isId(node)) return;
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
      const std::int64_t number = label();
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

  /// Dataset 2414: a result at nodes. Another one of the same name takes its place.
  void result() {
    in_.line();  // its number
    const std::string name(in_.line());
    const auto place = in_.number<int>("where the results are");
    in_.skipLine();
    for (int i = 0; i < 5; ++i) in_.line();
    std::array<std::int64_t, 6> head{};
    for (std::int64_t& number : head) number = in_.number<std::int64_t>("a kind of result");
    in_.skipLine();
    for (int i = 0; i < 4; ++i) in_.line();
    if (in_.failed()) return;
    const std::int64_t type = head[4], components = head[5];
    if (place != kAtNodes || (type != kSingle && type != kDouble) || components < 1 ||
        components > kMaxFieldComponents) {
      note("the results " + name + " are not read: not real numbers at nodes, or too many at each");
      return skip();
    }
    Result2414 out{
        type == kSingle ? "float32" : "float64", static_cast<std::uint32_t>(components), {}, {}};
    while (!in_.failed()) {
      const std::int64_t node = label();
      if (node == -1) break;
      if (in_.failed() || !isId(node)) return;
      out.nodes.push_back(static_cast<std::uint32_t>(node));
      for (std::int64_t c = 0; c < components; ++c) out.values.push_back(real());
    }
    in_.skipLine();
    if (results_.contains(name)) note("of several results " + name + " the last one is read");
    results_[name] = std::move(out);
  }

  void addResult(const std::string& name, const Result2414& result) {
    if (result.nodes.size() < out_.points.size() / kFewNodes) {
      note("the results " + name + " are left out: few nodes have them");
      return;
    }
    MeshField field{name, result.components, result.type, {}, "point"};
    field.values.assign(out_.points.size() * result.components,
                        std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < result.nodes.size(); ++i) {
      const auto at = numbers_.find(result.nodes[i]);
      if (at == numbers_.end()) continue;
      std::copy_n(result.values.begin() + static_cast<std::ptrdiff_t>(i * result.components),
                  result.components,
                  field.values.begin() +
                      static_cast<std::ptrdiff_t>(std::size_t{at->second} * result.components));
    }
    out_.fields.push_back(std::move(field));
  }

  MeshScanner in_;
  ReadReport& report_;
  CellMesh out_;          ///< whose cells name the file's own numbers until all nodes are known
  NumberTable numbers_;   ///< of the file's own nodes
  NumberTable elements_;  ///< of the file's own solids
  std::vector<Group> groups_;
  std::map<std::string, Result2414> results_;
  std::set<std::string> noted_;
};

}  // namespace

Result<CellMesh> readUnv(const std::filesystem::path& path, ReadReport& report,
                         std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return Unv(*text, path, report).read(patience);
}

}  // namespace qtet

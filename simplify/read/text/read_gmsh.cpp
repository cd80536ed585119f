#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "proto/limits.h"
#include "proto/number_text.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/text/gmsh_elements.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/read/text/text_readers.h"

namespace qtet {
namespace {

/// Gmsh's own numbers of nodes and elements, which may have gaps, to ours.
class Numbers {
 public:
  /// False: the number is taken, and stays with the one that has it.
  bool add(std::uint64_t tag, std::size_t place) { return places_.emplace(tag, place).second; }
  void reserve(std::size_t count) { places_.reserve(count); }
  [[nodiscard]] VertexId operator[](std::uint64_t tag) const {
    const auto at = places_.find(tag);
    return at == places_.end() ? kGhost : static_cast<VertexId>(at->second);
  }

 private:
  std::unordered_map<std::uint64_t, std::size_t, MixedHash> places_;
};

/// One file. Text and bytes differ in how a number is read, versions 2.2 and 4.1 in what stands
/// where.
class Gmsh {
 public:
  Gmsh(std::string_view text, const std::filesystem::path& path, const std::string& time,
       ReadReport& report)
      : in_(text, path), path_(path), time_(time), report_(report) {}

  Result<CellMesh> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    while (!in_.atEnd()) {
      const std::string section(in_.line());
      readSection(section);
      if (in_.failed()) return in_.error();
    }
    if (version_ == 0)
      in_.fail(ErrorCode::kBadInput,
               "there is no $MeshFormat: it is no mesh of Gmsh 2 or 4. Save it with Gmsh again");
    if (in_.failed()) return in_.error();
    return finish();
  }

 private:
  void readSection(const std::string& name) {
    if (name.empty() || name[0] != '$') {
      return in_.fail(ErrorCode::kBadInput,
                      "a section's name such as $Nodes should be here; the file is damaged, or "
                      "no Gmsh mesh");
    }
    if (name != "$MeshFormat" && version_ == 0)
      return in_.fail(ErrorCode::kBadInput,
                      "the file does not begin with $MeshFormat; save it with Gmsh again");
    if (name == "$MeshFormat")
      readFormat();
    else if (name == "$PhysicalNames")
      readNames();
    else if (name == "$Entities" && isNew())
      readEntities();
    else if (name == "$PartitionedEntities" && isNew())
      readPartitions();
    else if (name == "$Nodes")
      isNew() ? readNodes() : readNodes2();
    else if (name == "$Elements")
      isNew() ? readElements() : readElements2();
    else if (name == "$NodeData")
      readData(false);
    else if (name == "$ElementData")
      readData(true);
    else {
      if (name == "$ElementNodeData")
        report_.notes.push_back("ElementNodeData was ignored: it has several values at a node");
      return skipSection(name);
    }
    endSection(name);
  }

  void endSection(const std::string& name) {
    if (in_.failed()) return;
    const std::string end = "$End" + name.substr(1), found(in_.word());
    if (found.empty())
      return in_.fail(ErrorCode::kTruncated,
                      "the file ends without " + end + ": it was cut off; copy or export it again");
    if (found != end)
      in_.fail(ErrorCode::kBadInput,
               end + " should be here: the section's count is wrong; export the mesh again");
    in_.skipLine();
  }

  void skipSection(const std::string& name) {
    const std::string end = "$End" + name.substr(1);
    while (!in_.failed()) {
      if (in_.remaining() == 0)
        return in_.fail(ErrorCode::kTruncated, "the file ends without " + end +
                                                   ": it was cut off; copy or export it again");
      if (in_.line() == end) return;
    }
  }

  void readFormat() {
    version_ = in_.number<double>("the format's version");
    const auto kind = in_.number<int>("0 or 1 for text or bytes"),
               wordBytes = in_.number<int>("the size of a number");
    if (in_.failed()) return;
    if (version_ != 4.1 && !(version_ >= 2 && version_ < 3)) {
      return in_.fail(ErrorCode::kBadInput,
                      "the format's version is " + std::to_string(version_).substr(0, 3) +
                          "; 2.2 and 4.1 are read (gmsh FILE -save -format msh41 -o NEW.msh)");
    }
    bytes_ = kind == 1;
    if (wordBytes != 8)
      return in_.fail(ErrorCode::kBadInput, "numbers of " + std::to_string(wordBytes) +
                                                " bytes; those of 8 are read. Save the mesh again");
    if (!bytes_) return;
    in_.skipLine();
    if (in_.raw<std::int32_t>("the sign of its byte order") != 1)
      in_.fail(ErrorCode::kBadInput, "its numbers are big-endian; save the mesh as text");
  }

  [[nodiscard]] bool isNew() const { return version_ > 4; }

  std::int64_t integer(const char* what) {
    return bytes_ ? in_.raw<std::int32_t>(what) : in_.number<std::int64_t>(what);
  }
  std::uint64_t size(const char* what) {
    return bytes_ ? in_.raw<std::uint64_t>(what) : in_.number<std::uint64_t>(what);
  }
  double real(const char* what) {
    return bytes_ ? in_.raw<double>(what) : in_.number<double>(what);
  }
  bool fits(std::uint64_t count, std::uint64_t inText, std::uint64_t inBytes, const char* what) {
    return in_.fits(count, bytes_ ? inBytes : inText, what);
  }

  /// Text, also in a file of bytes: "3 7 \"steel\"", a line each. Those of volumes alone count.
  void readNames() {
    const auto count = in_.number<std::uint64_t>("the number of physical names");
    if (!in_.fits(count, 7, "physical names")) return;
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      const auto dimension = in_.number<int>("a dimension");
      const auto group = in_.number<std::int64_t>("a physical group");
      std::string_view name = in_.line();
      if (name.size() < 3 || name.front() != '"' || name.back() != '"') continue;
      name = name.substr(1, name.size() - 2);
      if (dimension == 3 && std::in_range<std::int32_t>(group))
        names_.emplace(static_cast<std::int32_t>(group), name);
    }
  }

  void readEntities(bool arePartitioned = false) {
    std::array<std::uint64_t, 4> counts{};
    for (std::uint64_t& count : counts) count = size("a number of entities");
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      if (!fits(counts[dimension], 10, 28, "entities")) return;
      for (std::uint64_t i = 0; i < counts[dimension] && !in_.failed(); ++i)
        readEntity(dimension, arePartitioned);
    }
  }

  void readPartitions() {
    size("the number of partitions");
    const std::uint64_t ghosts = size("a number of ghost entities");
    if (!fits(ghosts, 4, 8, "ghost entities")) return;
    for (std::uint64_t i = 0; i < ghosts; ++i) integer("a ghost entity"), integer("its partition");
    readEntities(true);
  }

  void readEntity(std::size_t dimension, bool isPartitioned) {
    const std::int64_t tag = integer("an entity's number");
    if (isPartitioned) {
      integer("the dimension of an entity's parent"), integer("an entity's parent");
      const std::uint64_t partitions = size("a number of partitions");
      if (!fits(partitions, 2, 4, "partitions")) return;
      for (std::uint64_t i = 0; i < partitions; ++i) integer("a partition");
    }
    for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) real("an entity's extent");
    const std::uint64_t groups = size("a number of physical groups");
    if (!fits(groups, 2, 4, "physical groups")) return;
    for (std::uint64_t i = 0; i < groups; ++i) {
      const std::int64_t group = integer("a physical group");
      if (dimension == 3 && i == 0) groupOf_[tag] = group;
    }
    if (dimension == 0) return;
    const std::uint64_t bounding = size("a number of bounding entities");
    if (!fits(bounding, 2, 4, "bounding entities")) return;
    for (std::uint64_t i = 0; i < bounding; ++i) integer("a bounding entity");
  }

  void readNodes() {
    const std::uint64_t blocks = size("the number of blocks"), count = size("the number of nodes");
    size("the smallest node"), size("the largest node");
    if (!fits(count, 8, 32, "nodes") || !fits(blocks, 8, 20, "blocks of nodes")) return;
    out_.points.reserve(count);
    nodes_.reserve(count);
    for (std::uint64_t block = 0; block < blocks && !in_.failed(); ++block) {
      const std::int64_t dimension = integer("an entity's dimension");
      integer("an entity's number");
      const bool parametric = integer("0 or 1") != 0;
      const std::uint64_t inBlock = size("the number of nodes of a block");
      if (!fits(inBlock, 8, 32, "nodes")) return;
      for (std::uint64_t i = 0; i < inBlock && !in_.failed(); ++i) addNode(size("a node's number"));
      for (std::uint64_t i = 0; i < inBlock && !in_.failed(); ++i) {
        readPoint();
        for (std::int64_t k = 0; parametric && k < std::min<std::int64_t>(dimension, 3); ++k)
          real("a parameter");
      }
    }
  }

  void readNodes2() {
    const auto count = in_.number<std::uint64_t>("the number of nodes");
    if (bytes_) in_.skipLine();
    if (!fits(count, 8, 28, "nodes")) return;
    nodes_.reserve(count);
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      addNode(static_cast<std::uint64_t>(integer("a node's number")));
      readPoint();
    }
  }

  void addNode(std::uint64_t tag) {
    if (!in_.failed() && !nodes_.add(tag, nodeCount_++))
      in_.fail(ErrorCode::kBadInput, "two nodes have the number " + std::to_string(tag) +
                                         "; the file is damaged, export it again");
  }

  void readPoint() {
    Position p{};
    for (double& x : p) x = real("a coordinate");
    out_.points.push_back(p);
  }

  GmshElement kindOf(std::int64_t number) {
    const GmshElement kind = gmshElement(number);
    if (kind.nodes == 0 && !in_.failed()) {
      in_.fail(ErrorCode::kBadInput,
               "elements of type " + std::to_string(number) +
                   " are not read; complete ones of order 1 to 9 are: save the mesh with "
                   "Mesh.SecondOrderIncomplete = 0, or of a lower order (gmsh FILE -order 2)");
    }
    return kind;
  }

  void readElements() {
    const std::uint64_t blocks = size("the number of blocks"),
                        count = size("the number of elements");
    size("the smallest element"), size("the largest element");
    if (!fits(count, 4, 16, "elements") || !fits(blocks, 8, 20, "blocks of elements")) return;
    for (std::uint64_t block = 0; block < blocks && !in_.failed(); ++block) {
      integer("an entity's dimension");
      const std::int64_t entity = integer("an entity's number");
      const GmshElement kind = kindOf(integer("a type of element"));
      const std::uint64_t inBlock = size("the number of elements of a block");
      if (!fits(inBlock, 2 * (kind.nodes + 1), 8 * (kind.nodes + 1), "elements")) return;
      const auto group = groupOf_.find(entity);
      for (std::uint64_t i = 0; i < inBlock && !in_.failed(); ++i) {
        const std::uint64_t tag = size("an element's number");
        ids_.clear();
        for (std::uint32_t k = 0; k < kind.nodes; ++k) ids_.push_back(nodes_[size("a node")]);
        addElement(kind, tag, group == groupOf_.end() ? 0 : group->second);
      }
    }
  }

  void readElements2() {
    const auto count = in_.number<std::uint64_t>("the number of elements");
    if (bytes_) in_.skipLine();
    if (!fits(count, 8, 8, "elements")) return;
    for (std::uint64_t i = 0; i < count && !in_.failed();) {
      std::uint64_t tag = 0, inBlock = 1;
      if (!bytes_) tag = in_.number<std::uint64_t>("an element's number");
      const GmshElement kind = kindOf(integer("a type of element"));
      if (bytes_)
        inBlock = static_cast<std::uint64_t>(integer("the number of elements of a block"));
      const auto tags = static_cast<std::uint64_t>(integer("the number of an element's tags"));
      if (!fits(tags, 2, 4, "tags") ||
          !fits(inBlock, 2 * kind.nodes, 4 * (kind.nodes + tags), "elements"))
        return;
      if (inBlock == 0)
        return in_.fail(ErrorCode::kBadInput,
                        "a block of no elements; the file is damaged, export it again");
      for (std::uint64_t k = 0; k < inBlock && !in_.failed(); ++k, ++i) {
        if (bytes_) tag = static_cast<std::uint64_t>(integer("an element's number"));
        readElement2(kind, tag, tags);
      }
    }
  }

  void readElement2(const GmshElement& kind, std::uint64_t tag, std::uint64_t tags) {
    std::int64_t group = 0;
    for (std::uint64_t t = 0; t < tags; ++t) {
      const std::int64_t value = integer("a tag");
      if (t == 0) group = value;
    }
    ids_.clear();
    for (std::uint32_t k = 0; k < kind.nodes; ++k)
      ids_.push_back(nodes_[static_cast<std::uint64_t>(integer("a node"))]);
    addElement(kind, tag, group);
  }

  /// ids_ in Gmsh's order.
  void addElement(const GmshElement& kind, std::uint64_t tag, std::int64_t group) {
    if (in_.failed()) return;
    if (kind.type == 0) {
      ++report_.ignoredCells;
      return;
    }
    ordered_ = ids_;
    for (std::size_t k = 0; k < kind.nodeOf.size(); ++k) ordered_[k] = ids_[kind.nodeOf[k]];
    elements_.add(tag, out_.cells());
    out_.addCell(kind.type, ordered_);
    groups_.push_back(static_cast<double>(group));
  }

  /// A field of nodes or elements; it has NaN where the file gives no value.
  void readData(bool ofElements) {
    const auto texts = in_.number<std::uint64_t>("the number of texts");
    in_.skipLine();
    std::string name;
    if (!in_.fits(texts, 1, "texts")) return;
    for (std::uint64_t i = 0; i < texts && !in_.failed(); ++i) {
      const std::string text(in_.line());
      if (i == 0) name = text;
    }
    std::erase(name, '"');
    const auto reals = in_.number<std::uint64_t>("the number of numbers");
    double time = 0;
    for (std::uint64_t i = 0; i < reals && !in_.failed(); ++i) {
      const auto value = in_.number<double>("a number such as the time");
      if (i == 0) time = value;
    }
    const auto integers = in_.number<std::uint64_t>("the number of integers");
    std::array<std::uint64_t, 3> head{};  // step, components, tuples
    for (std::uint64_t i = 0; i < integers && !in_.failed(); ++i) {
      const auto value = in_.number<std::uint64_t>("an integer such as the number of components");
      if (i < head.size()) head[i] = value;
    }
    if (bytes_) in_.skipLine();
    if (head[1] < 1 || head[1] > kMaxFieldComponents)
      return in_.fail(ErrorCode::kBadInput, "the field " + name + " has " +
                                                std::to_string(head[1]) + " components; 1 to " +
                                                std::to_string(kMaxFieldComponents) + " are read");
    if (!fits(head[2], 2 * (head[1] + 1), 4 + 8 * head[1], "values")) return;
    const std::size_t before = out_.fields.size();
    readTuples(ofElements, name, head[1], head[2]);
    if (out_.fields.size() > before) times_.push_back(time);
  }

  void readTuples(bool ofElements, const std::string& name, std::uint64_t components,
                  std::uint64_t tuples) {
    const Numbers& numbers = ofElements ? elements_ : nodes_;
    const std::size_t places = ofElements ? out_.cells() : out_.points.size();
    MeshField field{name.empty() ? "unnamed-" + std::to_string(out_.fields.size()) : name,
                    static_cast<std::uint32_t>(components),
                    "float64",
                    {},
                    ofElements ? "cell" : "point"};
    field.values.assign(places * components, std::numeric_limits<double>::quiet_NaN());
    bool any = false;
    for (std::uint64_t i = 0; i < tuples && !in_.failed(); ++i) {
      const VertexId at = numbers[static_cast<std::uint64_t>(integer("a number"))];
      for (std::uint64_t c = 0; c < components; ++c) {
        const double value = real("a value");
        if (at == kGhost) continue;  // of an element of lower dimension
        field.values[at * components + c] = value;
        any = true;
      }
    }
    if (any) out_.fields.push_back(std::move(field));
  }

  /// Keeps the steps that are meant of each field that the file has at several times. If all steps
  /// are meant, they are called NAME@TIME, as those of other series.
  Status chooseSteps() {
    std::map<std::pair<std::string, std::string>, std::size_t> count;
    for (const MeshField& field : out_.fields) ++count[{field.association, field.name}];
    const auto isSeries = [&](std::size_t f) {
      return count[{out_.fields[f].association, out_.fields[f].name}] > 1;
    };
    std::vector<double> times;
    for (std::size_t f = 0; f < times_.size(); ++f) {
      if (isSeries(f)) times.push_back(times_[f]);
    }
    const bool any = !times.empty();
    // each field has one time: nothing to choose, but --time must name one of them
    if (!any) times = times_;
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::vector<std::string> unsaid;
    const auto steps = chosenSteps(times, time_, path_, any ? report_.notes : unsaid);
    if (!steps) return std::unexpected(steps.error());
    if (!any) return {};
    std::vector<MeshField> kept;
    for (std::size_t f = 0; f < times_.size(); ++f) {
      const bool series = isSeries(f);
      if (series &&
          std::ranges::none_of(*steps, [&](std::size_t step) { return times[step] == times_[f]; }))
        continue;
      kept.push_back(out_.fields[f]);
      if (series && steps->size() > 1)
        kept.back().name = kept.back().name.at(shortestText(times_[f]));
    }
    out_.fields = std::move(kept);
    return {};
  }

  Result<CellMesh> finish() {
    if (Status chosen = chooseSteps(); !chosen) return std::unexpected(chosen.error());
    const char* type = integerTypeOf(groups_);
    if (std::ranges::any_of(groups_, [](double g) { return g != 0; }))
      out_.fields.push_back(
          {"gmsh:physical", 1, type, std::move(groups_), "cell", std::move(names_)});
    return std::move(out_);
  }

  MeshScanner in_;
  const std::filesystem::path& path_;
  const std::string& time_;
  ReadReport& report_;
  double version_ = 0;
  bool bytes_ = false;
  CellMesh out_;
  Numbers nodes_, elements_;
  std::size_t nodeCount_ = 0;
  std::unordered_map<std::int64_t, std::int64_t, MixedHash> groupOf_;  ///< of a volume
  LabelNames names_;                                                   ///< of volumes' groups
  std::vector<double> times_;                                          ///< one a field
  std::vector<double> groups_;                                         ///< one a cell
  std::vector<VertexId> ids_, ordered_;
};

}  // namespace

Result<CellMesh> readGmsh(const std::filesystem::path& path, const std::string& time,
                          ReadReport& report, std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return Gmsh(*text, path, time, report).read(patience);
}

}  // namespace qtet

#include "simplify/read/ensight/ensight_geometry.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "codec/coding/float_bits.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/steps/cell_labels.h"

namespace qtet {
namespace {

constexpr std::uint8_t kNoSolid = 0, kPolygons = 1;  ///< VTK's numbers of no volume

/// A kind of elements, whose nodes stand in VTK's order but for wedges.
struct ElementKind {
  std::string_view name;
  std::uint8_t nodes;  ///< 0: as many as the file says
  std::uint8_t type;   ///< CellType, kNoSolid or kPolygons
};
constexpr std::array<ElementKind, 17> kElementKinds{{
    {"point", 1, kNoSolid},
    {"bar2", 2, kNoSolid},
    {"bar3", 3, kNoSolid},
    {"tria3", 3, kNoSolid},
    {"tria6", 6, kNoSolid},
    {"quad4", 4, kNoSolid},
    {"quad8", 8, kNoSolid},
    {"nsided", 0, kPolygons},
    {"tetra4", 4, kTetrahedronCell},
    {"tetra10", 10, kQuadraticTetrahedronCell},
    {"pyramid5", 5, kPyramidCell},
    {"pyramid13", 13, kQuadraticPyramidCell},
    {"penta6", 6, kWedgeCell},
    {"penta15", 15, kQuadraticWedgeCell},
    {"hexa8", 8, kHexahedronCell},
    {"hexa20", 20, kQuadraticHexahedronCell},
    {"nfaced", 0, kPolyhedronCell},
}};
/// The place of each node in VTK's wedge, whose triangles look the other way.
constexpr std::array<std::uint8_t, 15> kWedgeOrder{0, 2,  1,  3, 5,  4,  8, 7,
                                                   6, 11, 10, 9, 12, 14, 13};

bool isWedge(std::uint8_t type) { return type == kWedgeCell || type == kQuadraticWedgeCell; }

class GeometryReader {
 public:
  GeometryReader(std::string_view bytes, const std::filesystem::path& file,
                 const EnSightEncoding& encoding, EnSightBounds& bounds, ReadReport& report)
      : in_(bytes, file, encoding, bounds.patience),
        isGold_(encoding.isGold),
        bounds_(bounds),
        report_(report) {}

  Result<EnSightGeometry> read() {
    const std::string_view first = in_.line();
    if (!in_.isText() && (first.starts_with("C Binary") || first.starts_with("Fortran Binary")))
      in_.line();
    in_.line();  // the second line of its description
    const std::string_view nodeIds = idLine("node id");
    hasNodeIds_ = standIn(nodeIds);
    areNodeIdsMeant_ = nodeIds.contains("given");
    hasElementIds_ = standIn(idLine("element id"));
    std::string_view next = in_.keyword();
    if (next.starts_with("extents")) {
      for (int i = 0; i < 6; ++i) in_.real("an extent");
      next = in_.keyword();
    }
    if (!isGold_) {
      if (!next.starts_with("coordinates")) refuse(next, "\"coordinates\"");
      globalNodes();
      next = in_.keyword();
    }
    while (!in_.failed() && !next.empty()) next = part(next);
    if (in_.failed()) return in_.error();
    for (EnSightBlock& block : out_.blocks) {
      if (block.mesh.pointType.empty()) block.mesh.pointType = "float32";
      if (block.rows.size() < block.elements) block.mesh.cellIds = block.rows;
    }
    out_.encoding = in_.encoding();
    return std::move(out_);
  }

 private:
  void refuse(std::string_view found, const std::string& what) {
    if (in_.failed()) return;
    std::string shown(found.substr(0, kShown));
    for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
    in_.fail("'" + shown + "' is where " + what +
             " should be; the file is damaged, export it again");
  }

  std::string_view idLine(std::string_view key) {
    const std::string_view line = in_.keyword();
    if (!line.starts_with(key)) refuse(line, "\"" + std::string(key) + "\"");
    return line;
  }

  /// Whether ids stand in the file.
  static bool standIn(std::string_view line) {
    return line.contains("given") || line.contains("ignore");
  }

  /// The nodes of EnSight 6, which its parts share.
  void globalNodes() {
    in_.findOrder(hasNodeIds_ ? 4 : 3);
    const std::uint64_t count = in_.count("the number of nodes");
    if (!in_.fits(3 * count, "coordinates")) return;
    out_.blocks.emplace_back();
    std::vector<Position>& points = out_.blocks.front().mesh.points;
    points.resize(count);
    if (hasNodeIds_ && !in_.isText()) addNodeIds(count);
    for (Position& p : points) {
      if (hasNodeIds_ && in_.isText()) addNodeId(in_.integer("a node's id"));
      for (double& x : p) x = widened(in_.real("a coordinate"));
      if (in_.failed()) return;
    }
    sortIds();
  }

  void addNodeIds(std::uint64_t count) {
    if (!in_.fits(count, "ids of nodes")) return;
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i)
      addNodeId(in_.integer("a node's id"));
  }

  void addNodeId(std::int64_t id) { ids_.push_back({id, static_cast<VertexId>(ids_.size())}); }

  void sortIds() {
    if (!areNodeIdsMeant_) ids_.clear();
    std::ranges::sort(ids_);
    const auto twice =
        std::ranges::adjacent_find(ids_, {}, [](const auto& id) { return id.first; });
    if (twice != ids_.end())
      in_.fail("node " + std::to_string(twice->first) +
               " is there twice; the file is damaged, export it again");
  }

  VertexId pointOf(std::int64_t id, std::uint64_t points) const {
    if (!ids_.empty()) {
      const auto at =
          std::ranges::lower_bound(ids_, id, {}, [](const auto& one) { return one.first; });
      return at != ids_.end() && at->first == id ? at->second : kGhost;
    }
    return id >= 1 && static_cast<std::uint64_t>(id) <= points ? static_cast<VertexId>(id - 1)
                                                               : kGhost;
  }

  /// Reads a part behind its keyword. Gives the keyword behind it.
  std::string_view part(std::string_view keyword) {
    if (!keyword.starts_with("part")) refuse(keyword, "\"part\"");
    const std::int64_t number =
        isGold_ ? in_.integer("a part's number") : ensightPartNumber(keyword);
    std::string name(in_.line());
    name.erase(name.find_last_not_of(" \t\r") + 1);
    if (in_.failed()) return {};
    const auto [at, isNew] = out_.parts.try_emplace(number);
    if (!isNew) {
      in_.fail("part " + std::to_string(number) + " is there twice; export the case again");
      return {};
    }
    part_ = &at->second;
    const std::string_view next = contents();
    const bool isNumber = number > 0 && std::in_range<std::int32_t>(number);
    if (!in_.failed())
      nameNewCells(name, static_cast<std::int32_t>(isNumber ? number : std::ssize(out_.parts)),
                   block().mesh);
    return next;
  }

  /// Reads a part behind its name. Gives the keyword behind it.
  std::string_view contents() {
    std::string_view next = in_.keyword();
    if (next.starts_with("block")) {
      addBlock();
      grid(std::string(next));
      next = in_.keyword();
      // ids of a grid stand behind it, in Gold alone
      while (isGold_ && (next.starts_with("node_ids") || next.starts_with("element_ids"))) {
        const std::uint64_t count =
            next.starts_with("node_ids") ? block().mesh.points.size() : block().elements;
        if (in_.fits(count, "ids of a grid")) in_.skipIntegers(count);
        next = in_.keyword();
      }
      return next;
    }
    if (isGold_) {
      addBlock();
      if (next.starts_with("coordinates")) {
        nodesOfPart();
        next = in_.keyword();
      }
    }
    while (!in_.failed() && !next.empty() && !next.starts_with("part")) {
      elements(std::string(next));
      next = in_.keyword();
    }
    return next;
  }

  void addBlock() {
    part_->block = out_.blocks.size();
    out_.blocks.emplace_back();
  }

  EnSightBlock& block() { return out_.blocks[part_->block]; }

  void nodesOfPart() {
    const std::uint64_t count = in_.count("the number of nodes");
    if (hasNodeIds_) {
      if (!in_.fits(count, "ids of nodes")) return;
      in_.skipIntegers(count);
    }
    coordinates(count);
  }

  /// All x, all y and all z.
  void coordinates(std::uint64_t count) {
    if (!in_.fits(3 * count, "coordinates")) return;
    std::vector<Position>& points = block().mesh.points;
    points.resize(count);
    for (std::size_t axis = 0; axis < 3 && !in_.failed(); ++axis)
      for (Position& p : points) p[axis] = widened(in_.real("a coordinate"));
  }

  void elements(const std::string& line) {
    std::string_view name = line;
    name = name.substr(0, name.find_first_of(" \t"));
    const bool isGhost = name.starts_with("g_");
    const auto kind =
        std::ranges::find(kElementKinds, name.substr(isGhost ? 2 : 0), &ElementKind::name);
    if (kind == kElementKinds.end()) return refuse(line, "a kind of elements");
    const std::uint64_t count = in_.count("the number of elements");
    const auto [at, isNew] = part_->elements.try_emplace(std::string(name));
    if (!isNew)
      return in_.fail("a part has " + std::string(name) + " twice; export the case again");
    at->second = {block().elements, count};
    const bool isKept = !isGhost && kind->type > kPolygons;
    if (!isGhost && !isKept) report_.ignoredCells += count;
    const bool interleaves = !isGold_ && in_.isText();
    if (hasElementIds_ && !interleaves) {
      if (!in_.fits(count, "ids of elements")) return;
      in_.skipIntegers(count);
    }
    if (kind->nodes == 0)
      manySided(kind->type, count, isKept);
    else
      fixedSize(*kind, count, isKept, hasElementIds_ && interleaves);
    block().elements += count;
  }

  void fixedSize(const ElementKind& kind, std::uint64_t count, bool isKept, bool isNumbered) {
    const std::uint64_t each = kind.nodes + (isNumbered ? 1u : 0u);
    if (!in_.fits(count * each, "ids of nodes")) return;
    if (!isKept) return in_.skipIntegers(count * each);
    EnSightBlock& to = block();
    std::array<VertexId, 20> ids{};
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      if (isNumbered) in_.integer("an element's id");
      for (std::size_t k = 0; k < kind.nodes; ++k)
        ids[isWedge(kind.type) ? kWedgeOrder[k] : k] = corner();
      to.mesh.addCell(kind.type, std::span(ids).first(kind.nodes));
      to.rows.push_back(to.elements + i);
    }
  }

  VertexId corner() { return pointOf(in_.integer("a node's id"), block().mesh.points.size()); }

  /// Counts that follow, and their sum; an error if fewer numbers follow.
  std::vector<std::uint32_t> counts(std::uint64_t number, const char* what, std::uint64_t& sum) {
    std::vector<std::uint32_t> out;
    if (!in_.fits(number, what)) return out;
    out.reserve(number);
    for (std::uint64_t i = 0; i < number && !in_.failed(); ++i) {
      out.push_back(static_cast<std::uint32_t>(in_.count(what)));
      sum += out.back();
    }
    in_.fits(sum, what);
    return out;
  }

  /// Polygons (dropped) or polyhedra.
  void manySided(std::uint8_t type, std::uint64_t count, bool isKept) {
    const bool isOfPolygons = type == kPolygons;
    std::uint64_t faces = 0, corners = 0;
    std::vector<std::uint32_t> facesOf;
    if (!isOfPolygons) facesOf = counts(count, "a polyhedron's number of faces", faces);
    const std::vector<std::uint32_t> cornersOf =
        counts(isOfPolygons ? count : faces, "a face's number of nodes", corners);
    if (in_.failed()) return;
    if (!isKept) return in_.skipIntegers(corners);
    EnSightBlock& to = block();
    std::vector<VertexId> ids;
    std::size_t face = 0;
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i) {
      ids.assign(1, facesOf[i]);
      for (std::uint32_t f = 0; f < facesOf[i]; ++f, ++face) {
        ids.push_back(cornersOf[face]);
        for (std::uint32_t k = 0; k < cornersOf[face]; ++k) ids.push_back(corner());
      }
      to.mesh.addCell(type, ids);
      to.rows.push_back(to.elements + i);
    }
  }

  /// A grid of i x j x k points behind its line "block ...".
  void grid(const std::string& line) {
    part_->isGrid = true;
    std::array<std::uint64_t, 3> n{};
    std::uint64_t points = 1;
    for (std::uint64_t& side : n)
      side = static_cast<std::uint64_t>(std::max<std::int64_t>(0, in_.integer("a grid's size")));
    if (line.contains("range")) {
      for (std::uint64_t& side : n) {
        const std::int64_t first = in_.integer("a range"), last = in_.integer("a range");
        side = last < first ? 0 : static_cast<std::uint64_t>(last - first) + 1;
      }
    }
    for (const std::uint64_t side : n) {
      if (in_.failed()) return;
      if (side < 1 || side > kGhost / points)
        return in_.fail("its grid of " + std::to_string(n[0]) + " x " + std::to_string(n[1]) +
                        " x " + std::to_string(n[2]) + " points has none, or 2^32 and more");
      points *= side;
    }
    if (line.contains("uniform") || line.contains("rectilinear"))
      straightGrid(n, points, line.contains("uniform"));
    else
      coordinates(points);
    std::vector<bool> isBlank;
    if (line.contains("iblanked")) isBlank = flags(points, true);
    const std::uint64_t cells = sides(n, 0) * sides(n, 1) * sides(n, 2);
    std::vector<bool> isGhost;
    if (line.contains("with_ghost")) {
      in_.keyword();  // "ghost_flags"
      isGhost = flags(cells, false);
    }
    if (in_.failed()) return;
    part_->elements["block"] = {0, cells};
    block().elements = cells;
    if (*std::ranges::min_element(n) < 2)
      report_.ignoredCells += cells;
    else
      hexahedra(n, isBlank, isGhost);
  }

  static std::uint64_t sides(const std::array<std::uint64_t, 3>& n, std::size_t axis) {
    return std::max<std::uint64_t>(1, n[axis] - 1);
  }

  std::vector<bool> flags(std::uint64_t count, bool meansZero) {
    std::vector<bool> out;
    if (!in_.fits(count, "flags of a grid")) return out;
    out.resize(count);
    for (std::uint64_t i = 0; i < count && !in_.failed(); ++i)
      out[i] = (in_.integer("a flag") == 0) == meansZero;
    return out;
  }

  /// A grid whose few numbers unfold into many points.
  void straightGrid(const std::array<std::uint64_t, 3>& n, std::uint64_t points, bool isUniform) {
    if (points > bounds_.room / kEnSightGridPointBytes)
      return in_.fail("its grid of " + std::to_string(points) +
                      " points does not fit in this machine's memory");
    bounds_.room -= points * kEnSightGridPointBytes;
    if (!in_.fits(isUniform ? 6 : n[0] + n[1] + n[2], "coordinates of a grid")) return;
    std::array<std::vector<double>, 3> along;
    Position origin{};
    if (isUniform)
      for (double& x : origin) x = widened(in_.real("a grid's origin"));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = isUniform ? widened(in_.real("a grid's step")) : 0;
      for (std::uint64_t i = 0; i < n[axis]; ++i)
        along[axis].push_back(isUniform ? origin[axis] + static_cast<double>(i) * step
                                        : widened(in_.real("a coordinate")));
    }
    if (in_.failed()) return;
    CellMesh& to = block().mesh;
    if (isUniform) to.pointType = "float64";
    to.points.reserve(points);
    for (const double z : along[2])
      for (const double y : along[1])
        for (const double x : along[0]) to.points.push_back({x, y, z});
  }

  void hexahedra(const std::array<std::uint64_t, 3>& n, const std::vector<bool>& isBlank,
                 const std::vector<bool>& isGhost) {
    EnSightBlock& to = block();
    std::uint64_t row = 0;
    for (std::uint64_t k = 0; k + 1 < n[2]; ++k) {
      for (std::uint64_t j = 0; j + 1 < n[1]; ++j) {
        for (std::uint64_t i = 0; i + 1 < n[0]; ++i, ++row) {
          const auto at = static_cast<VertexId>(i + n[0] * (j + n[1] * k));
          const auto up = static_cast<VertexId>(n[0]), far = static_cast<VertexId>(n[0] * n[1]);
          const std::array<VertexId, 8> ids{
              at,       at + 1,       at + 1 + up,       at + up,
              at + far, at + 1 + far, at + 1 + up + far, at + up + far};
          if (!isGhost.empty() && isGhost[row]) continue;
          if (!isBlank.empty() && std::ranges::any_of(ids, [&](VertexId v) { return isBlank[v]; }))
            continue;
          to.mesh.addCell(kHexahedronCell, ids);
          to.rows.push_back(row);
        }
      }
    }
  }

  static constexpr std::size_t kShown = 40;  ///< characters of the file that an error quotes

  EnSightNumbers in_;
  const bool isGold_;
  EnSightBounds& bounds_;
  ReadReport& report_;
  EnSightGeometry out_;
  EnSightPart* part_ = nullptr;
  bool hasNodeIds_ = false, hasElementIds_ = false;
  bool areNodeIdsMeant_ = false;                        ///< by the cells of EnSight 6
  std::vector<std::pair<std::int64_t, VertexId>> ids_;  ///< sorted; empty: 1, 2, 3 ...
};

}  // namespace

Result<EnSightGeometry> readEnSightGeometry(std::string_view bytes,
                                            const std::filesystem::path& file,
                                            const EnSightEncoding& encoding, EnSightBounds& bounds,
                                            ReadReport& report) {
  return GeometryReader(bytes, file, encoding, bounds, report).read();
}

Status movePoints(EnSightGeometry& geometry, const EnSightGeometry& moved,
                  const std::filesystem::path& file) {
  const auto fits = [&](std::size_t i) {
    return geometry.blocks[i].mesh.points.size() == moved.blocks[i].mesh.points.size();
  };
  bool isSame = geometry.blocks.size() == moved.blocks.size();
  for (std::size_t i = 0; isSame && i < geometry.blocks.size(); ++i) isSame = fits(i);
  if (!isSame)
    return badFile(
        file,
        "it has other points than the step whose cells it has by \"change_coords_only\"; "
        "export the case without it");
  for (std::size_t i = 0; i < geometry.blocks.size(); ++i)
    geometry.blocks[i].mesh.points = moved.blocks[i].mesh.points;
  return {};
}

}  // namespace qtet

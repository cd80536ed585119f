#include "simplify/split/split_cells.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "proto/limits.h"
#include "simplify/mesh/vector3.h"
#include "simplify/mesh/volume_sign.h"
#include "simplify/split/bezier_nodes.h"
#include "simplify/split/cell_shapes.h"
#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

/// A triangle of a polygon counts as flat where twice its area is below this part of its longest
/// edge squared.
constexpr double kFlatTriangle = 1e-9;

/// How well a set of tetrahedra fills its cell.
enum Fit { kAllPositive, kSomeFlat, kSomeInverted };

/// The three ways of cutting the octahedron between a quadratic tetrahedron's edge nodes: an axis
/// of two, and the ring of the others.
constexpr std::array<std::array<std::uint8_t, 6>, 3> kOctahedronCuts{
    {{0, 5, 1, 2, 3, 4}, {1, 3, 2, 0, 4, 5}, {2, 4, 0, 1, 5, 3}}};
constexpr std::array<Tetrahedron, 4> kCornerTetrahedra{
    {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};

/// The places of the three faces of a hexahedron (kHexahedronFaces) that do not have corner i.
constexpr std::array<std::array<std::uint8_t, 3>, 8> kFarFaces{
    {{1, 3, 5}, {0, 3, 5}, {0, 2, 5}, {1, 2, 5}, {1, 3, 4}, {0, 3, 4}, {0, 2, 4}, {1, 2, 4}}};
/// The extents between which the cheap bound on a volume's sign neither underflows nor overflows.
constexpr double kSmallestExtent = 1e-60, kLargestExtent = 1e60;
/// A determinant of entries up to L is rounded by less than this times L^3: volume_sign.cpp's bound
/// on its six products.
constexpr double kCubeErrorBound = 6 * 7.7715611723761027e-16;

/// How many tetrahedra a cell mostly becomes, to have the room at once.
std::size_t expectedTetrahedra(const std::vector<std::uint8_t>& types) {
  std::size_t sum = 0;
  for (const std::uint8_t type : types)
    sum += type == kTetrahedronCell ? 1 : type == kPyramidCell ? 2 : type == kWedgeCell ? 3 : 6;
  return sum;
}

/// Whether the field belongs to the shape of cells of higher degree, and means nothing for
/// tetrahedra.
bool isShapeField(const MeshField& field) {
  return field.name == (isCellField(field) ? kDegreesField : kWeightsField);
}

class Splitter {
 public:
  Splitter(CellMesh& mesh, CurvedCells curved, SplitReport& report)
      : mesh_(mesh), curved_(curved), report_(report) {
    out_.points = std::move(mesh.points);
    const auto degrees = std::ranges::find_if(mesh.fields, [](const MeshField& field) {
      return isCellField(field) && field.name == kDegreesField && field.components == 3;
    });
    degrees_ = degrees == mesh.fields.end() ? nullptr : &*degrees;
    const std::size_t expected =
        std::min<std::size_t>(expectedTetrahedra(mesh.types), kMaxElements);
    out_.tetrahedra.reserve(expected);
    ends_.reserve(mesh.cells());
  }

  Status run() {
    for (std::size_t i = 0; i < mesh_.cells(); ++i) {
      const std::size_t before = out_.tetrahedra.size();
      if (Status added = add(mesh_.types[i], mesh_.cell(i), i); !added) return added;
      ++report_.cells[mesh_.types[i]];
      if (out_.tetrahedra.size() == before) ++report_.collapsed;
      if (out_.tetrahedra.size() > kMaxElements || out_.points.size() > kMaxElements) {
        return fail(ErrorCode::kLimitExceeded,
                    "split into tetrahedra, the mesh has more than " +
                        std::to_string(kMaxElements) + " cells or points" +
                        (curved_ == CurvedCells::kSplit ? "; `curved` linear makes fewer" : ""));
      }
      ends_.push_back(static_cast<CellId>(out_.tetrahedra.size()));
    }
    return {};
  }

  TetMesh finish() {
    assert(ends_.size() == mesh_.cells());
    out_.pointType = mesh_.pointType;
    for (MeshField& field : mesh_.fields) {
      if (isShapeField(field)) continue;
      if (isCellField(field))
        inherit(field);
      else
        extend(field);
      out_.fields.push_back(std::move(field));
    }
    return std::move(out_);
  }

  /// Where each cell's tetrahedra end.
  [[nodiscard]] const std::vector<CellId>& ends() const { return ends_; }

 private:
  struct Face {
    VertexId apex;
    std::size_t first, count;  ///< of triangles_
  };

  Status add(std::uint8_t type, std::span<const VertexId> ids, std::size_t cell) {
    if (type == kTetrahedronCell) {
      assert(ids.size() == 4);
      out_.tetrahedra.push_back({ids[0], ids[1], ids[2], ids[3]});
      return {};
    }
    if (type == kHexahedronCell && addUsualHexahedron(ids)) return {};
    const CurvedNodes nodes = curvedNodesOf(type);
    const CellShape shape = shapeOf(type);
    const bool isHigher = isHigherCell(type);
    if (isHigher && curved_ == CurvedCells::kSplit) return addHigher(type, ids, cell);
    if ((nodes.curved || isHigher) && curved_ == CurvedCells::kLinear)
      return addLinear(shape, ids.first(shape.corners)), Status{};
    if (type == kQuadraticTetrahedronCell) return addQuadraticTetrahedron(ids), Status{};
    if (nodes.curved) return addCurved(shape, nodes, ids), Status{};
    if (type == kPolyhedronCell) return addPolyhedron(ids), Status{};
    return addLinear(shape, ids), Status{};
  }

  /// Does what addLinear does for a hexahedron of eight vertices whose first cone fits without
  /// doubt, in a fifth of the time (tests/bench/read_bench.cpp).
  bool addUsualHexahedron(std::span<const VertexId> ids) {
    assert(ids.size() == 8);
    const auto corner = static_cast<std::size_t>(std::ranges::min_element(ids) - ids.begin());
    const VertexId apex = ids[corner];
    std::array<Vector3, 8> at;  // seen from the apex
    double extent = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (ids[j] == ids[k]) return false;
      }
      at[k] = out_.points[ids[k]] - out_.points[apex];
      for (const double x : at[k]) extent = std::max(extent, std::abs(x));
    }
    if (!(extent > kSmallestExtent && extent < kLargestExtent)) return false;
    const double bound = kCubeErrorBound * extent * extent * extent;
    const std::span<const ShapeFace> faces = shapeOf(kHexahedronCell).faces;
    std::array<Tetrahedron, 6> cone;
    std::size_t positive = 0, negative = 0, count = 0;
    for (const std::uint8_t face : kFarFaces[corner]) {
      const auto& c = faces[face].corner;
      std::size_t first = 0;
      for (std::size_t k = 1; k < 4; ++k) first = ids[c[k]] < ids[c[first]] ? k : first;
      for (std::size_t k = 1; k < 3; ++k) {
        const std::uint8_t p = c[first], q = c[(first + k) % 4], r = c[(first + k + 1) % 4];
        const double volume6 = dot(cross(at[p], at[q]), at[r]);  // of (p, r, q, apex)
        positive += volume6 > bound ? 1 : 0;
        negative += volume6 < -bound ? 1 : 0;
        cone[count++] = {ids[p], ids[r], ids[q], apex};
      }
    }
    assert(count == cone.size());
    if (positive != 6 && negative != 6) return false;
    if (negative == 6) {
      ++report_.insideOut;
      for (Tetrahedron& t : cone) std::swap(t[2], t[3]);
    }
    out_.tetrahedra.insert(out_.tetrahedra.end(), cone.begin(), cone.end());
    return true;
  }

  void addLinear(const CellShape& shape, std::span<const VertexId> ids) {
    assert(ids.size() >= shape.corners);
    if (shape.corners == 4) {
      out_.tetrahedra.push_back({ids[0], ids[1], ids[2], ids[3]});
      return;
    }
    clearFaces();
    for (const ShapeFace& face : shape.faces) {
      std::array<VertexId, 6> loop{};
      for (std::size_t k = 0; k < face.corners; ++k) loop[k] = ids[face.corner[k]];
      addFace(std::span(loop).first(face.corners));
    }
    corners_.assign(ids.begin(), ids.end());
    addCone();
  }

  void addPolyhedron(std::span<const VertexId> stream) {
    clearFaces();
    corners_.clear();
    for (std::size_t at = 1; at < stream.size(); at += stream[at] + 1) {
      const std::span<const VertexId> loop = stream.subspan(at + 1, stream[at]);
      addFace(loop);
      corners_.insert(corners_.end(), loop.begin(), loop.end());
    }
    orientTriangles();
    addCone();
  }

  /// Files store a polyhedron's faces in either sense: carries one triangle's on over the edges of
  /// each shell. The shell of the largest volume is the outside, every other one the wall of a hole
  /// in it.
  void orientTriangles() {
    struct Side {
      std::array<VertexId, 2> edge;
      std::size_t triangle;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
        sides.push_back({{std::min(a, b), std::max(a, b)}, t});
      }
    }
    std::ranges::sort(sides, {},
                      [](const Side& side) { return std::pair(side.edge, side.triangle); });
    std::vector<char> seen(triangles_.size(), 0);
    std::vector<std::vector<std::size_t>> shells;
    for (std::size_t first = 0; first < triangles_.size(); ++first) {
      if (seen[first]) continue;
      std::vector<std::size_t>& shell = shells.emplace_back(1, first);
      seen[first] = 1;
      for (std::size_t at = 0; at < shell.size(); ++at) {
        const Triangle t = triangles_[shell[at]];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::array edge{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
          for (const Side& side : std::ranges::equal_range(sides, edge, {}, &Side::edge)) {
            if (seen[side.triangle]) continue;
            if (senseAcross(t, triangles_[side.triangle]) < 0)
              std::swap(triangles_[side.triangle][1], triangles_[side.triangle][2]);
            seen[side.triangle] = 1;
            shell.push_back(side.triangle);
          }
        }
      }
    }
    if (shells.size() > 1) turnShells(shells);
  }

  void turnShells(const std::vector<std::vector<std::size_t>>& shells) {
    std::vector<double> volumes;
    for (const std::vector<std::size_t>& shell : shells) {
      const VertexId apex = triangles_[shell[0]][0];
      double volume = 0;
      for (const std::size_t t : shell)
        volume += roundedVolume6(out_.points[apex], out_.points[triangles_[t][0]],
                                 out_.points[triangles_[t][1]], out_.points[triangles_[t][2]]);
      volumes.push_back(volume);
    }
    const auto outside =
        std::ranges::max_element(volumes, {}, [](double x) { return std::abs(x); }) -
        volumes.begin();
    for (std::size_t s = 0; s < shells.size(); ++s) {
      const bool isOutside = static_cast<std::ptrdiff_t>(s) == outside;
      if (isOutside ? volumes[s] >= 0 : volumes[s] <= 0) continue;
      for (const std::size_t t : shells[s]) std::swap(triangles_[t][1], triangles_[t][2]);
    }
  }

  /// +1: two triangles share an edge that they run through in opposite directions, as neighbours
  /// should; -1: in one direction; 0: none.
  static int senseAcross(const Triangle& a, const Triangle& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (a[i] == b[j] && a[(i + 1) % 3] == b[(j + 1) % 3]) return -1;
        if (a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j]) return 1;
      }
    }
    return 0;
  }

  /// Four corner tetrahedra and the octahedron between them, which is the cell's own to cut.
  void addQuadraticTetrahedron(std::span<const VertexId> ids) {
    assert(ids.size() == 10);
    cutOctahedron(ids.subspan(4, 6));
    for (const Tetrahedron& t : kCornerTetrahedra)
      best_.push_back({ids[t[0]], ids[t[1]], ids[t[2]], ids[t[3]]});
    takeBest();
  }

  /// The best of the three cuts, into best_.
  void cutOctahedron(std::span<const VertexId> ids) {
    assert(ids.size() == 6);
    best_.clear();
    Fit bestFit = kSomeInverted;
    for (const auto& cut : kOctahedronCuts) {
      tried_.clear();
      for (std::size_t k = 0; k < 4; ++k)
        tried_.push_back({ids[cut[0]], ids[cut[1]], ids[cut[2 + k]], ids[cut[2 + (k + 1) % 4]]});
      keepIfBetter(bestFit);
      if (bestFit == kAllPositive) break;
    }
  }

  /// VTK's quadratic kinds with a node in the middle of each triangle and in the cell. Those nodes
  /// are left out, on both sides of a face.
  bool addSevenNodeFaces(std::uint8_t type, std::span<const VertexId> ids) {
    if (type == kLagrangeTetrahedronCell && ids.size() == 15)
      return addQuadraticTetrahedron(ids.first(10)), true;
    if (type != kLagrangeWedgeCell || ids.size() != 21) return false;
    std::array<VertexId, 18> kept{};
    std::ranges::copy(ids.first(15), kept.begin());
    std::ranges::copy(ids.subspan(17, 3), kept.begin() + 15);
    addCurved(shapeOf(type), curvedNodesOf(kBiquadraticQuadraticWedgeCell), kept);
    return true;
  }

  /// Linear cells between all nodes (higher_cells.h). Faces are cut at their own nodes, so that
  /// neighbours of the same degree there agree.
  Status addHigher(std::uint8_t type, std::span<const VertexId> ids, std::size_t cell) {
    if (addSevenNodeFaces(type, ids)) return {};
    const auto stated = degrees_ ? std::span<const double>(degrees_->values).subspan(3 * cell, 3)
                                 : std::span<const double>();
    const auto degrees = degreesOf(type, ids.size(), stated);
    if (!degrees) {
      return fail(ErrorCode::kBadInput,
                  "cell " + std::to_string(mesh_.cellId(cell)) + " is a " + cellTypeName(type) +
                      " of " + std::to_string(ids.size()) + " nodes, which no degree up to " +
                      std::to_string(kMaxDegree) + " has; `curved` linear takes its corners alone");
    }
    const HigherCell& higher = higherCell(type, *degrees);
    const std::uint64_t insideOut = report_.insideOut;
    simplices_.clear();
    for (const LinearPart& part : higher.parts) {
      std::array<VertexId, 8> own{};
      for (std::size_t k = 0; k < part.size(); ++k) own[k] = ids[part.nodes[k]];
      addPart(part, std::span(own).first(part.size()));
    }
    best_ = simplices_;
    if (!best_.empty()) takeBest();
    // Counts a cell once, however many parts it was split into. VTK's own wedges are turned against
    // its hexahedra.
    if (report_.insideOut > insideOut)
      report_.insideOut = insideOut + (shapeOf(type).corners == 6 ? 0 : 1);
    return {};
  }

  /// Tetrahedra into simplices_, so that the cell is turned as one; other parts are turned by
  /// themselves.
  void addPart(const LinearPart& part, std::span<const VertexId> ids) {
    if (part.kind == LinearPart::kHexahedron) return addLinear(shapeOf(kHexahedronCell), ids);
    if (part.kind == LinearPart::kWedge) return addLinear(shapeOf(kWedgeCell), ids);
    if (part.kind == LinearPart::kPyramid) return addLinear(shapeOf(kPyramidCell), ids);
    if (part.kind == LinearPart::kTetrahedron)
      return simplices_.push_back({ids[0], ids[1], ids[2], ids[3]});
    cutOctahedron(ids);
    simplices_.insert(simplices_.end(), best_.begin(), best_.end());
  }

  /// Faces cut at their nodes, joined to the centre: the cell's own, or a new one at the mean of
  /// the edges' nodes.
  void addCurved(const CellShape& shape, const CurvedNodes& nodes, std::span<const VertexId> ids) {
    clearFaces();
    for (std::size_t f = 0; f < shape.faces.size(); ++f) addCurvedFace(shape, nodes, ids, f);
    best_.clear();
    assert(ids.size() >= shape.corners + nodes.edges.size());
    const std::span<const VertexId> onEdges = ids.subspan(shape.corners, nodes.edges.size());
    coneFrom(nodes.centre != kNoNode ? ids[nodes.centre] : newCentre(onEdges));
    Fit fit = kSomeInverted;
    keepIfBetter(fit);
    takeBest();
  }

  void addCurvedFace(const CellShape& shape, const CurvedNodes& nodes,
                     std::span<const VertexId> ids, std::size_t f) {
    const ShapeFace& face = shape.faces[f];
    assert(face.corners == 3 || face.corners == 4);
    const std::size_t n = face.corners;
    std::array<VertexId, 4> corner{}, mid{};
    for (std::size_t k = 0; k < n; ++k) {
      corner[k] = ids[face.corner[k]];
      mid[k] = midOf(shape, nodes, ids, face.corner[k], face.corner[(k + 1) % n]);
    }
    const auto quad = [&](VertexId a, VertexId b, VertexId c, VertexId d) {
      addFace(std::array{a, b, c, d});
    };
    const auto triangle = [&](VertexId a, VertexId b, VertexId c) { addFace(std::array{a, b, c}); };
    if (n == 4 && nodes.faceCentre[f] != kNoNode) {
      for (std::size_t k = 0; k < 4; ++k)
        quad(corner[k], mid[k], ids[nodes.faceCentre[f]], mid[(k + 3) % 4]);
    } else if (n == 4 && mid[0] == kGhost) {
      quad(corner[0], corner[1], mid[1], mid[3]);
      quad(mid[3], mid[1], corner[2], corner[3]);
    } else if (n == 4 && mid[1] == kGhost) {
      quad(corner[1], corner[2], mid[2], mid[0]);
      quad(mid[0], mid[2], corner[3], corner[0]);
    } else {
      for (std::size_t k = 0; k < n; ++k) triangle(corner[k], mid[k], mid[(k + n - 1) % n]);
      n == 4 ? quad(mid[0], mid[1], mid[2], mid[3]) : triangle(mid[0], mid[1], mid[2]);
    }
  }

  static VertexId midOf(const CellShape& shape, const CurvedNodes& nodes,
                        std::span<const VertexId> ids, std::uint8_t a, std::uint8_t b) {
    for (std::size_t e = 0; e < nodes.edges.size(); ++e) {
      const auto& edge = nodes.edges[e];
      if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a))
        return ids[shape.corners + e];
    }
    return kGhost;
  }

  void clearFaces() {
    faces_.clear();
    triangles_.clear();
  }

  /// Cuts a face into triangles. Vertices that follow themselves (collapsed edges) count once; a
  /// quadrilateral that names two opposite corners alike is folded flat and has no triangle.
  void addFace(std::span<const VertexId> loop) {
    loop_.clear();
    for (const VertexId v : loop) {
      if (loop_.empty() || loop_.back() != v) loop_.push_back(v);
    }
    while (loop_.size() > 1 && loop_.front() == loop_.back()) loop_.pop_back();
    const std::size_t n = loop_.size();
    if (n < 3 || (n == 4 && (loop_[0] == loop_[2] || loop_[1] == loop_[3]))) return;
    const std::size_t apex = apexOfLoop();
    faces_.push_back({loop_[apex], triangles_.size(), n - 2});
    for (std::size_t k = 1; k + 1 < n; ++k)
      triangles_.push_back({loop_[apex], loop_[(apex + k) % n], loop_[(apex + k + 1) % n]});
  }

  std::size_t apexOfLoop() {
    const std::size_t n = loop_.size();
    const auto smallest = static_cast<std::size_t>(std::ranges::min_element(loop_) - loop_.begin());
    if (n <= 4) return smallest;
    std::size_t best = n;
    for (std::size_t apex = 0; apex < n; ++apex) {
      if ((best == n || loop_[apex] < loop_[best]) && !fanHasAFlatTriangle(apex)) best = apex;
    }
    return best == n ? smallest : best;
  }

  bool fanHasAFlatTriangle(std::size_t apex) const {
    const std::size_t n = loop_.size();
    for (std::size_t k = 1; k + 1 < n; ++k) {
      if (isFlat({loop_[apex], loop_[(apex + k) % n], loop_[(apex + k + 1) % n]})) return true;
    }
    return false;
  }

  /// The same for the triangle in whichever order: both cells of a face must come to one answer.
  bool isFlat(Triangle t) const {
    std::ranges::sort(t);
    const Position &a = out_.points[t[0]], &b = out_.points[t[1]], &c = out_.points[t[2]];
    const Position u = b - a, v = c - a, w = c - b, normal = cross(u, v);
    const double longest = std::max({dot(u, u), dot(v, v), dot(w, w)});
    return dot(normal, normal) <= kFlatTriangle * kFlatTriangle * longest * longest;
  }

  /// Adds the cone from the smallest vertex that is the apex of all of its faces and leaves no bad
  /// tetrahedron. Else it adds that from a new centre, if it is better.
  void addCone() {
    std::ranges::sort(corners_);
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    best_.clear();
    Fit fit = kSomeInverted;
    for (const VertexId apex : corners_) {
      if (!fitsItsFaces(apex)) continue;
      coneFrom(apex);
      keepIfBetter(fit);
      if (fit == kAllPositive) return takeBest();
    }
    if (triangles_.empty()) return;
    coneFrom(newCentre(corners_));
    if (!best_.empty() && fitOf() != kAllPositive) {
      forgetCentre();
      return takeBest();
    }
    best_.swap(tried_);
    takeBest();
  }

  [[nodiscard]] bool contains(const Face& face, VertexId v) const {
    if (face.apex == v) return true;
    for (std::size_t k = face.first; k < face.first + face.count; ++k) {
      if (triangles_[k][1] == v || triangles_[k][2] == v) return true;
    }
    return false;
  }

  [[nodiscard]] bool fitsItsFaces(VertexId v) const {
    return std::ranges::all_of(
        faces_, [&](const Face& face) { return face.apex == v || !contains(face, v); });
  }

  void coneFrom(VertexId apex) {
    tried_.clear();
    for (const Face& face : faces_) {
      if (contains(face, apex)) continue;
      for (std::size_t k = face.first; k < face.first + face.count; ++k) {
        const Triangle& t = triangles_[k];
        tried_.push_back({t[0], t[2], t[1], apex});
      }
    }
  }

  [[nodiscard]] int signOf(const Tetrahedron& t) const {
    return volumeSign(out_.points[t[0]], out_.points[t[1]], out_.points[t[2]], out_.points[t[3]]);
  }

  /// How well `tried_` fits; a cell that is inside out as a whole fits as well as one that is not.
  [[nodiscard]] Fit fitOf() const {
    std::size_t positive = 0, negative = 0;
    for (const Tetrahedron& t : tried_) {
      const int sign = signOf(t);
      positive += sign > 0 ? 1 : 0;
      negative += sign < 0 ? 1 : 0;
    }
    if (positive > 0 && negative > 0) return kSomeInverted;
    return positive + negative < tried_.size() ? kSomeFlat : kAllPositive;
  }

  void keepIfBetter(Fit& fit) {
    if (tried_.empty()) return;
    const Fit own = fitOf();
    if (!best_.empty() && own >= fit) return;
    fit = own;
    best_.swap(tried_);
  }

  /// Appends the best split, turned so that its volume is not negative.
  void takeBest() {
    double volume = 0;
    for (const Tetrahedron& t : best_)
      volume += roundedVolume6(out_.points[t[0]], out_.points[t[1]], out_.points[t[2]],
                               out_.points[t[3]]);
    if (volume < 0) {
      ++report_.insideOut;
      for (Tetrahedron& t : best_) std::swap(t[2], t[3]);
    }
    out_.tetrahedra.insert(out_.tetrahedra.end(), best_.begin(), best_.end());
  }

  VertexId newCentre(std::span<const VertexId> around) {
    assert(!around.empty());
    Position mean{};
    for (const VertexId v : around) {
      for (std::size_t k = 0; k < 3; ++k)
        mean[k] += out_.points[v][k] / static_cast<double>(around.size());
    }
    out_.points.push_back(mean);
    centreVertices_.insert(centreVertices_.end(), around.begin(), around.end());
    centreEnds_.push_back(centreVertices_.size());
    ++report_.centrePoints;
    return static_cast<VertexId>(out_.points.size() - 1);
  }

  void forgetCentre() {
    assert(!centreEnds_.empty() && report_.centrePoints > 0);
    out_.points.pop_back();
    centreEnds_.pop_back();
    centreVertices_.resize(centreEnds_.empty() ? 0 : centreEnds_.back());
    --report_.centrePoints;
  }

  void inherit(MeshField& field) const {
    assert(field.values.size() == ends_.size() * field.components);
    const std::size_t n = field.components;
    std::vector<double> values;
    values.reserve((ends_.empty() ? 0 : ends_.back()) * n);
    std::size_t next = 0;
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) {
      const auto own = field.values.begin() + static_cast<std::ptrdiff_t>(cell * n);
      for (; next < ends_[cell]; ++next)
        values.insert(values.end(), own, own + static_cast<std::ptrdiff_t>(n));
    }
    field.values = std::move(values);
  }

  void extend(MeshField& field) const {
    const std::size_t n = field.components;
    std::size_t begin = 0;
    for (const std::size_t end : centreEnds_) {
      const auto around = std::span(centreVertices_).subspan(begin, end - begin);
      for (std::size_t c = 0; c < n; ++c) {
        double value = field.values[around[0] * n + c];
        if (isFloatType(field.type)) {
          double sum = 0;
          for (const VertexId v : around) sum += field.values[v * n + c];
          value = sum / static_cast<double>(around.size());
          if (field.type == "float32") value = static_cast<double>(static_cast<float>(value));
        }
        field.values.push_back(value);
      }
      begin = end;
    }
    assert(field.values.size() == out_.points.size() * n);
  }

  CellMesh& mesh_;
  CurvedCells curved_;
  SplitReport& report_;
  TetMesh out_;
  std::vector<CellId> ends_;
  std::vector<VertexId> loop_, corners_, centreVertices_;
  std::vector<std::size_t> centreEnds_;
  std::vector<Face> faces_;
  std::vector<Triangle> triangles_;
  std::vector<Tetrahedron> tried_, best_, simplices_;
  const MeshField* degrees_;
};

/// Nothing to split: the vertices are the tetrahedra.
TetMesh asTheyAre(CellMesh&& mesh) {
  TetMesh out{std::move(mesh.points), {}, std::move(mesh.fields), std::move(mesh.pointType)};
  assert(mesh.vertices.size() == 4 * mesh.cells());
  out.tetrahedra.resize(mesh.cells());
  for (std::size_t i = 0; i < out.tetrahedra.size(); ++i)
    std::copy_n(mesh.vertices.data() + 4 * i, 4, out.tetrahedra[i].data());
  return out;
}

void addOriginalCellIds(const CellMesh& mesh, const std::vector<CellId>& ends, TetMesh& out) {
  for (const MeshField& field : out.fields) {
    if (isCellField(field) && field.name == kOriginalCellField) return;
  }
  std::uint64_t largest = 0;
  MeshField ids{kOriginalCellField, 1, "int32", {}, "cell"};
  ids.values.reserve(out.tetrahedra.size());
  for (std::size_t cell = 0; cell < ends.size(); ++cell) {
    assert(ids.values.size() <= ends[cell]);
    largest = std::max(largest, mesh.cellId(cell));
    ids.values.resize(ends[cell], static_cast<double>(mesh.cellId(cell)));
  }
  if (largest > 0x7FFFFFFFu) ids.type = "int64";
  out.fields.push_back(std::move(ids));
}

}  // namespace

bool SplitReport::onlyTetrahedra() const {
  for (std::size_t type = 0; type < cells.size(); ++type) {
    if (type != kTetrahedronCell && cells[type] > 0) return false;
  }
  return true;
}

Result<TetMesh> splitCells(CellMesh&& mesh, const SplitOptions& options, SplitReport& report) {
  if (std::ranges::all_of(mesh.types, [](std::uint8_t type) { return type == kTetrahedronCell; })) {
    if (mesh.cells() > kMaxElements)
      return fail(ErrorCode::kLimitExceeded, std::to_string(mesh.cells()) +
                                                 " tetrahedra; at most " +
                                                 std::to_string(kMaxElements) + " are allowed");
    report.cells[kTetrahedronCell] = mesh.cells();
    return asTheyAre(std::move(mesh));
  }
  if (options.curved == CurvedCells::kSplit) {
    if (Status done = placeBezierNodes(mesh); !done) return std::unexpected(done.error());
  }
  Splitter splitter(mesh, options.curved, report);
  if (Status done = splitter.run(); !done) return std::unexpected(done.error());
  TetMesh out = splitter.finish();
  if (options.originalIds) addOriginalCellIds(mesh, splitter.ends(), out);
  return out;
}

}  // namespace qtet

#include "simplify/split/cell_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "proto/limits.h"
#include "simplify/split/cell_shapes.h"
#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

/// VTK's numbers of two kinds that it does not have itself.
constexpr std::uint8_t kVtkLagrangePyramid = 74, kVtkBezierPyramid = 81;

bool isRead(std::uint8_t type) { return type == kPolyhedronCell || shapeOf(type).corners > 0; }

/// Whether a polyhedron's faces are there: at least four of at least three vertices, and nothing
/// after them.
bool hasItsFaces(std::span<const VertexId> stream, std::size_t points) {
  if (stream.empty() || stream[0] < 4) return false;
  std::size_t at = 1;
  for (VertexId face = 0; face < stream[0]; ++face) {
    if (at >= stream.size()) return false;
    const std::size_t count = stream[at++];
    if (count < 3 || count > stream.size() - at) return false;
    for (const VertexId v : stream.subspan(at, count)) {
      if (v >= points) return false;
    }
    at += count;
  }
  return at == stream.size();
}

bool hasItsVertices(std::uint8_t type, std::span<const VertexId> ids, std::size_t points) {
  if (type == kPolyhedronCell) return hasItsFaces(ids, points);
  assert(isRead(type));
  const std::uint32_t wanted = verticesOf(type);
  if (wanted > 0 ? ids.size() != wanted : ids.size() < shapeOf(type).corners) return false;
  return std::ranges::all_of(ids, [points](VertexId v) { return v < points; });
}

Status checkPoints(const CellMesh& mesh, const std::filesystem::path& path) {
  if (mesh.points.empty())
    return bad(path, "it holds no points; export the volume mesh, not an empty selection");
  if (mesh.points.size() > kMaxElements) {
    return fail(ErrorCode::kLimitExceeded,
                path.string() + ": " + std::to_string(mesh.points.size()) + " points; at most " +
                    std::to_string(kMaxElements) + " are allowed");
  }
  std::uint64_t notFinite = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Position& p = mesh.points[i];
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    if (notFinite++ == 0) first = i;
  }
  if (notFinite == 0) return {};
  return bad(path, std::to_string(notFinite) +
                       " points have a coordinate that is NaN or infinite, the first is point " +
                       std::to_string(first) +
                       "; remove these points and their cells before exporting");
}

}  // namespace

void CellMesh::renamePoints(std::span<const VertexId> names) {
  for (std::size_t i = 0; i < cells(); ++i)
    forEachId(types[i], std::span(vertices).subspan(begins[i], begins[i + 1] - begins[i]),
              [names](VertexId& v) {
                if (v == kGhost) return;
                assert(v < names.size());
                v = names[v];
              });
}

std::string cellTypeName(std::uint8_t type) {
  switch (type) {
    case kTetrahedronCell: return "tetrahedron";
    case kVoxelCell: return "voxel";
    case kHexahedronCell: return "hexahedron";
    case kWedgeCell: return "wedge";
    case kPyramidCell: return "pyramid";
    case kPentagonalPrismCell: return "pentagonal prism";
    case kHexagonalPrismCell: return "hexagonal prism";
    case kQuadraticTetrahedronCell: return "quadratic tetrahedron";
    case kQuadraticHexahedronCell: return "quadratic hexahedron";
    case kQuadraticWedgeCell: return "quadratic wedge";
    case kQuadraticPyramidCell: return "quadratic pyramid";
    case kTriquadraticHexahedronCell: return "triquadratic hexahedron";
    case kQuadraticLinearWedgeCell: return "quadratic-linear wedge";
    case kBiquadraticQuadraticWedgeCell: return "biquadratic wedge";
    case kBiquadraticQuadraticHexahedronCell: return "biquadratic hexahedron";
    case kTriquadraticPyramidCell: return "triquadratic pyramid";
    case kPolyhedronCell: return "polyhedron";
    case kLagrangeTetrahedronCell: return "Lagrange tetrahedron";
    case kLagrangeHexahedronCell: return "Lagrange hexahedron";
    case kLagrangeWedgeCell: return "Lagrange wedge";
    case kBezierTetrahedronCell: return "Bezier tetrahedron";
    case kBezierHexahedronCell: return "Bezier hexahedron";
    case kBezierWedgeCell: return "Bezier wedge";
    case kBiquadraticPyramidCell: return "biquadratic pyramid";
    case kLagrangePyramidCell: return "Lagrange pyramid";
    default: return "cell of VTK type " + std::to_string(type);
  }
}

std::uint32_t verticesOf(std::uint8_t type) {
  if (isHigherCell(type)) return 0;
  const CurvedNodes nodes = curvedNodesOf(type);
  std::uint32_t count = shapeOf(type).corners + static_cast<std::uint32_t>(nodes.edges.size());
  for (const std::uint8_t node : nodes.faceCentre) count += node != kNoNode ? 1 : 0;
  return count + (nodes.centre != kNoNode ? 1 : 0);
}

Status checkCellMesh(const CellMesh& mesh, const std::filesystem::path& path) {
  if (Status checked = checkPoints(mesh, path); !checked) return checked;
  if (mesh.cells() == 0)
    return bad(path, "it holds no volume cells; export the volume mesh, not its surface");
  // the vertices of each kind that is read and has a fixed number of them, or 0
  std::array<std::uint32_t, 256> fixed{};
  for (std::size_t type = 0; type < fixed.size(); ++type)
    if (const auto t = static_cast<std::uint8_t>(type); isRead(t) && t != kPolyhedronCell)
      fixed[type] = verticesOf(t);
  const bool areAllThere =
      std::ranges::none_of(mesh.types, [](std::uint8_t type) { return type == kPolyhedronCell; }) &&
      !mesh.vertices.empty() && std::ranges::max(mesh.vertices) < mesh.points.size();
  for (std::size_t i = 0; i < mesh.cells(); ++i) {
    const std::uint8_t type = mesh.types[i];
    if (areAllThere && fixed[type] > 0 && mesh.cell(i).size() == fixed[type]) continue;
    if (type == kVtkLagrangePyramid || type == kVtkBezierPyramid) {
      return bad(path, "cell " + std::to_string(mesh.cellId(i)) + " is of VTK type " +
                           std::to_string(type) +
                           ", a pyramid of higher degree, for whose nodes VTK defines no order; "
                           "save such cells with Gmsh (.msh), or as quadratic pyramids");
    }
    if (!isRead(type)) {
      return bad(path, "cell " + std::to_string(mesh.cellId(i)) + " is of VTK type " +
                           std::to_string(type) +
                           ", which is not read; turn it into tetrahedra first (in ParaView: "
                           "filter Tetrahedralize)");
    }
    if (type == kPolyhedronCell && mesh.cell(i).size() > kMaxPolyhedronNumbers) {
      return fail(ErrorCode::kLimitExceeded,
                  path.string() + ": cell " + std::to_string(mesh.cellId(i)) +
                      " is a polyhedron whose faces take " + std::to_string(mesh.cell(i).size()) +
                      " numbers; at most " + std::to_string(kMaxPolyhedronNumbers) +
                      " are split: divide the cell before exporting");
    }
    if (hasItsVertices(type, mesh.cell(i), mesh.points.size())) continue;
    const std::uint32_t wanted = verticesOf(type);
    return bad(
        path,
        "cell " + std::to_string(mesh.cellId(i)) + " is a " + cellTypeName(type) + " without " +
            (wanted > 0 ? std::to_string(wanted) + " vertices" : std::string("its vertices")) +
            " among the " + std::to_string(mesh.points.size()) +
            " points; the file is damaged, export it again");
  }
  for (const MeshField& field : mesh.fields) {
    const std::size_t tuples = isCellField(field) ? mesh.cells() : mesh.points.size();
    if (field.values.size() == tuples * field.components) continue;
    return bad(path, field.association + " field " + field.name + " has " +
                         std::to_string(field.values.size() / field.components) + " tuples for " +
                         std::to_string(tuples) + " " + field.association + "s; export it again");
  }
  return {};
}

}  // namespace qtet

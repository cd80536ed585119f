#include "simplify/clean/float_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

/// Steps of the lattice that every mesh gets at least, along its longest axis.
constexpr double kUsualSteps = 65535;

struct Extents {
  double largest = 0;  ///< magnitude of a coordinate
  double longest = 0;  ///< side of the box
};

Extents extentsOf(const std::vector<Position>& points) {
  Position low = points.front(), high = low;
  for (const Position& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  Extents out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.largest = std::max({out.largest, std::abs(low[k]), std::abs(high[k])});
    out.longest = std::max(out.longest, high[k] - low[k]);
  }
  return out;
}

/// The distance from a magnitude to the next one that float32 has.
double spacingAt(double magnitude) {
  const auto x = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(x, std::numeric_limits<float>::infinity())) -
         static_cast<double>(x);
}

/// The share of the cells' edges that are shorter than `length`. An edge counts once for each cell
/// that has it.
double shareBelow(const TetMesh& mesh, double length) {
  std::uint64_t count = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Vector3 edge = mesh.points[t[i]] - mesh.points[t[j]];
        count += dot(edge, edge) < length * length ? 1 : 0;
      }
  return static_cast<double>(count) / (6 * static_cast<double>(mesh.tetrahedra.size()));
}

}  // namespace

std::optional<std::string> lostToFloats(const TetMesh& mesh) {
  if (mesh.pointType != "float32" || mesh.points.empty() || mesh.tetrahedra.empty())
    return std::nullopt;
  const Extents extents = extentsOf(mesh.points);
  const double spacing = spacingAt(extents.largest);
  const double lost = shareBelow(mesh, kSpacingsOfAnEdge * spacing);
  if (lost <= kLostEdges && spacing <= extents.longest / kUsualSteps) return std::nullopt;
  std::ostringstream out;
  out.precision(3);
  out << "the file's coordinates are float32, which near " << extents.largest
      << " are a multiple of " << spacing << "; " << 100 * lost
      << " % of the edges are shorter than " << kSpacingsOfAnEdge
      << " times that, so the file has lost shape already: store them as float64, or near the "
         "origin";
  return out.str();
}

}  // namespace qtet

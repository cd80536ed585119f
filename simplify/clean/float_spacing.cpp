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

/// The distance from a magnitude to the next one that float32 has.
double spacingAt(double magnitude) {
  const auto x = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(x, std::numeric_limits<float>::infinity())) -
         static_cast<double>(x);
}

}  // namespace

FloatSpacing::FloatSpacing(const Position& low, const Position& high) {
  for (std::size_t k = 0; k < 3; ++k) {
    largest_ = std::max({largest_, std::abs(low[k]), std::abs(high[k])});
    longest_ = std::max(longest_, high[k] - low[k]);
  }
  spacing_ = spacingAt(largest_);
}

void FloatSpacing::add(const TetMesh& piece) {
  isFloat32_ = piece.pointType == "float32";
  if (!isFloat32_) return;
  const double length = kSpacingsOfAnEdge * spacing_;
  for (const Tetrahedron& t : piece.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Vector3 edge = piece.points[t[i]] - piece.points[t[j]];
        short_ += dot(edge, edge) < length * length ? 1 : 0;
      }
  edges_ += 6 * piece.tetrahedra.size();
}

std::optional<std::string> FloatSpacing::lost() const {
  if (!isFloat32_ || edges_ == 0) return std::nullopt;
  const double share = static_cast<double>(short_) / static_cast<double>(edges_);
  if (share <= kLostEdges && spacing_ <= longest_ / kUsualSteps) return std::nullopt;
  std::ostringstream out;
  out.precision(3);
  out << "the file's coordinates are float32, which near " << largest_ << " are a multiple of "
      << spacing_ << "; " << 100 * share << " % of the edges are shorter than " << kSpacingsOfAnEdge
      << " times that, so the file has lost shape already: store them as float64, or near the "
         "origin";
  return out.str();
}

std::optional<std::string> lostToFloats(const TetMesh& mesh) {
  if (mesh.points.empty()) return std::nullopt;
  Position low = mesh.points.front(), high = low;
  for (const Position& p : mesh.points)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  FloatSpacing spacing(low, high);
  spacing.add(mesh);
  return spacing.lost();
}

}  // namespace qtet

#include "simplify/pipeline/loss_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

/// How many times the cells a base mesh should have that is too coarse. On real meshes a loss of 25
/// % then becomes one of 1 to 7 %.
constexpr double kMoreCells = 5;

std::string percent(double fraction) {
  std::ostringstream out;
  out.precision(3);
  out << 100 * fraction << " %";
  return out.str();
}

/// A number of two digits that is not below it, to be given as an option.
std::string roundedUp(double ratio) {
  if (!(ratio < 1)) return "1";
  double unit = 0.1;
  while (ratio < unit) unit /= 10;
  std::ostringstream out;
  out.precision(2);
  out << std::ceil(ratio / unit * 10) * unit / 10;
  return out.str();
}

/// "the base mesh has lost 4.1 % of the volume, and its boundary is up to 12 % of the diagonal off"
std::string whatIsLost(const LevelError& error, bool volumeIsOff, bool boundaryIsOff) {
  std::string out = "the base mesh ";
  if (volumeIsOff)
    out += (error.volumeKept < 1 ? "has lost " : "has gained ") +
           percent(std::abs(1 - error.volumeKept)) + " of the volume";
  if (volumeIsOff && boundaryIsOff) out += ", and its boundary ";
  if (boundaryIsOff)
    out += std::string(volumeIsOff ? "is" : "has a boundary that is") + " up to " +
           percent(error.boundaryDistance()) + " of the diagonal off";
  return out;
}

struct Counts {
  std::uint64_t full, base, points, parts;
};

/// The most probable reason, and what to do.
std::string reasonOf(const Counts& counts, const LossFacts& facts) {
  const std::uint64_t coincident = facts.clean.coincidentPoints.count;
  if (static_cast<double>(coincident) >= kSeamPoints * static_cast<double>(counts.points))
    return std::to_string(coincident) +
           " points lie at the place of another one and are not joined with it, so the seams "
           "between pieces count as boundary: join them with `weld` 0";
  const std::string ratio =
      "`targetRatio` " +
      roundedUp(kMoreCells * static_cast<double>(counts.base) / static_cast<double>(counts.full));
  if (counts.parts >= kManyParts && counts.base < kEnoughCellsAPart * counts.parts)
    return "the mesh falls into " + std::to_string(counts.parts) + " parts, of which each keeps " +
           std::to_string(counts.base / counts.parts) + " cells on average: give `targetRatio` " +
           roundedUp(static_cast<double>(kEnoughCellsAPart * counts.parts) /
                     static_cast<double>(counts.full)) +
           ", or join parts that nearly touch with `weld` DISTANCE";
  if (facts.wallThickness < kThinWall)
    return "its walls are thin, " + percent(facts.wallThickness) +
           " of the diagonal on average: put the shape first with `boundaryWeight` 15000, or "
           "give " +
           ratio;
  return "too few cells are left for this shape, " + std::to_string(counts.base) + ": give " +
         ratio + ", or `maxBoundaryError` " + roundedUp(kBoundaryErrorWarned);
}

}  // namespace

double wallThicknessOf(const LatticeMesh& mesh) {
  if (mesh.points.empty()) return 0;
  const auto at = [&](VertexId v) { return toVector(mesh.points[v]); };
  Vector3 low = at(0), high = low;
  double volume6 = 0, area2 = 0;
  for (const Triangle& t : mesh.boundary) {
    const Vector3 a = at(t[0]), b = at(t[1]), c = at(t[2]), normal = cross(b - a, c - a);
    area2 += std::sqrt(dot(normal, normal));
    volume6 += dot(normal, a);
    for (const Vector3& corner : {a, b, c})
      for (std::size_t k = 0; k < 3; ++k)
        low[k] = std::min(low[k], corner[k]), high[k] = std::max(high[k], corner[k]);
  }
  const double diagonal = std::sqrt(dot(high - low, high - low));
  return area2 > 0 && diagonal > 0 ? 2 * std::abs(volume6) / 6 / (area2 / 2) / diagonal : 0;
}

std::vector<std::string> lossWarnings(const Manifest& manifest, const LossFacts& facts) {
  const ManifestLevel &base = manifest.levels.front(), &full = manifest.levels.back();
  if (!base.error) return {};
  const bool volumeIsOff = std::abs(1 - base.error->volumeKept) > kVolumeLossWarned,
             boundaryIsOff = base.error->boundaryDistance() >
                             std::max(kBoundaryErrorWarned, facts.allowedBoundaryError);
  if (!volumeIsOff && !boundaryIsOff) return {};
  const Counts counts{full.tetrahedra, base.tetrahedra, full.vertices, facts.clean.components};
  return {whatIsLost(*base.error, volumeIsOff, boundaryIsOff) +
          "; the most probable reason: " + reasonOf(counts, facts)};
}

}  // namespace qtet

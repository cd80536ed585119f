#include "simplify/pipeline/loss_warnings.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "proto/field_name.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/measure/measure_error.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

std::string percent(double fraction) {
  std::ostringstream out;
  out.precision(3);
  out << 100 * fraction << " %";
  return out.str();
}

/// "the base mesh has lost 4.1 % of the volume, and its boundary is up to 12 % of the diagonal off"
std::string whatIsLost(const LevelError& error, bool volume, bool boundary) {
  const bool lost = error.volumeLost > kVolumeLossWarned,
             gained = error.volumeGained > kVolumeLossWarned;
  std::string out = "the base mesh ";
  if (lost) out += "has lost " + percent(error.volumeLost);
  if (gained) out += (lost ? " and gained " : "has gained ") + percent(error.volumeGained);
  if (volume) out += " of the volume";
  if (volume && boundary) out += ", and its boundary ";
  if (boundary)
    out += std::string(volume ? "is" : "has a boundary that is") + " up to " +
           percent(error.boundaryDistance()) + " of the diagonal off";
  return out;
}

bool volumeIsOff(const LevelError& error) {
  return std::max(error.volumeLost, error.volumeGained) > kVolumeLossWarned;
}
bool boundaryIsOff(const LevelError& error, const LossFacts& facts) {
  return error.boundaryDistance() > std::max(kBoundaryErrorWarned, facts.allowedBoundaryError);
}
bool isOff(const ManifestLevel& level, const LossFacts& facts) {
  return level.error && (volumeIsOff(*level.error) || boundaryIsOff(*level.error, facts));
}

/// The option that makes the base mesh the coarsest measured level of which it and all finer ones
/// lose little. Fusing ends at that level then, so its errors are the ones in the manifest.
std::string enoughCells(const Manifest& manifest, const LossFacts& facts) {
  std::size_t level = manifest.levels.size() - 1;
  for (std::size_t coarser = level; coarser-- > 0 && !isOff(manifest.levels[coarser], facts);)
    if (manifest.levels[coarser].error) level = coarser;
  const std::string out = "`baseCells` " + std::to_string(manifest.levels[level].tetrahedra);
  if (facts.hasTargetRatio) return out + " in place of `targetRatio`";
  return facts.isByRule ? out + " (unasked it takes " + std::to_string(kMaxBaseBytes / 1000) +
                              " kB or " + std::to_string(kMaxBaseCells) + " tetrahedra at most)"
                        : out;
}

/// The most probable reason, and what to do.
std::string reasonOf(const Manifest& manifest, const LossFacts& facts) {
  const std::uint64_t coincident = facts.clean.coincidentPoints.count,
                      points = manifest.levels.back().vertices, parts = facts.clean.components,
                      cells = manifest.levels.front().tetrahedra;
  if (static_cast<double>(coincident) >= kSeamPoints * static_cast<double>(points))
    return std::to_string(coincident) +
           " points lie at the place of another one and are not joined with it, so the seams "
           "between pieces count as boundary: join them with `weld` 0";
  const std::string enough = "give " + enoughCells(manifest, facts);
  if (parts >= kManyParts && cells < kEnoughCellsAPart * parts)
    return "the mesh falls into " + std::to_string(parts) + " parts, of which each keeps " +
           std::to_string(cells / parts) + " cells on average: " + enough +
           ", or join parts that nearly touch with `weld` DISTANCE";
  if (facts.wallThickness < kThinWall)
    return "its walls are thin, " + percent(facts.wallThickness) +
           " of the diagonal on average: " + enough;
  return "too few cells are left for this shape, " + std::to_string(cells) + ": " + enough;
}

/// One a label that the base mesh does not keep, of its worst instant. It names the coarsest
/// measured level that does keep it, as all finer ones do.
std::vector<std::string> labelWarnings(const Manifest& manifest) {
  std::map<std::string_view, std::size_t> worst;
  const std::optional<LevelError>& base = manifest.levels.front().error;
  for (std::size_t f = 0; base && f < manifest.fields.size(); ++f) {
    if (labelNamesOf(manifest, f) == nullptr || base->fields[f].rms <= kLabelErrorWarned) continue;
    std::size_t& of = worst.emplace(manifest.fields[f].name.withoutTime(), f).first->second;
    if (base->fields[f].rms > base->fields[of].rms) of = f;
  }
  std::vector<std::string> out;
  for (const auto& [name, f] : worst) {
    const auto isOff = [&](const ManifestLevel& level) {
      return level.error && level.error->fields[f].rms > kLabelErrorWarned;
    };
    std::size_t level = manifest.levels.size() - 1;
    for (std::size_t coarser = level; coarser-- > 0 && !isOff(manifest.levels[coarser]);)
      if (manifest.levels[coarser].error) level = coarser;
    out.push_back(percent(base->fields[f].rms) +
                  " of the volume of the base mesh have another label " + fieldKey(manifest, f) +
                  " than the original: give `baseCells` " +
                  std::to_string(manifest.levels[level].tetrahedra) + ", or a larger weight of " +
                  std::string(name) + " by `labelWeights`");
  }
  return out;
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
  assert(!manifest.levels.empty());
  const ManifestLevel& base = manifest.levels.front();
  std::vector<std::string> out = labelWarnings(manifest);
  if (!isOff(base, facts)) return out;
  out.insert(out.begin(),
             whatIsLost(*base.error, volumeIsOff(*base.error), boundaryIsOff(*base.error, facts)) +
                 "; the most probable reason: " + reasonOf(manifest, facts));
  return out;
}

}  // namespace qtet

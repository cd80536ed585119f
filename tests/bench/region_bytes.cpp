// The cost of a place: the bytes of a log of layout `regions`. They bring a box with 10, 1 and 0.1
// % of the cells to full resolution. The whole file is compared with the same mesh's `stream`.
// Boxes are cubes round cells taken at even steps through the finest mesh, as large as it takes.
// Slabs lie round planes through the same cells across each axis in turn. Isosurfaces have values
// of vertices at even steps through their order. The bytes are those that the server plans for such
// a view up to the last level.
//
//   region_bytes REGIONS.qtet [STREAM.qtet]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/log_file.h"
#include "server/store/packet_intervals.h"
#include "server/stream/client_blocks.h"
#include "server/stream/planner.h"

namespace {

using namespace qtet;

constexpr std::size_t kBoxes = 32;
constexpr double kSlab = 0.02;  // of the mesh's extent across it

/// Four times the barycentre.
LatticePoint middleOf(const LatticeMesh& mesh, const Tetrahedron& t) {
  LatticePoint sum{};
  for (const VertexId v : t)
    for (std::size_t a = 0; a < 3; ++a) sum[a] += mesh.points[v][a];
  return sum;
}

/// The smallest cube round `centre` that holds the barycentres of so many cells.
View boxRound(const Manifest& manifest, const std::vector<LatticePoint>& middles,
              const LatticePoint& centre, std::size_t cells) {
  std::vector<std::int32_t> reach;
  for (const LatticePoint& m : middles) {
    std::int32_t most = 0;
    for (std::size_t a = 0; a < 3; ++a) most = std::max(most, std::abs(m[a] - centre[a]));
    reach.push_back(most);
  }
  const auto at = reach.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(cells, 1) - 1);
  std::nth_element(reach.begin(), at, reach.end());
  std::array<double, 6> box{};
  for (std::size_t a = 0; a < 3; ++a) {
    box[a] = manifest.latticeOrigin[a] + manifest.latticeStep * (centre[a] - *at) / 4;
    box[a + 3] = manifest.latticeOrigin[a] + manifest.latticeStep * (centre[a] + *at) / 4;
  }
  return {.box = box};
}

/// The region within half of `thickness` from the plane through `centre` across an axis.
View slabRound(const Manifest& manifest, const LatticePoint& centre, std::size_t axis,
               double thickness) {
  const double at = manifest.latticeOrigin[axis] + manifest.latticeStep * centre[axis] / 4;
  Plane above{0, 0, 0, thickness / 2 - at}, below{0, 0, 0, thickness / 2 + at};
  above[axis] = 1, below[axis] = -1;
  return {.frustum = {above, below}};
}

/// The mesh's extent along an axis, in its own units.
double extentOf(const Manifest& manifest, const LatticeMesh& mesh, std::size_t axis) {
  std::int32_t least = mesh.points.front()[axis], most = least;
  for (const LatticePoint& p : mesh.points)
    least = std::min(least, p[axis]), most = std::max(most, p[axis]);
  return manifest.latticeStep * (most - least);
}

std::uint64_t bytesOf(const LogFront& log, const View& view,
                      const std::vector<std::uint32_t>& fields) {
  const auto& [index, manifest, intervals] = log;
  std::uint64_t bytes = index.headBytes();
  const StopAt stop = chunksFor(LevelTarget{manifest.levels.back().level}, manifest, index).value();
  for (const BlockRun& run : planStream(log, ClientBlocks(index, fields), view, stop, 1u << 18))
    bytes += sliceOf(index, run).size;
  return bytes;
}

/// The sorted values of the first field's vertices; with several components their lengths.
std::vector<double> sortedValues(const LatticeMesh& mesh) {
  const FieldInfo& field = mesh.fields[0];
  std::vector<double> out;
  for (std::size_t i = 0; i < mesh.values[0].size(); i += field.components) {
    double square = 0;
    for (std::uint32_t c = 0; c < field.components; ++c)
      square += std::pow(field.value(c, mesh.values[0][i + c]), 2);
    out.push_back(field.components > 1 ? std::sqrt(square) : field.value(0, mesh.values[0][i]));
  }
  std::ranges::sort(out);
  return out;
}

struct Share {
  double sum = 0, most = 0;

  void add(double part) { sum += part, most = std::max(most, part); }
  void print(const char* what) const {
    std::printf("%s: %5.1f %% of the bytes, at most %5.1f %%\n", what, sum / kBoxes, most);
  }
};

std::uint64_t sizeOf(const LogIndex& index, std::uint32_t firstNode, std::uint32_t endNode) {
  std::uint64_t bytes = 0;
  for (const ChunkEntry& e : index.chunks)
    if (e.node >= firstNode && e.node < endNode) bytes += e.size();
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3)
    return std::fprintf(stderr, "usage: region_bytes REGIONS.qtet [STREAM.qtet]\n"), 2;
  const auto log = LogFile::open(argv[1]);
  if (!log) return std::fprintf(stderr, "%s\n", log.error().text().c_str()), 1;
  const LogIndex& index = log->index();
  const auto mesh = meshAtLevel(*log, index.chunks.back().lastLevel,
                                std::vector<std::uint32_t>(index.fields.empty() ? 0 : 1));
  if (!mesh) return std::fprintf(stderr, "%s\n", mesh.error().text().c_str()), 1;
  const auto manifest = manifestOf(index);
  if (!manifest) return std::fprintf(stderr, "%s\n", manifest.error().text().c_str()), 1;
  const auto intervals = packetIntervals(*log, *manifest);
  if (!intervals) return std::fprintf(stderr, "%s\n", intervals.error().text().c_str()), 1;
  std::vector<LatticePoint> middles;
  for (const Tetrahedron& t : mesh->tetrahedra) middles.push_back(middleOf(*mesh, t));

  const auto whole = static_cast<double>(index.fileBytes);
  std::printf("%zu cells, %llu bytes, %zu chunks; front %.1f %%, head %.1f %%", middles.size(),
              static_cast<unsigned long long>(index.fileBytes), index.chunks.size(),
              100 * static_cast<double>(index.headBytes()) / whole,
              100 * static_cast<double>(sizeOf(index, 0, 1)) / whole);
  for (std::uint32_t depth = index.firstDepth(); depth > 0 && depth <= index.lastDepth(); ++depth)
    std::printf(", depth %u %.1f %%", depth,
                100 * static_cast<double>(sizeOf(index, 1u << depth, 2u << depth)) / whole);
  std::printf("\n");
  std::vector<std::uint32_t> all(index.fields.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<std::uint32_t> one(all.begin(),
                                       all.begin() + std::min<std::ptrdiff_t>(1, std::ssize(all)));
  const std::vector<double> values = one.empty() ? std::vector<double>() : sortedValues(*mesh);
  for (const auto& [fields, name] :
       {std::pair(all, "all fields"), std::pair(one, "the first field")}) {
    std::printf("%s:\n", name);
    const auto part = [&](const View& view) {
      return 100 * static_cast<double>(bytesOf({index, *manifest, &*intervals}, view, fields)) /
             whole;
    };
    for (const double percent : {10.0, 1.0, 0.1}) {
      Share share;
      const auto cells =
          static_cast<std::size_t>(percent / 100 * static_cast<double>(middles.size()));
      for (std::size_t i = 0; i < kBoxes; ++i)
        share.add(part(boxRound(*manifest, middles,
                                middles[(2 * i + 1) * middles.size() / (2 * kBoxes)], cells)));
      share.print(("  box of " + std::to_string(percent) + " % of the cells").c_str());
    }
    Share share;
    for (std::size_t i = 0; i < kBoxes; ++i)
      share.add(part(slabRound(*manifest, middles[(2 * i + 1) * middles.size() / (2 * kBoxes)],
                               i % 3, kSlab * extentOf(*manifest, *mesh, i % 3))));
    share.print("  slab of 2 % of the extent");
    if (one.empty()) continue;
    Share surfaces;
    for (std::size_t i = 0; i < kBoxes; ++i)
      surfaces.add(
          part({.isovalue = Isovalue{manifest->fields[0].name,
                                     {},
                                     {values[(2 * i + 1) * values.size() / (2 * kBoxes)]}}}));
    surfaces.print("  isosurface of the first field");
  }
  if (argc == 3) {
    const auto stream = LogFile::open(argv[2]);
    if (!stream) return std::fprintf(stderr, "%s\n", stream.error().text().c_str()), 1;
    std::printf("the whole file: %.3f of stream's %llu bytes\n",
                whole / static_cast<double>(stream->index().fileBytes),
                static_cast<unsigned long long>(stream->index().fileBytes));
  }
}

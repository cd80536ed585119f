// What a place costs: the bytes of a log of layout `regions` that bring a box with 10, 1 and 0.1 % of the cells to full resolution, and the whole file
// beside the same mesh's `stream`. Boxes are cubes round cells taken at even steps through the finest mesh, as large as it takes; the chunks are
// those that LogIndex::chunksOfBox names.
//
//   region_bytes REGIONS.qtet [STREAM.qtet]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "codec/log_file.h"

namespace {

using namespace qtet;

constexpr std::size_t kBoxes = 32;

/// Four times the barycentre.
LatticePoint middleOf(const LatticeMesh& mesh, const Tetrahedron& t) {
  LatticePoint sum{};
  for (const VertexId v : t)
    for (std::size_t a = 0; a < 3; ++a) sum[a] += mesh.points[v][a];
  return sum;
}

/// The smallest cube round `centre` that holds the barycentres of so many cells, as a box of 256ths.
PacketBox boxRound(const std::vector<LatticePoint>& middles, const LatticePoint& centre, std::size_t cells, int bits) {
  std::vector<std::int32_t> reach;
  for (const LatticePoint& m : middles) {
    std::int32_t most = 0;
    for (std::size_t a = 0; a < 3; ++a) most = std::max(most, std::abs(m[a] - centre[a]));
    reach.push_back(most);
  }
  const auto at = reach.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(cells, 1) - 1);
  std::nth_element(reach.begin(), at, reach.end());
  PacketBox box;
  const std::int64_t end = std::int64_t{4} << bits;
  for (std::size_t a = 0; a < 3; ++a) {
    box.least[a] = static_cast<std::uint8_t>(256 * std::clamp<std::int64_t>(std::int64_t{centre[a]} - *at, 0, end - 1) / end);
    box.most[a] = static_cast<std::uint8_t>(256 * std::clamp<std::int64_t>(std::int64_t{centre[a]} + *at, 0, end - 1) / end);
  }
  return box;
}

std::uint64_t bytesOf(const LogIndex& index, const PacketBox& box) {
  std::uint64_t bytes = index.headBytes();
  for (const std::uint32_t chunk : index.chunksOfBox(box)) bytes += index.chunks[chunk].size();
  return bytes;
}

std::uint64_t sizeOf(const LogIndex& index, std::uint32_t firstNode, std::uint32_t endNode) {
  std::uint64_t bytes = 0;
  for (const ChunkEntry& e : index.chunks)
    if (e.node >= firstNode && e.node < endNode) bytes += e.size();
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: region_bytes REGIONS.qtet [STREAM.qtet]\n"), 2;
  const auto log = LogFile::open(argv[1]);
  if (!log) return std::fprintf(stderr, "%s\n", log.error().text().c_str()), 1;
  const LogIndex& index = log->index();
  const auto mesh = meshAtLevel(*log, index.chunks.back().lastLevel, std::vector<std::uint32_t>{});
  if (!mesh) return std::fprintf(stderr, "%s\n", mesh.error().text().c_str()), 1;
  std::vector<LatticePoint> middles;
  for (const Tetrahedron& t : mesh->tetrahedra) middles.push_back(middleOf(*mesh, t));

  const auto whole = static_cast<double>(index.fileBytes);
  std::printf("%zu cells, %llu bytes, %zu chunks; front %.1f %%, head %.1f %%", middles.size(),
              static_cast<unsigned long long>(index.fileBytes), index.chunks.size(), 100 * static_cast<double>(index.headBytes()) / whole,
              100 * static_cast<double>(sizeOf(index, 0, 1)) / whole);
  for (std::uint32_t depth = index.firstDepth(); depth > 0 && depth <= index.lastDepth(); ++depth)
    std::printf(", depth %u %.1f %%", depth, 100 * static_cast<double>(sizeOf(index, 1u << depth, 2u << depth)) / whole);
  std::printf("\n");
  for (const double percent : {10.0, 1.0, 0.1}) {
    double sum = 0, most = 0;
    for (std::size_t i = 0; i < kBoxes; ++i) {
      const LatticePoint& centre = middles[(2 * i + 1) * middles.size() / (2 * kBoxes)];
      const PacketBox box =
          boxRound(middles, centre, static_cast<std::size_t>(percent / 100 * static_cast<double>(middles.size())), index.positionBits);
      const double part = 100 * static_cast<double>(bytesOf(index, box)) / whole;
      sum += part, most = std::max(most, part);
    }
    std::printf("box of %4.1f %% of the cells: %5.1f %% of the bytes, at most %5.1f %%\n", percent, sum / kBoxes, most);
  }
  if (argc == 3) {
    const auto stream = LogFile::open(argv[2]);
    if (!stream) return std::fprintf(stderr, "%s\n", stream.error().text().c_str()), 1;
    std::printf("the whole file: %.3f of stream's %llu bytes\n", whole / static_cast<double>(stream->index().fileBytes),
                static_cast<unsigned long long>(stream->index().fileBytes));
  }
}

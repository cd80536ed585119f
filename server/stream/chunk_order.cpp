#include "server/stream/chunk_order.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "proto/manifest.h"
#include "server/stream/view_request.h"

namespace qtet {
namespace {

double square(double x) { return x * x; }

/// The error of each level: that of the boundary and of the fields sent with it, as squares of
/// fractions. Between two levels of which it is known it changes evenly. If nothing was measured,
/// the square of the interpolation error on n cells, O(n^(-2/3)) in space.
std::vector<double> squaredErrors(const Manifest& manifest,
                                  const std::vector<std::uint32_t>& fields) {
  std::vector<double> out;
  std::size_t known = 0;  // the last level before
  for (const ManifestLevel& level : manifest.levels) {
    if (!level.error) {
      out.push_back(std::pow(std::max(level.tetrahedra, 1u), -4.0 / 3));
      continue;
    }
    double sum = square(level.error->boundaryMean());
    for (const std::uint32_t f : fields) sum += square(level.error->fields[f].rms);
    const std::size_t between = out.size() - known;
    for (std::size_t i = 1; i < between; ++i)
      out[known + i] =
          std::lerp(out[known], sum, static_cast<double>(i) / static_cast<double>(between));
    known = out.size();
    out.push_back(sum);
  }
  return out;
}

struct Candidate {
  Tier tier = Tier::kRest;
  bool lacksMesh = true;  ///< else only blocks of fields
  double gain = 0;        ///< error per byte, weighted
  std::uint32_t chunk = 0;

  /// Whether it comes behind the other.
  bool operator<(const Candidate& other) const {
    if (tier != other.tier) return tier > other.tier;
    if (lacksMesh != other.lacksMesh) return lacksMesh;
    return gain != other.gain ? gain < other.gain : chunk > other.chunk;
  }
};

class PacketOrder {
 public:
  PacketOrder(const LogFront& log, const ClientBlocks& blocks, const View& view, const StopAt& stop)
      : index_(log.index),
        blocks_(blocks),
        request_(view, log),
        stop_(stop),
        error_(squaredErrors(log.manifest, blocks.fields())) {
    for (const ChunkEntry& packet : index_.chunks)
      if (packet.node != 0) {
        records_.resize(packet.lastLevel + std::size_t{1});
        records_[packet.lastLevel] += packet.records;
      }
  }

  void append(std::vector<std::uint32_t>& out) {
    for (std::uint32_t node = firstNode_; node < 2 * firstNode_; ++node) offer(node);
    while (!waiting_.empty()) {
      const Candidate next = waiting_.top();
      waiting_.pop();
      if (!blocks_.hasAll(next.chunk)) out.push_back(next.chunk);
      const std::uint32_t node = index_.chunks[next.chunk].node;
      if (node >= lastBand_) continue;
      offer(2 * node);
      offer(2 * node + 1);
    }
  }

 private:
  void offer(std::uint32_t node) {
    const std::uint32_t chunk = head_ + node - firstNode_;
    if (chunk > stop_.lastChunk) return;
    const ChunkEntry& packet = index_.chunks[chunk];
    const Tier tier = request_.tierOf(chunk);
    if (stop_.ofWantedOnly && tier != Tier::kWanted) return;
    waiting_.push({tier, !blocks_.hasMesh(chunk), gainOf(packet, chunk), chunk});
  }

  /// The share of the band's gain that its share of the band's records has, over the bytes that it
  /// still costs.
  [[nodiscard]] double gainOf(const ChunkEntry& packet, std::uint32_t chunk) const {
    const double band =
        std::max(0.0, error_[packet.firstLevel - std::size_t{1}] - error_[packet.lastLevel]);
    const double share =
        static_cast<double>(packet.records) /
        static_cast<double>(std::max<std::uint64_t>(records_[packet.lastLevel], 1));
    return request_.weightOf(packet.box) * band * share /
           static_cast<double>(blocks_.missingBytes(chunk) + 1);
  }

  const LogIndex& index_;
  const ClientBlocks& blocks_;
  const std::uint32_t head_ = index_.headChunks(), firstNode_ = 1u << index_.firstDepth(),
                      lastBand_ = 1u << index_.lastDepth();
  ViewRequest request_;
  StopAt stop_;
  std::vector<double> error_;
  std::vector<std::uint64_t> records_;  ///< of the band that ends with a level
  std::priority_queue<Candidate> waiting_;
};

}  // namespace

std::vector<std::uint32_t> chunkOrder(const LogFront& log, const ClientBlocks& blocks,
                                      const View& view, const StopAt& stop) {
  std::vector<std::uint32_t> out;
  const std::uint32_t head = log.index.headChunks();
  for (std::uint32_t chunk = 0; chunk < head && chunk <= stop.lastChunk; ++chunk)
    if (!blocks.hasAll(chunk)) out.push_back(chunk);
  if (head < log.index.chunks.size()) PacketOrder(log, blocks, view, stop).append(out);
  return out;
}

}  // namespace qtet

#include "server/planner.h"

#include <algorithm>
#include <cassert>

#include "proto/messages.h"

namespace qtet {
namespace {

/// Collects blocks, in order, into runs.
class Runs {
 public:
  Runs(const LogIndex& index, std::uint32_t payloadBytes) : index_(index), payloadBytes_(payloadBytes) {}

  void add(std::uint32_t chunk, std::uint32_t part) {
    const std::uint32_t size = index_.block(chunk, part).size;
    const bool neighbour = !out_.empty() && out_.back().chunk == chunk && out_.back().firstPart + out_.back().parts == part;
    if (neighbour && bytes_ + size <= payloadBytes_) {
      ++out_.back().parts;
      bytes_ += size;
      return;
    }
    out_.push_back({chunk, static_cast<std::uint16_t>(part), 1});
    bytes_ = size;
  }
  void addHead() { out_.push_back({0, FrameHeader::kHead, 0}); }

  [[nodiscard]] std::vector<BlockRun> take() { return std::move(out_); }

 private:
  const LogIndex& index_;
  std::uint32_t payloadBytes_;
  std::uint64_t bytes_ = 0;  // in the last run
  std::vector<BlockRun> out_;
};

}  // namespace

std::vector<BlockRun> planStream(const LogIndex& index, const StreamRequest& request, std::uint32_t payloadBytes) {
  assert(request.fields.size() == request.haveFields.size());
  assert(std::ranges::adjacent_find(request.fields, std::greater_equal<>()) == request.fields.end() &&
         request.haveChunks <= index.chunks.size());
  Runs runs(index, payloadBytes);
  if (request.haveChunks == 0) runs.addHead();

  const auto chunks = static_cast<std::uint32_t>(index.chunks.size());
  std::uint32_t first = request.haveChunks;
  for (const std::uint32_t have : request.haveFields) first = std::min(first, have);
  for (std::uint32_t chunk = first; chunk < chunks; ++chunk) {
    if (chunk >= request.haveChunks) {
      runs.add(chunk, kStructurePart);
      runs.add(chunk, kPositionsPart);
    }
    for (std::size_t f = 0; f < request.fields.size(); ++f)
      if (chunk >= request.haveFields[f]) runs.add(chunk, kFirstFieldPart + request.fields[f]);
  }
  return runs.take();
}

FileSlice sliceOf(const LogIndex& index, const BlockRun& run) {
  if (run.firstPart == FrameHeader::kHead) return {0, static_cast<std::uint32_t>(index.headBytes())};
  const BlockEntry& first = index.block(run.chunk, run.firstPart);
  const BlockEntry& last = index.block(run.chunk, std::uint32_t{run.firstPart} + run.parts - 1);
  return {first.offset, static_cast<std::uint32_t>(last.offset + last.size - first.offset)};
}

}  // namespace qtet

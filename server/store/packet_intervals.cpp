#include "server/store/packet_intervals.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

#include "codec/log/log_index.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/manifest.h"
#include "proto/stream_request.h"

namespace qtet {
namespace {

std::size_t columnsOfField(const ManifestField& field) {
  if (field.association != "point") return 0;
  return field.components + (field.components > 1 ? 1 : 0);
}

/// The corners of all cells that a chunk changes, and those that it brings.
class ChangedVertices : public SplitObserver {
 public:
  void beforeSplit(VertexId v, const GrowingMesh& mesh, const Link& link,
                   const Split& split) override {
    vertices_.push_back(v);
    for (const VertexId u : link.vertices())
      if (u != kGhost) vertices_.push_back(u);
    for (int i = 0; i + 1 < split.k; ++i)
      vertices_.push_back(mesh.next().vertices + static_cast<VertexId>(i));
  }
  /// Ascending, each once.
  [[nodiscard]] std::vector<VertexId> take() {
    std::ranges::sort(vertices_);
    const auto twice = std::ranges::unique(vertices_);
    vertices_.erase(twice.begin(), twice.end());
    return std::exchange(vertices_, {});
  }

 private:
  std::vector<VertexId> vertices_;
};

/// Adds the values of these vertices to the columns of one field, in `row`. Values may be missing,
/// of missing values and of vertices that the field has not reached.
void addValues(const ManifestField& field, std::span<const std::int32_t> integers,
               std::span<const VertexId> vertices, std::span<ValueInterval> row) {
  const std::size_t n = field.components;
  for (const VertexId v : vertices) {
    if ((std::size_t{v} + 1) * n > integers.size()) continue;
    double square = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const std::int32_t integer = integers[v * n + c];
      const double value =
          integer == kMissing ? std::nan("") : field.minimum[c] + field.step * integer;
      square += value * value;
      row[c].add({value, value});  // NaN adds nothing
    }
    if (n > 1) row[n].add({std::sqrt(square), std::sqrt(square)});
  }
}

}  // namespace

PacketIntervals::PacketIntervals(const Manifest& manifest, std::vector<ValueInterval> values)
    : columns_(columnsOf(manifest)), values_(std::move(values)) {
  assert(columns_ == 0 ? values_.empty() : values_.size() % columns_ == 0);
}

std::size_t PacketIntervals::columnsOf(const Manifest& manifest) {
  std::size_t out = 0;
  for (const ManifestField& field : manifest.fields) out += columnsOfField(field);
  return out;
}

std::optional<std::size_t> PacketIntervals::columnOf(const Manifest& manifest,
                                                     const Isovalue& isovalue) const {
  const auto wanted = fieldOfKey(manifest, isovalue.field);
  if (!wanted || values_.empty()) return std::nullopt;
  std::size_t first = 0;
  for (std::uint32_t f = 0; f < *wanted; ++f) first += columnsOfField(manifest.fields[f]);
  const std::size_t columns = columnsOfField(manifest.fields[*wanted]);
  // the last is the length
  const std::size_t column = isovalue.component ? *isovalue.component : columns - 1;
  const bool exists =
      columns > 0 && (isovalue.component ? column < manifest.fields[*wanted].components : true);
  return exists ? std::optional(first + column) : std::nullopt;
}

Bytes PacketIntervals::encode() const {
  ByteWriter out;
  for (const ValueInterval& interval : values_)
    for (const double end : {interval.least, interval.most})
      out.write(std::bit_cast<std::uint64_t>(end));
  return out.take();
}

PacketIntervals PacketIntervals::decode(ByteView bytes, const LogIndex& index,
                                        const Manifest& manifest) {
  std::vector<ValueInterval> values(index.chunks.size() * columnsOf(manifest));
  if (bytes.size() != values.size() * 2 * sizeof(double)) return {};
  ByteReader in(bytes);
  for (ValueInterval& interval : values)
    for (double* end : {&interval.least, &interval.most})
      *end = std::bit_cast<double>(in.read<std::uint64_t>());
  return {manifest, std::move(values)};
}

Result<PacketIntervals> packetIntervals(const LogFile& log, const Manifest& manifest,
                                        const std::stop_token& stop) {
  const LogIndex& index = log.index();
  const std::size_t columns = PacketIntervals::columnsOf(manifest);
  std::vector<ValueInterval> values(index.chunks.size() * columns);
  const auto rowOf = [&](std::uint32_t chunk) {
    return std::span(values).subspan(chunk * columns, columns);
  };
  Refiner refiner(index);
  ChangedVertices changed;
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    if (stop.stop_requested())
      return fail(ErrorCode::kIo, "stopped, because nobody waits for it any more");
    const bool isPacket = index.chunks[chunk].node != 0;
    refiner.observe(isPacket ? &changed : nullptr);
    if (Status s = applyChunk(log, refiner, chunk, {}); !s) return std::unexpected(s.error());
    const std::vector<VertexId> vertices = changed.take();
    std::span<ValueInterval> row = rowOf(chunk);
    for (std::uint32_t f = 0; f < manifest.fields.size(); ++f) {
      const std::size_t width = columnsOfField(manifest.fields[f]);
      if (width == 0) continue;
      addValues(manifest.fields[f], refiner.fieldValues(f), vertices, row);
      if (Status s = applyFieldBlock(log, refiner, chunk, f); !s) return std::unexpected(s.error());
      addValues(manifest.fields[f], refiner.fieldValues(f), vertices, row);
      row = row.subspan(width);
    }
  }
  // Children stand behind their parents.
  for (auto chunk = static_cast<std::uint32_t>(index.chunks.size());
       chunk-- > index.headChunks();) {
    const std::uint32_t parent = index.dependencies[index.chunks[chunk].firstDependency];
    if (index.chunks[parent].node == 0) continue;
    for (std::size_t c = 0; c < columns; ++c) rowOf(parent)[c].add(rowOf(chunk)[c]);
  }
  return PacketIntervals(manifest, std::move(values));
}

namespace {
std::atomic<std::uintmax_t> knownBytes = 0;
}  // namespace

void KnownIntervals::put(PacketIntervals table) {
  const std::size_t bytes = table.bytes();
  auto owned = std::make_unique<const PacketIntervals>(std::move(table));
  knownBytes += bytes;
  std::shared_ptr<const PacketIntervals> known(owned.release(), [bytes](const auto* gone) {
    knownBytes -= bytes;
    std::default_delete<const PacketIntervals>()(gone);
  });
  const std::scoped_lock lock(mutex_);
  known_.swap(known);
}

std::uintmax_t KnownIntervals::bytesOfAll() { return knownBytes; }

}  // namespace qtet

// The stages between a mesh on the lattice and a refined mesh, on the sample `fin`; results in
// TABLE.md. Rates count input tetrahedra.
#include <benchmark/benchmark.h>

#include <cstring>
#include <numeric>

#include "codec/coding/draco_block.h"
#include "codec/log/log_index.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/checksum.h"
#include "proto/crc32c.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/samples/samples.h"
#include "tests/bench/need.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using bench::need;

const LatticeMesh& fin() {
  static const LatticeMesh mesh = need(quantise(finSample())).mesh;
  return mesh;
}

const FusionHistory& history() {
  static const FusionHistory h = need(simplify(fin(), {}));
  return h;
}

EncodedLog encodedBy(CodecId codec) {
  LogWriterOptions options;
  options.valueCodec = codec;
  return need(encodeLog(history(), options));
}

const EncodedLog& encoded() {
  static const EncodedLog log = encodedBy(CodecId::kDraco);
  return log;
}
const EncodedLog& encodedAdaptively() {
  static const EncodedLog log = encodedBy(CodecId::kAdaptive);
  return log;
}

void count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(fin().tetrahedra.size()));
}

void simplifyFin(benchmark::State& state) {
  const LatticeMesh& mesh = fin();
  for (auto _ : state) benchmark::DoNotOptimize(simplify(mesh, {}));
  count(state);
}
BENCHMARK(simplifyFin)->Unit(benchmark::kMillisecond);

void encodeFin(benchmark::State& state) {
  const FusionHistory& h = history();
  for (auto _ : state) benchmark::DoNotOptimize(encodeLog(h, {}));
  count(state);
}
BENCHMARK(encodeFin)->Unit(benchmark::kMillisecond);

/// The values of one part, chunk by chunk.
std::vector<std::vector<std::int32_t>> valuesOf(const LogIndex& index, ByteView bytes,
                                                std::uint32_t part) {
  std::vector<std::vector<std::int32_t>> out;
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const BlockEntry& block = index.block(chunk, part);
    out.push_back(
        need(decodeValueBlock(bytes.subspan(block.offset, block.size), index.components(part),
                              index.tuples(chunk, part), index.blockCodec(chunk, part))));
  }
  return out;
}

// All value blocks of the log, positions and fields; rates count the integers' bytes.
void valueBlocks(benchmark::State& state, const EncodedLog& log) {
  const LogIndex index = need(LogIndex::parse(log.bytes));
  std::size_t integers = 0, bytes = 0;
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk)
    for (std::uint32_t part = kPositionsPart; part < index.parts(); ++part)
      integers += std::size_t{index.tuples(chunk, part)} * index.components(part),
          bytes += index.block(chunk, part).size;
  for (auto _ : state)
    for (std::uint32_t part = kPositionsPart; part < index.parts(); ++part)
      benchmark::DoNotOptimize(valuesOf(index, log.bytes, part));
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(integers * sizeof(std::int32_t)));
  state.counters["bytes"] = static_cast<double>(bytes);
}
void dracoBlocksOfFin(benchmark::State& state) { valueBlocks(state, encoded()); }
BENCHMARK(dracoBlocksOfFin)->Unit(benchmark::kMillisecond);
void adaptiveBlocksOfFin(benchmark::State& state) { valueBlocks(state, encodedAdaptively()); }
BENCHMARK(adaptiveBlocksOfFin)->Unit(benchmark::kMillisecond);

// Draco alone on the same points, as one cloud without cells, in the order of the log's slots.
void dracoPointsOfFin(benchmark::State& state) {
  std::vector<std::int32_t> points;
  for (const LatticePoint& p : fin().points) points.insert(points.end(), p.begin(), p.end());
  const Bytes block = need(encodeDracoBlock(points, 3));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        decodeDracoBlock(block, 3, static_cast<std::uint32_t>(fin().points.size())));
  count(state);
}
BENCHMARK(dracoPointsOfFin)->Unit(benchmark::kMillisecond);

void memcpyOfFin(benchmark::State& state) {
  const LatticeMesh& mesh = fin();
  std::vector<Tetrahedron> tetrahedra(mesh.tetrahedra.size());
  std::vector<LatticePoint> points(mesh.points.size());
  for (auto _ : state) {
    std::memcpy(tetrahedra.data(), mesh.tetrahedra.data(), tetrahedra.size() * sizeof(Tetrahedron));
    std::memcpy(points.data(), mesh.points.data(), points.size() * sizeof(LatticePoint));
    benchmark::ClobberMemory();
  }
  count(state);
}
BENCHMARK(memcpyOfFin)->Unit(benchmark::kMillisecond);

// Records alone: the positions' values are there.
void refineFin(benchmark::State& state) {
  const LogIndex index = need(LogIndex::parse(encoded().bytes));
  const auto positions = valuesOf(index, encoded().bytes, kPositionsPart);
  for (auto _ : state) {
    Refiner refiner(index);
    for (std::uint32_t c = 0; c < index.chunks.size(); ++c) {
      const BlockEntry& b = index.block(c, kStructurePart);
      if (!refiner.apply(c, ByteView(encoded().bytes).subspan(b.offset, b.size), positions[c]))
        state.SkipWithError("a chunk was refused");
    }
    benchmark::DoNotOptimize(refiner.tetrahedra().data());
  }
  count(state);
}
BENCHMARK(refineFin)->Unit(benchmark::kMillisecond);

// Decodes bytes to the mesh and all fields: checksums, Draco, records, values.
void decodeFin(benchmark::State& state) {
  const LogFile log = need(LogFile::fromBytes(encoded().bytes));
  std::vector<std::uint32_t> fields(log.index().fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  for (auto _ : state) {
    Refiner refiner(log.index());
    for (std::uint32_t c = 0; c < log.index().chunks.size(); ++c)
      if (!applyChunk(log, refiner, c, fields)) state.SkipWithError("a chunk was refused");
    benchmark::DoNotOptimize(refiner.tetrahedra().data());
  }
  count(state);
}
BENCHMARK(decodeFin)->Unit(benchmark::kMillisecond);

void crcOfTheLog(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(crc32c(encoded().bytes));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(encoded().bytes.size()));
}
BENCHMARK(crcOfTheLog);

void sha256OfTheLog(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(sha256Hex(encoded().bytes));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(encoded().bytes.size()));
}
BENCHMARK(sha256OfTheLog);

}  // namespace
}  // namespace qtet

BENCHMARK_MAIN();

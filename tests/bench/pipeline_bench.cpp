// The stages between a mesh on the lattice and a refined mesh, on the sample `fin`; results in TABLE.md. Rates count input tetrahedra.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <fstream>

#include "codec/value_block.h"
#include "codec/log_file.h"
#include "codec/log_writer.h"
#include "proto/checksum.h"
#include "proto/crc32c.h"
#include "simplify/qtetfusion.h"
#include "simplify/quantise.h"
#include "simplify/samples.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().text().c_str());
  std::exit(1);
}

const LatticeMesh& fin() {
  static const LatticeMesh mesh = need(quantise(finSample())).mesh;
  return mesh;
}

const FusionHistory& history() {
  static const FusionHistory h = need(simplify(fin(), {}));
  return h;
}

const EncodedLog& encoded() {
  static const EncodedLog log = need(encodeLog(history(), {}));
  return log;
}

void count(benchmark::State& state) { state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(fin().tetrahedra.size())); }

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

std::vector<std::vector<std::int32_t>> positionsOf(const LogIndex& index, ByteView bytes) {
  std::vector<std::vector<std::int32_t>> out;
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const BlockEntry& block = index.block(chunk, kPositionsPart);
    out.push_back(need(decodeValueBlock(bytes.subspan(block.offset, block.size), 3, index.tuples(chunk, kPositionsPart))));
  }
  return out;
}

void dracoFin(benchmark::State& state) {
  const LogIndex index = need(LogIndex::parse(encoded().bytes));
  for (auto _ : state) benchmark::DoNotOptimize(positionsOf(index, encoded().bytes));
  count(state);
}
BENCHMARK(dracoFin)->Unit(benchmark::kMillisecond);

void refineFin(benchmark::State& state) {
  const LogIndex index = need(LogIndex::parse(encoded().bytes));
  const auto positions = positionsOf(index, encoded().bytes);
  for (auto _ : state) {
    Refiner refiner(index);
    for (std::uint32_t c = 0; c < index.chunks.size(); ++c) {
      const BlockEntry& b = index.block(c, kStructurePart);
      if (!refiner.apply(c, ByteView(encoded().bytes).subspan(b.offset, b.size), positions[c])) state.SkipWithError("a chunk was refused");
    }
    benchmark::DoNotOptimize(refiner.tetrahedra().data());
  }
  count(state);
}
BENCHMARK(refineFin)->Unit(benchmark::kMillisecond);

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

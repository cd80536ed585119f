// Decoding logs from memory, in user CPU time: the records alone, and everything from bytes to mesh
// and all fields (checksums and Draco included).
//   decode_bench [--runs N] LOG.qtet...
// Results in TABLE.md. Prints medians, tetrahedra a second, and digests of the results, by which
// two builds are compared. `digest` is that of tests/golden, `values` a CRC-32C of all fields.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/log/value_block.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "proto/checksum.h"
#include "proto/crc32c.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/need.h"

namespace qtet {
namespace {

using bench::need;

using Blocks = std::vector<std::vector<std::int32_t>>;  // integers by chunk

Blocks positionsOf(const LogFile& log) {
  const LogIndex& index = log.index();
  Blocks out;
  for (std::uint32_t c = 0; c < index.chunks.size(); ++c)
    out.push_back(
        need(decodeValueBlock(log.block(c, kPositionsPart), 3, index.tuples(c, kPositionsPart),
                              index.blockCodec(c, kPositionsPart))));
  return out;
}

void refine(const LogFile& log, const Blocks& positions) {
  Refiner refiner(log.index());
  for (std::uint32_t c = 0; c < positions.size(); ++c)
    need(refiner.apply(c, log.block(c, kStructurePart), positions[c]));
}

Refiner decode(const LogFile& log) {
  std::vector<std::uint32_t> fields(log.index().fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  Refiner refiner(log.index());
  for (std::uint32_t c = 0; c < log.index().chunks.size(); ++c)
    need(applyChunk(log, refiner, c, fields));
  return refiner;
}

std::uint32_t valuesCrc(const Refiner& refiner) {
  Bytes all;
  for (std::uint32_t f = 0; f < refiner.index().fields.size(); ++f) {
    const std::span<const std::int32_t> values = refiner.fieldValues(f);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    all.insert(all.end(), bytes, bytes + values.size_bytes());
  }
  return crc32c(all);
}

void report(const char* path, int runs) {
  const LogFile log = need(LogFile::open(path));
  const Blocks positions = positionsOf(log);
  std::vector<double> records, all;
  for (int run = 0; run < runs; ++run) {
    records.push_back(bench::timeOf([&] { refine(log, positions); }).user);
    all.push_back(bench::timeOf([&] { (void)decode(log); }).user);
  }
  const Refiner refiner = decode(log);
  const auto cells = static_cast<double>(refiner.tetrahedra().size());
  const double recordSeconds = bench::medianOf(records), allSeconds = bench::medianOf(all);
  std::printf(
      "%-28s %9.0f cells  records %7.1f ms %5.0f k/s  everything %7.1f ms %5.0f k/s  digest %.16s "
      "values %08x\n",
      path, cells, 1e3 * recordSeconds, 1e-3 * cells / recordSeconds, 1e3 * allSeconds,
      1e-3 * cells / allSeconds, toHex(refiner.digest()).c_str(), valuesCrc(refiner));
}

}  // namespace
}  // namespace qtet

int main(int argc, char** argv) {
  int runs = 5;
  std::vector<const char*> logs;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--runs") == 0 && i + 1 < argc)
      runs = std::max(1, std::atoi(argv[++i]));
    else
      logs.push_back(argv[i]);
  }
  if (logs.empty()) {
    std::fprintf(stderr, "usage: decode_bench [--runs N] LOG.qtet...\n");
    return 2;
  }
  for (const char* log : logs) qtet::report(log, runs);
}

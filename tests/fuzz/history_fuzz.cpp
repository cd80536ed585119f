// Fuzzes by structure: the input chooses a mesh, the simplifier's options and where chunks end.
// Every decoded level must be the mesh that the simplifier had. Then the rest of the input damages
// blocks below their checksums, and no id may leave its range.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/paper_fusion.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/checked_refiner.h"
#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"

namespace {

using namespace qtet;
using Input = fuzz::ByteSource;

void require(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "history_fuzz: %s\n", what.c_str());
  std::abort();
}

/// A grid with any of its cubes left out, or a random solid.
LatticeMesh meshFrom(Input& in) {
  const std::uint8_t kind = in.next();
  const std::uint16_t seed = in.next16();
  if (kind % 4 == 0) return testing::randomSolid(seed).mesh;
  const int n = 1 + kind / 4 % 3;
  std::uint32_t keep = 0;
  for (int i = 0; i < 4; ++i) keep |= std::uint32_t{in.next()} << (8 * i);
  keep = ~keep;  // an input that ends early leaves nothing out
  LatticeMesh mesh = testing::gridMesh(
      n, seed, [&](int i, int j, int k) { return (keep >> ((i * n + j) * n + k) & 1) != 0; });
  if (kind & 64) testing::addCellFields(mesh);
  return mesh;
}

/// Some values are chosen one by one, within what the fields' bits hold.
void changeValues(LatticeMesh& mesh, Input& in) {
  for (std::size_t f = 0; f < mesh.values.size(); ++f) {
    std::vector<std::int32_t>& values = mesh.values[f];
    for (std::uint8_t left = in.next() % 8; left > 0 && !values.empty(); --left) {
      const std::size_t at = in.next16() % values.size();
      values[at] = in.next16() & ((std::int32_t{1} << mesh.fields[f].bits) - 1);
    }
  }
}

Result<FusionHistory> historyFrom(const LatticeMesh& mesh, Input& in) {
  FusionOptions options;
  const std::uint8_t flags = in.next();
  options.targetRatio = in.next() / 255.0;
  options.shapeWeight = in.next() / 64.0;
  options.cost.boundaryWeight = in.next() * in.next() / 16.0;
  if (flags & 1) options.envelopeTolerance = in.next() / 1024.0;
  if (flags & 2)
    for (std::size_t f = 0; f < mesh.fields.size(); ++f)
      options.cost.fieldWeights.push_back(in.next() / 32.0);
  if (flags & 4)
    for (std::size_t f = 0; f < mesh.fields.size(); ++f)
      if (isCellField(mesh.fields[f]) && mesh.fields[f].components == 1) options.regionField = f;
  if (!(flags & 8)) return simplify(mesh, options);
  Result<PaperFusion> paper = simplifyAsThePaper(mesh, options);
  if (!paper) return std::unexpected(paper.error());
  return std::move(paper->history);
}

struct Log {
  LogIndex index;
  std::vector<Bytes> structures;                               // by chunk
  std::vector<std::vector<std::vector<std::int32_t>>> values;  // chunk, part; none of the structure
};

Log logOf(const FusionHistory& history, Input& in) {
  LogWriterOptions options;
  options.generator = "history_fuzz";
  options.chunkBytes = 16u + in.next16() % 4096u;
  options.valueCodec = CodecId::kDraco;  // values are damaged one by one below
  Result<EncodedLog> encoded = encodeLog(history, options);
  require(encoded.has_value(), encoded ? "" : "not encoded: " + encoded.error().text());
  Log log;
  Result<LogIndex> index = LogIndex::parse(encoded->bytes);
  require(index.has_value(), index ? "" : "not parsed: " + index.error().text());
  log.index = std::move(*index);
  require(manifestOf(log.index).has_value(), "the manifest contradicts the table");
  const auto block = [&](std::uint32_t chunk, std::uint32_t part) {
    const BlockEntry& b = log.index.block(chunk, part);
    return ByteView(encoded->bytes).subspan(static_cast<std::size_t>(b.offset), b.size);
  };
  for (std::uint32_t chunk = 0; chunk < log.index.chunks.size(); ++chunk) {
    const ByteView structure = block(chunk, kStructurePart);
    log.structures.emplace_back(structure.begin(), structure.end());
    log.values.emplace_back(1);
    for (std::uint32_t part = kPositionsPart; part < log.index.parts(); ++part) {
      auto values = decodeValueBlock(block(chunk, part), log.index.components(part),
                                     log.index.tuples(chunk, part), CodecId::kDraco);
      require(values.has_value(), "a value block does not decode");
      log.values.back().push_back(std::move(*values));
    }
  }
  return log;
}

Status applyMesh(const Log& log, Refiner& refiner, std::uint32_t chunk) {
  return refiner.apply(chunk, log.structures[chunk], log.values[chunk][kPositionsPart]);
}

Status applyField(const Log& log, Refiner& refiner, std::uint32_t chunk, std::uint32_t field) {
  return refiner.applyField(field, chunk, log.values[chunk][kFirstFieldPart + field]);
}

Status apply(const Log& log, Refiner& refiner, std::uint32_t chunk) {
  if (Status s = applyMesh(log, refiner, chunk); !s) return s;
  for (std::uint32_t f = 0; f < log.index.fields.size(); ++f)
    if (Status s = applyField(log, refiner, chunk, f); !s) return s;
  return {};
}

/// The same values come at a few elements alone, as a server makes those of a point.
void compareFew(const Log& log, const Refiner& whole, Association association, Input& in) {
  const auto isOthers = [&](std::uint32_t f) {
    return log.index.fields[f].association != association;
  };
  std::vector<std::uint32_t> fields(log.index.fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  std::erase_if(fields, isOthers);
  const std::size_t count =
      association == Association::kPoint ? whole.points().size() : whole.tetrahedra().size();
  if (fields.empty() || count == 0) return;
  std::array<std::uint32_t, 3> elements{};
  for (std::uint32_t& e : elements) e = static_cast<std::uint32_t>(in.next16() % count);
  Refiner few(log.index);
  few.stopAtLevel(whole.level());
  for (std::uint32_t chunk = 0; chunk < whole.chunksApplied(); ++chunk)
    require(applyMesh(log, few, chunk).has_value(), "a mesh that was made once is not made again");
  few.fieldsOnlyAt(association, elements);
  for (const std::uint32_t f : fields) {
    const std::size_t width = log.index.fields[f].components;
    for (std::uint32_t chunk = 0; chunk < whole.chunksApplied(); ++chunk)
      require(applyField(log, few, chunk, f).has_value(), "a field is not made again");
    for (const std::uint32_t e : elements)
      require(std::ranges::equal(few.fieldValues(f).subspan(e * width, width),
                                 whole.fieldValues(f).subspan(e * width, width)),
              "a few elements have other values than among all");
  }
}

void compareFew(const Log& log, const Refiner& whole, Input& in) {
  for (const Association association : {Association::kPoint, Association::kCell})
    compareFew(log, whole, association, in);
}

void compareLevel(const FusionHistory& history, const Log& log, std::uint32_t level, Input& in) {
  Refiner refiner(log.index);
  refiner.stopAtLevel(level);
  for (std::uint32_t chunk = 0;
       chunk < log.index.chunks.size() && (chunk == 0 || refiner.level() < level); ++chunk) {
    const Status applied = apply(log, refiner, chunk);
    require(applied.has_value(), applied ? "" : applied.error().text());
  }
  compareFew(log, refiner, in);
  const LatticeMesh expected = testing::meshOfHistory(history, level);
  LatticeMesh decoded;
  decoded.lattice = expected.lattice;
  decoded.fields = expected.fields;
  decoded.points.assign(refiner.points().begin(), refiner.points().end());
  decoded.tetrahedra.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
  decoded.boundary.assign(refiner.boundary().begin(), refiner.boundary().end());
  for (std::uint32_t f = 0; f < log.index.fields.size(); ++f)
    decoded.values.emplace_back(refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
  const auto same = sameMesh(decoded, expected);
  require(same.has_value(),
          same ? "" : "level " + std::to_string(level) + ": " + same.error().text());
  const std::string wrong = testing::whatIsWrongWith(decoded);
  require(wrong.empty(), "level " + std::to_string(level) + ": " + wrong);
}

/// Each pair of bytes damages a place of one chunk's structure or residuals; every chunk is decoded
/// as far as it goes.
void decodeDamaged(Log& log, Input& in) {
  const std::uint32_t bad = in.next() % static_cast<std::uint32_t>(log.index.chunks.size());
  Bytes& structure = log.structures[bad];
  for (int left = 16; left > 0 && !in.empty(); --left) {
    const std::uint16_t at = in.next16();
    const std::uint8_t value = in.next();
    std::vector<std::vector<std::int32_t>>& values = log.values[bad];
    std::vector<std::int32_t>& block = values[kPositionsPart + at % (values.size() - 1)];
    if (value & 1 && !block.empty()) {
      block[at / values.size() % block.size()] +=
          (value & 2 ? 1 : 40'000) * (static_cast<std::int8_t>(value) >> 2);
    } else if (!structure.empty()) {
      structure[at % structure.size()] ^= static_cast<std::uint8_t>(value | 1);
    }
  }
  Refiner refiner(log.index);
  for (std::uint32_t chunk = 0; chunk < log.index.chunks.size(); ++chunk) {
    const Status applied = apply(log, refiner, chunk);
    fuzz::abortUnlessSound(refiner);
    if (!applied) return;
  }
  compareFew(log, refiner, in);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input in{{data, size}};
  LatticeMesh mesh = meshFrom(in);
  // small ones meet the same code in less time
  if (mesh.tetrahedra.empty() || mesh.tetrahedra.size() > 300) return 0;
  changeValues(mesh, in);
  const Result<FusionHistory> history = historyFrom(mesh, in);
  require(history.has_value(), history ? "" : history.error().text());
  Log log = logOf(*history, in);
  require(log.index.chunks.back().lastLevel == history->levels, "another number of levels");
  compareLevel(*history, log, history->levels, in);
  compareLevel(*history, log, in.next() % (history->levels + 1), in);
  decodeDamaged(log, in);
  return 0;
}

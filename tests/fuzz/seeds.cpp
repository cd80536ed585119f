// Rewrites the fuzzers' seeds: `qtet_seeds tests/fuzz/seeds`. Run it when the format changes;
// log_fuzz and chunk_fuzz take the golden files.
#include <cstdio>
#include <random>

#include "codec/files/atomic_file.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "proto/messages.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

void write(const std::filesystem::path& path, ByteView bytes) {
  std::filesystem::create_directories(path.parent_path());
  if (const Status s = writeFileAtomically(path, bytes); !s)
    std::fprintf(stderr, "%s\n", s.error().text().c_str());
}

void write(const std::filesystem::path& path, const std::string& text) {
  write(path, ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

/// A log with what refiner_fuzz has: a lattice of 10 bits, a point field of two components, a cell
/// field of one.
testing::TakenApart refinerLog(int n, std::uint32_t seed, std::uint32_t chunkBytes) {
  LatticeMesh mesh = testing::gridMesh(n, seed);
  testing::addCellFields(mesh);
  mesh.lattice.bits = 10;
  std::vector<std::int32_t> pairs;
  for (const LatticePoint& p : mesh.points) pairs.push_back(p[0]), pairs.push_back(p[1]);
  mesh.fields = {mesh.fields[0], mesh.fields[2]};
  mesh.fields[0].components = 2;
  mesh.fields[0].minimum = {0, 0};
  mesh.values = {pairs, mesh.values[2]};
  LogWriterOptions options;
  options.chunkBytes = chunkBytes;
  options.valueCodec = CodecId::kDraco;
  return testing::takeApart(encodeLog(simplify(mesh, {}).value(), options).value().bytes);
}

/// In the order in which refiner_fuzz reads.
Bytes refinerSeed(const testing::TakenApart& log, std::size_t chunks) {
  ByteWriter w;
  chunks = std::min(chunks, log.blocks.size());
  w.write(static_cast<std::uint8_t>(chunks - 1));
  for (std::size_t c = 0; c < chunks; ++c) {
    const ChunkEntry& e = log.index.chunks[c];
    for (const std::uint32_t count :
         {e.newVertices, e.newTetrahedra, e.newBoundaryTriangles, e.records})
      w.write(static_cast<std::uint16_t>(count));
    w.write(static_cast<std::uint8_t>(e.firstLevel));
    w.write(static_cast<std::uint8_t>(e.lastLevel - e.firstLevel));
    w.write(static_cast<std::uint16_t>(e.endSlot));
  }
  w.write(std::uint8_t{255});  // no level to stop at
  for (std::uint32_t c = 0; c < chunks; ++c) {
    w.write(static_cast<std::uint16_t>(log.blocks[c][kStructurePart].size()));
    w.append(log.blocks[c][kStructurePart]);
    for (std::uint32_t part = kPositionsPart; part < log.index.parts(); ++part) {
      const auto values = decodeValueBlock(log.blocks[c][part], log.index.components(part),
                                           log.index.tuples(c, part), CodecId::kDraco)
                              .value();
      for (const std::int32_t value : values) w.write(static_cast<std::uint16_t>(value));
    }
  }
  return w.take();
}

Bytes dracoSeed(std::uint32_t components, std::uint32_t tuples, std::int32_t magnitude) {
  std::mt19937 random(components * 1000 + tuples);
  std::vector<std::int32_t> values(std::size_t{components} * tuples);
  for (std::int32_t& value : values)
    value = magnitude == 0 ? 7 : static_cast<std::int32_t>(random() % (2u * magnitude)) - magnitude;
  ByteWriter w;
  w.write(static_cast<std::uint8_t>(components - 1));
  w.write(static_cast<std::uint16_t>(tuples));
  w.append(encodeValueBlock(values, components, CodecId::kDraco).value());
  return w.take();
}

/// As manifest_fuzz reads it, with known errors.
Bytes knownErrorsSeed() {
  Manifest m;
  m.generator = "qtet", m.source = "a.vtu";
  m.fields = {{"p", 2, "float32", "point", 12, 0.5, {0, 1}, {0, 2}},
              {"c", 1, "uint8", "cell", 8, 1, {0}, {0, 255}}};
  for (std::uint32_t l = 0; l < 6; ++l) {
    const double e = (5 - l) * 0.01;
    m.levels.push_back({l, 100 + 10 * l * l, 40 + 3 * l, 50 + 2 * l, 0,
                        LevelError{{e / 3, e}, {e / 4, e}, e, e / 2, {{e / 9, e}, {0, e / 2}}}});
  }
  Bytes out = manifestBlock(m).value();
  out.insert(out.begin(), 5);
  return out;
}

/// Bytes as history_fuzz reads them: the mesh first, then values, options and damage at random.
Bytes historySeed(std::uint8_t kind, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes out{kind, static_cast<std::uint8_t>(seed), 0, 0, 0, 0, 0};
  while (out.size() < 64) out.push_back(static_cast<std::uint8_t>(random()));
  return out;
}

}  // namespace
}  // namespace qtet

int main(int argc, char** argv) {
  using namespace qtet;
  if (argc != 2) return std::fprintf(stderr, "usage: qtet_seeds FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  write(folder / "refiner" / "one-cube", refinerSeed(refinerLog(1, 1, 32768), 8));
  write(folder / "refiner" / "eight-cubes", refinerSeed(refinerLog(2, 2, 60), 8));
  write(folder / "draco" / "none", Bytes{2, 0, 0});
  write(folder / "draco" / "one", dracoSeed(3, 1, 100));
  write(folder / "draco" / "constant", dracoSeed(1, 1000, 0));
  write(folder / "draco" / "small", dracoSeed(3, 40, 9));
  write(folder / "draco" / "large", dracoSeed(2, 30, 1 << 17));
  write(folder / "draco" / "sixteen", dracoSeed(16, 12, 300));
  const auto shortest = refinerLog(1, 1, 32768);
  Bytes manifest = shortest.index.manifest;
  manifest.insert(manifest.begin(),
                  static_cast<std::uint8_t>(shortest.index.chunks.back().lastLevel));
  write(folder / "manifest" / "two-fields", manifest);
  write(folder / "manifest" / "known-errors", knownErrorsSeed());
  OpenMessage open{.mesh = "fin",
                   .digest = std::string(64, 'a'),
                   .fields = {"Velocity", "cell:Region"},
                   .have = {},
                   .target = {},
                   .credit = 1 << 20};
  open.have = {3, {{"Velocity", 2}}};
  write(folder / "message" / "open", toJson(ClientMessage(open)));
  write(folder / "message" / "credit", toJson(ClientMessage(CreditMessage{65536})));
  write(folder / "message" / "cancel", toJson(ClientMessage(CancelMessage{})));
  write(folder / "message" / "opened",
        toJson(ServerMessage(OpenedMessage{1, "fin", std::string(64, 'b'), 1000, 900})));
  write(folder / "message" / "error",
        toJson(ServerMessage(ErrorMessage{kNotFound, "there is no mesh 'a'"})));
  Bytes frame(FrameHeader::kBytes + 4, 1);
  const auto header = FrameHeader{1, 2, 0, 1, 4}.encode();
  std::copy(header.begin(), header.end(), frame.begin());
  write(folder / "message" / "frame", frame);
  for (const std::uint8_t kind :
       std::initializer_list<std::uint8_t>{0, 4, 8, 9, 5 + 64, 9 + 64, 11})
    write(folder / "history" / ("kind-" + std::to_string(kind)), historySeed(kind, kind + 1u));
  return 0;
}

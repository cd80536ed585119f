// Writes the golden files anew: `qtet_golden FOLDER`. Run it only when the format changes; the committed files are the reference.
#include <cstdio>
#include <fstream>
#include <functional>

#include "codec/atomic_file.h"
#include "codec/log_file.h"
#include "codec/log_writer.h"
#include "simplify/qtetfusion.h"
#include "proto/checksum.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

Bytes logOf(const LatticeMesh& mesh, std::uint32_t chunkBytes) {
  LogWriterOptions options;
  options.source = "golden.vtu";
  options.generator = "qtet golden";
  options.chunkBytes = chunkBytes;
  return encodeLog(simplify(mesh, {}).value(), options).value().bytes;
}

/// A log taken apart, changed and put together with every checksum right; `table` changes what stands there beside the right offsets.
Bytes forged(const Bytes& good, const std::function<void(LogIndex&)>& table, const std::function<void(std::vector<std::vector<Bytes>>&)>& body = {}) {
  testing::TakenApart parts = testing::takeApart(good);
  if (body) body(parts.blocks);
  Bytes whole = parts.together();
  if (!table) return whole;
  const auto tail = static_cast<std::ptrdiff_t>(parts.index.headBytes());
  table(parts.index);
  Bytes out = parts.index.encode();
  out.insert(out.end(), whole.begin() + tail, whole.end());
  return out;
}

void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::filesystem::create_directories(path.parent_path());
  if (const Status s = writeFileAtomically(path, bytes); !s) std::fprintf(stderr, "%s\n", s.error().text().c_str());
}

void writeMustFail(const std::filesystem::path& folder, const Bytes& good) {
  const auto patched = [&](std::size_t at, std::uint8_t value) {
    Bytes b = good;
    b[at] = value;
    return b;
  };
  const auto cut = [&](std::size_t n) { return Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)); };
  const auto entry = [&](std::size_t chunk, const std::function<void(ChunkEntry&)>& change) {
    return forged(good, [&](LogIndex& i) { change(i.chunks[chunk]); });
  };
  const LogIndex index = LogIndex::parse(good).value();
  Bytes reserved = patched(15, 1);
  testing::mendChecksums(reserved);
  write(folder / "bad-magic.text-mode-copy.qtet", patched(5, 0x0A));
  write(folder / "bad-version.major-1.qtet", patched(8, 1));
  write(folder / "bad-version.major-3.qtet", patched(8, 3));
  write(folder / "bad-version.regions.qtet", forged(good, [](LogIndex& i) { i.layout = Layout::kRegions; }));
  write(folder / "truncated.header.qtet", cut(63));
  write(folder / "truncated.manifest.qtet", cut(100));
  write(folder / "truncated.last-byte.qtet", cut(good.size() - 1));
  write(folder / "bad-value.one-byte-too-many.qtet", [&] { Bytes b = good; b.push_back(0); return b; }());
  write(folder / "bad-checksum.header.qtet", patched(41, 1));
  write(folder / "bad-checksum.manifest.qtet", patched(70, static_cast<std::uint8_t>(good[70] ^ 1)));
  write(folder / "bad-checksum.table.qtet", patched(index.headBytes() - 3, 99));
  write(folder / "bad-checksum.block.qtet", patched(good.size() - 7, static_cast<std::uint8_t>(good[good.size() - 7] ^ 16)));
  write(folder / "bad-value.position-bits.qtet", forged(good, [](LogIndex& i) { i.positionBits = 3; }));
  write(folder / "bad-value.lattice-too-small.qtet", forged(good, [](LogIndex& i) { i.positionBits = 6; }));
  write(folder / "bad-value.field-components.qtet", forged(good, [](LogIndex& i) { i.fields[0].components = 0; }));
  write(folder / "bad-value.field-association.qtet", forged(good, [](LogIndex& i) { i.fields[0].association = static_cast<Association>(2); }));
  write(folder / "bad-value.points-as-cells.qtet", forged(good, [](LogIndex& i) { i.fields[0].association = Association::kCell; }));
  write(folder / "bad-value.chunk-offset.qtet", entry(1, [](ChunkEntry& e) { e.offset += 8; }));
  write(folder / "bad-value.levels-backwards.qtet", entry(2, [](ChunkEntry& e) { e.firstLevel = 0; }));
  write(folder / "bad-value.depends-on-itself.qtet", forged(good, [](LogIndex& i) { i.dependencies[0] = 1; }));
  write(folder / "bad-value.reserved-bytes.qtet", reserved);
  write(folder / "bad-value.ends-within-a-level.qtet", entry(index.chunks.size() - 1, [](ChunkEntry& e) { e.endSlot = 1000; }));
  write(folder / "bad-value.a-level-left-out.qtet", entry(index.chunks.size() - 1, [](ChunkEntry& e) { ++e.firstLevel, ++e.lastLevel; }));
  write(folder / "bad-value.too-few-cells.qtet", entry(1, [](ChunkEntry& e) { --e.newTetrahedra; }));
  write(folder / "bad-value.too-many-records.qtet", entry(1, [](ChunkEntry& e) { ++e.records; }));
  write(folder / "limit-exceeded.levels.qtet", entry(index.chunks.size() - 1, [](ChunkEntry& e) { e.lastLevel = 4097; }));
  write(folder / "limit-exceeded.records.qtet", entry(1, [](ChunkEntry& e) { e.records = 0x40000000; }));
  write(folder / "bad-codec.unknown-id.qtet", entry(1, [](ChunkEntry& e) { e.valueCodec = static_cast<CodecId>(77); }));
  write(folder / "bad-codec.not-draco.qtet", forged(good, {}, [](auto& blocks) { blocks[1][kPositionsPart] = Bytes(50, 0x5A); }));
  write(folder / "bad-value.structure-of-noise.qtet", forged(good, {}, [](auto& blocks) { for (auto& b : blocks[1][kStructurePart]) b = static_cast<std::uint8_t>(b * 7 + 3); }));
  write(folder / "bad-value.structure-too-long.qtet", forged(good, {}, [](auto& blocks) { blocks[1][kStructurePart].push_back(0); }));
  write(folder / "truncated.structure.qtet", forged(good, {}, [](auto& blocks) { blocks[2][kStructurePart].resize(blocks[2][kStructurePart].size() / 2); }));
}

/// What the valid files decode to, in the form that sha256sum writes.
void writeDigests(const std::filesystem::path& folder) {
  std::ofstream meshes(folder / "digests.txt"), values(folder / "field-digests.txt");
  for (const char* name : {"cell-fields", "no-fields", "pinched", "solid", "tunnel"}) {
    const std::string file = std::string(name) + ".qtet";
    const LogFile log = LogFile::open(folder / "valid" / file).value();
    std::vector<std::uint32_t> fields;
    for (std::uint32_t f = 0; f < log.index().fields.size(); ++f) fields.push_back(f);
    Refiner refiner(log.index());
    for (std::uint32_t chunk = 0; chunk < log.index().chunks.size(); ++chunk) applyChunk(log, refiner, chunk, fields).value();
    meshes << toHex(refiner.digest()) << "  " << file << "\n";
    for (const std::uint32_t f : fields) {
      ByteWriter w;
      for (const std::int32_t value : refiner.fieldValues(f)) w.write(static_cast<std::uint32_t>(value));
      values << sha256Hex(w.bytes()) << "  " << file << "/" << f << "\n";
    }
  }
}

}  // namespace
}  // namespace qtet

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: qtet_golden FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  using qtet::testing::gridMesh;
  const qtet::Bytes solid = qtet::logOf(gridMesh(3, 1), 500);
  qtet::write(folder / "valid" / "solid.qtet", solid);
  qtet::write(folder / "valid" / "tunnel.qtet", qtet::logOf(gridMesh(3, 2, [](int i, int j, int) { return i != 1 || j != 1; }), 300));
  qtet::write(folder / "valid" / "pinched.qtet", qtet::logOf(gridMesh(4, 3, [](int i, int j, int) { return (i < 2) == (j < 2); }), 700));
  qtet::LatticeMesh bare = gridMesh(2, 4);
  bare.fields.clear(), bare.values.clear();
  qtet::write(folder / "valid" / "no-fields.qtet", qtet::logOf(bare, 32768));
  qtet::LatticeMesh cells = gridMesh(3, 5);
  qtet::testing::addCellFields(cells);
  qtet::write(folder / "valid" / "cell-fields.qtet", qtet::logOf(cells, 800));
  qtet::writeMustFail(folder / "must-fail", solid);
  qtet::writeDigests(folder);
  return 0;
}

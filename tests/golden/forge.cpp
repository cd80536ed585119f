// Writes the golden files that a folder lacks: `qtet_golden FOLDER`. The committed files are the
// reference and stay. second_decoder/author.py writes the logs of dice and all digests.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>

#include "codec/coding/level_columns.h"
#include "codec/files/atomic_file.h"
#include "codec/log/chunk_table.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "proto/limits.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/log/kept_input.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/series/time_differences.h"
#include "tests/support/cheap_log.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"
#include "tests/support/series_mesh.h"

namespace qtet {
namespace {

Bytes logOf(const LatticeMesh& mesh, std::uint32_t chunkBytes, const FusionOptions& fusion = {},
            CodecId values = CodecId::kLifted) {
  LogWriterOptions options;
  options.source = "golden.vtu";
  options.generator = "qtet golden";
  options.chunkBytes = chunkBytes;
  options.valueCodec = values;
  return encodeLog(simplify(mesh, fusion).value(), options).value().bytes;
}

/// A field of points, one of cells, and every third of their values missing, beside a field without
/// missing values.
Bytes logWithMissingValues() {
  LatticeMesh mesh = testing::gridMesh(3, 6);
  testing::addCellFields(mesh);
  std::vector<std::vector<std::uint8_t>> hasMissing(mesh.fields.size());
  for (const std::size_t f : {std::size_t{0}, mesh.fields.size() - 1}) {
    mesh.fields[f].hasMissing = true;
    for (std::size_t i = 0; i < mesh.values[f].size(); ++i) hasMissing[f].push_back(i / 2 % 3 == 0);
  }
  FusionHistory history = simplify(mesh, {}).value();
  restoreMissing(history, hasMissing);
  LogWriterOptions options;
  options.source = "golden.vtu";
  options.generator = "qtet golden";
  options.chunkBytes = 500;
  return encodeLog(history, options).value().bytes;
}

/// Series of points and cells, one instant with missing values.
Bytes logOfSeries() {
  LatticeMesh mesh = testing::seriesMesh(3, 8, 6);
  std::vector<std::vector<std::uint8_t>> missing(mesh.fields.size());
  mesh.fields[2].hasMissing = true;
  for (std::size_t i = 0; i < mesh.values[2].size(); ++i) missing[2].push_back(i % 7 == 0);
  FusionHistory history = simplify(mesh, {}).value();
  restoreMissing(history, missing);
  (void)predictInTime(history).value();
  toTimeDifferences(history);
  LogWriterOptions options;
  options.source = "golden.pvd";
  options.generator = "qtet golden";
  options.chunkBytes = 700;
  return encodeLog(history, options).value().bytes;
}

/// The mesh in floats, its values an eighth of a step beside the lattice's.
TetMesh besideTheLattice(const LatticeMesh& mesh) {
  TetMesh input;
  for (const LatticePoint& p : mesh.points) input.points.push_back(mesh.lattice.position(p));
  input.tetrahedra = mesh.tetrahedra;
  input.pointType = "float64";
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    MeshField& field = input.fields.emplace_back(
        MeshField{info.name, info.components, info.type, {}, info.association});
    for (std::size_t i = 0; i < mesh.values[f].size(); ++i)
      field.values.push_back(info.value(i % info.components, mesh.values[f][i]) +
                             0.125 * info.step);
  }
  return input;
}

Bytes logWithInput(const LatticeMesh& mesh, const KeptInput& kept) {
  const FusionHistory history = simplify(mesh, {}).value();
  LogWriterOptions options;
  options.source = "golden.vtu";
  options.generator = "qtet golden";
  options.closing = [&](const FinestMesh& finest, const ClosingSink& give) {
    return giveInput(history, finest, kept, {}, give);
  };
  return encodeLog(history, options).value().bytes;
}

/// A log of hexahedra that were each cut into six cells. The file numbers them in steps of three.
Bytes logWithOriginalCells() {
  const LatticeMesh mesh = testing::gridMesh(2, 8);
  KeptInput kept{{false, false, true}, besideTheLattice(mesh)};
  kept.originalCells.emplace();
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    kept.originalCells->push_back(3 * (t / 6));
  return logWithInput(mesh, kept);
}

/// With all closing blocks, and one of a kind that is not known yet.
Bytes keptLog() {
  const LatticeMesh mesh = testing::gridMesh(2, 7);
  testing::TakenApart parts =
      testing::takeApart(logWithInput(mesh, {{true, true}, besideTheLattice(mesh)}));
  parts.index.closing.push_back({static_cast<ClosingKind>(70000), 300, {}});
  parts.closing.push_back(Bytes(200, 0x5A));
  return parts.together();
}

/// A log taken apart, changed and put together with every checksum right; `table` changes what
/// stands there beside the right offsets.
Bytes forged(const Bytes& good, const std::function<void(LogIndex&)>& table,
             const std::function<void(std::vector<std::vector<Bytes>>&)>& body = {}) {
  testing::TakenApart parts = testing::takeApart(good);
  if (body) body(parts.blocks);
  Bytes whole = parts.together();
  if (!table) return whole;
  table(parts.index);
  return testing::withFront(whole, parts.index);
}

/// Files that are there stay, whatever the simplifier makes by now.
void write(const std::filesystem::path& path, const Bytes& bytes) {
  if (std::filesystem::exists(path)) return;
  std::filesystem::create_directories(path.parent_path());
  if (const Status s = writeFileAtomically(path, bytes); !s)
    std::fprintf(stderr, "%s\n", s.error().text().c_str());
}

constexpr Focus kSomeFocus{1, 2, 3, 0x8001, 0x8002, 0xffff};
constexpr Opening kSomeOpening{1, 2};

Bytes withFirstView(const Bytes& log, const Focus& focus, const Opening& opening) {
  testing::TakenApart parts = testing::takeApart(log);
  Manifest m = manifestOf(parts.index).value();
  m.focus = focus;
  m.opening = opening;
  parts.index.manifest = manifestBlock(m).value();
  return parts.together();
}

/// With a unit of the first field and one of times.
Bytes withUnits(const Bytes& log, const std::string& unit) {
  testing::TakenApart parts = testing::takeApart(log);
  Manifest m = manifestOf(parts.index).value();
  m.units = {{"", "s"}, {m.fields[0].name, unit}};
  parts.index.manifest = manifestBlock(m).value();
  return parts.together();
}

/// Reduced from an original of that size.
Bytes withOriginal(const Bytes& log, const OriginalSize& original) {
  testing::TakenApart parts = testing::takeApart(log);
  Manifest m = manifestOf(parts.index).value();
  m.original = original;
  parts.index.manifest = manifestBlock(m).value();
  return parts.together();
}

constexpr OriginalSize kSomeOriginal{5'000'000'000, 900'000'000};

/// With half a cell more.
Bytes withHalfACell(const Bytes& log) {
  testing::TakenApart parts = testing::takeApart(withOriginal(log, kSomeOriginal));
  const auto bytesOf = [](double number) {
    std::array<std::uint8_t, sizeof number> out{};
    std::memcpy(out.data(), &number, sizeof number);
    return out;
  };
  const auto cells = static_cast<double>(kSomeOriginal.tetrahedra);
  const auto at = std::ranges::search(parts.index.manifest, bytesOf(cells));
  std::ranges::copy(bytesOf(cells + 0.5), at.begin());
  return parts.together();
}

/// With the field as a label that has names of its values.
Bytes withLabel(const Bytes& log, const std::string& field, const LabelNames& names) {
  testing::TakenApart parts = testing::takeApart(log);
  Manifest m = manifestOf(parts.index).value();
  m.labels = {{field, names}};
  parts.index.manifest = manifestBlock(m).value();
  return parts.together();
}

const LabelNames kSomeNames{{-7, "air"}, {1, "steel"}, {4, "oil"}};

void writeBadLabels(const std::filesystem::path& folder, const Bytes& good) {
  write(folder / "bad-value.manifest-label-without-a-name.qtet",
        withLabel(good, "Region", {{1, ""}}));
  LabelNames many;
  for (std::int32_t value = 0; value <= static_cast<std::int32_t>(kMaxLabelNames); ++value)
    many[value] = "x";
  write(folder / "bad-value.manifest-label-of-too-many-names.qtet",
        withLabel(good, "Region", many));
}

/// With the errors of levels 0, 3, 4, 9 and the last.
Bytes withSomeErrors(const Bytes& log) {
  testing::TakenApart parts = testing::takeApart(log);
  Manifest m = manifestOf(parts.index).value();
  for (const std::size_t level :
       {std::size_t{0}, std::size_t{3}, std::size_t{4}, std::size_t{9}, m.levels.size() - 1}) {
    const double e = 0.08 / static_cast<double>(1 + level * level);
    m.levels[level].error =
        LevelError{{e / 7, e},
                   {e / 9, e / 2},
                   e / 3,
                   e / 5,
                   std::vector<FieldError>(m.fields.size(), FieldError{e / 11, e / 2})};
  }
  parts.index.manifest = manifestBlock(m).value();
  return parts.together();
}

/// Breaks the head's statements about levels and fields, with correct checksums.
void writeBadHeads(const std::filesystem::path& folder, const Bytes& good) {
  const auto manifest = [&](const std::function<void(Bytes&)>& change) {
    testing::TakenApart parts = testing::takeApart(good);
    change(parts.index.manifest);
    return parts.together();
  };
  const auto manifested = [&](const std::function<void(Manifest&)>& change) {
    testing::TakenApart parts = testing::takeApart(good);
    Manifest m = manifestOf(parts.index).value();
    change(m);
    parts.index.manifest = manifestBlock(m).value();
    return parts.together();
  };
  write(folder / "truncated.manifest-fields.qtet", manifest([](Bytes& b) { b.resize(60); }));
  write(folder / "truncated.manifest-levels.qtet",
        manifest([](Bytes& b) { b.resize(b.size() - 3); }));
  write(folder / "bad-value.manifest-too-long.qtet", manifest([](Bytes& b) { b.push_back(0); }));
  write(folder / "bad-value.manifest-long-varint.qtet",
        manifest([](Bytes& b) { b[0] |= 128, b.insert(b.begin() + 1, 0); }));
  write(folder / "bad-value.manifest-name-length.qtet",
        manifest([](Bytes& b) { b[0] |= 128, b.insert(b.begin() + 1, 3); }));
  write(folder / "bad-value.manifest-step.qtet",
        manifested([](Manifest& m) { m.latticeStep = 0; }));
  write(folder / "bad-value.manifest-not-finite.qtet", manifested([](Manifest& m) {
          m.latticeOrigin[1] = std::numeric_limits<double>::quiet_NaN();
        }));
  write(folder / "bad-value.manifest-field-bits.qtet",
        manifested([](Manifest& m) { m.fields[0].bits = 29; }));
  write(folder / "bad-value.manifest-field-type.qtet",
        manifested([](Manifest& m) { m.fields[0].type = "complex64"; }));
  write(folder / "bad-value.manifest-field-twice.qtet",
        manifested([](Manifest& m) { m.fields[1].name = m.fields[0].name; }));
  write(folder / "bad-value.manifest-no-name.qtet",
        manifested([](Manifest& m) { m.fields[0].name = ""; }));
  write(folder / "bad-value.manifest-count.qtet",
        manifested([](Manifest& m) { m.levels[1].vertices = kMaxElements + 1; }));
  write(folder / "bad-value.manifest-empty-focus.qtet",
        withFirstView(good, {1, 2, 3, 4, 2, 4}, kSomeOpening));
  write(folder / "bad-value.manifest-opening-field.qtet",
        withFirstView(good, kSomeFocus, Opening{2, 2}));
  write(folder / "bad-value.manifest-opening-cut.qtet",
        withFirstView(good, kSomeFocus, Opening{1, 4}));
  write(folder / "bad-value.manifest-empty-unit.qtet", withUnits(good, ""));
  const ManifestLevel last = manifestOf(testing::takeApart(good).index).value().levels.back();
  write(folder / "bad-value.manifest-original-of-few-cells.qtet",
        withOriginal(good, {last.tetrahedra - 1u, last.vertices}));
  write(folder / "bad-value.manifest-original-of-few-vertices.qtet",
        withOriginal(good, {last.tetrahedra, last.vertices - 1u}));
  write(folder / "bad-value.manifest-original-of-half-a-cell.qtet", withHalfACell(good));
  write(folder / "bad-value.manifest-unit-length.qtet", withUnits(good, std::string(65, 'K')));
  // The figures of all levels in the bytes of none.
  const Manifest m = manifestOf(testing::takeApart(good).index).value();
  LevelColumns columns;
  for (const auto count :
       {&ManifestLevel::tetrahedra, &ManifestLevel::vertices, &ManifestLevel::boundaryTriangles})
    for (const ManifestLevel& level : m.levels) columns.push_back(level.*count);
  const std::size_t size =
      encodeLevelColumns(columns, static_cast<std::uint32_t>(m.levels.size()), KnownErrors::kNone)
          .size();
  write(folder / "limit-exceeded.manifest-bomb.qtet",
        manifest([size](Bytes& b) { b.resize(b.size() - size); }));
  // The errors of the last level alone, and flags that are not known.
  columns.resize(m.levels.size() * levelColumnCount(2, KnownErrors::kSome));
  const std::size_t known = kKnownColumn * m.levels.size();
  const auto errors = [&](std::uint8_t flags, std::uint32_t ofFirst) {
    columns[known] = ofFirst;
    columns[known + m.levels.size() - 1] = 1;
    testing::TakenApart parts = testing::takeApart(good);
    Bytes& b = parts.index.manifest;
    b.resize(b.size() - size);
    b.back() = flags;
    const Bytes told = encodeLevelColumns(columns, static_cast<std::uint32_t>(m.levels.size()),
                                          KnownErrors::kSome);
    b.insert(b.end(), told.begin(), told.end());
    return parts.together();
  };
  write(folder / "bad-value.manifest-base-without-error.qtet", errors(1, 0));
  write(folder / "bad-value.manifest-unknown-flag.qtet", errors(65, 1));
}

/// Breaks the part of later instants, and what the table says of it.
void writeBadSeries(const std::filesystem::path& folder, const Bytes& series) {
  const LogIndex index = LogIndex::parse(series).value();
  const auto patched = [&](std::size_t at, std::size_t value) {
    Bytes b = series;
    b[at] = static_cast<std::uint8_t>(value);
    testing::mendChecksums(b);
    return b;
  };
  const std::size_t part = series.size() - index.encodeLater().size();
  const auto first = std::ranges::find_if(
      index.fields, [](const FieldShape& f) { return !f.prediction.isNone(); });
  // Components and association of the later fields before it stand before its count of parents.
  const std::size_t front = index.fields.size() - index.laterFields;
  const std::size_t before = static_cast<std::size_t>(first - index.fields.begin());
  const std::size_t count = part + 2 * (before - front + 1);
  write(folder / "bad-value.series-no-parent.qtet", patched(count, 0));
  write(folder / "bad-value.series-five-parents.qtet", patched(count, 5));
  write(folder / "bad-value.series-its-own-parent.qtet", patched(count + 1, before));
  // The last field is one of cells, the first one of points.
  write(folder / "bad-value.series-parent-of-another-kind.qtet",
        forged(series, [](LogIndex& i) { i.fields.back().prediction.parents[0].field = 0; }));
  const std::size_t table = LogIndex::kHeaderBytes + index.manifest.size();
  write(folder / "bad-value.series-more-later-fields-than-fields.qtet",
        patched(table, index.fields.size() + 1));
  write(folder / "bad-value.series-no-later-field-in-the-part.qtet", patched(table, 0));
  write(folder / "bad-value.series-part-too-long.qtet",
        forged(series, [](LogIndex& i) { i.laterManifest.push_back(0); }));
  // The manifest of later fields takes what their blocks' rows need.
  std::size_t shapes = 0;
  for (const FieldShape& f : std::span(index.fields).last(index.laterFields))
    shapes += 2 + (f.prediction.isNone() ? 0 : 1 + 2 * f.prediction.count);
  write(folder / "bad-value.series-part-too-short.qtet",
        patched(part + shapes, series[part + shapes] + 20));
  Bytes flipped = series;
  flipped[part] ^= 1;
  write(folder / "bad-checksum.later-instants.qtet", flipped);
}

void writeBadClosing(const std::filesystem::path& folder, const Bytes& kept) {
  const auto closing = [&](const std::function<void(std::vector<ClosingBlock>&)>& change) {
    return forged(kept, [&](LogIndex& i) { change(i.closing); });
  };
  const auto exact = [](std::vector<ClosingBlock>& c) -> ClosingBlock& {
    return *std::ranges::find(c, ClosingKind::kExactField, &ClosingBlock::kind);
  };
  write(folder / "bad-value.gaps-in-the-table-alone.qtet",
        forged(kept, [](LogIndex& i) { i.fields[0].hasMissing = true; }));
  write(folder / "bad-value.closing-twice.qtet", closing([](auto& c) { c[1].kind = c[0].kind; }));
  write(folder / "bad-value.closing-order-of-a-field.qtet",
        closing([](auto& c) { c[0].field = 1; }));
  write(folder / "bad-value.closing-cells-alone.qtet", [&] {
    testing::TakenApart parts = testing::takeApart(kept);
    parts.index.closing.erase(parts.index.closing.begin());
    parts.closing.erase(parts.closing.begin());
    return parts.together();
  }());
  write(folder / "bad-value.closing-field.qtet", closing([&](auto& c) { exact(c).field = 99; }));
  write(folder / "bad-value.closing-size.qtet", closing([](auto& c) { ++c[0].block.size; }));
  write(folder / "bad-value.closing-left-out.qtet", closing([](auto& c) { c.pop_back(); }));
  write(folder / "limit-exceeded.closing-size.qtet",
        closing([](auto& c) { c[0].block.size = kMaxBlockBytes + 1; }));
  write(folder / "limit-exceeded.closing-blocks.qtet", closing([](auto& c) {
          while (c.size() <= kMaxClosingBlocks)
            c.push_back({static_cast<ClosingKind>(1000 + c.size()), 0, {}});
        }));
}

void writeMustFail(const std::filesystem::path& folder, const Bytes& good) {
  const auto patched = [&](std::size_t at, std::uint8_t value) {
    Bytes b = good;
    b[at] = value;
    return b;
  };
  const auto cut = [&](std::size_t n) {
    return Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
  };
  const auto entry = [&](std::size_t chunk, const std::function<void(ChunkEntry&)>& change) {
    return forged(good, [&](LogIndex& i) { change(i.chunks[chunk]); });
  };
  const LogIndex index = LogIndex::parse(good).value();
  Bytes reserved = patched(15, 1);
  testing::mendChecksums(reserved);
  Bytes dependencies = patched(48, static_cast<std::uint8_t>(good[48] + 1));
  testing::mendChecksums(dependencies);
  write(folder / "bad-magic.text-mode-copy.qtet", patched(5, 0x0A));
  write(folder / "bad-version.major-3.qtet", patched(8, 3));
  write(folder / "bad-version.major-5.qtet", patched(8, 5));
  Bytes regions = patched(12, 1);
  testing::mendChecksums(regions);
  write(folder / "bad-version.layout-1.qtet", regions);
  write(folder / "truncated.header.qtet", cut(63));
  write(folder / "truncated.manifest.qtet", cut(100));
  write(folder / "truncated.last-byte.qtet", cut(good.size() - 1));
  write(folder / "bad-value.one-byte-too-many.qtet", [&] {
    Bytes b = good;
    b.push_back(0);
    return b;
  }());
  write(folder / "bad-checksum.header.qtet", patched(41, 1));
  write(folder / "bad-checksum.manifest.qtet",
        patched(70, static_cast<std::uint8_t>(good[70] ^ 1)));
  write(folder / "bad-checksum.table.qtet", patched(index.headBytes() - 3, 99));
  write(folder / "bad-checksum.block.qtet",
        patched(good.size() - 7, static_cast<std::uint8_t>(good[good.size() - 7] ^ 16)));
  write(folder / "bad-value.position-bits.qtet",
        forged(good, [](LogIndex& i) { i.positionBits = 3; }));
  write(folder / "bad-value.lattice-too-small.qtet",
        forged(good, [](LogIndex& i) { i.positionBits = 6; }));
  write(folder / "bad-value.field-components.qtet",
        forged(good, [](LogIndex& i) { i.fields[0].components = 0; }));
  write(folder / "bad-value.field-association.qtet",
        forged(good, [](LogIndex& i) { i.fields[0].association = static_cast<Association>(2); }));
  write(folder / "bad-value.points-as-cells.qtet",
        forged(good, [](LogIndex& i) { i.fields[0].association = Association::kCell; }));
  write(folder / "bad-value.block-size.qtet",
        entry(1, [](ChunkEntry& e) { e.blocks[0].size += 8; }));
  write(folder / "bad-value.dependencies.qtet", dependencies);
  write(folder / "bad-value.reserved-bytes.qtet", reserved);
  write(folder / "bad-value.ends-within-a-level.qtet",
        entry(index.chunks.size() - 1, [](ChunkEntry& e) { e.endSlot = 1000; }));
  write(folder / "bad-value.a-level-too-many.qtet",
        entry(index.chunks.size() - 1, [](ChunkEntry& e) { ++e.lastLevel; }));
  write(folder / "bad-value.too-few-cells.qtet",
        entry(1, [](ChunkEntry& e) { --e.newTetrahedra; }));
  write(folder / "bad-value.too-many-records.qtet", entry(1, [](ChunkEntry& e) { ++e.records; }));
  write(folder / "limit-exceeded.levels.qtet",
        entry(index.chunks.size() - 1, [](ChunkEntry& e) { e.lastLevel = 4097; }));
  write(folder / "limit-exceeded.records.qtet",
        entry(1, [](ChunkEntry& e) { e.records = 0x40000000; }));
  write(folder / "bad-codec.unknown-id.qtet",
        entry(1, [](ChunkEntry& e) { e.valueCodec = static_cast<CodecId>(77); }));
  write(folder / "bad-codec.two-of-values.qtet",
        entry(1, [](ChunkEntry& e) { e.valueCodec = CodecId::kAdaptive; }));
  write(folder / "truncated.lifted.qtet", forged(good, {}, [](auto& blocks) {
          Bytes& block = blocks[1][kFirstFieldPart];
          block.erase(block.begin() + 6, block.end() - 1);
        }));
  write(folder / "bad-value.lifted-too-long.qtet", forged(good, {}, [](auto& blocks) {
          Bytes& block = blocks[1][kFirstFieldPart];
          block.insert(block.begin() + static_cast<std::ptrdiff_t>(block.size() / 2), 9, 0x5A);
        }));
  write(folder / "bad-value.lifted-lengths.qtet", forged(good, {}, [](auto& blocks) {
          Bytes& block = blocks[1][kFirstFieldPart];
          std::ranges::fill(block, 0);
        }));
  write(folder / "bad-codec.not-draco.qtet", forged(good, {}, [](auto& blocks) {
          blocks[1][kPositionsPart] = Bytes(50, 0x5A),
          std::fill_n(blocks[1][kPositionsPart].end() - 4, 4, 0);
        }));
  write(folder / "bad-value.structure-of-noise.qtet", forged(good, {}, [](auto& blocks) {
          for (auto& b : blocks[1][kStructurePart]) b = static_cast<std::uint8_t>(b * 7 + 3);
        }));
  write(folder / "bad-value.structure-too-long.qtet",
        forged(good, {}, [](auto& blocks) { blocks[1][kStructurePart].push_back(0); }));
  writeBadHeads(folder, good);
  write(folder / "bad-value.structure-cut.qtet", forged(good, {}, [](auto& blocks) {
          blocks[2][kStructurePart].resize(blocks[2][kStructurePart].size() / 2);
        }));
}

}  // namespace
}  // namespace qtet

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: qtet_golden FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  using qtet::testing::gridMesh;
  const qtet::Bytes solid = qtet::logOf(gridMesh(3, 1), 150);
  qtet::write(folder / "valid" / "solid.qtet", solid);
  qtet::write(folder / "valid" / "first-view.qtet",
              qtet::withFirstView(solid, qtet::kSomeFocus, qtet::kSomeOpening));
  qtet::write(folder / "valid" / "some-errors.qtet", qtet::withSomeErrors(solid));
  qtet::write(folder / "valid" / "units.qtet", qtet::withUnits(solid, "kg/m^3"));
  qtet::write(folder / "valid" / "reduced.qtet", qtet::withOriginal(solid, qtet::kSomeOriginal));
  qtet::write(folder / "valid" / "tunnel.qtet",
              qtet::logOf(gridMesh(3, 2, [](int i, int j, int) { return i != 1 || j != 1; }), 300));
  qtet::write(
      folder / "valid" / "pinched.qtet",
      qtet::logOf(gridMesh(4, 3, [](int i, int j, int) { return (i < 2) == (j < 2); }), 700));
  qtet::LatticeMesh bare = gridMesh(2, 4);
  bare.fields.clear(), bare.values.clear();
  qtet::write(folder / "valid" / "no-fields.qtet", qtet::logOf(bare, 32768));
  qtet::LatticeMesh cells = gridMesh(3, 5);
  qtet::testing::addCellFields(cells);
  const qtet::Bytes withCells = qtet::logOf(cells, 800);
  qtet::write(folder / "valid" / "cell-fields.qtet", withCells);
  qtet::write(folder / "valid" / "labels.qtet",
              qtet::withLabel(withCells, "Region", qtet::kSomeNames));
  qtet::writeBadLabels(folder / "must-fail", withCells);
  qtet::write(folder / "valid" / "adaptive.qtet",
              qtet::logOf(gridMesh(3, 5), 400, {}, qtet::CodecId::kAdaptive));
  qtet::write(folder / "valid" / "draco.qtet",
              qtet::logOf(gridMesh(3, 5), 400, {}, qtet::CodecId::kDraco));
  const qtet::Bytes kept = qtet::keptLog();
  qtet::write(folder / "valid" / "gaps.qtet", qtet::logWithMissingValues());
  qtet::write(folder / "valid" / "kept-input.qtet", kept);
  qtet::write(folder / "valid" / "original-cells.qtet", qtet::logWithOriginalCells());
  const qtet::Bytes series = qtet::logOfSeries();
  qtet::write(folder / "valid" / "series.qtet", series);
  qtet::writeMustFail(folder / "must-fail", solid);
  qtet::writeBadSeries(folder / "must-fail", series);
  qtet::writeBadClosing(folder / "must-fail", kept);
  qtet::write(folder / "must-fail" / "limit-exceeded.work.qtet",
              qtet::testing::CheapLog(250).file());
  return 0;
}

// A small log that asks for much work: decisions that cost next to nothing (FORMAT.md, "Security").
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "codec/log/log_manifest.h"
#include "codec/log/value_block.h"
#include "codec/mesh/boundary.h"
#include "codec/record/base_coder.h"
#include "codec/record/record_coder.h"
#include "codec/refine/refiner.h"
#include "tests/support/author_coder.h"
#include "tests/support/forged_log.h"

namespace qtet::testing {

/// A log of single tetrahedra, which cost a hundredth of a bit each. Chunk 1 has `levels` levels.
/// Each asks all vertices and splits one.
class CheapLog {
 public:
  static constexpr std::uint32_t kTetrahedra = 10'000, kVertices = 4 * kTetrahedra;
  static constexpr std::uint8_t kBits = 10;

  explicit CheapLog(std::uint32_t levels) {
    index.positionBits = kBits;
    index.chunks.resize(2);
    index.chunks[1].firstLevel = 1;
    index.chunks[1].lastLevel = levels;
    index.chunks[1].records = levels;
    base();
    positions[1].assign(std::size_t{3} * levels, 0);
    refine(levels);
  }

  /// Decodes everything with the refiner.
  [[nodiscard]] Status decode(Refiner& refiner) const {
    for (std::uint32_t chunk = 0; chunk < 2; ++chunk)
      if (Status s = refiner.apply(chunk, structure[chunk], positions[chunk]); !s) return s;
    return {};
  }

  /// The same as a file.
  [[nodiscard]] Bytes file() const {
    TakenApart log{index, {}};
    for (std::size_t chunk = 0; chunk < 2; ++chunk) {
      log.index.chunks[chunk].valueCodec = CodecId::kAdaptive;
      log.blocks.push_back(
          {structure[chunk], encodeValueBlock(positions[chunk], 3, CodecId::kAdaptive).value()});
    }
    Manifest m;
    m.generator = "qtet golden";
    m.source = "cheap.vtu";
    for (std::uint32_t level = 0; level <= index.chunks[1].lastLevel; ++level)
      m.levels.push_back({level, 1, 1, 1, 0, std::nullopt});
    log.index.manifest = manifestBlock(m).value();
    return log.together();
  }

  LogIndex index;
  std::array<Bytes, 2> structure;
  std::array<std::vector<std::int32_t>, 2> positions;

 private:
  void base() {
    AuthorCoder author([](std::uint32_t) { return 1; }, [](int) { return 0u; });
    BaseCoder<AuthorCoder> cells(author, kVertices, kTetrahedra);
    EXPECT_TRUE(cells.run(nullptr, [] { return false; }));
    structure[0] = author.written.finish();
    constexpr std::array<LatticePoint, 4> kSteps{{{-1, 0, -1}, {1, 0, 0}, {-1, 1, 0}, {1, -1, 1}}};
    for (VertexId v = 0; v < kVertices; ++v) {
      const LatticePoint told = v == 0 ? LatticePoint{500, 500, 500} : kSteps[v % 4];
      positions[0].insert(positions[0].end(), told.begin(), told.end());
      mesh_.points.push_back(told);
      for (std::size_t a = 0; a < 3 && v > 0; ++a) mesh_.points[v][a] += mesh_.points[v - 1][a];
    }
    mesh_.tetrahedra = cells.tetrahedra;
    mesh_.boundary = boundaryOf(mesh_.tetrahedra);
    mesh_.start(kBits);
    count(index.chunks[0], {});
  }

  void refine(std::uint32_t levels) {
    const Slots before = mesh_.next();
    Values told(positions[1]);
    RecordCoder<AuthorCoder> coder(author_, models_, mesh_, link_, told);
    for (std::uint32_t level = 1; level <= levels; ++level) {
      mesh_.beginLevel(level);
      for (VertexId v = 0; v < mesh_.levelVertices(); ++v) {
        if (!mesh_.maysplit(v)) continue;
        answers_ = v == 4 * level;
        if (coder.splits(v, level, false)) split(coder, v);
      }
    }
    structure[1] = author_.written.finish();
    count(index.chunks[1], before);
  }

  // k = 2; the second triangle has label 1; the fused vertex stands at a prey vertex.
  void split(RecordCoder<AuthorCoder>& coder, VertexId v) {
    answers_ = 0b11111000;
    Split out;
    ASSERT_TRUE(mesh_.enter(v, link_));
    ASSERT_TRUE(coder.code(v, {}, out)) << v;
    mesh_.apply(v, link_, out);
  }

  void count(ChunkEntry& row, const Slots& before) const {
    row.newVertices = mesh_.next().vertices - before.vertices;
    row.newTetrahedra = mesh_.next().tetrahedra - before.tetrahedra;
    row.newBoundaryTriangles = mesh_.next().triangles - before.triangles;
  }

  GrowingMesh mesh_;
  Link link_;
  RecordModels models_;
  unsigned answers_ = 0;  // the next one lowest
  AuthorCoder author_{[this](std::uint32_t) {
                        const int answer = static_cast<int>(answers_ & 1);
                        answers_ >>= 1;
                        return answer;
                      },
                      [](int) { return 0u; }};
};

}  // namespace qtet::testing

// One record in both directions: split flag, kind, labels, deleted cells, positions (FORMAT.md,
// "Record"). The encoder runs it on a mirror of the decoder's mesh, so the two can never disagree
// about a context.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/mixed_bit.h"
#include "codec/coding/range_coder.h"
#include "codec/mesh/deleted_cells.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"
#include "codec/record/label_coder.h"
#include "codec/record/position_coder.h"
#include "proto/limits.h"

namespace qtet {

/// The encoder's knowledge of a record; a decoder leaves it empty. Prey 0 keeps the slot.
struct RecordTruth {
  int k = 2;
  Placement placement = Placement::kAtPrey;
  int near = 0;
  std::array<LatticePoint, 4> points{};
  std::vector<std::uint8_t> labels;  ///< one a link triangle, in star order
  /// Sorted list of sorted cells; filled in once the link is known.
  std::vector<LocalCell> deleted;
};

struct RecordModels {
  // star size, extent against the level's, age
  std::array<std::array<std::array<BitModel, 3>, 16>, 16> split;
  // extent, on the boundary, age
  std::array<std::array<std::array<BitModel, 3>, 2>, 64> splitScale;
  // levels since birth, star size, on the boundary
  std::array<std::array<std::array<BitModel, 2>, 32>, 16> splitAge;
  // the last flags, flatness of the star, extent
  std::array<std::array<std::array<BitModel, 8>, 8>, 16> splitRun;
  std::array<Mixer<4>, 3> splitMixer;  // age
  // the last ones, the latest lowest
  std::uint32_t flags = 0;
  std::array<std::array<BitModel, 2>, 4> tetrahedron;  // star size, touches the boundary
  std::array<std::array<BitModel, 2>, 4> triangle;
  PositionModels positions;
  LabelModels labels;
  DeletedModels deleted;
  // running mean of the log extent of stars that split, times 16
  std::int32_t extent = 64 * 10 * 16;
};

template <class Coder>
class RecordCoder {
 public:
  RecordCoder(Coder& coder, RecordModels& models, GrowingMesh& mesh, Link& link, Values& positions)
      : coder_(coder),
        models_(models),
        mesh_(mesh),
        link_(link),
        values_(positions),
        labels_(coder, models.labels, link),
        positions_(coder, models.positions, positions, mesh, link) {}

  /// The split flag of v at `level`. REQUIRES mesh.maysplit(v).
  bool splits(VertexId v, std::uint32_t level, bool truth) {
    assert(mesh_.maysplit(v));
    const std::size_t size = mesh_.star(v).size();
    const GrowingMesh::Spread& spread = mesh_.spread(v);
    const auto& squares = spread.squares;
    const int extent = spread.logMean(squares[0] + squares[1] + squares[2]);
    const int scale = extent - models_.extent / 16;
    const auto step = [&](int width, int half) {
      return static_cast<std::size_t>(std::clamp(scale / width + half, 0, 2 * half - 1));
    };
    const std::uint32_t born = mesh_.born(v);
    const std::size_t age = born == 0 ? 0 : level - born <= 1 ? 1 : 2;
    const std::size_t sinceBorn = born == 0 ? 15 : std::min<std::size_t>(level - born, 14);
    const bool edge = mesh_.onBoundary(v);
    const std::uint64_t least = std::min(std::min(squares[0], squares[1]), squares[2]),
                        most = std::max(std::max(squares[0], squares[1]), squares[2]);
    const auto flat =
        static_cast<std::size_t>(std::min((log2Fixed(most + 1) - log2Fixed(least + 1)) / 48, 7));
    const std::array<BitModel*, 4> models{
        &models_.split[std::min<std::size_t>(size / 6, 15)][step(16, 8)][age],
        &models_.splitScale[step(8, 32)][edge][age],
        &models_.splitAge[sinceBorn][std::min<std::size_t>(size / 2, 31)][edge],
        &models_.splitRun[models_.flags & 15][flat][step(24, 4)]};
    const bool split = mixedBit(coder_, truth, models, models_.splitMixer[age]) != 0;
    models_.flags = models_.flags << 1 | static_cast<std::uint32_t>(split);
    if (split) models_.extent += (extent * 16 - models_.extent) / 64;
    return split;
  }

  /// The record of v, whose link is built (GrowingMesh::enter), into `split`; an encoder's truth is
  /// complete. False: not describable (encoder), not valid (decoder).
  [[nodiscard]] bool code(VertexId v, const RecordTruth& truth, Split& split) {
    if constexpr (Coder::kEncoding) assert(truth.k >= 2 && truth.k <= 4);
    const auto size = std::min<std::size_t>(link_.triangles().size() / 24, 3);
    const std::size_t edge = link_.hasGhost();
    if (coder_.bit(truth.k == 4, models_.tetrahedron[size][edge]))
      split.k = 4;
    else
      split.k = coder_.bit(truth.k == 3, models_.triangle[size][edge]) ? 3 : 2;
    labels_.code(split.k, truth.labels);
    if (!codeDeletedCells(coder_, models_.deleted, link_, split.k, truth.deleted, split.deleted))
      return false;
    split.placement = truth.placement;
    split.near = truth.near;
    split.points = truth.points;
    if constexpr (Coder::kEncoding) positionCost_ -= coder_.cost();
    positions_.code(v, split);
    if constexpr (Coder::kEncoding) positionCost_ += coder_.cost();
    if (values_.bad()) return false;
    for (int i = 0; i < split.k; ++i)
      for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
        // the predicates' range; the lattice's own is the refiner's to check
        if (x < 0 || x >> kMaxPositionBits != 0) return false;
    return true;
  }

  /// An encoder's: what positions took of the structure block so far, in 64ths of a bit.
  [[nodiscard]] std::uint64_t positionCost() const { return positionCost_; }

 private:
  Coder& coder_;
  RecordModels& models_;
  GrowingMesh& mesh_;
  Link& link_;
  Values& values_;
  std::uint64_t positionCost_ = 0;
  LabelCoder<Coder> labels_;
  PositionCoder<Coder> positions_;
};

}  // namespace qtet

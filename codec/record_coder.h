// One record in both directions: split flag, kind, positions, labels, deleted cells (FORMAT.md, "Record"). The encoder runs it on a mirror of
// the decoder's mesh, so the two can never disagree about a context.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/deleted_cells.h"
#include "codec/growing_mesh.h"
#include "codec/label_coder.h"
#include "codec/link.h"
#include "codec/range_coder.h"
#include "proto/limits.h"

namespace qtet {

/// What an encoder knows of a record; a decoder leaves it empty. Prey 0 keeps the slot.
struct RecordTruth {
  int k = 2;
  bool moved = false;
  std::array<LatticePoint, 4> points{};
  std::vector<std::uint8_t> labels;   ///< one a link triangle, in star order
  std::vector<LocalCell> deleted;     ///< sorted list of sorted cells; filled in once the link is known
};

/// What a field needs to follow a record without its connectivity.
struct Birth {
  VertexId slot = 0;       ///< the vertex that split
  VertexId firstNew = 0;   ///< its k - 1 new vertices start here
  std::uint8_t k = 2;
  bool moved = false;

  [[nodiscard]] int values() const { return moved ? k : k - 1; }
};

/// Differences to predictions: read one after the other by a decoder, collected by an encoder.
class Residuals {
 public:
  Residuals() = default;
  explicit Residuals(std::span<const std::int32_t> given) : given_(given) {}

  template <bool kEncoding>
  std::int32_t code(std::int64_t predicted, std::int32_t truth) {
    if constexpr (kEncoding) {
      written_.push_back(static_cast<std::int32_t>(truth - predicted));
      return truth;
    } else {
      if (next_ == given_.size()) {
        bad_ = true;
        return 0;
      }
      const std::int64_t value = predicted + given_[next_++];
      bad_ |= value < -kLargest || value > kLargest;
      return bad_ ? 0 : static_cast<std::int32_t>(value);
    }
  }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] bool atEnd() const { return next_ == given_.size(); }
  [[nodiscard]] std::vector<std::int32_t>& written() { return written_; }

 private:
  static constexpr std::int64_t kLargest = std::int64_t{1} << 30;

  std::span<const std::int32_t> given_;
  std::size_t next_ = 0;
  bool bad_ = false;
  std::vector<std::int32_t> written_;
};

/// Codes the tuples of a record's k prey vertices, predicted from the fused vertex's: `fused(c)` is its component c, `prey(i, c)` a
/// reference to prey vertex i's. Moved: every prey vertex differs, and the last is predicted as what keeps the mean. Else prey 0 is the
/// fused vertex itself. REQUIRES components <= kMaxFieldComponents.
template <bool kEncoding, class Fused, class Prey>
void codePreyTuples(Residuals& residuals, int k, bool moved, std::uint32_t components, const Fused& fused, const Prey& prey) {
  if (!moved)
    for (std::uint32_t c = 0; c < components; ++c) prey(0, c) = fused(c);
  std::array<std::int64_t, kMaxFieldComponents> sum{};
  for (int i = moved ? 0 : 1; i < k; ++i) {
    const bool last = moved && i == k - 1;
    for (std::uint32_t c = 0; c < components; ++c) {
      std::int32_t& value = prey(i, c);
      value = residuals.code<kEncoding>(last ? std::int64_t{k} * fused(c) - sum[c] : fused(c), value);
      sum[c] += value;
    }
  }
}

struct RecordModels {
  std::array<std::array<std::array<BitModel, 3>, 16>, 16> split;  // star size, extent against the level's, age
  std::array<std::array<BitModel, 2>, 4> tetrahedron;             // star size, touches the boundary
  std::array<std::array<BitModel, 2>, 4> triangle;
  std::array<std::array<BitModel, 2>, 5> moved;                   // k, touches the boundary
  LabelModels labels;
  DeletedModels deleted;
  std::int32_t extent = 64 * 10 * 16;  // running mean of the log extent of stars that split, times 16
};

template <class Coder>
class RecordCoder {
 public:
  RecordCoder(Coder& coder, RecordModels& models, GrowingMesh& mesh, Link& link, Residuals& positions)
      : coder_(coder), models_(models), mesh_(mesh), link_(link), positions_(positions) {}

  /// The split flag of v at `level`. REQUIRES mesh.maysplit(v).
  bool splits(VertexId v, std::uint32_t level, bool truth) {
    const std::span<const CellRef> star = mesh_.star(v);
    if (star.empty()) return false;  // an unused vertex: nothing to split, nothing coded
    const int extent = starExtent(v, star);
    const std::size_t size = std::min<std::size_t>(star.size() / 6, 15);
    const auto scale = static_cast<std::size_t>(std::clamp((extent - models_.extent / 16) / 16 + 8, 0, 15));
    const std::size_t age = mesh_.born[v] == 0 ? 0 : level - mesh_.born[v] <= 1 ? 1 : 2;
    const bool split = coder_.bit(truth, models_.split[size][scale][age]) != 0;
    if (split) models_.extent += (extent * 16 - models_.extent) / 64;
    return split;
  }

  /// The record of v, whose link is built (GrowingMesh::enter), into `split`; an encoder's truth is complete.
  /// False: not describable (encoder), not valid (decoder).
  [[nodiscard]] bool code(VertexId v, const RecordTruth& truth, Split& split) {
    const auto size = std::min<std::size_t>(mesh_.star(v).size() / 24, 3);
    const std::size_t edge = link_.hasGhost();
    if (coder_.bit(truth.k == 4, models_.tetrahedron[size][edge]))
      split.k = 4;
    else
      split.k = coder_.bit(truth.k == 3, models_.triangle[size][edge]) ? 3 : 2;
    split.moved = coder_.bit(truth.moved, models_.moved[static_cast<std::size_t>(split.k)][edge]) != 0;
    codePoints(v, truth, split);
    if (positions_.bad()) return false;
    for (int i = 0; i < split.k; ++i)
      for (const std::int32_t x : split.points[static_cast<std::size_t>(i)])
        if (x < 0 || x >> kMaxPositionBits != 0) return false;  // the predicates' range; the lattice's own is the refiner's to check
    const std::span prey(split.points.data(), static_cast<std::size_t>(split.k));
    LabelCoder<Coder>(coder_, models_.labels, link_, mesh_.points, split.k, prey).code(truth.labels);
    return codeDeletedCells(coder_, models_.deleted, link_, split.k, truth.deleted, split.deleted);
  }

 private:
  // Log of the mean squared length of a sample of the star's edges at v.
  int starExtent(VertexId v, std::span<const CellRef> star) const {
    const std::size_t step = star.size() > 4 ? star.size() / 4 : 1;
    std::uint64_t sum = 0;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < star.size(); i += step)
      for (const VertexId w : mesh_.cell(star[i]))
        if (w != v && w != kGhost) {
          for (std::size_t a = 0; a < 3; ++a) {
            const std::int64_t d = mesh_.points[w][a] - mesh_.points[v][a];
            sum += static_cast<std::uint64_t>(d * d);
          }
          ++count;
        }
    return log2Fixed(count ? sum / count + 1 : 1);
  }

  void codePoints(VertexId v, const RecordTruth& truth, Split& split) {
    split.points = truth.points;
    const LatticePoint fused = mesh_.points[v];
    codePreyTuples<Coder::kEncoding>(
        positions_, split.k, split.moved, 3, [&](std::uint32_t a) { return fused[a]; },
        [&](int i, std::uint32_t a) -> std::int32_t& { return split.points[static_cast<std::size_t>(i)][a]; });
  }

  Coder& coder_;
  RecordModels& models_;
  GrowingMesh& mesh_;
  Link& link_;
  Residuals& positions_;
};

}  // namespace qtet

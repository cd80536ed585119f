// The base mesh in both directions: cells grown face by face, each given by its apex (FORMAT.md,
// "Base mesh").
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "codec/coding/range_coder.h"
#include "codec/mesh/boundary.h"
#include "codec/mesh/mesh.h"

namespace qtet {

/// The vertices that predict a base vertex's values: the face (a, b, c) over which its first cell
/// was grown, and the apex d behind it. a == kGhost for a vertex of a seed cell, which the vertex
/// before it predicts.
struct BaseBirth {
  std::array<VertexId, 4> from{kGhost, kGhost, kGhost, kGhost};
};

/// The encoder's knowledge: the oriented cells, and which cell lies across which face.
class BaseTruth {
 public:
  explicit BaseTruth(std::span<const Tetrahedron> cells);
  /// The cell not yet placed that shares the face, or kNone.
  [[nodiscard]] std::uint32_t unplacedAt(const Triangle& face) const;
  [[nodiscard]] std::uint32_t nextSeed();
  [[nodiscard]] const Tetrahedron& cell(std::uint32_t i) const { return cells_[i]; }
  void place(std::uint32_t i) { placed_[i] = 1; }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

 private:
  std::span<const Tetrahedron> cells_;
  std::vector<std::uint8_t> placed_;
  std::vector<std::pair<Triangle, std::uint32_t>> faces_;  // sorted vertices -> cell, sorted
  std::uint32_t seed_ = 0;
};

[[nodiscard]] inline Triangle sortedFace(Triangle face) {
  std::ranges::sort(face);
  return face;
}

struct BaseModels {
  BitModel boundary, fresh, seedFresh;
  NumberModel back;  // how many vertices ago an old vertex was new
};

template <class Coder>
class BaseCoder {
 public:
  BaseCoder(Coder& coder, std::uint32_t vertices, std::uint32_t cells)
      : coder_(coder), vertices_(vertices), cells_(cells) {}

  /// Grows all cells. An encoder passes the truth and reads `order`/`vertexOrder`. False: the
  /// stream contradicts itself, or (encoder) two cells do not agree on the orientation of the face
  /// between them. `overrun` is asked after each cell.
  template <class Overrun>
  [[nodiscard]] bool run(BaseTruth* truth, const Overrun& overrun) {
    truth_ = truth;
    std::size_t head = 0;
    while (tetrahedra.size() < cells_) {
      if (head == queue_.size()) {
        if (!seed()) return false;
      } else {
        const Open face = queue_[head++];
        if (!face.isOpen(open_, head - 1)) continue;
        if (!grow(face)) return false;
      }
      if (overrun()) return false;
    }
    return births.size() == vertices_;
  }

  std::vector<Tetrahedron> tetrahedra;  ///< in decoding order, oriented
  std::vector<BaseBirth> births;        ///< one a vertex
  std::vector<std::uint32_t> order;     ///< encoder: decoding order -> cell of the truth
  std::vector<VertexId> vertexOrder;    ///< encoder: decoded vertex -> vertex of the truth

 private:
  struct FaceHash {
    std::size_t operator()(const Triangle& t) const {
      return static_cast<std::size_t>((t[0] * 0x9E3779B97F4A7C15ull ^ t[1] * 0xC2B2AE3D27D4EB4Full ^
                                       t[2] * 0x165667B19E3779F9ull) >>
                                      16);
    }
  };
  using OpenFaces = std::unordered_map<Triangle, std::size_t, FaceHash>;
  struct Open {
    Triangle face{};      // a cell across it is (face, apex), positively oriented
    VertexId behind = 0;  // the apex on this side
    // Not met by another cell since it was queued at `index`; place() takes it off the map when one
    // comes.
    [[nodiscard]] bool isOpen(const OpenFaces& open, std::size_t index) const {
      const auto at = open.find(sortedFace(face));
      return at != open.end() && at->second == index;
    }
  };

  bool seed() {
    Tetrahedron cell{};
    std::uint32_t trueCell = 0;
    if constexpr (Coder::kEncoding) order.push_back(trueCell = truth_->nextSeed());
    for (std::size_t i = 0; i < 4; ++i) {
      VertexId wanted = 0;
      if constexpr (Coder::kEncoding) wanted = truth_->cell(trueCell)[i];
      if (!vertex(wanted, seedModels_.seedFresh, {}, cell[i])) return false;
    }
    return place(cell, trueCell);
  }

  bool grow(const Open& face) {
    std::uint32_t trueCell = 0;
    VertexId wanted = 0;
    if constexpr (Coder::kEncoding) {
      const Triangle f{vertexOrder[face.face[0]], vertexOrder[face.face[1]],
                       vertexOrder[face.face[2]]};
      trueCell = truth_->unplacedAt(f);
      if (trueCell != BaseTruth::kNone && !apexOf(f, truth_->cell(trueCell), wanted)) return false;
    }
    if (coder_.bit(trueCell == BaseTruth::kNone, seedModels_.boundary)) return true;
    if constexpr (Coder::kEncoding) order.push_back(trueCell);
    Tetrahedron cell{face.face[0], face.face[1], face.face[2], 0};
    const BaseBirth birth{{face.face[0], face.face[1], face.face[2], face.behind}};
    return vertex(wanted, seedModels_.fresh, birth, cell[3]) && place(cell, trueCell);
  }

  // The fourth vertex of `cell`, which must be (f, apex) up to an even permutation.
  static bool apexOf(const Triangle& f, const Tetrahedron& cell, VertexId& apex) {
    for (int i = 0; i < 4; ++i) {
      Triangle outward = cellFace(cell, i);
      if (sortedFace(outward) != sortedFace(f)) continue;
      apex = cell[static_cast<std::size_t>(i)];
      while (outward[0] != f[0]) std::ranges::rotate(outward, outward.begin() + 1);
      return outward[1] == f[2];  // f is the same face seen from inside
    }
    return false;
  }

  bool vertex(VertexId wanted, BitModel& freshModel, const BaseBirth& birth, VertexId& out) {
    const auto next = static_cast<VertexId>(births.size());
    VertexId known = kGhost;
    if constexpr (Coder::kEncoding)
      if (const auto at = numbered_.find(wanted); at != numbered_.end()) known = at->second;
    if (coder_.bit(known == kGhost, freshModel)) {
      if (next == vertices_) return false;
      births.push_back(birth);
      if constexpr (Coder::kEncoding) numbered_[wanted] = next, vertexOrder.push_back(wanted);
      out = next;
      return true;
    }
    const std::uint32_t back = seedModels_.back.code(coder_, next - 1 - known);
    if (back >= next) return false;
    out = next - 1 - back;
    return true;
  }

  bool place(const Tetrahedron& cell, std::uint32_t trueCell) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (cell[i] == cell[j]) return false;
    tetrahedra.push_back(cell);
    if constexpr (Coder::kEncoding) truth_->place(trueCell);
    for (int i = 0; i < 4; ++i) {
      const Triangle out = cellFace(cell, i);
      const auto [at, fresh] = open_.try_emplace(sortedFace(out), queue_.size());
      if (fresh)
        queue_.push_back({out, cell[static_cast<std::size_t>(i)]});
      else
        open_.erase(at);
    }
    return true;
  }

  Coder& coder_;
  std::uint32_t vertices_, cells_;
  BaseTruth* truth_ = nullptr;
  BaseModels seedModels_;
  OpenFaces open_;
  std::vector<Open> queue_;
  std::unordered_map<VertexId, VertexId> numbered_;
};

/// Predicts component c of base vertex v from values already known; `at(u, c)` reads them.
template <class At>
[[nodiscard]] std::int64_t predictBase(const BaseBirth& birth, VertexId v, std::uint32_t c,
                                       bool position, const At& at) {
  const auto& f = birth.from;
  if (f[0] == kGhost) return v == 0 ? 0 : at(v - 1, c);
  const std::int64_t sum = std::int64_t{at(f[0], c)} + at(f[1], c) + at(f[2], c);
  return position ? (2 * sum + 1) / 3 - at(f[3], c) : (sum + 1) / 3;
}

/// The same for a field with missing values: the mean of the face's values that are present. For a
/// seed's vertex, the value before it if present. Else 0.
template <class At>
[[nodiscard]] std::int64_t predictBaseBesideMissing(const BaseBirth& birth, VertexId v,
                                                    std::uint32_t c, const At& at) {
  const auto& f = birth.from;
  if (f[0] == kGhost) return v == 0 || at(v - 1, c) == kMissing ? 0 : at(v - 1, c);
  std::int64_t sum = 0, count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const std::int64_t value = at(f[i], c); value != kMissing) sum += value, ++count;
  return count == 0 ? 0 : (sum + count / 2) / count;
}

/// The prediction for a field.
template <class At>
[[nodiscard]] std::int64_t predictBaseField(const BaseBirth& birth, VertexId v, std::uint32_t c,
                                            bool hasMissing, const At& at) {
  return hasMissing ? predictBaseBesideMissing(birth, v, c, at)
                    : predictBase(birth, v, c, false, at);
}

}  // namespace qtet

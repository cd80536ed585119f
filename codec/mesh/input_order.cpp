#include "codec/mesh/input_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>
#include <unordered_map>

#include "codec/coding/range_coder.h"

namespace qtet {
namespace {

std::unexpected<Error> bad() {
  return fail(ErrorCode::kBadValue,
              "a block of the input's order contradicts itself; fetch or build the log again");
}

/// The vertices that share an edge with each vertex.
class Neighbours {
 public:
  explicit Neighbours(const DecodedMesh& mesh) {
    std::vector<std::uint64_t> edges;
    edges.reserve(mesh.tetrahedra.size() * 12);
    for (const Tetrahedron& t : mesh.tetrahedra)
      for (const VertexId a : t)
        for (const VertexId b : t)
          if (a != b) edges.push_back(std::uint64_t{a} << 32 | b);
    std::ranges::sort(edges);
    edges.erase(std::ranges::unique(edges).begin(), edges.end());
    first_.assign(mesh.points.size() + 1, 0);
    for (const std::uint64_t e : edges)
      ++first_[(e >> 32) + 1], to_.push_back(static_cast<VertexId>(e));
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }
  [[nodiscard]] std::span<const VertexId> of(VertexId v) const {
    return std::span(to_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<VertexId> to_;
};

/// Walks along the input's points: most often the next one is a neighbour of the one before,
/// straight on.
template <class Coder>
class PointOrderCoder {
 public:
  PointOrderCoder(Coder& coder, const DecodedMesh& mesh)
      : coder_(coder), mesh_(mesh), neighbours_(mesh), taken_(mesh.points.size(), 0) {}

  template <class Overrun>
  [[nodiscard]] bool run(std::vector<VertexId>& slots, const Overrun& overrun) {
    const int bits = static_cast<int>(std::bit_width(slots.size() - 1));
    std::size_t stepped = 0;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      VertexId& slot = slots[i];
      if (i > 0) rank(slots[i - 1], i > 1 ? slots[i - 2] : slots[i - 1]);
      const auto at =
          static_cast<std::uint32_t>(std::ranges::find(ranked_, slot) - ranked_.begin());
      if (!ranked_.empty() && coder_.bit(at < ranked_.size(), step_[stepped]) != 0) {
        const std::uint32_t told = places_.code(coder_, at);
        if (told >= ranked_.size()) return false;
        slot = ranked_[told];
        stepped = 1;
      } else {
        slot = coder_.raw(slot, bits);
        stepped = 0;
      }
      if (overrun() || slot >= slots.size() || taken_[slot]++ != 0) return false;
    }
    return true;
  }

 private:
  // The neighbours of `last` that have not been met, those nearest to straight on from `before`
  // first.
  void rank(VertexId last, VertexId before) {
    const LatticePoint& p = mesh_.points[last];
    const LatticePoint& q = mesh_.points[before];
    ranked_.clear();
    for (const VertexId v : neighbours_.of(last))
      if (taken_[v] == 0) ranked_.push_back(v);
    const auto distance = [&](VertexId v) {
      std::int64_t sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t d = std::int64_t{mesh_.points[v][a]} - 2 * std::int64_t{p[a]} + q[a];
        sum += d * d;
      }
      return sum;
    };
    std::ranges::sort(ranked_, [&](VertexId a, VertexId b) {
      return std::pair(distance(a), a) < std::pair(distance(b), b);
    });
  }

  Coder& coder_;
  const DecodedMesh& mesh_;
  Neighbours neighbours_;
  std::vector<std::uint8_t> taken_;
  std::vector<VertexId> ranked_;
  std::array<BitModel, 2> step_;  // whether the one before was a step
  NumberModel places_;
};

Tetrahedron sortedCell(Tetrahedron cell) {
  std::ranges::sort(cell);
  return cell;
}

/// Whether sorting the four different numbers takes an odd number of swaps.
bool isOdd(const Tetrahedron& cell) {
  int inversions = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) inversions += cell[j] > cell[i];
  return inversions % 2 != 0;
}

/// The even permutations of four, then the odd ones: row r and r + 12 differ in their last two.
constexpr std::array<std::array<std::uint8_t, 4>, 12> kEven{{{0, 1, 2, 3},
                                                             {0, 2, 3, 1},
                                                             {0, 3, 1, 2},
                                                             {1, 0, 3, 2},
                                                             {1, 2, 0, 3},
                                                             {1, 3, 2, 0},
                                                             {2, 0, 1, 3},
                                                             {2, 1, 3, 0},
                                                             {2, 3, 0, 1},
                                                             {3, 0, 2, 1},
                                                             {3, 1, 0, 2},
                                                             {3, 2, 1, 0}}};

Tetrahedron permuted(const Tetrahedron& sorted, std::uint32_t row) {
  const auto& e = kEven[row % 12];
  Tetrahedron out{sorted[e[0]], sorted[e[1]], sorted[e[2]], sorted[e[3]]};
  if (row >= 12) std::swap(out[2], out[3]);
  return out;
}

std::uint32_t rowOf(const Tetrahedron& sorted, const Tetrahedron& cell) {
  std::uint32_t row = 0;
  while (row + 1 < 24 && permuted(sorted, row) != cell) ++row;
  return row;
}

/// A number below 16 as a tree of decisions.
struct RowModel {
  std::array<BitModel, 16> node;

  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    std::uint32_t at = 1;
    for (int i = 3; i >= 0; --i)
      at = at * 2 +
           static_cast<std::uint32_t>(coder.bit(static_cast<int>(value >> i & 1), node[at]));
    return at - 16;
  }
};

/// Codes each cell by its rank among all cells in the order of their vertices' input numbers. Where
/// cells were made in a pattern, the steps between ranks repeat, and so do the orders of vertices.
template <class Coder>
class CellOrderCoder {
 public:
  CellOrderCoder(Coder& coder, const DecodedMesh& mesh, std::span<const VertexId> slots)
      : coder_(coder) {
    number_.resize(mesh.points.size());
    for (VertexId i = 0; i < slots.size(); ++i) number_[slots[i]] = i;
    for (const Tetrahedron& t : mesh.tetrahedra)
      own_.push_back({number_[t[0]], number_[t[1]], number_[t[2]], number_[t[3]]});
    byRank_.resize(own_.size());
    std::iota(byRank_.begin(), byRank_.end(), 0u);
    std::vector<Tetrahedron> sorted;
    for (const Tetrahedron& t : own_) sorted.push_back(sortedCell(t));
    std::ranges::sort(byRank_, [&](CellId a, CellId b) {
      return std::pair(sorted[a], a) < std::pair(sorted[b], b);
    });
    if constexpr (Coder::kEncoding) {
      rankOf_.resize(byRank_.size());
      for (std::uint32_t r = 0; r < byRank_.size(); ++r) rankOf_[byRank_[r]] = r;
    }
  }

  template <class Overrun>
  [[nodiscard]] bool run(std::vector<CellId>& cells, std::vector<Tetrahedron>& tetrahedra,
                         const Overrun& overrun) {
    std::vector<std::uint8_t> taken(cells.size(), 0);
    std::int64_t rank = -1;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::int64_t truth = 0;
      if constexpr (Coder::kEncoding) truth = rankOf_[cells[i]];
      rank += step(truth - rank);
      if (overrun() || rank < 0 || rank >= static_cast<std::int64_t>(cells.size()) ||
          taken[static_cast<std::size_t>(rank)]++ != 0)
        return false;
      cells[i] = byRank_[static_cast<std::size_t>(rank)];
      if (!vertices(own_[cells[i]], tetrahedra[i], before)) return false;
    }
    return true;
  }

 private:
  // The step that followed the same three steps last, or any.
  std::int64_t step(std::int64_t truth) {
    Known& known = known_[last_[0] * 0x9E3779B97F4A7C15ull ^ last_[1] * 0xC2B2AE3D27D4EB4Full ^
                          last_[2] * 0x165667B19E3779F9ull];
    const std::size_t trust = std::min<std::size_t>(known.hits, 7);
    std::int64_t out = known.step;
    if (coder_.bit(truth == known.step, repeats_[trust][lastRepeated_]) != 0) {
      if (known.hits < 7) ++known.hits;
      lastRepeated_ = 1;
    } else {
      const bool negative = coder_.bit(truth < 0, negative_) != 0;
      const auto size = static_cast<std::int64_t>(
          sizes_.code(coder_, static_cast<std::uint32_t>(truth < 0 ? -truth : truth)));
      out = negative ? -size : size;
      known = {out, 0};
      lastRepeated_ = 0;
    }
    last_ = {static_cast<std::uint64_t>(out), last_[0], last_[1]};
    return out;
  }

  // Even or odd against the decoder's cell, which is positive; then which of the twelve.
  bool vertices(const Tetrahedron& own, Tetrahedron& truth, std::uint32_t& before) {
    const Tetrahedron sorted = sortedCell(own);
    std::uint32_t row = 0;
    if constexpr (Coder::kEncoding) row = rowOf(sorted, truth);
    const bool turned = coder_.bit((row >= 12) != isOdd(own), turned_) != 0;
    row = rows_[before].code(coder_, row % 12);
    if (row >= 12) return false;
    before = row;
    truth = permuted(sorted, turned != isOdd(own) ? row + 12 : row);
    return true;
  }

  struct Known {
    std::int64_t step = 1;
    std::size_t hits = 0;
  };

  Coder& coder_;
  std::vector<VertexId> number_;  // slot -> input's point
  std::vector<Tetrahedron> own_;  // the decoder's cells in input numbers
  std::vector<CellId> byRank_;
  std::vector<std::uint32_t> rankOf_;
  std::unordered_map<std::uint64_t, Known> known_;
  std::array<std::uint64_t, 3> last_{};
  std::array<std::array<BitModel, 2>, 8> repeats_;
  std::size_t lastRepeated_ = 0;
  BitModel negative_, turned_;
  NumberModel sizes_;
  std::array<RowModel, 12> rows_;
};

}  // namespace

Bytes encodePointOrder(const DecodedMesh& mesh, std::span<const VertexId> slots) {
  assert(slots.size() == mesh.points.size());
  RangeEncoder encoder;
  std::vector<VertexId> order(slots.begin(), slots.end());
  (void)PointOrderCoder<RangeEncoder>(encoder, mesh).run(order, [] { return false; });
  return encoder.finish();
}

Result<std::vector<VertexId>> decodePointOrder(const DecodedMesh& mesh, ByteView bytes) {
  RangeDecoder decoder(bytes);
  std::vector<VertexId> slots(mesh.points.size(), kGhost);
  if (!PointOrderCoder<RangeDecoder>(decoder, mesh).run(slots, [&] { return decoder.overrun(); }) ||
      !decoder.atEnd())
    return bad();
  return slots;
}

Bytes encodeCellOrder(const DecodedMesh& mesh, const InputOrder& order) {
  assert(order.points.size() == mesh.points.size());
  assert(order.cells.size() == mesh.tetrahedra.size());
  assert(order.tetrahedra.size() == mesh.tetrahedra.size());
  RangeEncoder encoder;
  InputOrder copy = order;
  (void)CellOrderCoder<RangeEncoder>(encoder, mesh, order.points)
      .run(copy.cells, copy.tetrahedra, [] { return false; });
  return encoder.finish();
}

Status decodeCellOrder(const DecodedMesh& mesh, ByteView bytes, InputOrder& order) {
  assert(order.points.size() == mesh.points.size());
  RangeDecoder decoder(bytes);
  order.cells.assign(mesh.tetrahedra.size(), 0);
  order.tetrahedra.assign(mesh.tetrahedra.size(), {});
  if (!CellOrderCoder<RangeDecoder>(decoder, mesh, order.points)
           .run(order.cells, order.tetrahedra, [&] { return decoder.overrun(); }) ||
      !decoder.atEnd())
    return bad();
  return {};
}

}  // namespace qtet

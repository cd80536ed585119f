// From labels to the cells that a split brings back (FORMAT.md, "Deleted cells"). The labels of a
// link imply them in nearly every record; an escape flag and a few decisions code the rest.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/range_coder.h"
#include "codec/mesh/link.h"
#include "proto/limits.h"

namespace qtet {

/// A vertex of a cell to be restored: a local link id, or kPreyBit | prey index.
using LocalVertex = std::uint32_t;
inline constexpr LocalVertex kPreyBit = 0x80000000u;
using LocalCell = std::array<LocalVertex, 4>;

[[nodiscard]] inline LocalCell sorted(LocalCell cell) {
  std::ranges::sort(cell);
  return cell;
}

struct DeletedModels {
  std::array<BitModel, 5> escape;                 // by k
  std::array<BitModel, 5> diagonal;               // by k
  std::array<std::array<BitModel, 4>, 5> detour;  // by k and detours so far
  std::array<BitModel, 5> which, second, hidden;  // by k
};

/// Derives the deleted cells of one record, each oriented as a positive cell, in a fixed order.
/// `Truth` is the sorted list of sorted cells for an encoder, empty for a decoder. REQUIRES link
/// closed, of at most kMaxLinkTriangles, and every triangle labelled below k.
template <class Coder>
class DeletedCells {
 public:
  DeletedCells(Coder& coder, DeletedModels& models, const Link& link, int k,
               std::span<const LocalCell> truth, std::vector<LocalCell>& out)
      : coder_(coder), models_(models), link_(link), k_(k), truth_(truth), out_(out) {
    assert(link.triangles().size() <= kMaxLinkTriangles && k >= 2 && k <= 4);
  }

  /// `escape`: the labels alone do not determine the cells. False when no split can leave this
  /// link.
  [[nodiscard]] bool derive(bool escape) {
    out_.clear();
    escape_ = escape;
    if (escape) between_.assign(link_.triangles().size(), {});
    cellsAtEdges();
    if (k_ >= 3)
      for (std::uint32_t x = 0; x < link_.vertices().size(); ++x)
        if (!cellsAtVertex(x)) return false;
    return (k_ < 4 || preyTetrahedron()) && everyPreyHasCells();
  }

 private:
  // The most letters of a walk round a vertex. Each triangle of its fan gives a label and then at
  // most two prey vertices of a detour. A walk that does not end is noticed one triangle later.
  static constexpr std::size_t kLongestWord = std::size_t{3} * (kMaxLinkTriangles + 1);
  // by edge: prey vertices between the two labels, 0 = none, else 1 + prey
  using Detour = std::array<std::array<std::uint8_t, 2>, 3>;

  static LocalVertex prey(int label) { return kPreyBit | static_cast<LocalVertex>(label); }
  [[nodiscard]] bool isTrue(LocalVertex a, LocalVertex b, LocalVertex c, LocalVertex d) const {
    return std::ranges::binary_search(truth_, sorted({a, b, c, d}));
  }
  [[nodiscard]] std::size_t K() const { return static_cast<std::size_t>(k_); }

  /// A vertex without cells costs no bits later, but every level takes time to look at it. No mesh
  /// has one, and a log of a kilobyte could bring millions.
  [[nodiscard]] bool everyPreyHasCells() const {
    const unsigned all = (1u << k_) - 1;
    unsigned seen = 0;
    for (const LinkTriangle& t : link_.triangles()) seen |= 1u << t.label;
    if (seen == all) return true;
    for (const LocalCell& cell : out_)
      for (const LocalVertex v : cell)
        if (v & kPreyBit) seen |= 1u << (v & 3);
    return seen == all;
  }

  // First the edges between two labels, without branches on which they are: one in three is, in no
  // order that a processor could guess.
  void cellsAtEdges() {
    const auto triangles = link_.triangles();
    // 4 * triangle + edge; each is met from one side
    std::array<std::uint32_t, kMaxLinkTriangles / 2 * 3 + 1> edges;
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
      for (std::uint32_t e = 0; e < 3; ++e) {
        const std::uint32_t g = triangles[f].neighbour[e];
        edges[count] = 4 * f + e;
        count += static_cast<unsigned>(g > f) &
                 static_cast<unsigned>(triangles[g].label != triangles[f].label);
      }
    std::size_t detours = 0;
    out_.reserve(count);
    for (const std::uint32_t edge : std::span(edges).first(count)) {
      const std::uint32_t f = edge / 4;
      const std::size_t e = edge % 4;
      const std::uint32_t g = triangles[f].neighbour[e];
      const std::uint32_t x = triangles[f].vertex[(e + 1) % 3];
      const std::uint32_t y = triangles[f].vertex[(e + 2) % 3];
      std::array<int, 4> path{triangles[f].label, triangles[g].label};
      const std::size_t length = escape_ && k_ >= 3 ? detour(x, y, path, detours) : 2;
      for (std::size_t i = 0; i + 1 < length; ++i)
        out_.push_back({x, y, prey(path[i]), prey(path[i + 1])});
      if (length > 2) remember(f, e, g, {x, y}, std::span(path).subspan(1, length - 2));
    }
  }

  // The prey vertices round the link edge (x, y): p .. q straight, or through one or two others.
  std::size_t detour(std::uint32_t x, std::uint32_t y, std::array<int, 4>& path,
                     std::size_t& detours) {
    const int p = path[0];
    const int q = path[1];
    const int through = coder_.bit(!isTrue(x, y, prey(p), prey(q)),
                                   models_.detour[K()][std::min<std::size_t>(detours, 3)]);
    if (!through) return 2;
    ++detours;
    std::array<int, 2> others{};
    std::size_t n = 0;
    for (int c = 0; c < k_; ++c)
      if (c != p && c != q) others[n++] = c;
    int first = others[0];
    int rest = others[0];
    if (n == 2) {
      const int w = coder_.bit(isTrue(x, y, prey(p), prey(others[1])), models_.which[K()]);
      first = others[static_cast<std::size_t>(w)];
      rest = others[static_cast<std::size_t>(1 - w)];
    }
    path[1] = first;
    path[2] = q;
    if (n < 2 || !coder_.bit(!isTrue(x, y, prey(first), prey(q)), models_.second[K()])) return 3;
    path[2] = rest;
    path[3] = q;
    return 4;
  }

  void remember(std::uint32_t f, std::size_t e, std::uint32_t g, std::array<std::uint32_t, 2> edge,
                std::span<const int> inner) {
    std::size_t back = 0;
    while (link_.triangles()[g].vertex[back] == edge[0] ||
           link_.triangles()[g].vertex[back] == edge[1])
      ++back;
    for (std::size_t i = 0; i < inner.size(); ++i) {
      between_[f][e][i] = static_cast<std::uint8_t>(1 + inner[i]);
      between_[g][back][i] = static_cast<std::uint8_t>(1 + inner[inner.size() - 1 - i]);
    }
  }

  // Walks the fan of x; the word of labels that it meets bounds the triangles of prey vertices that
  // x sees.
  bool cellsAtVertex(std::uint32_t x) {
    const auto triangles = link_.triangles();
    const std::uint32_t start = link_.triangleOf(x);
    std::array<std::uint8_t, kLongestWord> word;
    std::size_t letters = 0;
    std::uint32_t f = start;
    std::size_t steps = 0;
    do {
      const LinkTriangle& t = triangles[f];
      if (letters == 0 || word[letters - 1] != t.label) word[letters++] = t.label;
      const std::size_t i = t.vertex[0] == x ? 0 : t.vertex[1] == x ? 1 : 2;
      const std::size_t e = (i + 1) % 3;  // cross the edge that misses the vertex after x
      if (escape_)
        for (const std::uint8_t inner : between_[f][e])
          if (inner) word[letters++] = static_cast<std::uint8_t>(inner - 1);
      f = t.neighbour[e];
      if (++steps > triangles.size()) return false;
    } while (f != start);
    if (letters >= 3) triangulate(std::span(word).first(letters), x);
    return true;
  }

  // A word pinched at a prey vertex is two words. A recursive call does the inner one first; it
  // holds its first letter once, so the depth is at most four. The loop goes on with the outer one,
  // since a hostile word has thousands of pinches.
  void triangulate(std::span<std::uint8_t> word, std::uint32_t x) {
    for (;;) {
      while (word.size() > 1 && word.front() == word.back()) word = word.first(word.size() - 1);
      if (word.size() < 3) return;
      const auto [first, second] = pinch(word);
      if (first == second) break;
      triangulate(word.subspan(first, second - first), x);
      // [second, end) and then [0, first)
      std::ranges::rotate(word, word.begin() + static_cast<std::ptrdiff_t>(second));
      word = word.first(word.size() - (second - first));
    }
    if (word.size() == 3)
      fillTriangle(word, x);
    else
      fillQuadrilateral(word, x);
  }

  /// The lowest place whose letter comes again, and for it the next such place; equal places: none.
  static std::pair<std::size_t, std::size_t> pinch(std::span<const std::uint8_t> word) {
    for (std::size_t i = 0; i < word.size(); ++i)
      for (std::size_t j = i + 1; j < word.size(); ++j)
        if (word[i] == word[j]) return {i, j};
    return {0, 0};
  }

  void fillTriangle(std::span<const std::uint8_t> w, std::uint32_t x) {
    const LocalVertex a = prey(w[0]);
    const LocalVertex b = prey(w[1]);
    const LocalVertex c = prey(w[2]);
    if (escape_ && k_ == 4 && coder_.bit(!isTrue(x, a, b, c), models_.hidden[K()])) {
      const LocalVertex s = prey(6 - w[0] - w[1] - w[2]);
      out_.insert(out_.end(), {{x, a, b, s}, {x, b, c, s}, {x, c, a, s}});
    } else {
      out_.push_back({x, a, b, c});
    }
  }

  void fillQuadrilateral(std::span<std::uint8_t> w, std::uint32_t x) {
    std::ranges::rotate(w, std::ranges::min_element(w));
    const std::array<LocalVertex, 4> p{prey(w[0]), prey(w[1]), prey(w[2]), prey(w[3])};
    if (coder_.bit(isTrue(x, p[0], p[1], p[2]), models_.diagonal[K()]))
      out_.insert(out_.end(), {{x, p[0], p[1], p[2]}, {x, p[0], p[2], p[3]}});
    else
      out_.insert(out_.end(), {{x, p[0], p[1], p[3]}, {x, p[1], p[2], p[3]}});
  }

  // The prey tetrahedron lies behind any (x, a, b, c): mirrored, x becomes the fourth prey vertex.
  bool preyTetrahedron() {
    for (const LocalCell& cell : out_)
      if (!(cell[0] & kPreyBit) && (cell[1] & cell[2] & cell[3] & kPreyBit)) {
        const LocalVertex s = kPreyBit | (6 - (cell[1] & 3) - (cell[2] & 3) - (cell[3] & 3));
        out_.push_back({cell[1], s, cell[2], cell[3]});
        return true;
      }
    return false;
  }

  Coder& coder_;
  DeletedModels& models_;
  const Link& link_;
  int k_;
  std::span<const LocalCell> truth_;
  std::vector<LocalCell>& out_;
  bool escape_ = false;
  std::vector<Detour> between_;
};

/// Codes the deleted cells of one record. An encoder passes the true cells (sorted list of sorted
/// cells). It gets false when no coding of this format describes them. A decoder passes none, and
/// gets false for a link that no split leaves.
template <class Coder>
[[nodiscard]] bool codeDeletedCells(Coder& coder, DeletedModels& models, const Link& link, int k,
                                    std::span<const LocalCell> truth, std::vector<LocalCell>& out) {
  bool escape = false;
  if constexpr (Coder::kEncoding) {
    const auto matches = [&](bool withEscape) {
      EchoCoder echo;
      if (!DeletedCells<EchoCoder>(echo, models, link, k, truth, out).derive(withEscape))
        return false;
      for (LocalCell& cell : out) cell = sorted(cell);
      std::ranges::sort(out);
      return std::ranges::equal(out, truth);
    };
    escape = !matches(false);
    if (escape && (k == 2 || !matches(true))) return false;
  }
  if (k >= 3) escape = coder.bit(escape, models.escape[static_cast<std::size_t>(k)]) != 0;
  return DeletedCells<Coder>(coder, models, link, k, truth, out).derive(escape);
}

}  // namespace qtet

#include "tests/support/homology.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace qtet::testing {
namespace {

using Edge = std::array<VertexId, 2>;
/// A column of a boundary matrix over Z/2: the rows that hold a one, ascending.
using Column = std::vector<std::size_t>;

template <class Simplex>
class Numbering {
 public:
  std::size_t operator[](Simplex simplex) {
    std::ranges::sort(simplex);
    return numbers_.try_emplace(simplex, numbers_.size()).first->second;
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  std::map<Simplex, std::size_t> numbers_;
};

struct Rank {
  std::int64_t rank = 0;
  std::vector<bool> pivots;  // by row
};

/// A row of one column makes that column independent of the others, and both go, which may free
/// further rows.
void collapse(std::vector<Column>& columns, Rank& out) {
  std::vector<std::set<std::size_t>> columnsOf(out.pivots.size());
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (const std::size_t row : columns[c]) columnsOf[row].insert(c);
  std::vector<std::size_t> rows(columnsOf.size());
  std::iota(rows.begin(), rows.end(), 0);
  while (!rows.empty()) {
    const std::size_t row = rows.back();
    rows.pop_back();
    if (columnsOf[row].size() != 1) continue;
    const std::size_t column = *columnsOf[row].begin();
    for (const std::size_t other : columns[column])
      columnsOf[other].erase(column), rows.push_back(other);
    columns[column].clear();
    out.pivots[row] = true;
    ++out.rank;
  }
}

/// Adds columns to one another until each has a lowest row of its own.
void eliminate(const std::vector<Column>& columns, Rank& out) {
  std::map<std::size_t, Column> byLowest;
  for (Column column : columns) {
    while (!column.empty()) {
      const auto [at, isNew] = byLowest.try_emplace(column.back(), column);
      if (isNew) break;
      Column sum;
      std::ranges::set_symmetric_difference(column, at->second, std::back_inserter(sum));
      column = std::move(sum);
    }
  }
  for (const auto& [lowest, column] : byLowest) out.pivots[lowest] = true;
  out.rank += static_cast<std::int64_t>(byLowest.size());
}

/// `dependent`: the pivots of the matrix one dimension up. A pivot's simplex closes a cycle with
/// simplices that are no pivots, so its column is a sum of theirs and may be left out.
Rank rankOf(std::vector<Column> columns, std::size_t rows,
            const std::vector<bool>& dependent = {}) {
  for (std::size_t c = 0; c < dependent.size(); ++c)
    if (dependent[c]) columns[c].clear();
  Rank out{0, std::vector<bool>(rows)};
  collapse(columns, out);
  eliminate(columns, out);
  return out;
}

template <std::size_t N>
std::array<VertexId, N - 1> without(const std::array<VertexId, N>& simplex, std::size_t corner) {
  std::array<VertexId, N - 1> out{};
  for (std::size_t i = 0, o = 0; i < N; ++i)
    if (i != corner) out[o++] = simplex[i];
  return out;
}

/// The boundary matrix: a column for each simplex, a row for each of their faces.
template <class Simplex, class Face>
std::vector<Column> boundaryMatrix(const std::vector<Simplex>& simplices, Numbering<Face>& faces,
                                   std::vector<Face>& listed) {
  std::vector<Column> columns;
  for (const Simplex& simplex : simplices) {
    Column& column = columns.emplace_back();
    for (std::size_t corner = 0; corner < simplex.size(); ++corner) {
      const Face face = without(simplex, corner);
      column.push_back(faces[face]);
      if (faces.size() > listed.size()) listed.push_back(face);
    }
    std::ranges::sort(column);
  }
  return columns;
}

}  // namespace

std::array<std::int64_t, 4> bettiNumbers(std::span<const Tetrahedron> cells) {
  Numbering<Triangle> faces;
  Numbering<Edge> edges;
  Numbering<std::array<VertexId, 1>> vertices;
  std::vector<Triangle> faceList;
  std::vector<Edge> edgeList;
  std::vector<std::array<VertexId, 1>> vertexList;
  const std::vector<Tetrahedron> cellList(cells.begin(), cells.end());
  const auto third = boundaryMatrix(cellList, faces, faceList);
  const auto second = boundaryMatrix(faceList, edges, edgeList);
  const auto first = boundaryMatrix(edgeList, vertices, vertexList);

  const Rank rank3 = rankOf(third, faces.size());
  const Rank rank2 = rankOf(second, edges.size(), rank3.pivots);
  const Rank rank1 = rankOf(first, vertices.size(), rank2.pivots);
  const auto cycles = [](std::size_t simplices, const Rank& rank) {
    return static_cast<std::int64_t>(simplices) - rank.rank;
  };
  return {cycles(vertices.size(), rank1), cycles(edges.size(), rank1) - rank2.rank,
          cycles(faces.size(), rank2) - rank3.rank, cycles(cells.size(), rank3)};
}

}  // namespace qtet::testing

#include "tests/support/random_solid.h"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "codec/mesh/boundary.h"
#include "tests/support/exact_geometry.h"

namespace qtet::testing {
namespace {

constexpr std::int32_t kEven = 64, kFlat = 8;  // lattice steps a cube
constexpr int kLatticeBits = 12;

using Cube = std::array<int, 3>;

class Grid {
 public:
  explicit Grid(std::uint32_t seed) : random_(seed) {
    for (std::size_t axis = 0; axis < 3; ++axis) ticks_[axis] = randomTicks();
    five_ = oneIn(2);
    keptCubes_ = pick({100, 95, 85, 70, 50, 35});
    keptCells_ = pick({100, 100, 100, 97, 85});
    for (int i = 0; i <= cubes(0); ++i)
      for (int j = 0; j <= cubes(1); ++j)
        for (int k = 0; k <= cubes(2); ++k)
          mesh_.points.push_back({tick(0, i), tick(1, j), tick(2, k)});
    cutIntoCells();
    movePoints();
    takeOut();
  }

  RandomSolid solid() && {
    dropUnusedPoints();
    mesh_.lattice = {kLatticeBits, 1.0 / kEven, {0, 0, 0}};
    mesh_.boundary = boundaryOf(mesh_.tetrahedra);
    const bool fields = !oneIn(5);
    if (fields) addFields();
    std::string text = std::to_string(cubes(0)) + " x " + std::to_string(cubes(1)) + " x " +
                       std::to_string(cubes(2)) + " cubes of " + (five_ ? "five" : "six") +
                       " cells, " + std::to_string(keptCubes_) + " % of the cubes, " +
                       std::to_string(keptCells_) + " % of their cells" +
                       (fields ? "" : ", no fields");
    return {std::move(mesh_), std::move(text)};
  }

 private:
  [[nodiscard]] std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(random_() % n);
  }
  [[nodiscard]] bool oneIn(std::uint32_t n) { return below(n) == 0; }
  [[nodiscard]] bool percent(int chance) { return static_cast<int>(below(100)) < chance; }
  [[nodiscard]] int pick(const std::vector<int>& choices) {
    return choices[below(static_cast<std::uint32_t>(choices.size()))];
  }
  [[nodiscard]] int cubes(std::size_t axis) const {
    return static_cast<int>(ticks_[axis].size()) - 1;
  }
  [[nodiscard]] std::int32_t tick(std::size_t axis, int i) const {
    return ticks_[axis][static_cast<std::size_t>(i)];
  }

  std::vector<std::int32_t> randomTicks() {
    const int kind = pick({0, 0, 1, 2});  // even, even, graded, flat
    std::int32_t step = kind == 0 ? kEven : kFlat;
    std::vector<std::int32_t> out{0};
    for (int n = pick({2, 3, 4, 5, 6}); n > 0; --n) {
      out.push_back(out.back() + step);
      if (kind == 1) step += step / 2;
    }
    return out;
  }

  [[nodiscard]] VertexId vertex(const Cube& at) const {
    return static_cast<VertexId>((at[0] * (cubes(1) + 1) + at[1]) * (cubes(2) + 1) + at[2]);
  }

  void addCell(std::size_t cube, Tetrahedron t) {
    if (volumeOf(t) < 0) std::swap(t[2], t[3]);
    mesh_.tetrahedra.push_back(t);
    cubeOf_.push_back(cube);
  }

  /// Paths along the cube's edges from its lowest corner to its highest, one for each order of the
  /// axes.
  void addSix(std::size_t cube, const Cube& low) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
      Cube at = low;
      Tetrahedron t{vertex(at)};
      for (std::size_t s = 0; s < 3; ++s) ++at[axes[s]], t[s + 1] = vertex(at);
      addCell(cube, t);
    } while (std::ranges::next_permutation(axes).found);
  }

  /// Four corners cut off and the middle one; mirrored from cube to cube, so that the diagonals of
  /// neighbours agree.
  void addFive(std::size_t cube, const Cube& low) {
    const bool odd = (low[0] + low[1] + low[2]) % 2 != 0;
    const auto corner = [&](int bits) {
      return vertex({low[0] + (((bits & 1) != 0) != odd), low[1] + (bits >> 1 & 1),
                     low[2] + (bits >> 2 & 1)});
    };
    for (const auto& t :
         {std::array{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}})
      addCell(cube, {corner(t[0]), corner(t[1]), corner(t[2]), corner(t[3])});
  }

  void cutIntoCells() {
    std::size_t cube = 0;
    for (int i = 0; i < cubes(0); ++i)
      for (int j = 0; j < cubes(1); ++j)
        for (int k = 0; k < cubes(2); ++k, ++cube)
          five_ ? addFive(cube, {i, j, k}) : addSix(cube, {i, j, k});
  }

  [[nodiscard]] std::int64_t volumeOf(const Tetrahedron& t) const {
    std::array<Point, 4> p;
    std::ranges::transform(t, p.begin(), [&](VertexId v) {
      return Point{mesh_.points[v][0], mesh_.points[v][1], mesh_.points[v][2]};
    });
    return volume6Of(p[0], p[1], p[2], p[3]);
  }

  /// By up to a third of a spacing on each axis that the point lies inside of; back again where
  /// that turns a cell over.
  void movePoints() {
    std::vector<std::vector<Tetrahedron>> stars(mesh_.points.size());
    for (const Tetrahedron& t : mesh_.tetrahedra)
      for (const VertexId v : t) stars[v].push_back(t);
    for (int i = 0; i <= cubes(0); ++i)
      for (int j = 0; j <= cubes(1); ++j)
        for (int k = 0; k <= cubes(2); ++k) {
          const Cube at{i, j, k};
          LatticePoint& p = mesh_.points[vertex(at)];
          const LatticePoint old = p;
          for (std::size_t axis = 0; axis < 3; ++axis)
            if (at[axis] > 0 && at[axis] < cubes(axis))
              p[axis] += moveBy((tick(axis, at[axis]) - tick(axis, at[axis] - 1)) / 3);
          if (std::ranges::any_of(stars[vertex(at)],
                                  [&](const Tetrahedron& t) { return volumeOf(t) <= 0; }))
            p = old;
        }
  }

  [[nodiscard]] std::int32_t moveBy(std::int32_t most) {
    return static_cast<std::int32_t>(below(static_cast<std::uint32_t>(2 * most + 1))) - most;
  }

  void takeOut() {
    std::vector<bool> kept(cubeOf_.back() + 1);
    for (std::size_t cube = 0; cube < kept.size(); ++cube) kept[cube] = percent(keptCubes_);
    kept[below(static_cast<std::uint32_t>(kept.size()))] = true;
    std::vector<Tetrahedron> cells;
    for (std::size_t c = 0; c < mesh_.tetrahedra.size(); ++c)
      if (kept[cubeOf_[c]] && (cells.empty() || percent(keptCells_)))
        cells.push_back(mesh_.tetrahedra[c]);
    mesh_.tetrahedra = std::move(cells);
  }

  void dropUnusedPoints() {
    std::vector<VertexId> number(mesh_.points.size(), kGhost);
    std::vector<LatticePoint> points;
    for (Tetrahedron& t : mesh_.tetrahedra)
      for (VertexId& v : t) {
        if (number[v] == kGhost)
          number[v] = static_cast<VertexId>(points.size()), points.push_back(mesh_.points[v]);
        v = number[v];
      }
    mesh_.points = std::move(points);
  }

  void addFields() {
    mesh_.fields = {{"Height", 1, "float32", "point", 12, 0.25, {-3}, {-3, 1020}},
                    {"Swirl", 3, "float64", "point", 10, 0.5, {0, 0, -1}, {0, 900}}};
    mesh_.values.resize(2);
    for (const LatticePoint& p : mesh_.points) {
      mesh_.values[0].push_back((p[0] * p[0] + 3 * p[2]) % 4096);
      for (const std::int32_t x : {p[1], 512 + (p[2] - p[0]) / 4, p[0] / 2})
        mesh_.values[1].push_back(x % 1024);
    }
  }

  std::mt19937 random_;
  std::array<std::vector<std::int32_t>, 3> ticks_;
  bool five_ = false;
  int keptCubes_ = 100, keptCells_ = 100;  // per cent
  LatticeMesh mesh_;
  std::vector<std::size_t> cubeOf_;  // by cell
};

}  // namespace

RandomSolid randomSolid(std::uint32_t seed) { return Grid(seed).solid(); }

}  // namespace qtet::testing

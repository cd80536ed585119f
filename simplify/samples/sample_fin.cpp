#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codec/coding/float_rounding.h"
#include "simplify/samples/fin_flow.h"
#include "simplify/samples/samples.h"

// The grid is a surface of triangles over half a cube, blown up to the fin (inner shell) and to the
// domain's edge (outer shell). Between the shells lie layers of prisms, three tetrahedra each.

namespace qtet {
namespace {

/// How many quads along x and y, along z, and layers; the usual size and the shape of all others.
struct Grid {
  VertexId across = 18;
  VertexId up = 16;
  VertexId layers = 24;

  [[nodiscard]] std::uint64_t cells() const {
    return 6 * std::uint64_t{layers} *
           (4 * std::uint64_t{up} * across + std::uint64_t{across} * across);
  }
};
constexpr double kLayerGrowth = 1.17;  ///< from layer to layer of the usual size
/// That of the fewest layers is less.
constexpr double kMaxLayerGrowth = 4;
/// The smallest size: with fewer the fin has no edges.
constexpr VertexId kMinAcross = 4;
constexpr Position kOuterHalfAxes{4.2, 2.6, 3.4};
/// The outer shell reaches further downstream than upstream; less than the difference of the half
/// axes, or shells would cross.
constexpr double kOuterShift = 2.7;

struct CubeSurface {
  std::vector<Position> directions;  ///< on the unit superellipsoid x^4 + y^4 + z^4 = 1, z >= 0
  std::vector<Triangle> triangles;   ///< counter-clockwise seen from outside
};

double fourthPower(double x) { return x * x * x * x; }

Grid gridOf(std::uint64_t cells) {
  constexpr Grid kUsual;
  const auto sized = [&](VertexId across) {
    const auto scaled = [&](VertexId count) {
      return (count * across + kUsual.across / 2) / kUsual.across;
    };
    return Grid{across, scaled(kUsual.up), scaled(kUsual.layers)};
  };
  Grid grid = sized(kMinAcross);
  while (grid.cells() < cells) grid = sized(grid.across + 1);
  return grid;
}

Position directionAt(const Grid& grid, VertexId i, VertexId j, VertexId k) {
  const auto side = [&](VertexId n) {
    const double s = 2.0 * n / grid.across - 1;
    return s * (0.8 + 0.2 * s * s);  // evens out the angles, as a tangent would
  };
  const double up = static_cast<double>(k) / grid.up;
  Position d{side(i), side(j), up * (0.35 + 0.65 * up)};  // finer near the plate
  const double length =
      std::sqrt(std::sqrt(fourthPower(d[0]) + fourthPower(d[1]) + fourthPower(d[2])));
  for (double& x : d) x /= length;
  return d;
}

/// Numbers the cube's surface points as they are first named.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(const Grid& grid)
      : grid_(grid),
        ids_(std::size_t{grid.across + 1} * (grid.across + 1) * (grid.up + 1), kGhost) {}
  /// Two triangles for the quad (a, b, c, d) of cube points, in either rotation.
  void addQuad(std::array<std::array<VertexId, 3>, 4> corners) {
    std::array<VertexId, 4> v;
    for (std::size_t n = 0; n < 4; ++n) v[n] = vertex(corners[n]);
    // Diagonals that alternate favour no direction.
    if ((corners[0][0] + corners[0][1] + corners[0][2]) % 2)
      std::rotate(v.begin(), v.begin() + 1, v.end());
    add({v[0], v[1], v[2]});
    add({v[0], v[2], v[3]});
  }
  [[nodiscard]] CubeSurface take() { return std::move(surface_); }

 private:
  VertexId vertex(const std::array<VertexId, 3>& p) {
    VertexId& id =
        ids_[(std::size_t{p[2]} * (grid_.across + 1) + p[1]) * (grid_.across + 1) + p[0]];
    if (id == kGhost) {
      id = static_cast<VertexId>(surface_.directions.size());
      surface_.directions.push_back(directionAt(grid_, p[0], p[1], p[2]));
    }
    return id;
  }
  void add(Triangle t) {
    const Position &a = surface_.directions[t[0]], &b = surface_.directions[t[1]],
                   &c = surface_.directions[t[2]];
    const double outward = (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
                           (a[0] * b[1] - a[1] * b[0]) * c[2];
    if (outward < 0) std::swap(t[1], t[2]);
    surface_.triangles.push_back(t);
  }

  Grid grid_;
  CubeSurface surface_;
  std::vector<VertexId> ids_;
};

CubeSurface halfCube(const Grid& grid) {
  SurfaceBuilder builder(grid);
  for (VertexId k = 0; k < grid.up; ++k) {
    for (VertexId n = 0; n < grid.across; ++n) {
      for (const VertexId wall : {VertexId{0}, grid.across}) {
        builder.addQuad({{{wall, n, k}, {wall, n + 1, k}, {wall, n + 1, k + 1}, {wall, n, k + 1}}});
        builder.addQuad({{{n, wall, k}, {n + 1, wall, k}, {n + 1, wall, k + 1}, {n, wall, k + 1}}});
      }
    }
  }
  const VertexId top = grid.up;
  for (VertexId j = 0; j < grid.across; ++j) {
    for (VertexId i = 0; i < grid.across; ++i)
      builder.addQuad({{{i, j, top}, {i + 1, j, top}, {i + 1, j + 1, top}, {i, j + 1, top}}});
  }
  return builder.take();
}

double power(double x, VertexId n) {
  double out = 1;
  for (VertexId i = 0; i < n; ++i) out *= x;
  return out;
}

/// The growth a layer for which the last layer is as much thicker than the first as in the usual
/// size, by bisection.
double layerGrowth(const Grid& grid) {
  constexpr Grid kUsual;
  if (grid.layers == kUsual.layers) return kLayerGrowth;
  const double whole = power(kLayerGrowth, kUsual.layers);
  double low = 1, high = grid.layers < kUsual.layers ? kMaxLayerGrowth : kLayerGrowth;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (power(middle, grid.layers) < whole ? low : high) = middle;
  }
  return low;
}

/// 0 at the fin, 1 at the outer shell, growing from layer to layer.
std::vector<double> layerHeights(const Grid& grid) {
  std::vector<double> heights{0};
  const double growth = layerGrowth(grid);
  double thickness = 1;
  for (VertexId layer = 0; layer < grid.layers; ++layer, thickness *= growth)
    heights.push_back(heights.back() + thickness);
  for (double& height : heights) height /= heights.back();
  return heights;
}

Position pointAt(const Position& direction, double height) {
  Position p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = direction[k] * (kFinHalfAxes[k] + height * (kOuterHalfAxes[k] - kFinHalfAxes[k]));
  p[0] += height * kOuterShift + kFinSweep * p[2];
  for (double& x : p) x = roundedToFloat(x);
  return p;
}

double distance(const Position& p, const Position& q) {
  const Position d{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// A triangle's prism between two layers. Each side's diagonal runs from its lower-numbered lower
/// corner up, so neighbours agree on it.
void addPrism(Triangle t, VertexId lower, VertexId upper, std::vector<Tetrahedron>& out) {
  bool even = true;
  const auto order = [&](VertexId& a, VertexId& b) {
    if (a < b) return;
    std::swap(a, b);
    even = !even;
  };
  order(t[0], t[1]);
  order(t[1], t[2]);
  order(t[0], t[1]);
  std::array<Tetrahedron, 3> cells{{{lower + t[0], lower + t[1], lower + t[2], upper + t[2]},
                                    {lower + t[0], lower + t[1], upper + t[2], upper + t[1]},
                                    {lower + t[0], upper + t[0], upper + t[1], upper + t[2]}}};
  for (Tetrahedron& cell : cells) {
    if (!even) std::swap(cell[2], cell[3]);
    out.push_back(cell);
  }
}

/// The shock's way, in the fin's half lengths, and the bends that the wake sheds meanwhile.
constexpr double kShockWay = 1.2, kShedBends = 2;

/// The grid with the fields of each phase; `suffix` comes behind the names of a phase's fields.
struct Instant {
  std::string suffix;
  FlowPhase phase;
};
/// The cells of the layers from `begin` to `end`.
TetMesh finMesh(const Grid& grid, VertexId begin, VertexId end,
                const std::vector<Instant>& instants) {
  const CubeSurface surface = halfCube(grid);
  const auto perLayer = static_cast<VertexId>(surface.directions.size());

  TetMesh mesh;
  for (const Instant& instant : instants)
    for (const auto& [name, components] :
         {std::pair{"Density", 1u}, {"Pressure", 1u}, {"Velocity", 3u}})
      mesh.fields.push_back({name + instant.suffix, components, "float32", {}});
  const std::vector<double> heights = layerHeights(grid);
  for (const double height : std::span(heights).subspan(begin, end - begin + 1)) {
    for (const Position& direction : surface.directions) {
      const Position p = pointAt(direction, height);
      mesh.points.push_back(p);
      for (std::size_t i = 0; i < instants.size(); ++i) {
        const FlowState flow = finFlowAt(p, distance(p, pointAt(direction, 0)), instants[i].phase);
        MeshField* fields = &mesh.fields[3 * i];
        fields[0].values.push_back(roundedToFloat(flow.density));
        fields[1].values.push_back(roundedToFloat(flow.pressure));
        for (const double component : flow.velocity)
          fields[2].values.push_back(roundedToFloat(component));
      }
    }
  }
  for (VertexId layer = 0; layer < end - begin; ++layer) {
    for (const Triangle& t : surface.triangles)
      addPrism(t, layer * perLayer, (layer + 1) * perLayer, mesh.tetrahedra);
  }
  return mesh;
}

}  // namespace

TetMesh finSample(std::uint64_t cells) {
  const Grid grid = gridOf(cells);
  return finMesh(grid, 0, grid.layers, {{"", {}}});
}

std::uint32_t finLayers(std::uint64_t cells) { return gridOf(cells).layers; }

TetMesh finPiece(std::uint64_t cells, std::uint32_t piece, std::uint32_t pieces) {
  const Grid grid = gridOf(cells);
  assert(piece < pieces && pieces <= grid.layers);
  const auto layer = [&](std::uint64_t i) {
    return static_cast<VertexId>(i * grid.layers / pieces);
  };
  return finMesh(grid, layer(piece), layer(piece + std::uint64_t{1}), {{"", {}}});
}

TetMesh finSeries(std::uint64_t cells, std::uint32_t instants) {
  std::vector<Instant> phases;
  for (std::uint32_t i = 0; i < instants; ++i) {
    const double left = 1 - static_cast<double>(i) / (instants - 1);
    phases.push_back({"@" + std::to_string(i), {kShockWay * left * left, kShedBends * (1 - left)}});
  }
  const Grid grid = gridOf(cells);
  return finMesh(grid, 0, grid.layers, phases);
}

}  // namespace qtet

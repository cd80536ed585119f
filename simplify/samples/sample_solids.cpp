// Solids that are bent from a grid of cubes, with fields by textbook formulas: pictures, not
// predictions. All of them are in + - * / sqrt.
#include <algorithm>
#include <cmath>

#include "codec/coding/float_rounding.h"
#include "simplify/samples/cube_grid.h"
#include "simplify/samples/samples.h"

namespace qtet {
namespace {

using Pair = std::array<double, 2>;

/// A unit vector at so many turns, to six digits.
Pair turned(double turns) {
  turns -= std::floor(turns);
  const double quarters = 4 * turns, quarter = std::floor(quarters);
  const double half = (quarters - quarter) * 0.78539816339744831;       // of the angle, in radians
  const double k = half * (15 - half * half) / (15 - 6 * half * half);  // its tangent, by Padé
  Pair v{(1 - k * k) / (1 + k * k), 2 * k / (1 + k * k)};
  for (double q = 0; q < quarter; ++q) v = {-v[1], v[0]};
  return v;
}

/// A point of the square [-1, 1]^2 in the disc of radius 1: the square's sides become the circle.
Pair inDisc(double a, double b) {
  const double side = std::max(std::abs(a), std::abs(b));
  if (side == 0) return {0, 0};
  const double onCircle = side / std::sqrt(a * a + b * b);
  const double scale = 0.8 * (1 - side) + side * onCircle;
  return {a * scale, b * scale};
}

double lengthOf(const Position& p) { return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }

/// A solid while it is made: points and the values of its point fields.
class Solid {
 public:
  Solid(const CubeGrid& grid, std::vector<MeshField> fields) : grid_(grid) {
    mesh_.fields = std::move(fields);
  }

  /// `make(unit, add)` gives add(field, value) what it has at `unit` in [0, 1]^3, component by
  /// component, and returns the place.
  template <class Make>
  TetMesh made(const Make& make) && {
    grid_.forEachPoint([&](const std::array<VertexId, 3>& at) {
      Position unit;
      for (std::size_t k = 0; k < 3; ++k) unit[k] = static_cast<double>(at[k]) / grid_.cubes[k];
      Position p = make(unit, [&](std::size_t field, double value) {
        mesh_.fields[field].values.push_back(roundedToFloat(value));
      });
      for (double& x : p) x = roundedToFloat(x);
      mesh_.points.push_back(p);
    });
    mesh_.tetrahedra = grid_.cells();
    return std::move(mesh_);
  }

 private:
  CubeGrid grid_;
  TetMesh mesh_;
};

MeshField scalars(const char* name) { return {name, 1, "float32", {}}; }
MeshField vectors(const char* name) { return {name, 3, "float32", {}}; }

}  // namespace

namespace {

constexpr double kBeamLength = 10, kBeamWidth = 1, kBeamHeight = 1.6, kBeamStiffness = 2e5;
constexpr double kBeamInertia = kBeamWidth * kBeamHeight * kBeamHeight * kBeamHeight / 12;
constexpr VertexId kBeamColumns = 80;
constexpr CubeGrid kBeamGrid{{kBeamColumns, 10, 14}};

Position beamPoint(const Position& u) {
  return {kBeamLength * u[0], kBeamWidth * (u[1] - 0.5), kBeamHeight * (u[2] - 0.5)};
}

/// The von Mises stress under a load at the free end.
double beamStress(const Position& p, double load) {
  const double bending = load * (kBeamLength - p[0]) * p[2] / kBeamInertia;
  const double shear = load / (2 * kBeamInertia) * (kBeamHeight * kBeamHeight / 4 - p[2] * p[2]);
  return std::sqrt(bending * bending + 3 * shear * shear);
}

/// A column of the bent beam: where its axis is, and the unit vector along it; x and z of both.
struct BeamColumn {
  Pair place{}, along{};
};

/// The columns where the free end's slope is so many turns. The slope grows along the beam as Euler
/// and Bernoulli's formula says; the axis keeps its length.
std::vector<BeamColumn> bentBeam(double turns) {
  const auto along = [turns](double share) {
    const Pair v = turned(turns * share * (2 - share));
    return Pair{v[0], -v[1]};
  };
  std::vector<BeamColumn> columns;
  columns.push_back({{0, 0}, along(0)});
  for (VertexId i = 1; i <= kBeamColumns; ++i) {
    const BeamColumn& last = columns.back();
    BeamColumn next{last.place, along(static_cast<double>(i) / kBeamColumns)};
    const Pair middle = along((i - 0.5) / kBeamColumns);
    for (std::size_t k = 0; k < 2; ++k)  // by Simpson's rule
      next.place[k] +=
          kBeamLength / kBeamColumns * (last.along[k] + 4 * middle[k] + next.along[k]) / 6;
    columns.push_back(next);
  }
  return columns;
}

/// The load's share `time` (0..1) after it was put on at once: the beam goes beyond its place,
/// swings twice, and comes to rest.
double swingAt(double time) {
  const double left = 1 - time;
  return 1 - left * left * turned(2 * time)[0];
}

}  // namespace

TetMesh beamSample() {
  constexpr double kLoad = 40;
  return Solid(kBeamGrid, {scalars("VonMises"), vectors("Displacement")})
      .made([&](const Position& u, const auto& add) {
        const Position p = beamPoint(u);
        const double slope =
            -kLoad * p[0] * (2 * kBeamLength - p[0]) / (2 * kBeamStiffness * kBeamInertia);
        const double sag =
            -kLoad * p[0] * p[0] * (3 * kBeamLength - p[0]) / (6 * kBeamStiffness * kBeamInertia);
        add(0, beamStress(p, kLoad));
        for (const double d : {-slope * p[2], 0.0, sag}) add(1, d);
        return p;
      });
}

TetMesh beamSeries(std::uint32_t instants) {
  // the load whose slope at the free end is one radian
  constexpr double kLoad = 2 * kBeamStiffness * kBeamInertia / (kBeamLength * kBeamLength);
  constexpr double kTurns = 0.15915494309189535;
  std::vector<MeshField> fields;
  std::vector<double> shares;
  std::vector<std::vector<BeamColumn>> bent;
  for (std::uint32_t i = 0; i < instants; ++i) {
    for (MeshField field : {scalars("VonMises"), vectors("Displacement")}) {
      field.name = field.name.at(std::to_string(i));
      fields.push_back(std::move(field));
    }
    shares.push_back(swingAt(static_cast<double>(i) / (instants - 1)));
    bent.push_back(bentBeam(kTurns * shares.back()));
  }
  return Solid(kBeamGrid, std::move(fields)).made([&](const Position& u, const auto& add) {
    const Position p = beamPoint(u);
    const auto column = static_cast<std::size_t>(std::lround(u[0] * kBeamColumns));
    const double restX = kBeamLength / kBeamColumns * static_cast<double>(column);
    for (std::size_t i = 0; i < instants; ++i) {
      const auto& [place, along] = bent[i][column];
      add(2 * i, beamStress(p, kLoad * shares[i]));
      // sections stay plain, and upright on the axis
      for (const double d :
           {place[0] - restX - p[2] * along[1], 0.0, place[1] + p[2] * (along[0] - 1)})
        add(2 * i + 1, d);
    }
    return p;
  });
}

TetMesh springSample() {
  constexpr double kRadius = 2, kWire = 0.4, kTurns = 3.5, kPitch = 1.3, kSag = 0.8;
  return Solid({{280, 8, 8}}, {scalars("ShearStress"), vectors("Displacement")})
      .made([&](const Position& u, const auto& add) {
        const Pair out = turned(kTurns * u[0]);
        const Pair across = inDisc(2 * u[1] - 1, 2 * u[2] - 1);
        const double inward = kWire * across[0], up = kWire * across[1];
        const double radius = kRadius - inward;
        // Torsion grows to the wire's surface, and on the coil's inner side.
        const double fromAxis = std::sqrt(across[0] * across[0] + across[1] * across[1]);
        add(0, fromAxis * kRadius / radius + 0.25 * (1 - fromAxis * fromAxis));
        for (const double d :
             {-0.1 * kSag * u[0] * out[1], 0.1 * kSag * u[0] * out[0], -kSag * u[0]})
          add(1, d);
        return Position{radius * out[0], radius * out[1], kPitch * kTurns * u[0] + up};
      });
}

TetMesh ballSample() {
  constexpr VertexId kCubes = 24;
  constexpr std::array<Position, 5> kPlumes{
      {{1, 0, 0.2}, {-0.5, 0.8, 0.3}, {-0.4, -0.7, 0.6}, {0.2, 0.3, -0.9}, {0.1, -0.9, -0.4}}};
  const CubeGrid grid{{kCubes, kCubes, kCubes}};
  TetMesh mesh =
      Solid(grid, {scalars("Temperature")}).made([&](const Position& u, const auto& add) {
        const Position c{2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1};
        const double side = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])});
        const double scale = side == 0 ? 0 : 0.7 * (1 - side) + side * side / lengthOf(c);
        const Position p{c[0] * scale, c[1] * scale, c[2] * scale};
        const double r = lengthOf(p);
        double hot = 0;
        for (const Position& plume : kPlumes) {
          const double along =
              (p[0] * plume[0] + p[1] * plume[1] + p[2] * plume[2]) / lengthOf(plume);
          const double off2 = std::max(0.0, r * r - along * along);
          if (along > 0) hot += along * along / (along * along + 0.05) / (1 + 60 * off2);
        }
        add(0, 300 + 2700 * (1 - r * r) / (1 + r * r) + 900 * hot * r * (1 - r));
        return p;
      });
  // Core, mantle and crust, shell by shell of cubes.
  MeshField layer{"Layer", 1, "int32", {}, "cell", {{1, "core"}, {2, "mantle"}, {3, "crust"}}};
  const CubeGrid corners{{kCubes - 1, kCubes - 1, kCubes - 1}};
  corners.forEachPoint([&](const std::array<VertexId, 3>& at) {
    VertexId depth = kCubes;
    for (const VertexId k : at) depth = std::min({depth, k, kCubes - 1 - k});
    const double number = depth < 2 ? 3 : depth < 7 ? 2 : 1;
    layer.values.insert(layer.values.end(), 6, number);
  });
  mesh.fields.push_back(std::move(layer));
  return mesh;
}

TetMesh elbowSample() {
  constexpr double kRadius = 0.5, kBend = 1.4, kStraight = 2.5;
  return Solid({{120, 10, 10}}, {scalars("Pressure"), vectors("Velocity")})
      .made([&](const Position& u, const auto& add) {
        const double way = 3 * u[0];
        const double bent = std::clamp(way - 1, 0.0, 1.0);
        const Pair along = turned(bent / 4);
        const Pair inward{-along[1], along[0]};
        const Pair across = inDisc(2 * u[1] - 1, 2 * u[2] - 1);
        const double before = kStraight * std::min(0.0, way - 1);
        const double behind = kStraight * std::max(0.0, way - 2);
        const double off = kRadius * across[0];
        const Position p{kBend * along[1] + before + behind * along[0] + off * inward[0],
                         kBend * (1 - along[0]) + behind * along[1] + off * inward[1],
                         kRadius * across[1]};
        // The stream is pushed outward in the bend, turns in two cells behind it, and calms down.
        const double fromAxis2 = across[0] * across[0] + across[1] * across[1];
        const double turning = way < 1 ? 0 : bent / (1 + 0.8 * std::max(0.0, way - 2));
        const double speed = 2 * (1 - fromAxis2) * (1 - 0.45 * turning * across[0]);
        const double inner = 0.4 * turning * (1 - fromAxis2) * (1 - 4 * across[1] * across[1]);
        const double side = 0.8 * turning * (1 - fromAxis2) * across[0] * across[1];
        const bool isBend = way > 1 && way < 2;
        add(0, 1.2 - 0.3 * way - (isBend ? 0.5 * across[0] * bent * (1 - bent) * 4 : 0));
        for (const double v :
             {speed * along[0] - inner * inward[0], speed * along[1] - inner * inward[1], side})
          add(1, v);
        return p;
      });
}

}  // namespace qtet

// Meshes that are made, not read: for trying the tool without data, for tests and for the demo. The
// same bits on every machine, because nothing but + - * / sqrt and rounding to float32 goes into
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "proto/error.h"
#include "proto/limits.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

inline constexpr std::uint64_t kBoxCells = 3072, kFinCells = 212544, kBeamCells = 67200,
                               kSpringCells = 107520, kBallCells = 82944, kElbowCells = 72000;
/// A mesh of so many cells takes 7 GB to make.
inline constexpr std::uint64_t kMaxSampleCells = 100'000'000;
/// One of so many in pieces fills a disk of 30 GB.
inline constexpr std::uint64_t kMaxCellsInPieces = 1'000'000'000;

struct Sample {
  std::string_view name;
  std::string_view description;
  /// A mesh of at least so many cells, the next size that there is.
  TetMesh (*make)(std::uint64_t cells);
  /// Its usual size and the largest; equal: there is but one.
  std::uint64_t cells, maxCells;
  /// The same with so many instants of each field, called NAME@0, NAME@1, ...; null: it is steady.
  TetMesh (*makeSeries)(std::uint64_t cells, std::uint32_t instants) = nullptr;
};

/// As many as the three fields of a sample may have.
inline constexpr std::uint32_t kMaxSampleInstants = kMaxFields / 3;

/// All samples, in the order in which help shows them.
[[nodiscard]] std::span<const Sample> samples();

/// `cells`: how many tetrahedra at least; nullopt = the sample's own size. `instants`: of a series;
/// 0 = a steady sample. Errors: not-found, with the names there are; bad-value (a size that the
/// sample does not come in, or instants of a steady one).
[[nodiscard]] Result<TetMesh> makeSample(std::string_view name,
                                         std::optional<std::uint64_t> cells = std::nullopt,
                                         std::uint32_t instants = 0);

/// The unit cube in 8 x 8 x 8 cells of 6 Kuhn tetrahedra: 729 points, 3,072 tetrahedra; field
/// Scalar = sin(2 pi x) cos(pi y) + z^2.
[[nodiscard]] TetMesh boxSample();

/// A supersonic stream round a swept blunt fin on a plate, an algebraic model of one. It has bow
/// shock, boundary layers, tip and horseshoe vortices, a meandering wake. 212,544 tetrahedra, or as
/// many as asked for, 2,400 at least, in layers that grow from the wall; fields Density, Pressure,
/// Velocity (free stream: 1, 1/1.4, Mach 2.95).
[[nodiscard]] TetMesh finSample(std::uint64_t cells = kFinCells);
/// Layers of the same, which are as many at least as it may have pieces.
[[nodiscard]] std::uint32_t finLayers(std::uint64_t cells);
/// Piece `piece` of `pieces` of the same: some layers, with all of their points. REQUIRES: piece <
/// pieces <= finLayers(cells).
[[nodiscard]] TetMesh finPiece(std::uint64_t cells, std::uint32_t piece, std::uint32_t pieces);
/// The same while the stream settles: the shock travels to its place, and the wake sheds bends.
[[nodiscard]] TetMesh finSeries(std::uint64_t cells, std::uint32_t instants);

/// A cantilever of 10 x 1 x 1.6, loaded at its free end, by Euler and Bernoulli's formulas: 67,200
/// tetrahedra; fields VonMises, Displacement.
[[nodiscard]] TetMesh beamSample();
/// The same while it swings under a load that bends it by a radian in the end, and by up to 1.6
/// meanwhile. The mesh is the straight beam; Displacement@0 is 0.
[[nodiscard]] TetMesh beamSeries(std::uint32_t instants);

/// Three and a half coils of a round wire under load: 107,520 tetrahedra; fields ShearStress,
/// Displacement.
[[nodiscard]] TetMesh springSample();

/// A ball with hot plumes: 82,944 tetrahedra; field Temperature, and the cell field Layer (1 core,
/// 2 mantle, 3 crust).
[[nodiscard]] TetMesh ballSample();

/// A pipe that turns by 90 degrees, and the flow in it: 72,000 tetrahedra; fields Pressure, and
/// Velocity (0 at the wall).
[[nodiscard]] TetMesh elbowSample();

}  // namespace qtet

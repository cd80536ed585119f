// Meshes for tests: small, on the lattice, deterministic, of any topology.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "codec/mesh/mesh.h"
#include "codec/record/fusion_history.h"

namespace qtet::testing {

/// A grid of n cubes a side, six tetrahedra each, its inner points moved at random by up to a
/// quarter of a cube. Cubes for which `keep(i, j, k)` is false are left out. This gives tunnels,
/// voids and several components. Two point fields: "Height" (a scalar) and "Swirl" (a vector).
[[nodiscard]] LatticeMesh gridMesh(
    int n, std::uint32_t seed,
    const std::function<bool(int, int, int)>& keep = [](int, int, int) { return true; });

/// The same with every value within the bits of its field, as in a log that is verified whole.
[[nodiscard]] LatticeMesh soundMesh(int n, std::uint32_t seed);

/// `n` cells round one axis, vertices 0 and 1; cell i has rim vertices 2 + i and 2 + (i + 1) % n
/// too. Everything at the axis is long, thin and askew. No fields.
[[nodiscard]] LatticeMesh fanMesh(std::uint32_t n);

/// Adds two cell fields to a gridMesh: "Region" (labels of blocks) and "Height" (two components; a
/// point field has the same name).
void addCellFields(LatticeMesh& mesh);

/// Expects all of both to be the same: what was fused, in which order and level, and what became of
/// the mesh.
void expectTheSame(const FusionHistory& history, const FusionHistory& expected);

/// The mesh that is left of a history after its last `undone` levels have been taken back, in the
/// history's numbering.
[[nodiscard]] LatticeMesh meshOfHistory(const FusionHistory& history, std::uint32_t undone);

/// Vertices - edges + faces - cells of the solid, and vertices - edges + triangles of its boundary.
[[nodiscard]] std::array<std::int64_t, 2> eulerCharacteristics(const LatticeMesh& mesh);

/// Every cell positive, no face of three cells, and `boundary` = the faces of one cell, with their
/// orientation. The text says what is wrong.
[[nodiscard]] std::string whatIsWrongWith(const LatticeMesh& mesh);

/// How far p lies outside the solid: 0 inside, else the distance to the nearest boundary triangle.
/// Brute force.
[[nodiscard]] double distanceOutside(const LatticeMesh& solid, const LatticePoint& p);

/// A small real log (gridMesh simplified and encoded into chunks of about `chunkBytes`) as the file
/// `name`.qtet in `folder`.
std::filesystem::path writeSampleLog(const std::filesystem::path& folder,
                                     const std::string& name = "sample", int n = 6,
                                     std::uint32_t seed = 1, std::uint32_t chunkBytes = 2048);

/// A folder of the test's own, emptied.
[[nodiscard]] std::filesystem::path freshFolder(const std::string& name);

}  // namespace qtet::testing

#include "tests/support/meshes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "codec/files/atomic_file.h"
#include "codec/log/log_writer.h"
#include "codec/mesh/boundary.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/predicates.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/mesh/measure_geometry.h"
#include "tests/support/written_log.h"

namespace qtet::testing {
namespace {

constexpr std::int32_t kCube = 64;  // lattice steps a cube

void addCube(LatticeMesh& mesh, const std::function<VertexId(int, int, int)>& vertex, int i, int j,
             int k) {
  static constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  // Kuhn: a path from corner to corner for each order of the axes
  for (const auto& order : kOrders) {
    std::array<int, 3> at{i, j, k};
    Tetrahedron t{vertex(at[0], at[1], at[2])};
    for (std::size_t s = 0; s < 3; ++s) {
      ++at[static_cast<std::size_t>(order[s])];
      t[s + 1] = vertex(at[0], at[1], at[2]);
    }
    if (orientation(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[2], t[3]);
    mesh.tetrahedra.push_back(t);
  }
}

void dropUnused(LatticeMesh& mesh) {
  std::vector<VertexId> renumbered(mesh.points.size(), kGhost);
  std::vector<VertexId> kept;
  for (Tetrahedron& t : mesh.tetrahedra)
    for (VertexId& v : t) {
      if (renumbered[v] == kGhost)
        renumbered[v] = static_cast<VertexId>(kept.size()), kept.push_back(v);
      v = renumbered[v];
    }
  for (Triangle& t : mesh.boundary)
    for (VertexId& v : t) v = renumbered[v];
  LatticeMesh old = mesh;
  mesh.points.clear();
  for (const VertexId v : kept) mesh.points.push_back(old.points[v]);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    if (isCellField(mesh.fields[f])) continue;
    const auto n = static_cast<std::ptrdiff_t>(mesh.fields[f].components);
    mesh.values[f].clear();
    for (const VertexId v : kept)
      mesh.values[f].insert(mesh.values[f].end(), old.values[f].begin() + v * n,
                            old.values[f].begin() + (v + 1) * n);
  }
}

}  // namespace

LatticeMesh gridMesh(int n, std::uint32_t seed, const std::function<bool(int, int, int)>& keep) {
  std::mt19937 random(seed);
  LatticeMesh mesh;
  mesh.lattice = {12, 1.0 / kCube, {0, 0, 0}};
  const auto vertex = [n](int i, int j, int k) {
    return static_cast<VertexId>((i * (n + 1) + j) * (n + 1) + k);
  };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        LatticePoint p{i * kCube, j * kCube, k * kCube};
        const std::array<int, 3> at{i, j, k};
        for (std::size_t a = 0; a < 3; ++a)
          if (at[a] > 0 && at[a] < n)
            p[a] += static_cast<std::int32_t>(random() % (kCube / 4)) - kCube / 8;
        mesh.points.push_back(p);
      }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        if (keep(i, j, k)) addCube(mesh, vertex, i, j, k);
  dropUnused(mesh);
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  mesh.fields = {{"Height", 1, "float32", "point", 12, 0.25, {-3}, {-3, 1020}},
                 {"Swirl", 3, "float64", "point", 10, 0.5, {0, 0, -1}, {0, 900}}};
  mesh.values.resize(2);
  for (const LatticePoint& p : mesh.points) {
    mesh.values[0].push_back((p[0] * p[0] + 3 * p[2]) % 4096);
    for (const std::int32_t x : {p[1], p[2] - p[0] + 500, p[0] / 2}) mesh.values[1].push_back(x);
  }
  return mesh;
}

LatticeMesh soundMesh(int n, std::uint32_t seed) {
  LatticeMesh mesh = gridMesh(n, seed);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    for (std::int32_t& value : mesh.values[f]) value &= (1 << mesh.fields[f].bits) - 1;
  return mesh;
}

LatticeMesh fanMesh(std::uint32_t n) {
  constexpr std::int32_t kRadius = 1 << 27;
  LatticeMesh mesh;
  mesh.lattice = {28, 1, {0, 0, 0}};
  mesh.points = {{kRadius, kRadius, kRadius / 2}, {kRadius, kRadius, kRadius / 2 * 3}};
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const auto at = [](double x) {
      return kRadius + static_cast<std::int32_t>(std::floor((kRadius - 1) * x));
    };
    mesh.points.push_back({at(std::cos(angle)), at(std::sin(angle)), kRadius});
    mesh.tetrahedra.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
  }
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  return mesh;
}

void addCellFields(LatticeMesh& mesh) {
  mesh.fields.push_back({"Region", 1, "uint8", "cell", 4, 1, {1}, {1, 9}});
  mesh.fields.push_back({"Height", 2, "float32", "cell", 12, 0.5, {-1, 2}, {0, 900}});
  std::vector<std::int32_t> regions, heights;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    std::array<std::int32_t, 3> sum{};
    for (const VertexId v : t)
      for (std::size_t a = 0; a < 3; ++a) sum[a] += mesh.points[v][a];
    regions.push_back((sum[0] > 6 * kCube) + 3 * (sum[2] > 9 * kCube));
    heights.push_back((sum[0] + sum[1]) / 4);
    heights.push_back((sum[2] * 7 + sum[1]) % 4096);
  }
  mesh.values.push_back(std::move(regions));
  mesh.values.push_back(std::move(heights));
}

void expectTheSame(const FusionHistory& history, const FusionHistory& expected) {
  EXPECT_EQ(history.points, expected.points);
  EXPECT_EQ(history.values, expected.values);
  EXPECT_EQ(history.cells, expected.cells);
  EXPECT_EQ(history.live, expected.live);
  EXPECT_EQ(history.affectedCells, expected.affectedCells);
  EXPECT_EQ(history.affectedLabels, expected.affectedLabels);
  EXPECT_EQ(history.deletedCells, expected.deletedCells);
  EXPECT_EQ(history.levels, expected.levels);
  ASSERT_EQ(history.fusions.size(), expected.fusions.size());
  for (std::size_t i = 0; i < expected.fusions.size(); ++i) {
    EXPECT_EQ(history.fusions[i].prey, expected.fusions[i].prey);
    EXPECT_EQ(history.fusions[i].placement, expected.fusions[i].placement);
    EXPECT_EQ(history.fusions[i].fused, expected.fusions[i].fused);
    EXPECT_EQ(history.fusions[i].level, expected.fusions[i].level);
    EXPECT_EQ(history.fusions[i].firstAffected, expected.fusions[i].firstAffected);
    EXPECT_EQ(history.fusions[i].firstDeleted, expected.fusions[i].firstDeleted);
  }
}

LatticeMesh meshOfHistory(const FusionHistory& history, std::uint32_t undone) {
  FusionHistory h = history;
  for (std::size_t i = h.fusions.size(); i-- > 0;) {
    const Fusion& f = h.fusions[i];
    if (h.levels - f.level > undone) break;
    for (std::uint32_t j = 0; j < f.affectedCount; ++j)
      std::ranges::replace(h.cells[h.affectedCells[f.firstAffected + j]], f.fused,
                           f.prey[h.affectedLabels[f.firstAffected + j]]);
    for (std::uint32_t j = 0; j < f.deletedCount; ++j)
      h.live[h.deletedCells[f.firstDeleted + j]] = 1;
  }
  LatticeMesh mesh;
  mesh.lattice = h.lattice;
  mesh.points = h.points;
  mesh.fields = h.fields;
  mesh.values = h.values;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    if (isCellField(mesh.fields[f])) mesh.values[f].clear();
  for (std::size_t c = 0; c < h.cells.size(); ++c) {
    if (!h.live[c]) continue;
    const auto ghost =
        static_cast<std::size_t>(std::ranges::find(h.cells[c], kGhost) - h.cells[c].begin());
    if (ghost == 4) {
      mesh.tetrahedra.push_back(h.cells[c]);
      for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
        if (!isCellField(mesh.fields[f])) continue;
        const std::size_t n = mesh.fields[f].components;
        for (std::size_t i = 0; i < n; ++i) mesh.values[f].push_back(h.values[f][c * n + i]);
      }
    } else {
      const auto face = withLast(h.cells[c], ghost);
      mesh.boundary.push_back({face[0], face[1], face[2]});
    }
  }
  dropUnused(mesh);
  return mesh;
}

std::array<std::int64_t, 2> eulerCharacteristics(const LatticeMesh& mesh) {
  const auto count = [](const auto& cells, std::size_t corners) {
    std::set<std::vector<VertexId>> simplices;
    for (const auto& c : cells)
      for (unsigned mask = 1; mask < (1u << corners); ++mask) {
        std::vector<VertexId> s;
        for (unsigned i = 0; i < corners; ++i)
          if (mask >> i & 1) s.push_back(c[i]);
        std::ranges::sort(s);
        simplices.insert(std::move(s));
      }
    std::int64_t chi = 0;
    for (const auto& s : simplices) chi += s.size() % 2 == 1 ? 1 : -1;
    return chi;
  };
  return {count(mesh.tetrahedra, 4), count(mesh.boundary, 3)};
}

std::string whatIsWrongWith(const LatticeMesh& mesh) {
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const Tetrahedron& t = mesh.tetrahedra[i];
    if (orientation(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) <=
        0)
      return "cell " + std::to_string(i) + " is not positive";
  }
  std::map<Triangle, int> faces;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (int i = 0; i < 4; ++i) {
      Triangle f = cellFace(t, i);
      std::ranges::sort(f);
      if (++faces[f] > 2) return "a face of three cells";
    }
  const auto turned = [](std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
    std::ranges::sort(triangles);
    return triangles;
  };
  return turned(mesh.boundary) == turned(boundaryOf(mesh.tetrahedra))
             ? ""
             : "the boundary is not that of the cells";
}

double distanceOutside(const LatticeMesh& solid, const LatticePoint& p) {
  for (const Tetrahedron& t : solid.tetrahedra) {
    bool inside = true;
    for (int i = 0; i < 4 && inside; ++i) {
      const Triangle f = cellFace(t, i);
      inside = orientation(solid.points[f[0]], solid.points[f[1]], solid.points[f[2]], p) <= 0;
    }
    if (inside) return 0;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : solid.boundary)
    nearest = std::min(nearest, nearestOnTriangle(toVector(p), {toVector(solid.points[t[0]]),
                                                                toVector(solid.points[t[1]]),
                                                                toVector(solid.points[t[2]])})
                                    .squared);
  return std::sqrt(nearest);
}

std::filesystem::path writeSampleLog(const std::filesystem::path& folder, const std::string& name,
                                     int n, std::uint32_t seed, std::uint32_t chunkBytes) {
  const std::filesystem::path path = folder / (name + ".qtet");
  writeLog(path, gridMesh(n, seed), {}, chunkBytes);
  return path;
}

Bytes logBytes(const LatticeMesh& mesh, const FusionOptions& fusion, std::uint32_t chunkBytes,
               const std::string& source) {
  const auto history = simplify(mesh, fusion);
  if (!history) throw std::runtime_error(history.error().text());
  LogWriterOptions options;
  options.source = source;
  options.generator = "qtet test";
  options.chunkBytes = chunkBytes;
  auto log = encodeLog(*history, options);
  if (!log) throw std::runtime_error(log.error().text());
  return std::move(log->bytes);
}

void writeLog(const std::filesystem::path& path, const LatticeMesh& mesh,
              const FusionOptions& fusion, std::uint32_t chunkBytes) {
  const Bytes log = logBytes(mesh, fusion, chunkBytes, path.stem().string() + ".vtu");
  if (const auto written = writeFileAtomically(path, log); !written)
    throw std::runtime_error(written.error().text());
}

std::filesystem::path freshFolder(const std::string& name) {
  // One folder a process, gone when the process ends.
  static const struct Root {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("qtet-unit-test." + std::to_string(getpid()));
    ~Root() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  } root;
  const auto folder = root.path / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace qtet::testing

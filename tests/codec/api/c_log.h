// For the tests of codec/api/qtet.h: a handle that frees itself, logs to open, and what the C++
// codec makes of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <numeric>

#include "codec/api/qtet.h"
#include "codec/log/log_index.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet::testing {

using Handle = std::unique_ptr<qtet_log, decltype(&qtet_log_destroy)>;

inline Handle handle() { return {qtet_log_create(), &qtet_log_destroy}; }

/// Chunks of half a kilobyte, so that levels end inside chunks, at their ends, and chunks inside
/// levels.
inline const std::filesystem::path& smallChunks() {
  static const std::filesystem::path path =
      writeSampleLog(freshFolder("c-api"), "small-chunks", 6, 1, 512);
  return path;
}
inline std::filesystem::path golden(const char* name) {
  return std::filesystem::path(testing::kGoldenFolder) / name;
}

inline Handle opened(const std::filesystem::path& path) {
  Handle log = handle();
  EXPECT_EQ(qtet_log_open_file(log.get(), path.c_str()), QTET_OK) << qtet_log_error(log.get());
  return log;
}

inline Bytes bytesOf(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string errorOf(const Handle& log) { return qtet_log_error(log.get()); }

/// The log's levels; as many tests go through all of them.
inline std::uint32_t levelCount(const Handle& log) {
  qtet_log_info info{};
  EXPECT_EQ(qtet_log_get_info(log.get(), sizeof info, &info), QTET_OK);
  return info.levels;
}

/// Opens, compares every block, and decodes everything; the first failure.
inline qtet_status wholly(qtet_log* log, qtet_status opened) {
  qtet_log_info info{};
  if (opened != QTET_OK) return opened;
  if (const qtet_status status = qtet_log_verify(log)) return status;
  if (const qtet_status status = qtet_log_refine(log, QTET_FULL)) return status;
  if (const qtet_status status = qtet_log_get_info(log, sizeof info, &info)) return status;
  for (std::uint32_t f = 0; f < info.fields; ++f) {
    const std::int32_t* integers = nullptr;
    if (const qtet_status status = qtet_log_field_integers(log, f, &integers)) return status;
  }
  return QTET_OK;
}

/// A level, all fields with it, by a Refiner that knows nothing of other levels.
inline Refiner refinedTo(const LogFile& file, std::uint32_t level) {
  std::vector<std::uint32_t> fields(file.index().fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  Refiner refiner(file.index());
  refiner.stopAtLevel(level);
  for (std::uint32_t c = 0; c == 0 || refiner.level() < level; ++c)
    EXPECT_TRUE(applyChunk(file, refiner, c, fields));
  return refiner;
}

inline std::string digestAt(const LogFile& file, std::uint32_t level) {
  const auto digest = refinedTo(file, level).digest();
  return {digest.begin(), digest.end()};
}

inline std::string digestOf(qtet_log* log) {
  std::array<std::uint8_t, QTET_DIGEST_BYTES> digest{};
  EXPECT_EQ(qtet_log_mesh_digest(log, digest.data()), QTET_OK) << qtet_log_error(log);
  return {digest.begin(), digest.end()};
}

template <class T, class Copy>
std::vector<T> copied(std::size_t count, const Copy& copy) {
  std::vector<T> out(count + 1, T{-77});  // one more than is to be written
  EXPECT_EQ(copy(count, out.data()), QTET_OK);
  EXPECT_EQ(out.back(), T{-77}) << "written beyond the end";
  out.pop_back();
  return out;
}

inline void expectPoints(qtet_log* log, const LatticeMesh& mesh) {
  ASSERT_EQ(qtet_log_vertex_count(log), mesh.points.size());
  EXPECT_EQ(std::memcmp(qtet_log_lattice_points(log), mesh.points.data(),
                        mesh.points.size() * sizeof(LatticePoint)),
            0);
  const auto doubles = copied<double>(3 * mesh.points.size(), [&](auto n, auto* out) {
    return qtet_log_copy_points_double(log, n, out);
  });
  const auto floats = copied<float>(3 * mesh.points.size(), [&](auto n, auto* out) {
    return qtet_log_copy_points_float(log, n, out);
  });
  for (std::size_t i = 0; i < doubles.size(); ++i) {
    EXPECT_EQ(doubles[i], mesh.lattice.position(mesh.points[i / 3])[i % 3]);
    EXPECT_EQ(floats[i], static_cast<float>(doubles[i]));
  }
}

inline void expectField(qtet_log* log, std::uint32_t f, const FieldInfo& field,
                        const std::vector<std::int32_t>& values) {
  ASSERT_EQ(qtet_log_field_count(log, f), values.size());
  const std::int32_t* integers = nullptr;
  ASSERT_EQ(qtet_log_field_integers(log, f, &integers), QTET_OK) << qtet_log_error(log);
  EXPECT_TRUE(std::equal(values.begin(), values.end(), integers)) << field.name;
  const auto doubles = copied<double>(
      values.size(), [&](auto n, auto* out) { return qtet_log_copy_field_double(log, f, n, out); });
  const auto floats = copied<float>(
      values.size(), [&](auto n, auto* out) { return qtet_log_copy_field_float(log, f, n, out); });
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(doubles[i], field.minimum[i % field.components] + field.step * values[i])
        << field.name;
    EXPECT_EQ(floats[i], static_cast<float>(doubles[i])) << field.name;
  }
}

inline void expectCells(qtet_log* log, const LatticeMesh& mesh) {
  ASSERT_EQ(qtet_log_tetrahedron_count(log), mesh.tetrahedra.size());
  ASSERT_EQ(qtet_log_boundary_count(log), mesh.boundary.size());
  EXPECT_EQ(std::memcmp(qtet_log_tetrahedra(log), mesh.tetrahedra.data(),
                        mesh.tetrahedra.size() * sizeof(Tetrahedron)),
            0);
  EXPECT_EQ(std::memcmp(qtet_log_boundary(log), mesh.boundary.data(),
                        mesh.boundary.size() * sizeof(Triangle)),
            0);
}

inline void expectMesh(qtet_log* log, const LatticeMesh& mesh) {
  expectPoints(log, mesh);
  expectCells(log, mesh);
  for (std::uint32_t f = 0; f < mesh.fields.size(); ++f)
    expectField(log, f, mesh.fields[f], mesh.values[f]);
}

}  // namespace qtet::testing

// codec/api/qtet.h: every failure has its number and its text, and leaves nothing half done.
#include <gtest/gtest.h>

#include <new>

#include "codec/api/c_api_handle.h"
#include "codec/log/log_index.h"
#include "tests/codec/api/c_log.h"

namespace qtet {
namespace {

using namespace testing;

TEST(QtetC, goldenLogsThatMustFailGiveTheStatusInTheirName) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden("must-fail"))) {
    const std::string name = entry.path().filename().string(),
                      expected = name.substr(0, name.find('.'));
    const Handle log = handle();
    EXPECT_EQ(
        qtet_status_name(wholly(log.get(), qtet_log_open_file(log.get(), entry.path().c_str()))),
        expected)
        << name;
    EXPECT_TRUE(errorOf(log).starts_with(expected)) << errorOf(log);
    const Bytes bytes = bytesOf(entry.path());
    EXPECT_EQ(qtet_status_name(
                  wholly(log.get(), qtet_log_open_memory(log.get(), bytes.size(), bytes.data()))),
              expected)
        << name;
    ++files;
  }
  EXPECT_GE(files, 20u);
}

TEST(QtetC, everyTruncationIsToldAndNothingStaysOpen) {
  const Bytes bytes = bytesOf(golden("valid/tunnel.qtet"));
  const Handle log = handle();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // of its own, so that reading beyond is seen
    const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const void* data = size == 0 ? static_cast<const void*>("") : part.data();
    ASSERT_EQ(qtet_log_open_memory(log.get(), size, data), QTET_TRUNCATED)
        << size << ": " << errorOf(log);
    ASSERT_EQ(qtet_log_refine(log.get(), 0), QTET_NO_LOG);
  }
  EXPECT_EQ(wholly(log.get(), qtet_log_open_memory(log.get(), bytes.size(), bytes.data())),
            QTET_OK);
}

TEST(QtetC, aFileThatCannotBeReadIsNamed) {
  const Handle log = handle();
  const auto folder = testing::freshFolder("c-api-files");
  const auto missing = folder / "none.qtet", empty = folder / "empty.qtet";
  std::ofstream(empty).close();
  EXPECT_EQ(qtet_log_open_file(log.get(), missing.c_str()), QTET_IO);
  EXPECT_NE(errorOf(log).find(missing.string()), std::string::npos) << errorOf(log);
  EXPECT_EQ(qtet_log_open_file(log.get(), folder.c_str()), QTET_IO);
  EXPECT_EQ(qtet_log_open_file(log.get(), empty.c_str()), QTET_TRUNCATED);
  EXPECT_NE(errorOf(log).find(empty.string()), std::string::npos) << errorOf(log);
}

/// The log with one bit changed in the last byte of a block.
Bytes damaged(const std::filesystem::path& path, std::uint32_t chunk, std::uint32_t part) {
  const Result<LogFile> file = LogFile::open(path);
  EXPECT_TRUE(file);
  const BlockEntry& block = file->index().block(chunk, part);
  Bytes bytes = bytesOf(path);
  bytes[block.offset + block.size - 1] ^= 1;
  return bytes;
}

TEST(QtetC, behindDamageThereIsNoMeshAndBeforeItThereIs) {
  const Result<LogFile> file = LogFile::open(smallChunks());
  ASSERT_TRUE(file);
  const auto chunk = static_cast<std::uint32_t>(file->index().chunks.size()) / 2;
  const Bytes bytes = damaged(smallChunks(), chunk, kStructurePart);
  const Handle log = handle();
  ASSERT_EQ(qtet_log_open_memory(log.get(), bytes.size(), bytes.data()), QTET_OK);
  EXPECT_EQ(qtet_log_verify(log.get()), QTET_BAD_CHECKSUM);
  const std::uint32_t before = file->index().chunks[chunk].firstLevel - 1;
  ASSERT_EQ(qtet_log_refine(log.get(), before), QTET_OK) << errorOf(log);
  EXPECT_EQ(qtet_log_refine(log.get(), QTET_FULL), QTET_BAD_CHECKSUM);
  EXPECT_NE(errorOf(log).find("chunk " + std::to_string(chunk)), std::string::npos) << errorOf(log);
  EXPECT_EQ(qtet_log_level(log.get()), QTET_NO_LEVEL);
  EXPECT_EQ(qtet_log_boundary(log.get()), nullptr);
  std::array<std::uint8_t, QTET_DIGEST_BYTES> digest{};
  EXPECT_EQ(qtet_log_mesh_digest(log.get(), digest.data()), QTET_NO_MESH);
  ASSERT_EQ(qtet_log_refine(log.get(), before), QTET_OK);
  EXPECT_EQ(digestOf(log.get()), digestAt(*file, before));
}

TEST(QtetC, aDamagedFieldLeavesTheMeshAndTheOtherFields) {
  const Result<LogFile> file = LogFile::open(smallChunks());
  ASSERT_TRUE(file);
  const Bytes bytes = damaged(smallChunks(), 1, kFirstFieldPart);
  const Handle log = handle();
  ASSERT_EQ(qtet_log_open_memory(log.get(), bytes.size(), bytes.data()), QTET_OK);
  ASSERT_EQ(qtet_log_refine(log.get(), QTET_FULL), QTET_OK) << errorOf(log);
  const std::int32_t* integers = qtet_log_lattice_points(log.get());
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(qtet_log_field_integers(log.get(), 0, &integers), QTET_BAD_CHECKSUM);
  EXPECT_EQ(integers, nullptr);
  std::vector<double> values(qtet_log_field_count(log.get(), 0));
  EXPECT_EQ(qtet_log_copy_field_double(log.get(), 0, values.size(), values.data()),
            QTET_BAD_CHECKSUM);
  const Result<LatticeMesh> mesh = meshAtLevel(*file, levelCount(log) - 1);
  ASSERT_TRUE(mesh);
  expectCells(log.get(), *mesh);
  expectField(log.get(), 1, mesh->fields[1], mesh->values[1]);
}

TEST(QtetC, levelsAndFieldsThatAreNotThereAreRefusedByNumber) {
  const Handle log = opened(smallChunks());
  const std::uint32_t levels = levelCount(log);
  EXPECT_EQ(qtet_log_refine(log.get(), levels), QTET_NOT_FOUND);
  EXPECT_NE(errorOf(log).find("the last is " + std::to_string(levels - 1)), std::string::npos)
      << errorOf(log);
  ASSERT_EQ(qtet_log_refine(log.get(), levels - 1), QTET_OK);
  EXPECT_EQ(qtet_log_refine(log.get(), levels), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_level(log.get()), levels - 1) << "what is refused leaves the mesh";

  qtet_level_info level{};
  qtet_field_info field{};
  double value = 0;
  float small = 0;
  std::uint32_t found = 0;
  const std::int32_t* integers = nullptr;
  EXPECT_EQ(qtet_log_get_level(log.get(), levels, sizeof level, &level), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_get_field(log.get(), 2, sizeof field, &field), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_field_error(log.get(), levels, 0, &value, &value), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_field_error(log.get(), 0, 2, &value, &value), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_level_of_field_error(log.get(), 2, 0.1, &found), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_field_integers(log.get(), 2, &integers), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_copy_field_double(log.get(), 2, 1, &value), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_copy_field_float(log.get(), 0xFFFFFFFF, 1, &small), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_field_count(log.get(), 2), 0u);
  EXPECT_EQ(qtet_log_find_field(log.get(), "height", &found), QTET_NOT_FOUND);
  EXPECT_NE(errorOf(log).find("it has: Height, Swirl"), std::string::npos) << errorOf(log);
}

TEST(QtetC, anArrayThatIsOneNumberTooSmallIsNotTouched) {
  const Handle log = opened(smallChunks());
  ASSERT_EQ(qtet_log_refine(log.get(), 1), QTET_OK);
  const std::size_t points = 3 * std::size_t{qtet_log_vertex_count(log.get())},
                    values = qtet_log_field_count(log.get(), 1);
  std::vector<double> doubles(points - 1, 5);
  std::vector<float> floats(values - 1, 5);
  EXPECT_EQ(qtet_log_copy_points_double(log.get(), points - 1, doubles.data()), QTET_BAD_ARGUMENT);
  EXPECT_NE(errorOf(log).find("it needs " + std::to_string(points)), std::string::npos)
      << errorOf(log);
  EXPECT_EQ(qtet_log_copy_field_float(log.get(), 1, values - 1, floats.data()), QTET_BAD_ARGUMENT);
  EXPECT_EQ(std::ranges::count(doubles, 5), static_cast<std::ptrdiff_t>(doubles.size()));
  EXPECT_EQ(std::ranges::count(floats, 5), static_cast<std::ptrdiff_t>(floats.size()));
}

/// Every function that takes a handle and can fail, with arguments that are right.
std::vector<qtet_status> callsWith(qtet_log* log) {
  qtet_log_info info{};
  qtet_field_info field{};
  qtet_level_info level{};
  std::uint32_t number = 0;
  std::vector<double> doubles(9999);
  std::vector<float> floats(9999);
  std::array<std::uint8_t, QTET_DIGEST_BYTES> digest{};
  const std::int32_t* integers = nullptr;
  return {qtet_log_verify(log),
          qtet_log_get_info(log, sizeof info, &info),
          qtet_log_get_field(log, 0, sizeof field, &field),
          qtet_log_get_level(log, 0, sizeof level, &level),
          qtet_log_find_field(log, "Height", &number),
          qtet_log_field_error(log, 0, 0, doubles.data(), doubles.data() + 1),
          qtet_log_level_of_tetrahedra(log, 1, &number),
          qtet_log_level_of_bytes(log, 1, &number),
          qtet_log_level_of_boundary_error(log, 1, &number),
          qtet_log_level_of_field_error(log, 0, 1, &number),
          qtet_log_copy_points_double(log, 9999, doubles.data()),
          qtet_log_copy_points_float(log, 9999, floats.data()),
          qtet_log_copy_field_double(log, 0, 9999, doubles.data()),
          qtet_log_copy_field_float(log, 0, 9999, floats.data()),
          qtet_log_field_integers(log, 0, &integers),
          qtet_log_mesh_digest(log, digest.data()),
          qtet_log_refine(log, 0)};
}

TEST(QtetC, withoutALogOrAMeshOrAHandleCallsSayWhatIsMissing) {
  for (const qtet_status status : callsWith(nullptr)) EXPECT_EQ(status, QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_log_open_file(nullptr, "x"), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_log_open_memory(nullptr, 1, "x"), QTET_BAD_ARGUMENT);
  EXPECT_NE(qtet_log_error(nullptr), nullptr);
  EXPECT_EQ(qtet_log_level(nullptr), QTET_NO_LEVEL);
  EXPECT_EQ(qtet_log_vertex_count(nullptr) + qtet_log_tetrahedron_count(nullptr) +
                qtet_log_boundary_count(nullptr),
            0u);
  EXPECT_EQ(qtet_log_field_count(nullptr, 0), 0u);
  EXPECT_EQ(qtet_log_lattice_points(nullptr), nullptr);
  EXPECT_EQ(qtet_log_tetrahedra(nullptr), nullptr);
  EXPECT_EQ(qtet_log_boundary(nullptr), nullptr);
  qtet_log_destroy(nullptr);

  const Handle closed = handle();
  EXPECT_EQ(errorOf(closed), "");
  for (const qtet_status status : callsWith(closed.get())) EXPECT_EQ(status, QTET_NO_LOG);
  EXPECT_TRUE(errorOf(closed).starts_with("no-log")) << errorOf(closed);

  const Handle log = opened(smallChunks());
  const std::vector<qtet_status> statuses = callsWith(log.get());
  EXPECT_EQ(std::ranges::count(statuses, qtet_status{QTET_NO_MESH}), 6);
  EXPECT_EQ(statuses.back(), QTET_OK);
}

TEST(QtetC, nullsAreRefused) {
  const Handle log = opened(smallChunks());
  ASSERT_EQ(qtet_log_refine(log.get(), 0), QTET_OK);
  double value = 0;
  std::uint32_t number = 0;
  const std::vector<qtet_status> statuses = {
      qtet_log_get_info(log.get(), sizeof(qtet_log_info), nullptr),
      qtet_log_get_field(log.get(), 0, sizeof(qtet_field_info), nullptr),
      qtet_log_get_level(log.get(), 0, sizeof(qtet_level_info), nullptr),
      qtet_log_find_field(log.get(), nullptr, &number),
      qtet_log_find_field(log.get(), "Height", nullptr),
      qtet_log_field_error(log.get(), 0, 0, nullptr, &value),
      qtet_log_field_error(log.get(), 0, 0, &value, nullptr),
      qtet_log_level_of_tetrahedra(log.get(), 1, nullptr),
      qtet_log_level_of_bytes(log.get(), 1, nullptr),
      qtet_log_level_of_boundary_error(log.get(), 1, nullptr),
      qtet_log_level_of_field_error(log.get(), 0, 1, nullptr),
      qtet_log_copy_points_double(log.get(), 9999, nullptr),
      qtet_log_copy_points_float(log.get(), 9999, nullptr),
      qtet_log_copy_field_double(log.get(), 0, 9999, nullptr),
      qtet_log_copy_field_float(log.get(), 0, 9999, nullptr),
      qtet_log_field_integers(log.get(), 0, nullptr),
      qtet_log_mesh_digest(log.get(), nullptr),
  };
  for (std::size_t i = 0; i < statuses.size(); ++i)
    EXPECT_EQ(statuses[i], QTET_BAD_ARGUMENT) << "call " << i;
  EXPECT_EQ(qtet_log_level(log.get()), 0u);
  EXPECT_EQ(qtet_log_open_memory(log.get(), 64, nullptr), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_log_open_file(log.get(), nullptr), QTET_BAD_ARGUMENT);
}

TEST(QtetC, noExceptionCrossesTheBorder) {
  const Handle log = opened(smallChunks());
  EXPECT_EQ(withLog(log.get(), []() -> qtet_status { throw std::bad_alloc(); }),
            QTET_OUT_OF_MEMORY);
  EXPECT_TRUE(errorOf(log).starts_with("out-of-memory: ")) << errorOf(log);
  EXPECT_EQ(withLog(log.get(), []() -> qtet_status { throw 7; }), QTET_INTERNAL);
  EXPECT_TRUE(errorOf(log).starts_with("internal: ")) << errorOf(log);
  EXPECT_EQ(qtet_log_refine(log.get(), 0), QTET_OK) << "the log is as good as before";
}

TEST(QtetC, aStatusHasANameAndOtherNumbersHaveNone) {
  std::vector<std::string> names;
  for (qtet_status status = -1; status < 200; ++status)
    if (std::string(qtet_status_name(status)) != "unknown")
      names.emplace_back(qtet_status_name(status));
  EXPECT_EQ(names.size(), 18u);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

}  // namespace
}  // namespace qtet

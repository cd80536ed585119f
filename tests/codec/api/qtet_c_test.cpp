// Tests codec/api/qtet.h from outside: it reports and decodes the same as the C++ codec.
#include <gtest/gtest.h>

#include <cstddef>
#include <thread>

#include "codec/log/log_levels.h"
#include "codec/log/log_manifest.h"
#include "proto/field_name.h"
#include "proto/rounding_error.h"
#include "tests/codec/api/c_log.h"

namespace qtet {
namespace {

using namespace testing;

TEST(QtetC, headerAndLibraryAreOfOneVersion) {
  EXPECT_EQ(qtet_version(), static_cast<std::uint32_t>(QTET_VERSION_NUMBER));
  EXPECT_STREQ(qtet_version_text(), QTET_VERSION);
}

TEST(QtetC, whatALogHoldsIsWhatItsManifestSays) {
  for (const auto& path :
       {smallChunks(), golden("valid/cell-fields.qtet"), golden("valid/no-fields.qtet")}) {
    const Handle log = opened(path);
    const Result<LogFile> file = LogFile::open(path);
    ASSERT_TRUE(file);
    const Result<Manifest> manifest = manifestOf(file->index());
    ASSERT_TRUE(manifest);

    qtet_log_info info{};
    ASSERT_EQ(qtet_log_get_info(log.get(), sizeof info, &info), QTET_OK);
    EXPECT_EQ(info.versionMajor, file->bytes()[8]);
    EXPECT_EQ(info.versionMinor, file->bytes()[10]);
    EXPECT_EQ(info.bytes, std::filesystem::file_size(path));
    EXPECT_EQ(info.chunks, file->index().chunks.size());
    EXPECT_EQ(info.latticeBits, static_cast<std::uint32_t>(manifest->latticeBits));
    EXPECT_EQ(info.latticeStep, manifest->latticeStep);
    EXPECT_TRUE(std::ranges::equal(info.latticeOrigin, manifest->latticeOrigin));
    EXPECT_EQ(info.digest, file->digest());
    EXPECT_EQ(info.source, manifest->source);
    EXPECT_EQ(info.generator, manifest->generator);

    ASSERT_EQ(info.fields, manifest->fields.size());
    for (std::uint32_t f = 0; f < info.fields; ++f) {
      const ManifestField& expected = manifest->fields[f];
      qtet_field_info field{};
      ASSERT_EQ(qtet_log_get_field(log.get(), f, sizeof field, &field), QTET_OK);
      EXPECT_EQ(field.name, expected.name);
      EXPECT_EQ(field.type, expected.type);
      EXPECT_EQ(field.association, expected.association == "cell" ? QTET_CELL : QTET_POINT);
      EXPECT_EQ(field.bits, static_cast<std::uint32_t>(expected.bits));
      EXPECT_EQ(field.step, expected.step);
      EXPECT_EQ(field.largestRoundingError, largestRoundingError(expected));
      EXPECT_TRUE(std::ranges::equal(field.range, expected.range));
      ASSERT_EQ(field.components, expected.minimum.size());
      EXPECT_TRUE(std::equal(expected.minimum.begin(), expected.minimum.end(), field.minimum));
      std::uint64_t bytes = 0;
      for (std::uint32_t c = 0; c < info.chunks; ++c)
        bytes += file->block(c, kFirstFieldPart + f).size();
      EXPECT_EQ(field.bytes, bytes);
      std::uint32_t found = 99;
      EXPECT_EQ(qtet_log_find_field(log.get(), fieldKey(*manifest, f).c_str(), &found), QTET_OK);
      EXPECT_EQ(found, f);
    }

    ASSERT_EQ(info.levels, manifest->levels.size());
    for (std::uint32_t l = 0; l < info.levels; ++l) {
      qtet_level_info level{};
      ASSERT_EQ(qtet_log_get_level(log.get(), l, sizeof level, &level), QTET_OK);
      EXPECT_EQ(level.tetrahedra, manifest->levels[l].tetrahedra);
      EXPECT_EQ(level.vertices, manifest->levels[l].vertices);
      EXPECT_EQ(level.boundaryTriangles, manifest->levels[l].boundaryTriangles);
      EXPECT_EQ(level.prefixBytes, prefixBytes(*manifest, file->index(), l));
      EXPECT_EQ(level.hasError, 0u);
    }
  }
}

TEST(QtetC, aSeriesHasItsTimesAndTheirFields) {
  const Handle log = opened(golden("valid/series.qtet"));
  const std::uint32_t count = qtet_log_series_count(log.get());
  ASSERT_GT(count, 1u);
  for (std::uint32_t s = 0; s < count; ++s) {
    qtet_series_info info{};
    ASSERT_EQ(qtet_log_get_series(log.get(), s, sizeof info, &info), QTET_OK) << errorOf(log);
    ASSERT_GE(info.instants, 2u);
    std::vector<double> times(info.instants + 1, -77);
    std::vector<std::uint32_t> fields(info.instants + 1, 77);
    ASSERT_EQ(qtet_log_copy_series(log.get(), s, info.instants, times.data(), fields.data()),
              QTET_OK);
    EXPECT_EQ(times.back(), -77) << "written beyond the end";
    EXPECT_EQ(fields.back(), 77u) << "written beyond the end";
    for (std::uint32_t i = 0; i < info.instants; ++i) {
      if (i > 0) EXPECT_LT(times[i - 1], times[i]);
      qtet_field_info field{};
      ASSERT_EQ(qtet_log_get_field(log.get(), fields[i], sizeof field, &field), QTET_OK);
      EXPECT_EQ(field.association, info.association);
      const FieldName name(field.name);
      const auto instant = name.instant();
      ASSERT_TRUE(instant) << field.name;
      EXPECT_EQ(instant->series, info.name);
      EXPECT_EQ(instant->time, times[i]);
    }
    EXPECT_EQ(qtet_log_copy_series(log.get(), s, info.instants, nullptr, nullptr), QTET_OK);
    EXPECT_EQ(qtet_log_copy_series(log.get(), s, info.instants - 1, times.data(), nullptr),
              QTET_BAD_ARGUMENT);
    EXPECT_EQ(qtet_log_get_series(log.get(), s, sizeof info - 1, &info), QTET_BAD_ARGUMENT);
  }
  qtet_series_info info{};
  EXPECT_EQ(qtet_log_get_series(log.get(), count, sizeof info, &info), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_copy_series(log.get(), count, 9, nullptr, nullptr), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_series_count(handle().get()), 0u);
  EXPECT_EQ(qtet_log_series_count(nullptr), 0u);
}

TEST(QtetC, everyLevelForwardIsTheRefinersMesh) {
  for (const auto& path :
       {smallChunks(), golden("valid/cell-fields.qtet"), golden("valid/tunnel.qtet")}) {
    const Handle log = opened(path);
    const Result<LogFile> file = LogFile::open(path);
    ASSERT_TRUE(file);
    for (std::uint32_t level = 0; level < levelCount(log); ++level) {
      ASSERT_EQ(qtet_log_refine(log.get(), level), QTET_OK) << errorOf(log);
      EXPECT_EQ(qtet_log_level(log.get()), level);
      EXPECT_EQ(digestOf(log.get()), digestAt(*file, level)) << level;
      const Result<LatticeMesh> mesh = meshAtLevel(*file, level);
      ASSERT_TRUE(mesh);
      expectMesh(log.get(), *mesh);
    }
  }
}

TEST(QtetC, levelsMayBeAskedForInAnyOrder) {
  for (const auto& path : {smallChunks(), golden("valid/gaps.qtet")}) {
    const Handle log = opened(path);
    const Result<LogFile> file = LogFile::open(path);
    ASSERT_TRUE(file);
    const std::uint32_t levels = levelCount(log);
    ASSERT_GT(levels, 5u);
    std::vector<std::uint32_t> order;
    for (std::uint32_t level = levels; level-- > 0;) order.push_back(level);
    for (std::uint32_t i = 0; i < 2 * levels; ++i) order.push_back(i * 7 % levels);
    for (const std::uint32_t level : order) {
      ASSERT_EQ(qtet_log_refine(log.get(), level), QTET_OK) << errorOf(log);
      EXPECT_EQ(qtet_log_level(log.get()), level);
      EXPECT_EQ(digestOf(log.get()), digestAt(*file, level)) << level;
      const Refiner expected = refinedTo(*file, level);
      for (std::uint32_t f = 0; f < file->index().fields.size(); ++f) {
        const std::int32_t* integers = nullptr;
        ASSERT_EQ(qtet_log_field_integers(log.get(), f, &integers), QTET_OK) << errorOf(log);
        ASSERT_EQ(qtet_log_field_count(log.get(), f), expected.fieldValues(f).size());
        EXPECT_TRUE(std::ranges::equal(expected.fieldValues(f),
                                       std::span(integers, expected.fieldValues(f).size())))
            << "field " << f << ", level " << level;
      }
    }
  }
}

TEST(QtetC, aFieldIsTheSameHoweverLateItIsAskedFor) {
  for (const auto& path : {smallChunks(), golden("valid/cell-fields.qtet")}) {
    const Result<LogFile> file = LogFile::open(path);
    ASSERT_TRUE(file);
    const Handle log = opened(path);
    const std::uint32_t last = levelCount(log) - 1;
    const std::int32_t* integers = nullptr;
    // Field 0 is there from the base mesh on, field 1 comes half-way, the others when all is done.
    ASSERT_EQ(qtet_log_refine(log.get(), 0), QTET_OK);
    ASSERT_EQ(qtet_log_field_integers(log.get(), 0, &integers), QTET_OK);
    ASSERT_EQ(qtet_log_refine(log.get(), last / 2), QTET_OK);
    ASSERT_EQ(qtet_log_field_integers(log.get(), 1, &integers), QTET_OK);
    ASSERT_EQ(qtet_log_refine(log.get(), QTET_FULL), QTET_OK);
    EXPECT_EQ(qtet_log_level(log.get()), last);
    const Result<LatticeMesh> mesh = meshAtLevel(*file, last);
    ASSERT_TRUE(mesh);
    expectMesh(log.get(), *mesh);
  }
}

TEST(QtetC, memoryIsCopied) {
  Bytes bytes = bytesOf(smallChunks());
  const Handle log = handle();
  ASSERT_EQ(qtet_log_open_memory(log.get(), bytes.size(), bytes.data()), QTET_OK);
  std::ranges::fill(bytes, std::uint8_t{0});
  EXPECT_EQ(wholly(log.get(), QTET_OK), QTET_OK) << errorOf(log);
}

TEST(QtetC, openingAnotherLogClosesTheFirst) {
  const Handle log = opened(smallChunks());
  ASSERT_EQ(qtet_log_refine(log.get(), QTET_FULL), QTET_OK);
  ASSERT_EQ(qtet_log_open_file(log.get(), golden("valid/no-fields.qtet").c_str()), QTET_OK);
  EXPECT_EQ(qtet_log_level(log.get()), QTET_NO_LEVEL);
  EXPECT_EQ(qtet_log_tetrahedra(log.get()), nullptr);
  EXPECT_EQ(qtet_log_field_count(log.get(), 0), 0u);
  ASSERT_EQ(qtet_log_refine(log.get(), 0), QTET_OK);
  ASSERT_EQ(qtet_log_open_file(log.get(), "/nowhere"), QTET_IO);
  EXPECT_EQ(qtet_log_vertex_count(log.get()), 0u);
  EXPECT_EQ(qtet_log_refine(log.get(), 0), QTET_NO_LOG);
}

TEST(QtetC, structsOfOtherVersionsAreFilledAsFarAsBothKnowThem) {
  const Handle log = opened(smallChunks());
  struct {
    qtet_log_info now;
    std::array<std::uint8_t, 24> later;
  } info;
  std::memset(static_cast<void*>(&info), 0xAB, sizeof info);
  ASSERT_EQ(qtet_log_get_info(log.get(), sizeof info.now + 16, &info.now), QTET_OK);
  EXPECT_GT(info.now.levels, 5u);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(info.later[i], i < 16 ? 0 : 0xAB);
  // the members since 0.4 may lack, those of the first version may not
  constexpr std::size_t kFirstInfo = offsetof(qtet_log_info, timeUnit),
                        kFirstField = offsetof(qtet_field_info, unit);
  EXPECT_EQ(qtet_log_get_info(log.get(), kFirstInfo, &info.now), QTET_OK);
  EXPECT_EQ(qtet_log_get_info(log.get(), kFirstInfo - 1, &info.now), QTET_BAD_ARGUMENT);
  qtet_field_info field{};
  qtet_level_info level{};
  EXPECT_EQ(qtet_log_get_field(log.get(), 0, kFirstField - 1, &field), QTET_BAD_ARGUMENT);
  EXPECT_EQ(qtet_log_get_level(log.get(), 0, 0, &level), QTET_BAD_ARGUMENT);
  EXPECT_EQ(field.name, nullptr);
}

TEST(QtetC, twoLogsInTwoThreadsDoNotMeet) {
  const std::string expected = digestOf([&] {
    static const Handle log = opened(smallChunks());
    EXPECT_EQ(qtet_log_refine(log.get(), QTET_FULL), QTET_OK);
    return log.get();
  }());
  std::array<std::string, 2> digests;
  {
    const auto work = [&](std::size_t i) {
      const Handle log = opened(smallChunks());
      for (std::uint32_t level = 0; level < levelCount(log);
           level += 1 + static_cast<std::uint32_t>(i))
        EXPECT_EQ(qtet_log_refine(log.get(), level), QTET_OK);
      EXPECT_EQ(wholly(log.get(), QTET_OK), QTET_OK);
      digests[i] = digestOf(log.get());
    };
    const std::jthread first(work, 0), second(work, 1);
  }
  for (const std::string& digest : digests) EXPECT_EQ(digest, expected);
}

}  // namespace
}  // namespace qtet

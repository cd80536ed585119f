// codec/api/qtet.h: known errors, and levels chosen by them or by size.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "codec/log/log_writer.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/codec/api/c_log.h"

namespace qtet {
namespace {

using namespace testing;

/// A log with known errors. Those of field 0 fall as 1 / (level + 1), those of field 1 four times
/// as fast. The boundary's are twice that.
class QtetCKnownErrors : public ::testing::Test {
 protected:
  void SetUp() override {
    const Result<FusionHistory> history = simplify(testing::gridMesh(5, 2), {});
    ASSERT_TRUE(history);
    LogWriterOptions options;
    options.source = "grid.vtu";
    options.generator = "qtet test";
    options.chunkBytes = 512;
    for (std::uint32_t i = 0; i <= history->levels; ++i) {
      const double e = 1.0 / (i + 1);
      options.errors.push_back(
          LevelError{{e / 8, e / 2}, {e / 16, e}, e / 10, e / 5, {{e, 2 * e}, {e / 4, e / 2}}});
    }
    const Result<EncodedLog> log = encodeLog(*history, options);
    ASSERT_TRUE(log) << log.error().text();
    ASSERT_EQ(qtet_log_open_memory(log_.get(), log->bytes.size(), log->bytes.data()), QTET_OK);
    last_ = levelCount(log_) - 1;
    ASSERT_GT(last_, 4u);
  }

  Handle log_ = handle();
  std::uint32_t last_ = 0;
};

TEST_F(QtetCKnownErrors, standAtTheirLevels) {
  for (std::uint32_t l = 0; l <= last_; ++l) {
    const double e = 1.0 / (l + 1);
    qtet_level_info level{};
    ASSERT_EQ(qtet_log_get_level(log_.get(), l, sizeof level, &level), QTET_OK);
    EXPECT_EQ(level.hasError, 1u);
    EXPECT_NEAR(level.toLevelMean, e / 8, 1e-2 * e);
    EXPECT_NEAR(level.toLevelMax, e / 2, 1e-2 * e);
    EXPECT_NEAR(level.toOriginalMean, e / 16, 1e-2 * e);
    EXPECT_NEAR(level.toOriginalMax, e, 1e-2 * e);
    EXPECT_EQ(level.boundaryDistance, level.toOriginalMax);
    EXPECT_NEAR(level.volumeLost, e / 10, 1e-2 * e);
    EXPECT_NEAR(level.volumeGained, e / 5, 1e-2 * e);
    EXPECT_NEAR(level.volumeKept, 1 + e / 10, 1e-2 * e);
    double rms = 0, max = 0;
    ASSERT_EQ(qtet_log_field_error(log_.get(), l, 1, &rms, &max), QTET_OK);
    EXPECT_NEAR(rms, e / 4, 1e-2 * e);
    EXPECT_NEAR(max, e / 2, 1e-2 * e);
  }
}

TEST_F(QtetCKnownErrors, chooseTheCoarsestLevelWithinABound) {
  std::uint32_t level = 99;
  EXPECT_EQ(qtet_log_level_of_field_error(log_.get(), 0, 0.34, &level), QTET_OK);
  EXPECT_EQ(level, 2u);
  EXPECT_EQ(qtet_log_level_of_field_error(log_.get(), 1, 0.13, &level), QTET_OK);
  EXPECT_EQ(level, 1u);
  EXPECT_EQ(qtet_log_level_of_boundary_error(log_.get(), 0.26, &level), QTET_OK);
  EXPECT_EQ(level, 3u);
  EXPECT_EQ(qtet_log_level_of_boundary_error(log_.get(), 1, &level), QTET_OK);
  EXPECT_EQ(level, 0u);
  EXPECT_EQ(qtet_log_level_of_boundary_error(log_.get(), 0, &level), QTET_OK);
  EXPECT_EQ(level, last_);
  for (const double bound : {-0.1, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(qtet_log_level_of_boundary_error(log_.get(), bound, &level), QTET_BAD_ARGUMENT);
    EXPECT_EQ(qtet_log_level_of_field_error(log_.get(), 0, bound, &level), QTET_BAD_ARGUMENT);
  }
  EXPECT_EQ(level, last_);
}

TEST_F(QtetCKnownErrors, sizesChooseTheFinestLevelThatFits) {
  for (std::uint32_t l = 0; l <= last_; ++l) {
    qtet_level_info info{}, next{};
    ASSERT_EQ(qtet_log_get_level(log_.get(), l, sizeof info, &info), QTET_OK);
    std::uint32_t level = 99;
    EXPECT_EQ(qtet_log_level_of_tetrahedra(log_.get(), info.tetrahedra, &level), QTET_OK);
    EXPECT_EQ(level, l);
    EXPECT_EQ(qtet_log_level_of_tetrahedra(log_.get(), info.tetrahedra - 1, &level), QTET_OK);
    EXPECT_EQ(level, l == 0 ? 0 : l - 1);
    EXPECT_EQ(qtet_log_level_of_bytes(log_.get(), info.prefixBytes, &level), QTET_OK);
    EXPECT_GE(level, l);
    ASSERT_EQ(qtet_log_get_level(log_.get(), level, sizeof next, &next), QTET_OK);
    EXPECT_EQ(next.prefixBytes, info.prefixBytes);
    if (level == last_) continue;
    ASSERT_EQ(qtet_log_get_level(log_.get(), level + 1, sizeof next, &next), QTET_OK);
    EXPECT_GT(next.prefixBytes, info.prefixBytes) << "a finer level would have fitted";
  }
  std::uint32_t level = 99;
  EXPECT_EQ(qtet_log_level_of_bytes(log_.get(), 0, &level), QTET_OK);
  EXPECT_EQ(level, 0u);
  EXPECT_EQ(qtet_log_level_of_bytes(log_.get(), ~std::uint64_t{0}, &level), QTET_OK);
  EXPECT_EQ(level, last_);
}

TEST(QtetC, errorsThatWereNotMeasuredAreNotFound) {
  const Handle log = opened(smallChunks());
  std::uint32_t level = 99;
  double rms = 0, max = 0;
  EXPECT_EQ(qtet_log_level_of_boundary_error(log.get(), 0.5, &level), QTET_NOT_FOUND);
  EXPECT_NE(errorOf(log).find("`measure` levels"), std::string::npos) << errorOf(log);
  EXPECT_EQ(qtet_log_level_of_field_error(log.get(), 0, 0.5, &level), QTET_NOT_FOUND);
  EXPECT_EQ(qtet_log_field_error(log.get(), 0, 0, &rms, &max), QTET_NOT_FOUND);
  EXPECT_EQ(level, 99u);
}

}  // namespace
}  // namespace qtet

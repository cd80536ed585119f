#include "codec/log/log_levels.h"

#include <gtest/gtest.h>

#include "codec/coding/error_figure.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

class LogLevels : public ::testing::Test {
 protected:
  Result<EncodedLog> encode(std::size_t errors) {
    LogWriterOptions options;
    options.source = "grid.vtu";
    options.generator = "qtet test";
    options.chunkBytes = 1024;
    for (std::size_t i = 0; i < errors; ++i) {
      const double e = 1.0 / static_cast<double>(i + 1);
      options.errors.push_back(
          LevelError{{e / 2, e}, {e / 4, e / 2}, e / 10, 0, {{e / 8, e}, {e / 16, e}}});
    }
    return encodeLog(history_, options);
  }

  FusionHistory history_ = *simplify(testing::gridMesh(5, 2), {});
};

TEST_F(LogLevels, theKnownErrorsStandAtTheirLevels) {
  const Result<EncodedLog> log = encode(history_.levels + 1);
  ASSERT_TRUE(log) << log.error().message;
  const Result<LogIndex> index = LogIndex::parse(log->bytes);
  ASSERT_TRUE(index);
  const Result<Manifest> manifest = manifestOf(*index);
  ASSERT_TRUE(manifest) << manifest.error().message;
  const auto levels = levelsJson(*manifest, *index);
  ASSERT_EQ(levels.size(), history_.levels + 1u);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    EXPECT_EQ(levels[i]["level"], i);
    sum += levels[i]["bytes"].get<std::uint64_t>();
    EXPECT_EQ(levels[i]["cumulativeBytes"], sum);
    EXPECT_EQ(levels[i]["cumulativeBytes"], prefixBytes(*manifest, *index, i));
    EXPECT_EQ(levels[i]["error"]["boundary"]["toLevel"]["max"],
              roundedUp(1.0 / static_cast<double>(i + 1)));
    EXPECT_EQ(levels[i]["error"]["fields"].size(), 2u);
  }
  EXPECT_EQ(sum, log->bytes.size());
}

TEST_F(LogLevels, nothingIsToldWhereNothingWasMeasured) {
  const Result<EncodedLog> log = encode(0);
  ASSERT_TRUE(log);
  const Result<LogIndex> index = LogIndex::parse(log->bytes);
  ASSERT_TRUE(index);
  for (const auto& level : levelsJson(*manifestOf(*index), *index))
    EXPECT_FALSE(level.contains("error"));
}

TEST_F(LogLevels, errorsOfAnotherHistoryAreRefused) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{history_.levels}, history_.levels + std::size_t{2}}) {
    const Result<EncodedLog> log = encode(count);
    ASSERT_FALSE(log) << count;
    EXPECT_EQ(log.error().code, ErrorCode::kBadValue);
  }
}

}  // namespace
}  // namespace qtet

#include "codec/log/log_index.h"

#include <gtest/gtest.h>

#include <string>

#include "codec/refine/log_file.h"
#include "proto/limits.h"
#include "tests/support/forged_log.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

TEST(LogIndex, holdsSoManyFieldsAndNoMore) {
  const std::string golden = std::string(testing::kGoldenFolder) + "/valid/no-fields.qtet";
  for (const std::uint32_t count : {kMaxFields - 1, kMaxFields, kMaxFields + 1}) {
    testing::TakenApart parts = testing::takeApart(LogFile::open(golden).value().bytes());
    parts.index.fields.resize(count, FieldShape{1});
    for (auto& blocks : parts.blocks) blocks.resize(kFirstFieldPart + count);
    const Result<LogIndex> index = LogIndex::parse(parts.together());
    ASSERT_EQ(index.has_value(), count <= kMaxFields) << count;
    if (!index) EXPECT_EQ(index.error().code, ErrorCode::kLimitExceeded);
  }
}

}  // namespace
}  // namespace qtet

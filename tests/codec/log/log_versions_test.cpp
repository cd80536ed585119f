#include "codec/log/log_versions.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(LogVersions, areThoseOfTheFormatsDocument) {
  EXPECT_EQ(oldestLogVersion(), "4.0");
  EXPECT_EQ(newestLogVersion(), "4.0");
}

}  // namespace
}  // namespace qtet

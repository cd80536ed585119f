#include "codec/log/log_versions.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(LogVersions, areThoseOfTheFormatsDocument) {
  EXPECT_EQ(oldestLogVersion(), "2.0");
  EXPECT_EQ(newestLogVersion(), "3.5");
}

}  // namespace
}  // namespace qtet

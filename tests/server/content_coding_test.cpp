#include "server/content_coding.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(ContentCoding, gzipIsTakenWhereTheClientAllowsIt) {
  for (const char* value : {"gzip", "GZIP", "deflate, gzip;q=1.0, br", "br , gzip ; q=0.001", "*", "x-gzip", "gzip;q=0.5,*;q=0"}) EXPECT_TRUE(acceptsGzip(value)) << value;
  for (const char* value : {"", "br", "gzip;q=0", "gzip; q=0.000, *", "*;q=0", "identity", "gzipped", ";;,,", "*;Q=0.0"}) EXPECT_FALSE(acceptsGzip(value)) << value;
}

}  // namespace
}  // namespace qtet

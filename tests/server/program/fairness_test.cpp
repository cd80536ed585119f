// One client that asks for much, beside another that asks for little.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/support/json.h"

namespace qtet {
namespace {

using test::Json;

class FairnessTest : public ::testing::Test {
 protected:
  /// The methods of the log's `count` lines, in the order in which they were answered.
  std::vector<std::string> methods(std::size_t count) const {
    std::vector<std::string> out;
    (void)test::eventually([&] {
      out.clear();
      std::ifstream in(path_);
      for (std::string line; std::getline(in, line) && !in.eof();)
        out.push_back(Json::parse(line)["method"].string());
      return out.size() >= count;
    });
    return out;
  }

  test::ServedFolder folder_;
  test::TempFolder out_;
  std::filesystem::path path_ = out_.path() / "access.json";
  Result<std::unique_ptr<AccessLog>> log_ = AccessLog::open(path_.string());
};

TEST_F(FairnessTest, aPipeliningConnectionGivesWayAfterEachAnswer) {
  constexpr std::size_t kHalf = 500;  // their answers fit into a socket's buffers
  const test::RunningServer server(
      folder_.store(), folder_.viewer(),
      {.threads = 1, .maxRequestsPerSecond = 0, .accessLog = log_->get()});
  test::RawClient much(server.port()), little(server.port());
  ASSERT_EQ(little.get("/livez").status, 200u);
  std::string half;
  for (std::size_t i = 0; i < kHalf; ++i) half += "HEAD /livez HTTP/1.1\r\nHost: a\r\n\r\n";
  ASSERT_TRUE(much.send(half));
  ASSERT_TRUE(little.send("GET /livez HTTP/1.1\r\nHost: a\r\n\r\n"));
  ASSERT_TRUE(much.send(half));
  EXPECT_EQ(little.receive().status, 200u);
  const std::vector<std::string> all = methods(2 * kHalf + 2);
  ASSERT_EQ(all.size(), 2 * kHalf + 2);
  const auto at = std::find(all.begin() + 1, all.end(), "GET") - all.begin();
  EXPECT_LT(at, static_cast<std::ptrdiff_t>(2 * kHalf)) << "not behind all that the other sent";
}

TEST_F(FairnessTest, anAddressThatHasUsedUpItsProcessorTimeIsRefused) {
  const auto refuses = [&](std::chrono::nanoseconds owed) {
    const test::RunningServer server(folder_.store(), folder_.viewer(),
                                     {.threads = 1, .maxOwedTime = owed});
    test::RawClient client(server.port());
    for (int i = 0; i < 50; ++i)
      if (client.get("/metrics").status == 429) return true;
    return false;
  };
  EXPECT_TRUE(refuses(std::chrono::microseconds(1)));
  EXPECT_FALSE(refuses(limits::kMaxOwedTime));
}

}  // namespace
}  // namespace qtet

// One client that asks for much, beside another that asks for little.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <latch>
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

/// SIGHUP stops the one thread until everything has arrived, so that the order is its own choice.
TEST_F(FairnessTest, aPipeliningConnectionGivesWayAfterEachAnswer) {
  constexpr std::size_t kMany = 100;  // their answers fit into a socket's buffers
  std::latch stopped(1), arrived(1);
  const test::RunningServer server(folder_.store(), folder_.viewer(),
                                   {.threads = 1,
                                    .maxRequestsPerSecond = 0,
                                    .endOnSignals = true,
                                    .accessLog = log_->get(),
                                    .reload = [&] {
                                      stopped.count_down();
                                      arrived.wait();
                                    }});
  test::RawClient much(server.port()), little(server.port());
  ASSERT_EQ(much.get("/livez").status, 200u);
  ASSERT_EQ(little.get("/livez").status, 200u);
  std::raise(SIGHUP);
  stopped.wait();
  std::string many;
  for (std::size_t i = 0; i < kMany; ++i) many += "HEAD /livez HTTP/1.1\r\nHost: a\r\n\r\n";
  EXPECT_TRUE(much.send(many));
  EXPECT_TRUE(little.send("GET /livez HTTP/1.1\r\nHost: a\r\n\r\n"));
  arrived.count_down();
  EXPECT_EQ(little.receive().status, 200u);
  const std::vector<std::string> all = methods(kMany + 3);
  ASSERT_EQ(all.size(), kMany + 3);
  const auto at = std::find(all.begin() + 2, all.end(), "GET") - all.begin();
  EXPECT_LT(at, static_cast<std::ptrdiff_t>(kMany / 2)) << "not behind all that the other sent";
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

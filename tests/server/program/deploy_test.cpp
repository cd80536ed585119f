// The examples of server/deploy beside the limits and addresses that they go by.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "server/program/command_line.h"
#include "server/session/services.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

/// The first group of `pattern` where it matches the file of server/deploy; "": nowhere.
std::string found(const char* file, const std::string& pattern) {
  std::ifstream in(std::filesystem::path(testing::kSourceFolder) / "server/deploy" / file);
  std::ostringstream text;
  text << in.rdbuf();
  const std::string all = text.str();
  std::smatch match;
  return std::regex_search(all, match, std::regex(pattern)) ? match[1].str() : "";
}

TEST(Deploy, theUnitWaitsForLongerThanAnyDrain) {
  const std::string seconds = found("qtet-server.service", "\nTimeoutStopSec=([0-9]+)\n");
  ASSERT_FALSE(seconds.empty());
  EXPECT_GT(std::chrono::seconds(std::stoll(seconds)), limits::kMaxDrainTime + limits::kGraceTime);
}

TEST(Deploy, caddyAsksWhetherTheServerIsReadyAtTheOperatorsAddress) {
  const std::string port = found("qtet-server.conf", "\nadmin = [^\n]*:([0-9]+)\n");
  ASSERT_FALSE(port.empty());
  EXPECT_EQ(found("Caddyfile", "\n\\s*health_port ([0-9]+)\n"), port);
  EXPECT_EQ(found("Caddyfile", "\n\\s*health_uri (\\S+)\n"), "/readyz");
}

}  // namespace
}  // namespace qtet

#include "server/command_line.h"

#include <gtest/gtest.h>

#include <vector>

namespace qtet {
namespace {

Result<CommandLine> parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "qtet-server");
  return parseCommandLine(static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandLine, aFolderIsEnough) {
  const auto line = parse({"logs"});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->folder, "logs");
  EXPECT_EQ(line->host, "127.0.0.1");
  EXPECT_EQ(line->port, 8080);
  EXPECT_GE(line->threads, 1u);
  EXPECT_FALSE(line->viewer);
}

TEST(CommandLine, everyOptionIsUnderstood) {
  const auto line = parse({"--port", "0", "--host=::1", "logs", "--viewer", "page", "--threads", "3"});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->folder, "logs");
  EXPECT_EQ(line->host, "::1");
  EXPECT_EQ(line->port, 0);
  EXPECT_EQ(line->viewer, "page");
  EXPECT_EQ(line->threads, 3u);
}

TEST(CommandLine, helpAndVersionNeedNoFolder) {
  EXPECT_EQ(parse({"--help"})->wish, CommandLine::Wish::kHelp);
  EXPECT_EQ(parse({"--version"})->wish, CommandLine::Wish::kVersion);
}

TEST(CommandLine, wrongUsageIsExplained) {
  for (const std::vector<const char*>& arguments : std::vector<std::vector<const char*>>{{},
                                                                                         {"a", "b"},
                                                                                         {"a", "--prot", "1"},
                                                                                         {"a", "--por", "1"},
                                                                                         {"a", "--port"},
                                                                                         {"a", "--port", "x"},
                                                                                         {"a", "--port", "-1"},
                                                                                         {"a", "--port", "65536"},
                                                                                         {"a", "--threads", "0"},
                                                                                         {"a", "--threads", "257"}}) {
    const auto line = parse(arguments);
    ASSERT_FALSE(line);
    EXPECT_EQ(line.error().code, ErrorCode::kBadValue);
    EXPECT_FALSE(line.error().message.empty());
  }
}

}  // namespace
}  // namespace qtet

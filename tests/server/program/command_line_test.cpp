#include "server/program/command_line.h"

#include <gtest/gtest.h>

#include <vector>

#include "server/wire/connection_limits.h"
#include "tests/server/store/synthetic_log.h"

namespace qtet {
namespace {

using Words = std::vector<const char*>;

Result<CommandLine> parse(Words arguments, Words environment = {}) {
  arguments.insert(arguments.begin(), "qtet-server");
  environment.push_back(nullptr);
  return parseCommandLine(static_cast<int>(arguments.size()), arguments.data(), environment.data());
}

TEST(CommandLine, aFolderIsEnough) {
  const auto line = parse({"logs"});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->folder, "logs");
  EXPECT_EQ(line->host, "127.0.0.1");
  EXPECT_EQ(line->port, 8080);
  EXPECT_GE(line->threads, 1u);
  EXPECT_TRUE(line->watch);
  EXPECT_FALSE(line->readyEarly);
  EXPECT_EQ(line->maxConnections, limits::kMaxConnections);
  EXPECT_FALSE(line->viewer || line->tokens || line->cache || line->accessLog || line->adminHost);
}

TEST(CommandLine, everyOptionIsUnderstood) {
  const auto line = parse({"--port",
                           "0",
                           "--host=::1",
                           "logs",
                           "--viewer",
                           "page",
                           "--threads",
                           "3",
                           "--watch",
                           "off",
                           "--ready-early",
                           "on",
                           "--admin",
                           "[::1]:9090",
                           "--cache",
                           "c",
                           "--cache-bytes",
                           "0",
                           "--access-log",
                           "-",
                           "--tokens",
                           "t",
                           "--max-upload-bytes",
                           "1",
                           "--max-check-bytes",
                           "5",
                           "--max-check-seconds",
                           "8",
                           "--max-connections",
                           "7",
                           "--max-connections-per-address",
                           "0",
                           "--max-levels-per-address",
                           "3",
                           "--max-level-bytes",
                           "6",
                           "--max-requests-per-second",
                           "9",
                           "--allow-origins",
                           "https://a.example,http://localhost:3000"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->allowedOrigins,
            (std::vector<std::string>{"https://a.example", "http://localhost:3000"}));
  EXPECT_EQ(line->folder, "logs");
  EXPECT_EQ(line->host, "::1");
  EXPECT_EQ(line->port, 0);
  EXPECT_EQ(line->viewer, "page");
  EXPECT_EQ(line->threads, 3u);
  EXPECT_FALSE(line->watch);
  EXPECT_TRUE(line->readyEarly);
  EXPECT_EQ(line->adminHost, "::1");
  EXPECT_EQ(line->adminPort, 9090);
  EXPECT_EQ(line->cache, "c");
  EXPECT_EQ(line->cacheBytes, 0u);
  EXPECT_EQ(line->accessLog, "-");
  EXPECT_EQ(line->tokens, "t");
  EXPECT_EQ(line->maxUploadBytes, 1u);
  EXPECT_EQ(line->maxCheckBytes, 5u);
  EXPECT_EQ(line->maxCheckTime, std::chrono::seconds(8));
  EXPECT_EQ(line->maxConnections, 7u);
  EXPECT_EQ(line->maxConnectionsPerAddress, 0u);
  EXPECT_EQ(line->maxLevelsPerAddress, 3u);
  EXPECT_EQ(line->maxLevelBytes, 6u);
  EXPECT_EQ(line->maxRequestsPerSecond, 9u);
}

TEST(CommandLine, whatIsNoOriginIsRefused) {
  for (const char* bad : {"a.example", "https://", "://a", "https://a.example/",
                          "https://a.example,", "https://a, https://b"}) {
    const bool taken = parse({"logs", "--allow-origins", bad}).has_value();
    // a comma at the end is nobody's fault
    EXPECT_EQ(taken, std::string(bad) == "https://a.example,") << bad;
  }
}

TEST(CommandLine, optionsComeBeforeTheEnvironmentAndThatBeforeTheFile) {
  const test::TempFolder folder;
  folder.write("conf", std::string_view(
                           "# settings\nfolder = from-file\nport = 1\nhost = h\nthreads = 2\n"));
  const std::string config = "QTET_SERVER_CONFIG=" + (folder.path() / "conf").string();
  const auto line = parse({"--port", "3"}, {config.c_str(), "QTET_SERVER_PORT=2",
                                            "QTET_SERVER_HOST=e", "QTETSERVER=x", "PATH=/bin"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->folder, "from-file");
  EXPECT_EQ(line->port, 3);
  EXPECT_EQ(line->host, "e");
  EXPECT_EQ(line->threads, 2u);
}

TEST(CommandLine, whatIsPrintedIsAFileThatSaysTheSame) {
  const auto line =
      parse({"logs", "--port", "5", "--admin", "[::1]:9090", "--watch", "off", "--tokens", "t",
             "--trust-proxy", "10.0.0.0/8,::1", "--proxy-header", "forwarded", "--check-config"});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->action, CommandLine::Action::kCheckConfig);
  const test::TempFolder folder;
  folder.write("conf", std::string_view(configText(*line)));
  const std::string config = (folder.path() / "conf").string();
  const auto again = parse({"--config", config.c_str()});
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(configText(*again), configText(*line));
}

TEST(CommandLine, helpAndVersionNeedNoFolder) {
  EXPECT_EQ(parse({"--help"})->action, CommandLine::Action::kHelp);
  EXPECT_EQ(parse({"--help-all"})->action, CommandLine::Action::kHelpAll);
  EXPECT_EQ(parse({"--version"})->action, CommandLine::Action::kVersion);
}

TEST(CommandLine, wrongUsageIsExplained) {
  for (const Words& arguments :
       std::vector<Words>{{},
                          {"a", "b"},
                          {"a", "--prot", "1"},
                          {"a", "--por", "1"},
                          {"a", "--port"},
                          {"a", "--port", "x"},
                          {"a", "--port", "-1"},
                          {"a", "--port", "65536"},
                          {"a", "--threads", "0"},
                          {"a", "--threads", "257"},
                          {"a", "--watch", "perhaps"},
                          {"a", "--frame-ancestors", "a; script-src *"},
                          {"a", "--frame-ancestors", ""},
                          {"a", "--trust-proxy", "10.0.0.0/40"},
                          {"a", "--trust-proxy", "::1", "--proxy-header", "via"},
                          {"a", "--proxy-header", "forwarded"},
                          {"a", "--admin", "9090"},
                          {"a", "--admin", ":9090"},
                          {"a", "--admin", "h:65536"},
                          {"a", "--max-connections", "0"},
                          {"a", "--max-check-bytes", "0"},
                          {"a", "--max-level-bytes", "0"},
                          {"a", "--max-check-seconds", "0"},
                          {"a", "--max-check-seconds", "1000001"},
                          {"a", "--cache-bytes", "99999999999999999999"}}) {
    const auto line = parse(arguments);
    ASSERT_FALSE(line);
    EXPECT_EQ(line.error().code, ErrorCode::kBadValue);
    EXPECT_FALSE(line.error().message.empty());
  }
  EXPECT_NE(parse({"a"}, {"QTET_SERVER_PROT=1"}).error().message.find("QTET_SERVER_PROT"),
            std::string::npos);
  EXPECT_EQ(parse({"a", "--config", "/nonexistent"}).error().code, ErrorCode::kIo);
  const test::TempFolder folder;
  folder.write("conf", std::string_view("prot = 1\n"));
  const std::string config = (folder.path() / "conf").string();
  EXPECT_NE(parse({"a", "--config", config.c_str()}).error().message.find("prot"),
            std::string::npos);
}

TEST(CommandLine, aWordThatHoldsThePlaceholderOfAnErrorsTextIsQuotedLikeAnyOther) {
  for (const char* word :
       {"--x%original_token%", "--%canonical_option%%prefix%", "--%option%", "--port%value%=1"}) {
    const auto line = parse({"a", word});
    ASSERT_FALSE(line) << word;
    EXPECT_NE(line.error().message.find(word), std::string::npos) << line.error().message;
  }
  const test::TempFolder folder;
  folder.write("conf", std::string_view("%original_token% = 1\n"));
  const std::string config = (folder.path() / "conf").string();
  EXPECT_NE(parse({"a", "--config", config.c_str()}).error().message.find("%original_token%"),
            std::string::npos);
}

}  // namespace
}  // namespace qtet

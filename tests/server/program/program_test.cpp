// The program itself: what it prints, its exit codes, and how it ends on a signal.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/types.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "proto/checksum.h"
#include "proto/version.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/program.h"
#include "tests/server/program/served_folder.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_log.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

using test::Program;

TEST(Program, helpAndVersionGoToStandardOutput) {
  Program help({"--help"}), all({"--help-all"});
  EXPECT_NE(help.output().find("Usage: qtet-server DIR"), std::string::npos);
  EXPECT_EQ(help.output().find("--max-check-bytes"), std::string::npos);
  EXPECT_NE(all.output().find("--max-check-bytes"), std::string::npos);
  std::istringstream lines(help.output() + all.output());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_EQ(help.exitCode(), 0);
  Program shown({"--version"});
  EXPECT_EQ(shown.output(), "qtet-server " + version() + "\n");
  EXPECT_EQ(shown.exitCode(), 0);
}

TEST(Program, wrongUsageIsExitCode2) {
  Program program({"--nonsense"});
  const std::string said = program.errors();
  EXPECT_NE(said.find("nonsense"), std::string::npos);
  EXPECT_TRUE(said.ends_with("\nqtet-server: see 'qtet-server --help'\n")) << said;
  EXPECT_EQ(std::ranges::count(said, '\n'), 2) << said;
  EXPECT_EQ(program.exitCode(), 2);
}

TEST(Program, whatCannotBeServedIsExitCode1) {
  Program folder({"/nonexistent", "--port", "0"});
  EXPECT_NE(folder.errors().find("/nonexistent"), std::string::npos);
  EXPECT_EQ(folder.exitCode(), 1);
  const test::ServedFolder served;
  Program viewer({served.logFolder(), "--port", "0", "--viewer", served.logFolder()});
  EXPECT_NE(viewer.errors().find("index.html"), std::string::npos);
  EXPECT_EQ(viewer.exitCode(), 1);
}

TEST(Program, aConfigurationCanBeCheckedWithoutServing) {
  const test::ServedFolder served;
  Program sound(
      {served.logFolder(), "--check-config", "--viewer", served.viewerFolder(), "--port", "1"});
  EXPECT_NE(sound.output().find("port = 1\n"), std::string::npos);
  EXPECT_EQ(sound.exitCode(), 0);
  test::TempFolder folder;
  folder.write("tokens", std::string_view("write * short\n"));
  Program wrong({served.logFolder(), "--check-config", "--viewer", served.viewerFolder(),
                 "--tokens", folder.path() / "tokens"});
  EXPECT_NE(wrong.errors().find("line 1"), std::string::npos);
  EXPECT_EQ(wrong.exitCode(), 1);
}

TEST(Program, anUploadThatIsKilledLeavesNothingVisibleAndCanBeGoneOnWith) {
  const std::string token = "aSecretOfTwentyTwoChars";
  const test::ServedFolder served;
  test::TempFolder folder;
  folder.write("tokens", std::string_view("write * " + token + "\n"));
  const Bytes bytes = testing::logBytes(testing::soundMesh(8, 55));
  const std::string log(bytes.begin(), bytes.end()), digest = sha256Hex(bytes);
  const std::vector<std::string> words = {
      served.logFolder(),   "--port", "0", "--tokens", folder.path() / "tokens", "--viewer",
      served.viewerFolder()};
  const auto head = [&](std::size_t first, const std::string& target) {
    return "PUT " + target + " HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + token +
           "\r\nContent-Length: " + std::to_string(log.size() - first) + "\r\n" +
           (first == 0
                ? ""
                : "Content-Range: bytes " + std::to_string(first) + "-" +
                      std::to_string(log.size() - 1) + "/" + std::to_string(log.size()) + "\r\n") +
           "\r\n";
  };
  const auto part = served.logFolder() / (".upload-" + digest + "-new.part");
  {
    Program program(words);
    const std::uint16_t port = program.port();
    ASSERT_NE(port, 0);
    test::RawClient named(port), nameless(port);
    named.send(head(0, "/v1/meshes/new?digest=" + digest) + log.substr(0, log.size() / 2));
    nameless.send(head(0, "/v1/meshes/new") + log.substr(0, 10));
    EXPECT_TRUE(test::eventually([&] { return std::filesystem::exists(part); }));
    program.signal(SIGKILL);
    EXPECT_EQ(program.exitCode(), 128 + SIGKILL);
  }
  Program program(words);
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0) << "two meshes, as before";
  std::error_code ec;
  const auto there = std::filesystem::file_size(part, ec);
  ASSERT_FALSE(ec);
  test::RawClient client(port);
  client.send(head(there, "/v1/meshes/new?digest=" + digest) + log.substr(there));
  EXPECT_EQ(client.receive().status, 201u);
  EXPECT_EQ(client.get("/v1/logs/" + digest + "/log").body, log);
  for (const auto& entry : std::filesystem::directory_iterator(served.logFolder()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

/// Names of a folder that begin so.
std::vector<std::string> namesIn(const std::filesystem::path& folder, std::string_view prefix) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const std::string name = entry.path().filename(); name.starts_with(prefix))
      out.push_back(name);
  return out;
}

TEST(Program, whatOneThatWasKilledInTheMidstOfALevelLeftIsGoneAfterTheNextStart) {
  const std::filesystem::path log = testing::sampleLog();
  test::TempFolder folder;
  const std::filesystem::path cache = folder.path() / "cache";
  const std::vector<std::string> words = {log.parent_path(), "--port", "0", "--cache", cache};
  const std::string level = "/v1/meshes/" + log.stem().string() + "/levels/1.vtu";
  const auto fetch = [&](std::uint16_t port) {
    test::RawClient client(port);
    return client.get(client.get(level).header("location")).status;
  };
  {
    Program program(words);
    const std::uint16_t port = program.port();
    ASSERT_NE(port, 0);
    const rlimit few{
        1000, 1000};  // bytes of a file; the write that goes beyond them is the process's last
    ASSERT_EQ(::prlimit(program.id(), RLIMIT_FSIZE, &few, nullptr), 0);
    EXPECT_EQ(fetch(port), 0u);
    EXPECT_EQ(program.exitCode(), 128 + SIGXFSZ);
  }
  ASSERT_EQ(namesIn(cache, ".").size(), 1u) << "the half of a level";
  Program program(words);
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  EXPECT_TRUE(namesIn(cache, ".").empty());
  EXPECT_EQ(fetch(port), 200u);
  EXPECT_EQ(namesIn(cache, "").size(), 1u);
}

TEST(Program, theTemporaryFolderOfOneThatWasKilledGoesAndThatOfOneThatRunsStays) {
  const test::ServedFolder served;
  test::TempFolder folder;
  const std::vector<std::string> words = {served.logFolder(), "--port", "0", "--viewer",
                                          served.viewerFolder()},
                                 where = {"TMPDIR=" + folder.path().string()};
  Program living(words, where), killed(words, where);
  ASSERT_NE(living.port(), 0);
  ASSERT_NE(killed.port(), 0);
  ASSERT_EQ(namesIn(folder.path(), "qtet-server-").size(), 2u);
  killed.signal(SIGKILL);
  EXPECT_EQ(killed.exitCode(), 128 + SIGKILL);
  const std::vector<std::string> left = namesIn(folder.path(), "qtet-server-");
  ASSERT_EQ(left.size(), 2u);
  Program next(words, where);
  ASSERT_NE(next.port(), 0);
  const std::vector<std::string> now = namesIn(folder.path(), "qtet-server-");
  EXPECT_EQ(now.size(), 2u);
  EXPECT_NE(std::set(now.begin(), now.end()), std::set(left.begin(), left.end()));
  living.signal(SIGTERM);
  EXPECT_EQ(living.exitCode(), 0);
  EXPECT_EQ(namesIn(folder.path(), "qtet-server-").size(), 1u);
}

TEST(Program, readsTokensAgainOnSighupAndKeepsThemWhereTheFileIsWrong) {
  const std::string first = "firstSecretOfManyChars", second = "secondSecretOfManyChars";
  const test::ServedFolder served;
  test::TempFolder folder;
  const std::string file = folder.path() / "tokens";
  folder.write("tokens", std::string_view("read * " + first + "\n"));
  Program program(
      {served.logFolder(), "--port", "0", "--tokens", file, "--viewer", served.viewerFolder()});
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  const auto status = [&](const std::string& token) {
    return test::RawClient(port)
        .get("/v1/meshes/noise", "Authorization: Bearer " + token + "\r\n")
        .status;
  };
  EXPECT_EQ(status(first), 200u);
  EXPECT_EQ(status(second), 401u);
  folder.write("tokens", std::string_view("read * " + second + "\n"));
  program.signal(SIGHUP);
  EXPECT_TRUE(test::eventually([&] { return status(second) == 200; }));
  EXPECT_EQ(status(first), 401u);
  // Wrong, cut off, and without the lines that guard reading: none of them opens what was guarded.
  std::size_t told = 0;
  for (const std::string_view text : {"read * short\n", "", "write * secretOfManyCharacters\n"}) {
    folder.write("tokens", text);
    program.signal(SIGHUP);
    ++told;
    EXPECT_TRUE(test::eventually([&] { return program.complaints("are kept") == told; })) << text;
    EXPECT_EQ(status(second), 200u) << text;
    EXPECT_EQ(status("anotherSecretOfManyChars"), 401u) << text;
  }
  program.signal(SIGTERM);
  EXPECT_EQ(program.exitCode(), 0);
}

TEST(Program, signalsOpenTheAccessLogAgain) {
  const test::ServedFolder served;
  const test::TempFolder folder;
  const std::filesystem::path log = folder.path() / "access.json", old = folder.path() / "old.json";
  Program program({served.logFolder(), "--port", "0", "--viewer", served.viewerFolder(),
                   "--access-log", log.string()});
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  std::size_t opened = 0;
  for (const int number : {SIGHUP, SIGUSR1}) {
    const auto before = std::filesystem::file_size(log);
    EXPECT_EQ(test::RawClient(port).get("/livez").status, 200u);
    EXPECT_TRUE(test::eventually([&] { return std::filesystem::file_size(log) > before; }));
    std::filesystem::rename(log, old);
    const auto size = std::filesystem::file_size(old);
    program.signal(number);
    ++opened;
    EXPECT_TRUE(test::eventually([&] { return program.complaints("opened again") == opened; }));
    EXPECT_EQ(test::RawClient(port).get("/readyz").status, 200u);
    EXPECT_TRUE(test::eventually([&] { return std::filesystem::file_size(log) > 0; }));
    EXPECT_EQ(std::filesystem::file_size(old), size);
  }
  program.signal(SIGTERM);
  EXPECT_EQ(program.exitCode(), 0);
}

TEST(Program, withoutTokensOrCertificateOutlivesSighup) {
  const test::ServedFolder served;
  Program program({served.logFolder(), "--port", "0", "--viewer", served.viewerFolder()});
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  program.signal(SIGHUP);
  EXPECT_TRUE(
      test::eventually([&] { return program.complaints("no tokens and no certificate") == 1; }));
  EXPECT_EQ(test::RawClient(port).get("/livez").status, 200u);
  program.signal(SIGTERM);
  EXPECT_EQ(program.exitCode(), 0);
}

TEST(Program, servesAndEndsOnSigtermWithZero) {
  for (const int number : {SIGTERM, SIGINT}) {
    const test::ServedFolder served;
    Program program(
        {served.logFolder(), "--port", "0", "--threads", "2", "--viewer", served.viewerFolder()});
    const std::uint16_t port = program.port();
    ASSERT_NE(port, 0);
    EXPECT_EQ(test::RawClient(port).get(served.log()).body, served.file());
    EXPECT_EQ(test::RawClient(port).get("/").status, 200u);
    test::StreamClient stream(port);
    ASSERT_TRUE(stream.send(R"({"type":"open","mesh":"noise","credit":0})"));
    ASSERT_TRUE(stream.receive());
    program.signal(number);
    EXPECT_EQ(stream.closeCode(), 1001u);
    EXPECT_EQ(program.exitCode(), 0);
  }
}

/// The processes that decode for it.
std::vector<pid_t> decodersOf(const Program& program) {
  const std::string thread = std::to_string(program.id());
  std::ifstream in("/proc/" + thread + "/task/" + thread + "/children");
  return {std::istream_iterator<pid_t>(in), {}};
}

TEST(Program, theDeathOfAProcessThatDecodesIsA500OfOneRequest) {
  const std::filesystem::path log = testing::sampleLog();
  Program program({log.parent_path(), "--port", "0"});
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  test::RawClient client(port);
  const std::string level =
      client.get("/v1/meshes/" + log.stem().string() + "/levels/1.vtu").header("location");
  const std::vector<pid_t> decoders = decodersOf(program);
  ASSERT_EQ(decoders.size(), limits::kLevelThreads + limits::kPointThreads + limits::kCheckThreads);
  for (const pid_t decoder : decoders) ::kill(decoder, SIGSTOP);
  client.send("GET " + level + " HTTP/1.1\r\nHost: a\r\n\r\n");
  test::RawClient other(port);
  EXPECT_TRUE(test::eventually([&] {
    return other.get("/metrics").body.find("qtet_decoders_running 1\n") != std::string::npos;
  })) << "served meanwhile";
  for (const pid_t decoder : decoders) ::kill(decoder, SIGKILL);
  const test::HttpResponse died = client.receive();
  EXPECT_EQ(died.status, 500u);
  EXPECT_NE(died.body.find("signal 9"), std::string::npos) << died.body;
  EXPECT_EQ(client.get(level).status, 200u) << "by the next process, on the same connection";
  EXPECT_NE(other.get("/metrics").body.find("qtet_decoders_lost_total 1\n"), std::string::npos);
  EXPECT_GE(program.complaints("was ended by signal 9"), 1u);
}

TEST(Program, aDamagedLogIsNamedAndTheOthersAreServed) {
  test::TempFolder folder;
  folder.write("good.qtet", test::makeLog(test::SyntheticLog()));
  folder.write("also.qtet", test::makeLog({.seed = 5}));
  folder.write("bad.qtet", "nonsense");
  Program program({folder.path(), "--port", "0"});
  const std::uint16_t port = program.port();
  ASSERT_NE(port, 0);
  EXPECT_EQ(test::RawClient(port).get("/v1/meshes/good").status, 200u);
  EXPECT_EQ(test::RawClient(port).get("/v1/meshes/bad").status, 404u);
  program.signal(SIGTERM);
  EXPECT_NE(program.errors().find("bad.qtet is not served"), std::string::npos);
  EXPECT_EQ(program.exitCode(), 0);
}

}  // namespace
}  // namespace qtet

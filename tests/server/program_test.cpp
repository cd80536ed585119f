// The program itself: what it prints, its exit codes, and how it ends on a signal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <regex>
#include <string>
#include <vector>

#include "proto/checksum.h"
#include "tests/server/loopback.h"
#include "tests/server/served_folder.h"

namespace qtet {
namespace {

/// The program as a child, its standard output and error in pipes.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    std::array<int, 2> out{}, err{};
    if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    arguments.insert(arguments.begin(), QTET_SERVER);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(err[1], STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(out[1]);
    ::close(err[1]);
    out_ = out[0];
    err_ = err[0];
  }
  ~Program() {
    if (child_ > 0) ::kill(child_, SIGKILL), (void)exitCode();
    ::close(out_);
    ::close(err_);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  std::string line() {
    std::string out;
    for (char c = 0; ::read(out_, &c, 1) == 1 && c != '\n';) out += c;
    return out;
  }
  std::string output() { return rest(out_); }
  std::string errors() { return rest(err_); }
  void signal(int number) const { ::kill(child_, number); }
  /// Waits for the end; 128 + n for a signal n.
  int exitCode() {
    int status = 0;
    ::waitpid(std::exchange(child_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  static std::string rest(int file) {
    std::string out;
    std::array<char, 4096> piece;
    for (ssize_t n = 0; (n = ::read(file, piece.data(), piece.size())) > 0;) out.append(piece.data(), static_cast<std::size_t>(n));
    return out;
  }

  pid_t child_ = -1;
  int out_ = -1;
  int err_ = -1;
};

std::uint16_t portOf(const std::string& line) {
  std::smatch match;
  return std::regex_match(line, match, std::regex(R"(qtet-server: listening on http://127\.0\.0\.1:(\d+)/ \(2 meshes\))"))
             ? static_cast<std::uint16_t>(std::stoi(match[1]))
             : std::uint16_t{0};
}

TEST(Program, helpAndVersionGoToStandardOutput) {
  Program help({"--help"});
  EXPECT_NE(help.output().find("Usage: qtet-server DIR"), std::string::npos);
  EXPECT_EQ(help.exitCode(), 0);
  Program version({"--version"});
  EXPECT_EQ(version.output(), "qtet-server " QTET_VERSION "\n");
  EXPECT_EQ(version.exitCode(), 0);
}

TEST(Program, wrongUsageIsExitCode2) {
  Program program({"--nonsense"});
  EXPECT_NE(program.errors().find("nonsense"), std::string::npos);
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
  Program sound({served.logFolder(), "--check-config", "--viewer", served.viewerFolder(), "--port", "1"});
  EXPECT_NE(sound.output().find("port = 1\n"), std::string::npos);
  EXPECT_EQ(sound.exitCode(), 0);
  test::TempFolder folder;
  folder.write("tokens", std::string_view("write * short\n"));
  Program wrong({served.logFolder(), "--check-config", "--viewer", served.viewerFolder(), "--tokens", folder.path() / "tokens"});
  EXPECT_NE(wrong.errors().find("line 1"), std::string::npos);
  EXPECT_EQ(wrong.exitCode(), 1);
}

TEST(Program, anUploadThatIsKilledLeavesNothingVisibleAndCanBeGoneOnWith) {
  const std::string token = "aSecretOfTwentyTwoChars";
  const test::ServedFolder served;
  test::TempFolder folder;
  folder.write("tokens", std::string_view("write * " + token + "\n"));
  const Bytes bytes = test::makeLog({.chunks = 40, .largestBlock = 60000, .seed = 55});
  const std::string log(bytes.begin(), bytes.end()), digest = sha256Hex(bytes);
  const std::vector<std::string> words = {served.logFolder(), "--port", "0", "--tokens", folder.path() / "tokens", "--viewer", served.viewerFolder()};
  const auto head = [&](std::size_t first, const std::string& target) {
    return "PUT " + target + " HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer " + token + "\r\nContent-Length: " + std::to_string(log.size() - first) +
           "\r\n" + (first == 0 ? "" : "Content-Range: bytes " + std::to_string(first) + "-" + std::to_string(log.size() - 1) + "/" + std::to_string(log.size()) + "\r\n") + "\r\n";
  };
  const auto part = served.logFolder() / (".upload-" + digest + ".part");
  {
    Program program(words);
    const std::uint16_t port = portOf(program.line());
    ASSERT_NE(port, 0);
    test::RawClient named(port), nameless(port);
    named.send(head(0, "/v1/meshes/new?digest=" + digest) + log.substr(0, log.size() / 2));
    nameless.send(head(0, "/v1/meshes/new") + log.substr(0, 10));
    const auto deadline = std::chrono::steady_clock::now() + test::kPatience;
    std::error_code ec;
    while (!std::filesystem::exists(part, ec) && std::chrono::steady_clock::now() < deadline)
      std::this_thread::yield();
    program.signal(SIGKILL);
    EXPECT_EQ(program.exitCode(), 128 + SIGKILL);
  }
  Program program(words);
  const std::uint16_t port = portOf(program.line());
  ASSERT_NE(port, 0) << "two meshes, as before";
  std::error_code ec;
  const auto there = std::filesystem::file_size(part, ec);
  ASSERT_FALSE(ec);
  test::RawClient client(port);
  client.send(head(there, "/v1/meshes/new?digest=" + digest) + log.substr(there));
  EXPECT_EQ(client.receive().status, 201u);
  EXPECT_EQ(client.get("/v1/logs/" + digest + "/log").body, log);
  for (const auto& entry : std::filesystem::directory_iterator(served.logFolder())) EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST(Program, servesAndEndsOnSigtermWithZero) {
  for (const int number : {SIGTERM, SIGINT}) {
    const test::ServedFolder served;
    Program program({served.logFolder(), "--port", "0", "--threads", "2", "--viewer", served.viewerFolder()});
    const std::uint16_t port = portOf(program.line());
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

TEST(Program, aDamagedLogIsNamedAndTheOthersAreServed) {
  test::TempFolder folder;
  folder.write("good.qtet", test::makeLog(test::SyntheticLog()));
  folder.write("also.qtet", test::makeLog({.seed = 5}));
  folder.write("bad.qtet", "nonsense");
  Program program({folder.path(), "--port", "0"});
  const std::uint16_t port = portOf(program.line());
  ASSERT_NE(port, 0);
  EXPECT_EQ(test::RawClient(port).get("/v1/meshes/good").status, 200u);
  EXPECT_EQ(test::RawClient(port).get("/v1/meshes/bad").status, 404u);
  program.signal(SIGTERM);
  EXPECT_NE(program.errors().find("bad.qtet is not served"), std::string::npos);
  EXPECT_EQ(program.exitCode(), 0);
}

}  // namespace
}  // namespace qtet

#include "tests/server/program/program.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/support/paths/test_paths.h"

namespace qtet::test {
namespace {

std::string rest(int file) {
  std::string out;
  std::array<char, 4096> piece;
  for (ssize_t n = 0; (n = ::read(file, piece.data(), piece.size())) > 0;)
    out.append(piece.data(), static_cast<std::size_t>(n));
  return out;
}

/// Word `index` of a file under /proc, counted from behind the name in brackets where there is one.
unsigned long long wordOf(const std::string& path, int index) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  std::istringstream words(
      text.str().substr(std::min(text.str().rfind(')') + 1, text.str().size())));
  std::string word;
  for (int i = 0; i <= index; ++i) words >> word;
  return word.empty() ? 0 : std::stoull(word);
}

}  // namespace

Program::Program(std::vector<std::string> arguments, const std::vector<std::string>& environment) {
  std::array<int, 2> out{};
  err_ = ::memfd_create("errors", MFD_CLOEXEC);
  if (::pipe2(out.data(), O_CLOEXEC) != 0 || err_ < 0) throw std::runtime_error("no pipe");
  const char* other = std::getenv("QTET_TESTED_SERVER");
  arguments.insert(arguments.begin(), other != nullptr ? other : testing::kServerProgram);
  std::vector<char*> argv, more;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::vector<std::string> added = environment;
  for (std::string& entry : added) more.push_back(entry.data());  // first, so that they count
  for (char** given = environ; *given != nullptr; ++given) more.push_back(*given);
  more.push_back(nullptr);
  child_ = ::fork();
  if (child_ == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err_, STDERR_FILENO);
    ::execve(argv[0], argv.data(), more.data());
    ::_exit(127);
  }
  ::close(out[1]);
  out_ = out[0];
}

Program::~Program() {
  if (child_ > 0) ::kill(child_, SIGKILL), (void)exitCode();
  ::close(out_);
  ::close(err_);
}

std::string Program::line() {
  std::string out;
  for (char c = 0; ::read(out_, &c, 1) == 1 && c != '\n';) out += c;
  return out;
}

std::uint16_t Program::port() {
  const std::string first = line();
  std::smatch match;
  const std::regex form(
      R"(qtet-server: listening on https?://127\.0\.0\.1:(\d+)/ \(\d+ mesh(es)?\))");
  return std::regex_match(first, match, form) ? static_cast<std::uint16_t>(std::stoi(match[1]))
                                              : std::uint16_t{0};
}

std::string Program::output() { return rest(out_); }

std::string Program::errors() {
  (void)rest(out_);  // ends with the program
  ::lseek(err_, 0, SEEK_SET);
  return rest(err_);
}

std::size_t Program::complaints(std::string_view text) const {
  // opened again, for a position of its own in the file
  std::ifstream in("/proc/self/fd/" + std::to_string(err_));
  std::stringstream told;
  told << in.rdbuf();
  std::size_t out = 0;
  for (std::size_t at = 0; (at = told.str().find(text, at)) != std::string::npos; ++at) ++out;
  return out;
}

void Program::signal(int number) const { ::kill(child_, number); }

bool Program::runs() const {
  siginfo_t ended{};
  return child_ > 0 &&
         ::waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         ended.si_pid == 0;
}

int Program::exitCode() {
  int status = 0;
  ::waitpid(std::exchange(child_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

double Program::cpuSeconds() const {
  const std::string stat = "/proc/" + std::to_string(child_) + "/stat";
  return static_cast<double>(wordOf(stat, 11) + wordOf(stat, 12)) /
         static_cast<double>(::sysconf(_SC_CLK_TCK));
}

std::size_t Program::residentBytes() const {
  return wordOf("/proc/" + std::to_string(child_) + "/statm", 1) *
         static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace qtet::test

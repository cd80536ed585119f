// qtet-server as a child process, with its standard output in a pipe and its standard error in a
// file.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace qtet::test {

/// The program of this build, or the one that QTET_TESTED_SERVER names: a sanitizer's.
class Program {
 public:
  /// `environment` is added to the test's own: NAME=VALUE.
  explicit Program(std::vector<std::string> arguments,
                   const std::vector<std::string>& environment = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] pid_t id() const { return child_; }
  /// The next line of standard output.
  std::string line();
  /// The port that its first line names, 0 where there is none.
  std::uint16_t port();
  /// The rest of standard output, up to its end. Standard error goes to a file, so that a full pipe
  /// blocks nobody.
  std::string output();
  std::string errors();
  /// How often `text` stands in the errors so far.
  [[nodiscard]] std::size_t complaints(std::string_view text) const;
  void signal(int number) const;
  [[nodiscard]] bool runs() const;
  /// Waits for the end; 128 + n for a signal n.
  int exitCode();
  /// Seconds of the processor's that it has taken.
  [[nodiscard]] double cpuSeconds() const;
  /// Bytes of memory of its own.
  [[nodiscard]] std::size_t residentBytes() const;

 private:
  pid_t child_ = -1;
  int out_ = -1;
  int err_ = -1;  // a file without a name
};

}  // namespace qtet::test

// qtet-server as a child process, its standard output and error in pipes.
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
  /// Of standard output.
  std::string line();
  /// The port that its first line names, 0 where there is none.
  std::uint16_t port();
  /// All of it, up to its end. Errors are read from the beginning on, so that nobody waits for a
  /// full pipe.
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

#include "tests/server/routes/push_run.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "tests/support/paths/test_paths.h"

namespace qtet::test {

PushOutcome runPush(const std::filesystem::path& file, const std::string& words,
                    const std::string& token, const std::function<void(const std::string&)>& hear) {
  const std::string command = "QTET_TOKEN='" + token + "' " + testing::kTool + " push '" +
                              file.string() + "' " + words + " 2>&1";
  PushOutcome out;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> piece;
  for (ssize_t n = 0; (n = ::read(::fileno(pipe), piece.data(), piece.size())) > 0;) {
    out.text.append(piece.data(), static_cast<std::size_t>(n));
    if (hear) hear(out.text);
  }
  const int status = ::pclose(pipe);
  out.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

}  // namespace qtet::test

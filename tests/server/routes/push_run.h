// `qtet push` as a child process.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace qtet::test {

inline constexpr const char* kPushToken = "aSecretOfTwentyTwoChars";

struct PushOutcome {
  int code = -1;
  std::string text;  ///< standard output and error
};

/// Pushes `file` with the shell's words behind it. `hear` receives the program's output so far.
[[nodiscard]] PushOutcome runPush(const std::filesystem::path& file, const std::string& words,
                                  const std::string& token = kPushToken,
                                  const std::function<void(const std::string&)>& hear = {});

}  // namespace qtet::test

// The command line of qtet-server.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "proto/error.h"

namespace qtet {

struct CommandLine {
  enum class Wish { kServe, kHelp, kVersion };
  Wish wish = Wish::kServe;
  std::filesystem::path folder;
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  std::optional<std::filesystem::path> viewer;
  std::size_t threads = 1;
};

/// Errors: bad-value with a sentence for the user.
[[nodiscard]] Result<CommandLine> parseCommandLine(int argc, const char* const* argv);
[[nodiscard]] std::string usageText();

}  // namespace qtet

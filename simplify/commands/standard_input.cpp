#include "simplify/commands/standard_input.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace qtet {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// The places of "-" as an input.
std::vector<std::size_t> placesOf(const Words& words) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool isOutput = i > 0 && (words[i - 1] == "-o" || words[i - 1] == "--output");
    if (words[i] == "-" && !isOutput) out.push_back(i);
  }
  return out;
}

/// What --format says, in either way of writing it.
std::string formatAmong(const Words& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].starts_with("--format=")) return words[i].substr(std::strlen("--format="));
    if (words[i] == "--format" && i + 1 < words.size()) return words[i + 1];
  }
  return {};
}

Status copyTo(const std::filesystem::path& file, int input, std::uint64_t most) {
  std::ofstream out(file, std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  std::uint64_t bytes = 0;
  for (;;) {
    const ssize_t got = ::read(input, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      return fail(ErrorCode::kIo,
                  std::string("the standard input cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    bytes += static_cast<std::uint64_t>(got);
    if (bytes > most)
      return fail(ErrorCode::kLimitExceeded, "the standard input has more than " +
                                                 std::to_string(most) +
                                                 " bytes; give a file's name instead of -");
    if (!out.write(piece.data(), got)) break;
  }
  if (!out.flush())
    return fail(ErrorCode::kIo, "the standard input does not fit into " +
                                    file.parent_path().parent_path().string() +
                                    "; let TMPDIR name a folder with room");
  if (bytes == 0)
    return fail(ErrorCode::kTruncated, "the standard input is empty; what should have written it?");
  return {};
}

}  // namespace

Result<std::unique_ptr<GuardedFolder>> spoolStandardInput(Words& words, std::string_view ending,
                                                          int input, std::uint64_t most) {
  const std::vector<std::size_t> places = placesOf(words);
  if (places.empty()) return nullptr;
  if (places.size() > 1)
    return fail(ErrorCode::kBadInput, "- stands for the standard input and can be given once");
  std::string kind = ending.empty() ? formatAmong(words) : std::string(ending);
  if (kind.starts_with('.')) kind.erase(0, 1);
  if (kind.empty() ||
      !std::ranges::all_of(kind, [](unsigned char c) { return std::isalnum(c) != 0; }))
    return fail(ErrorCode::kBadInput,
                "- is the standard input, which has no name: say with --format what kind of file "
                "it is, for example --format vtu");
  if (::isatty(input) == 1)
    return fail(
        ErrorCode::kIo,
        "- is the standard input, which is a terminal; send a file into it: qtet ... - <FILE");
  auto folder = std::make_unique<GuardedFolder>("pipe");
  if (folder->failure())
    return fail(ErrorCode::kIo, "no temporary folder can be made (" + folder->failure().message() +
                                    "); let TMPDIR name one with room");
  const std::filesystem::path file = folder->path() / (std::string(kPipedFile) + "." + kind);
  if (Status copied = copyTo(file, input, most); !copied) return std::unexpected(copied.error());
  words[places.front()] = file.string();
  return folder;
}

}  // namespace qtet

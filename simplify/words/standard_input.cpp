#include "simplify/words/standard_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

namespace qtet {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Whether the word names what can be read once alone: a pipe, or a device such as a terminal.
bool isPipe(const std::string& word) {
  if (word.empty() || word.starts_with('-')) return false;
  std::error_code code;
  const std::filesystem::file_type type = std::filesystem::status(word, code).type();
  return type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character;
}

/// The places of "-" and of pipes as an input.
std::vector<std::size_t> placesOf(const Words& words) {
  constexpr std::array<std::string_view, 6> kOthersFiles{"-o",       "--output",     "--against",
                                                         "--plot3d", "--token-file", "--from"};
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool isOption =
        i > 0 && std::ranges::find(kOthersFiles, words[i - 1]) != kOthersFiles.end();
    if (!isOption && (words[i] == "-" || isPipe(words[i]))) out.push_back(i);
  }
  return out;
}

/// A file that is open for reading while this lives.
class OpenFile {
 public:
  explicit OpenFile(const std::string& name) : file_(::open(name.c_str(), O_RDONLY | O_CLOEXEC)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  [[nodiscard]] int file() const { return file_; }

 private:
  int file_;
};

/// The value of --format, in either way of writing it.
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

bool isGzip(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return in.get() == 0x1F && in.get() == 0x8B;  // RFC 1952, 2.3.1
}

}  // namespace

Result<std::unique_ptr<GuardedFolder>> spoolStandardInput(Words& words, std::string_view ending,
                                                          int input, std::uint64_t most) {
  const std::vector<std::size_t> places = placesOf(words);
  if (places.empty()) return nullptr;
  if (places.size() > 1)
    return fail(ErrorCode::kBadInput,
                "- means the standard input and can be given once, as any pipe");
  const std::string named = words[places.front()] == "-" ? "" : words[places.front()];
  std::string kind = ending.empty() ? formatAmong(words) : std::string(ending);
  if (kind.empty()) kind = std::filesystem::path(named).extension().string();
  if (kind == ".gz") kind = std::filesystem::path(named).stem().extension().string();
  if (kind.starts_with('.')) kind.erase(0, 1);
  if (kind.ends_with(".gz")) kind.resize(kind.size() - std::strlen(".gz"));
  if (kind.empty() ||
      !std::ranges::all_of(kind, [](unsigned char c) { return std::isalnum(c) != 0; }))
    return fail(ErrorCode::kBadInput,
                (named.empty() ? "- is the standard input, which has no name"
                               : named + " is a pipe whose name does not say what it gives") +
                    std::string(": say with --format what kind of file it is, for example "
                                "--format vtu"));
  std::optional<OpenFile> pipe;
  if (!named.empty()) {
    input = pipe.emplace(named).file();
    if (input < 0)
      return fail(ErrorCode::kIo, "cannot read " + named + ": " + std::strerror(errno));
  }
  if (::isatty(input) == 1)
    return fail(
        ErrorCode::kIo,
        "- is the standard input, which is a terminal; send a file into it: qtet ... - <FILE");
  auto folder = std::make_unique<GuardedFolder>("pipe");
  if (Status made = folder->made(); !made) return std::unexpected(made.error());
  std::filesystem::path file = folder->path() / (std::string(kPipedFile) + "." + kind);
  if (Status copied = copyTo(file, input, most); !copied) return std::unexpected(copied.error());
  if (ending.empty() && isGzip(file)) {
    const std::filesystem::path plain = std::exchange(file, file.string() + ".gz");
    std::filesystem::rename(plain, file);
  }
  words[places.front()] = file.string();
  return folder;
}

}  // namespace qtet

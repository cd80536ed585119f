#include "simplify/read/foreign/foreign_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "simplify/read/foreign/foreign_programs.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/read/process/watch_process.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The program's exit codes (steps.py), and a shell's where there is no such program.
constexpr int kNoProgram = 127, kNoModule = 77, kNoSuchKind = 78, kNoMemory = 3;
constexpr int kKilled = -1, kStuck = -2;  ///< not by itself
/// Between two looks at the program.
constexpr int kPauseMs = 50;
/// All lines of one answer: a thousand times those of a file of a thousand blocks.
constexpr std::size_t kMaxAnswerBytes = std::size_t{64} << 20;

std::string lastLineOf(const fs::path& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last.empty() ? "it ended without a word" : last;
}

const char* nameOf(ForeignLibrary library) {
  return library == ForeignLibrary::kVtk ? "VTK" : "meshio";
}

std::string notInstalled(const ForeignInput& input, const std::string& kind) {
  if (input.library == ForeignLibrary::kVtk)
    return "its format is read by VTK's module for Python, which is not installed; install it (apt "
           "install python3-vtk9, or pip install vtk), or save the mesh as .vtu";
  return "files of type '" + kind +
         "' are read through meshio, which is not installed; install it (apt install "
         "python3-meshio, or pip install meshio), or save the mesh as .vtu; if it is one of "
         "another kind, say which with `format`: " +
         knownEndings();
}

/// Why the program ended with `code`, and what to do about it.
std::unexpected<Error> ended(int code, const ForeignInput& input, const fs::path& words) {
  const std::string kind = input.kind.empty() ? input.path.extension().string() : input.kind,
                    library = nameOf(input.library);
  switch (code) {
    case kNoProgram:
    case kNoModule:
      return fail(ErrorCode::kNotFound, input.path.string() + ": " + notInstalled(input, kind));
    case kStuck:
      return badFile(input.path,
                     library + " has neither read nor written anything for " +
                         std::to_string(input.patience.count()) +
                         " s, so that it seems to wait for what the file does not hold; if it is "
                         "only large, give it longer with `readSeconds`, else export the mesh "
                         "again, best as .vtu");
    case kNoMemory:
      return badFile(
          input.path,
          library +
              " wants more memory for it than this machine has: a count in it is wrong, "
              "or it is too large for this machine; export the mesh again, best as .vtu");
    case kNoSuchKind:
      return badFile(input.path, "files of type '" + kind +
                                     "' are not read; say with `format` what it is: " +
                                     knownEndings() + ", or an ending that meshio knows");
    case kKilled:
      if (input.library == ForeignLibrary::kVtk)
        return badFile(input.path,
                       "VTK crashes on it: its counts contradict each other, or it is too large "
                       "for this machine; export the mesh again, best as .vtu");
      [[fallthrough]];
    default:
      return badFile(input.path, library + " could not read it: " + lastLineOf(words) +
                                     "; save the mesh as .vtu");
  }
}

/// The words of an answer's line behind its first, between tabulators.
std::vector<std::string> wordsOf(std::string_view line) {
  std::vector<std::string> out;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find('\t'), line.size());
    out.emplace_back(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return out;
}

}  // namespace

/// The process, its folder, and the socket on which it is asked and answers.
class ForeignFile::Program {
 public:
  explicit Program(ForeignInput input) : input_(std::move(input)), folder_("read") {}
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { (void)end(true); }

  [[nodiscard]] const GuardedFolder& folder() const { return folder_; }

  /// Starts it by that Python. False: no process could be made.
  [[nodiscard]] bool start(const char* python) {
    int ends[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
    // whole, since the program leaves this process's folder
    const std::string in = fs::absolute(input_.path).string(), out = folder_.path().string(),
                      beside =
                          input_.companion.empty() ? "" : fs::absolute(input_.companion).string();
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would wait for it
      const int words = ::open(wordsPath().c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(ends[1], STDIN_FILENO);
      ::dup2(ends[1], STDOUT_FILENO);
      ::dup2(words, STDERR_FILENO);
      boundMemory();
      ::execlp(python, python, "-c",
               input_.library == ForeignLibrary::kVtk ? kVtkProgram : kMeshioProgram, in.c_str(),
               out.c_str(), input_.kind.c_str(), beside.c_str(), static_cast<char*>(nullptr));
      ::_exit(kNoProgram);
    }
    ::close(ends[1]);
    socket_ = ends[0];
    buffer_.clear();
    return child_ > 0;
  }

  /// The lines of its next answer, up to and without one that is `last` or begins with it and a
  /// blank, which `closing` gets. Errors: as ForeignFile::open.
  [[nodiscard]] Result<std::vector<std::string>> answer(std::string_view last,
                                                        std::string& closing) {
    std::vector<std::string> lines;
    std::size_t bytes = 0;
    for (;;) {
      Result<std::string> line = nextLine();
      if (!line) return std::unexpected(line.error());
      bytes += line->size();
      if (line->starts_with("failed ")) return badFile(input_.path, line->substr(7));
      if (*line == last || line->starts_with(std::string(last) + " ")) {
        closing = line->substr(std::min(last.size() + 1, line->size()));
        return lines;
      }
      if (bytes > kMaxAnswerBytes) return ended(end(true), input_, wordsPath());
      lines.push_back(std::move(*line));
    }
  }

  void ask(std::size_t number) const {
    const std::string text = std::to_string(number) + "\n";
    // a program that has ended is met when its answer is read
    (void)::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }

  /// Ends it, by force if `kills`, and returns how it ended.
  int end(bool kills) {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    if (child_ <= 0) return kKilled;
    if (kills) ::kill(child_, SIGKILL);
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : kKilled;
  }

  [[nodiscard]] fs::path wordsPath() const { return folder_.path() / "words.txt"; }
  /// How the program ended, where its answer did not come.
  [[nodiscard]] std::optional<int> code() const { return code_; }

 private:
  Result<std::string> nextLine() {
    ProcessWatch watch(child_, input_.patience);
    for (;;) {
      if (const std::size_t at = buffer_.find('\n'); at != std::string::npos) {
        std::string line = buffer_.substr(0, at);
        buffer_.erase(0, at + 1);
        return line;
      }
      pollfd waiting{socket_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, kPauseMs);
      if (ready == 0 && !watch.isStuck()) continue;
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0) {
        (void)end(true);
        return failed(kStuck);
      }
      char piece[4096];
      const ssize_t got = ::recv(socket_, piece, sizeof piece, 0);
      if (got <= 0 || buffer_.size() > kMaxAnswerBytes) return failed(end(got > 0));
      buffer_.append(piece, static_cast<std::size_t>(got));
    }
  }

  std::unexpected<Error> failed(int code) {
    code_ = code;
    return ended(code, input_, wordsPath());
  }

  ForeignInput input_;
  GuardedFolder folder_;
  pid_t child_ = -1;
  int socket_ = -1;
  std::string buffer_;  ///< received, and not taken
  std::optional<int> code_;
};

ForeignFile::ForeignFile(std::unique_ptr<Program> program) : program_(std::move(program)) {}
ForeignFile::ForeignFile(ForeignFile&&) noexcept = default;
ForeignFile::~ForeignFile() = default;

Result<ForeignFile> ForeignFile::open(const ForeignInput& input) {
  ForeignFile out(std::make_unique<Program>(input));
  Program& program = *out.program_;
  if (Status made = program.folder().made(); !made) return std::unexpected(made.error());
  Result<std::vector<std::string>> lines = std::vector<std::string>{};
  std::string times;
  // The first python3 may be one of the user's own; Debian's has Debian's modules.
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (!program.start(python))
      return fail(ErrorCode::kIo, "no process could be made to read " + input.path.string());
    lines = program.answer("times", times);
    if (lines || (program.code() != kNoProgram && program.code() != kNoModule)) break;
  }
  if (!lines) return std::unexpected(lines.error());
  for (std::string& line : *lines)
    if (line.starts_with("note ")) out.notes_.push_back(line.substr(5));
  for (const std::string& word : wordsOf(times)) {
    double time = 0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), time);
    if (read.ec != std::errc{})
      return badFile(input.path, "a time of it is " + word + ", which is none");
    out.times_.push_back(time);
  }
  return out;
}

Result<std::vector<BlockFile>> ForeignFile::step(std::size_t number,
                                                 std::vector<std::string>& notes) {
  assert(number < std::max<std::size_t>(1, times_.size()));
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  const fs::path& folder = program_->folder().path();
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.path() != program_->wordsPath()) fs::remove(entry.path(), ignored);
  program_->ask(number);
  std::string nothing;
  const auto lines = program_->answer("done", nothing);
  if (!lines) return std::unexpected(lines.error());
  std::vector<BlockFile> out;
  for (const std::string& line : *lines) {
    if (line.starts_with("note ")) notes.push_back(line.substr(5));
    if (!line.starts_with("block ")) continue;
    const std::vector<std::string> words = wordsOf(std::string_view(line).substr(6));
    // a spoilt program names files of its own folder alone
    const fs::path name = words.empty() ? fs::path() : fs::path(words.front()).filename();
    out.push_back({folder / name, words.size() > 1 ? words[1] : ""});
  }
  return out;
}

}  // namespace qtet

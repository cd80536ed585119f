#include "simplify/words/output.h"

#include <unistd.h>
#include <cassert>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "codec/files/atomic_file.h"

namespace qtet {

namespace fs = std::filesystem;

std::string Output::name() const {
  return stream != nullptr ? "the standard output" : file.string();
}

void addNoClobber(po::options_description& options) {
  options.add_options()("no-clobber", "refuse an output that exists, instead of replacing it");
}

Output outputOf(const ParsedWords& parsed, const Console& console) {
  assert(parsed.has("output"));
  const bool isStandardOutput = parsed.get<std::string>("output") == "-";
  if (isStandardOutput && parsed.has("json"))
    throw UsageError(
        "-o - and --json both want the standard output; give the output a name, or leave --json "
        "out");
  return {parsed.get<std::string>("output"), parsed.has("no-clobber"),
          isStandardOutput ? &console.out : nullptr};
}

Status checkOutput(const Output& output, const std::string& extensions,
                   const std::optional<fs::path>& input) {
  if (output.stream != nullptr) return checkNoTerminal();
  const fs::path& file = output.file;
  std::istringstream known(extensions);
  if (std::find(std::istream_iterator<std::string>(known), {}, file.extension().string()) ==
      std::istream_iterator<std::string>())
    throw UsageError("the output " + file.string() + " must end in " +
                     (extensions.find(' ') == std::string::npos ? "" : "one of ") + extensions);
  const Result<fs::path> folder = folderBehindLinks(file);
  if (!folder) return std::unexpected(folder.error());
  std::error_code code;
  if (fs::is_directory(file, code))
    return fail(ErrorCode::kIo,
                "the output " + file.string() + " is a folder; give the name of a file");
  if (::access(folder->c_str(), W_OK) != 0)
    return fail(ErrorCode::kIo, "the folder " + folder->string() +
                                    " of the output cannot be written; choose another output");
  if (input && fs::equivalent(file, *input, code)) {
    return fail(ErrorCode::kIo,
                "the output " + file.string() +
                    " is the input itself; choose another name, the input is never overwritten");
  }
  return checkKeepsOld(output);
}

Status checkKeepsOld(const Output& output) {
  std::error_code code;
  if (!output.keepsOld || output.stream != nullptr || !fs::exists(output.file, code)) return {};
  return fail(ErrorCode::kIo, "the output " + output.file.string() +
                                  " exists; choose another name, or leave out --no-clobber");
}

Status checkNoTerminal() {
  if (::isatty(STDOUT_FILENO) != 1) return {};
  return fail(ErrorCode::kIo,
              "-o - is the standard output, which is a terminal; send it into a file or a program: "
              "qtet ... -o - >FILE");
}

Status writeOutput(const Output& output, const ByteSource& content) {
  if (output.stream != nullptr) {
    // a stream that fails is reported once, when the command ends
    return content([&](ByteView piece) -> Status {
      output.stream->write(reinterpret_cast<const char*>(piece.data()),
                           static_cast<std::streamsize>(piece.size()));
      return {};
    });
  }
  if (Status kept = checkKeepsOld(output); !kept) return kept;
  return writeFileAtomically(output.file, content);
}

Status writeOutput(const Output& output, ByteView bytes) {
  return writeOutput(output, [bytes](const ByteSink& sink) { return sink(bytes); });
}

void reportOutput(const Output& output, const std::string& lines, Console& console) {
  if (output.stream == nullptr) {
    console.out << lines;
    return;
  }
  std::istringstream each(lines);
  for (std::string line; std::getline(each, line);) console.note(line);
}

}  // namespace qtet

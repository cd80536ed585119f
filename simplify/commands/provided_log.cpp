#include "simplify/commands/provided_log.h"

#include "codec/files/unreachable.h"
#include "simplify/commands/commands.h"
#include "simplify/read/listed_files.h"
#include "simplify/words/json_report.h"
#include "simplify/words/read_words.h"

namespace qtet {

namespace fs = std::filesystem;

std::string meshNameOf(const fs::path& file) {
  std::string name = file.stem().string();
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
          (c == '.' && &c != name.data())))
      c = '_';
  return name.empty() ? "mesh" : name;
}

int provideLog(const fs::path& input, const fs::path& log, const ParsedWords& parsed,
               Console& console) {
  const auto failed = [&](ErrorCode kind, const std::string& message) {
    return reportFailure({kind, message, Error::kNoOffset}, false, console);
  };
  std::error_code code;
  const bool isThere = fs::is_regular_file(input, code) || namesFiles(input);
  if (isUnreachable(code))
    return failed(ErrorCode::kIo, "cannot read " + input.string() + ": " + code.message());
  if (!isThere)
    return failed(ErrorCode::kNotFound,
                  "there is no file " + input.string() + "; give a mesh or a log");
  if (input.extension() == ".qtet") {
    fs::create_hard_link(fs::canonical(input, code), log, code);
    if (code) fs::copy_file(input, log, code);
    if (!code) return kExitOk;
    return failed(ErrorCode::kIo, "cannot put " + input.string() + " into " +
                                      log.parent_path().string() + ": " + code.message());
  }
  std::ostream nowhere(nullptr);
  Console quiet = {nowhere, console.err,   console.errIsTerminal,
                   false,   console.quiet, console.verbose};
  Words words = readWordsOf(parsed);
  words.insert(words.end(),
               {input.string(), "-o", log.string(), "--fields", parsed.get<std::string>("fields")});
  return runSimplify(words, quiet);
}

}  // namespace qtet

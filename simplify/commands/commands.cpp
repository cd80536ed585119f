
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "proto/version.h"
#include "simplify/commands/commands.h"
#include "simplify/words/did_you_mean.h"
#include "simplify/words/standard_input.h"
#include "simplify/words/usage_error.h"

namespace qtet {
namespace {

constexpr std::array<Command, 16> kCommands{{
    {"sample", "make a mesh to try things with", runSample, true},
    {"check", "say what is wrong with a mesh, and what simplify would do about it", runCheck, false,
     Command::Pipe::kMesh},
    {"convert", "write a mesh of any format that is read as another one", runConvert, true,
     Command::Pipe::kMesh},
    {"simplify", "turn a volume mesh into a log", runSimplify, true, Command::Pipe::kMesh},
    {"info", "say what a log holds, level by level", runInfo, false, Command::Pipe::kLog},
    {"extract", "write one level of a log as an ordinary mesh", runExtract, true,
     Command::Pipe::kLog},
    {"add-field", "add fields of a mesh file to a log", runAddField, true},
    {"add-steps", "add time steps behind those that a log has", runAddSteps, true},
    {"remove-field", "leave fields of a log out", runRemoveField, true},
    {"verify", "check a log, also against the mesh that it was made from", runVerify, false,
     Command::Pipe::kLog},
    {"push", "send a log to a server", runPush, true},
    {"publish", "make a folder for any web server: the viewer and logs", runPublish, true},
    {"page", "make one HTML file of the viewer and a mesh or a log", runPage, true,
     Command::Pipe::kMesh},
    {"view", "show a mesh or a log in the browser", runView, false, Command::Pipe::kMesh},
    {"completion", "print what makes a shell complete qtet's words", runCompletion},
    {"manual", "write the manual pages", runManual, true},
}};

void printHelp(std::ostream& out) {
  out << R"(usage: qtet COMMAND [options]

Turns tetrahedral simulation meshes into logs that a browser can show coarse-first, and back.

commands:
)";
  for (const Command& command : kCommands)
    out << "  " << std::left << std::setw(13) << command.name << command.summary << "\n";
  out << R"(  help         say more about one of them, as --help after it does

  qtet --version tells the version.
  - instead of a mesh's or a log's name is the standard input, -o - the standard output.
  --no-clobber refuses an output that exists.
  Every command knows --quiet and --verbose. NO_COLOR in the environment keeps colours away.

examples:
  qtet sample fin -o fin.vtu
  qtet check fin.vtu
  qtet view fin.vtu
  qtet simplify fin.vtu -o fin.qtet
  qtet info fin.qtet
  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu
  curl -s http://HOST/fin.vtu | qtet check - --format vtu
  qtet verify fin.qtet --against fin.vtu
  QTET_TOKEN=... qtet push fin.qtet http://127.0.0.1:8080/
  qtet publish site fin.qtet
  qtet page fin.qtet -o fin.html

exit codes: 0 done, 1 an input or a file is at fault, 2 the command line is
)";
}

/// Two lines: what is wrong with the words, and where the right ones stand. `command` is empty, or
/// a command and a blank.
int refuseWords(const std::string& what, const std::string& command, const Console& console) {
  console.err << "qtet: " << printable(what) << "\nqtet: see 'qtet " << command << "--help'\n";
  return kExitUsage;
}

/// Takes --quiet and --verbose out of the words, wherever they stand.
Words withoutManners(Words words, Console& console) {
  std::erase_if(words, [&](const std::string& word) {
    const bool quiet = word == "--quiet" || word == "-q",
               verbose = word == "--verbose" || word == "-v";
    console.quiet |= quiet;
    console.verbose |= verbose;
    return quiet || verbose;
  });
  return words;
}

void tellMemory(const Console& console) {
  rusage used{};
  if (console.verbose && ::getrusage(RUSAGE_SELF, &used) == 0)
    console.err << "qtet: " << used.ru_maxrss / 1024 << " MB of memory at most\n";
}

int runCommand(const Command& command, const Words& given, Console& console) {
  Words words = withoutManners(given, console);
  const auto isAnswer = [](const std::string& word) {
    return word == "--json" || word.starts_with("--help") || word == "-h" || word == "-" ||
           word == "-o-" || word.ends_with("=-");
  };
  const bool isAsked = std::ranges::any_of(words, isAnswer);
  std::unique_ptr<GuardedFolder> piped;
  if (command.pipe != Command::Pipe::kNone) {
    Result<std::unique_ptr<GuardedFolder>> spooled =
        spoolStandardInput(words, command.pipe == Command::Pipe::kLog ? "qtet" : "", STDIN_FILENO);
    if (!spooled) {
      if (spooled.error().code == ErrorCode::kBadInput)
        return refuseWords(spooled.error().message, std::string(command.name) + " ", console);
      console.err << "qtet: " << spooled.error().text() << "\n";
      return kExitFailed;
    }
    piped = std::move(*spooled);
    if (piped)
      console.piped = *std::ranges::find_if(
          words, [&](const std::string& word) { return word.starts_with(piped->path().string()); });
  }
  std::ostream nowhere(nullptr);
  Console silent{nowhere, console.err,     console.errIsTerminal, false,
                 true,    console.verbose, console.piped};
  try {
    const bool silenced = console.quiet && command.makesFile && !isAsked;
    const int code = command.run(words, silenced ? silent : console);
    tellMemory(console);
    if (console.out.flush()) return code;
    console.err
        << "qtet: the result could not be written to the standard output; is the disk full?\n";
    return kExitFailed;
  } catch (const UsageError& error) {
    return refuseWords(error.what(), std::string(command.name) + " ", console);
  }
}

const Command* findCommand(const std::string& name) {
  const auto found = std::ranges::find(kCommands, name, &Command::name);
  return found == kCommands.end() ? nullptr : &*found;
}

int refuseCommand(const std::string& name, Console& console) {
  std::string text;
  std::vector<std::string> known{"help"};
  for (const Command& candidate : kCommands) {
    known.emplace_back(candidate.name);
    text += (text.empty() ? "" : ", ") + known.back();
  }
  const std::string near = didYouMean(name, known);
  return refuseWords(
      (name.empty() ? "a command is missing" : "there is no command '" + name + "'") + near +
          (near.empty() ? "; there are: " : " There are: ") + text,
      "", console);
}

/// `qtet help`, `qtet help COMMAND`.
int runHelp(const Words& words, Console& console) {
  const bool ofItself = words.size() == 1 && (words[0] == "help" || words[0] == "--help");
  if (words.empty() || ofItself) {
    printHelp(console.out);
    return kExitOk;
  }
  if (words.size() > 1)
    return refuseWords("'" + words[1] + "' is one word too many, 'qtet help' takes one command", "",
                       console);
  const Command* command = findCommand(words.front());
  return command != nullptr ? runCommand(*command, {"--help"}, console)
                            : refuseCommand(words.front(), console);
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

int runTool(const Words& words, Console& console) {
  const std::string first = words.empty() ? "" : words.front();
  if (first == "--version") {
    console.out << "qtet " << version() << '\n';
    return kExitOk;
  }
  const Words rest = words.empty() ? Words() : Words(words.begin() + 1, words.end());
  if (first == "--help" || first == "-h" || first == "help") return runHelp(rest, console);
  const Command* command = findCommand(first);
  return command != nullptr ? runCommand(*command, rest, console) : refuseCommand(first, console);
}

}  // namespace qtet

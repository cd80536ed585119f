#include "simplify/commands.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "simplify/command_line.h"

namespace qtet {
namespace {

constexpr std::array<Command, 10> kCommands{{
    {"sample", "make a mesh to try things with", runSample},
    {"check", "say what is wrong with a mesh, and what simplify would do about it", runCheck},
    {"convert", "write a mesh of any format that is read as .vtu", runConvert},
    {"simplify", "turn a volume mesh into a log", runSimplify},
    {"info", "say what a log holds, level by level", runInfo},
    {"extract", "write one level of a log as an ordinary mesh", runExtract},
    {"add-field", "add fields of a mesh file to a log", runAddField},
    {"remove-field", "leave fields of a log out", runRemoveField},
    {"verify", "check a log, also against the mesh that it was made from", runVerify},
    {"push", "send a log to a server", runPush},
}};

void printHelp(std::ostream& out) {
  out << "usage: qtet COMMAND [options]\n\nTurns tetrahedral simulation meshes into logs that a browser can show coarse-first, and "
         "back.\n\ncommands:\n";
  for (const Command& command : kCommands) out << "  " << std::left << std::setw(13) << command.name << command.summary << "\n";
  out << "\n  qtet COMMAND --help says more about each; qtet --version tells the version.\n"
         "\nexamples:\n"
         "  qtet sample fin -o fin.vtu\n"
         "  qtet check fin.vtu\n"
         "  qtet simplify fin.vtu -o fin.qtet\n"
         "  qtet info fin.qtet\n"
         "  qtet extract fin.qtet --ratio 0.1 -o coarse.vtu\n"
         "  qtet verify fin.qtet --against fin.vtu\n"
         "  QTET_TOKEN=... qtet push fin.qtet http://127.0.0.1:8080/\n"
         "\nexit codes: 0 done, 1 an input or a file is at fault, 2 the command line is\n";
}

/// Every line of a message for people starts with the tool's name.
void printLines(std::ostream& err, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) err << "qtet: " << line << "\n";
}

int runCommand(const Command& command, const Words& words, Console& console) {
  try {
    const int code = command.run(words, console);
    if (console.out.flush()) return code;
    console.err << "qtet: the result could not be written to the standard output; is the disk full?\n";
    return kExitFailed;
  } catch (const UsageError& error) {
    printLines(console.err, error.what());
    return kExitUsage;
  }
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

int runTool(const Words& words, Console& console) {
  const std::string first = words.empty() ? "" : words.front();
  if (first == "--version") {
    console.out << "qtet " QTET_VERSION "\n";
    return kExitOk;
  }
  if (first == "--help" || first == "-h" || first == "help") {
    printHelp(console.out);
    return kExitOk;
  }
  const auto* command = std::find_if(kCommands.begin(), kCommands.end(), [&](const Command& candidate) { return candidate.name == first; });
  if (command != kCommands.end()) return runCommand(*command, Words(words.begin() + 1, words.end()), console);

  std::string known;
  for (const Command& candidate : kCommands) known += (known.empty() ? "" : ", ") + std::string(candidate.name);
  printLines(console.err, (first.empty() ? "a command is missing" : "there is no command '" + first + "'") + "; there are: " + known +
                              "\nsee 'qtet --help'");
  return kExitUsage;
}

}  // namespace qtet

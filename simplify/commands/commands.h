// The commands of the `qtet` tool. They take their words and streams as arguments, so tests can run
// them in process.
#pragma once

#include <span>
#include <string_view>

#include "simplify/words/console.h"

namespace qtet {

struct Command {
  std::string_view name;
  std::string_view summary;
  int (*run)(const Words& words, Console& console);
  /// The command prints only that it made the file, so it prints nothing with --quiet.
  bool makesFile = false;
  /// Whether "-" among its words is the standard input, and what that holds.
  enum class Pipe { kNone, kMesh, kLog } pipe = Pipe::kNone;
};

/// In the order in which help shows them.
[[nodiscard]] std::span<const Command> commands();

/// Runs the tool on what follows its name on the command line; returns the exit code. Throws
/// nothing but std::bad_alloc and the like.
int runTool(const Words& words, Console& console);

int runSample(const Words& words, Console& console);
int runSimplify(const Words& words, Console& console);
int runCheck(const Words& words, Console& console);
int runConvert(const Words& words, Console& console);
int runInfo(const Words& words, Console& console);
int runExtract(const Words& words, Console& console);
int runAddField(const Words& words, Console& console);
int runAddSteps(const Words& words, Console& console);
int runRemoveField(const Words& words, Console& console);
int runPush(const Words& words, Console& console);
int runPublish(const Words& words, Console& console);
int runPage(const Words& words, Console& console);
int runView(const Words& words, Console& console);
int runCompletion(const Words& words, Console& console);
int runManual(const Words& words, Console& console);
int runVerify(const Words& words, Console& console);

}  // namespace qtet

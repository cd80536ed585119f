// The tool as a WebAssembly module that a program of JavaScript runs (web-client/tool/). There is
// one process and one thread: a reader that crashes takes the module with it, and nobody else.
#include <unistd.h>

#include <cstdlib>

#include "simplify/api/reported_work.h"
#include "simplify/commands/commands.h"
#include "simplify/commands/tool_main.h"
#include "simplify/produce/follow_files.h"
#include "simplify/publish/compressed.h"
#include "simplify/read/process/guarded_folder.h"
#include "simplify/read/steps/read_apart.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

/// A variable of the environment, by which the host speaks; empty without it.
std::string told(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

Installation installation() { return {told("QTET_VIEWER"), {}}; }

Result<std::vector<TimedCells>> readApart(const std::filesystem::path&, const ReadOptions&,
                                          ReadReport& report, const StepReader& read) {
  return read(report);
}

// There is no second thread to work in.
Result<PipelineOutput> simplifyAndReport(TetMesh&& mesh, PipelineOptions options,
                                         const Tell& tell) {
  options.progress = [&](Stage stage, double fraction) { (void)tell(stage, fraction); };
  return simplifyToLog(std::move(mesh), options);
}

// The native tool knows none of these names: it would take a folder without a lock for abandoned.
GuardedFolder::GuardedFolder(std::string_view purpose) {
  unguarded_.emplace("node-" + std::string(purpose));
}
GuardedFolder::~GuardedFolder() = default;

void followFiles(const std::vector<std::string>&, std::chrono::milliseconds,
                 const std::function<Result<bool>()>&, Console&) {
  throw UsageError("--follow needs the tool of the Python or Debian package; leave it out");
}

int runPublish(const Words&, Console&) {
  throw UsageError(
      "publish needs the tool of the Python or Debian package; 'qtet page' makes one file");
}

Result<Bytes> brotlied(ByteView) {
  return fail(ErrorCode::kIo, "this program was built without Brotli");
}

/// Makes a page where the host wants it, which opens it.
int runView(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("no-open", "only print the page's address, also on a desktop")(
      "fields", po::value<std::string>()->default_value("all"),
      "of a mesh: all, none, or names between commas, as `qtet simplify --fields` takes them");
  addReadOptions(options);
  const ParsedWords parsed(
      words,
      {"view", "view FILE [options]",
       "Shows a log in the browser, or a mesh after simplifying it with the usual settings, as a "
       "page in a temporary file. To keep it: qtet page.",
       "  qtet view part.vtu\n  qtet view part.qtet --no-open\n"},
      options, {"FILE"});
  if (parsed.helped(console)) return kExitOk;
  Words page = words;
  std::erase(page, "--no-open");
  page.insert(page.end(), {"-o", told("QTET_VIEW_PAGE")});
  return runPage(page, console);
}

}  // namespace qtet

extern "C" {
/// `qtet WORDS...` as main() takes them, once a module. Files are those of WASI's functions. PWD in
/// the environment is where relative names begin.
int qtet_main(int argc, const char* const* argv);
}

int qtet_main(int argc, const char* const* argv) {
  (void)::chdir(qtet::told("PWD").c_str());
  return qtet::toolMain(argc, argv);
}

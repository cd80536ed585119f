#include "codec/refine/log_file.h"
#include "simplify/commands/commands.h"
#include "simplify/remote/push_log.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {
namespace {

CommandHelp pushHelp() {
  return {"push", "push LOG.qtet URL [--token-file FILE] [--cacert FILE] [--json]",
          R"(Sends a log to a qtet-server that takes uploads (qtet-server --tokens).
URL is https://HOST:PORT/, for a mesh of the file's name, or https://HOST:PORT/v1/meshes/NAME.
With http the token travels unencrypted.
The server checks the log before anybody sees it, as qtet verify does, which takes a while for a
large one.
A connection that breaks is taken up again where it broke, also by a later push of the same log.
Blocks of the log that the server has under this name are not sent again (experimental).
A log that somebody else put under the name meanwhile is not replaced.)",
          R"(  QTET_TOKEN=... qtet push fin.qtet http://127.0.0.1:8080/
  qtet push fin.qtet https://meshes.example.org/v1/meshes/wing --token-file ~/.qtet-token
)"};
}

}  // namespace

int runPush(const Words& words, Console& console) {
  po::options_description options("options");
  addPushOptions(options);
  options.add_options()("json", "print one JSON object");
  const ParsedWords parsed(words, pushHelp(), options, {"LOG", "URL"});
  if (parsed.helped(console)) return kExitOk;
  const bool asJson = parsed.has("json");
  const auto file = parsed.get<std::string>("LOG");
  const Result<PushTarget> target = pushTargetOf(parsed, parsed.get<std::string>("URL"), file);
  if (!target) return reportFailure(target.error(), asJson, console);
  const Result<LogFile> log = LogFile::open(file);
  if (!log) return reportFailure(log.error(), asJson, console);
  const Result<Pushed> pushed = pushLog(*log, *target, console);
  if (!pushed) return reportFailure(pushed.error(), asJson, console);
  reportPushed(*log, *pushed, asJson, console);
  return kExitOk;
}

}  // namespace qtet

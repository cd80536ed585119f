#include "simplify/words/several_logs.h"

#include <algorithm>
#include <vector>

namespace qtet {
namespace {

int reportOne(const std::string& path, bool asJson, const LogReporter& report, Console& console) {
  const Result<LogReport> made = report(path);
  if (!made) return reportFailure(made.error(), asJson, console);
  if (asJson)
    printJson(made->json, console);
  else
    console.out << made->text;
  return kExitOk;
}

}  // namespace

int reportLogs(const ParsedWords& parsed, const LogReporter& report, Console& console) {
  const auto paths = parsed.get<std::vector<std::string>>("LOG...");
  const bool asJson = parsed.has("json");
  if (paths.size() == 1) return reportOne(paths.front(), asJson, report, console);
  OrderedJson all = OrderedJson::array();
  int worst = kExitOk;
  for (const std::string& path : paths) {
    const std::string name = console.named(path);
    OrderedJson& about = all.emplace_back(OrderedJson{{"input", name}});
    Result<LogReport> made = report(path);
    if (!made) {
      Error& error = made.error();
      if (error.message.find(path) == std::string::npos)
        error.message = path + ": " + error.message;
      worst = std::max(worst, reportFailure(error, false, console));
      about["error"] = {{"code", errorCodeName(error.code)},
                        {"message", console.named(error.message)}};
      continue;
    }
    if (asJson)
      about.update(made->json);
    else
      console.out << (&path == &paths.front() ? "" : "\n") << console.shown(name) << ":\n"
                  << made->text;
  }
  if (asJson) printJson(all, console);
  return worst;
}

}  // namespace qtet

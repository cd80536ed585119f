#include <filesystem>
#include <iomanip>

#include "simplify/commands/commands.h"
#include "simplify/read/check_mesh.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

OrderedJson checkJson(const CheckReport& report, const std::string& input, const Console& console) {
  OrderedJson findings = OrderedJson::array();
  for (const Finding& finding : report.findings) {
    OrderedJson one = {{"kind", finding.kind},
                       {"verdict", verdictName(finding.verdict)},
                       {"text", console.named(finding.text)}};
    if (finding.found.count > 0)
      one.update(
          {{"what", finding.what}, {"count", finding.found.count}, {"first", finding.found.first}});
    if (!finding.advice.empty()) one["advice"] = withOptionNames(finding.advice);
    findings.push_back(std::move(one));
  }
  return {{"input", console.named(input)},
          {"refused", report.refused()},
          {"points", report.points},
          {"tetrahedra", report.tetrahedra},
          {"fields", report.fields},
          {"components", report.components},
          {"mesh", report.clean.components > 0 ? soundnessReport(report.clean) : OrderedJson()},
          {"read", readReport(report.read)},
          {"notes", withOptionNames(report.read.notes)},
          {"warnings", withOptionNames(report.read.warnings)},
          {"findings", findings}};
}

void printReport(const CheckReport& report, const std::string& input, const Console& console) {
  std::ostream& out = console.out;
  if (report.tetrahedra > 0) {
    out << console.shown(input) << ": " << counted(report.points, "point", "points") << ", "
        << counted(report.tetrahedra, "tetrahedron", "tetrahedra");
    if (!report.read.split.onlyTetrahedra()) out << " of cells that were split";
    out << ", " << counted(report.fields.size(), "field", "fields") << "\n";
    if (report.clean.components > 0) out << soundnessText(soundnessReport(report.clean)) << "\n";
    for (const std::string& field : report.fields) out << "  " << printable(field) << "\n";
  }
  for (const Finding& finding : report.findings) {
    out << std::left << std::setw(10) << verdictName(finding.verdict)
        << console.shown(finding.text);
    if (finding.found.count > 0) {
      out << ": " << finding.found.count;
      for (std::size_t i = 0; i < finding.found.first.size(); ++i)
        out << (i == 0 ? " (" + finding.what + " " : ", ") << finding.found.first[i];
      if (!finding.found.first.empty())
        out << (finding.found.count > finding.found.first.size() ? ", ...)" : ")");
    }
    out << "\n";
    if (!finding.advice.empty())
      out << std::setw(10) << "" << "-> " << console.shown(finding.advice) << "\n";
  }
  if (report.findings.empty()) out << "nothing is wrong with it\n";
  out << (report.refused() ? "qtet simplify would refuse it\n" : "qtet simplify takes it\n");
}

CommandHelp checkHelp() {
  return {"check", "check IN... [options]",
          R"(Says everything that is wrong or unusual about a mesh: what it is, how often it is
there and where first, and whether simplify would refuse it, repair it or keep it.
Ends with 1 if anything would be refused.
Tetrahedra are counted after splitting; points and other cells as in the file.)",
          R"(  qtet check part.vtu
  qtet check ogrid.vts --weld 1e-6 --json
)"};
}

}  // namespace

int runCheck(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("json", "print one JSON object");
  addReadOptions(options);
  addTimesOption(options);
  const ParsedWords parsed(words, checkHelp(), options, {"IN..."});
  if (parsed.helped(console)) return kExitOk;
  ReadOptions reading = readOptionsOf(parsed);
  const std::string input = inputOf(parsed, reading);
  Progress progress(console);
  progress.stage("checking " + input);
  const CheckReport report = checkMesh(input, reading);
  progress.clear();
  if (parsed.has("json")) {
    printJson(checkJson(report, input, console), console);
  } else {
    for (const std::string& note : report.read.notes) console.note(note);
    for (const std::string& warning : report.read.warnings) console.warn(warning);
    printReport(report, input, console);
  }
  return report.refused() ? kExitFailed : kExitOk;
}

}  // namespace qtet

#include "simplify/produce/edited_log_report.h"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/level_error_json.h"
#include "simplify/produce/written_log.h"

namespace qtet {
namespace {

OrderedJson toJson(const NewField& field) {
  const ManifestField& info = field.info;
  OrderedJson out = {{"name", info.name},
                     {"association", info.association},
                     {"components", info.components},
                     {"type", info.type},
                     {"bits", info.bits},
                     {"step", info.step},
                     {"minimum", info.minimum},
                     {"range", info.range},
                     {"missingValues", info.hasMissing},
                     {"bytes", bytesOf(field)}};
  if (!field.errors.empty())
    out["error"] = fieldErrorJson(field.errors.front(), field.labelNames.has_value());
  return out;
}

}  // namespace

std::size_t bytesOf(const NewField& field) {
  return std::accumulate(field.blocks.begin(), field.blocks.end(), std::size_t{0},
                         [](std::size_t sum, const Bytes& b) { return sum + b.size(); });
}

Output newLogOf(const ParsedWords& parsed, const Console& console) {
  return parsed.has("output") ? outputOf(parsed, console) : Output{parsed.get<std::string>("LOG")};
}

Status checkNewLog(const ParsedWords& parsed, const std::string& mesh, const Console& console) {
  if (parsed.has("output")) return checkOutput(outputOf(parsed, console), ".qtet", mesh);
  if (parsed.has("no-clobber"))
    throw UsageError(
        "without -o the log itself is replaced, which --no-clobber refuses; name the new log with "
        "-o");
  return {};
}

Result<OrderedJson> writeNewLog(const ParsedWords& parsed, const Output& output,
                                const LogFile& before, const EditedLog& edited) {
  const Result<LogIndex> index = LogIndex::parse(edited.head(), edited.later());
  if (!index) return std::unexpected(index.error());
  const Result<Manifest> manifest = manifestOf(*index);
  if (!manifest) return std::unexpected(manifest.error());
  OrderedJson fields = OrderedJson::array();
  for (std::size_t f = 0; f < manifest->fields.size(); ++f)
    fields.push_back(fieldKey(*manifest, f));
  const Result<WrittenLog> written =
      writeLog(output, [&](const ByteSink& sink) { return edited.writeTo(sink); });
  if (!written) return std::unexpected(written.error());
  return OrderedJson{{"input", parsed.get<std::string>("LOG")},
                     {"output", output.name()},
                     {"digest", written->digest},
                     {"bytes", written->bytes},
                     {"bytesBefore", before.bytes().size()},
                     {"tetrahedra", manifest->levels.back().tetrahedra},
                     {"vertices", manifest->levels.back().vertices},
                     {"levels", manifest->levels.size() - 1},
                     {"fields", fields}};
}

void printNew(const OrderedJson& report, std::ostream& out) {
  out << report["output"].get<std::string>() << ": " << report["bytes"] << " bytes, before "
      << report["bytesBefore"] << "\n";
}

Status writeAdded(const ParsedWords& parsed, const LogFile& log, const AddedFields& added,
                  const OrderedJson& source, const FieldPrinter& print, Progress& progress,
                  Console& console) {
  const Result<EditedLog> edited = withFields(log, added.kept, added.fields);
  if (!edited) return std::unexpected(edited.error());
  const Output output = newLogOf(parsed, console);
  Result<OrderedJson> report = writeNewLog(parsed, output, log, *edited);
  if (!report) return std::unexpected(report.error());
  progress.clear();
  for (const std::string& note : added.notes) console.note(note);
  for (const std::string& warning : withOptionNames(added.warnings)) console.warn(warning);
  std::vector<const NewField*> come;
  for (std::size_t i = 0; i < added.fields.size(); ++i)
    if (std::ranges::find(added.again, i) == added.again.end()) come.push_back(&added.fields[i]);
  if (!parsed.has("json")) {
    std::ostringstream lines;
    print(come, lines);
    printNew(*report, lines);
    reportOutput(output, lines.str(), console);
    return {};
  }
  report->update(source);
  (*report)["added"] = OrderedJson::array();
  for (const NewField* const field : come) (*report)["added"].push_back(toJson(*field));
  (*report)["notes"] = added.notes;
  (*report)["warnings"] = withOptionNames(added.warnings);
  printJson(*report, console);
  return {};
}

}  // namespace qtet

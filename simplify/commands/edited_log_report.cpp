#include "simplify/commands/edited_log_report.h"

#include <numeric>
#include <ostream>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/field_key.h"
#include "simplify/commands/written_log.h"

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
    out["error"] = {{"rms", field.errors.front().rms}, {"max", field.errors.front().max}};
  return out;
}

}  // namespace

std::size_t bytesOf(const NewField& field) {
  return std::accumulate(field.blocks.begin(), field.blocks.end(), std::size_t{0},
                         [](std::size_t sum, const Bytes& b) { return sum + b.size(); });
}

std::string outputOf(const ParsedWords& parsed) {
  return parsed.get<std::string>(parsed.has("output") ? "output" : "LOG");
}

Status checkNewLog(const ParsedWords& parsed, const std::string& mesh) {
  return parsed.has("output") ? checkOutput(parsed.get<std::string>("output"), ".qtet", mesh)
                              : Status{};
}

Result<OrderedJson> writeNewLog(const ParsedWords& parsed, const LogFile& before,
                                const EditedLog& edited) {
  const Result<LogIndex> index = LogIndex::parse(edited.head(), edited.later());
  if (!index) return std::unexpected(index.error());
  const Result<Manifest> manifest = manifestOf(*index);
  if (!manifest) return std::unexpected(manifest.error());
  OrderedJson fields = OrderedJson::array();
  for (std::size_t f = 0; f < manifest->fields.size(); ++f)
    fields.push_back(fieldKey(*manifest, f));
  const Result<WrittenLog> written =
      writeLog(outputOf(parsed), [&](const ByteSink& sink) { return edited.writeTo(sink); });
  if (!written) return std::unexpected(written.error());
  return OrderedJson{{"input", parsed.get<std::string>("LOG")},
                     {"output", outputOf(parsed)},
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

Status writeAdded(const ParsedWords& parsed, const LogFile& log,
                  const std::vector<std::uint32_t>& kept, const AddedFields& added,
                  const OrderedJson& source,
                  const std::function<void(const std::vector<NewField>&)>& print,
                  Progress& progress, Console& console) {
  const Result<EditedLog> edited = withFields(log, kept, added.fields);
  if (!edited) return std::unexpected(edited.error());
  Result<OrderedJson> report = writeNewLog(parsed, log, *edited);
  if (!report) return std::unexpected(report.error());
  progress.clear();
  for (const std::string& note : added.notes) console.note(note);
  if (!parsed.has("json")) {
    print(added.fields);
    printNew(*report, console.out);
    return {};
  }
  report->update(source);
  (*report)["added"] = OrderedJson::array();
  for (const NewField& field : added.fields) (*report)["added"].push_back(toJson(field));
  (*report)["notes"] = added.notes;
  printJson(*report, console);
  return {};
}

}  // namespace qtet

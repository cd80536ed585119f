#include <algorithm>
#include <numeric>
#include <sstream>

#include "proto/field_key.h"
#include "proto/level_error_json.h"
#include "proto/limits.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/commands/commands.h"
#include "simplify/log/add_fields.h"
#include "simplify/log/opened_log.h"
#include "simplify/mesh/workers.h"
#include "simplify/produce/edited_log_report.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/steps/cell_labels.h"
#include "simplify/words/error_words.h"
#include "simplify/words/field_names.h"
#include "simplify/words/json_report.h"
#include "simplify/words/measure_words.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

/// Leaves out labels of the file's blocks that the log has already: nobody asked for them.
void eraseKnownLabels(const OpenedLog& log, ReadReport& report, std::vector<MeshField>& fields) {
  std::erase_if(report.labels, [&](const std::string& name) {
    return std::ranges::none_of(log.manifest.fields, [&](const ManifestField& field) {
      return field.association == "cell" && field.name == name;
    });
  });
  eraseLabelFields(report, fields);
}

/// The log's fields without those that `mesh` replaces. Errors: bad-value (a name that is there,
/// without --replace).
Result<std::vector<std::uint32_t>> keptBeside(const OpenedLog& log, const TetMesh& mesh,
                                              bool replace) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t f = 0; f < log.manifest.fields.size(); ++f) {
    const ManifestField& there = log.manifest.fields[f];
    const bool again = std::ranges::any_of(mesh.fields, [&](const MeshField& field) {
      return field.name == there.name && field.association == there.association;
    });
    if (!again) {
      kept.push_back(f);
    } else if (!replace) {
      return fail(ErrorCode::kBadValue,
                  "the log has a " + there.association + " field '" + there.name +
                      "' already; give --replace, or choose others with --fields");
    }
  }
  return kept;
}

void printAdded(const std::vector<const NewField*>& fields, std::ostream& out) {
  for (const NewField* const field : fields) {
    const ManifestField& info = field->info;
    out << info.association << " field " << printable(info.name) << ": " << bytesOf(*field)
        << " bytes, " << info.bits << " bits, step " << info.step;
    if (!field->errors.empty())
      out << "; base mesh "
          << fieldErrorText(fieldErrorJson(field->errors.front(), field->labelNames.has_value()));
    out << "\n";
  }
}

Status addField(const ParsedWords& parsed, Progress& progress, Console& console) {
  const auto from = parsed.get<std::string>("from");
  if (Status checked = checkNewLog(parsed, from, console); !checked) return checked;
  const Result<OpenedLog> log = openLog(parsed.get<std::string>("LOG"));
  if (!log) return std::unexpected(log.error());
  progress.stage("reading " + from);
  ReadOptions reading = readOptionsOf(parsed);
  reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  Result<ReadMesh> read = readMesh(from, reading);
  if (!read) return std::unexpected(read.error());
  if (!reading.fields && !parsed.has("replace"))
    eraseKnownLabels(*log, read->report, read->mesh.fields);
  if (read->mesh.fields.empty()) return fail(ErrorCode::kNotFound, from + " holds no field to add");
  if (const Result<CleanReport> cleaned = cleanMesh(read->mesh); !cleaned)
    return std::unexpected(cleaned.error());
  const auto kept = keptBeside(*log, read->mesh, parsed.has("replace"));
  if (!kept) return std::unexpected(kept.error());

  progress.stage("adding fields");
  AddFieldsOptions options;
  options.fieldBits = parsed.integer("field-bits", kMinFieldBits, kMaxFieldBits);
  options.errors = valueBoundsOf(parsed);
  if (Status s = checkValueBounds(read->mesh.fields, options.errors, log->manifest.units); !s)
    return s;
  options.threads = threadsAtOnce(parsed.integer("threads", 1, kMaxAddingThreads));
  options.kept = *kept;
  options.progress = [&](double fraction) { progress.update(fraction); };
  const Result<AddedFields> added = addFields(log->file, read->mesh, options);
  if (!added) return std::unexpected(added.error());
  return writeAdded(parsed, log->file, *added, {{"from", from}}, printAdded, progress, console);
}

Status removeField(const ParsedWords& parsed, Console& console) {
  if (Status checked = checkNewLog(parsed, parsed.get<std::string>("LOG"), console); !checked)
    return checked;
  const Result<OpenedLog> log = openLog(parsed.get<std::string>("LOG"));
  if (!log) return std::unexpected(log.error());
  std::vector<std::uint32_t> kept(log->manifest.fields.size());
  std::iota(kept.begin(), kept.end(), 0u);
  const auto names = parseFieldNames(parsed.get<std::string>("fields"));
  if (!names) kept.clear();
  for (const std::string& name : names.value_or(std::vector<std::string>{})) {
    const std::vector<std::uint32_t> meant = fieldsOfKey(log->manifest.fields, name);
    if (meant.empty()) return std::unexpected(noSuchField(log->manifest, name));
    for (const std::uint32_t f : meant) std::erase(kept, f);
  }
  const Result<EditedLog> edited = withFields(log->file, kept, {});
  if (!edited) return std::unexpected(edited.error());
  const Output output = newLogOf(parsed, console);
  Result<OrderedJson> report = writeNewLog(parsed, output, log->file, *edited);
  if (!report) return std::unexpected(report.error());
  std::ostringstream line;
  printNew(*report, line);
  parsed.has("json") ? printJson(*report, console) : reportOutput(output, line.str(), console);
  return {};
}

CommandHelp addFieldHelp() {
  return {"add-field",
          "add-field LOG.qtet --from MESH.vtu [--fields NAMES] [-o OUT.qtet] [--replace]",
          R"(Adds fields of a mesh file to a log without simplifying again: the geometry stays as it
is, byte for byte. The file must hold the mesh that the log was made from, in any numbering.
Where the log knows the errors of its levels, those of the new fields are measured.
--json: input, output, digest, bytes, bytesBefore, tetrahedra, vertices, levels, fields (keys),
from, added [{name, association, components, type, bits, step, minimum, range, missingValues, bytes,
error {rms, max} or {wrong} of the base mesh}], notes.)",
          R"(  qtet add-field fin.qtet --from later.vtu --fields Pressure
  qtet add-field fin.qtet --from fin.vtu --replace --field-bits 16 -o fine.qtet
)"};
}

CommandHelp removeFieldHelp() {
  return {"remove-field", "remove-field LOG.qtet --fields NAMES [-o OUT.qtet]",
          R"(Leaves fields of a log out. Everything else stays as it is, byte for byte.
--json: input, output, digest, bytes, bytesBefore, tetrahedra, vertices, levels, fields (keys).)",
          R"(  qtet remove-field fin.qtet --fields Velocity -o small.qtet
)"};
}

}  // namespace

int runAddField(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()(
      "from", po::value<std::string>(),
      "required: the mesh file whose fields are added; its mesh is the log's input")(
      "fields", po::value<std::string>()->default_value("all"), kFieldsHelp)(
      "output,o", po::value<std::string>(),
      "the log to write, NAME.qtet; or - for the standard output; without it the log itself is "
      "replaced once the new one is whole")("replace",
                                            "fields that the log has already are replaced")(
      "field-bits", po::value<int>()->default_value(12),
      "bits of a float field's values, 1 to 28; integer fields are stored exactly")(
      "threads", po::value<int>()->default_value(1),
      "threads for measuring, as many as there are processors at most; the result does not depend "
      "on it")("json", "print one JSON object");
  addErrorOption(options);
  addNoClobber(options);
  addReadOptions(options);
  const ParsedWords parsed(words, addFieldHelp(), options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  Progress progress(console);
  const Status done = addField(parsed, progress, console);
  progress.clear();
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

int runRemoveField(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()(
      "fields", po::value<std::string>(),
      "required: the fields to leave out: all, or names as `qtet extract --fields` takes them")(
      "output,o", po::value<std::string>(),
      "the log to write, NAME.qtet; or - for the standard output; without it the log itself is "
      "replaced once the new one is whole")("json", "print one JSON object");
  addNoClobber(options);
  const ParsedWords parsed(words, removeFieldHelp(), options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const Status done = removeField(parsed, console);
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

}  // namespace qtet

// Writing of logs whose fields were changed, and the report about it. Add-field, add-steps and
// remove-field share it.
#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "codec/refine/log_edit.h"
#include "simplify/log/add_fields.h"
#include "simplify/words/json_report.h"
#include "simplify/words/output.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"

namespace qtet {

/// Where the new log goes: over the old one unless --output says otherwise.
[[nodiscard]] Output newLogOf(const ParsedWords& parsed, const Console& console);

/// Refuses a bad --output, which must not be `mesh` (checkOutput). Throws UsageError for
/// --no-clobber without --output.
[[nodiscard]] Status checkNewLog(const ParsedWords& parsed, const std::string& mesh,
                                 const Console& console);

/// Writes the new log to `output`. Returns the report: {input, output, digest, bytes, bytesBefore,
/// tetrahedra, vertices, levels, fields}. `fields` are the keys of those that the new log holds.
/// Errors: those of LogIndex::parse, manifestOf and writeLog.
[[nodiscard]] Result<OrderedJson> writeNewLog(const ParsedWords& parsed, const Output& output,
                                              const LogFile& before, const EditedLog& edited);
void printNew(const OrderedJson& report, std::ostream& out);

using FieldPrinter = std::function<void(const std::vector<const NewField*>&, std::ostream&)>;

/// Writes the log with the fields that `added` keeps and then those added. Reports notes and
/// warnings, and then what `print(fields, out)` says and a line. The report as JSON has also the
/// members of `source`, `added`, `notes` and `warnings`. The members of an added field are name,
/// association, components, type, bits, step, minimum, range, missingValues, bytes, and error {rms,
/// max} of the base mesh. Errors: withFields's and writeNewLog's.
[[nodiscard]] Status writeAdded(const ParsedWords& parsed, const LogFile& log,
                                const AddedFields& added, const OrderedJson& source,
                                const FieldPrinter& print, Progress& progress, Console& console);

/// Bytes of all of its blocks.
[[nodiscard]] std::size_t bytesOf(const NewField& field);

}  // namespace qtet

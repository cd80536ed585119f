// Writing of logs whose fields were changed, and the report about it: what add-field, add-steps and
// remove-field share.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "codec/refine/log_edit.h"
#include "simplify/commands/command_line.h"

namespace qtet {

/// Where the new log goes: over the old one unless --output says otherwise.
[[nodiscard]] std::string outputOf(const ParsedWords& parsed);

/// Refuses a bad --output, which must not be `mesh` (checkOutput).
[[nodiscard]] Status checkNewLog(const ParsedWords& parsed, const std::string& mesh);

/// Writes the new log. Returns the report: {input, output, digest, bytes, bytesBefore, tetrahedra,
/// vertices, levels, fields}. `fields` are the keys of those that the new log holds. Errors: those
/// of LogIndex::parse, manifestOf and writeLog.
[[nodiscard]] Result<OrderedJson> writeNewLog(const ParsedWords& parsed, const LogFile& before,
                                              const EditedLog& edited);
void printNew(const OrderedJson& report, std::ostream& out);

/// {name, association, components, type, bits, step, minimum, range, missingValues, bytes, error
/// {rms, max} of the base mesh}.
[[nodiscard]] OrderedJson toJson(const NewField& field);
void printAdded(const std::vector<NewField>& fields, std::ostream& out);

}  // namespace qtet

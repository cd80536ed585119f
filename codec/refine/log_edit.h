// Makes a log from another log's blocks: fields are added, left out or replaced, and the other
// blocks stay byte for byte.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_index.h"
#include "proto/manifest.h"

namespace qtet {

class LogFile;

/// A field for a log, its blocks those of encodeFieldBlocks.
struct NewField {
  ManifestField info;
  std::vector<Bytes> blocks;       ///< one a chunk
  std::vector<FieldError> errors;  ///< one a level; unused where the log has none of the level
};

/// A closing block for a log.
struct NewClosing {
  ClosingKind kind = ClosingKind::kPointOrder;
  std::uint32_t field = 0;  ///< of kExactField
  Bytes bytes;
};

/// The log with `added` behind its own closing blocks. Errors: limit-exceeded (a block too large).
/// REQUIRES: kinds that the log does not have yet.
[[nodiscard]] Result<Bytes> withClosing(const LogFile& log, const std::vector<NewClosing>& added);

/// The log with the fields `kept` (numbers of its own fields, in the order wanted) and then
/// `added`. Errors: limit-exceeded (too many fields, a block too large), bad-value (the log's
/// manifest), bad-input (a field that another one is predicted from would go, or come behind it).
/// REQUIRES: fields of the log; a block of each added field for every chunk. If any level of the
/// log has errors, each added field has some for every level. Closing blocks stay, except those of
/// fields left out.
[[nodiscard]] Result<Bytes> withFields(const LogFile& log, const std::vector<std::uint32_t>& kept,
                                       const std::vector<NewField>& added);

}  // namespace qtet

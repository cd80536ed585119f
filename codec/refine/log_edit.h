// Makes a log from another log's blocks: fields are added, left out or replaced, and the other
// blocks and their checksums stay as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "codec/mesh/time_parents.h"
#include "proto/byte_sink.h"
#include "proto/manifest.h"

namespace qtet {

class LogFile;

/// A field for a log, its blocks those of encodeFieldBlocks.
struct NewField {
  ManifestField info;
  std::vector<Bytes> blocks;       ///< one a chunk
  std::vector<FieldError> errors;  ///< one a level; unused where the log has none of the level
  /// Its parents: below the number of the log's fields one of them, else an added one before it.
  TimePrediction prediction{};
  /// The names of its values where it is a label; `errors` are those of one then.
  std::optional<LabelNames> labelNames{};
};

/// A log whose blocks lie in another log and in new fields. Both must outlive it.
class EditedLog {
 public:
  /// A block, and where it lies in the other log if it is one of that.
  struct Piece {
    ByteView bytes;
    std::optional<std::uint64_t> offset;
  };

  EditedLog(const LogFile& log, Bytes head, std::vector<Piece> blocks, Bytes later)
      : log_(log), head_(std::move(head)), later_(std::move(later)), blocks_(std::move(blocks)) {}

  /// Header, manifest and table.
  [[nodiscard]] const Bytes& head() const { return head_; }
  /// The part of later instants, behind all blocks.
  [[nodiscard]] const Bytes& later() const { return later_; }
  /// All of its bytes, in order. A block of the other log is held in memory only until the sink has
  /// taken it. Errors: the sink's.
  [[nodiscard]] Status writeTo(const ByteSink& sink) const;
  /// The blocks alone.
  [[nodiscard]] Status writeBlocksTo(const ByteSink& sink) const;
  /// The same in memory.
  [[nodiscard]] Bytes together() const;

 private:
  const LogFile& log_;
  Bytes head_, later_;
  std::vector<Piece> blocks_;
};

/// Errors: limit-exceeded (more fields than a log may have).
[[nodiscard]] Status checkFieldCount(std::size_t fields);

/// The log with the fields `kept` (numbers of its own fields, in the order wanted) and then
/// `added`. Errors: limit-exceeded (too many fields, a block too large), bad-value (the log's
/// manifest), bad-input (a field that another one is predicted from would go, or come behind it).
/// REQUIRES: fields of the log; a block of each added field for every chunk. If any level of the
/// log has errors, each added field has some for every level. Closing blocks stay, except those of
/// fields left out.
[[nodiscard]] Result<EditedLog> withFields(const LogFile& log,
                                           const std::vector<std::uint32_t>& kept,
                                           const std::vector<NewField>& added);

}  // namespace qtet

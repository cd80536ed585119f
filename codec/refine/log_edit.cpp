#include "codec/refine/log_edit.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/crc32c.h"
#include "proto/field_name.h"
#include "proto/limits.h"
#include "proto/series.h"

namespace qtet {
namespace {

/// Where the blocks of the new log lie, in file order.
class Pieces {
 public:
  explicit Pieces(const LogFile& log) : log_(log) {}

  BlockEntry keep(const BlockEntry& block) {
    const auto offset = static_cast<std::size_t>(block.offset);
    return add({log_.bytes().subspan(offset, block.size), block.offset}, block.crc);
  }
  BlockEntry add(ByteView block) { return add({block, std::nullopt}, crc32c(block)); }

  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::vector<EditedLog::Piece>& all() { return all_; }

 private:
  BlockEntry add(const EditedLog::Piece& piece, std::uint32_t crc) {
    all_.push_back(piece);
    bytes_ += piece.bytes.size();
    return {0, static_cast<std::uint32_t>(piece.bytes.size()), crc};
  }

  const LogFile& log_;
  std::vector<EditedLog::Piece> all_;
  std::uint64_t bytes_ = 0;
};

void keepErrors(LevelError& error, std::size_t level, const std::vector<std::uint32_t>& kept,
                const std::vector<NewField>& added) {
  const std::vector<FieldError> before = std::exchange(error.fields, {});
  for (const std::uint32_t f : kept) error.fields.push_back(before[f]);
  for (const NewField& field : added) {
    assert(level < field.errors.size());
    error.fields.push_back(field.errors[level]);
  }
}

/// The opening follows its field, or the added one of its name. A series opens with the instant in
/// the head, which may be another one now. Else it goes. REQUIRES: a manifest of the new fields.
void keepOpening(Manifest& manifest, const ManifestField& shown,
                 const std::vector<std::uint32_t>& kept, const std::vector<NewField>& added) {
  auto place =
      static_cast<std::size_t>(std::ranges::find(kept, manifest.opening->field) - kept.begin());
  const auto isShown = [&](const NewField& field) {
    return field.info.name == shown.name && field.info.association == shown.association;
  };
  if (place == kept.size())
    place += static_cast<std::size_t>(std::ranges::find_if(added, isShown) - added.begin());
  for (const Series& series : manifest.series)
    if (std::ranges::find(series.fields, place) != series.fields.end())
      place = std::ranges::min(series.fields);
  if (place < kept.size() + added.size() && place <= kMaxOpeningField) {
    manifest.opening->field = static_cast<std::uint8_t>(place);
  } else {
    manifest.opening.reset();
  }
}

/// The prediction of the field at `place` of the new log, in the numbers of that. Errors: bad-input
/// (one of those that it rests on goes, or would come behind it).
Result<TimePrediction> renumbered(const Manifest& manifest, TimePrediction prediction,
                                  const std::vector<std::uint32_t>& kept, const std::string& name,
                                  std::size_t place) {
  for (std::size_t i = 0; i < prediction.count; ++i) {
    std::uint16_t& parent = prediction.parents[i].field;
    const bool isAdded = parent >= manifest.fields.size();
    const std::size_t at =
        isAdded ? kept.size() + parent - manifest.fields.size()
                : static_cast<std::size_t>(std::ranges::find(kept, parent) - kept.begin());
    if (at >= place || (!isAdded && at == kept.size()))
      return fail(ErrorCode::kBadInput,
                  "field " + name + " is coded as a difference to " +
                      (isAdded ? "one behind it" : fieldKey(manifest, parent)) +
                      ", which has to stay before it");
    parent = static_cast<std::uint16_t>(at);
  }
  return prediction;
}

}  // namespace

Status checkFieldCount(std::size_t fields) {
  return fields <= kMaxFields
             ? Status{}
             : fail(ErrorCode::kLimitExceeded,
                    "the log would have more than 8,192 fields; remove some first");
}

Result<EditedLog> withFields(const LogFile& log, const std::vector<std::uint32_t>& kept,
                             const std::vector<NewField>& added) {
  Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  if (Status s = checkFieldCount(kept.size() + added.size()); !s) return std::unexpected(s.error());
  LogIndex index = log.index();
  std::vector<ManifestField> fields;
  index.fields.clear();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    assert(kept[i] < manifest->fields.size());
    const Result<TimePrediction> prediction = renumbered(
        *manifest, log.fields()[kept[i]].prediction, kept, fieldKey(*manifest, kept[i]), i);
    if (!prediction) return std::unexpected(prediction.error());
    fields.push_back(manifest->fields[kept[i]]);
    index.fields.push_back(log.index().fields[kept[i]]);
    index.fields.back().prediction = *prediction;
  }
  for (const NewField& field : added) {
    assert(field.blocks.size() == index.chunks.size());
    const Result<TimePrediction> prediction =
        renumbered(*manifest, field.prediction, kept, field.info.name, fields.size());
    if (!prediction) return std::unexpected(prediction.error());
    fields.push_back(field.info);
    index.fields.push_back(
        {field.info.components,
         field.info.association == "cell" ? Association::kCell : Association::kPoint,
         field.info.hasMissing, *prediction});
  }
  for (const NewField& field : added)
    if (field.labelNames)
      manifest->labels[std::string(field.info.name.withoutTime())].insert(field.labelNames->begin(),
                                                                          field.labelNames->end());
  std::swap(manifest->fields, fields);
  manifest->series = seriesOf(manifest->fields);
  if (manifest->opening) keepOpening(*manifest, fields[manifest->opening->field], kept, added);
  for (ManifestLevel& level : manifest->levels)
    if (level.error) keepErrors(*level.error, level.level, kept, added);
  if (Status s = setManifest(index, std::move(*manifest)); !s) return std::unexpected(s.error());

  Pieces pieces(log);
  for (std::uint32_t chunk = 0; chunk < index.chunks.size(); ++chunk) {
    const std::vector<BlockEntry>& before = log.index().chunks[chunk].blocks;
    std::vector<BlockEntry>& blocks = index.chunks[chunk].blocks;
    blocks = {pieces.keep(before[kStructurePart]), pieces.keep(before[kPositionsPart])};
    for (const std::uint32_t f : kept) blocks.push_back(pieces.keep(before[kFirstFieldPart + f]));
    for (const NewField& field : added) {
      if (field.blocks[chunk].size() > kMaxBlockBytes)
        return fail(ErrorCode::kLimitExceeded,
                    "a block above 256 MiB; take fewer components or bits");
      blocks.push_back(pieces.add(field.blocks[chunk]));
    }
  }
  index.closing.clear();
  for (const ClosingBlock& c : log.index().closing) {
    const auto place = std::ranges::find(kept, c.field);
    if (c.kind == ClosingKind::kExactField && place == kept.end()) continue;
    index.closing.push_back(c);
    if (c.kind == ClosingKind::kExactField)
      index.closing.back().field = static_cast<std::uint32_t>(place - kept.begin());
    index.closing.back().block = pieces.keep(c.block);
  }
  Result<Bytes> later = laterPart(index);
  if (!later) return std::unexpected(later.error());
  index.fileBytes = index.encode().size() + pieces.bytes() + later->size();
  return EditedLog(log, index.encode(), std::move(pieces.all()), std::move(*later));
}

Status EditedLog::writeTo(const ByteSink& sink) const {
  if (Status s = sink(head_); !s) return s;
  if (Status s = writeBlocksTo(sink); !s) return s;
  return sink(later_);
}

Status EditedLog::writeBlocksTo(const ByteSink& sink) const {
  for (const Piece& piece : blocks_) {
    if (Status s = sink(piece.bytes); !s) return s;
    if (piece.offset) log_.release(*piece.offset, piece.bytes.size());
  }
  return {};
}

Bytes EditedLog::together() const {
  Bytes out;
  (void)writeTo(appendTo(out));
  return out;
}

}  // namespace qtet

#include "codec/refine/log_edit.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

using Blocks = std::vector<std::vector<ByteView>>;  // chunk, part

/// The file with sizes and checksums that fit the blocks.
Bytes together(LogIndex index, const Blocks& blocks, const std::vector<ByteView>& closing) {
  for (std::size_t chunk = 0; chunk < blocks.size(); ++chunk) {
    index.chunks[chunk].blocks.clear();
    for (const ByteView block : blocks[chunk])
      index.chunks[chunk].blocks.push_back(
          {0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
  }
  for (std::size_t i = 0; i < closing.size(); ++i)
    index.closing[i].block = {0, static_cast<std::uint32_t>(closing[i].size()), crc32c(closing[i])};
  index.fileBytes = index.encode().size();
  for (const auto& chunk : blocks)
    for (const ByteView block : chunk) index.fileBytes += block.size();
  for (const ByteView block : closing) index.fileBytes += block.size();
  Bytes out = index.encode();
  out.reserve(index.fileBytes);
  for (const auto& chunk : blocks)
    for (const ByteView block : chunk) out.insert(out.end(), block.begin(), block.end());
  for (const ByteView block : closing) out.insert(out.end(), block.begin(), block.end());
  return out;
}

ByteView viewOf(const LogFile& log, const ClosingBlock& closing) {
  return log.bytes().subspan(static_cast<std::size_t>(closing.block.offset), closing.block.size);
}

void keepErrors(LevelError& error, std::size_t level, const std::vector<std::uint32_t>& kept,
                const std::vector<NewField>& added) {
  const std::vector<FieldError> before = std::exchange(error.fields, {});
  for (const std::uint32_t f : kept) error.fields.push_back(before[f]);
  for (const NewField& field : added) {
    assert(level < field.errors.size());
    error.fields.push_back(field.errors[level]);
  }
}

/// The opening follows its field, or goes with it.
void keepOpening(Manifest& manifest, const std::vector<std::uint32_t>& kept) {
  if (!manifest.opening) return;
  const auto place =
      static_cast<std::size_t>(std::ranges::find(kept, manifest.opening->field) - kept.begin());
  if (place < kept.size() && place <= kMaxOpeningField) {
    manifest.opening->field = static_cast<std::uint8_t>(place);
  } else {
    manifest.opening.reset();
  }
}

/// The prediction in the numbers of the fields that are kept. Errors: bad-input (one of those that
/// it rests on goes, or would come behind it).
Result<TimePrediction> keptPrediction(const Manifest& manifest, const LogIndex& index,
                                      const std::vector<std::uint32_t>& kept, std::size_t place) {
  TimePrediction out = index.fields[kept[place]].prediction;
  for (std::size_t i = 0; i < out.count; ++i) {
    const std::uint32_t parent = out.parents[i].field;
    const auto at = static_cast<std::size_t>(std::ranges::find(kept, parent) - kept.begin());
    if (at >= place)
      return fail(ErrorCode::kBadInput,
                  "field " + fieldKey(manifest, kept[place]) + " is coded as a difference to " +
                      fieldKey(manifest, parent) + ", which has to stay before it");
    out.parents[i].field = static_cast<std::uint16_t>(at);
  }
  return out;
}

}  // namespace

Result<Bytes> withFields(const LogFile& log, const std::vector<std::uint32_t>& kept,
                         const std::vector<NewField>& added) {
  Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  if (kept.size() + added.size() > kMaxFields)
    return fail(ErrorCode::kLimitExceeded,
                "the log would have more than 1,024 fields; remove some first");
  LogIndex index = log.index();
  std::vector<ManifestField> fields;
  index.fields.clear();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    assert(kept[i] < manifest->fields.size());
    const Result<TimePrediction> prediction = keptPrediction(*manifest, log.index(), kept, i);
    if (!prediction) return std::unexpected(prediction.error());
    fields.push_back(manifest->fields[kept[i]]);
    index.fields.push_back(log.index().fields[kept[i]]);
    index.fields.back().prediction = *prediction;
  }
  for (const NewField& field : added) {
    assert(field.blocks.size() == index.chunks.size());
    fields.push_back(field.info);
    index.fields.push_back(
        {field.info.components,
         field.info.association == "cell" ? Association::kCell : Association::kPoint,
         field.info.hasMissing,
         {}});
  }
  manifest->fields = std::move(fields);
  keepOpening(*manifest, kept);
  index.manifestMinor = minorOf(*manifest);
  for (ManifestLevel& level : manifest->levels)
    if (level.error) keepErrors(*level.error, level.level, kept, added);
  Result<Bytes> manifestBytes = manifestBlock(*manifest);
  if (!manifestBytes) return std::unexpected(manifestBytes.error());
  index.manifest = std::move(*manifestBytes);

  Blocks blocks(index.chunks.size());
  for (std::uint32_t chunk = 0; chunk < blocks.size(); ++chunk) {
    blocks[chunk] = {log.block(chunk, kStructurePart), log.block(chunk, kPositionsPart)};
    for (const std::uint32_t f : kept)
      blocks[chunk].push_back(log.block(chunk, kFirstFieldPart + f));
    for (const NewField& field : added) blocks[chunk].push_back(field.blocks[chunk]);
    for (const ByteView block : blocks[chunk])
      if (block.size() > kMaxBlockBytes)
        return fail(ErrorCode::kLimitExceeded,
                    "a block above 256 MiB; take fewer components or bits");
  }
  std::vector<ByteView> closing;
  index.closing.clear();
  for (const ClosingBlock& c : log.index().closing) {
    const auto place = std::ranges::find(kept, c.field);
    if (c.kind == ClosingKind::kExactField && place == kept.end()) continue;
    index.closing.push_back(c);
    if (c.kind == ClosingKind::kExactField)
      index.closing.back().field = static_cast<std::uint32_t>(place - kept.begin());
    closing.push_back(viewOf(log, c));
  }
  return together(std::move(index), blocks, closing);
}

Result<Bytes> withClosing(const LogFile& log, const std::vector<NewClosing>& added) {
  LogIndex index = log.index();
  Blocks blocks(index.chunks.size());
  for (std::uint32_t chunk = 0; chunk < blocks.size(); ++chunk)
    for (std::uint32_t part = 0; part < index.parts(); ++part)
      blocks[chunk].push_back(log.block(chunk, part));
  std::vector<ByteView> closing;
  for (const ClosingBlock& c : index.closing) closing.push_back(viewOf(log, c));
  for (const NewClosing& c : added) {
    if (c.bytes.size() > kMaxBlockBytes)
      return fail(ErrorCode::kLimitExceeded,
                  "a closing block above 256 MiB; leave out `lossless` or `keepOrder`");
    assert(index.closingBlock(c.kind, c.field) == nullptr);
    index.closing.push_back({c.kind, c.field, {}});
    closing.push_back(c.bytes);
  }
  return together(std::move(index), blocks, closing);
}

}  // namespace qtet

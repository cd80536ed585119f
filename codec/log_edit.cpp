#include "codec/log_edit.h"

#include <string>
#include <utility>

#include "codec/log_manifest.h"
#include "proto/crc32c.h"
#include "proto/limits.h"

namespace qtet {
namespace {

using Blocks = std::vector<std::vector<ByteView>>;  // chunk, part

/// Offsets, sizes and checksums that fit `blocks`. Where the first block starts depends on the table, whose own size may depend on what it says.
void layOut(LogIndex& index, const Blocks& blocks) {
  for (std::size_t chunk = 0; chunk < blocks.size(); ++chunk) {
    index.chunks[chunk].blocks.clear();
    for (const ByteView block : blocks[chunk]) index.chunks[chunk].blocks.push_back({0, static_cast<std::uint32_t>(block.size()), crc32c(block)});
  }
  std::uint64_t offset = index.encode().size();
  for (ChunkEntry& chunk : index.chunks) {
    chunk.offset = offset;
    for (BlockEntry& block : chunk.blocks) block.offset = std::exchange(offset, offset + block.size);
  }
  index.fileBytes = offset;
}

void keepErrors(LevelError& error, std::size_t level, const std::vector<std::uint32_t>& kept, const std::vector<NewField>& added) {
  const std::vector<FieldError> before = std::exchange(error.fields, {});
  for (const std::uint32_t f : kept) error.fields.push_back(before[f]);
  for (const NewField& field : added) error.fields.push_back(field.errors[level]);
}

}  // namespace

Result<Bytes> withFields(const LogFile& log, const std::vector<std::uint32_t>& kept, const std::vector<NewField>& added) {
  Result<Manifest> manifest = manifestOf(log.index());
  if (!manifest) return std::unexpected(manifest.error());
  if (kept.size() + added.size() > kMaxFields) return fail(ErrorCode::kLimitExceeded, "the log would have more than 256 fields; remove some first");
  LogIndex index = log.index();
  std::vector<ManifestField> fields;
  index.fields.clear();
  for (const std::uint32_t f : kept) {
    fields.push_back(manifest->fields[f]);
    index.fields.push_back(log.index().fields[f]);
  }
  for (const NewField& field : added) {
    fields.push_back(field.info);
    index.fields.push_back({field.info.components, field.info.association == "cell" ? Association::kCell : Association::kPoint, field.info.gaps});
  }
  manifest->fields = std::move(fields);
  for (ManifestLevel& level : manifest->levels)
    if (level.error) keepErrors(*level.error, level.level, kept, added);
  index.manifest = manifestToJson(*manifest);

  Blocks blocks(index.chunks.size());
  for (std::uint32_t chunk = 0; chunk < blocks.size(); ++chunk) {
    blocks[chunk] = {log.block(chunk, kStructurePart), log.block(chunk, kPositionsPart)};
    for (const std::uint32_t f : kept) blocks[chunk].push_back(log.block(chunk, kFirstFieldPart + f));
    for (const NewField& field : added) blocks[chunk].push_back(field.blocks[chunk]);
    for (const ByteView block : blocks[chunk])
      if (block.size() > kMaxBlockBytes) return fail(ErrorCode::kLimitExceeded, "a block above 256 MiB; take fewer components or bits");
  }
  layOut(index, blocks);
  Bytes out = index.encode();
  out.reserve(index.fileBytes);
  for (const auto& chunk : blocks)
    for (const ByteView block : chunk) out.insert(out.end(), block.begin(), block.end());
  return out;
}

}  // namespace qtet

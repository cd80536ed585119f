// A log on disk or in memory: opened with every checksum available, refined to any level natively.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "codec/log/chunk_entry.h"
#include "codec/log/closing_block.h"
#include "codec/log/field_shape.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

class Refiner;
struct LatticeMesh;
struct LogIndex;
struct Manifest;

/// A log mapped read-only into memory, or held there. Immutable, so safe to share between threads;
/// views live as long as the object.
class LogFile {
 public:
  /// SHA-256 in lower-case hexadecimal, of a room that has a faster one than ours.
  using DigestOf = std::string (*)(ByteView);

  /// Maps the file and checks header, manifest and table, and that the file is as long as it says.
  /// Its digest is ours, made without keeping the file in memory, or `digestOf`'s. Errors: io, and
  /// LogIndex::parse's.
  [[nodiscard]] static Result<LogFile> open(const std::filesystem::path& path,
                                            DigestOf digestOf = nullptr);
  /// The same of a file that is open for reading, and may be closed afterwards. Errors call it
  /// `name`.
  [[nodiscard]] static Result<LogFile> map(int file, const std::string& name,
                                           DigestOf digestOf = nullptr);
  /// The same of bytes that were read or fetched elsewhere. Errors: as open, but for io.
  [[nodiscard]] static Result<LogFile> fromBytes(Bytes bytes);
  LogFile(LogFile&&) noexcept;
  LogFile& operator=(LogFile&&) noexcept;
  ~LogFile();

  [[nodiscard]] ByteView bytes() const;
  [[nodiscard]] const LogIndex& index() const;
  /// SHA-256 of the whole file, lower-case hexadecimal; computed once at open.
  [[nodiscard]] const std::string& digest() const;
  [[nodiscard]] std::span<const ChunkEntry> chunks() const;
  [[nodiscard]] std::span<const FieldShape> fields() const;
  [[nodiscard]] std::span<const ClosingBlock> closingBlocks() const;
  [[nodiscard]] bool hasClosing(ClosingKind kind, std::uint32_t field = 0) const;
  /// Bytes of header, manifest and table: where the first block starts.
  [[nodiscard]] std::uint64_t headBytes() const;
  [[nodiscard]] ByteView block(std::uint32_t chunk, std::uint32_t part) const;
  /// The integers of a value block, after comparing it with its CRC-32C; its memory is given back.
  /// Errors: bad-checksum, decodeValueBlock's. REQUIRES: not the structure, nor a lifted block.
  [[nodiscard]] Result<std::vector<std::int32_t>> values(std::uint32_t chunk,
                                                         std::uint32_t part) const;
  /// The bytes of a block after comparing them with its CRC-32C. Errors: bad-checksum.
  [[nodiscard]] Result<ByteView> checkedBlock(std::uint32_t chunk, std::uint32_t part) const;
  /// The bytes of a closing block after comparing them with its CRC-32C. Errors: not-found (the log
  /// has none of the kind), bad-checksum.
  [[nodiscard]] Result<ByteView> closing(ClosingKind kind, std::uint32_t field = 0) const;
  /// Compares every block with its CRC-32C; the first that differs is the error (bad-checksum,
  /// chunk and part in the message). Keeps none of them in memory.
  [[nodiscard]] Status verifyChecksums() const;
  /// Lets the system take the memory of these bytes of a mapped file. They can be read as before,
  /// from the file. Readers of whole logs call it behind themselves.
  void release(std::uint64_t offset, std::uint64_t size) const;

 private:
  struct State;
  explicit LogFile(std::unique_ptr<State> state);
  [[nodiscard]] static Result<LogFile> checked(std::unique_ptr<State> state,
                                               DigestOf digestOf = nullptr);
  std::unique_ptr<State> state_;
};

/// Decodes one chunk's blocks (checksum, range coder, Draco) into the refiner: the mesh, and the
/// named fields.
Status applyChunk(const LogFile& log, Refiner& refiner, std::uint32_t chunk,
                  std::span<const std::uint32_t> fields);

/// Decodes one field's block of a chunk that the refiner has. Errors: not-found (no such field),
/// Refiner::applyField's, bad-checksum, bad-codec.
Status applyFieldBlock(const LogFile& log, Refiner& refiner, std::uint32_t chunk,
                       std::uint32_t field);

/// Decodes the mesh up to level `level` with the named fields, which the refiner does not have.
/// Errors: applyChunk's, not-found (no such level), io (`stop` was requested; looked at before
/// every chunk). REQUIRES: a refiner without a chunk.
Status refineToLevel(const LogFile& log, Refiner& refiner, std::uint32_t level,
                     std::span<const std::uint32_t> fields, const std::stop_token& stop);

/// The mesh that `refiner` holds, with the fields of these numbers.
[[nodiscard]] LatticeMesh latticeMesh(const Manifest& manifest, const Refiner& refiner,
                                      std::span<const std::uint32_t> fields);

/// The mesh after level `level` (0 = base mesh) with the given fields; nullopt fields = all.
/// Errors: not-found (no such level), decoding errors, io (`stop` was requested; looked at after
/// every chunk).
[[nodiscard]] Result<LatticeMesh> meshAtLevel(
    const LogFile& log, std::uint32_t level,
    const std::optional<std::vector<std::uint32_t>>& fields = std::nullopt,
    const std::stop_token& stop = {});

}  // namespace qtet

// Puts the chunks of a log together (FORMAT.md, "Refinement"). A patch decoder refines the mesh in
// place; the fields follow it at once or later. Engine-free and exception-free; compiled natively
// and to WebAssembly.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/log/field_shape.h"
#include "codec/mesh/mesh.h"
#include "codec/refine/patch_requests.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

struct LogIndex;

/// Applies the chunks of one log in file order. Vertices and cells keep their slots for ever; an
/// affected cell changes one index. A chunk's slots follow from the chunk table (firstSlots). Not
/// thread-safe. After an error no further chunk is accepted; ids stay in range, but the mesh is a
/// part of a chunk's.
class Refiner {
 public:
  explicit Refiner(const LogIndex& index);
  ~Refiner();
  Refiner(Refiner&&) noexcept;
  Refiner& operator=(Refiner&&) noexcept;

  /// Applies chunk `chunk`: `structure` is its structure block, `positions` the decoded positions
  /// block (3 integers a value). Errors: bad-order (another chunk comes next), bad-checksum is the
  /// caller's to find, anything else of FORMAT.md.
  Status apply(std::uint32_t chunk, ByteView structure, std::span<const std::int32_t> positions);
  /// Applies field `field` of chunk `chunk`: as many tuples as LogIndex::tuples says. A field may
  /// lag behind the mesh, never run ahead, and takes chunks in file order, like the mesh.
  Status applyField(std::uint32_t field, std::uint32_t chunk, std::span<const std::int32_t> values);
  /// The same of a lifted block's bytes. Errors: truncated and limit-exceeded as well. REQUIRES:
  /// LogIndex::blockCodec says kLifted.
  Status applyField(std::uint32_t field, std::uint32_t chunk, ByteView block);

  /// Brings the later fields of an index that was read without them (LogIndex::readLater). Errors:
  /// readLater's; then nothing has changed. REQUIRES: index().unreadBytes() > 0.
  Status readLater(ByteView part);

  /// Gives the memory of a field's values back, as if none of its blocks had come. REQUIRES: a
  /// field of the log.
  void forgetField(std::uint32_t field);

  /// From now on fields of this association have values at these elements alone, once all their
  /// blocks are applied. Values at other elements mean nothing. This takes much less time than all
  /// values. Lifted blocks take as long as ever, since each value depends on those round it.
  /// REQUIRES: the log has such a field and none was applied; the elements are there; no chunk
  /// comes later.
  void fieldsOnlyAt(Association association, std::span<const std::uint32_t> elements);

  /// A chunk that goes beyond `level` then ends there, and chunks that begin beyond it are refused.
  /// Once level() is `level`, the mesh is that level's.
  void stopAtLevel(std::uint32_t level);

  /// From now on `observer` is notified of every split; nullptr turns this off. It must outlive the
  /// chunks applied.
  void observe(SplitObserver* observer);

  /// From now on `gate` is asked before every level; nullptr: nobody. False
  /// ends the current chunk with the error io. It must outlive the chunks applied.
  void askBeforeLevels(LevelGate* gate);

  [[nodiscard]] const LogIndex& index() const;
  /// How many; this is also the next one.
  [[nodiscard]] std::uint32_t chunksApplied() const;
  /// Where the slots of a chunk begin; those of the next chunk begin where they end. REQUIRES:
  /// chunk <= number of chunks.
  [[nodiscard]] const Slots& firstSlots(std::uint32_t chunk) const;
  /// Chunks of one field that have been applied.
  [[nodiscard]] std::uint32_t fieldChunksApplied(std::uint32_t field) const;
  /// The last complete level.
  [[nodiscard]] std::uint32_t level() const;

  /// Work so far, which limit-exceeded bounds (kMaxStepsPerByte).
  [[nodiscard]] std::uint64_t steps() const;
  /// The counts of the complete levels, 0 first. One chunk may complete several.
  [[nodiscard]] std::span<const LevelCounts> levelCounts() const;

  [[nodiscard]] std::span<const LatticePoint> points() const;
  [[nodiscard]] std::span<const Tetrahedron> tetrahedra() const;
  [[nodiscard]] std::span<const Triangle> boundary() const;
  /// GrowingMesh::across.
  [[nodiscard]] std::optional<CellId> across(CellId tetrahedron, std::size_t corner) const;
  /// components * points integers, or components * tetrahedra for a cell field. Until the field's
  /// block of a chunk arrives, the chunk's vertices carry their fused vertex's value and its
  /// tetrahedra their prediction.
  [[nodiscard]] std::span<const std::int32_t> fieldValues(std::uint32_t field) const;

  /// SHA-256 over points, tetrahedra and boundary in slot order, little-endian (FORMAT.md,
  /// "Digests").
  [[nodiscard]] std::array<std::uint8_t, 32> digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtet

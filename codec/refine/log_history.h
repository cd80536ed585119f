// A log decoded back into the history that it was written from: what measuring its levels and
// adding fields to it start from.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/log/codec_id.h"
#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/fusion_history.h"
#include "codec/record/point_values.h"

namespace qtet {

class LogFile;

/// The geometry of a log; its fields are left out.
struct LogHistory {
  /// Stands at level 0, without fields. Vertices: those of the last level by slot, then the fused
  /// ones. Cells: tetrahedra by slot, then boundary triangles by slot.
  FusionHistory history;
  std::uint32_t vertices = 0;    ///< of the last level
  std::uint32_t tetrahedra = 0;  ///< of the last level
  std::vector<BaseBirth> baseBirths;
  /// Slot of the base mesh -> the history's vertex.
  std::vector<VertexId> baseVertices;
  PointAncestry points{true};
  CellAncestry cells;
  std::vector<std::array<VertexId, 4>> prey;  ///< of each birth, in the order of coding
  /// Births and tetrahedra before chunk i, and of all chunks.
  std::vector<std::uint32_t> chunkBirths, chunkCells;
  std::vector<CodecId> valueCodecs;  ///< of each chunk
};

/// Errors: all that decoding gives. `progress` receives the fraction done.
[[nodiscard]] Result<LogHistory> historyOf(const LogFile& log,
                                           const std::function<void(double)>& progress = {});

/// The field's integers, `components` for each of the history's vertices or, of a cell field,
/// tetrahedra: those that its writer had. Errors: bad-checksum, all that decoding gives. REQUIRES:
/// the history of this log, a field of it.
[[nodiscard]] Result<std::vector<std::int32_t>> historyValues(const LogFile& log,
                                                              const LogHistory& history,
                                                              std::uint32_t field);

/// One field's block of every chunk, as a log's writer would have made them. `values` holds
/// components integers for each of the history's vertices or, of a cell field, tetrahedra. Errors:
/// limit-exceeded, bad-codec.
[[nodiscard]] Result<std::vector<Bytes>> encodeFieldBlocks(const LogHistory& log,
                                                           const FieldInfo& field,
                                                           std::span<const std::int32_t> values);

}  // namespace qtet

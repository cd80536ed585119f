// A log decoded back into the history that it was written from: what measuring its levels and
// adding fields to it start from.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/log/codec_id.h"
#include "codec/record/fusion_history.h"
#include "codec/record/value_order.h"

namespace qtet {

class LogFile;

/// The geometry of a log; its fields are left out.
struct LogHistory {
  /// Stands at level 0, without fields. Vertices: those of the last level by slot, then the fused
  /// ones. Cells: tetrahedra by slot, then boundary triangles by slot.
  FusionHistory history;
  std::uint32_t vertices = 0;    ///< of the last level
  std::uint32_t tetrahedra = 0;  ///< of the last level
  ValueOrder order;
  CodecId valueCodec = CodecId::kLifted;
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

}  // namespace qtet

// Error against bytes: of the prefixes of a log, and of the ladder of separate meshes that one
// would send without it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simplify/log/opened_log.h"
#include "tests/bench/parts/error_plot.h"

namespace qtet::bench {

/// The mesh to look at once so many bytes have been fetched.
struct RatePoint {
  double bytes = 0;
  std::uint32_t level = 0;  ///< of the log that the mesh is a level of
  double boundary = 0;      ///< LevelError::boundaryMean()
  double field = 0;         ///< rms of the log's first field
};
/// Bytes and quality rise from point to point; a point stands until the next.
using RateCurve = std::vector<RatePoint>;

/// The known errors of a log's levels at the lengths of its prefixes. If several levels end with
/// the same byte, only the finest counts. Errors: not-found (a log without known errors or without
/// a field).
[[nodiscard]] Result<RateCurve> logCurve(const OpenedLog& log);

/// Meshes at 1/64, 1/16, 1/4 and 1 of the cells, fetched one after the other. They are the log's
/// own finest levels of at most so many cells (level 0 where none is so small). Each is encoded by
/// itself as a base mesh without records. REQUIRES: a log that logCurve takes. Errors: those of
/// decoding and encoding.
[[nodiscard]] Result<RateCurve> ladderCurve(const OpenedLog& log);

using Measure = double RatePoint::*;

/// How a curve compares with another at every byte count at which either of them improves.
struct Comparison {
  std::size_t places = 0;  ///< such byte counts
  /// Places where the curve's error is larger, or it has nothing to show while the other has.
  std::size_t above = 0;
  /// The largest error over the other's, where both show something that has an error.
  double worst = 0;
  double worstBytes = 0;  ///< where that is
};
[[nodiscard]] Comparison compare(const RateCurve& curve, const RateCurve& other, Measure measure);

/// The first point that keeps both bounds. REQUIRES: a curve that ends without error.
[[nodiscard]] RatePoint firstWithin(const RateCurve& curve, double boundary, double field);

[[nodiscard]] ErrorCurve plotted(const std::string& name, const RateCurve& curve, Measure measure);

}  // namespace qtet::bench

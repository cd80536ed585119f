// Error against bytes as a picture: what a reader of the first so many bytes of a log has to live
// with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/error.h"
#include "proto/manifest.h"

namespace qtet {

struct ErrorPlotPoint {
  double bytes = 0;  ///< of the log's prefix
  double error = 0;  ///< a fraction
};

struct ErrorCurve {
  std::string name;
  /// Drawn apart from the fields: over the diagonal, not over a range.
  bool isBoundary = false;
  std::vector<ErrorPlotPoint> points;  ///< coarse-first
};

/// The boundary's distance and the rms error of each field, over the prefix lengths `bytes`, one a
/// level. If several levels end with the same byte, only the finest counts. Errors: not-found where
/// the manifest has no errors.
[[nodiscard]] Result<std::vector<ErrorCurve>> errorCurves(const Manifest& manifest,
                                                          const std::vector<std::uint64_t>& bytes);

/// An SVG document with logarithmic axes and a legend, legible on light and dark ground. Curves are
/// steps. Errors of 0, and those below a hundred-thousandth of the largest, lie on the lower edge.
/// REQUIRES: at least one curve; bytes above 0.
[[nodiscard]] std::string errorPlotSvg(const std::string& title,
                                       const std::vector<ErrorCurve>& curves);

}  // namespace qtet

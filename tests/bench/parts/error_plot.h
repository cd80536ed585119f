// Error against bytes as a picture: what a reader of the first so many bytes of a log has to live
// with.
#pragma once

#include <string>
#include <vector>

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

/// An SVG document with logarithmic axes and a legend, legible on light and dark ground. Curves are
/// steps. Errors of 0, and those below a hundred-thousandth of the largest, lie on the lower edge.
/// REQUIRES: at least one curve; bytes above 0.
[[nodiscard]] std::string errorPlotSvg(const std::string& title,
                                       const std::vector<ErrorCurve>& curves);

}  // namespace qtet

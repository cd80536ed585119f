// The points of a file with their values in a spool, so that those of any few cells can be fetched.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "codec/files/byte_spool.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

class PointRecords {
 public:
  /// Each point has `values` numbers beside its three coordinates.
  PointRecords(std::unique_ptr<ByteSpool> spool, std::size_t values)
      : spool_(std::move(spool)), width_(values + 3) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  /// Whole records, one after the other. Errors: io.
  Status append(std::span<const double> records);
  /// Calls take(i, record) for the i-th of the points. Errors: io. REQUIRES: numbers that ascend,
  /// of points that were appended.
  template <class Take>
  Status fetch(std::span<const std::uint64_t> points, const Take& take) const {
    std::vector<double> some;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
      end = runEnd(points, begin);
      const std::uint64_t first = points[begin];
      some.resize((points[end - 1] - first + 1) * width_);
      const std::span bytes(reinterpret_cast<std::uint8_t*>(some.data()),
                            some.size() * sizeof(double));
      if (Status s = spool_->read(first * width_ * sizeof(double), bytes); !s) return s;
      for (std::size_t i = begin; i < end; ++i)
        take(i, std::span(some).subspan((points[i] - first) * width_, width_));
    }
    return {};
  }

 private:
  /// Behind the last point that is read together with points[begin].
  [[nodiscard]] static std::size_t runEnd(std::span<const std::uint64_t> points, std::size_t begin);

  std::unique_ptr<ByteSpool> spool_;
  std::size_t width_;
};

}  // namespace qtet

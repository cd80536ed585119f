#include "simplify/read/pieces/point_records.h"

#include <cassert>

namespace qtet {
namespace {

/// Points that are read in vain where that saves a call.
constexpr std::uint64_t kGap = 32;
/// Points that are read at once: some MB.
constexpr std::uint64_t kRun = 65536;

}  // namespace

Status PointRecords::append(std::span<const double> records) {
  assert(records.size() % width_ == 0);
  return spool_->append(
      {reinterpret_cast<const std::uint8_t*>(records.data()), records.size() * sizeof(double)});
}

std::size_t PointRecords::runEnd(std::span<const std::uint64_t> points, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < points.size() && points[end] - points[end - 1] <= kGap &&
         points[end] - points[begin] < kRun)
    ++end;
  return end;
}

}  // namespace qtet

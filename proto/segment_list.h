// The list of a series whose cells change: a log for each run of steps with the same cells
// (SEGMENT_LIST.md).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

namespace qtet {

/// How the name of a list's file ends.
inline constexpr std::string_view kListEnding = ".json";
/// Logs of one list. A viewer opens each log before it knows its fields, so a list of more is a
/// series of files and not a film.
inline constexpr std::size_t kMaxSegments = 1024;
/// Bytes of a list: 1,024 logs of a hundred times each take some 2 MB.
inline constexpr std::size_t kMaxListBytes = std::size_t{4} << 20;

/// A run of consecutive steps with the same cells and number of points.
struct Segment {
  std::string log;            ///< a file's name beside the list, which ends in .qtet
  std::vector<double> times;  ///< finite, ascending, one at least
};

struct SegmentList {
  std::vector<Segment> segments;  ///< one at least; their times ascend over all of them

  /// The times of all segments, ascending.
  [[nodiscard]] std::vector<double> times() const;
};

/// Whether `name` is a file's name without a path that ends in .qtet.
[[nodiscard]] bool isSegmentLog(std::string_view name);

/// Reads a list; members that are unknown are ignored. Errors, with the JSON pointer of the place:
/// limit-exceeded (more than kMaxListBytes or kMaxSegments), bad-value.
[[nodiscard]] Result<SegmentList> readSegmentList(std::string_view text);

/// The list as JSON, a segment a line. Numbers come back to the bit. Errors: those of
/// readSegmentList, which reads the text.
[[nodiscard]] Result<std::string> segmentListText(const SegmentList& list);

}  // namespace qtet

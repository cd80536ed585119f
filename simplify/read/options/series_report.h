// The report on several steps of a file: fields, types, motion.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace qtet {

/// The instants of one field. Its key has its association and its name without a time.
struct InstantsReport {
  std::uint32_t components = 1;
  std::string type;                               ///< holds the values of all instants
  std::map<std::string, std::set<double>> times;  ///< by the type that the file has there
};

/// The points move: how far at most, from where they are at time `rest`.
struct MotionReport {
  std::string field;
  double rest = 0;
  std::set<double> moved;  ///< times at which they lie elsewhere
  bool isRead = false;     ///< the field is among those asked for
  double largest = 0;
};

/// On all steps that were read so far. The reports of windows add up to one (series_notes.h).
struct SeriesReport {
  std::set<double> times;
  std::map<std::pair<std::string, std::string>, InstantsReport> fields;
  std::set<double> reordered;  ///< had their points or cells in another order than the first
  std::optional<MotionReport> motion;
};

}  // namespace qtet

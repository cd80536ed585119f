// Statistics of series over their instants: T@TIME gives the fields T_average, T_minimum, T_maximum
// and T_stddev, as ParaView's filter Temporal Statistics names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// The names of the fields that a series gives, in their order.
[[nodiscard]] std::vector<std::string> statisticsNames(std::string_view series);

/// Whether the fields have series whose statistics can be added. The log would hold `count` fields
/// without them. Errors: bad-value (no series of two instants; a field or series has such a name;
/// one name of two series), limit-exceeded (more than kMaxFields fields; a name of more than
/// kMaxNameBytes bytes).
[[nodiscard]] Status checkTimeStatistics(std::span<const MeshField> fields, std::size_t count);

/// Sums of the instants that it has seen: 36 bytes a value of a series, whatever their number. Each
/// value and component is for itself, and every instant counts the same. A value that is NaN or
/// infinite does not count. All sums are by Welford (1962), in float64. So the same instants give
/// the same numbers, however they come.
class TimeStatistics {
 public:
  /// Takes the instants NAME@TIME of some fields. The instants of a series must come by time, but
  /// may stand in any order in one call. Those of a time that is not behind the last one do not
  /// count. Errors: bad-input (an instant with another number of values).
  [[nodiscard]] Status add(std::span<const MeshField> fields);

  /// Four fields for each series of two instants and more, in the order of their first ones. The
  /// least and the largest have the series' type. Average and deviation of integers are float64.
  /// The deviation is that of all instants: the mean square is over their number. A value that no
  /// instant has is NaN. REQUIRES: called once and last.
  [[nodiscard]] std::vector<MeshField> take();

 private:
  struct Sums {
    MeshField kind{};  // the series' name, and no values
    double lastTime = 0;
    std::size_t instants = 0;
    std::vector<std::uint32_t> counts{};
    std::vector<double> means{}, squares{}, least{}, largest{};
  };
  [[nodiscard]] Status addInstant(const MeshField& field);
  [[nodiscard]] static std::vector<MeshField> fieldsOf(Sums&& sums);

  std::vector<Sums> series_;
};

/// Puts the statistics of all series behind the fields. Errors: checkTimeStatistics's,
/// TimeStatistics::add's.
[[nodiscard]] Status addTimeStatistics(std::vector<MeshField>& fields);

}  // namespace qtet

// The instants that a log has, and those that come to it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "proto/error.h"
#include "proto/manifest.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

class KnownInstants {
 public:
  explicit KnownInstants(const Manifest& manifest);

  /// Some series has an instant of that time.
  [[nodiscard]] bool knows(double time) const { return hasTime(times_, time); }
  /// The log has a series of the field, or one came. REQUIRES, here and below: the field's name is
  /// that of an instant.
  [[nodiscard]] bool knowsSeriesOf(const MeshField& field) const {
    return seriesOf(field) != nullptr;
  }
  /// Its series has an instant of its time.
  [[nodiscard]] bool has(const MeshField& field) const;
  /// Adds the field to its series, as which it is. `file` is where it was read. Errors: bad-input
  /// (another type or number of components).
  Status add(MeshField& field, const std::string& file);
  /// A sentence about instants before the log's last one; empty without any.
  [[nodiscard]] std::string warning() const;

 private:
  /// The times of a series, and what its instants have in common.
  struct OneSeries {
    std::set<double> times;
    std::uint32_t components = 1;
    std::string type;
  };

  [[nodiscard]] static bool hasTime(const std::set<double>& times, double time);
  [[nodiscard]] const OneSeries* seriesOf(const MeshField& field) const;

  std::map<std::pair<std::string, std::string>, OneSeries> series_;  // by association and name
  std::set<double> times_, between_;
  std::optional<double> last_;  // of the log
};

}  // namespace qtet

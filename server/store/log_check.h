// The check of a log that somebody sent, before anybody sees it: decoded whole, within bounds of
// memory and time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "server/store/served_mesh.h"

namespace qtet {

namespace limits {
/// Bytes of memory that one check may take, as predicted by codec/log/decoding_memory.h: 80 for
/// each tetrahedron of a log of 50 million with a field.
inline constexpr std::uintmax_t kMaxCheckBytes = std::uintmax_t{4} << 30;
/// From a check's beginning to its end. That many tetrahedra take a minute.
inline constexpr std::chrono::minutes kCheckTime{10};
}  // namespace limits

struct CheckLimits {
  /// Memory, as predicted by codec/log/decoding_memory.h.
  std::uintmax_t bytes = limits::kMaxCheckBytes;
  std::chrono::milliseconds time = limits::kCheckTime;  ///< of one check, from its own beginning
};

/// The end of a check, and its reason for people; "" for kSound.
struct CheckVerdict {
  enum class End : std::uint8_t {
    kSound,     ///< everything decodes and agrees with the manifest
    kTooLarge,  ///< beyond the limits; the reason has the figure
    kUnsound,   ///< the reason has the fault and its place
    kBusy,      ///< there is no memory just now, or `stop` was requested
    kFailed,    ///< the process that decoded it has ended
  };
  End end = End::kSound;
  std::string reason{};
};

/// Decodes every record and the values of every field. Looks at `stop` before every level and after
/// every chunk.
[[nodiscard]] CheckVerdict checkLog(const ServedMesh& mesh, const CheckLimits& limits,
                                    const std::stop_token& stop);
using LogCheck =
    std::function<CheckVerdict(const ServedMesh&, const CheckLimits&, const std::stop_token&)>;

}  // namespace qtet

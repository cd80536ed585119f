// States which calls fail, how often, and how. A mapped file shares the plan between a test and the
// program into which it has loaded libqtet_faults.so.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace qtet::test {

enum class Fault : std::uint8_t {
  kReceive,
  kSend,
  kSendFile,
  kAccept,
  kOpen,
  kMap,
  kReadFile,
  kWriteFile
};
inline constexpr std::size_t kFaults = 8;

/// All zero: nothing fails. Lies in a file that both sides map; the environment variable
/// QTET_FAULTS names it.
struct FaultPlan {
  struct Kind {
    std::atomic<std::uint32_t> every;  ///< each N-th call fails; 0: none
    /// Always this one; 0: what is plausible, one after the other.
    std::atomic<std::int32_t> error;
    std::atomic<std::uint32_t> calls;
    std::atomic<std::uint32_t> failed;  ///< or done in part only: one byte
  };
  std::array<Kind, kFaults> kinds;
  std::atomic<std::int64_t> clockShift;  ///< seconds that CLOCK_REALTIME is off by

  [[nodiscard]] Kind& of(Fault fault) { return kinds[static_cast<std::size_t>(fault)]; }
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace qtet::test

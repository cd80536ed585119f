// Functions of a C library, for METIS. Random numbers are those of glibc, so that the page cuts a
// mesh as `qtet` does. No clock runs: METIS would take the time for messages that are off.
#include <sys/resource.h>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

/// glibc's random numbers: each is the sum of those 3 and 31 before it.
class SummedNumbers {
 public:
  /// REQUIRES: 1 <= seed < 2^31 - 1
  explicit SummedNumbers(std::uint32_t seed) {
    std::uint64_t word = seed;
    for (std::uint32_t& number : last_) {
      number = static_cast<std::uint32_t>(word);
      word = word * 16807 % 2147483647;
    }
    for (std::size_t i = 0; i < 10 * last_.size(); ++i) next();
  }

  int next() {
    std::uint32_t& number = last_[(at_ + 3) % last_.size()];
    number += last_[at_];
    at_ = (at_ + 1) % last_.size();
    return static_cast<int>(number >> 1);
  }

 private:
  std::array<std::uint32_t, 31> last_{};
  std::size_t at_ = 0;
};

SummedNumbers numbers{1};

}  // namespace

extern "C" {

void srand(unsigned seed) { numbers = SummedNumbers(seed); }
int rand() { return numbers.next(); }

/// Memory never shrinks, so its size is the most that was used.
int getrusage(int, rusage* used) {
  constexpr long kPageKilobytes = 64;
  *used = {};
  used->ru_maxrss = static_cast<long>(__builtin_wasm_memory_size(0)) * kPageKilobytes;
  return 0;
}

// Signals jump (setjmp.h), and nobody else raises one.
void (*signal(int, void (*)(int)))(int) { return nullptr; }
int raise(int) { __builtin_trap(); }

}  // extern "C"

// Runs a fuzz target without libFuzzer, so that every build replays the fuzzer's inputs. It runs
// each file named on the command line (or below a folder named there) as it is, then pseudo-random
// mutations of it. The same seed gives the same bytes on every machine.
//   NAME_replay [--mutations=N] [--seed=S] FILE|FOLDER...
// Bytes that end the program are left in ./replay-crash.bin; NAME_replay replay-crash.bin repeats
// the failure.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// Present only in builds with a sanitizer.
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

/// SplitMix64: small, and not left to a library's choice.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  /// In [0, bound); REQUIRES bound > 0.
  std::size_t below(std::size_t bound) { return static_cast<std::size_t>(next() % bound); }

 private:
  std::uint64_t state_;
};

constexpr const char* kCrashFile = "replay-crash.bin";
/// The target's current input, for the crash file.
std::span<const std::uint8_t> current;

/// Only calls that are allowed in a signal handler.
void saveCurrent() {
  const int file = open(kCrashFile, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0) return;
  if (write(file, current.data(), current.size()) == static_cast<ssize_t>(current.size())) {
    constexpr std::string_view kNote = "the input that failed was saved as replay-crash.bin\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kNote.data(), kNote.size());
  }
  close(file);
}

void saveCurrentAndDie(int signalNumber) {
  saveCurrent();
  std::signal(signalNumber, SIG_DFL);
  std::raise(signalNumber);
}

void saveCurrentOnDeath() {
  if (__sanitizer_set_death_callback != nullptr) return __sanitizer_set_death_callback(saveCurrent);
  for (const int signalNumber : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL})
    std::signal(signalNumber, saveCurrentAndDie);
}

/// Hands the target a buffer of exactly the input's size, so that a sanitizer sees the first byte
/// read beyond it.
void run(const Input& input) {
  const auto exact = std::make_unique<std::uint8_t[]>(input.size());
  std::copy(input.begin(), input.end(), exact.get());
  current = {exact.get(), input.size()};
  LLVMFuzzerTestOneInput(exact.get(), input.size());
}

void mutateOnce(Input& input, Random& random) {
  constexpr std::uint8_t kTelling[] = {0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF};
  if (input.empty()) {
    input.push_back(static_cast<std::uint8_t>(random.next()));
    return;
  }
  const std::size_t at = random.below(input.size());
  const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
  switch (random.below(6)) {
    case 0: *place ^= static_cast<std::uint8_t>(1u << random.below(8)); break;
    case 1: *place = kTelling[random.below(std::size(kTelling))]; break;
    case 2: *place = static_cast<std::uint8_t>(random.next()); break;
    case 3: input.resize(at); break;
    case 4:
      input.erase(place, place + static_cast<std::ptrdiff_t>(1 + random.below(std::min<std::size_t>(
                                                                     8, input.size() - at))));
      break;
    default: input.insert(place, static_cast<std::uint8_t>(random.next())); break;
  }
}

Input mutated(Input input, Random& random) {
  // Most mutations near the front, where counts and offsets stand: half of them see only the first
  // 256 bytes changed.
  Input tail;
  if (input.size() > 256 && random.below(2) == 0) {
    tail.assign(input.begin() + 256, input.end());
    input.resize(256);
  }
  for (std::size_t left = 1 + random.below(4); left > 0; --left) mutateOnce(input, random);
  input.insert(input.end(), tail.begin(), tail.end());
  return input;
}

Input readFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    std::fprintf(stderr, "%s: cannot be read; check the name and the rights\n", path.c_str());
    std::exit(2);
  }
  return Input(std::istreambuf_iterator<char>(stream), {});
}

/// The files named, and those below folders named, in the order of their names.
std::vector<fs::path> filesOf(const std::vector<fs::path>& named) {
  std::vector<fs::path> files;
  for (const fs::path& path : named) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<fs::path> below;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) below.push_back(entry.path());
    }
    std::sort(below.begin(), below.end());
    files.insert(files.end(), below.begin(), below.end());
  }
  return files;
}

std::optional<std::uint64_t> numberAfter(std::string_view argument, std::string_view option) {
  if (!argument.starts_with(option)) return std::nullopt;
  const std::string_view digits = argument.substr(option.size());
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    std::fprintf(stderr, "%.*s is no number; give for example %.*s1000\n",
                 static_cast<int>(argument.size()), argument.data(),
                 static_cast<int>(option.size()), option.data());
    std::exit(2);
  }
  return value;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t mutations = 0;
  std::uint64_t seed = 1;
  std::vector<fs::path> named;
  for (int i = 1; i < argc; ++i) {
    if (const auto count = numberAfter(argv[i], "--mutations=")) {
      mutations = *count;
    } else if (const auto number = numberAfter(argv[i], "--seed=")) {
      seed = *number;
    } else {
      named.emplace_back(argv[i]);
    }
  }

  saveCurrentOnDeath();
  std::vector<Input> inputs{Input{}};  // the empty input is always worth a try
  for (const fs::path& path : filesOf(named)) inputs.push_back(readFile(path));
  for (const Input& input : inputs) run(input);
  Random random(seed);
  for (std::uint64_t i = 0; i < mutations; ++i)
    run(mutated(inputs[random.below(inputs.size())], random));
  std::printf("%zu inputs and %llu mutations replayed\n", inputs.size(),
              static_cast<unsigned long long>(mutations));
  return 0;
}

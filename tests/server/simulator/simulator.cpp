// qtet_simulator: runs of the server's sessions on a simulated kernel (SIMULATOR.md).
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <map>
#include <thread>

#include "tests/server/simulator/traffic.h"
#include "tests/server/store/synthetic_log.h"

/// Large pieces come and go: pages that were given back to the system have to be cleared again.
extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "allocator_release_to_os_interval_ms=-1:quarantine_size_mb=16";
}

namespace {

using namespace qtet;  // NOLINT(google-build-using-namespace): a program
using namespace qtet::simulator;

struct Options {
  std::uint64_t first = 1, count = 200, seconds = 20, jobs = 1;
  bool twice = false, verbose = false;
};

constexpr const char* kUsage =
    "usage: qtet_simulator [--first SEED] [--count N] [--seconds S] [--jobs N] [--twice] "
    "[--verbose]\n";

bool readOptions(int count, char** words, Options& out) {
  const std::map<std::string_view, std::uint64_t*> numbers = {{"--first", &out.first},
                                                              {"--count", &out.count},
                                                              {"--seconds", &out.seconds},
                                                              {"--jobs", &out.jobs}};
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--twice") {
      out.twice = true;
    } else if (word == "--verbose") {
      out.verbose = true;
    } else if (const auto found = numbers.find(word); found != numbers.end() && i + 1 < count) {
      const char* const text = words[++i];
      const char* const end = text + std::strlen(text);
      if (std::from_chars(text, end, *found->second).ptr != end || *found->second == 0)
        return false;
    } else {
      return false;
    }
  }
  return true;
}

/// Two logs, one of megabytes, and a page.
struct Folder {
  test::TempFolder logs, pages;
  ViewerFiles viewer;

  Folder() {
    logs.write("small.qtet", test::makeLog({.chunks = 5, .seed = 7}));
    logs.write("large.qtet", test::makeLog({.chunks = 20, .largestBlock = 30'000}));
    pages.write("index.html", std::string_view("<!doctype html><title>a page</title>"));
    Result<ViewerFiles> read = ViewerFiles::load(pages.path());
    if (!read) throw std::runtime_error(read.error().text());
    viewer = std::move(*read);
  }
};

/// The server says that a fault of its own has happened.
class Errors final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  std::string first;

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string_view text(message.payload.data(), message.payload.size());
    if (first.empty() && text.find("the simulated maker has failed") == std::string_view::npos)
      first = text;
  }
  void flush_() override {}
};

/// On a thread of its own, whose variables no other seed has seen.
Outcome runOnce(std::uint64_t seed, const Options& options, const Folder& folder) {
  const auto errors = std::make_shared<Errors>();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("", errors));
  spdlog::set_level(spdlog::level::err);
  Result<MeshStore> store = MeshStore::open(folder.logs.path());
  if (!store) throw std::runtime_error(store.error().text());
  Outcome out;
  std::jthread([&] {
    out = simulate(seed, std::chrono::seconds(options.seconds), *store, folder.viewer);
  }).join();
  if (out.violation.empty()) out.violation = errors->first;
  return out;
}

int runSeed(std::uint64_t seed, const Options& options, const Folder& folder) {
  const Outcome out = runOnce(seed, options, folder);
  const double at = std::chrono::duration<double>(out.at).count();
  if (options.verbose || !out.violation.empty()) {
    std::printf("seed %llu: %.3f s, %llu calls, trace %016llx", (unsigned long long)seed, at,
                (unsigned long long)out.calls, (unsigned long long)out.trace);
    for (const auto& [what, count] : out.seen)
      std::printf(", %s %llu", what.c_str(), (unsigned long long)count);
    std::printf("\n");
  }
  if (!out.violation.empty()) {
    std::printf("seed %llu: at %.6f s: %s\n", (unsigned long long)seed, at, out.violation.c_str());
    return 1;
  }
  if (options.twice && runOnce(seed, options, folder).trace != out.trace) {
    std::printf("seed %llu: another run of it is another\n", (unsigned long long)seed);
    return 1;
  }
  return 0;
}

/// A process that runs seeds one after the other, until it crashes. It says in shared memory which.
struct Worker {
  pid_t process = -1;
  std::uint64_t next = 0;           ///< its next seed
  std::uint64_t* now = nullptr;     ///< the one that it runs, in memory that both share
  std::uint64_t* failed = nullptr;  ///< likewise
};

bool begin(Worker& worker, const Options& options, const Folder& folder) {
  std::fflush(stdout);
  worker.process = ::fork();
  if (worker.process != 0) return worker.process > 0;
  for (; worker.next < options.first + options.count; worker.next += options.jobs) {
    *worker.now = worker.next;
    *worker.failed += static_cast<std::uint64_t>(runSeed(worker.next, options, folder));
    std::fflush(stdout);
  }
  ::_exit(0);  // the folder is the parent's
}

int runAll(const Options& options, const Folder& folder) {
  const std::size_t bytes = 2 * options.jobs * sizeof(std::uint64_t);
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return std::perror("mmap"), 2;
  auto* const shared = static_cast<std::uint64_t*>(memory);
  std::vector<Worker> workers;
  for (std::size_t i = 0; i < options.jobs; ++i) {
    workers.push_back({-1, options.first + i, shared + 2 * i, shared + 2 * i + 1});
    if (!begin(workers.back(), options, folder)) return std::perror("fork"), 2;
  }
  for (std::size_t running = workers.size(); running > 0;) {
    int status = 0;
    const pid_t ended = ::wait(&status);
    Worker& worker = *std::ranges::find(workers, ended, &Worker::process);
    if (status == 0) {
      --running;
      continue;
    }
    std::printf("seed %llu: %s %d\n", (unsigned long long)*worker.now,
                WIFSIGNALED(status) ? "ended by signal" : "ended with code",
                WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
    ++*worker.failed;
    worker.next = *worker.now + options.jobs;
    if (!begin(worker, options, folder)) return std::perror("fork"), 2;
  }
  std::uint64_t failed = 0;
  for (const Worker& worker : workers) failed += *worker.failed;
  ::munmap(memory, bytes);
  std::printf("%llu seeds, %llu failed\n", (unsigned long long)options.count,
              (unsigned long long)failed);
  return failed == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (!readOptions(count, words, options)) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  const Folder folder;
  return options.count == 1 ? runSeed(options.first, options, folder) : runAll(options, folder);
}

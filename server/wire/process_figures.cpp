#include "server/wire/process_figures.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>

namespace qtet {
namespace {

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

struct Memory {
  std::optional<double> whole, resident;  ///< bytes
};

Memory memory() {
  std::ifstream file("/proc/self/statm");
  double whole = 0, resident = 0;
  if (!(file >> whole >> resident)) return {};
  const auto page = static_cast<double>(::sysconf(_SC_PAGESIZE));
  return {whole * page, resident * page};
}

std::optional<double> openFiles() {
  std::error_code ec;
  const std::filesystem::directory_iterator folder("/proc/self/fd", ec);
  if (ec) return std::nullopt;
  return static_cast<double>(std::distance(begin(folder), end(folder)) - 1);  // without this look
}

/// When this file's code began to run, seconds since 1970.
const double kStart =
    std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();

}  // namespace

std::vector<Metrics::Figure> processFigures() {
  std::vector<Metrics::Figure> out = {
      {"process_start_time_seconds", "When the process began, since 1970.", false, kStart}};
  const auto add = [&](const char* name, const char* help, bool counter,
                       std::optional<double> value) {
    if (value) out.push_back({name, help, counter, *value});
  };
  rusage used{};
  if (::getrusage(RUSAGE_SELF, &used) == 0)
    add("process_cpu_seconds_total", "Processor time of the process, its own and the system's.",
        true, secondsOf(used.ru_utime) + secondsOf(used.ru_stime));
  const Memory bytes = memory();
  add("process_resident_memory_bytes", "Memory of the process that lies in RAM.", false,
      bytes.resident);
  add("process_virtual_memory_bytes", "Addresses of the process that lead to something.", false,
      bytes.whole);
  add("process_open_fds", "Files and connections that the process has open.", false, openFiles());
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) == 0)
    add("process_max_fds", "How many it may have open.", false,
        static_cast<double>(files.rlim_cur));
  return out;
}

}  // namespace qtet

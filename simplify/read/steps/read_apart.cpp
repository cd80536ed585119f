#include "simplify/read/steps/read_apart.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "simplify/read/process/trial_process.h"
#include "simplify/read/steps/cell_transfer.h"

namespace qtet {
namespace {

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

/// Why the trial of a reader did not come to its end; what to do about it.
std::unexpected<Error> trialFailed(TrialEnd end, const std::filesystem::path& path,
                                   std::chrono::seconds patience) {
  switch (end) {
    case TrialEnd::kStuck:
      return bad(path, "its reader has read nothing of it for " + std::to_string(patience.count()) +
                           " s, so that it seems to wait for what the file does not hold; if it "
                           "is only large, give it longer with `readSeconds`, else export the "
                           "mesh again, best as .vtu");
    case TrialEnd::kOutOfMemory:
      return bad(path,
                 "reading it wants more memory than this machine has: a count in it is wrong, or "
                 "it is too large for this machine; export the mesh again, best as .vtu");
    default:
      return bad(
          path,
          "its reader crashes on it: its counts contradict each other, or it is too large for "
          "this machine; export the mesh again, best as .vtu");
  }
}

}  // namespace

Result<std::vector<TimedCells>> readApart(const std::filesystem::path& path,
                                          const ReadOptions& options, ReadReport& report,
                                          const StepReader& read) {
  const int file = ::memfd_create("qtet-read", MFD_CLOEXEC);
  if (file < 0)
    return fail(ErrorCode::kIo,
                "no room for what " + path.string() + " holds: " + std::strerror(errno));
  const TrialEnd end = tryOut(
      [&] {
        ReadReport found;
        const Result<std::vector<TimedCells>> steps = read(found);
        sendCells(file, steps, found);
      },
      options.patience);
  Result<std::vector<TimedCells>> out = end == TrialEnd::kDone
                                            ? receiveCells(file, report)
                                            : trialFailed(end, path, options.patience);
  ::close(file);
  return out;
}

}  // namespace qtet

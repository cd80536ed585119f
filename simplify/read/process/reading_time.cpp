#include "simplify/read/process/reading_time.h"

#include <algorithm>

namespace qtet {
namespace {

/// No reading takes longer, and a clock does not overflow: ten years.
constexpr std::uint64_t kLongestSeconds = 315'360'000;

std::chrono::milliseconds timeFor(std::uint64_t fileBytes) {
  return std::chrono::milliseconds(
      std::min(fileBytes / (ReadingTime::kSlowestBytesPerSecond / 1000), kLongestSeconds * 1000));
}

}  // namespace

ReadingTime::ReadingTime(std::chrono::seconds patience, std::uint64_t fileBytes)
    : patience_(patience), end_(Clock::now() + patience + timeFor(fileBytes)) {}

void ReadingTime::addFile(std::uint64_t fileBytes) {
  const std::chrono::milliseconds more = timeFor(fileBytes);
  end_ = end_ > Clock::time_point::max() - more ? Clock::time_point::max() : end_ + more;
}

bool ReadingTime::isOver() const { return Clock::now() > end_; }

std::string ReadingTime::text() const {
  return "reading it takes longer than " + std::to_string(patience_.count()) +
         " s and its size allow, so that it seems to unfold into far more than it holds; if it is "
         "what you expect, give it longer with `readSeconds`, else export the mesh again";
}

Status ReadingTime::check(const std::filesystem::path& path) const {
  if (!isOver()) return {};
  return fail(ErrorCode::kBadInput, path.string() + ": " + text());
}

}  // namespace qtet

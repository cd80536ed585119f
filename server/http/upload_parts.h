// The parts of uploads that stay in the folder until somebody resumes them, and the limits on their
// number.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/http_message.h"
#include "server/http/upload_limits.h"
#include "server/store/free_disk.h"
#include "server/wire/upload_request.h"

namespace qtet {

/// Bounds on parts that are kept, one under way among them.
struct PartQuota {
  std::size_t most = limits::kMaxParts, maxOfToken = limits::kMaxPartsOfToken;
  std::uintmax_t bytes = limits::kMaxPartBytes, bytesOfToken = limits::kMaxPartBytesOfToken;
  /// No upload begins if the disk has less free space than this.
  std::uintmax_t reserve = limits::kDiskReserve;
  FreeDiskBytes freeBytes = freeDiskBytes;
};

/// Not thread-safe: the mutex of Uploads guards it. The token is known only for parts that arrived
/// since the start. Earlier parts count for all tokens together.
class UploadParts {
 public:
  UploadParts(std::filesystem::path folder, PartQuota quota)
      : folder_(std::move(folder)), quota_(std::move(quota)) {}

  /// The file for the bytes of an upload that can be resumed.
  [[nodiscard]] std::filesystem::path resumable(const std::string& id,
                                                const std::string& digest) const;
  /// Where those go that cannot; another place each time.
  [[nodiscard]] std::filesystem::path nameless();

  /// Makes room for an upload into `part`: beyond the bounds of its token the oldest parts of the
  /// same token go. nullopt: there is room, and `part` is under way; else 507, and nothing has
  /// changed for others.
  [[nodiscard]] std::optional<Reply> begin(const UploadRequest& request,
                                           const std::filesystem::path& part);
  /// The upload into `part` has ended.
  void end(const std::filesystem::path& part);
  [[nodiscard]] bool underWay(const std::filesystem::path& part) const {
    return underWay_.contains(part);
  }
  [[nodiscard]] std::size_t countUnderWay() const { return underWay_.size(); }
  [[nodiscard]] std::size_t countUnderWay(const std::string& token) const;

  /// Removes old parts of inactive uploads: those that nobody wrote to for
  /// limits::kPartialUploadTime, or for `ofNoDigest` if they cannot be resumed.
  void removeOld(std::chrono::seconds ofNoDigest);
  /// Sums the parts under way and those that the last begin() or removeOld() has seen. Asks for
  /// each file's size, but does not read the folder, which may hold 100,000 logs.
  [[nodiscard]] std::uintmax_t bytes() const;

 private:
  struct Part {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written;
    std::string token;
  };
  struct UnderWay {
    std::string token;
    std::uintmax_t toCome = 0;  ///< bytes, when it was begun
  };
  /// Those that nobody sends at the moment, the oldest first, without `except`.
  [[nodiscard]] std::vector<Part> kept(const std::filesystem::path& except);

  const std::filesystem::path folder_;
  const PartQuota quota_;
  std::map<std::filesystem::path, UnderWay> underWay_;
  std::map<std::filesystem::path, std::string> tokens_;  // of parts of this run
  std::set<std::filesystem::path> seen_;                 // without those under way
  std::uint64_t next_ = 0;
};

}  // namespace qtet

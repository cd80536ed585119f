// The values of a series at one point, as JSON or CSV (PROTOCOL.md, "Values over time").
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>

#include "proto/bytes.h"
#include "proto/error.h"
#include "server/store/level_request.h"

namespace qtet {

namespace limits {
/// Bytes of a series' values that stay decoded for the next point: 1,000 instants of 60,000 points.
inline constexpr std::uint64_t kKeptValueBytes = 256u << 20;
}  // namespace limits

/// Keeps the mesh that it decoded last, and the values of one series if they are few enough. So
/// only the first point of a series takes long. One thread at a time.
class SeriesMaker {
 public:
  explicit SeriesMaker(std::uint64_t keptValueBytes = limits::kKeptValueBytes);
  ~SeriesMaker();
  SeriesMaker(const SeriesMaker&) = delete;
  SeriesMaker& operator=(const SeriesMaker&) = delete;

  /// The whole text. Decodes the mesh up to the level, then the request's fields and their parents,
  /// one after the other. Looks at `stop` after every chunk and every block of a field. Errors:
  /// not-found (the point lies in no cell; the message has the mesh's box), those of applyChunk, io
  /// (stopped). REQUIRES: a request with a point, the form kJson or kCsv, and fields that are
  /// instants of one series or one field.
  [[nodiscard]] Result<Bytes> make(const LevelRequest& request, const std::stop_token& stop);
  /// Gives all memory back.
  void forget();

 private:
  struct Kept;
  const std::uint64_t keptValueBytes_;
  std::unique_ptr<Kept> kept_;
};

}  // namespace qtet

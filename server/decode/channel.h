// Messages with open files between the server and a process that decodes for it, over a pair of
// connected sockets.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"
#include "server/store/served_mesh.h"

namespace qtet {

namespace limits {
/// Bytes of a message: 8,192 names of fields with room to spare.
inline constexpr std::size_t kMaxDecodeMessage = 64u << 20;
/// Files that come with one message: a log, and where the level goes.
inline constexpr std::size_t kMaxDecodeFiles = 2;
}  // namespace limits

/// A message that arrived, and its files.
struct DecodeMessage {
  Bytes bytes{};
  std::vector<std::unique_ptr<Descriptor>> files{};
};

/// One end of the pair. One thread may send while another receives.
class Channel {
 public:
  /// Takes over an open end.
  explicit Channel(std::unique_ptr<Descriptor> end) : end_(std::move(end)) {}

  /// Waits until the other end has room. Errors: io (nobody is there).
  [[nodiscard]] Status send(ByteView bytes, std::span<const int> files = {}) const;
  /// Waits for a message. Errors: io (nobody is there any more), limit-exceeded (a message, or its
  /// files, beyond the limits above).
  [[nodiscard]] Result<DecodeMessage> receive() const;
  /// From now on a message that takes longer than `most` on its way, once it has begun, is an error
  /// of send() and receive().
  void setPatience(std::chrono::seconds most) const;
  [[nodiscard]] int number() const { return end_->number; }

 private:
  std::unique_ptr<Descriptor> end_;
};

/// Two connected ends, which exec() closes. Errors: io.
[[nodiscard]] Result<std::array<std::unique_ptr<Descriptor>, 2>> connectedEnds();

}  // namespace qtet

// What a session on `/v1/stream` says, and when (PROTOCOL.md, "WebSocket"): the state behind the socket, without the socket.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/messages.h"
#include "server/mesh_store.h"
#include "server/planner.h"

namespace qtet {

/// Close codes of RFC 6455, 7.4.1, that this server uses by its own decision.
enum class CloseCode : std::uint16_t { kGoingAway = 1001, kPolicy = 1008, kInternal = 1011 };

/// A binary frame; the payload lies in the mapping of the log, which lives at least as long as the frame.
struct OutgoingFrame {
  FrameHeader header;
  ByteView payload;
  MeshPointer mesh;
};
using Outgoing = std::variant<std::string, OutgoingFrame, CloseCode>;

/// Fed with messages, asked for what to send next. Not thread-safe; `store` must outlive it.
class StreamProtocol {
 public:
  using Clock = std::chrono::steady_clock;
  explicit StreamProtocol(const MeshStore& store) : store_(store) {}

  void receive(std::string_view json, Clock::time_point now);
  /// Clients send no binary messages.
  void receiveBinary();
  /// The next thing to send; nullopt: nothing before the next message arrives. After a CloseCode nothing follows.
  [[nodiscard]] std::optional<Outgoing> next();

 private:
  void handle(const OpenMessage& message);
  void handle(const CreditMessage& message);
  void handle(const StopMessage& message);
  /// The plan's request, or the error message that answers the `open`.
  std::variant<StreamRequest, ErrorMessage> resolve(const OpenMessage& message, const ServedMesh& mesh) const;
  void start(const OpenMessage& message, const MeshPointer& mesh, const StreamRequest& request);
  void refuse(const char* code, std::string detail);
  bool countMessage(Clock::time_point now);
  bool countOpen();

  const MeshStore& store_;
  std::deque<std::string> answers_;
  bool closing_ = false;

  std::uint32_t stream_ = 0;  ///< `open`s so far
  bool active_ = false;       ///< the plan is not finished
  MeshPointer mesh_;  ///< a stream finishes on the log that it began with
  std::vector<BlockRun> plan_;
  std::size_t nextRun_ = 0;
  std::int64_t credit_ = 0;  ///< bytes; below zero by one frame at most

  Clock::time_point second_{};  ///< the window that the two counters belong to
  unsigned messages_ = 0;
  unsigned opens_ = 0;
};

}  // namespace qtet

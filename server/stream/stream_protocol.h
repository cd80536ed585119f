// Decides what a session on `/v1/stream` sends, and when (STREAM.md). It is the state behind the
// socket, without the socket.
#pragma once

#include <cassert>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/messages.h"
#include "server/store/mesh_store.h"
#include "server/stream/client_blocks.h"
#include "server/stream/planner.h"
#include "server/stream/stream_limits.h"
#include "server/wire/access.h"
#include "server/wire/web_socket_reader.h"

namespace qtet {

/// A binary frame; the payload lies in the mapping of the log, which lives at least as long as the
/// frame.
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
  /// With `mayRead` other meshes are not there.
  explicit StreamProtocol(const MeshStore& store, MayRead mayRead = {})
      : store_(store), mayRead_(std::move(mayRead)) {}

  void receive(std::string_view json, Clock::time_point now);
  /// Clients send no binary messages.
  void receiveBinary();
  /// The next thing to send; nullopt: nothing before the next message arrives, or nothing but
  /// hasFrame(). After a CloseCode nothing follows. A frame's payload has at most `room` bytes, or
  /// is one block, a piece of one, or the head; without room there is none. While more than `piece`
  /// bytes of a block are to come, a frame has so many of them. REQUIRES: piece > 0.
  [[nodiscard]] std::optional<Outgoing> next(std::size_t room = limits::kFramePayload,
                                             std::size_t piece = limits::kFramePayload);

  /// `open`s so far.
  [[nodiscard]] std::uint32_t opens() const { return opens_; }
  /// That of the stream under way; nullptr: none is.
  [[nodiscard]] MeshPointer mesh() const { return stream_ ? stream_->mesh : nullptr; }
  /// There is a frame to send, and credit for it.
  [[nodiscard]] bool hasFrame() const { return !closing_ && hasRun() && stream_->credit > 0; }
  /// There is more to send, and credit alone is wanting.
  [[nodiscard]] bool lacksCredit() const { return hasRun() && stream_->credit <= 0; }

 private:
  void handle(const OpenMessage& message);
  void handle(const CreditMessage& message);
  void handle(const TargetMessage& message);
  void handle(const PauseMessage& message);
  void handle(const ResumeMessage& message);
  void handle(const CancelMessage& message);

  /// A stream that a valid `open` has begun. It stays until the next `open` or `cancel`, even when
  /// everything was sent, because the request may change.
  struct Stream {
    MeshPointer mesh;  ///< a stream finishes on the log that it began with
    ClientBlocks blocks;
    bool hasHead = false;
    std::uint32_t lastChunk = 0;  ///< chunks behind it are not sent
    std::int64_t credit = 0;      ///< bytes; below zero by one frame at most
    bool paused = false;
    enum class PlanState : std::uint8_t {
      kCurrent,
      kDone,   ///< all of it was sent, and `done` was said
      kStale,  ///< the request has changed since it was made
    };
    PlanState planState = PlanState::kCurrent;
    StreamPlan plan{};
    std::optional<BlockRun> nextRun{};  ///< the next one, or the rest of it; nullopt: all were sent
    /// Bytes of blocks that were sent in part, by chunk and part. The client keeps them.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> begun{};

    [[nodiscard]] std::uint32_t sentOf(std::uint32_t chunk, std::uint32_t part) const {
      const auto found = begun.find({chunk, part});
      return found == begun.end() ? 0 : found->second;
    }
    /// Bytes to come of a run's first block.
    [[nodiscard]] std::uint32_t rest(const BlockRun& run) const {
      const std::uint32_t size = mesh->log.index().block(run.chunk, run.firstPart).size;
      assert(sentOf(run.chunk, run.firstPart) <= size);
      return size - sentOf(run.chunk, run.firstPart);
    }
  };
  /// Returns the payload bytes to come.
  static std::uint64_t plan(Stream& stream);
  /// Makes a new plan if the request has changed, and announces it.
  void catchUp();
  /// There is more to send, credit or not.
  [[nodiscard]] bool hasRun() const { return stream_ && stream_->nextRun && !stream_->paused; }
  OutgoingFrame nextFrame(Stream& stream, std::size_t room, std::size_t piece) const;
  /// Take the bytes of the next frame off the plan, and say in `run` which blocks they are.
  static FileSlice takePiece(Stream& stream, BlockRun& run, std::size_t piece);
  static FileSlice takeBlocks(Stream& stream, BlockRun& run, std::size_t room);
  /// Ends the stream, or leaves it as it is.
  void refuse(const char* code, std::string detail);
  void answerError(const char* code, std::string detail);
  bool countMessage(Clock::time_point now);
  bool countChange();
  bool count(unsigned& counter, unsigned most, const char* what);

  const MeshStore& store_;
  MayRead mayRead_;
  std::deque<std::string> answers_;
  bool closing_ = false;

  std::uint32_t opens_ = 0;  ///< so far: the number of the stream
  std::optional<Stream> stream_;

  Clock::time_point second_{};  ///< the window that the counters belong to
  unsigned messagesOfSecond_ = 0;
  unsigned opensOfSecond_ = 0;
  unsigned changesOfSecond_ = 0;
};

}  // namespace qtet

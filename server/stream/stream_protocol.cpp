#include "server/stream/stream_protocol.h"

#include <algorithm>
#include <cassert>

#include "codec/log/target_choice.h"
#include "proto/sentence.h"
#include "server/stream/stream_limits.h"

namespace qtet {

namespace {

/// The `error` message that answers.
struct StreamRefusal {
  const char* code;
  std::string detail;
};

StreamRefusal unknownField(const ServedMesh& mesh, const std::string& name) {
  return {kUnknownField, "'" + mesh.id + "' has no field '" + name + "'"};
}

std::expected<ClientBlocks, StreamRefusal> blocksOf(const Have& have, FieldTurns turns,
                                                    const ServedMesh& mesh) {
  const std::size_t chunks = mesh.log.index().chunks.size();
  if (have.chunks > chunks)
    return std::unexpected(
        StreamRefusal{kLogChanged, "have names chunk " + std::to_string(have.chunks - 1) +
                                       " and this log has " + std::to_string(chunks)});
  ClientBlocks out(mesh.log.index(), std::move(turns));
  out.addLeading(have.chunks, kStructurePart);
  out.addLeading(have.chunks, kPositionsPart);
  for (const auto& [name, held] : have.fields) {
    const auto field = mesh.keys().fieldOfKey(name);
    if (!field) return std::unexpected(unknownField(mesh, name));
    const auto at = std::ranges::lower_bound(out.fields(), *field);
    if (at != out.fields().end() && *at == *field)
      out.addLeading(held, static_cast<std::size_t>(kFirstFieldPart + (at - out.fields().begin())));
  }
  return out;
}

std::expected<std::uint32_t, StreamRefusal> lastChunkOf(const Target& target,
                                                        const ServedMesh& mesh) {
  const Result<std::uint32_t> last = lastChunkFor(target, mesh.manifest, mesh.log.index());
  if (!last) return std::unexpected(unknownField(mesh, std::get<FieldErrorTarget>(target).field));
  return *last;
}

}  // namespace

void StreamProtocol::receive(std::string_view json, Clock::time_point now) {
  if (closing_) return;
  if (!countMessage(now)) return;
  const Result<ClientMessage> message = parseClientMessage(json);
  if (!message) {
    refuse(kBadMessage, message.error().message);
    closing_ = true;
    return;
  }
  std::visit([this](const auto& m) { handle(m); }, *message);
}

void StreamProtocol::receiveBinary() {
  if (closing_) return;
  refuse(kBadMessage, "clients send JSON text messages, no binary ones");
  closing_ = true;
}

bool StreamProtocol::countMessage(Clock::time_point now) {
  if (now - second_ >= std::chrono::seconds(1))
    second_ = now, messagesOfSecond_ = opensOfSecond_ = changesOfSecond_ = 0;
  const bool answersRead = answers_.size() < limits::kMaxQueuedAnswers;
  return count(messagesOfSecond_, answersRead ? limits::kMaxMessagesPerSecond : 0,
               "too many messages, or answers that are not read");
}

bool StreamProtocol::count(unsigned& counter, unsigned most, const char* what) {
  if (++counter <= most) return true;
  refuse(kTooManyMessages, std::string(what) + "; STREAM.md has the bounds");
  closing_ = true;
  return false;
}

void StreamProtocol::handle(const OpenMessage& message) {
  stream_.reset();
  ++opens_;
  if (!count(opensOfSecond_, limits::kMaxOpensPerSecond, "too many open messages a second")) return;
  const bool open = !mayRead_ || mayRead_(message.mesh);
  const MeshPointer mesh = open ? store_.find(message.mesh) : nullptr;
  if (!mesh)
    return refuse(kNotFound, "there is no mesh '" + message.mesh +
                                 (mayRead_ ? "', or it is for other tokens" : "'") +
                                 "; the list is at /v1/meshes");
  if (!message.digest.empty() && message.digest != mesh->log.digest())
    return refuse(kLogChanged, "the mesh '" + message.mesh + "' has the digest " +
                                   mesh->log.digest() + " by now");
  auto turns = fieldTurns(message.fields, message.time, mesh->keys(), mesh->manifest.series,
                          mesh->log.fields());
  if (!turns) {
    StreamRefusal unknown = unknownField(*mesh, turns.error());
    return refuse(unknown.code, std::move(unknown.detail));
  }
  auto blocks = blocksOf(message.have, std::move(*turns), *mesh);
  if (!blocks) return refuse(blocks.error().code, std::move(blocks.error().detail));
  auto last = lastChunkOf(message.target, *mesh);
  if (!last) return refuse(last.error().code, std::move(last.error().detail));
  stream_.emplace(Stream{mesh, std::move(*blocks), message.have.chunks > 0, *last,
                         static_cast<std::int64_t>(message.credit)});
  const std::uint64_t planned = plan(*stream_);
  answers_.push_back(toJson(
      OpenedMessage{opens_, mesh->id, mesh->log.digest(), mesh->log.bytes().size(), planned}));
}

std::uint64_t StreamProtocol::plan(Stream& stream) {
  const LogIndex& index = stream.mesh->log.index();
  const BlockRun head{0, FrameHeader::kHead, 0};
  stream.plan = StreamPlan(index, stream.lastChunk, limits::kFramePayload);
  stream.nextRun = stream.hasHead ? stream.plan.next(stream.blocks) : head;
  stream.planState = Stream::PlanState::kCurrent;
  std::uint64_t planned = lackingBytes(index, stream.blocks, stream.lastChunk);
  if (!stream.hasHead) planned += sliceOf(index, head).size;
  for (const auto& [place, sent] : stream.begun)
    if (place.first <= stream.lastChunk) {
      assert(sent <= planned);
      planned -= sent;
    }
  return planned;
}

void StreamProtocol::catchUp() {
  if (!stream_ || stream_->planState != Stream::PlanState::kStale) return;
  const std::uint64_t planned = plan(*stream_);
  answers_.push_back(toJson(PlannedMessage{opens_, planned}));
}

void StreamProtocol::handle(const CreditMessage& message) {
  assert(message.bytes <= kMaxCredit && (!stream_ || stream_->credit <= std::int64_t{kMaxCredit}));
  // Both lie below 2^53, so the sum cannot overflow; the bound keeps it so.
  if (stream_)
    stream_->credit = std::min(stream_->credit + static_cast<std::int64_t>(message.bytes),
                               static_cast<std::int64_t>(kMaxCredit));
}

void StreamProtocol::handle(const TargetMessage& message) {
  if (!stream_ || !countChange()) return;
  const auto last = lastChunkOf(message.target, *stream_->mesh);
  if (!last) return answerError(last.error().code, last.error().detail);
  stream_->lastChunk = *last;
  stream_->planState = Stream::PlanState::kStale;
}

void StreamProtocol::handle(const PauseMessage&) {
  if (stream_) stream_->paused = true;
}

void StreamProtocol::handle(const ResumeMessage& message) {
  if (!stream_) return;
  if (message.have) {
    if (!countChange()) return;
    auto blocks = blocksOf(*message.have, stream_->blocks.turns(), *stream_->mesh);
    if (!blocks) return answerError(blocks.error().code, blocks.error().detail);
    catchUp();  // what is due is said of the blocks before
    stream_->blocks = std::move(*blocks);
    stream_->begun.clear();
    plan(*stream_);
  }
  stream_->paused = false;
}

void StreamProtocol::handle(const CancelMessage&) {
  stream_.reset();
  answers_.push_back(toJson(StoppedMessage{opens_}));
}

bool StreamProtocol::countChange() {
  return count(changesOfSecond_, limits::kMaxChangesPerSecond,
               "too many targets and resumes with have a second");
}

void StreamProtocol::answerError(const char* code, std::string detail) {
  catchUp();  // answers keep the order of their messages
  answers_.push_back(toJson(ErrorMessage{code, sentence(detail)}));
}

void StreamProtocol::refuse(const char* code, std::string detail) {
  stream_.reset();
  answerError(code, std::move(detail));
}

std::optional<Outgoing> StreamProtocol::next(std::size_t room, std::size_t piece) {
  assert(piece > 0);
  catchUp();
  if (!answers_.empty()) {
    std::string text = std::move(answers_.front());
    answers_.pop_front();
    return text;
  }
  if (closing_) return CloseCode::kPolicy;
  if (!stream_) return std::nullopt;
  if (stream_->nextRun) {
    if (stream_->paused || stream_->credit <= 0 || room == 0) return std::nullopt;
    return nextFrame(*stream_, room, piece);
  }
  if (stream_->planState == Stream::PlanState::kDone) return std::nullopt;
  stream_->planState = Stream::PlanState::kDone;
  return toJson(DoneMessage{opens_});
}

OutgoingFrame StreamProtocol::nextFrame(Stream& stream, std::size_t room, std::size_t piece) const {
  assert(stream.nextRun && !stream.paused && stream.credit > 0);
  BlockRun run = *stream.nextRun;
  const bool head = run.firstPart == FrameHeader::kHead;
  const bool whole = head || stream.rest(run) <= piece;
  const FileSlice slice = whole ? takeBlocks(stream, run, room) : takePiece(stream, run, piece);
  assert(std::uint64_t{slice.offset} + slice.size <= stream.mesh->log.bytes().size());
  stream.credit -= slice.size;
  return {{opens_, run.chunk, run.firstPart, run.parts, slice.size},
          stream.mesh->log.bytes().subspan(slice.offset, slice.size),
          stream.mesh};
}

FileSlice StreamProtocol::takePiece(Stream& stream, BlockRun& run, std::size_t piece) {
  assert(piece < stream.rest(run));  // the last bytes go with the block's own frame
  const std::uint64_t offset = stream.mesh->log.index().block(run.chunk, run.firstPart).offset;
  run.parts = FrameHeader::kPiece;
  std::uint32_t& sent = stream.begun[{run.chunk, run.firstPart}];
  const FileSlice slice{offset + sent, static_cast<std::uint32_t>(piece)};
  sent += slice.size;
  return slice;
}

FileSlice StreamProtocol::takeBlocks(Stream& stream, BlockRun& run, std::size_t room) {
  const LogIndex& index = stream.mesh->log.index();
  const std::uint32_t sent = stream.sentOf(run.chunk, run.firstPart);
  for (std::uint16_t i = 1; i < run.parts; ++i)
    if (stream.sentOf(run.chunk, std::uint32_t{run.firstPart} + i) > 0) run.parts = i;
  while (run.parts > 1 && sliceOf(index, run).size - sent > room) --run.parts;
  assert(run.parts <= stream.nextRun->parts);
  stream.nextRun->firstPart += run.parts;
  stream.nextRun->parts -= run.parts;
  if (run.firstPart == FrameHeader::kHead) {
    stream.hasHead = true;
  } else {
    stream.blocks.addRun(run.chunk, run.firstPart, run.parts);
    stream.begun.erase({run.chunk, run.firstPart});
  }
  if (stream.nextRun->parts == 0) stream.nextRun = stream.plan.next(stream.blocks);
  const FileSlice slice = sliceOf(index, run);
  return {slice.offset + sent, slice.size - sent};
}

}  // namespace qtet

#include "server/stream_protocol.h"

#include <algorithm>

#include "server/limits.h"

namespace qtet {
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
  if (now - second_ >= std::chrono::seconds(1)) second_ = now, messages_ = 0, opens_ = 0;
  if (++messages_ <= limits::kMaxMessagesPerSecond && answers_.size() < limits::kMaxQueuedAnswers) return true;
  refuse(kTooManyMessages, "at most " + std::to_string(limits::kMaxMessagesPerSecond) + " messages a second, and read the answers");
  closing_ = true;
  return false;
}

bool StreamProtocol::countOpen() {
  if (++opens_ <= limits::kMaxOpensPerSecond) return true;
  refuse(kTooManyMessages, "at most " + std::to_string(limits::kMaxOpensPerSecond) + " open messages a second");
  closing_ = true;
  return false;
}

void StreamProtocol::handle(const OpenMessage& message) {
  active_ = false;
  ++stream_;
  if (!countOpen()) return;
  const MeshPointer mesh = store_.find(message.mesh);
  if (!mesh) return refuse(kNotFound, "there is no mesh '" + message.mesh + "'; the list is at /v1/meshes");
  if (!message.digest.empty() && message.digest != mesh->log.digest())
    return refuse(kLogChanged, "the mesh '" + message.mesh + "' has the digest " + mesh->log.digest() + " by now");
  const auto request = resolve(message, *mesh);
  if (const auto* error = std::get_if<ErrorMessage>(&request)) return answers_.push_back(toJson(*error));
  start(message, mesh, std::get<StreamRequest>(request));
}

std::variant<StreamRequest, ErrorMessage> StreamProtocol::resolve(const OpenMessage& message, const ServedMesh& mesh) const {
  const std::size_t chunks = mesh.log.index().chunks.size();
  if (message.haveChunks > chunks)
    return ErrorMessage{kLogChanged,
                        "have.chunks is " + std::to_string(message.haveChunks) + " and this log has " + std::to_string(chunks)};
  std::vector<std::uint32_t> have(mesh.manifest.fields.size(), 0);
  const auto unknown = [&](const std::string& name) {
    return ErrorMessage{kUnknownField, "'" + message.mesh + "' has no field '" + name + "'"};
  };
  for (const auto& [name, count] : message.haveFields) {
    const auto field = fieldOfKey(mesh.manifest, name);
    if (!field) return unknown(name);
    have[*field] = count;
  }
  StreamRequest out;
  out.haveChunks = message.haveChunks;
  for (const std::string& name : message.fields) {
    const auto field = fieldOfKey(mesh.manifest, name);
    if (!field) return unknown(name);
    out.fields.push_back(*field);
  }
  std::ranges::sort(out.fields);
  const auto twice = std::ranges::unique(out.fields);
  out.fields.erase(twice.begin(), twice.end());
  for (const std::uint32_t field : out.fields) out.haveFields.push_back(have[field]);
  return out;
}

void StreamProtocol::start(const OpenMessage& message, const MeshPointer& mesh, const StreamRequest& request) {
  const LogIndex& index = mesh->log.index();
  mesh_ = mesh;
  plan_ = planStream(index, request, limits::kFramePayload);
  nextRun_ = 0;
  credit_ = static_cast<std::int64_t>(message.credit);
  active_ = true;
  std::uint64_t planned = 0;
  for (const BlockRun& run : plan_) planned += sliceOf(index, run).size;
  answers_.push_back(toJson(OpenedMessage{stream_, mesh->id, mesh->log.digest(), mesh->log.bytes().size(), planned}));
}

void StreamProtocol::handle(const CreditMessage& message) {
  // Both lie below 2^53, so the sum cannot overflow; the bound keeps it so.
  if (active_) credit_ = std::min(credit_ + static_cast<std::int64_t>(message.bytes), static_cast<std::int64_t>(kMaxCredit));
}

void StreamProtocol::handle(const StopMessage&) {
  active_ = false;
  answers_.push_back(toJson(StoppedMessage{stream_}));
}

void StreamProtocol::refuse(const char* code, std::string detail) {
  active_ = false;
  answers_.push_back(toJson(ErrorMessage{code, std::move(detail)}));
}

std::optional<Outgoing> StreamProtocol::next() {
  if (!answers_.empty()) {
    std::string text = std::move(answers_.front());
    answers_.pop_front();
    return text;
  }
  if (closing_) return CloseCode::kPolicy;
  if (!active_) return std::nullopt;
  if (nextRun_ == plan_.size()) {
    active_ = false;
    return toJson(DoneMessage{stream_});
  }
  if (credit_ <= 0) return std::nullopt;
  const BlockRun& run = plan_[nextRun_++];
  const FileSlice slice = sliceOf(mesh_->log.index(), run);
  credit_ -= slice.size;
  return OutgoingFrame{{stream_, run.chunk, run.firstPart, run.parts, slice.size}, mesh_->log.bytes().subspan(slice.offset, slice.size),
                       mesh_};
}

}  // namespace qtet

#include "proto/messages.h"

#include <cassert>

#include "proto/json_reader.h"
#include "proto/limits.h"
#include "proto/log_digest.h"
#include "proto/stream_request_json.h"

namespace qtet {
namespace {

constexpr std::size_t kMaxTextBytes = 4096;  // of an error's detail

std::string readDigest(const JsonCursor& json) {
  std::string out = json.text(kDigestCharacters);
  if (json.present() && !isLogDigest(out)) json.fail("must be 64 lower-case hexadecimal digits");
  return out;
}

OpenMessage readOpen(const JsonCursor& json) {
  OpenMessage out;
  out.mesh = json["mesh"].name();
  out.digest = readDigest(json.optional("digest"));
  for (const JsonCursor& name : json.optional("fields").items(0, kMaxRequestFields))
    out.fields.push_back(name.name());
  out.time = readStreamTime(json.optional("time"));
  out.have = readHave(json.optional("have"));
  out.target = readTarget(json.optional("target"));
  out.credit = json["credit"].count(0, kMaxCredit);
  return out;
}

Json parseDocument(std::string_view json, std::optional<Error>& error) {
  if (json.size() > kMaxMessageBytes) {
    error = Error{ErrorCode::kLimitExceeded,
                  "the message is longer than " + std::to_string(kMaxMessageBytes) + " bytes",
                  Error::kNoOffset};
    return Json::object();
  }
  if (!isShallowJson(json)) {
    error = Error{ErrorCode::kBadValue,
                  "the message nests deeper than " + std::to_string(kMaxJsonDepth) + " levels",
                  Error::kNoOffset};
    return Json::object();
  }
  Json document = Json::parse(json, nullptr, false);
  if (!document.is_object())
    error = Error{ErrorCode::kBadValue, "the message is not a JSON object", Error::kNoOffset};
  return document;
}

std::uint32_t readStream(const JsonCursor& json) { return json["stream"].count32(0, 0xFFFFFFFFu); }

template <class Message>
Result<Message> checked(Message message, const std::optional<Error>& error) {
  if (error) return std::unexpected(*error);
  return message;
}

Json openToJson(const OpenMessage& m) {
  assert(m.credit <= kMaxCredit);
  Json out = {{"type", "open"}, {"mesh", m.mesh}, {"fields", m.fields}, {"credit", m.credit}};
  if (!m.digest.empty()) out["digest"] = m.digest;
  if (m.time) out["time"] = toJson(*m.time);
  out["have"] = toJson(m.have);
  if (!std::holds_alternative<EverythingTarget>(m.target)) out["target"] = toJson(m.target);
  return out;
}

struct ToJson {
  Json operator()(const OpenMessage& m) const { return openToJson(m); }
  Json operator()(const CreditMessage& m) const {
    assert(m.bytes <= kMaxCredit);
    return {{"type", "credit"}, {"bytes", m.bytes}};
  }
  Json operator()(const TargetMessage& m) const {
    return {{"type", "target"}, {"target", toJson(m.target)}};
  }
  Json operator()(const PauseMessage&) const { return {{"type", "pause"}}; }
  Json operator()(const ResumeMessage& m) const {
    Json out = {{"type", "resume"}};
    if (m.have) out["have"] = toJson(*m.have);
    return out;
  }
  Json operator()(const CancelMessage&) const { return {{"type", "cancel"}}; }
  Json operator()(const OpenedMessage& m) const {
    assert(m.bytes <= kMaxCredit && m.planned <= m.bytes);
    return {{"type", "opened"},   {"stream", m.stream}, {"mesh", m.mesh},
            {"digest", m.digest}, {"bytes", m.bytes},   {"planned", m.planned}};
  }
  Json operator()(const PlannedMessage& m) const {
    assert(m.planned <= kMaxCredit);
    return {{"type", "planned"}, {"stream", m.stream}, {"planned", m.planned}};
  }
  Json operator()(const DoneMessage& m) const { return {{"type", "done"}, {"stream", m.stream}}; }
  Json operator()(const StoppedMessage& m) const {
    return {{"type", "stopped"}, {"stream", m.stream}};
  }
  Json operator()(const ErrorMessage& m) const {
    assert(!m.code.empty());
    return {{"type", "error"}, {"code", m.code}, {"detail", m.detail}};
  }
};

}  // namespace

Result<ClientMessage> parseClientMessage(std::string_view json) {
  std::optional<Error> error;
  const Json document = parseDocument(json, error);
  if (error) return std::unexpected(*error);
  const JsonCursor root(&document, "", &error);
  const std::string type = root["type"].text(kMaxNameBytes);
  ClientMessage out;
  if (type == "open") {
    out = readOpen(root);
  } else if (type == "credit") {
    out = CreditMessage{root["bytes"].count(0, kMaxCredit)};
  } else if (type == "target") {
    out = TargetMessage{readTarget(root["target"])};
  } else if (type == "pause") {
    out = PauseMessage{};
  } else if (type == "resume") {
    const JsonCursor have = root.optional("have");
    out = ResumeMessage{have.present() ? std::optional(readHave(have)) : std::nullopt};
  } else if (type == "cancel" || type == "stop") {
    out = CancelMessage{};
  } else {
    root["type"].fail("must be 'open', 'credit', 'target', 'pause', 'resume' or 'cancel'");
  }
  return checked(std::move(out), error);
}

Result<ServerMessage> parseServerMessage(std::string_view json) {
  std::optional<Error> error;
  const Json document = parseDocument(json, error);
  if (error) return std::unexpected(*error);
  const JsonCursor root(&document, "", &error);
  const std::string type = root["type"].text(kMaxNameBytes);
  ServerMessage out;
  if (type == "opened") {
    out = OpenedMessage{readStream(root), root["mesh"].name(), readDigest(root["digest"]),
                        root["bytes"].count(0, kMaxCredit), root["planned"].count(0, kMaxCredit)};
  } else if (type == "planned") {
    out = PlannedMessage{readStream(root), root["planned"].count(0, kMaxCredit)};
  } else if (type == "done") {
    out = DoneMessage{readStream(root)};
  } else if (type == "stopped") {
    out = StoppedMessage{readStream(root)};
  } else if (type == "error") {
    out = ErrorMessage{root["code"].name(), root["detail"].text(kMaxTextBytes)};
  } else {
    root["type"].fail("must be 'opened', 'planned', 'done', 'stopped' or 'error'");
  }
  return checked(std::move(out), error);
}

std::string toJson(const ClientMessage& message) { return dumpJson(std::visit(ToJson{}, message)); }
std::string toJson(const ServerMessage& message) { return dumpJson(std::visit(ToJson{}, message)); }

std::array<std::uint8_t, FrameHeader::kBytes> FrameHeader::encode() const {
  // as parse() wants it
  assert(firstPart != kHead || (chunk == 0 && parts == 0));
  assert(firstPart == kHead || parts != kPiece || size > 0);
  ByteWriter writer;
  writer.write(stream);
  writer.write(chunk);
  writer.write(firstPart);
  writer.write(parts);
  writer.write(size);
  std::array<std::uint8_t, kBytes> out{};
  std::copy(writer.bytes().begin(), writer.bytes().end(), out.begin());
  return out;
}

Result<FrameHeader> FrameHeader::parse(ByteView frame) {
  ByteReader reader(frame);
  FrameHeader out;
  out.stream = reader.read<std::uint32_t>();
  out.chunk = reader.read<std::uint32_t>();
  out.firstPart = reader.read<std::uint16_t>();
  out.parts = reader.read<std::uint16_t>();
  out.size = reader.read<std::uint32_t>();
  if (reader.failed()) return std::unexpected(reader.error());
  if (out.size != reader.remaining())
    reader.fail(ErrorCode::kBadValue, "the frame's payload is not as long as its header says");
  if (out.firstPart == kHead && (out.chunk != 0 || out.parts != 0))
    reader.fail(ErrorCode::kBadValue, "a head names no chunk and no parts");
  if (out.firstPart != kHead && out.parts == kPiece && out.size == 0)
    reader.fail(ErrorCode::kBadValue, "a piece of a block has at least one byte");
  if (reader.failed()) return std::unexpected(reader.error());
  return out;
}

}  // namespace qtet

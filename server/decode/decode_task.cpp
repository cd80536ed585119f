#include "server/decode/decode_task.h"

#include <bit>
#include <cassert>
#include <utility>

namespace qtet {
namespace {

/// The same kinds in the order of the variants.
enum class Kind : std::uint8_t { kLevel, kCheck, kStop, kReady, kLevelEnd, kVerdict };

constexpr std::uint8_t kNoError = 255;

void writeText(ByteWriter& out, const std::string& text) {
  out.write(static_cast<std::uint32_t>(text.size()));
  out.append({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string readText(ByteReader& in) {
  const ByteView bytes = in.take(in.read<std::uint32_t>());
  return {bytes.begin(), bytes.end()};
}

/// A member of an enum whose last one is `last`.
template <class Enum>
Enum readEnum(ByteReader& in, Enum last) {
  const auto value = in.read<std::uint8_t>();
  if (value > std::to_underlying(last))
    in.fail(ErrorCode::kBadValue, "a message of the other process has an unknown value");
  return in.failed() ? last : static_cast<Enum>(value);
}

void writeLevel(ByteWriter& out, const LevelTask& task) {
  const LevelRequest& request = task.request;
  assert(request.names.empty() || request.names.size() == request.fields.size());
  writeText(out, task.digest);
  out.write(request.level);
  out.write(std::to_underlying(request.form));
  out.write(std::to_underlying(request.coding));
  out.write(static_cast<std::uint32_t>(request.fields.size()));
  for (const std::uint32_t field : request.fields) out.write(field);
  out.write(static_cast<std::uint32_t>(request.names.size()));
  for (const std::string& name : request.names) writeText(out, name);
  out.write(static_cast<std::uint8_t>(request.point.has_value()));
  if (request.point)
    for (const double x : *request.point) out.write(std::bit_cast<std::uint64_t>(x));
}

LevelTask readLevel(ByteReader& in) {
  LevelTask out{readText(in)};
  out.request.level = in.read<std::uint32_t>();
  out.request.form = readEnum(in, LevelForm::kCsv);
  out.request.coding = readEnum(in, ContentCoding::kZstd);
  for (auto left = in.read<std::uint32_t>(); left > 0 && !in.failed(); --left)
    out.request.fields.push_back(in.read<std::uint32_t>());
  for (auto left = in.read<std::uint32_t>(); left > 0 && !in.failed(); --left)
    out.request.names.push_back(readText(in));
  if (in.read<std::uint8_t>() != 0)
    for (double& x : out.request.point.emplace())
      x = std::bit_cast<double>(in.read<std::uint64_t>());
  return out;
}

void writeError(ByteWriter& out, const Status& status) {
  out.write(status ? kNoError : std::to_underlying(status.error().code));
  if (status) return;
  out.write(status.error().offset);
  writeText(out, status.error().message);
}

Status readError(ByteReader& in) {
  const auto code = in.read<std::uint8_t>();
  if (code == kNoError) return {};
  if (code > std::to_underlying(ErrorCode::kCancelled))
    in.fail(ErrorCode::kBadValue, "a message of the other process has an unknown error");
  const auto offset = in.read<std::uint64_t>();
  std::string message = readText(in);
  return fail(in.failed() ? ErrorCode::kIo : static_cast<ErrorCode>(code), std::move(message),
              offset);
}

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

/// The value, if the whole message was read.
template <class T>
Result<T> whole(const ByteReader& in, T value) {
  if (in.failed()) return std::unexpected(in.error());
  if (in.remaining() > 0)
    return fail(ErrorCode::kBadValue, "a message of the other process is too long");
  return value;
}

}  // namespace

Bytes messageOf(const DecodeTask& task) {
  ByteWriter out;
  out.write(static_cast<std::uint8_t>(task.index()));
  std::visit(Overloaded{[&](const LevelTask& level) { writeLevel(out, level); },
                        [&](const CheckTask& check) {
                          out.write(std::uint64_t{check.limits.bytes});
                          out.write(static_cast<std::int64_t>(check.limits.time.count()));
                        },
                        [](const StopTask&) {}},
             task);
  return out.take();
}

Bytes messageOf(const DecodeAnswer& answer) {
  ByteWriter out;
  out.write(static_cast<std::uint8_t>(std::to_underlying(Kind::kReady) + answer.index()));
  std::visit(Overloaded{[&](const DecoderReady& ready) {
                          out.write(static_cast<std::uint8_t>(ready.confined));
                        },
                        [&](const LevelEnd& level) { writeError(out, level.status); },
                        [&](const CheckVerdict& verdict) {
                          out.write(std::to_underlying(verdict.end));
                          writeText(out, verdict.reason);
                        }},
             answer);
  return out.take();
}

Result<DecodeTask> taskOf(ByteView message) {
  ByteReader in(message);
  switch (readEnum(in, Kind::kVerdict)) {
    case Kind::kLevel: {
      LevelTask out = readLevel(in);
      return whole<DecodeTask>(in, std::move(out));
    }
    case Kind::kCheck: {
      CheckTask out;
      out.limits.bytes = in.read<std::uint64_t>();
      out.limits.time = std::chrono::milliseconds(in.read<std::int64_t>());
      return whole<DecodeTask>(in, out);
    }
    case Kind::kStop: return whole<DecodeTask>(in, StopTask());
    default: return fail(ErrorCode::kBadValue, "a message of the other process is no task");
  }
}

Result<DecodeAnswer> answerOf(ByteView message) {
  ByteReader in(message);
  switch (readEnum(in, Kind::kVerdict)) {
    case Kind::kReady: {
      const DecoderReady out{in.read<std::uint8_t>() != 0};
      return whole<DecodeAnswer>(in, out);
    }
    case Kind::kLevelEnd: {
      LevelEnd out{readError(in)};
      return whole<DecodeAnswer>(in, std::move(out));
    }
    case Kind::kVerdict: {
      CheckVerdict out{readEnum(in, CheckVerdict::End::kFailed)};
      out.reason = readText(in);
      return whole<DecodeAnswer>(in, std::move(out));
    }
    default: return fail(ErrorCode::kBadValue, "a message of the other process is no answer");
  }
}

}  // namespace qtet

// Errors as values: every decoder of outside bytes returns Result<T>, and only a caller's mistake
// asserts.
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <utility>

namespace qtet {

/// Stable names of failures; tests assert them and the server maps them to problem types.
enum class ErrorCode : std::uint8_t {
  kTruncated,      ///< the bytes end before what they promise
  kBadMagic,       ///< not a qtet log at all
  kBadVersion,     ///< a log of a version this build cannot read
  kBadChecksum,    ///< a CRC-32C does not match its bytes
  kBadValue,       ///< a value outside its range, or two values that contradict each other
  kLimitExceeded,  ///< a count or size above a limit of proto/limits.h
  kBadCodec,       ///< an unknown codec id, or a codec's own decoder refused the bytes
  kBadOrder,       ///< a chunk was applied before one that it depends on
  kNotFound,       ///< a file, mesh, field or level of that name does not exist
  kBadInput,       ///< a mesh that cannot be simplified, with the reason in the message
  kIo,             ///< the operating system refused to read or write
  kCancelled,      ///< the caller asked to stop
};

/// The code's name as it stands in PROTOCOL.md and FORMAT.md, for example "bad-checksum".
[[nodiscard]] const char* errorCodeName(ErrorCode code);

/// A failure: what, where (byte offset in the input, when there is one) and, in the message, what
/// to do.
struct Error {
  static constexpr std::uint64_t kNoOffset = ~std::uint64_t{0};

  ErrorCode code = ErrorCode::kBadValue;
  std::string message;
  std::uint64_t offset = kNoOffset;

  /// "bad-checksum at byte 1234: the manifest's CRC-32C is ..."
  [[nodiscard]] std::string text() const;
};

template <class T>
using Result = std::expected<T, Error>;
using Status = std::expected<void, Error>;

[[nodiscard]] inline std::unexpected<Error> fail(ErrorCode code, std::string message,
                                                 std::uint64_t offset = Error::kNoOffset) {
  return std::unexpected<Error>(Error{code, std::move(message), offset});
}

/// The error of work that was asked to stop.
[[nodiscard]] inline std::unexpected<Error> cancelled() {
  return fail(ErrorCode::kCancelled, "stopped, as the caller asked");
}

}  // namespace qtet

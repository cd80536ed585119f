// A PUT's or DELETE's request, read from its head.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace qtet {

struct UploadRequest {
  enum class Kind : std::uint8_t { kPut, kDelete };
  Kind kind = Kind::kPut;
  std::string id{};     ///< a name that pathOfMesh takes
  std::string token{};  ///< the digest of the token that it comes with, "" where nobody asks
  /// 64 lower-case hexadecimal digits, where the request names it.
  std::optional<std::string> digest{};
  /// The digest of the log that the body is a delta to; nullopt: the body is the log's own bytes.
  std::optional<std::string> from{};
  std::optional<std::string> ifMatch{}, ifNoneMatch{};
  std::uint64_t bodyBytes = 0;   ///< of this request
  std::uint64_t first = 0;       ///< where they go, or the bytes that they give
  std::uint64_t totalBytes = 0;  ///< of the whole log
};

}  // namespace qtet

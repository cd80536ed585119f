#include "proto/error.h"

namespace qtet {

const char* errorCodeName(ErrorCode code) {
  switch (code) {
    case ErrorCode::kTruncated: return "truncated";
    case ErrorCode::kBadMagic: return "bad-magic";
    case ErrorCode::kBadVersion: return "bad-version";
    case ErrorCode::kBadChecksum: return "bad-checksum";
    case ErrorCode::kBadValue: return "bad-value";
    case ErrorCode::kLimitExceeded: return "limit-exceeded";
    case ErrorCode::kBadCodec: return "bad-codec";
    case ErrorCode::kBadOrder: return "bad-order";
    case ErrorCode::kNotFound: return "not-found";
    case ErrorCode::kBadInput: return "bad-input";
    case ErrorCode::kIo: return "io";
    case ErrorCode::kCancelled: return "cancelled";
  }
  return "unknown";
}

std::string Error::text() const {
  std::string out = errorCodeName(code);
  if (offset != kNoOffset) out += " at byte " + std::to_string(offset);
  return out + ": " + message;
}

}  // namespace qtet

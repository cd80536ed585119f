// A text that is made once and sent often: with its ETag, and compressed in both codings that
// browsers know.
#pragma once

#include <string>

#include "proto/bytes.h"

namespace qtet {

struct Document {
  std::string text;
  std::string etag;  ///< strong, of the uncompressed text, with its quotes
  Bytes gzip, zstd;  ///< empty: compressing does not pay

  Document() = default;
  explicit Document(std::string content);
};

}  // namespace qtet

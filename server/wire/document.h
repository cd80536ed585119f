// A text that is made once and sent often: in the codings that browsers know, each with its tag and
// the head of its answer.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "proto/bytes.h"
#include "server/wire/resource.h"

namespace qtet {

/// The text in one coding. Nothing but Date, Content-Length and what is about the connection lacks
/// in `headers`.
struct DocumentForm {
  Bytes bytes{};
  Validators validators{};
  HeaderLines headers{};
};

/// A text in all codings. Immutable after construction.
struct Document {
  DocumentForm identity{};
  std::optional<DocumentForm> gzip{}, zstd{};  ///< nullopt: compressing does not pay

  Document() = default;
  /// `about` has no tag: it becomes that of the text.
  Document(std::string_view text, Resource about);

  /// REQUIRES: there is such a form.
  [[nodiscard]] const DocumentForm& form(ContentCoding coding) const;
  /// Strong, of the uncompressed text, with its quotes.
  [[nodiscard]] const std::string& etag() const { return identity.validators.etag; }
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(identity.bytes.data()), identity.bytes.size()};
  }
};

/// `resource` in that coding, with `bytes` that are in it already.
[[nodiscard]] DocumentForm formOf(Resource resource, Bytes bytes, ContentCoding coding);

}  // namespace qtet

// A file on its way into a sink, piece by piece.
#pragma once

#include <string_view>

#include "proto/byte_sink.h"

namespace qtet {

/// Keeps its first error, after which it does nothing.
class Pieces {
 public:
  explicit Pieces(const ByteSink& sink) : sink_(sink) {}

  /// The bytes that `append` puts into a vector with room for `expected`.
  template <class Append>
  void piece(std::size_t expected, const Append& append) {
    if (!status_) return;
    Bytes bytes;
    bytes.reserve(expected);
    append(bytes);
    status_ = sink_(bytes);
  }
  void bytes(const Bytes& bytes) {
    if (status_) status_ = sink_(bytes);
  }
  void text(std::string_view text) {
    if (status_) status_ = sink_({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const ByteSink& sink_;
  Status status_{};
};

}  // namespace qtet

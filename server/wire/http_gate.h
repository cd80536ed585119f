// A look at the bytes of a request's head before Beast's parser sees them. That parser joins folded
// lines, which a proxy in front may have read in another way. This is how requests are smuggled
// (RFC 9112, 2.2, 5.2 and 11.2).
#pragma once

#include <cassert>
#include <cstddef>
#include <string_view>

namespace qtet {

/// Fed with a head that grows; looks at every byte once.
class HttpGate {
 public:
  enum class Verdict {
    kMore,      ///< sound so far; read on
    kComplete,  ///< `headBytes` of it are the whole head, with its empty line
    /// A bare CR or LF, a control byte, a folded line, or no method at the start: 400, and the
    /// connection ends.
    kBroken,
    kTooLong,  ///< more lines than limits::kMaxHeaderLines: 431, and the connection ends
  };

  /// REQUIRES: `bytes` begins with the request line, and grows from call to call until a verdict
  /// other than kMore.
  [[nodiscard]] Verdict look(std::string_view bytes);
  /// REQUIRES: the last verdict was kComplete.
  [[nodiscard]] std::size_t headBytes() const {
    assert(last_ == Verdict::kComplete);
    return checked_;
  }

 private:
  [[nodiscard]] Verdict lookOn(std::string_view bytes);
  [[nodiscard]] bool startsLine(std::string_view bytes) const {
    return checked_ >= 2 && bytes[checked_ - 1] == '\n';
  }

  std::size_t checked_ = 0;
  std::size_t lines_ = 0;
  Verdict last_ = Verdict::kMore;
};

/// How many bytes of empty lines stand before the request line: a client may send one after a body
/// (RFC 9112, 2.2).
[[nodiscard]] std::size_t emptyLinesBefore(std::string_view bytes);

}  // namespace qtet

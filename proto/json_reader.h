// Reads parsed JSON the way ByteReader reads bytes. It keeps the first error, with the JSON pointer
// of its place. So a parser is a straight line with one check at the end. For the .cpp files of
// this room only, because it includes nlohmann-json.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"
#include "proto/limits.h"

namespace qtet {

using Json = nlohmann::json;

/// Dumps JSON; bytes that are not UTF-8 (file and field names may hold them) become U+FFFD instead
/// of an exception.
[[nodiscard]] inline std::string dumpJson(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Levels of arrays and objects in a document from outside: what is legal has seven; a destructor
/// or a dump of 100,000 overflows the stack.
inline constexpr std::size_t kMaxJsonDepth = 32;

/// Whether no value of the text lies deeper than kMaxJsonDepth. Counts brackets outside of strings.
/// The result is unspecified for invalid JSON.
[[nodiscard]] inline bool isShallowJson(std::string_view text) {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if ((c == '[' || c == '{') && ++depth > kMaxJsonDepth) return false;
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
  return true;
}

/// One value of a document. A value that is missing or wrong reads as an empty default and sets the
/// error. The document and the error slot must outlive the cursor.
class JsonCursor {
 public:
  JsonCursor(const Json* value, std::string pointer, std::optional<Error>* error)
      : value_(value), pointer_(std::move(pointer)), error_(error) {}

  [[nodiscard]] bool present() const { return value_ != nullptr; }
  [[nodiscard]] bool isNull() const { return value_ != nullptr && value_->is_null(); }

  /// A member that must be there.
  [[nodiscard]] JsonCursor operator[](const std::string& key) const {
    const JsonCursor found = optional(key);
    if (!found.present()) found.fail("is missing");
    return found;
  }

  /// A member that may be absent; `null` is not absence.
  [[nodiscard]] JsonCursor optional(const std::string& key) const {
    const Json* value = nullptr;
    if (value_ != nullptr && !value_->is_object()) fail("must be an object");
    if (value_ != nullptr && value_->is_object()) {
      const auto it = value_->find(key);
      if (it != value_->end()) value = &*it;
    }
    return {value, pointer_ + "/" + key, error_};
  }

  /// A text of 1 to kMaxNameBytes bytes.
  [[nodiscard]] std::string name() const {
    std::string out = text(kMaxNameBytes);
    if (present() && out.empty()) fail("must not be empty");
    return out;
  }

  [[nodiscard]] std::string text(std::size_t maxBytes) const {
    if (value_ == nullptr) return {};
    if (!value_->is_string()) return fail("must be a string"), std::string();
    const auto& out = value_->get_ref<const std::string&>();
    if (out.size() > maxBytes)
      return fail("is longer than " + std::to_string(maxBytes) + " bytes"), std::string();
    return out;
  }

  /// A whole number in [minimum, maximum].
  [[nodiscard]] std::uint64_t count(std::uint64_t minimum, std::uint64_t maximum) const {
    if (value_ == nullptr) return minimum;
    if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() < minimum ||
        value_->get<std::uint64_t>() > maximum) {
      fail("must be a whole number from " + std::to_string(minimum) + " to " +
           std::to_string(maximum));
      return minimum;
    }
    return value_->get<std::uint64_t>();
  }
  [[nodiscard]] std::uint32_t count32(std::uint32_t minimum, std::uint32_t maximum) const {
    return static_cast<std::uint32_t>(count(minimum, maximum));
  }

  [[nodiscard]] double number() const {
    if (value_ == nullptr) return 0;
    if (!value_->is_number() || !std::isfinite(value_->get<double>()))
      return fail("must be a finite number"), 0.0;
    return value_->get<double>();
  }

  /// The elements of an array of minimum..maximum of them.
  [[nodiscard]] std::vector<JsonCursor> items(std::size_t minimum, std::size_t maximum) const {
    std::vector<JsonCursor> out;
    if (value_ == nullptr) return out;
    if (!value_->is_array() || value_->size() < minimum || value_->size() > maximum) {
      fail("must be an array of " + std::to_string(minimum) + " to " + std::to_string(maximum) +
           " elements");
      return out;
    }
    out.reserve(value_->size());
    for (const Json& item : *value_)
      out.emplace_back(&item, pointer_ + "/" + std::to_string(out.size()), error_);
    return out;
  }

  /// Names and values of an object of at most `maximum` members.
  [[nodiscard]] std::vector<std::pair<std::string, JsonCursor>> members(std::size_t maximum) const {
    std::vector<std::pair<std::string, JsonCursor>> out;
    if (value_ == nullptr) return out;
    if (!value_->is_object() || value_->size() > maximum) {
      fail("must be an object of at most " + std::to_string(maximum) + " members");
      return out;
    }
    for (const auto& [key, value] : value_->items())
      out.emplace_back(key, JsonCursor(&value, pointer_ + "/" + key, error_));
    return out;
  }

  /// Sets the error, unless there is one already.
  void fail(const std::string& what) const {
    if (!*error_)
      *error_ =
          Error{ErrorCode::kBadValue, (pointer_.empty() ? "the document" : pointer_) + " " + what,
                Error::kNoOffset};
  }

 private:
  const Json* value_;
  std::string pointer_;
  std::optional<Error>* error_;
};

}  // namespace qtet

#include "proto/field_name.h"

#include <charconv>
#include <cmath>
#include <ostream>
#include <system_error>
#include <utility>

namespace qtet {

FieldName::FieldName(std::string text) : text_(std::move(text)) {
  const std::size_t at = text_.rfind('@');
  if (at == std::string::npos || at == 0) return;
  double time = 0;
  const char* const end = text_.data() + text_.size();
  const auto [stop, code] = std::from_chars(text_.data() + at + 1, end, time);
  if (code == std::errc() && stop == end && std::isfinite(time)) seriesBytes_ = at, time_ = time;
}

std::ostream& operator<<(std::ostream& out, const FieldName& name) { return out << name.text_; }

}  // namespace qtet

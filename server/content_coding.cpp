#include "server/content_coding.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace qtet {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// q=0, q=0.0, q=0.00 and q=0.000 refuse; any other weight, or none, allows.
bool refuses(std::string_view parameters) {
  const std::string_view q = trimmed(parameters);
  if (q.size() < 3 || !equalsIgnoringCase(q.substr(0, 2), "q=")) return false;
  return q.substr(2).find_first_not_of("0.") == std::string_view::npos;
}

}  // namespace

bool acceptsGzip(std::string_view acceptEncoding) {
  std::optional<bool> named;
  bool any = false;
  while (!acceptEncoding.empty()) {
    const std::size_t comma = std::min(acceptEncoding.find(','), acceptEncoding.size());
    const std::string_view item = acceptEncoding.substr(0, comma);
    acceptEncoding.remove_prefix(std::min(comma + 1, acceptEncoding.size()));
    const std::size_t semicolon = std::min(item.find(';'), item.size());
    const std::string_view coding = trimmed(item.substr(0, semicolon));
    const bool allowed = semicolon == item.size() || !refuses(item.substr(semicolon + 1));
    if (equalsIgnoringCase(coding, "gzip") || equalsIgnoringCase(coding, "x-gzip")) named = allowed;
    if (coding == "*") any = allowed;
  }
  return named.value_or(any);
}

}  // namespace qtet

#include "server/wire/request_target.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>

namespace qtet {
namespace {

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// `space` stands for a space as well.
std::optional<std::string> percentDecode(std::string_view text, char space = ' ') {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == space ? ' ' : text[i];
      continue;
    }
    const bool whole = text.size() - i > 2;
    const int high = whole ? hexValue(text[i + 1]) : -1;
    const int low = whole ? hexValue(text[i + 2]) : -1;
    if (high < 0 || low < 0 || (high == 0 && low == 0)) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

/// As forms, URLSearchParams and urllib write a space.
constexpr char kSpaceOfQuery = '+';

struct Pair {
  std::string_view name, value;
};

/// The pair at the front of a query, which moves on behind it.
Pair takePair(std::string_view& query) {
  const std::string_view pair = query.substr(0, query.find('&'));
  query.remove_prefix(std::min(pair.size() + 1, query.size()));
  const std::size_t equals = std::min(pair.find('='), pair.size());
  return {pair.substr(0, equals), pair.substr(std::min(equals + 1, pair.size()))};
}

/// Decoded; as it stands where a code in it is broken.
std::string nameOf(const Pair& pair) {
  return percentDecode(pair.name, kSpaceOfQuery).value_or(std::string(pair.name));
}

bool printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F && c != '#'; });
}

/// "http://host:1/path" becomes "/path" (RFC 9112, 3.2.2).
std::string_view stripAuthority(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    const auto same = [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == b;
    };
    if (!std::ranges::equal(target.substr(0, scheme.size()), scheme, same)) continue;
    const std::size_t path = target.find('/', scheme.size());
    return path == std::string_view::npos ? "/" : target.substr(path);
  }
  return target;
}

}  // namespace

std::optional<std::string> RequestTarget::parameter(std::string_view name) const {
  for (std::string_view rest = query; !rest.empty();) {
    const Pair pair = takePair(rest);
    if (nameOf(pair) == name) return percentDecode(pair.value, kSpaceOfQuery);
  }
  return std::nullopt;
}

std::optional<std::string> RequestTarget::repeatedParameter() const {
  std::set<std::string> names;
  for (std::string_view rest = query; !rest.empty();) {
    const Pair pair = takePair(rest);
    if (pair.name.empty()) continue;
    const auto [name, isNew] = names.insert(nameOf(pair));
    if (!isNew) return *name;
  }
  return std::nullopt;
}

std::optional<RequestTarget> parseTarget(std::string_view target) {
  target = stripAuthority(target);
  if (!target.starts_with('/') || !printable(target)) return std::nullopt;
  RequestTarget out;
  const std::size_t question = std::min(target.find('?'), target.size());
  out.query = target.substr(std::min(question + 1, target.size()));
  std::string_view path = target.substr(1, question - 1);
  for (;;) {
    const std::size_t slash = path.find('/');
    std::optional<std::string> segment = percentDecode(path.substr(0, slash));
    if (!segment) return std::nullopt;
    out.segments.push_back(std::move(*segment));
    if (slash == std::string_view::npos) return out;
    path.remove_prefix(slash + 1);
  }
}

std::string percentEncode(std::string_view text) {
  constexpr std::string_view kUnreserved =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    if (kUnreserved.find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    const auto byte = static_cast<std::uint8_t>(c);
    out += '%';
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

}  // namespace qtet

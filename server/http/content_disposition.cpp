#include "server/http/content_disposition.h"

#include "server/wire/request_target.h"

namespace qtet {
namespace {

/// Some browsers take a % for the beginning of a percent code: RFC 6266, appendix D.
bool isPlain(char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\' && c != '%'; }

bool continuesCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

}  // namespace

std::string contentDisposition(Disposition disposition, std::string_view name) {
  std::string plain;
  for (const char c : name)
    if (!continuesCharacter(c)) plain += isPlain(c) ? c : '_';
  std::string out = disposition == Disposition::kInline ? "inline" : "attachment";
  out += "; filename=\"" + plain + "\"";
  if (plain != name) out += "; filename*=UTF-8''" + percentEncode(name);
  return out;
}

}  // namespace qtet

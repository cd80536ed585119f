#include "codec/picture/poster_page.h"

namespace qtet {
namespace {

void replace(std::string& text, std::string_view mark, const std::string& content) {
  if (const std::size_t at = text.find(mark); at != text.npos)
    text.replace(at, mark.size(), content);
}

}  // namespace

std::string htmlEscaped(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  return out;
}

std::string pageOfMesh(std::string_view page, std::string_view name, std::string_view address) {
  std::string out(page);
  // The poster comes first in the page: a name that reads like a mark is text.
  const std::string escaped = htmlEscaped(name);
  replace(out, kPosterMark,
          "<img slot=\"poster\" alt=\"\" fetchpriority=\"high\" data-mesh=\"" + escaped +
              "\" src=\"" + htmlEscaped(address) + "\">");
  replace(out, kNameMark, escaped);
  return out;
}

}  // namespace qtet

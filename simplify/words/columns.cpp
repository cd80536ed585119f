#include "simplify/words/columns.h"

#include <algorithm>

#include "simplify/words/printable.h"

namespace qtet {

std::string columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], textWidth(row[c]));
  }
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(widths[c] - textWidth(row[c]), ' ');
      out += c == 0 ? row[c] + space : "  " + space + row[c];
    }
    out += "\n";
  }
  return out;
}

std::string moreFields(std::size_t all, const std::string& how) {
  if (all <= kShownFields) return {};
  return "and " + counted(all - kShownFields, "more field", "more fields") + ": " + how + "\n";
}

}  // namespace qtet

#include "simplify/read/text/plain_numbers.h"

#include <string>

#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

std::optional<double> fortranReal(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  constexpr std::size_t kMaxLetters = 64;
  if (text.empty() || text.front() == '+' || text.size() >= kMaxLetters) return std::nullopt;
  std::string number(text);
  for (std::size_t i = 1; i < number.size(); ++i) {
    if (number[i] == 'D' || number[i] == 'd') number[i] = 'E';
    const bool isSign = number[i] == '+' || number[i] == '-';
    if (!isSign || std::string_view("0123456789.").find(number[i - 1]) == std::string_view::npos)
      continue;
    number.insert(i, "E");
    break;
  }
  double value = 0;
  const char* const end = number.data() + number.size();
  const auto read = std::from_chars(number.data(), end, value);
  if (read.ptr != end || read.ec == std::errc::invalid_argument) return std::nullopt;
  return read.ec == std::errc::result_out_of_range ? MeshScanner::beyondRange(number) : value;
}

}  // namespace qtet

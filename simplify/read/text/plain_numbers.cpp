#include "simplify/read/text/plain_numbers.h"

#include <algorithm>
#include <array>
#include <string>

#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

std::optional<double> fortranReal(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.front() == '+') return std::nullopt;
  std::array<char, 64> exponent{};
  if (const std::size_t at = text.find_first_of("Dd"); at != std::string_view::npos) {
    if (text.size() > exponent.size()) return std::nullopt;
    std::ranges::copy(text, exponent.begin());
    exponent[at] = 'E';
    text = {exponent.data(), text.size()};
  }
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ptr != text.data() + text.size() || read.ec == std::errc::invalid_argument)
    return std::nullopt;
  return read.ec == std::errc::result_out_of_range ? MeshScanner::beyondRange(text) : value;
}

}  // namespace qtet

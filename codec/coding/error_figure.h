// A known error as an integer that grows with it (FORMAT.md, "Known error"): three significant
// digits, rounded up, so that no error is understated.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <ranges>

namespace qtet {

/// Figure 0 is 0. Figure n >= 1, with n - 1 = 900 e + (m - 100) and m from 100 to 999, is m * 10^(e
/// - kErrorFigureDigits). There is no value between 0 and 10^-12.
inline constexpr std::uint32_t kErrorFigureDigits = 14;
/// Up to 9.99 * 10^6; an error is a fraction of the diagonal or of a field's range, seldom above 1.
inline constexpr std::uint32_t kMaxErrorFigure = 900 * 19;

[[nodiscard]] inline double errorOfFigure(std::uint32_t figure) {
  if (figure == 0) return 0;
  const std::uint32_t exponent = (figure - 1) / 900;
  // Whole powers of ten are exact up to 10^22, so there is one rounding and the decimal prints as
  // it stands here.
  double power = 1;
  for (std::uint32_t i = std::min(exponent, kErrorFigureDigits);
       i < std::max(exponent, kErrorFigureDigits); ++i)
    power *= 10;
  const double digits = (figure - 1) % 900 + 100;
  return exponent < kErrorFigureDigits ? digits / power : digits * power;
}

/// The least figure that does not understate `error`. REQUIRES: 0 to
/// errorOfFigure(kMaxErrorFigure).
[[nodiscard]] inline std::uint32_t figureOfError(double error) {
  assert(error >= 0 && error <= errorOfFigure(kMaxErrorFigure));
  return *std::ranges::partition_point(
      std::views::iota(0u, kMaxErrorFigure),
      [error](std::uint32_t figure) { return errorOfFigure(figure) < error; });
}

[[nodiscard]] inline double roundedUp(double error) { return errorOfFigure(figureOfError(error)); }

}  // namespace qtet

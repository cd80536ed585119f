// Why a request was refused, as a label of figures: few and fixed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace qtet {

enum class Refusal : std::uint8_t {
  kNone,    ///< it was not refused, or its status says enough
  kAuth,    ///< no token, or one for something else
  kRate,    ///< the address asks too often
  kCredit,  ///< the address owes processor time
  kPlaces,  ///< as many levels, uploads, tickets or clients of a proxy as may be
  kSize,    ///< larger than there is room for
  kBusy,    ///< the server cannot now
};
inline constexpr std::array<std::string_view, 7> kRefusalLabels = {
    "", "auth", "rate", "credit", "places", "size", "busy"};

/// The reason that a status tells by itself.
[[nodiscard]] constexpr Refusal refusalBy(unsigned status) {
  switch (status) {
    case 401:
    case 403: return Refusal::kAuth;
    case 429: return Refusal::kRate;
    case 413:
    case 431:
    case 507: return Refusal::kSize;
    case 503: return Refusal::kBusy;
    default: return Refusal::kNone;
  }
}

}  // namespace qtet

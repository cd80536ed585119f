// Films of half the rate: a log with series without some of their instants.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/log/log_index.h"
#include "proto/manifest.h"

namespace qtet {

/// The fields that stay if every second instant of each series goes, then every second one of the
/// others, and so on up to the ends of windows (decodingOrder). Each list is ascending, and holds
/// what its fields are predicted from. Empty where no instant can go.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> fewerInstants(const Manifest& manifest,
                                                                    const LogIndex& index);

}  // namespace qtet

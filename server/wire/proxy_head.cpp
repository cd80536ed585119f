#include "server/wire/proxy_head.h"

#include <algorithm>
#include <array>

#include "server/wire/trusted_proxies.h"

namespace qtet {
namespace {

namespace ip = boost::asio::ip;

std::uint16_t u16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

}  // namespace

ProxyHead readProxyHead(std::span<const std::uint8_t> bytes) {
  using State = ProxyHead::State;
  constexpr std::array<std::uint8_t, 12> kSignature = {0x0D, 0x0A, 0x0D, 0x0A, 0x00, 0x0D,
                                                       0x0A, 0x51, 0x55, 0x49, 0x54, 0x0A};
  constexpr std::size_t kFixedBytes = 16;
  constexpr std::uint8_t kLocal = 0x20, kProxy = 0x21, kTcp4 = 0x11, kTcp6 = 0x21;
  const std::size_t known = std::min(bytes.size(), kSignature.size());
  if (!std::ranges::equal(bytes.first(known), std::span(kSignature).first(known)))
    return {State::kWrong};
  if (bytes.size() < kFixedBytes) return {};
  const std::uint8_t command = bytes[12], family = bytes[13];
  const std::size_t whole = kFixedBytes + u16(bytes, 14);
  if ((command != kLocal && command != kProxy) || whole > kMaxProxyHeadBytes)
    return {State::kWrong};
  if (bytes.size() < whole) return {};
  ProxyHead out{State::kWhole, whole};
  const auto at = bytes.subspan(kFixedBytes);
  if (command == kProxy && family == kTcp4) {
    ip::address_v4::bytes_type v4;
    if (whole < kFixedBytes + 12) return {State::kWrong};
    std::ranges::copy(at.first(v4.size()), v4.begin());
    out.client = ip::make_address_v4(v4);
  } else if (command == kProxy && family == kTcp6) {
    ip::address_v6::bytes_type v6;
    if (whole < kFixedBytes + 36) return {State::kWrong};
    std::ranges::copy(at.first(v6.size()), v6.begin());
    out.client = plainAddress(ip::make_address_v6(v6));
  }
  return out;
}

}  // namespace qtet

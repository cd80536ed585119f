#include "server/wire/digest.h"

#include <openssl/evp.h>

#include <stdexcept>

#include "proto/checksum.h"

namespace qtet {
namespace {

constexpr std::size_t kTagCharacters = 32;

}  // namespace

Digest digestOf(ByteView bytes) {
  // fetched once: EVP_sha256() would look for it at every call
  static const EVP_MD* const kSha256 = ::EVP_MD_fetch(nullptr, "SHA256", nullptr);
  Digest out{};
  if (kSha256 == nullptr ||
      ::EVP_Digest(bytes.data(), bytes.size(), out.data(), nullptr, kSha256, nullptr) != 1)
    throw std::runtime_error("OpenSSL cannot make a SHA-256");
  return out;
}

Digest digestOf(std::string_view text) {
  return digestOf(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string hexDigestOf(ByteView bytes) { return toHex(digestOf(bytes)); }
std::string hexDigestOf(std::string_view text) { return toHex(digestOf(text)); }

std::string tagOf(ByteView bytes) { return hexDigestOf(bytes).substr(0, kTagCharacters); }
std::string tagOf(std::string_view text) { return hexDigestOf(text).substr(0, kTagCharacters); }

std::optional<Digest> digestOfHex(std::string_view hex) {
  Digest out{};
  if (hex.size() != 2 * out.size() ||
      hex.find_first_not_of("0123456789abcdef") != std::string_view::npos)
    return std::nullopt;
  const auto nibble = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::uint8_t>(nibble(hex[2 * i]) * 16 + nibble(hex[2 * i + 1]));
  return out;
}

}  // namespace qtet

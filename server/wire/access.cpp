#include "server/wire/access.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>

#include "server/wire/token_limits.h"

namespace qtet {
namespace {

std::string hexOf(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : bytes) out += {kDigits[byte >> 4], kDigits[byte & 15]};
  return out;
}

/// 32 random bytes in hexadecimal: nothing that an address would have to encode.
std::string randomSecret() {
  std::array<std::uint8_t, 32> bytes{};
  for (std::size_t have = 0; have < bytes.size();) {
    const ssize_t count = ::getrandom(bytes.data() + have, bytes.size() - have, 0);
    if (count < 0 && errno != EINTR) throw std::runtime_error("the system gives no random bytes");
    if (count > 0) have += static_cast<std::size_t>(count);
  }
  return hexOf(bytes);
}

/// Characters of what a ticket holds one behind the other, all in hexadecimal.
constexpr std::size_t kIssuerText = 16, kEndText = 16, kNonceText = 64, kTokenText = 64,
                      kMacText = 64;
constexpr std::size_t kSignedText = kIssuerText + kEndText + kNonceText + kTokenText;
static_assert(kSignedText + kMacText == limits::kTicketCharacters);
constexpr std::size_t kMinKeyBytes = 32;

std::string macOf(std::string_view text, std::string_view key) {
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> out{};
  unsigned bytes = 0;
  if (::HMAC(::EVP_sha256(), key.data(), static_cast<int>(key.size()),
             reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), out.data(),
             &bytes) == nullptr)
    throw std::runtime_error("OpenSSL has no HMAC");
  return hexOf(std::span(out).first(bytes));
}

std::int64_t secondsNow() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string endText() {
  std::array<char, kEndText + 1> out{};
  std::snprintf(out.data(), out.size(), "%016llx",
                static_cast<unsigned long long>(secondsNow() + limits::kTicketTime.count()));
  return out.data();
}

}  // namespace

Access::Access(Tokens tokens, std::string ticketKey)
    : ticketKey_(ticketKey.empty() ? randomSecret() : std::move(ticketKey)),
      issuer_(randomSecret().substr(0, kIssuerText)),
      tokens_(std::make_shared<const Tokens>(std::move(tokens))) {}

std::shared_ptr<const Tokens> Access::tokens() const {
  const std::scoped_lock lock(mutex_);
  return tokens_;
}

void Access::replace(Tokens tokens) {
  auto now = std::make_shared<const Tokens>(std::move(tokens));
  const std::scoped_lock lock(mutex_);
  tokens_.swap(now);
}

std::optional<std::string> Access::giveTicket(const SecretDigest& token, Clock::time_point now) {
  std::string ticket = issuer_ + endText() + randomSecret() + hexOf(token);
  assert(ticket.size() == kSignedText);  // as takeForeign() takes it apart
  ticket += macOf(ticket, ticketKey_);
  assert(ticket.size() == kSignedText + kMacText);
  const std::scoped_lock lock(mutex_);
  std::erase_if(tickets_, [&](const auto& entry) { return entry.second.end <= now; });
  const auto unused = std::ranges::count_if(
      tickets_, [&](const auto& entry) { return entry.second.token == token; });
  if (static_cast<std::size_t>(unused) >= limits::kMaxTickets) return std::nullopt;
  tickets_.emplace(secretDigest(ticket), Ticket{token, now + limits::kTicketTime});
  return ticket;
}

std::optional<SecretDigest> Access::takeTicket(std::string_view ticket, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  const auto taken = tickets_.extract(secretDigest(ticket));
  if (taken.empty()) return takeForeign(ticket, now);
  if (taken.mapped().end <= now) return std::nullopt;
  return taken.mapped().token;
}

std::optional<SecretDigest> Access::takeForeign(std::string_view ticket, Clock::time_point now) {
  if (ticket.size() != kSignedText + kMacText || ticket.starts_with(issuer_)) return std::nullopt;
  const std::string mac = macOf(ticket.substr(0, kSignedText), ticketKey_);
  if (::CRYPTO_memcmp(mac.data(), ticket.data() + kSignedText, kMacText) != 0) return std::nullopt;
  std::int64_t end = 0;
  const std::string_view text = ticket.substr(kIssuerText, kEndText);
  std::from_chars(text.data(), text.data() + text.size(), end, 16);
  const std::int64_t left = end - secondsNow();
  if (left <= 0 || left > limits::kTicketTime.count()) return std::nullopt;
  std::erase_if(usedForeign_, [&](const auto& entry) { return entry.second <= now; });
  if (!usedForeign_.emplace(secretDigest(ticket), now + limits::kTicketTime).second)
    return std::nullopt;
  return digestOfHex(ticket.substr(kSignedText - kTokenText, kTokenText));
}

Result<std::string> loadTicketKey(const std::filesystem::path& file) {
  const auto refused = [&] {
    return fail(ErrorCode::kIo, "the key of tickets " + file.string() + ": " +
                                    std::strerror(errno) + "; name another with --ticket-key");
  };
  // Written whole under another name first: two servers may start at once, and the first one wins.
  if (::access(file.c_str(), F_OK) != 0) {
    const std::string fresh = file.string() + "." + std::to_string(::getpid());
    const int made = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (made < 0) return refused();
    const std::string secret = randomSecret();
    const bool written =
        ::write(made, secret.data(), secret.size()) == static_cast<ssize_t>(secret.size());
    ::close(made);
    const bool linked = written && (::link(fresh.c_str(), file.c_str()) == 0 || errno == EEXIST);
    const int number = errno;
    ::unlink(fresh.c_str());
    errno = number;
    if (!linked) return refused();
  }
  std::ifstream in(file, std::ios::binary);
  std::string out{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.good() && !in.eof()) return refused();
  while (!out.empty() && (out.back() == '\n' || out.back() == '\r')) out.pop_back();
  if (out.size() >= kMinKeyBytes) return out;
  return fail(ErrorCode::kBadValue, file.string() + " holds " + std::to_string(out.size()) +
                                        " bytes; a key of tickets has at least " +
                                        std::to_string(kMinKeyBytes));
}

MayRead Access::readerOf(const std::optional<SecretDigest>& bearer) const {
  return [this, bearer](const std::string& mesh) {
    return tokens()->may(Tokens::Scope::kRead, bearer, mesh) == Tokens::Verdict::kAllowed;
  };
}

}  // namespace qtet

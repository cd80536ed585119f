#include "server/wire/access.h"

#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include "server/wire/limits.h"

namespace qtet {
namespace {

/// 32 random bytes in hexadecimal: nothing that an address would have to encode.
std::string randomSecret() {
  std::array<std::uint8_t, 32> bytes{};
  for (std::size_t have = 0; have < bytes.size();) {
    const ssize_t count = ::getrandom(bytes.data() + have, bytes.size() - have, 0);
    if (count < 0 && errno != EINTR) throw std::runtime_error("the system gives no random bytes");
    if (count > 0) have += static_cast<std::size_t>(count);
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : bytes) out += {kDigits[byte >> 4], kDigits[byte & 15]};
  return out;
}

}  // namespace

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
  std::string ticket = randomSecret();
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
  if (taken.empty() || taken.mapped().end <= now) return std::nullopt;
  return taken.mapped().token;
}

MayRead Access::readerOf(const std::optional<SecretDigest>& bearer) const {
  return [this, bearer](const std::string& mesh) {
    return tokens()->may(Tokens::Scope::kRead, bearer, mesh) == Tokens::Verdict::kAllowed;
  };
}

}  // namespace qtet

// The tokens that hold now, and the tickets that were given for them.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/wire/tokens.h"

namespace qtet {

/// Says of a mesh's name whether somebody may read it; an empty one: everything.
using MayRead = std::function<bool(const std::string& mesh)>;

/// Thread-safe: `mutex_` guards tokens and tickets. Must outlive the MayRead that it gives.
class Access {
 public:
  /// Not the system clock: its jumps would end a ticket early or keep it too long.
  using Clock = std::chrono::steady_clock;

  /// Tickets are signed with `ticketKey`, and those of every server with the same key are accepted.
  /// With "" only this server's own tickets are.
  explicit Access(Tokens tokens, std::string ticketKey = "");
  [[nodiscard]] std::shared_ptr<const Tokens> tokens() const;
  /// Requests from now on are judged by these; so are the tickets of tokens that are not among them
  /// any more.
  void replace(Tokens tokens);

  /// A secret that stands for the token of that digest once, for limits::kTicketTime: browsers
  /// cannot send a header with a WebSocket. nullopt: that token has limits::kMaxTickets of them
  /// unused. Each server takes a ticket once: its own by the steady clock, those of others by the
  /// system's.
  [[nodiscard]] std::optional<std::string> giveTicket(const SecretDigest& token,
                                                      Clock::time_point now = Clock::now());
  /// The digest of the token that it stands for, for which it is no good any more; nullopt: it is
  /// none, used, or too old.
  [[nodiscard]] std::optional<SecretDigest> takeTicket(std::string_view ticket,
                                                       Clock::time_point now = Clock::now());

  /// The meshes that the token's owner may read. Each question is answered by the tokens valid at
  /// that time.
  [[nodiscard]] MayRead readerOf(const std::optional<SecretDigest>& bearer) const;

 private:
  struct Ticket {
    SecretDigest token{};
    Clock::time_point end{};
  };
  [[nodiscard]] std::optional<SecretDigest> takeForeign(std::string_view ticket,
                                                        Clock::time_point now);

  const std::string ticketKey_, issuer_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Tokens> tokens_;
  /// Keyed by the tickets' digests, so that the time of a look-up reveals nothing about a ticket.
  std::map<SecretDigest, Ticket> tickets_;
  std::map<SecretDigest, Clock::time_point> usedForeign_;  ///< until when
};

/// The key that servers of one folder share: what stands in `file`, which is made, readable for its
/// owner alone, where it is not there. Errors: io, bad-value (it has less than 32 bytes).
[[nodiscard]] Result<std::string> loadTicketKey(const std::filesystem::path& file);

}  // namespace qtet

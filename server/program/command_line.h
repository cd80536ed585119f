// The options of qtet-server, from the command line, the environment and a file, in this order of
// precedence.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/error.h"
#include "server/http/upload_limits.h"
#include "server/store/free_disk.h"
#include "server/store/level_memory.h"
#include "server/store/log_check.h"
#include "server/store/store_limits.h"
#include "server/wire/connection_limits.h"
#include "server/wire/trusted_proxies.h"

namespace qtet {

namespace limits {
/// The longest time of draining: an hour, far above the time in which load balancers notice.
/// deploy/qtet-server.service waits for longer.
inline constexpr std::chrono::seconds kMaxDrainTime{3'600};
}  // namespace limits

struct CommandLine {
  enum class Action { kServe, kCheckConfig, kHelp, kHelpAll, kVersion };
  Action action = Action::kServe;
  std::filesystem::path folder;
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  std::optional<std::filesystem::path> viewer;
  std::size_t threads = 1;
  bool watch = true;
  bool readyEarly = false;
  std::optional<std::string> adminHost;
  std::uint16_t adminPort = 0;
  std::optional<std::filesystem::path> cache;
  std::uintmax_t cacheBytes = limits::kMaxCacheBytes;
  std::optional<std::string> accessLog;
  std::optional<std::filesystem::path> tokens;
  std::optional<std::filesystem::path> tlsCertificate;  ///< with tlsKey, or neither
  std::optional<std::filesystem::path> tlsKey;
  std::uintmax_t maxUploadBytes = limits::kMaxUploadBytes;
  std::uint64_t maxLevelBytes = ownMemory() / limits::kLevelPartOfMemory;
  std::uintmax_t maxCheckBytes = limits::kMaxCheckBytes;
  std::chrono::seconds maxCheckTime = limits::kCheckTime;
  std::uintmax_t diskReserve = limits::kDiskReserve;
  std::chrono::seconds drainTime{0};
  std::optional<std::filesystem::path> ticketKey;
  std::size_t maxConnections = limits::kMaxConnections;
  std::size_t maxConnectionsPerAddress = limits::kMaxConnectionsPerAddress;  ///< 0: no bound
  std::size_t maxLevelsPerAddress = limits::kMaxLevelJobsPerAddress;         ///< 0: no bound
  unsigned maxRequestsPerSecond = limits::kMaxRequestsPerSecond;             ///< 0: no bound
  /// Origins of pages that may open streams; empty: any.
  std::vector<std::string> allowedOrigins;
  std::string frameAncestors = "*";
  TrustedProxies proxies;
  std::string proxyList;  ///< the networks as they were given
};

/// `environment` is what `environ` points to: NAME=VALUE texts and a nullptr. An option
/// `max-connections` is QTET_SERVER_MAX_CONNECTIONS there; the file, lines `max-connections = 100`,
/// is the one that --config or QTET_SERVER_CONFIG names. Errors: bad-value, io (the file) with a
/// sentence for the user.
[[nodiscard]] Result<CommandLine> parseCommandLine(int argc, const char* const* argv,
                                                   const char* const* environment = nullptr);
[[nodiscard]] std::string usageText(bool all);
/// Every option as it holds, in the form of the file.
[[nodiscard]] std::string configText(const CommandLine& options);

}  // namespace qtet

// Sends a log to a server that takes uploads (PROTOCOL.md, "Uploads").
#pragma once

#include <boost/program_options.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "codec/refine/log_file.h"
#include "simplify/remote/http_client.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// Where a log goes, and who sends it.
struct PushTarget {
  HttpUrl server;
  std::string target;         ///< /v1/meshes/NAME
  std::string authorization;  ///< the header that says who sends it
  std::string authorities;    ///< HttpRequest's
};

/// Adds --token-file and --cacert.
void addPushOptions(po::options_description& options);

/// The mesh that the URL names, else that of the log's name. Errors: bad-value (no token), io.
/// Throws UsageError for a URL that is none.
[[nodiscard]] Result<PushTarget> pushTargetOf(const ParsedWords& parsed, const std::string& url,
                                              const std::filesystem::path& log);

struct Pushed {
  std::string address;     ///< of the mesh
  bool replaced = false;   ///< there was a log of this name
  std::uint64_t sent = 0;  ///< bytes of all bodies
};

/// Sends the log as often as it takes; only what is new where the server has another one under the
/// name. Errors: exchange's, io (the server refuses it).
[[nodiscard]] Result<Pushed> pushLog(const LogFile& log, const PushTarget& target,
                                     Console& console);

/// A line, or {address, digest, bytes, sent, replaced}.
void reportPushed(const LogFile& log, const Pushed& pushed, bool asJson, Console& console);

}  // namespace qtet

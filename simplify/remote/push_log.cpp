#include "simplify/remote/push_log.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>

#include "codec/log/log_delta.h"
#include "simplify/remote/old_log.h"
#include "simplify/words/json_report.h"
#include "simplify/words/progress.h"

namespace qtet {
namespace {

constexpr const char* kTokenVariable = "QTET_TOKEN";

/// After a lost connection: so often, and so long after the first; twice as long each time.
constexpr int kMaxAttempts = 6;
constexpr std::chrono::milliseconds kFirstPause{500};
/// The time for the answer to a whole log: the server decodes it first, and others before it.
constexpr std::chrono::hours kCheckTime{1};

/// The log to send, and its destination.
struct Push : PushTarget {
  const LogFile& log;
};

Result<std::string> readToken(const ParsedWords& parsed) {
  std::string token;
  if (parsed.has("token-file")) {
    const auto path = parsed.get<std::string>("token-file");
    std::ifstream in(path);
    if (!(in >> token)) return fail(ErrorCode::kIo, path + " holds no token");
  } else if (const char* given = std::getenv(kTokenVariable); given != nullptr) {
    token = given;
  }
  if (token.empty() || token.find_first_of(" \r\n") != std::string::npos)
    return fail(ErrorCode::kBadValue, std::string("no token: set ") + kTokenVariable +
                                          ", or name a file with --token-file");
  return token;
}

/// "http://host/" and "http://host/v1/meshes/" get the log's own name.
std::string targetOf(const HttpUrl& url, const std::filesystem::path& log) {
  constexpr std::string_view kMeshes = "/v1/meshes/";
  if (url.path.starts_with(kMeshes) && url.path.size() > kMeshes.size()) return url.path;
  return std::string(kMeshes) + encodedSegment(log.stem().string());
}

/// Where the log should go instead, the detail of a problem, or the body's beginning.
std::string reasonOf(const HttpAnswer& answer) {
  if (!answer.location.empty())
    return std::to_string(answer.status) + ": the address leads to " +
           answer.location.substr(0, answer.location.find('?')) + "; push to that one";
  const auto json = OrderedJson::parse(answer.body, nullptr, false);
  const bool told = json.is_object() && json.contains("detail") && json["detail"].is_string();
  return std::to_string(answer.status) + ": " +
         (told ? json["detail"].get<std::string>() : answer.body.substr(0, 200)) +
         (answer.status == 412 ? " The name has another log than when this push began; look at it, "
                                 "then push again."
                               : "");
}

/// Whether another attempt may go better: the server had no time or no place, or disagreed about
/// what is there.
bool worthAnother(const HttpAnswer& answer) {
  return answer.status == 408 || answer.status == 409 || answer.status == 429 ||
         answer.status == 503;
}

HttpRequest getOf(const Push& push, const std::string& target) {
  return {.method = "GET",
          .target = target,
          .headers = {push.authorization},
          .authorities = push.authorities};
}

/// The mesh that the server has under the name.
struct Served {
  std::string digest;     ///< of its log; empty: there is no such mesh, or the answer is unknown
  std::string condition;  ///< the header that says so: nobody else's log is replaced; may be empty
};

/// Errors: exchange's, io (the server cannot say it now).
Result<Served> askServed(const Push& push) {
  const Result<HttpAnswer> answer = exchange(push.server, getOf(push, push.target));
  if (!answer) return std::unexpected(answer.error());
  if (worthAnother(*answer)) return fail(ErrorCode::kIo, reasonOf(*answer));
  Served out;
  if (answer->status == 404) out.condition = "If-None-Match: *";
  if (answer->status != 200) return out;
  const auto json = OrderedJson::parse(answer->body, nullptr, false);
  if (json.is_object() && json.contains("digest") && json["digest"].is_string())
    out.digest = json["digest"].get<std::string>();
  // A weak tag, of a proxy that compresses, matches nothing.
  if (answer->etag.starts_with('"')) out.condition = "If-Match: " + answer->etag;
  return out;
}

/// Bytes that the server has of an upload that broke off, perhaps all of them. Errors: exchange's.
Result<std::uint64_t> bytesThere(const Push& push) {
  const std::string query = push.target + "/upload?digest=" + push.log.digest();
  const Result<HttpAnswer> answer = exchange(push.server, getOf(push, query));
  if (!answer) return std::unexpected(answer.error());
  const auto json = OrderedJson::parse(answer->body, nullptr, false);
  const bool told = answer->status == 200 && json.is_object() && json.contains("bytes") &&
                    json["bytes"].is_number_unsigned();
  const std::uint64_t bytes = told ? json["bytes"].get<std::uint64_t>() : 0;
  return bytes <= push.log.bytes().size() ? bytes : 0;
}

/// Bytes of a delta that are held in memory; beyond them the log is sent whole.
constexpr std::uint64_t kMaxDeltaBytes = std::uint64_t{1} << 30;

/// The log from byte `first` on: its own bytes, or a delta to another log.
struct Sending {
  std::uint64_t first = 0;
  Bytes delta{};
  std::string from{};  ///< the other log's digest; empty: the log's own bytes
};

/// A delta to the log that the server has. The log's own bytes where there is no such log, where it
/// cannot be had, or where a delta would not be shorter.
Sending sendingFrom(const Push& push, std::uint64_t first, bool mayUseDelta) {
  Sending out{.first = first};
  const ByteView log = push.log.bytes();
  assert(first <= log.size());
  if (!mayUseDelta || first == log.size()) return out;
  const Result<OldLog> old = fetchOldLog(push.server, getOf(push, push.target));
  if (!old) return out;
  const std::uint64_t most = std::min<std::uint64_t>(kMaxDeltaBytes, log.size() - first - 1);
  if (auto delta = makeDelta(old->index, push.log.index(), log, first, most)) {
    out.delta = std::move(*delta);
    out.from = old->digest;
  }
  return out;
}

/// `condition` is a header or empty. Adds the bytes of the body that were sent to `sent`.
Result<HttpAnswer> send(const Push& push, const Sending& sending, const std::string& condition,
                        Progress& progress, std::uint64_t& sent) {
  const std::uint64_t size = push.log.bytes().size(), first = sending.first;
  const bool isDelta = !sending.from.empty();
  const ByteView body = isDelta ? ByteView(sending.delta) : push.log.bytes().subspan(first);
  std::vector<std::string> headers{push.authorization};
  if (!condition.empty()) headers.push_back(condition);
  if (first > 0 || isDelta)
    headers.push_back(
        "Content-Range: bytes " +
        (first < size ? std::to_string(first) + "-" + std::to_string(size - 1) : "*") + "/" +
        std::to_string(size));
  constexpr std::string_view kChecking = "the server checks the log";
  progress.stage(body.empty() ? kChecking
                 : isDelta    ? "sending what is new"
                 : first > 0  ? "sending the rest"
                              : "sending");
  const std::uint64_t there = isDelta ? 0 : first, before = sent;
  return exchange(push.server, {.method = "PUT",
                                .target = push.target + "?digest=" + push.log.digest() +
                                          (isDelta ? "&from=" + sending.from : ""),
                                .headers = headers,
                                .body = body,
                                .authorities = push.authorities,
                                .patience = {.answering = kCheckTime},
                                .progress =
                                    [&](std::uint64_t bytes) {
                                      sent = before + bytes;
                                      progress.update(static_cast<double>(there + bytes) /
                                                      static_cast<double>(there + body.size()));
                                      if (bytes == body.size()) progress.stage(kChecking);
                                    },
                                .waiting = [&] { progress.working(); }});
}

/// The last answer to the log, and the bytes of all bodies that were sent for it.
struct Sent {
  HttpAnswer answer;
  std::uint64_t bytes = 0;
};

/// Sends the log as often as it takes.
Result<Sent> sendLog(const Push& push, Console& console) {
  Progress progress(console);
  std::uint64_t sent = 0;
  bool mayUseDelta = true, usedDelta = false;
  std::optional<std::string> condition;  // as things stood when this push began
  Result<HttpAnswer> answer = fail(ErrorCode::kIo, "");
  for (int attempt = 1;;) {
    const Result<Served> served = askServed(push);
    if (served && condition && served->digest == push.log.digest()) {
      // An earlier attempt published it, and the answer was lost.
      const bool isNew = condition->starts_with("If-None-Match");
      return Sent{{.status = isNew ? 201u : 200u, .body = "", .location = ""}, sent};
    }
    if (served && !condition) condition = served->condition;
    const Result<std::uint64_t> first = served ? bytesThere(push) : std::unexpected(served.error());
    if (first) {
      const Sending sending = sendingFrom(push, *first, mayUseDelta);
      usedDelta = usedDelta || !sending.from.empty();
      answer = send(push, sending, *condition, progress, sent);
    } else {
      answer = std::unexpected(first.error());
    }
    progress.clear();
    // The server knows no deltas, or the checksums of two blocks agree by chance.
    if (answer && (answer->status == 400 || answer->status == 422) && usedDelta && mayUseDelta) {
      mayUseDelta = false;
      continue;
    }
    const bool again = answer ? worthAnother(*answer) : answer.error().code == ErrorCode::kIo;
    if (!again || attempt == kMaxAttempts) break;
    console.err << "qtet: " << printable(answer ? reasonOf(*answer) : answer.error().message)
                << "; trying again\n";
    std::this_thread::sleep_for(kFirstPause * (1 << (attempt - 1)));
    ++attempt;
  }
  if (!answer) return std::unexpected(answer.error());
  return Sent{std::move(*answer), sent};
}

}  // namespace

void addPushOptions(po::options_description& options) {
  options.add_options()("token-file", po::value<std::string>(),
                        "file with the token (default: the environment's QTET_TOKEN)")(
      "cacert", po::value<std::string>()->default_value("", "the system's"),
      "PEM file of the authorities that may sign an https server's certificate");
}

Result<PushTarget> pushTargetOf(const ParsedWords& parsed, const std::string& url,
                                const std::filesystem::path& log) {
  const Result<HttpUrl> server = parseHttpUrl(url);
  if (!server) throw UsageError(server.error().message);
  const Result<std::string> token = readToken(parsed);
  if (!token) return std::unexpected(token.error());
  return PushTarget{*server, targetOf(*server, log), "Authorization: Bearer " + *token,
                    parsed.get<std::string>("cacert")};
}

Result<Pushed> pushLog(const LogFile& log, const PushTarget& target, Console& console) {
  const Push push{target, log};
  const Result<Sent> sent = sendLog(push, console);
  if (!sent) return std::unexpected(sent.error());
  const unsigned status = sent->answer.status;
  if (status != 200 && status != 201)
    return fail(ErrorCode::kIo, "the server refuses the log, " + reasonOf(sent->answer));
  return Pushed{push.server.origin + push.target, status == 200, sent->bytes};
}

void reportPushed(const LogFile& log, const Pushed& pushed, bool asJson, Console& console) {
  const std::uint64_t bytes = log.bytes().size();
  if (asJson)
    printJson({{"address", pushed.address},
               {"digest", log.digest()},
               {"bytes", bytes},
               {"sent", pushed.sent},
               {"replaced", pushed.replaced}},
              console);
  else
    console.out << pushed.address << "  " << (pushed.replaced ? "replaced" : "new") << ", " << bytes
                << " bytes, " << pushed.sent << " sent\n";
}

}  // namespace qtet

#include "simplify/remote/http_client.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <memory>

#include "proto/version.h"

namespace qtet {
namespace {

using Clock = std::chrono::steady_clock;

/// The limit of an answer: a mesh's description with thousands of levels takes some 100 KB.
constexpr std::size_t kMaxAnswerBytes = 4u << 20;
/// Seconds after which the system is asked whether a silent peer is still there: a server that
/// checks a log says nothing for minutes.
constexpr long kKeepAliveSeconds = 30;
/// A proxy sends http to https, and a name to another: two hops, and some to spare.
constexpr long kMaxRedirections = 5;

template <auto function>
struct Release {
  template <class T>
  void operator()(T* it) const {
    function(it);
  }
};
using Handle = std::unique_ptr<CURL, Release<curl_easy_cleanup>>;
using Lines = std::unique_ptr<curl_slist, Release<curl_slist_free_all>>;
using ParsedUrl = std::unique_ptr<CURLU, Release<curl_url_cleanup>>;

/// The state that the callbacks of one transfer share.
struct Transfer {
  CURL* handle;
  const HttpRequest& request;
  HttpAnswer answer{};
  std::size_t takenBytes = 0;  ///< of the body, by libcurl
  curl_off_t movedBytes = 0;   ///< both ways, at movedAt
  Clock::time_point movedAt = Clock::now();
  const char* trouble = nullptr;  ///< why a callback ended the transfer
  std::array<char, CURL_ERROR_SIZE> reason{};
};

std::size_t takeBody(char* to, std::size_t size, std::size_t count, void* with) {
  auto& transfer = *static_cast<Transfer*>(with);
  const ByteView rest = transfer.request.body.subspan(transfer.takenBytes);
  const std::size_t bytes = std::min(size * count, rest.size());
  std::copy_n(rest.data(), bytes, to);
  transfer.takenBytes += bytes;
  return bytes;
}

int rewindBody(void* with, curl_off_t offset, int origin) {
  auto& transfer = *static_cast<Transfer*>(with);
  const bool inside =
      offset >= 0 && static_cast<std::uint64_t>(offset) <= transfer.request.body.size();
  if (origin != SEEK_SET || !inside) return CURL_SEEKFUNC_FAIL;
  transfer.takenBytes = static_cast<std::size_t>(offset);
  return CURL_SEEKFUNC_OK;
}

std::size_t keepAnswer(char* from, std::size_t size, std::size_t count, void* with) {
  auto& transfer = *static_cast<Transfer*>(with);
  const std::size_t bytes = size * count;
  if (transfer.answer.body.size() + bytes > kMaxAnswerBytes) {
    transfer.trouble = "the server's answer does not end";
    return 0;
  }
  transfer.answer.body.append(from, bytes);
  return bytes;
}

/// Called by libcurl once a second, and whenever bytes move; not 0 ends the transfer.
int watch(void* with, curl_off_t, curl_off_t received, curl_off_t, curl_off_t sent) {
  auto& transfer = *static_cast<Transfer*>(with);
  const HttpRequest& request = transfer.request;
  const auto now = Clock::now();
  curl_off_t connected = 0;  // microseconds until it was
  curl_easy_getinfo(transfer.handle, CURLINFO_PRETRANSFER_TIME_T, &connected);
  const bool moved = received + sent != transfer.movedBytes;
  if (moved && request.progress) request.progress(static_cast<std::uint64_t>(sent));
  if (moved || connected == 0) {
    transfer.movedBytes = received + sent;
    transfer.movedAt = now;
    return 0;
  }
  const bool allSent = static_cast<std::uint64_t>(sent) >= request.body.size();
  if (allSent && request.waiting) request.waiting();
  if (now - transfer.movedAt < (allSent ? request.patience.answering : request.patience.moving))
    return 0;
  transfer.trouble = allSent ? "the server does not answer" : "the server takes nothing any more";
  return 1;
}

/// Sets options one by one and keeps the first error.
struct Options {
  CURL* handle;
  CURLcode code = CURLE_OK;

  template <class T>
  void set(CURLoption option, T value) {
    if (code == CURLE_OK) code = curl_easy_setopt(handle, option, value);
  }
};

/// Sets the rules of every request: which protocols, whom to trust, how long to wait.
void setRules(Options& options, const HttpUrl& server, const HttpRequest& request) {
  const bool secure = server.origin.starts_with("https:");
  options.set(CURLOPT_NOSIGNAL, 1L);
  options.set(CURLOPT_USERAGENT, ("qtet/" + version()).c_str());
  options.set(CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
  options.set(CURLOPT_PROTOCOLS_STR, "http,https");
  options.set(CURLOPT_REDIR_PROTOCOLS_STR, secure ? "https" : "http,https");
  options.set(CURLOPT_FOLLOWLOCATION, request.method == "GET" ? 1L : 0L);
  options.set(CURLOPT_MAXREDIRS, kMaxRedirections);
  options.set(CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2));
  if (!request.authorities.empty()) {
    options.set(CURLOPT_CAINFO, request.authorities.c_str());
    options.set(CURLOPT_CAPATH, static_cast<const char*>(nullptr));
  }
  // A proxy would read the token of a plain request; of https it sees the host alone.
  if (!secure) options.set(CURLOPT_PROXY, "");
  options.set(CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(request.patience.connecting.count()));
  options.set(CURLOPT_TCP_KEEPALIVE, 1L);
  options.set(CURLOPT_TCP_KEEPIDLE, kKeepAliveSeconds);
  options.set(CURLOPT_TCP_KEEPINTVL, kKeepAliveSeconds);
}

void setCallbacks(Options& options, Transfer& transfer) {
  options.set(CURLOPT_ERRORBUFFER, transfer.reason.data());
  options.set(CURLOPT_WRITEFUNCTION, &keepAnswer);
  options.set(CURLOPT_WRITEDATA, &transfer);
  options.set(CURLOPT_NOPROGRESS, 0L);
  options.set(CURLOPT_XFERINFOFUNCTION, &watch);
  options.set(CURLOPT_XFERINFODATA, &transfer);
  if (transfer.request.method != "PUT") return;
  options.set(CURLOPT_UPLOAD, 1L);
  options.set(CURLOPT_INFILESIZE_LARGE, static_cast<curl_off_t>(transfer.request.body.size()));
  options.set(CURLOPT_READFUNCTION, &takeBody);
  options.set(CURLOPT_READDATA, &transfer);
  options.set(CURLOPT_SEEKFUNCTION, &rewindBody);
  options.set(CURLOPT_SEEKDATA, &transfer);
}

Lines linesOf(const std::vector<std::string>& headers) {
  Lines out;
  for (const std::string& header : headers)
    if (curl_slist* longer = curl_slist_append(out.get(), header.c_str()); longer != nullptr) {
      (void)out.release();
      out.reset(longer);
    }
  return out;
}

Error errorOf(CURLcode code, const HttpUrl& server, const Transfer& transfer) {
  const bool told = transfer.reason.front() != '\0';
  const std::string reason = told ? transfer.reason.data() : curl_easy_strerror(code);
  const auto with = [](ErrorCode kind, const std::string& text) {
    return Error{kind, text, Error::kNoOffset};
  };
  if (transfer.trouble != nullptr) return with(ErrorCode::kIo, transfer.trouble);
  switch (code) {
    case CURLE_PEER_FAILED_VERIFICATION:
      return with(ErrorCode::kBadValue, "the certificate of " + server.origin + " does not hold (" +
                                            reason +
                                            "); renew it, or name the file of its "
                                            "authority with --cacert");
    case CURLE_SSL_CACERT_BADFILE: return with(ErrorCode::kNotFound, "no certificates: " + reason);
    case CURLE_WEIRD_SERVER_REPLY:
    case CURLE_UNSUPPORTED_PROTOCOL:
      return with(ErrorCode::kBadValue,
                  "what answers at " + server.origin + " does not speak HTTP (" + reason + ")");
    case CURLE_TOO_MANY_REDIRECTS: return with(ErrorCode::kBadValue, server.origin + ": " + reason);
    case CURLE_GOT_NOTHING: return with(ErrorCode::kIo, "the server closed without an answer");
    default: return with(ErrorCode::kIo, server.origin + ": " + reason);
  }
}

}  // namespace

Result<HttpUrl> parseHttpUrl(const std::string& text) {
  const ParsedUrl url(curl_url());
  const auto wrong = [&](const std::string& why) {
    return fail(ErrorCode::kBadValue,
                "'" + text + "' is no address like https://host:8080/v1/meshes/name: " + why);
  };
  const auto partOf = [&](CURLUPart part) {
    char* found = nullptr;
    const bool has = curl_url_get(url.get(), part, &found, 0) == CURLUE_OK;
    const std::unique_ptr<char, Release<curl_free>> owner(found);
    return std::string(has ? found : "");
  };
  if (const CURLUcode code =
          curl_url_set(url.get(), CURLUPART_URL, text.c_str(), CURLU_DISALLOW_USER);
      code != CURLUE_OK)
    return wrong(curl_url_strerror(code));
  if (const std::string scheme = partOf(CURLUPART_SCHEME); scheme != "http" && scheme != "https")
    return wrong("it is " + scheme);
  if (text.find_first_of("?#") != std::string::npos) return wrong("it has a query or a fragment");
  HttpUrl out{.origin = "", .path = partOf(CURLUPART_PATH)};
  if (!std::ranges::all_of(out.path, [](char c) { return c > ' ' && c < 0x7F; }))
    return wrong("it has characters that want to be written as %XX");
  curl_url_set(url.get(), CURLUPART_PATH, nullptr, 0);
  out.origin = partOf(CURLUPART_URL);
  if (out.origin.ends_with('/')) out.origin.pop_back();
  return out;
}

std::string encodedSegment(const std::string& text) {
  const std::unique_ptr<char, Release<curl_free>> out(
      curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())));
  return out ? out.get() : "";
}

Result<HttpAnswer> exchange(const HttpUrl& server, const HttpRequest& request) {
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  const Handle handle(ready == CURLE_OK ? curl_easy_init() : nullptr);
  if (!handle) return fail(ErrorCode::kIo, "libcurl does not start");
  Transfer transfer{.handle = handle.get(), .request = request};
  const Lines headers = linesOf(request.headers);
  const std::string url = server.origin + request.target;
  Options options{handle.get()};
  options.set(CURLOPT_URL, url.c_str());
  options.set(CURLOPT_HTTPHEADER, headers.get());
  setRules(options, server, request);
  setCallbacks(options, transfer);
  if (options.code == CURLE_OK) options.code = curl_easy_perform(handle.get());
  if (options.code != CURLE_OK) return std::unexpected(errorOf(options.code, server, transfer));
  long status = 0;
  const char* location = nullptr;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
  curl_easy_getinfo(handle.get(), CURLINFO_REDIRECT_URL, &location);
  transfer.answer.status = static_cast<unsigned>(status);
  if (location != nullptr) transfer.answer.location = location;
  curl_header* etag = nullptr;
  if (curl_easy_header(handle.get(), "ETag", 0, CURLH_HEADER, -1, &etag) == CURLHE_OK)
    transfer.answer.etag = etag->value;
  return std::move(transfer.answer);
}

}  // namespace qtet

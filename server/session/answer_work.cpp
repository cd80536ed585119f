#include "server/session/answer_work.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/async_result.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <expected>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "server/http/client_watch.h"
#include "server/http/http_resource.h"
#include "server/http/level_wait.h"
#include "server/http/unwritable_level.h"
#include "server/http/upload_limits.h"
#include "server/routes/access_routes.h"
#include "server/session/http_output.h"
#include "server/store/level_memory.h"
#include "server/wire/connection_limits.h"
#include "server/wire/http_limits.h"

namespace qtet {
namespace {

namespace asio = boost::asio;
using asio::use_awaitable;

constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

Reply clientGone(Reply reply = {}) {
  reply.status = kClientGone;
  return reply;
}

Reply refusedLevel(LevelRefusal refusal) {
  if (refusal != LevelRefusal::kAddress)
    return noPlaceReply("too many levels are being made; try again");
  Reply out = problem(429, "too-many-requests",
                      "as many levels are being made for this address as may be; try again");
  out.refusal = Refusal::kPlaces;
  out.headers.add("Retry-After", std::to_string(limits::kRetryAfterSeconds));
  return out;
}

Reply failedLevel(const Error& error) {
  if (error.code == ErrorCode::kNotFound) return problem(404, "not-found", error.message);
  if (error.code == ErrorCode::kBadInput) return unwritableLevel(error);
  const std::string why = error.code == ErrorCode::kIo
                              ? "the level cannot be made: "
                              : "this log cannot be decoded, though its checksums hold; qtet "
                                "verify says the same, and it has to be written again: ";
  return problem(500, "internal", why + error.text());
}

/// 413 where making the level would take more memory than there is for it.
std::optional<Reply> tooLarge(const LevelRequest& level, std::uint64_t most) {
  const std::uint64_t needed = memoryOf(level);
  if (needed <= most) return std::nullopt;
  return problem(413, "content-too-large",
                 "making this takes " + std::to_string(needed) +
                     " bytes of memory, more than the " + std::to_string(most) +
                     " that this server has for it (its option --max-level-bytes); choose time= or "
                     "fields=, or a coarser level");
}

/// The level's bytes behind `head`, or the range of them that is asked for.
asio::awaitable<Reply> makeReply(Reply head, const LevelRequest& level, const RequestView& request,
                                 Peer& peer, const Services& services) {
  LevelJobs& jobs = level.point ? services.pointJobs : services.jobs;
  KeptAnswer answer = jobs.find(level);
  const bool isKept = !answer && jobs.keeps(level);
  if (!answer && !isKept && head.sendBody)
    if (std::optional<Reply> refusal = tooLarge(level, services.maxLevelBytes))
      co_return std::move(*refusal);
  if (!answer && (head.sendBody || isKept)) {
    LevelAnswer answered = co_await waitForLevel(peer.socket, jobs, level, peer.address());
    if (const auto* refusal = std::get_if<LevelRefusal>(&answered))
      co_return *refusal == LevelRefusal::kGone ? clientGone(std::move(head))
                                                : refusedLevel(*refusal);
    answer = std::move(std::get<Result<LevelFile>>(answered));
    if (!*answer && answer->error().code != ErrorCode::kNotFound &&
        answer->error().code != ErrorCode::kBadInput)
      spdlog::error("{}: level {} cannot be made: {}", level.mesh->id, level.level,
                    answer->error().text());
  }
  if (!answer) co_return head;
  const bool sendBody = head.sendBody;
  if (!*answer) {
    Reply failed = failedLevel(answer->error());
    failed.sendBody = sendBody;
    co_return failed;
  }
  const LevelFile& file = **answer;
  Reply out = rangeReply(request, std::move(head), file.bytes, file.owner);
  out.sendBody = sendBody;
  co_return out;
}

/// The result of `work`, which may wait for the disk.
/// `work` captures references alone: GCC 12 destroys a temporary closure in the operand of co_await
/// twice.
template <class Outcome, class Work>
  requires std::is_trivially_destructible_v<Work>
asio::awaitable<Outcome> runOn(const Workers& workers, Work work) {
  auto start = [&workers, &work, executor = co_await asio::this_coro::executor](auto handler) {
    workers([&work, executor, handler = std::move(handler)]() mutable {
      Outcome outcome = work();
      asio::post(executor, [handler = std::move(handler), outcome = std::move(outcome)]() mutable {
        handler(std::move(outcome));
      });
    });
  };
  co_return co_await asio::async_initiate<const asio::use_awaitable_t<>, void(Outcome)>(
      std::move(start), use_awaitable);
}

/// Fills `piece`, of which each limits::kBodyPiece has its time to arrive. Returns the bytes that
/// came: fewer if the rest did not come in time.
asio::awaitable<std::size_t> readPiece(HttpInput& input, std::span<std::uint8_t> piece) {
  std::size_t have = 0;
  while (have < piece.size()) {
    const auto next = piece.subspan(have, std::min(piece.size() - have, limits::kBodyPiece));
    const std::size_t count = co_await input.readBody(next);
    have += count;
    if (count < next.size()) break;
  }
  co_return have;
}

/// Reads the body into the upload; the answer, if it ends before its time.
asio::awaitable<std::optional<Reply>> receiveBody(HttpInput& input, Upload& upload,
                                                  std::uint64_t bytes, const Peer& peer,
                                                  const Services& services) {
  Bytes piece(std::min<std::uint64_t>(bytes, limits::kUploadPiece));
  while (bytes > 0) {
    const std::size_t wanted = std::min<std::uint64_t>(bytes, piece.size());
    const std::size_t have = co_await readPiece(input, std::span(piece).first(wanted));
    ByteView rest = ByteView(piece).first(have);
    const auto append = [&] { return upload.append(std::exchange(rest, {})); };
    if (auto trouble = co_await runOn<std::optional<Reply>>(services.writers, append))
      co_return trouble;
    while (upload.isBusy()) {
      if (peer.connection->ending())
        co_return busyReply("the server ends; go on with the next one");
      if (auto trouble = co_await runOn<std::optional<Reply>>(services.writers, append))
        co_return trouble;
    }
    if (have < wanted)
      co_return problem(408, "request-timeout",
                        "the request's body did not arrive, or not in time");
    bytes -= have;
  }
  co_return std::nullopt;
}

/// Has the log checked and published. kClientGone: the check was broken off.
asio::awaitable<Reply> finish(Upload& upload, ClientSocket& socket, const Services& services) {
  std::stop_source stop;
  // while it is, the coroutine waits here, and with it the socket
  const auto pending = std::make_shared<bool>(true);
  watchForEnd(socket, [pending] { return *pending; }, [&stop] { stop.request_stop(); });
  Reply out =
      co_await runOn<Reply>(services.checkers, [&] { return upload.finish(stop.get_token()); });
  *pending = false;
  socket.cancel();  // the watch, if it still stands
  co_return stop.stop_requested() ? clientGone() : std::move(out);
}

asio::awaitable<std::optional<Reply>> takeUpload(const UploadRequest& upload, bool awaitsContinue,
                                                 Peer& peer, HttpInput& input,
                                                 const Services& services) {
  using Begun = std::expected<std::unique_ptr<Upload>, Reply>;
  const auto begin = [&] { return services.uploads->begin(upload); };
  Begun begun = co_await runOn<Begun>(services.writers, begin);
  if (!begun) {
    begun.error().close = true;  // the body is not read
    co_return std::move(begun.error());
  }
  if (awaitsContinue) {
    const Sent sent = co_await sendReply(peer.socket, {.head = kContinue}, services.timeouts.write,
                                         services.unpaced);
    if (!sent.whole) co_return std::nullopt;
  }
  std::optional<Reply> out = co_await receiveBody(input, **begun, upload.bodyBytes, peer, services);
  if (out)
    out->close = true;  // some of the body may still come
  else
    out = (*begun)->partial();
  if (!out) out = co_await finish(**begun, peer.socket, services);
  begun->reset();  // its place is free before the client hears of the end
  co_return out;
}

asio::awaitable<Reply> describe(const TextRequest& wanted, bool sendBody,
                                const RequestView& request, const Services& services) {
  const auto make = [&] { return &wanted.mesh->text(wanted.which); };
  const Document* const text = co_await runOn<const Document*>(services.describers, make);
  Reply out = documentReply(request, *text, wanted.mesh);
  if (wanted.isPrivate) keepPrivate(out);
  out.sendBody = sendBody;
  co_return out;
}

}  // namespace

asio::awaitable<std::optional<Reply>> workOn(Answer answer, const RequestView& request, Peer& peer,
                                             HttpInput& input, const Services& services) {
  std::optional<Reply> out;
  if (const auto* level = std::get_if<LevelRequest>(&answer.work)) {
    out = co_await makeReply(std::move(answer.reply), *level, request, peer, services);
  } else if (const auto* upload = std::get_if<UploadRequest>(&answer.work)) {
    if (upload->kind == UploadRequest::Kind::kDelete)
      out = co_await runOn<Reply>(services.writers,
                                  [&] { return services.uploads->remove(*upload); });
    else
      out = co_await takeUpload(*upload, request.expect.has_value(), peer, input, services);
  } else if (const auto* text = std::get_if<TextRequest>(&answer.work)) {
    out = co_await describe(*text, answer.reply.sendBody, request, services);
  } else {
    out = std::move(answer.reply);
  }
  co_return out;
}

}  // namespace qtet

#include "server/stream/stream_report.h"

#include <cassert>
#include <utility>

namespace qtet {

StreamReport::StreamReport(Metrics& metrics, AccessLog* log, StreamRequest request,
                           Clock::time_point now)
    : metrics_(metrics), log_(log), request_(std::move(request)), begun_(now) {
  metrics_.beginStream();
}

StreamReport::~StreamReport() {
  metrics_.endStream();
  if (log_ == nullptr) return;
  entry_.mesh = mesh_;
  entry_.end = why_.empty() ? std::string_view("client-gone") : why_;
  entry_.time = Clock::now() - begun_;
  log_->write(entry_, request_.client, request_.target, request_.trace);
}

void StreamReport::opened(std::string_view mesh, Clock::time_point now) {
  mesh_ = mesh;
  awaited_ = now;
  lacking_ = false;
  ++entry_.opens;
}

void StreamReport::took(std::size_t bytes) {
  entry_.bytes += bytes;
  metrics_.countStreamBytes(bytes);
}

void StreamReport::wroteFrames(std::size_t frames, Clock::time_point now) {
  if (frames == 0) return;
  entry_.frames += frames;
  lacking_ = false;
  if (!awaited_) return;
  const Clock::duration waited = now - *std::exchange(awaited_, std::nullopt);
  if (!entry_.firstFrame) entry_.firstFrame = waited;
  metrics_.countFirstFrame(waited);
}

void StreamReport::stalled(Clock::duration time) {
  assert(time >= Clock::duration());
  entry_.stalled += time;
  metrics_.countStreamStall(time);
}

void StreamReport::lacksCredit() {
  if (std::exchange(lacking_, true)) return;
  ++entry_.creditWaits;
  metrics_.countCreditWait();
}

}  // namespace qtet

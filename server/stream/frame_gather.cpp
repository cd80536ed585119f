#include "server/stream/frame_gather.h"

#include <cassert>
#include <span>

#include "server/stream/stream_limits.h"

namespace qtet {

void FrameGather::consume(std::size_t bytes) {
  while (!parts_.empty() && bytes >= parts_.front().bytes.size()) {
    bytes -= parts_.front().bytes.size();
    parts_.pop_front();
  }
  if (bytes == 0) return;
  assert(!parts_.empty());  // nobody takes more than there is
  parts_.front().bytes += bytes;
  parts_.front().file.offset += bytes;
}

std::size_t FrameGather::write(ClientSocket& socket, boost::system::error_code& ec) {
  assert(!written());
  const Part& first = parts_.front();
  std::size_t count = 0;
  if (first.inFile() && !socket.isTls()) {
    count = socket.writeFile(
        first.file, {static_cast<const std::uint8_t*>(first.bytes.data()), first.bytes.size()}, ec);
  } else {
    std::array<iovec, 2 * limits::kFramesPerWrite> vectors;
    std::size_t used = 0;
    for (const Part& part : parts_) {
      if (part.inFile() && !socket.isTls()) break;
      vectors[used++] = {const_cast<void*>(part.bytes.data()), part.bytes.size()};
    }
    count = socket.write(std::span(vectors).first(used), used < parts_.size(), ec);
  }
  consume(count);
  return count;
}

}  // namespace qtet

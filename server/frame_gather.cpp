#include "server/frame_gather.h"

#include <sys/sendfile.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <cerrno>

namespace qtet {

void FrameGather::consume(std::size_t bytes) {
  while (!parts_.empty() && bytes >= parts_.front().bytes.size()) {
    bytes -= parts_.front().bytes.size();
    parts_.pop_front();
  }
  if (bytes == 0) return;
  parts_.front().bytes += bytes;
  parts_.front().file.offset += bytes;
}

std::size_t FrameGather::write(boost::asio::ip::tcp::socket& socket, boost::system::error_code& ec) {
  const Part& first = parts_.front();
  ssize_t count = 0;
  if (first.inFile()) {
    auto offset = static_cast<off_t>(first.file.offset);
    count = ::sendfile(socket.native_handle(), first.file.descriptor, &offset, first.bytes.size());
  } else {
    std::array<iovec, 2 * limits::kFramesPerWrite> vectors;
    std::size_t used = 0;
    for (const Part& part : parts_) {
      if (part.inFile()) break;
      vectors[used++] = {const_cast<void*>(part.bytes.data()), part.bytes.size()};
    }
    msghdr message{};
    message.msg_iov = vectors.data();
    message.msg_iovlen = used;
    count = ::sendmsg(socket.native_handle(), &message, MSG_NOSIGNAL | (used < parts_.size() ? MSG_MORE : 0));
  }
  if (count > 0) return consume(static_cast<std::size_t>(count)), static_cast<std::size_t>(count);
  // Nothing at all: the file has become shorter.
  const int why = count == 0 ? EIO : errno;
  if (why == EAGAIN) {
    ec = boost::asio::error::would_block;
  } else if (why != EINTR) {
    ec = {why, boost::system::system_category()};
  }
  return 0;
}

}  // namespace qtet

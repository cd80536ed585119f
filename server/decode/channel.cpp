#include "server/decode/channel.h"

#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace qtet {
namespace {

constexpr std::size_t kLengthBytes = 4;

std::unexpected<Error> lost(int number) {
  return fail(ErrorCode::kIo,
              number == 0 ? "the other process has ended"
                          : std::string("the other process is lost: ") + std::strerror(number));
}

/// Room for the descriptors of a message, as the kernel wants it.
struct Control {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(limits::kMaxDecodeFiles * sizeof(int))> room{};
};

/// Sends what fits; the files go with the first byte.
ssize_t sendSome(int end, ByteView bytes, std::span<const int> files) {
  iovec piece{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  msghdr message{};
  message.msg_iov = &piece, message.msg_iovlen = 1;
  Control control;
  if (!files.empty()) {
    message.msg_control = control.room.data();
    message.msg_controllen = CMSG_SPACE(files.size_bytes());
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET, header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(files.size_bytes());
    std::memcpy(CMSG_DATA(header), files.data(), files.size_bytes());
  }
  return ::sendmsg(end, &message, MSG_NOSIGNAL);
}

/// Receives what is there. False: there was not enough room for the files.
bool receiveSome(int end, std::span<std::uint8_t> into, DecodeMessage& out, ssize_t& count) {
  iovec piece{into.data(), into.size()};
  Control control;
  msghdr message{};
  message.msg_iov = &piece, message.msg_iovlen = 1;
  message.msg_control = control.room.data(), message.msg_controllen = control.room.size();
  count = ::recvmsg(end, &message, MSG_CMSG_CLOEXEC);
  if (count < 0) return true;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= header->cmsg_len; at += sizeof(int)) {
      int file = -1;
      std::memcpy(&file, CMSG_DATA(header) + (at - CMSG_LEN(0)), sizeof file);
      out.files.push_back(std::make_unique<Descriptor>(file));
    }
  }
  return (message.msg_flags & MSG_CTRUNC) == 0 && out.files.size() <= limits::kMaxDecodeFiles;
}

Status receiveAll(int end, std::span<std::uint8_t> into, DecodeMessage& out) {
  while (!into.empty()) {
    ssize_t count = 0;
    if (!receiveSome(end, into, out, count))
      return fail(ErrorCode::kLimitExceeded, "too many files came with a message");
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return lost(count == 0 ? 0 : errno);
    into = into.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

}  // namespace

Result<std::array<std::unique_ptr<Descriptor>, 2>> connectedEnds() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(ErrorCode::kIo,
                std::string("there is no pair of sockets: ") + std::strerror(errno));
  return std::array{std::make_unique<Descriptor>(ends[0]), std::make_unique<Descriptor>(ends[1])};
}

void Channel::setPatience(std::chrono::seconds most) const {
  const timeval time{most.count(), 0};
  for (const int direction : {SO_RCVTIMEO, SO_SNDTIMEO})
    (void)::setsockopt(end_->number, SOL_SOCKET, direction, &time, sizeof time);
}

Status Channel::send(ByteView bytes, std::span<const int> files) const {
  assert(bytes.size() <= limits::kMaxDecodeMessage && files.size() <= limits::kMaxDecodeFiles);
  ByteWriter length;
  length.write(static_cast<std::uint32_t>(bytes.size()));
  for (ByteView rest : {ByteView(length.bytes()), bytes})
    while (!rest.empty()) {
      const ssize_t count = sendSome(end_->number, rest, files);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return lost(errno);
      files = {};
      rest = rest.subspan(static_cast<std::size_t>(count));
    }
  return {};
}

Result<DecodeMessage> Channel::receive() const {
  DecodeMessage out;
  std::array<std::uint8_t, kLengthBytes> length{};
  if (Status s = receiveAll(end_->number, length, out); !s) return std::unexpected(s.error());
  const std::uint32_t bytes = loadLittle(length.data());
  if (bytes > limits::kMaxDecodeMessage)
    return fail(ErrorCode::kLimitExceeded, "a message is too long");
  out.bytes.resize(bytes);
  if (Status s = receiveAll(end_->number, out.bytes, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace qtet

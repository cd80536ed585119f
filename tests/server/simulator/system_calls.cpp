// The system calls of the server, Asio's included, and its clocks. The linker's --wrap leads them
// here; a call for another descriptor goes on to the machine.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <vector>

#include "tests/server/simulator/kernel.h"

namespace {

using qtet::simulator::Kernel;
using qtet::simulator::kOwn;
using qtet::simulator::MemoryOf;
using qtet::simulator::Socket;

/// The simulation begins then, and not when it runs: 2026-01-01.
constexpr std::chrono::seconds kBeginning{1'767'225'600};
bool isOurs(int descriptor) {
  return Kernel::inForce != nullptr && descriptor >= Kernel::kFirstDescriptor;
}

template <class Number>
Number said(Number result) {
  if (result >= 0) return result;
  errno = static_cast<int>(-result);
  return -1;
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the linker's names
extern "C" {

int __real_epoll_create1(int flags);
int __real_epoll_ctl(int epoll, int operation, int descriptor, epoll_event* event);
int __real_epoll_wait(int epoll, epoll_event* events, int count, int milliseconds);
int __real_timerfd_create(int clock, int flags);
int __real_close(int descriptor);
ssize_t __real_recv(int descriptor, void* into, size_t count, int flags);
ssize_t __real_sendmsg(int descriptor, const msghdr* message, int flags);
ssize_t __real_sendfile(int to, int from, off_t* offset, size_t count);
int __real_setsockopt(int descriptor, int level, int name, const void* value, socklen_t size);
int __real_getsockopt(int descriptor, int level, int name, void* value, socklen_t* size);
int __real_getpeername(int descriptor, sockaddr* address, socklen_t* size);
int __real_shutdown(int descriptor, int how);
int __real_ioctl(int descriptor, unsigned long request, void* argument);
int __real_clock_gettime(clockid_t clock, timespec* time);
time_t __real_time(time_t* time);
// a time_point is returned as its one number is
std::int64_t __real__ZNSt6chrono3_V212steady_clock3nowEv();
std::int64_t __real__ZNSt6chrono3_V212system_clock3nowEv();

int __wrap_epoll_create1(int flags) {
  return Kernel::inForce != nullptr ? Kernel::kFirstDescriptor : __real_epoll_create1(flags);
}
int __wrap_epoll_ctl(int epoll, int operation, int descriptor, epoll_event* event) {
  return isOurs(epoll) ? said(Kernel::inForce->watch(operation, descriptor, event))
                       : __real_epoll_ctl(epoll, operation, descriptor, event);
}
int __wrap_epoll_wait(int epoll, epoll_event* events, int count, int milliseconds) {
  return isOurs(epoll)
             ? said(Kernel::inForce->poll({events, static_cast<std::size_t>(count)}, milliseconds))
             : __real_epoll_wait(epoll, events, count, milliseconds);
}
/// Without timerfd Asio gives its next timer to epoll_wait.
int __wrap_timerfd_create(int clock, int flags) {
  return Kernel::inForce != nullptr ? said(-ENOSYS) : __real_timerfd_create(clock, flags);
}
int __wrap_close(int descriptor) {
  if (!isOurs(descriptor)) return __real_close(descriptor);
  return descriptor == Kernel::kFirstDescriptor ? 0 : said(Kernel::inForce->close(descriptor));
}
ssize_t __wrap_recv(int descriptor, void* into, size_t count, int flags) {
  return isOurs(descriptor)
             ? said(Kernel::inForce->receive(descriptor, {static_cast<char*>(into), count},
                                             (flags & MSG_PEEK) != 0))
             : __real_recv(descriptor, into, count, flags);
}
/// The compiler calls it for recv with _FORTIFY_SOURCE.
ssize_t __wrap___recv_chk(int descriptor, void* into, size_t count, size_t /*room*/, int flags) {
  return __wrap_recv(descriptor, into, count, flags);
}
ssize_t __wrap_sendmsg(int descriptor, const msghdr* message, int flags) {
  return isOurs(descriptor)
             ? said(Kernel::inForce->sendAll(descriptor, {message->msg_iov, message->msg_iovlen}))
             : __real_sendmsg(descriptor, message, flags);
}
ssize_t __wrap_sendfile(int to, int from, off_t* offset, size_t count) {
  if (!isOurs(to)) return __real_sendfile(to, from, offset, count);
  const MemoryOf own(kOwn);
  const Socket* const socket = Kernel::inForce->find(to);
  if (socket == nullptr) return said<ssize_t>(-EBADF);
  std::vector<char> bytes(std::min(count, std::max<size_t>(Kernel::roomOf(*socket), 1)));
  const ssize_t read = ::pread(from, bytes.data(), bytes.size(), *offset);
  const ssize_t out =
      read <= 0 ? read
                : said(Kernel::inForce->sendBytes(to, {bytes.data(), static_cast<size_t>(read)}));
  if (out > 0) *offset += out;
  return out;
}
int __wrap_setsockopt(int descriptor, int level, int name, const void* value, socklen_t size) {
  if (!isOurs(descriptor)) return __real_setsockopt(descriptor, level, name, value, size);
  Socket* const socket = Kernel::inForce->find(descriptor);
  if (socket == nullptr) return said(-EBADF);
  if (level == IPPROTO_TCP && name == TCP_NOTSENT_LOWAT)
    socket->maxUnsent = static_cast<std::size_t>(*static_cast<const int*>(value));
  return 0;
}
int __wrap_getsockopt(int descriptor, int level, int name, void* value, socklen_t* size) {
  if (!isOurs(descriptor)) return __real_getsockopt(descriptor, level, name, value, size);
  const Socket* const socket = Kernel::inForce->find(descriptor);
  if (socket == nullptr) return said(-EBADF);
  if (level != IPPROTO_TCP || name != TCP_INFO || !Kernel::inForce->hasFigures())
    return said(-ENOPROTOOPT);
  constexpr std::uint32_t kPacket = 1448;
  tcp_info info{};
  info.tcpi_bytes_acked = socket->acknowledged;
  info.tcpi_snd_mss = kPacket;
  info.tcpi_unacked = static_cast<std::uint32_t>((socket->underWay + kPacket - 1) / kPacket);
  info.tcpi_notsent_bytes = static_cast<std::uint32_t>(socket->unsent.size());
  const auto trip = 2 * socket->line.latency;
  const auto queue = std::max(socket->lineFree - Kernel::inForce->now(), trip * 0);
  const auto microseconds = [](auto time) {
    return static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(time).count());
  };
  info.tcpi_rtt = microseconds(trip + queue);
  info.tcpi_min_rtt = microseconds(trip);
  *size = std::min<socklen_t>(*size, sizeof(info));
  std::memcpy(value, &info, *size);
  return 0;
}
int __wrap_getpeername(int descriptor, sockaddr* address, socklen_t* size) {
  if (!isOurs(descriptor)) return __real_getpeername(descriptor, address, size);
  const Socket* const socket = Kernel::inForce->find(descriptor);
  if (socket == nullptr || socket->lost) return said(socket == nullptr ? -EBADF : -ENOTCONN);
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_addr.s_addr = htonl(socket->address);
  *size = std::min<socklen_t>(*size, sizeof(out));
  std::memcpy(address, &out, *size);
  return 0;
}
int __wrap_shutdown(int descriptor, int how) {
  return isOurs(descriptor) ? said(Kernel::inForce->finishSending(descriptor))
                            : __real_shutdown(descriptor, how);
}
int __wrap_ioctl(int descriptor, unsigned long request, void* argument) {
  return isOurs(descriptor) ? 0 : __real_ioctl(descriptor, request, argument);
}
int __wrap_clock_gettime(clockid_t clock, timespec* time) {
  if (Kernel::inForce == nullptr) return __real_clock_gettime(clock, time);
  const auto now =
      Kernel::inForce->look() + (clock == CLOCK_REALTIME ? kBeginning : kBeginning * 0);
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now);
  *time = {seconds.count(), (now - seconds).count()};
  return 0;
}
time_t __wrap_time(time_t* time) {
  if (Kernel::inForce == nullptr) return __real_time(time);
  const time_t out =
      std::chrono::duration_cast<std::chrono::seconds>(kBeginning + Kernel::inForce->look())
          .count();
  if (time != nullptr) *time = out;
  return out;
}
std::int64_t __wrap__ZNSt6chrono3_V212steady_clock3nowEv() {
  return Kernel::inForce != nullptr ? (kBeginning + Kernel::inForce->look()).count()
                                    : __real__ZNSt6chrono3_V212steady_clock3nowEv();
}
std::int64_t __wrap__ZNSt6chrono3_V212system_clock3nowEv() {
  return Kernel::inForce != nullptr ? (kBeginning + Kernel::inForce->look()).count()
                                    : __real__ZNSt6chrono3_V212system_clock3nowEv();
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

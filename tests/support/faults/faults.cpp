// libqtet_faults.so, for LD_PRELOAD: lets a program's system calls fail as a FaultPlan says. It
// affects only sockets and regular files, not timers, events and pipes. Without a plan it does
// nothing.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "tests/support/faults/fault_plan.h"

namespace {

using qtet::test::Fault;
using qtet::test::FaultPlan;

/// Instead of an errno: the call is done, but for one byte only.
constexpr int kOneByte = -1;
constexpr std::size_t kErrors = 5;
constexpr std::array<std::array<int, kErrors>, qtet::test::kFaults> kPlausible = {{
    {kOneByte, ECONNRESET, EINTR, EAGAIN, ENOMEM},
    {kOneByte, EPIPE, EINTR, EAGAIN, ENOBUFS},
    {kOneByte, EIO, EINTR, EAGAIN, ENOMEM},
    {EMFILE, ECONNABORTED, ENFILE, ENOMEM, EINTR},
    {EMFILE, EIO, ENFILE, ENOMEM, EACCES},
    {ENOMEM, ENODEV, EAGAIN, ENFILE, ENOMEM},
    {EIO, EINTR, EIO, EINTR, EIO},
    {ENOSPC, kOneByte, EIO, EINTR, EDQUOT},
}};

/// By system calls of its own: what it would call is what it stands in front of.
FaultPlan* mapPlan() {
  const char* path = std::getenv("QTET_FAULTS");
  if (path == nullptr) return nullptr;
  const long file = ::syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC);
  if (file < 0) return nullptr;
  const long address =
      ::syscall(SYS_mmap, nullptr, sizeof(FaultPlan), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0L);
  ::syscall(SYS_close, file);
  return address < 0 ? nullptr : reinterpret_cast<FaultPlan*>(address);
}

FaultPlan* plan() {
  static FaultPlan* const mapped = mapPlan();
  return mapped;
}

/// The errno of this call, kOneByte, or 0: it is not its turn.
int faultOf(Fault fault) {
  if (plan() == nullptr) return 0;
  FaultPlan::Kind& kind = plan()->of(fault);
  const std::uint32_t every = kind.every.load(std::memory_order_relaxed);
  const std::uint32_t call = kind.calls.fetch_add(1, std::memory_order_relaxed) + 1;
  if (every == 0 || call % every != 0) return 0;
  const std::uint32_t turn = kind.failed.fetch_add(1, std::memory_order_relaxed);
  const int always = kind.error.load(std::memory_order_relaxed);
  return always != 0 ? always : kPlausible[static_cast<std::size_t>(fault)][turn % kErrors];
}

template <class F>
F* next(const char* name) {
  return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

/// Calls `real` with the bytes it may have, or fails.
template <class Real>
ssize_t transfer(int fault, std::size_t bytes, Real real) {
  if (fault > 0) return errno = fault, -1;
  return real(fault == kOneByte ? std::min<std::size_t>(bytes, 1) : bytes);
}

int kindOf(int file, Fault ofSocket, Fault ofFile) {
  struct stat info{};
  if (plan() == nullptr || ::fstat(file, &info) != 0) return 0;
  if (S_ISSOCK(info.st_mode)) return faultOf(ofSocket);
  return S_ISREG(info.st_mode) ? faultOf(ofFile) : 0;
}

/// Opens by `real`, or fails. `more`: what stands behind the flags.
int openOrFail(decltype(::open)* real, const char* path, int flags, va_list more) {
  const int fault = path != nullptr && path[0] == '/' ? faultOf(Fault::kOpen) : 0;
  return fault != 0 ? (errno = fault, -1) : real(path, flags, va_arg(more, mode_t));
}

}  // namespace

extern "C" {

ssize_t recv(int socket, void* into, size_t bytes, int flags) {
  static const auto real = next<decltype(recv)>("recv");
  return transfer(faultOf(Fault::kReceive), bytes,
                  [&](size_t n) { return real(socket, into, n, flags); });
}

ssize_t read(int file, void* into, size_t bytes) {
  static const auto real = next<decltype(read)>("read");
  return transfer(kindOf(file, Fault::kReceive, Fault::kReadFile), bytes,
                  [&](size_t n) { return real(file, into, n); });
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto real = next<decltype(sendmsg)>("sendmsg");
  const int fault = faultOf(Fault::kSend);
  if (fault > 0) return errno = fault, -1;
  if (fault == 0 || message->msg_iovlen == 0) return real(socket, message, flags);
  iovec byte = message->msg_iov[0];
  byte.iov_len = std::min<size_t>(byte.iov_len, 1);
  msghdr less = *message;
  less.msg_iov = &byte;
  less.msg_iovlen = 1;
  return real(socket, &less, flags);
}

ssize_t send(int socket, const void* bytes, size_t count, int flags) {
  static const auto real = next<decltype(send)>("send");
  return transfer(faultOf(Fault::kSend), count,
                  [&](size_t n) { return real(socket, bytes, n, flags); });
}

ssize_t write(int file, const void* bytes, size_t count) {
  static const auto real = next<decltype(write)>("write");
  return transfer(kindOf(file, Fault::kSend, Fault::kWriteFile), count,
                  [&](size_t n) { return real(file, bytes, n); });
}

/// The kernel's own copying of files is of the same kind.
ssize_t sendfile(int out, int in, off_t* offset, size_t bytes) {
  static const auto real = next<decltype(sendfile)>("sendfile");
  return transfer(faultOf(Fault::kSendFile), bytes,
                  [&](size_t n) { return real(out, in, offset, n); });
}

int accept(int socket, sockaddr* address, socklen_t* bytes) {
  static const auto real = next<decltype(accept)>("accept");
  const int fault = faultOf(Fault::kAccept);
  return fault != 0 ? (errno = fault, -1) : real(socket, address, bytes);
}

int open(const char* path, int flags, ...) {
  static const auto real = next<decltype(open)>("open");
  va_list more;
  va_start(more, flags);
  const int opened = openOrFail(real, path, flags, more);
  va_end(more);
  return opened;
}

int open64(const char* path, int flags, ...) {
  static const auto real = next<decltype(open64)>("open64");
  va_list more;
  va_start(more, flags);
  const int opened = openOrFail(real, path, flags, more);
  va_end(more);
  return opened;
}

void* mmap(void* address, size_t bytes, int protection, int flags, int file, off_t offset) {
  const int fault = file >= 0 ? faultOf(Fault::kMap) : 0;
  if (fault != 0) return errno = fault, MAP_FAILED;
  // By a system call: AddressSanitizer maps memory before it can bear dlsym, and waited for itself
  // for ever.
  return reinterpret_cast<void*>(
      ::syscall(SYS_mmap, address, bytes, protection, flags, file, offset));
}

int clock_gettime(clockid_t clock, timespec* time) {
  const auto done = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));  // as in mmap
  if (done == 0 && clock == CLOCK_REALTIME && plan() != nullptr)
    time->tv_sec += plan()->clockShift.load(std::memory_order_relaxed);
  return done;
}

}  // extern "C"

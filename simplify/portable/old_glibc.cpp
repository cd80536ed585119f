// Functions that a program would otherwise take from a newer C library than that of its users. In
// glibc 2.28 (PEP 600's manylinux_2_28) they are missing, or have an older version. The linker
// takes those here before it looks at the C library.
#include <dirent.h>
#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include "simplify/portable/first_version.h"

#ifndef __clang__
// g++ believes that what may be unset behind a pointer is read.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

// Defines a function as that of the same name and of the first version. It is hidden, so that the C
// library does not take it in place of its own.
#define QTET_AS_AT_FIRST(result, name, parameters, arguments)                    \
  result first_##name parameters;                                                \
  asm(".symver first_" #name ", " #name "@" QTET_FIRST_VERSION);                 \
  __attribute__((visibility("hidden"))) result our_##name parameters asm(#name); \
  result our_##name parameters { return first_##name arguments; }

// NOLINTBEGIN(readability-identifier-naming): the C library's names
extern "C" {

// Since 2.29 without the error handling of SVID; the numbers are the same since 2.28.
QTET_AS_AT_FIRST(double, exp, (double x), (x))
QTET_AS_AT_FIRST(double, log, (double x), (x))
QTET_AS_AT_FIRST(double, log2, (double x), (x))
QTET_AS_AT_FIRST(double, pow, (double x, double y), (x, y))

// Since 2.34 in libc.so.6, before in libdl.so.2 and libpthread.so.0.
QTET_AS_AT_FIRST(int, dladdr, (const void* at, Dl_info* info), (at, info))
QTET_AS_AT_FIRST(int, dlclose, (void* library), (library))
QTET_AS_AT_FIRST(char*, dlerror, (), ())
QTET_AS_AT_FIRST(void*, dlopen, (const char* file, int mode), (file, mode))
QTET_AS_AT_FIRST(void*, dlsym, (void* library, const char* name), (library, name))
QTET_AS_AT_FIRST(int, pthread_create,
                 (pthread_t * thread, const pthread_attr_t* how, void* (*run)(void*), void* with),
                 (thread, how, run, with))
QTET_AS_AT_FIRST(void*, pthread_getspecific, (pthread_key_t key), (key))
QTET_AS_AT_FIRST(int, pthread_join, (pthread_t thread, void** result), (thread, result))
QTET_AS_AT_FIRST(int, pthread_key_create, (pthread_key_t * key, void (*end)(void*)), (key, end))
QTET_AS_AT_FIRST(int, __pthread_key_create, (pthread_key_t * key, void (*end)(void*)), (key, end))
QTET_AS_AT_FIRST(int, pthread_once, (pthread_once_t * once, void (*run)()), (once, run))
QTET_AS_AT_FIRST(int, pthread_setspecific, (pthread_key_t key, const void* value), (key, value))

// Since 2.33 a function; before, the headers called another one.
int stat(const char* path, struct stat* out) {
  return static_cast<int>(::syscall(SYS_newfstatat, AT_FDCWD, path, out, 0));
}
int lstat(const char* path, struct stat* out) {
  return static_cast<int>(::syscall(SYS_newfstatat, AT_FDCWD, path, out, AT_SYMLINK_NOFOLLOW));
}
int fstat(int file, struct stat* out) { return static_cast<int>(::syscall(SYS_fstat, file, out)); }
int fstat64(int file, struct stat64* out) {
  return static_cast<int>(::syscall(SYS_fstat, file, out));
}

// Since 2.36. Expat asks for 8 bytes.
void arc4random_buf(void* buffer, std::size_t size) {
  for (auto* at = static_cast<char*>(buffer); size > 0;) {
    constexpr std::size_t kMaxAtOnce = 256;  // getentropy gives no more
    const std::size_t now = std::min(size, kMaxAtOnce);
    if (::getentropy(at, now) != 0) std::abort();
    at += now, size -= now;
  }
}

// Since 2.34. Linux before 5.9 does not know it, and old containers forbid what they do not know.
// Those that are open are closed then, as the kernel lists them: the limit may be a billion.
int close_range(unsigned first, unsigned last, int flags) {
  if (::syscall(SYS_close_range, first, last, flags) == 0) return 0;
  if (errno == EINVAL || flags != 0) return -1;
  DIR* const listed = ::opendir("/proc/self/fd");
  if (listed == nullptr) return -1;
  while (const dirent* const entry = ::readdir(listed)) {
    char* end = nullptr;
    const unsigned long file = std::strtoul(entry->d_name, &end, 10);
    const bool isOne = end != entry->d_name && *end == '\0';  // not `.` or `..`
    if (isOne && file >= first && file <= last && file != static_cast<unsigned>(::dirfd(listed)))
      ::close(static_cast<int>(file));
  }
  return ::closedir(listed);
}

// Since 2.30. Before, a wait was until a time of the day, which somebody may set.
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* until) {
  using Wait = int (*)(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
  static const auto theirs =
      reinterpret_cast<Wait>(our_dlsym(RTLD_DEFAULT, "pthread_cond_clockwait"));
  if (theirs != nullptr) return theirs(condition, mutex, clock, until);
  if (clock == CLOCK_REALTIME) return ::pthread_cond_timedwait(condition, mutex, until);
  timespec now{}, day{};
  ::clock_gettime(clock, &now);
  ::clock_gettime(CLOCK_REALTIME, &day);
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t seconds = std::int64_t{until->tv_sec} - now.tv_sec + day.tv_sec,
                     nanoseconds = std::int64_t{until->tv_nsec} - now.tv_nsec + day.tv_nsec;
  const std::int64_t more = nanoseconds >= 0 ? nanoseconds / kSecond : -1;
  const timespec at{seconds + more, nanoseconds - more * kSecond};
  return ::pthread_cond_timedwait(condition, mutex, &at);
}

// Since 2.32: whether there is one thread, which spares the C++ library its atomic operations.
char __libc_single_threaded = 0;

// Since 2.35. The unwinder asks where a function's tables are.
int _dl_find_object(void* at, dl_find_object* out) {
  struct Search {
    std::uintptr_t at;
    dl_find_object* out;
  } search{reinterpret_cast<std::uintptr_t>(at), out};
  const auto look = [](dl_phdr_info* object, std::size_t, void* data) {
    const Search& wanted = *static_cast<Search*>(data);
    bool isIt = false;
    const ElfW(Phdr)* tables = nullptr;
    std::uintptr_t first = UINTPTR_MAX, end = 0;
    for (const ElfW(Phdr)* h = object->dlpi_phdr; h != object->dlpi_phdr + object->dlpi_phnum;
         ++h) {
      if (h->p_type == PT_GNU_EH_FRAME) tables = h;
      if (h->p_type != PT_LOAD) continue;
      const std::uintptr_t begin = object->dlpi_addr + h->p_vaddr;
      isIt |= wanted.at >= begin && wanted.at - begin < h->p_memsz;
      first = std::min(first, begin);
      end = std::max(end, begin + h->p_memsz);
    }
    if (!isIt || tables == nullptr) return isIt ? -1 : 0;
    *wanted.out = {};
    wanted.out->dlfo_map_start = reinterpret_cast<void*>(first);
    wanted.out->dlfo_map_end = reinterpret_cast<void*>(end);
    wanted.out->dlfo_eh_frame = reinterpret_cast<void*>(object->dlpi_addr + tables->p_vaddr);
    return 1;
  };
  return ::dl_iterate_phdr(look, &search) == 1 ? 0 : -1;
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)

// Functions of POSIX for files that wasi-libc lacks.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::size_t kLetters = 6;

/// Tries names until `make` returns a number of 0 and above for one that nobody had.
template <class Make>
int makeNamed(char* name, const Make& make) {
  constexpr const char* kAlphabet = "abcdefghijklmnopqrstuvwxyz012345";
  constexpr int kAttempts = 100;
  const std::size_t length = std::strlen(name);
  for (int attempt = 0; attempt < kAttempts && length >= kLetters; ++attempt) {
    std::uint8_t chance[kLetters];
    if (::getentropy(chance, sizeof chance) != 0) return -1;
    for (std::size_t i = 0; i < kLetters; ++i)
      name[length - kLetters + i] = kAlphabet[chance[i] % 32];
    const int made = make(name);
    if (made >= 0 || errno != EEXIST) return made;
  }
  errno = length < kLetters ? EINVAL : EEXIST;
  return -1;
}

}  // namespace

extern "C" {

/// Hosts know no locks. So one's own file is taken for locked, and another's for in use: who tries
/// without waiting would remove what lies there.
int flock(int, int how) {
  if ((how & LOCK_NB) == 0) return 0;
  errno = EWOULDBLOCK;
  return -1;
}

int gethostname(char* name, std::size_t bytes) {
  if (bytes > 0) *name = '\0';
  return 0;
}

char* mkdtemp(char* name) {
  const int made = makeNamed(name, [](const char* path) { return ::mkdir(path, 0700); });
  return made < 0 ? nullptr : name;
}

int mkostemp(char* name, int flags) {
  return makeNamed(name, [&](const char* path) {
    return ::open(path, O_RDWR | O_CREAT | O_EXCL | flags, 0600);
  });
}

void* mmap(void*, std::size_t bytes, int, int, int file, long long at) {
  auto* memory = static_cast<char*>(std::malloc(bytes));
  for (std::size_t done = 0; memory != nullptr && done < bytes;) {
    const ssize_t got =
        ::pread(file, memory + done, bytes - done, at + static_cast<long long>(done));
    if (got > 0) {
      done += static_cast<std::size_t>(got);
    } else {
      if (got == 0) errno = EIO;  // the file became shorter
      std::free(memory);
      memory = nullptr;
    }
  }
  return memory;
}

int munmap(void* memory, std::size_t) {
  std::free(memory);
  return 0;
}

}  // extern "C"

// Functions of POSIX that wasi-libc does not declare: a host has neither users nor rights. Each
// file of the tool includes this first.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

/// Opens a folder itself, which is refused, so that a named file is made instead.
constexpr int O_TMPFILE = 0;

inline mode_t umask(mode_t) { return 022; }
inline int chmod(const char*, mode_t) { return 0; }
inline int fchmod(int, mode_t) { return 0; }
inline uid_t geteuid() { return 0; }

extern "C" {
/// As POSIX says: six X at the end of `name` become letters of a name that nobody has.
char* mkdtemp(char* name);
int mkostemp(char* name, int flags);
}

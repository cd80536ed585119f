// The start of a program that also runs with glibc 2.28, beside old_glibc.cpp. Programs linked
// since 2.34 leave it to the C library to call the constructors of static objects. A C library
// before that leaves it to the program.
#include "simplify/portable/first_version.h"

// NOLINTBEGIN(readability-identifier-naming): the C library's and the linker's names
extern "C" {

using Main = int (*)(int, char**, char**);
using Constructor = void (*)(int, char**, char**);

/// The linker's: the program's constructors.
extern const Constructor __init_array_start[] __attribute__((visibility("hidden")));
extern const Constructor __init_array_end[] __attribute__((visibility("hidden")));

int first_libc_start_main(Main, int, char**, Constructor, void (*)(), void (*)(), void*);
asm(".symver first_libc_start_main, __libc_start_main@" QTET_FIRST_VERSION);

static void construct(int argc, char** argv, char** environment) {
  for (const Constructor* c = __init_array_start; c != __init_array_end; ++c)
    (*c)(argc, argv, environment);
}

/// Destructors need no help: the loader calls them in any version.
int __libc_start_main(Main main, int argc, char** argv, Constructor, void (*atEnd)(),
                      void (*atLoadersEnd)(), void* stackEnd) {
  return first_libc_start_main(main, argc, argv, construct, atEnd, atLoadersEnd, stackEnd);
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)

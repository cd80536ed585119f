// Jumps out of METIS where memory runs out. WebAssembly has none: the module ends by a trap.
#pragma once

typedef int jmp_buf[1];
#define setjmp(buffer) 0
#define longjmp(buffer, value) __builtin_trap()

// Writes the log that server_bench.py serves: 320 chunks (or others) of 32 KB or so, of noise, since a server decodes nothing that it sends.
//
//   server_log OUT.qtet [CHUNKS]
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/server/synthetic_log.h"

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: server_log OUT.qtet [CHUNKS]\n"), 2;
  const auto chunks = argc == 3 ? static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 320u;
  const qtet::Bytes log = qtet::test::makeLog({.chunks = chunks, .largestBlock = 18000});
  std::ofstream(argv[1], std::ios::binary).write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));
}

// Writes the log that server_bench.py serves: 320 chunks of 32 KB or so, of noise, since a server decodes nothing that it sends.
//
//   server_log OUT.qtet
#include <cstdio>
#include <fstream>

#include "tests/server/synthetic_log.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: server_log OUT.qtet\n"), 2;
  const qtet::Bytes log = qtet::test::makeLog({.chunks = 320, .largestBlock = 18000});
  std::ofstream(argv[1], std::ios::binary).write(reinterpret_cast<const char*>(log.data()), static_cast<std::streamsize>(log.size()));
}

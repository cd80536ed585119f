// Writes the log that server_bench.py serves: a grid of 44 cubes a side (or others), half a million
// cells, with two fields of noise. It has some 300 chunks of 32 KB or so. It is a sound one: a
// server decodes nothing that it sends, but whoever asks it for a level gets one.
//
//   server_log OUT.qtet [CUBES A SIDE [SEED]]
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/support/meshes.h"
#include "tests/support/written_log.h"

namespace {

constexpr int kFieldBits = 28;  // as many as there may be: what is random takes them all

/// A grid whose points carry one value and sixteen, which a log needs about 64 bytes a point for.
qtet::LatticeMesh noisyGrid(int side, unsigned seed) {
  qtet::LatticeMesh mesh = qtet::testing::gridMesh(side, 1);
  std::mt19937 random(seed);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    qtet::FieldInfo& field = mesh.fields[f];
    field.components = f == 0 ? 1 : 16;
    field.bits = kFieldBits;
    field.minimum.assign(field.components, 0);
    mesh.values[f].resize(mesh.points.size() * field.components);
    for (std::int32_t& value : mesh.values[f])
      value = static_cast<std::int32_t>(random() >> (32 - kFieldBits));
  }
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4)
    return std::fprintf(stderr, "usage: server_log OUT.qtet [SIDE [SEED]]\n"), 2;
  const int side = argc >= 3 ? std::atoi(argv[2]) : 44;
  const int seed = argc >= 4 ? std::atoi(argv[3]) : 1;
  qtet::testing::writeLog(argv[1], noisyGrid(side, static_cast<unsigned>(seed)), {}, 32u << 10);
}

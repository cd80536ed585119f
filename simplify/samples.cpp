#include "simplify/samples.h"

#include <array>
#include <string>

namespace qtet {
namespace {

constexpr std::array<Sample, 2> kSamples{{
    {"box", "the unit cube, 3,072 tetrahedra, one scalar field", boxSample},
    {"fin", "supersonic flow round a swept fin, 212,544 tetrahedra, density, pressure and velocity", finSample},
}};

}  // namespace

std::span<const Sample> samples() { return kSamples; }

Result<TetMesh> makeSample(std::string_view name) {
  std::string known;
  for (const Sample& sample : kSamples) {
    if (sample.name == name) return sample.make();
    known += (known.empty() ? "" : ", ") + std::string(sample.name);
  }
  return fail(ErrorCode::kNotFound, "there is no sample '" + std::string(name) + "'; there are: " + known);
}

}  // namespace qtet

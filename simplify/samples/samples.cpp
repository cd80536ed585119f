#include "simplify/samples/samples.h"

#include <array>
#include <string>

namespace qtet {
namespace {

constexpr std::array<Sample, 6> kSamples{{
    {"box", "the unit cube, 3,072 tetrahedra, one scalar field",
     [](std::uint64_t) { return boxSample(); }, kBoxCells, kBoxCells},
    {"fin",
     "supersonic flow round a swept fin, 212,544 tetrahedra, fewer or more, density, pressure "
     "and velocity",
     finSample, kFinCells, kMaxSampleCells, finSeries},
    {"beam", "a loaded cantilever, 67,200 tetrahedra, stress and displacement",
     [](std::uint64_t) { return beamSample(); }, kBeamCells, kBeamCells,
     [](std::uint64_t, std::uint32_t instants) { return beamSeries(instants); }},
    {"spring", "a coil spring, 107,520 tetrahedra, stress and displacement",
     [](std::uint64_t) { return springSample(); }, kSpringCells, kSpringCells},
    {"ball", "a planet's core, mantle and crust, 82,944 tetrahedra, temperature and layers",
     [](std::uint64_t) { return ballSample(); }, kBallCells, kBallCells},
    {"elbow", "flow through a bent pipe, 72,000 tetrahedra, pressure and velocity",
     [](std::uint64_t) { return elbowSample(); }, kElbowCells, kElbowCells},
}};

}  // namespace

std::span<const Sample> samples() { return kSamples; }

Result<TetMesh> makeSample(std::string_view name, std::optional<std::uint64_t> cells,
                           std::uint32_t instants) {
  std::string known;
  for (const Sample& sample : kSamples) {
    if (sample.name == name) {
      const std::uint64_t count = cells.value_or(sample.cells);
      if (sample.cells == sample.maxCells && count != sample.cells)
        return fail(ErrorCode::kBadValue, "the sample " + std::string(name) +
                                              " comes in one size, " +
                                              std::to_string(sample.cells) + " cells");
      if (count > sample.maxCells)
        return fail(ErrorCode::kBadValue, "the sample " + std::string(name) + " comes with " +
                                              std::to_string(sample.maxCells) + " cells at most");
      if (instants == 0) return sample.make(count);
      if (sample.makeSeries == nullptr)
        return fail(ErrorCode::kBadValue,
                    "the sample " + std::string(name) + " is steady; fin and beam come with steps");
      return sample.makeSeries(count, instants);
    }
    known += (known.empty() ? "" : ", ") + std::string(sample.name);
  }
  return fail(ErrorCode::kNotFound,
              "there is no sample '" + std::string(name) + "'; there are: " + known);
}

}  // namespace qtet

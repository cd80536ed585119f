// Makes the logs of tests/same_bytes.txt in memory: the same bytes from every compiler, processor
// and number of threads. It needs the rooms proto, codec and simplify alone, and METIS, no reader
// and no VTK, so that a cross compiler builds it.
//   same_bytes [--threads N]      Prints a line a log: its SHA-256, and the command that makes it.
//   same_bytes --meshes FOLDER    Writes the meshes as .vtu, for programs that simplify files.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "codec/files/atomic_file.h"
#include "proto/checksum.h"
#include "simplify/log/write_mesh.h"
#include "simplify/parts/metis_partition.h"
#include "simplify/pipeline/series_pipeline.h"
#include "tests/bench/need.h"
#include "tests/same_bytes/meshes.h"

namespace qtet::testing {
namespace {

using bench::need;

using Choice = void (*)(PipelineOptions&);

struct Row {
  std::string_view mesh;
  std::string_view words;  ///< the options as `qtet simplify` has them, or what else is done
  Choice choose = [](PipelineOptions&) {};
};

constexpr Row kRows[] = {
    {"box", ""},
    {"box",
     " --lossless --keep-order --value-codec adaptive --placement optimal "
     "--envelope-tolerance 0.01",
     [](PipelineOptions& o) {
       o.keep = {.order = true, .exact = true};
       o.valueCodec = CodecId::kAdaptive;
       o.fusion.placement = PlacementRule::kOptimal;
       o.fusion.envelopeTolerance = 0.01;
     }},
    {"box", " --algorithm paper --measure none",
     [](PipelineOptions& o) {
       o.algorithm = Algorithm::kPaper;
       o.measure = std::nullopt;
     }},
    {"cells", ""},
    {"missing", ""},
    {"missing", " --lossless", [](PipelineOptions& o) { o.keep.exact = true; }},
    {"holes", ""},
    {"holes", " --algorithm paper", [](PipelineOptions& o) { o.algorithm = Algorithm::kPaper; }},
    {"fin", ""},
    {"fin", " --lossless --placement vertex --boundary-weight 30 --field-weight Density=2",
     [](PipelineOptions& o) {
       o.keep.exact = true;
       o.fusion.placement = PlacementRule::kVertex;
       o.fusion.cost.boundaryWeight = 30;
       o.fieldWeights = {{"Density", 2}};
     }},
    {"fin", " in parts of 1000 cells",
     [](PipelineOptions& o) { o.parts = smallParts(metisPartitioner(), 1000); }},
    {"beam", ""},
    {"beam", " --time-statistics", [](PipelineOptions& o) { o.timeStatistics = true; }},
    {"ball", ""},
    {"ball", " --lossless --preserve-regions Layer",
     [](PipelineOptions& o) {
       o.keep.exact = true;
       o.regions = "Layer";
     }},
    {"spring", " --target-ratio 0 --position-bits 20 --field-bits 16",
     [](PipelineOptions& o) {
       o.fusion.targetRatio = 0;
       o.quantise = {.positionBits = 20, .fieldBits = 16};
     }},
    {"elbow", ""},
};

void print(const PipelineOutput& made, const std::string& name) {
  std::printf("%s  %s\n", sha256Hex(need(made.log.bytes())).c_str(), name.c_str());
  std::fflush(stdout);
}

void printAll(int threads) {
  std::string_view last;
  TetMesh mesh;
  for (const Row& row : kRows) {
    if (row.mesh != last) mesh = sameBytesMesh(row.mesh);
    last = row.mesh;
    PipelineOptions options;
    options.source = std::string(row.mesh) + ".vtu";
    options.fusion.threads = threads;
    row.choose(options);
    print(need(simplifyToLog(TetMesh(mesh), options)), options.source + std::string(row.words));
  }
  PipelineOptions options;
  options.fusion.threads = threads;
  TetMesh sample = need(sameBytesInstants(sampledSteps(kSameBytesSteps)));
  print(need(simplifySeries(std::move(sample), kSameBytesSteps, sameBytesInstants, options)),
        "a series in windows");
}

void writeMeshes(const std::filesystem::path& folder) {
  for (const SameBytesMesh& mesh : sameBytesMeshes())
    need(writeFileAtomically(folder / (std::string(mesh.name) + ".vtu"), vtuBytes(mesh.make())));
}

}  // namespace
}  // namespace qtet::testing

int main(int count, char** words) {
  const std::string_view option = count == 3 ? words[1] : "";
  if (option == "--meshes") {
    qtet::testing::writeMeshes(words[2]);
  } else if (count == 1 || option == "--threads") {
    qtet::testing::printAll(count == 1 ? 1 : std::atoi(words[2]));
  } else {
    std::fputs("usage: same_bytes [--threads N | --meshes FOLDER]\n", stderr);
    return 2;
  }
}

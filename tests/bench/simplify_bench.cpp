// The simplifier's speed beside VTK's decimation. Each run is one program and one input in memory,
// pinned to as many cores as threads. The programs take turns; figures are medians of five. Prints
// Markdown tables.
//   simplify_bench [--threads N] [--repeats N] [--reduction R] [--fields all|one] [NAME...]
//     NAME: a mesh file, or a sample's name. Without any: every .vtu of the folder QTET_DATA, and
//     where that is not set the samples box and fin.
//   simplify_bench --speedup [--threads N] [--repeats N] [--reduction R] [NAME...]
//     ours alone, with one thread and with N (two unless given) in turns: wall seconds, and their
//     ratio.
//   simplify_bench --growth [CELLS|FILE...]
//     the whole tool on `qtet sample fin --cells CELLS` (200,000 and 10,000,000 unless given) or on
//     files: seconds and peak memory a cell.
// On the clock for ours is simplify(), from a cleaned mesh on the lattice to the history of
// fusions. Every field is optimised and carried along, or with `--fields one` the one scalar that
// VTK's filter keeps, which is like for like. On the clock for VTK is the filter's Update(), from
// an unstructured grid to another, always with that one scalar. Off the clock: reading, cleaning,
// quantising (its own column), building VTK's grid and scaling it, encoding.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/read/read_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/bench/vtk_decimation.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet::bench {
namespace {

struct Request {
  int threads = 1;
  int repeats = 5;
  double reduction = 0.9;
  bool isOneField = false;  // ours keeps no more than VTK's filter
  bool growth = false, speedup = false;
  std::vector<std::string> names;
};

template <class T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return std::move(*result);
}

TetMesh meshNamed(const std::string& name) {
  TetMesh mesh = std::filesystem::exists(name) ? need(readMesh(name)).mesh : need(makeSample(name));
  (void)need(cleanMesh(mesh));
  return mesh;
}

std::vector<std::string> defaultNames() {
  const char* folder = std::getenv("QTET_DATA");
  if (!folder || *folder == 0) return {"box", "fin"};
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".vtu") out.push_back(entry.path().string());
  std::ranges::sort(out);
  return out;
}

/// The results of one program on one mesh, over all repeats. VTK's filter draws random numbers, so
/// what it removes varies a little: the last run's counts.
struct Runs {
  std::size_t removed = 0;
  std::vector<double> user, wall;

  void add(std::size_t cellsRemoved, const Seconds& seconds) {
    removed = cellsRemoved;
    user.push_back(seconds.user);
    wall.push_back(seconds.wall);
  }
  /// Thousand cells removed a second of user CPU.
  [[nodiscard]] double rate() const {
    return 1e-3 * static_cast<double>(removed) / std::max(medianOf(user), 1e-6);
  }
};

std::size_t tetrahedraLeft(const FusionHistory& history, std::size_t original) {
  return static_cast<std::size_t>(std::count(
      history.live.begin(), history.live.begin() + static_cast<std::ptrdiff_t>(original), 1));
}

void addOurs(const LatticeMesh& mesh, const Request& request, int threads, Runs& runs) {
  FusionOptions options;
  options.targetRatio = 1 - request.reduction;
  options.threads = threads;
  std::optional<Result<FusionHistory>> history;
  const Seconds seconds = timeOf([&] { history.emplace(simplify(mesh, options)); });
  runs.add(
      mesh.tetrahedra.size() - tetrahedraLeft(need(std::move(*history)), mesh.tetrahedra.size()),
      seconds);
}

void addVtk(vtkUnstructuredGrid* grid, double scale, const Request& request, Runs& runs) {
  const Decimated out = decimate(grid, scale, request.reduction);
  runs.add(static_cast<std::size_t>(grid->GetNumberOfCells() - out.grid->GetNumberOfCells()),
           out.seconds);
}

/// Leaves only the field that VTK's filter keeps, if there is one.
void leaveScalar(TetMesh& mesh) {
  const MeshField* scalar = scalarOf(mesh);
  mesh.fields = scalar ? std::vector{*scalar} : std::vector<MeshField>{};
}

void compare(const std::string& name, const Request& request) {
  TetMesh mesh = meshNamed(name);
  if (request.isOneField) leaveScalar(mesh);
  std::optional<QuantisedMesh> lattice;
  const Seconds quantising = timeOf([&] { lattice.emplace(need(quantise(mesh))); });
  const auto plain = gridOf(mesh, 1), scaled = gridOf(mesh, kTunedScale);
  Runs ours, vtk, tuned;
  for (int i = 0; i < request.repeats; ++i) {
    addOurs(lattice->mesh, request, request.threads, ours);
    addVtk(plain, 1, request, vtk);
    addVtk(scaled, kTunedScale, request, tuned);
  }
  const auto cells = mesh.tetrahedra.size();
  std::printf("| %s | %zu |", std::filesystem::path(name).stem().c_str(), cells);
  for (const Runs* runs : {&ours, &vtk, &tuned})
    std::printf(" %.2f %% | %.3f | %.3f | %.0f |",
                100 * static_cast<double>(runs->removed) / static_cast<double>(cells),
                medianOf(runs->user), medianOf(runs->wall), runs->rate());
  for (const Runs* theirs : {&vtk, &tuned})
    theirs->removed > 0 ? std::printf(" %.2f |", ours.rate() / theirs->rate()) : std::printf(" |");
  std::printf(" %.3f |\n", quantising.user);
  std::fflush(stdout);
}

void compareAll(const Request& request) {
  std::printf(
      "%g %% asked for, %d thread%s, %s in ours, one in VTK's, medians of %d; u = user CPU "
      "seconds, w = wall seconds, k/u = thousand cells "
      "removed a user second\n\n",
      100 * request.reduction, request.threads, request.threads == 1 ? "" : "s",
      request.isOneField ? "one field" : "all fields", request.repeats);
  std::puts(
      "| mesh | cells | qtet removed | u | w | k/u | VTK removed | u | w | k/u | VTK x 1000 "
      "removed | u | w | k/u | qtet / VTK | qtet / "
      "VTK x 1000 | quantise u |");
  std::puts("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const std::string& name : request.names.empty() ? defaultNames() : request.names)
    compare(name, request);
}

void speedup(const Request& request) {
  std::printf(
      "%g %% asked for, all fields, wall seconds of simplify(), medians of %d (least in "
      "brackets)\n\n",
      100 * request.reduction, request.repeats);
  std::printf("| mesh | cells | one thread | %d threads | ratio |\n|---|---|---|---|---|\n",
              request.threads);
  for (const std::string& name : request.names.empty() ? defaultNames() : request.names) {
    const LatticeMesh mesh = need(quantise(meshNamed(name))).mesh;
    Runs one, many;
    for (int i = 0; i < request.repeats; ++i)
      addOurs(mesh, request, 1, one), addOurs(mesh, request, request.threads, many);
    const double alone = medianOf(one.wall), together = medianOf(many.wall);
    std::printf("| %s | %zu | %.4f (%.4f) | %.4f (%.4f) | %.3f |\n",
                std::filesystem::path(name).stem().c_str(), mesh.tetrahedra.size(), alone,
                std::ranges::min(one.wall), together, std::ranges::min(many.wall),
                together / alone);
    std::fflush(stdout);
  }
}

struct Finished {
  bool ok = false;
  double userSeconds = 0;
  double peakBytes = 0;
};

/// Runs the tool with its standard output thrown away, and waits for it.
Finished runTool(std::vector<std::string> words) {
  words.insert(words.begin(), testing::kTool);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("the system has no process left to run the tool in");
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
    execv(testing::kTool, pointers.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) < 0)
    throw std::runtime_error("the tool's end was not reported");
  constexpr double kBytesAUnit = 1024;  // ru_maxrss counts KiB on Linux
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, userSecondsOf(usage),
          kBytesAUnit * static_cast<double>(usage.ru_maxrss)};
}

std::string inputFor(const std::string& word, const std::filesystem::path& folder) {
  if (std::filesystem::exists(word)) return word;
  const std::string path = folder / ("fin-" + word + ".vtu");
  if (!runTool({"sample", "fin", "--cells", word, "-o", path}).ok)
    throw std::runtime_error("'" + word +
                             "' is no file, and the tool did not make a sample of so many cells "
                             "(its message stands above)");
  return path;
}

void growth(const Request& request) {
  const std::filesystem::path folder = testing::freshFolder("growth");
  std::vector<std::string> inputs;
  std::vector<Finished> tools;
  // All of the tool's runs first: Linux counts to a child's peak what its parent held when it was
  // forked.
  for (const std::string& word :
       request.names.empty() ? std::vector<std::string>{"200000", "10000000"} : request.names) {
    inputs.push_back(inputFor(word, folder));
    tools.push_back(runTool({"simplify", inputs.back(), "-o", folder / "log.qtet", "--threads",
                             std::to_string(request.threads)}));
    if (!tools.back().ok) throw std::runtime_error("the tool failed on " + inputs.back());
  }
  std::puts(
      "| input | cells | whole tool, user s | us a cell | simplify(), user s | us a cell | peak "
      "memory | bytes a cell |");
  std::puts("|---|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const LatticeMesh mesh = need(quantise(meshNamed(inputs[i]))).mesh;
    Runs ours;
    addOurs(mesh, request, request.threads, ours);
    const auto cells = static_cast<double>(mesh.tetrahedra.size());
    std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.0f MB | %.0f |\n",
                std::filesystem::path(inputs[i]).stem().c_str(), cells, tools[i].userSeconds,
                1e6 * tools[i].userSeconds / cells, ours.user[0], 1e6 * ours.user[0] / cells,
                1e-6 * tools[i].peakBytes, tools[i].peakBytes / cells);
    std::fflush(stdout);
  }
}

bool isOneAfter(const std::vector<std::string>& words, std::size_t& i) {
  const std::string value = ++i < words.size() ? words[i] : "";
  if (value != "one" && value != "all") throw std::runtime_error("--fields needs one or all");
  return value == "one";
}

double numberAfter(const std::vector<std::string>& words, std::size_t& i, double low, double high) {
  const std::string& option = words[i];
  char* end = nullptr;
  const double value = i + 1 < words.size() ? std::strtod(words[i + 1].c_str(), &end) : 0;
  if (!end || *end != '\0' || !(value >= low && value <= high)) {
    std::ostringstream message;
    message << option << " needs a number from " << low << " to " << high;
    throw std::runtime_error(message.str());
  }
  ++i;
  return value;
}

Request requestOf(const std::vector<std::string>& words) {
  Request request;
  bool isThreadsGiven = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--threads") {
      request.threads = static_cast<int>(numberAfter(words, i, 1, 1024));
      isThreadsGiven = true;
    } else if (words[i] == "--repeats") {
      request.repeats = static_cast<int>(numberAfter(words, i, 1, 1000));
    } else if (words[i] == "--reduction") {
      request.reduction = numberAfter(words, i, 0.01, 0.9999);
    } else if (words[i] == "--fields") {
      request.isOneField = isOneAfter(words, i);
    } else if (words[i] == "--growth") {
      request.growth = true;
    } else if (words[i] == "--speedup") {
      request.speedup = true;
    } else if (words[i].starts_with("--")) {
      throw std::runtime_error(
          "unknown option " + words[i] +
          "; there are --threads, --repeats, --reduction, --fields, --speedup and --growth");
    } else {
      request.names.push_back(words[i]);
    }
  }
  if (request.speedup && !isThreadsGiven) request.threads = 2;
  return request;
}

}  // namespace
}  // namespace qtet::bench

int main(int argc, char** argv) {
  try {
    const auto request = qtet::bench::requestOf({argv + 1, argv + argc});
    if (!qtet::bench::pinToCores(request.threads))
      std::fputs("simplify_bench: the system refuses to pin the process to cores\n", stderr);
    request.growth    ? qtet::bench::growth(request)
    : request.speedup ? qtet::bench::speedup(request)
                      : qtet::bench::compareAll(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simplify_bench: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

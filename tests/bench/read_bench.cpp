// The cost of reading and splitting a .vtu file, beside the cost of VTK alone to read it:
// `read_bench [FILE.vtu...]`. Without a file two of a million cells are made: hexahedra and
// tetrahedra, written by VTK as it writes them by default. The figures are medians of seven runs:
// CPU seconds of all threads, seconds of the clock, and memory at most beyond that before. The two
// programs take turns, each run in a process of its own that has no memory from the run before.
// They run with pages of 2 MB where the code asks for them, and without.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "simplify/read/read_mesh.h"
#include "tests/bench/cpu_clock.h"

namespace {

constexpr int kRuns = 7;

/// The cost of one run, or medians of several.
struct Cost {
  double user = 0, system = 0, clock = 0, megabytes = 0;
  std::size_t tetrahedra = 0;
  [[nodiscard]] double cpu() const { return user + system; }
};

Cost costSoFar() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {
      qtet::bench::userSecondsOf(usage),
      static_cast<double>(usage.ru_stime.tv_sec) +
          1e-6 * static_cast<double>(usage.ru_stime.tv_usec),
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
      static_cast<double>(usage.ru_maxrss) / 1024};
}

Cost medianOf(const std::vector<Cost>& runs) {
  const auto median = [&](const auto& part) {
    std::vector<double> values;
    for (const Cost& run : runs) values.push_back(part(run));
    return qtet::bench::medianOf(values);
  };
  // The median of the sum, so that it is one run's; the parts need not add up to it.
  const double cpu = median([](const Cost& run) { return run.cpu(); }),
               system = median([](const Cost& run) { return run.system; });
  return {cpu - system, system, median([](const Cost& run) { return run.clock; }),
          median([](const Cost& run) { return run.megabytes; }), runs.back().tetrahedra};
}

/// `work` in a process of its own, which ends without giving its memory back piece by piece; it
/// returns a number of tetrahedra.
Cost costOf(bool hugePages, const std::function<std::size_t()>& work) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  const pid_t child = fork();
  if (child < 0) std::abort();
  if (child == 0) {
    if (!hugePages) prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
    const Cost before = costSoFar();
    const std::size_t tetrahedra = work();
    const Cost after = costSoFar();
    const Cost cost{after.user - before.user, after.system - before.system,
                    after.clock - before.clock, after.megabytes - before.megabytes, tetrahedra};
    _exit(write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  close(ends[1]);
  Cost cost;
  if (read(ends[0], &cost, sizeof cost) != sizeof cost) std::abort();
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return cost;
}

/// n x n x n crooked hexahedra with a scalar and a vector, or the same with each cut into six
/// tetrahedra.
void writeGrid(const std::filesystem::path& path, int n, bool tetrahedra) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> scalar, vector;
  scalar->SetName("Scalar");
  vector->SetName("Vector");
  vector->SetNumberOfComponents(3);
  const auto at = [n](int i, int j, int k) {
    return vtkIdType{i} + vtkIdType{n + 1} * (j + vtkIdType{n + 1} * k);
  };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const double x = i + 0.1 * std::sin(j + 2.0 * k), y = j + 0.1 * std::sin(3.0 * k + i),
                     z = k + 0.1 * std::cos(i + j);
        points->InsertNextPoint(x, y, z);
        scalar->InsertNextValue(std::sin(0.1 * x) * y);
        vector->InsertNextTuple3(x * y, std::cos(0.1 * z), z);
      }
    }
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(scalar);
  grid->GetPointData()->AddArray(vector);
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const vtkIdType c[8] = {
            at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
            at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
        if (!tetrahedra) {
          grid->InsertNextCell(VTK_HEXAHEDRON, 8, c);
          continue;
        }
        for (const auto& t : {std::array{1, 2}, std::array{2, 3}, std::array{3, 7},
                              std::array{7, 4}, std::array{4, 5}, std::array{5, 1}}) {
          const vtkIdType ids[4] = {c[0], c[t[0]], c[t[1]], c[6]};
          grid->InsertNextCell(VTK_TETRA, 4, ids);
        }
      }
    }
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(grid);
  writer->Write();
}

std::size_t readByVtk(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return static_cast<std::size_t>(reader->GetOutput()->GetNumberOfCells());
}

std::size_t readByQtet(const std::filesystem::path& path) {
  const auto read = qtet::readMesh(path);
  return read ? read->mesh.tetrahedra.size() : 0;
}

void compare(const std::filesystem::path& path, bool hugePages) {
  std::vector<Cost> vtkRuns, ourRuns;
  for (int run = 0; run < kRuns; ++run) {
    vtkRuns.push_back(costOf(hugePages, [&] { return readByVtk(path); }));
    ourRuns.push_back(costOf(hugePages, [&] { return readByQtet(path); }));
  }
  const Cost vtk = medianOf(vtkRuns), ours = medianOf(ourRuns);
  std::printf(
      "%s, pages of %s: %zu tetrahedra; VTK alone %.3f s (%.3f of it system, %.3f by the clock, "
      "%.0f MB), read and split %.3f s (%.3f, %.3f, %.0f MB), %.2f times, by the clock %.2f\n",
      path.filename().c_str(), hugePages ? "2 MB" : "4 KB", ours.tetrahedra, vtk.cpu(), vtk.system,
      vtk.clock, vtk.megabytes, ours.cpu(), ours.system, ours.clock, ours.megabytes,
      ours.cpu() / vtk.cpu(), ours.clock / vtk.clock);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  if (count > 1) {
    for (int i = 1; i < count; ++i)
      for (const bool hugePages : {true, false}) compare(words[i], hugePages);
    return 0;
  }
  for (const bool tetrahedra : {false, true}) {
    const auto path = std::filesystem::temp_directory_path() /
                      (tetrahedra ? "qtet-read-bench-tet.vtu" : "qtet-read-bench-hex.vtu");
    costOf(true,
           [&] { return writeGrid(path, tetrahedra ? 55 : 100, tetrahedra), std::size_t{0}; });
    for (const bool hugePages : {true, false}) compare(path, hugePages);
    std::filesystem::remove(path);
  }
  return 0;
}

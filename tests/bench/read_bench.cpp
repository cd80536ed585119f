// What reading and splitting costs beside what VTK alone takes to read the same .vtu file: `read_bench [FILE.vtu]`. Without a file two of a million cells
// are made: hexahedra and tetrahedra, written by VTK as it writes them by default. Prints the medians of five runs, alternating.
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
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "simplify/read_mesh.h"

namespace {

constexpr int kRuns = 5;

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// n x n x n crooked hexahedra with a scalar and a vector, or the same with each cut into six tetrahedra.
std::filesystem::path gridFile(int n, bool tetrahedra) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> scalar, vector;
  scalar->SetName("Scalar");
  vector->SetName("Vector");
  vector->SetNumberOfComponents(3);
  const auto at = [n](int i, int j, int k) { return vtkIdType{i} + vtkIdType{n + 1} * (j + vtkIdType{n + 1} * k); };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const double x = i + 0.1 * std::sin(j + 2.0 * k), y = j + 0.1 * std::sin(3.0 * k + i), z = k + 0.1 * std::cos(i + j);
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
        const vtkIdType c[8] = {at(i, j, k),         at(i + 1, j, k),         at(i + 1, j + 1, k),         at(i, j + 1, k),
                                at(i, j, k + 1),     at(i + 1, j, k + 1),     at(i + 1, j + 1, k + 1),     at(i, j + 1, k + 1)};
        if (!tetrahedra) {
          grid->InsertNextCell(VTK_HEXAHEDRON, 8, c);
          continue;
        }
        for (const auto& t : {std::array{1, 2}, std::array{2, 3}, std::array{3, 7}, std::array{7, 4}, std::array{4, 5}, std::array{5, 1}}) {
          const vtkIdType ids[4] = {c[0], c[t[0]], c[t[1]], c[6]};
          grid->InsertNextCell(VTK_TETRA, 4, ids);
        }
      }
    }
  }
  const auto path = std::filesystem::temp_directory_path() / (tetrahedra ? "qtet-read-bench-tet.vtu" : "qtet-read-bench-hex.vtu");
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(grid);
  writer->Write();
  return path;
}

void compare(const std::filesystem::path& path) {
  std::vector<double> vtk, ours;
  std::size_t tetrahedra = 0;
  for (int run = 0; run < kRuns; ++run) {
    vtk.push_back(secondsOf([&] {
      vtkNew<vtkXMLUnstructuredGridReader> reader;
      reader->SetFileName(path.c_str());
      reader->Update();
    }));
    ours.push_back(secondsOf([&] {
      const auto read = qtet::readMesh(path);
      tetrahedra = read ? read->mesh.tetrahedra.size() : 0;
    }));
  }
  std::printf("%s: %zu tetrahedra; VTK alone %.3f s, read and split %.3f s, %.2f times\n", path.filename().c_str(), tetrahedra, median(vtk), median(ours),
              median(ours) / median(vtk));
}

}  // namespace

int main(int count, char** words) {
  if (count > 1) {
    compare(words[1]);
    return 0;
  }
  for (const bool tetrahedra : {false, true}) {
    const auto path = gridFile(tetrahedra ? 55 : 100, tetrahedra);
    compare(path);
    std::filesystem::remove(path);
  }
  return 0;
}

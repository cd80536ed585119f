// Our own reader of legacy VTK files beside VTK's.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataWriter.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedShortArray.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>

#include <array>

#include "simplify/read/text/text_readers.h"
#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::addArray;
using testing::expectSame;
using testing::fileWith;
using testing::scatteredPoints;
using testing::Way;

/// Cells of every dimension, ghosts, and arrays of every kind that is read here. The attributes are
/// what files name SCALARS, VECTORS and so on.
vtkNew<vtkUnstructuredGrid> manyKinds() {
  vtkNew<vtkUnstructuredGrid> grid;
  constexpr vtkIdType kPoints = 151;
  grid->SetPoints(scatteredPoints(kPoints));
  constexpr std::array<std::pair<int, int>, 6> kKinds{{{VTK_TETRA, 4},
                                                       {VTK_TRIANGLE, 3},
                                                       {VTK_HEXAHEDRON, 8},
                                                       {VTK_VERTEX, 1},
                                                       {VTK_WEDGE, 6},
                                                       {VTK_QUADRATIC_TETRA, 10}}};
  for (vtkIdType i = 0; i < 60; ++i) {
    const auto [type, nodes] = kKinds[static_cast<std::size_t>(i) % kKinds.size()];
    std::array<vtkIdType, 10> ids{};
    for (int k = 0; k < nodes; ++k) ids[static_cast<std::size_t>(k)] = (i + 3 * k) % kPoints;
    grid->InsertNextCell(type, nodes, ids.data());
  }
  vtkPointData& ofPoints = *grid->GetPointData();
  ofPoints.SetScalars(addArray<vtkFloatArray>(ofPoints, "two scalars", 2, kPoints));
  ofPoints.SetVectors(addArray<vtkDoubleArray>(ofPoints, "vectors", 3, kPoints));
  ofPoints.SetNormals(addArray<vtkFloatArray>(ofPoints, "normals", 3, kPoints));
  ofPoints.SetTensors(addArray<vtkDoubleArray>(ofPoints, "tensors", 9, kPoints));
  addArray<vtkSignedCharArray>(ofPoints, "100 %", 1, kPoints);
  addArray<vtkUnsignedShortArray>(ofPoints, "uint16", 2, kPoints);
  addArray<vtkIntArray>(ofPoints, "seventeen", 17, kPoints);
  addArray<vtkIdTypeArray>(ofPoints, "GlobalPointIds", 1, kPoints);
  const vtkIdType cells = grid->GetNumberOfCells();
  vtkCellData& ofCells = *grid->GetCellData();
  ofCells.SetScalars(addArray<vtkIntArray>(ofCells, "int32", 1, cells));
  addArray<vtkLongLongArray>(ofCells, "int64", 1, cells);
  auto* named = addArray<vtkDoubleArray>(ofCells, "with names", 2, cells);
  named->SetComponentName(0, "first");  // which the writer tells in METADATA
  named->SetComponentName(1, "second");
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName("vtkGhostType");
  for (vtkIdType i = 0; i < cells; ++i)
    ghosts->InsertNextValue(i % 11 == 0   ? 1
                            : i % 13 == 0 ? 32
                            : i % 17 == 0 ? 2
                            : i % 19 == 0 ? 8
                                          : 0);
  ofCells.AddArray(ghosts);
  vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(3);
  grid->GetFieldData()->AddArray(time);
  return grid;
}

struct Form {
  int type, version;
};

fs::path written(vtkUnstructuredGrid* grid, const Form& form) {
  const fs::path path = testing::freshFolder("legacy") / "grid.vtk";
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(path.c_str());
  writer->SetFileType(form.type);
  writer->SetFileVersion(form.version);
  writer->Write();
  return path;
}

Way byVtk(const fs::path& path, const FieldNames& fields) {
  Way out{CellMesh{}, {}};
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  out.mesh = testing::cellsOf(*reader->GetOutput(), fields, path, out.report);
  return out;
}

Way byOurs(const fs::path& path, const FieldNames& fields) {
  Way out{CellMesh{}, {}};
  auto mesh = readLegacyVtk(path, fields, out.report);
  if (!mesh) return {std::unexpected(mesh.error()), {}};
  EXPECT_TRUE(*mesh) << "it is left to VTK";
  if (*mesh) out.mesh = std::move(**mesh);
  return out;
}

TEST(ReadLegacyVtk, everyFormOfVtkGivesWhatVtkGives) {
  const auto grid = manyKinds();
  for (const int type : {VTK_ASCII, VTK_BINARY})
    for (const int version : {vtkDataWriter::VTK_LEGACY_READER_VERSION_4_2,
                              vtkDataWriter::VTK_LEGACY_READER_VERSION_5_1}) {
      const fs::path path = written(grid, {type, version});
      for (const FieldNames& fields : {FieldNames(), FieldNames({"vectors", "cell:int64"})})
        expectSame(byOurs(path, fields), byVtk(path, fields), std::to_string(10 * version + type));
    }
}

TEST(ReadLegacyVtk, whatOnlyVtkUnderstandsIsLeftToIt) {
  ReadReport report;
  const auto isLeft = [&](const fs::path& path) {
    const auto read = readLegacyVtk(path, std::nullopt, report);
    return read && !*read;
  };
  const auto grid = manyKinds();
  vtkNew<vtkStringArray> words;
  words->SetName("words");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) words->InsertNextValue("some");
  grid->GetPointData()->AddArray(words);
  EXPECT_TRUE(isLeft(written(grid, {VTK_ASCII, vtkDataWriter::VTK_LEGACY_READER_VERSION_5_1})));
  vtkNew<vtkUnstructuredGrid> polyhedron;
  vtkNew<vtkPoints> corners;
  for (int i = 0; i < 4; ++i) corners->InsertNextPoint(i == 1, i == 2, i == 3);
  polyhedron->SetPoints(corners);
  const std::array<vtkIdType, 4> ids{0, 1, 2, 3};
  const std::array<vtkIdType, 16> faces{3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3};
  polyhedron->InsertNextCell(VTK_POLYHEDRON, 4, ids.data(), 4, faces.data());
  EXPECT_TRUE(
      isLeft(written(polyhedron, {VTK_BINARY, vtkDataWriter::VTK_LEGACY_READER_VERSION_5_1})));
  EXPECT_TRUE(isLeft(fileWith("s.vtk",
                              "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"
                              "DIMENSIONS 2 2 2\n")));
}

TEST(ReadLegacyVtk, aFileThatEndsEarlyIsTruncatedAndAllocatesNothing) {
  const auto grid = manyKinds();
  ReadReport report;
  for (const int type : {VTK_ASCII, VTK_BINARY}) {
    std::ifstream file(written(grid, {type, vtkDataWriter::VTK_LEGACY_READER_VERSION_5_1}),
                       std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t size = 60; size < whole.size(); size += 97)
      (void)readLegacyVtk(fileWith("cut.vtk", whole.substr(0, size)), std::nullopt, report);
  }
  const auto huge =
      readLegacyVtk(fileWith("huge.vtk",
                             "# vtk DataFile Version 5.1\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
                             "POINTS 6148914691236517205 double\n"),
                    std::nullopt, report);
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().code, ErrorCode::kTruncated);
}

}  // namespace
}  // namespace qtet

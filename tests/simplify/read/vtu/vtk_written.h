// Unstructured grids as VTK writes and reads them.
#pragma once

#include <gtest/gtest.h>
#include <vtkFieldData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstring>
#include <fstream>
#include <random>
#include <string>

#include "simplify/read/vtu/read_vtu.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/vtu/vtk_cells.h"

namespace qtet::testing {

/// Adds an array of numbers that are the same each time.
template <class Array>
Array* addArray(vtkFieldData& to, const char* name, int components, vtkIdType tuples) {
  std::mt19937 random(7);
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
    array->SetComponent(i / components, static_cast<int>(i % components),
                        static_cast<double>(random() % 120) / 3);
  to.AddArray(array);
  return array;
}

/// As many points at places that are the same each time.
inline vtkNew<vtkPoints> scatteredPoints(vtkIdType count) {
  std::mt19937 random(5);
  vtkNew<vtkPoints> points;
  const auto coordinate = [&] { return static_cast<double>(random() % 9000) / 7; };
  for (vtkIdType i = 0; i < count; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    points->InsertNextPoint(x, y, z);
  }
  return points;
}

struct Encoding {
  int mode = vtkXMLWriter::Appended, compressor = vtkXMLWriter::ZLIB,
      order = vtkXMLWriter::LittleEndian, header = vtkXMLWriter::UInt32;
  bool base64 = true;
  std::size_t block = 32768;
};

inline std::string writtenByVtk(vtkUnstructuredGrid* grid, const Encoding& as) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataMode(as.mode);
  writer->SetCompressorType(as.compressor);
  writer->SetByteOrder(as.order);
  writer->SetHeaderType(as.header);
  writer->SetEncodeAppendedData(as.base64);
  writer->SetBlockSize(as.block);
  const std::filesystem::path path = freshFolder("written-by-vtk") / "written.vtu";
  writer->SetFileName(path.c_str());
  writer->Write();
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A mesh as one of the ways gives it, with what it reports.
struct Way {
  Result<CellMesh> mesh;
  ReadReport report;
};

inline Way readByVtk(const std::filesystem::path& path, const FieldNames& fields = std::nullopt) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  Way out{CellMesh{}, {}};
  if (reader->GetOutput()->GetNumberOfPoints() + reader->GetOutput()->GetNumberOfCells() > 0)
    out.mesh = cellsOf(*reader->GetOutput(), fields, path, out.report);
  return out;
}

inline Way readByOurs(const std::filesystem::path& path, const FieldNames& fields = std::nullopt) {
  Way out{CellMesh{}, {}};
  const Result<VtuFile> file = VtuFile::open(path);
  if (!file) return {std::unexpected(file.error()), {}};
  const Result<VtuDocument> document = readVtuDocument(*file);
  if (!document) return {std::unexpected(document.error()), {}};
  out.mesh = readVtu(*file, *document, fields, out.report);
  return out;
}

/// To the bit, also of NaN.
template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expectSame(const Way& ours, const Way& vtk, const std::string& what) {
  ASSERT_TRUE(vtk.mesh) << what << ": " << vtk.mesh.error().text();
  ASSERT_TRUE(ours.mesh) << what << ": " << ours.mesh.error().text();
  const CellMesh &a = *ours.mesh, &b = *vtk.mesh;
  EXPECT_TRUE(sameBits(a.points, b.points)) << what;
  EXPECT_EQ(a.types, b.types) << what;
  EXPECT_EQ(a.begins, b.begins) << what;
  EXPECT_EQ(a.vertices, b.vertices) << what;
  EXPECT_EQ(a.cellIds, b.cellIds) << what;
  EXPECT_EQ(a.otherFields, b.otherFields) << what;
  EXPECT_EQ(a.pointType, b.pointType) << what;
  EXPECT_EQ(a.pointIds, b.pointIds) << what;
  ASSERT_EQ(a.fields.size(), b.fields.size()) << what;
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    const MeshField &f = a.fields[i], &g = b.fields[i];
    EXPECT_EQ(f.name, g.name) << what;
    EXPECT_EQ(f.association, g.association) << what << ", " << f.name;
    EXPECT_EQ(f.type, g.type) << what << ", " << f.name;
    EXPECT_EQ(f.components, g.components) << what << ", " << f.name;
    EXPECT_TRUE(sameBits(f.values, g.values)) << what << ", " << f.name;
  }
  EXPECT_EQ(ours.report.ignoredCells, vtk.report.ignoredCells) << what;
  EXPECT_EQ(ours.report.ignoredFields, vtk.report.ignoredFields) << what;
  EXPECT_EQ(ours.report.notes, vtk.report.notes) << what;
}

}  // namespace qtet::testing

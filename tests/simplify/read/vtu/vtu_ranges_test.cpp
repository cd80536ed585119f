// Ranges of a .vtu file beside the whole of it, in every place and compression.
#include "simplify/read/vtu/vtu_ranges.h"

#include <gtest/gtest.h>
#include <vtkCellType.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>

#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

constexpr int kSide = 6;

/// A row of tetrahedra and triangles, with a last polyhedron, and a field of points.
vtkNew<vtkUnstructuredGrid> row() {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> field;
  field->SetName("T");
  field->SetNumberOfComponents(2);
  constexpr vtkIdType kPoints = kSide * kSide * kSide;
  for (vtkIdType i = 0; i < kPoints; ++i) {
    const vtkIdType y = i / kSide % kSide, z = i / kSide / kSide;
    points->InsertNextPoint(static_cast<double>(i % kSide), static_cast<double>(y),
                            static_cast<double>(z));
    field->InsertNextTuple2(static_cast<double>(i), static_cast<double>(-i));
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(field);
  for (vtkIdType i = 0; i + kSide * kSide + kSide < kPoints; ++i) {
    const vtkIdType ids[4] = {i, i + 1, i + kSide, i + kSide * kSide};
    grid->InsertNextCell(i % 5 == 3 ? VTK_TRIANGLE : VTK_TETRA, i % 5 == 3 ? 3 : 4, ids);
  }
  const vtkIdType faces[16] = {3, 0, 1, 6, 3, 0, 1, 36, 3, 1, 6, 36, 3, 0, 6, 36};
  grid->InsertNextCell(VTK_POLYHEDRON, 4, faces);
  return grid;
}

TEST(VtuRanges, areTheSameAsThePartsOfTheWhole) {
  const auto grid = row();
  const auto points = static_cast<std::uint64_t>(grid->GetNumberOfPoints()),
             cells = static_cast<std::uint64_t>(grid->GetNumberOfCells());
  for (const int mode : {vtkXMLWriter::Appended, vtkXMLWriter::Binary, vtkXMLWriter::Ascii})
    for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZMA}) {
      testing::Encoding as{mode, compressor};
      as.block = 1600;  // so that a range ends within one
      const auto file =
          VtuFile::open(testing::fileWith("ranges.vtu", testing::writtenByVtk(grid, as)));
      ASSERT_TRUE(file);
      const auto document = readVtuDocument(*file);
      ASSERT_TRUE(document) << document.error().text();
      const VtuPiece& piece = document->pieces.front();
      for (const std::uint64_t step : {1u, 7u, 1000u})
        for (std::uint64_t first = 0; first < points; first += 97 * step) {
          const VtuRange range{first, std::min(step, points - first)};
          const auto places = readVtuPointRange(*file, *document, piece, range);
          const auto values =
              readVtuValueRange(*file, *document, piece.pointFields.arrays.front(), points, range);
          ASSERT_TRUE(places) << places.error().text();
          ASSERT_TRUE(values) << values.error().text();
          ASSERT_EQ(places->size(), range.count);
          ASSERT_EQ(values->size(), 2 * range.count);
          for (std::size_t i = 0; i < range.count; ++i) {
            const auto number = static_cast<double>(first + i);
            EXPECT_EQ((*values)[2 * i], number);
            EXPECT_EQ((*values)[2 * i + 1], -number);
            Position wanted{};
            grid->GetPoint(static_cast<vtkIdType>(first + i), wanted.data());
            EXPECT_EQ((*places)[i], wanted);
          }
        }
      for (const std::uint64_t step : {1u, 50u, 1000u})
        for (std::uint64_t first = 0; first + 1 < cells; first += 53 * step) {
          const VtuRange range{first, std::min(step, cells - 1 - first)};
          const auto mesh = readVtuCellRange(*file, *document, piece, range);
          ASSERT_TRUE(mesh) << mesh.error().text();
          ASSERT_EQ(mesh->cells(), range.count);
          for (std::size_t i = 0; i < range.count; ++i) {
            const auto id = static_cast<vtkIdType>(first + i);
            EXPECT_EQ(mesh->cellId(i), first + i);
            EXPECT_EQ(int{mesh->types[i]}, grid->GetCellType(id));
            vtkNew<vtkIdList> wanted;
            grid->GetCellPoints(id, wanted);
            EXPECT_TRUE(
                std::ranges::equal(mesh->cell(i), std::span(wanted->begin(), wanted->end())));
          }
        }
      const auto all = readVtuCellRange(*file, *document, piece, {0, cells});
      ASSERT_FALSE(all);
      EXPECT_NE(all.error().message.find("is a polyhedron"), std::string::npos);
      EXPECT_TRUE(readVtuCellRange(*file, *document, piece, {cells, 0}));
    }
}

}  // namespace
}  // namespace qtet

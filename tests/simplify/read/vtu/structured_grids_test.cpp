// Structured, rectilinear and image files beside VTK's own reading of them.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLStructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>

#include "simplify/read/read_mesh.h"
#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::addArray;
using testing::Encoding;

/// Extents that do not begin at 0.
std::array<int, 6> extent() { return {3, 7, -2, 1, 5, 8}; }
constexpr vtkIdType kGridPoints = 5 * 4 * 4, kGridCells = 4 * 3 * 3;

void addFields(vtkDataSet& grid) {
  addArray<vtkFloatArray>(*grid.GetPointData(), "T", 1, grid.GetNumberOfPoints());
  addArray<vtkDoubleArray>(*grid.GetCellData(), "U", 3, grid.GetNumberOfCells());
}

/// Marks each seventh with `bit`, beside bits that mean nothing here.
void addGhosts(vtkFieldData& fields, vtkIdType count, unsigned char bit) {
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName("vtkGhostType");
  for (vtkIdType i = 0; i < count; ++i)
    ghosts->InsertNextValue(i % 7 == 2 ? bit : i % 3 == 0 ? 4 : 0);
  fields.AddArray(ghosts);
}

vtkNew<vtkImageData> image() {
  vtkNew<vtkImageData> grid;
  grid->SetExtent(extent().data());
  grid->SetOrigin(0.1, -7, 1e5);
  grid->SetSpacing(0.3, 1.0 / 3, 2);
  vtkNew<vtkMatrix3x3> turned;
  turned->SetElement(0, 0, 0.6), turned->SetElement(0, 1, -0.8);
  turned->SetElement(1, 0, 0.8), turned->SetElement(1, 1, 0.6);
  grid->SetDirectionMatrix(turned);
  addFields(*grid);
  addGhosts(*grid->GetCellData(), kGridCells, 1);
  return grid;
}

vtkNew<vtkRectilinearGrid> rectilinear() {
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetExtent(extent().data());
  const auto axis = [](int points, double step) {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    for (int i = 0; i < points; ++i) array->InsertNextValue(static_cast<float>(step * i * i));
    return array;
  };
  grid->SetXCoordinates(axis(5, 0.1));
  grid->SetYCoordinates(axis(4, 0.7));
  grid->SetZCoordinates(axis(4, 3));
  addFields(*grid);
  return grid;
}

vtkNew<vtkStructuredGrid> structured(unsigned char hiddenPoints) {
  vtkNew<vtkStructuredGrid> grid;
  grid->SetExtent(extent().data());
  grid->SetPoints(testing::scatteredPoints(kGridPoints));
  addFields(*grid);
  if (hiddenPoints != 0) addGhosts(*grid->GetPointData(), kGridPoints, hiddenPoints);
  return grid;
}

template <class Writer, class Grid>
fs::path written(Grid* grid, const char* ending, const Encoding& as) {
  vtkNew<Writer> writer;
  writer->SetInputData(grid);
  writer->SetDataMode(as.mode);
  writer->SetCompressorType(as.compressor);
  writer->SetByteOrder(as.order);
  writer->SetEncodeAppendedData(as.base64);
  writer->SetBlockSize(as.block);
  const fs::path path = testing::freshFolder("structured") / (std::string("grid") + ending);
  writer->SetFileName(path.c_str());
  writer->Write();
  return path;
}

template <class Reader>
testing::Way byVtk(const fs::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  testing::Way out{CellMesh{}, {}};
  out.mesh = testing::cellsOf(*reader->GetOutput(), std::nullopt, path, out.report);
  return out;
}

template <class Writer, class Reader, class Grid>
void expectAlike(Grid* grid, const char* ending) {
  for (const int mode : {vtkXMLWriter::Appended, vtkXMLWriter::Binary, vtkXMLWriter::Ascii}) {
    Encoding as{mode, mode == vtkXMLWriter::Binary ? vtkXMLWriter::NONE : vtkXMLWriter::ZLIB};
    as.base64 = false;
    as.block = 512;
    const fs::path path = written<Writer>(grid, ending, as);
    testing::expectSame(testing::readByOurs(path), byVtk<Reader>(path),
                        ending + std::to_string(mode));
  }
}

TEST(StructuredGrids, areReadAsVtkReadsThem) {
  expectAlike<vtkXMLImageDataWriter, vtkXMLImageDataReader>(image().Get(), ".vti");
  expectAlike<vtkXMLRectilinearGridWriter, vtkXMLRectilinearGridReader>(rectilinear().Get(),
                                                                        ".vtr");
  for (const unsigned char hidden : {std::uint8_t{0}, std::uint8_t{2}})
    expectAlike<vtkXMLStructuredGridWriter, vtkXMLStructuredGridReader>(structured(hidden).Get(),
                                                                        ".vts");
}

TEST(StructuredGrids, flatOnesHaveNoVolumes) {
  vtkNew<vtkImageData> flat;
  flat->SetDimensions(4, 1, 5);
  addFields(*flat);
  const fs::path path = written<vtkXMLImageDataWriter>(flat.Get(), ".vti", {});
  const testing::Way ours = testing::readByOurs(path);
  testing::expectSame(ours, byVtk<vtkXMLImageDataReader>(path), "flat");
  EXPECT_EQ(ours.report.ignoredCells, 12u);
}

TEST(StructuredGrids, piecesOfOneFileAreJoined) {
  ReadReport report;
  const auto cells = readStoredCells(
      testing::fileWith("two.vti",
                        "<VTKFile type=\"ImageData\"><ImageData><Piece Extent=\"0 1 0 1 0 1\"/>"
                        "<Piece Extent=\"1 2 0 1 0 1\"/></ImageData></VTKFile>"),
      {}, report);
  ASSERT_TRUE(cells) << cells.error().text();
  EXPECT_EQ(cells->points.size(), 12u);
  EXPECT_EQ(report.joinedPoints, 4u);
}

/// The message of reading a .vtr or .vti whose grid has this text in it.
std::string refusal(const std::string& type, const std::string& grid) {
  const std::string ending = type == "ImageData" ? "vti" : "vtr";
  const auto read = testing::readByOurs(testing::fileWith(
      "wrong." + ending,
      "<VTKFile type=\"" + type + "\"><" + type + grid + "</" + type + "></VTKFile>"));
  return read.mesh ? "" : read.mesh.error().message;
}

TEST(StructuredGrids, whatTheirFilesCannotMeanIsRefused) {
  const std::string piece = "><Piece Extent=\"0 1 0 1 0 1\"/>", corners = "0 1 0 1 0 ";
  EXPECT_EQ(refusal("ImageData", piece), "");
  const auto image = [&](const std::string& extent, const std::string& attributes = "") {
    return refusal("ImageData", attributes + "><Piece Extent=\"" + extent + "\"/>");
  };
  EXPECT_NE(refusal("ImageData", "><Piece/>").find("no Extent"), std::string::npos);
  EXPECT_NE(image("0 1 0 1 0").find("not 6 numbers"), std::string::npos);
  EXPECT_NE(image(corners + "9999999999").find("not 6 numbers"), std::string::npos);
  EXPECT_NE(image(corners + "1", " Origin=\"0 0 nan\"").find("Origin"), std::string::npos);
  EXPECT_NE(image(corners + "1", " Spacing=\"1 1\"").find("Spacing"), std::string::npos);
  EXPECT_NE(image(corners + "1", " Direction=\"1\"").find("Direction"), std::string::npos);
  EXPECT_NE(image(corners + "1000000").find("cannot hold"), std::string::npos);
  EXPECT_NE(image("0 65535 0 65535 0 1").find("2^32"), std::string::npos);
  EXPECT_NE(refusal("RectilinearGrid", piece).find("three arrays"), std::string::npos);
}

TEST(StructuredGrids, damageIsAnErrorOrAMesh) {
  std::mt19937 random(3);
  for (const bool raw : {false, true}) {
    Encoding as;
    as.base64 = !raw;
    std::ifstream file(written<vtkXMLStructuredGridWriter>(structured(2).Get(), ".vts", as),
                       std::ios::binary);
    const std::string sound{std::istreambuf_iterator<char>(file), {}};
    int refused = 0;
    for (int copy = 0; copy < 200; ++copy) {
      std::string damaged = sound;
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      if (!testing::readByOurs(testing::fileWith("damaged.vts", damaged)).mesh) ++refused;
    }
    EXPECT_GT(refused, 50);
  }
}

}  // namespace
}  // namespace qtet

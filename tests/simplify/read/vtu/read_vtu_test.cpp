// Our own reader of .vtu beside VTK's, on files of every encoding.
#include "simplify/read/vtu/read_vtu.h"

#include <gtest/gtest.h>
#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkGenericCell.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkShortArray.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkUnsignedLongLongArray.h>
#include <vtkUnsignedShortArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "codec/files/vtu_writer.h"
#include "codec/refine/log_file.h"
#include "simplify/log/write_mesh.h"
#include "simplify/pipeline/pipeline.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/read/read_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/simplify/read/vtu/vtk_written.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::Encoding;
using testing::expectSame;
using testing::fileWith;
using testing::readByOurs;
using testing::readByVtk;

TEST(ReadVtu, namesOfValuesComeBackFromFilesAndLogs) {
  TetMesh mesh = boxSample();
  MeshField part{"Part<1>", 1,      "int32",
                 {},        "cell", {{-3, "steel & oil"}, {5, "Öl = 1"}, {9, "no"}}};
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    part.values.push_back(c < mesh.tetrahedra.size() / 2 ? -3 : 5);
  mesh.fields.push_back(part);
  const auto read = [](const Bytes& file) {
    Result<ReadMesh> found = readMesh(fileWith("names.vtu", std::string(file.begin(), file.end())));
    EXPECT_TRUE(found) << found.error().text();
    return found ? found->mesh.fields.back().labelNames : LabelNames{};
  };
  EXPECT_EQ(read(vtuBytes(mesh)), part.labelNames);
  const Result<PipelineOutput> made = simplifyToLog(std::move(mesh), {});
  ASSERT_TRUE(made) << made.error().text();
  LabelNames known = part.labelNames;
  known.erase(9);  // no cell has it
  EXPECT_EQ(made->report.manifest.labels, (Labels{{part.name, known}}));
  const Result<LogFile> log = LogFile::fromBytes(made->log.bytes().value());
  ASSERT_TRUE(log);
  EXPECT_EQ(read(vtuBytes(meshAtLevel(*log, 0).value())), known);
}

template <class Array>
void addArray(vtkFieldData& to, const char* name, int components, vtkIdType tuples, bool isText) {
  auto* array = testing::addArray<Array>(to, name, components, tuples);
  if (array->GetDataType() == VTK_FLOAT && !isText && tuples > 3)
    array->SetComponent(3, 0, std::numeric_limits<double>::quiet_NaN());
}

/// Cells of every dimension, a polyhedron, ghosts, and fields of every kind. VTK reads no NaN from
/// text.
vtkNew<vtkUnstructuredGrid> everything(bool isText) {
  vtkNew<vtkUnstructuredGrid> grid;
  constexpr vtkIdType kPoints = 151;
  grid->SetPoints(testing::scatteredPoints(kPoints));
  constexpr std::array<std::pair<int, int>, 8> kKinds{{{VTK_TETRA, 4},
                                                       {VTK_TRIANGLE, 3},
                                                       {VTK_HEXAHEDRON, 8},
                                                       {VTK_VERTEX, 1},
                                                       {VTK_WEDGE, 6},
                                                       {VTK_QUADRATIC_TETRA, 10},
                                                       {VTK_PYRAMID, 5},
                                                       {VTK_LAGRANGE_HEXAHEDRON, 27}}};
  for (vtkIdType i = 0; i < 120; ++i) {
    const auto [type, nodes] = kKinds[static_cast<std::size_t>(i) % kKinds.size()];
    std::array<vtkIdType, 27> ids{};
    for (int k = 0; k < nodes; ++k) ids[static_cast<std::size_t>(k)] = (i + 3 * k) % kPoints;
    grid->InsertNextCell(type, nodes, ids.data());
    if (i % 20 != 7) continue;
    const std::array<vtkIdType, 4> corners{i, i + 1, i + 2, i + 3};
    const std::array<vtkIdType, 16> faces{3, i, i + 1, i + 2, 3, i,     i + 1, i + 3,
                                          3, i, i + 2, i + 3, 3, i + 1, i + 2, i + 3};
    grid->InsertNextCell(VTK_POLYHEDRON, 4, corners.data(), 4, faces.data());
  }
  const vtkIdType cells = grid->GetNumberOfCells();
  addArray<vtkDoubleArray>(*grid->GetPointData(), "double", 3, kPoints, isText);
  addArray<vtkFloatArray>(*grid->GetPointData(), "float", 1, kPoints, isText);
  addArray<vtkSignedCharArray>(*grid->GetPointData(), "int8", 1, kPoints, isText);
  addArray<vtkUnsignedShortArray>(*grid->GetPointData(), "uint16", 2, kPoints, isText);
  addArray<vtkIntArray>(*grid->GetPointData(), "seventeen", 17, kPoints, isText);
  addArray<vtkIdTypeArray>(*grid->GetPointData(), "GlobalPointIds", 1, kPoints, isText);
  vtkNew<vtkStringArray> words;
  words->SetName("words");
  for (vtkIdType i = 0; i < kPoints; ++i) words->InsertNextValue("some");
  grid->GetPointData()->AddArray(words);
  vtkNew<vtkBitArray> bits;
  bits->SetName("bits");
  for (vtkIdType i = 0; i < kPoints; ++i) bits->InsertNextValue(i % 3 == 0 ? 1 : 0);
  grid->GetPointData()->AddArray(bits);
  addArray<vtkShortArray>(*grid->GetCellData(), "int16", 1, cells, isText);
  addArray<vtkUnsignedIntArray>(*grid->GetCellData(), "uint32", 1, cells, isText);
  addArray<vtkUnsignedLongLongArray>(*grid->GetCellData(), "uint64", 2, cells, isText);
  addArray<vtkFloatArray>(*grid->GetCellData(), "float", 3, cells, isText);
  vtkNew<vtkUnsignedCharArray> ghosts;  // cell 8 is a polyhedron, before others
  ghosts->SetName("vtkGhostType");
  for (vtkIdType i = 0; i < cells; ++i)
    ghosts->InsertNextValue(i % 11 == 0 || i == 8 ? 1 : i % 13 == 0 ? 32 : i % 17 == 0 ? 2 : 0);
  grid->GetCellData()->AddArray(ghosts);
  return grid;
}

TEST(ReadVtu, everyEncodingOfVtkGivesWhatVtkGives) {
  for (const int mode : {vtkXMLWriter::Appended, vtkXMLWriter::Binary, vtkXMLWriter::Ascii}) {
    const auto grid = everything(mode == vtkXMLWriter::Ascii);
    for (const int compressor :
         {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA}) {
      for (const Encoding& as :
           {Encoding{mode, compressor},
            Encoding{mode, compressor, vtkXMLWriter::BigEndian, vtkXMLWriter::UInt64, false, 1600},
            Encoding{mode, compressor, vtkXMLWriter::BigEndian, vtkXMLWriter::UInt32, true, 5000},
            Encoding{mode, compressor, vtkXMLWriter::LittleEndian, vtkXMLWriter::UInt64, false}}) {
        const fs::path path = fileWith("every.vtu", testing::writtenByVtk(grid, as));
        const std::string what = "mode " + std::to_string(mode) + ", compressor " +
                                 std::to_string(compressor) + ", block " + std::to_string(as.block);
        const testing::Way vtk = readByVtk(path);
        ASSERT_TRUE(vtk.mesh);
        ASSERT_EQ(vtk.mesh->fields.size(), 10u);
        ASSERT_GT(vtk.mesh->cellIds.size(), 40u);
        expectSame(readByOurs(path), vtk, what);
        const FieldNames some = std::vector<std::string>{"cell:float", "int8"};
        expectSame(readByOurs(path, some), readByVtk(path, some), what);
      }
    }
  }
}

TEST(ReadVtu, theMeshesOfTheTestsAndTheSamplesAreThoseOfVtk) {
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(testing::kSourceFolder) /
                                                            "tests/simplify/read/meshes")) {
    if (entry.path().extension() != ".vtu") continue;
    expectSame(readByOurs(entry.path()), readByVtk(entry.path()), entry.path().string());
    ++files;
  }
  EXPECT_GE(files, 3u);
  for (const Sample& sample : samples()) {
    const Bytes bytes = vtuBytes(sample.make(sample.cells));
    const fs::path path =
        fileWith(std::string(sample.name) + ".vtu", std::string(bytes.begin(), bytes.end()));
    expectSame(readByOurs(path), readByVtk(path), std::string(sample.name));
  }
}

/// Two pieces of text, the second with a polyhedron and in the order of the first.
std::string twoPieces() {
  const auto array = [](const char* type, const std::string& attributes, const char* numbers) {
    return std::string("<DataArray type=\"") + type + "\" " + attributes + " format=\"ascii\">" +
           numbers + "</DataArray>";
  };
  const std::string points =
      "<Points>" + array("Float32", "NumberOfComponents=\"3\"", "0 0 0 1 0 0 0 1 0 0 0 1") +
      "</Points>";
  const std::string fields =
      "<PointData GlobalIds=\"gid\">" + array("Int32", "Name=\"gid\"", "5 6 7 8") +
      array("Int32", "Name=\"gid\"", "5 6 7 8") +
      array("Float32", "Name=\"" + std::string(300, 'n') + "\"", "1 2 3 4e-40") +
      "</PointData><CellData>" + array("Int8", "Name=\"c\" NumberOfComponents=\"0\"", "-5") +
      "</CellData>";
  const auto cells = [&](const char* type, const std::string& more) {
    return "<Cells>" + array("Int32", "Name=\"connectivity\"", "3 2 1 0") +
           array("Int64", "Name=\"offsets\"", "4") + array("UInt8", "Name=\"types\"", type) + more +
           "</Cells>";
  };
  const std::string faces = array("Int64", "Name=\"faces\"", "4 3 0 1 2 3 0 1 3 3 0 2 3 3 1 2 3") +
                            array("Int64", "Name=\"faceoffsets\"", "17");
  const std::string piece = "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">";
  return "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><UnstructuredGrid><FieldData>" +
         array("Float64", "Name=\"TimeValue\" NumberOfTuples=\"1\"", "0.5") + "</FieldData>" +
         piece + points + fields + cells("10", "") + "</Piece>" + piece + fields + points +
         cells("42", faces) + "</Piece></UnstructuredGrid></VTKFile>";
}

TEST(ReadVtu, piecesFollowOneAnotherAsVtkJoinsThem) {
  const fs::path path = fileWith("pieces.vtu", twoPieces());
  const testing::Way ours = readByOurs(path);
  ASSERT_TRUE(ours.mesh) << ours.mesh.error().text();
  ASSERT_EQ(ours.mesh->cells(), 2u);
  EXPECT_EQ(ours.mesh->vertices[4 + 2], 4u) << "the second piece's points follow the first's";
  std::string once = twoPieces();  // VTK itself confuses arrays of one name
  const std::string twice =
      "<DataArray type=\"Int32\" Name=\"gid\" format=\"ascii\">5 6 7 8"
      "</DataArray>";
  for (std::size_t at = once.find(twice + twice); at != std::string::npos;
       at = once.find(twice + twice))
    once.erase(at, twice.size());
  const fs::path without = fileWith("pieces-once.vtu", once);
  expectSame(readByOurs(without), readByVtk(without), "once");
  expectSame(ours, readByOurs(without), "twice");
}

TEST(ReadVtu, textMayHaveValuesThatAreNotFinite) {
  std::string text = twoPieces();
  for (std::size_t at = 0; (at = text.find("1 2 3 4e-40")) != std::string::npos;)
    text.replace(at, 11, "NaN nan -inf Infinity");
  const testing::Way read = readByOurs(fileWith("not-finite.vtu", text));
  ASSERT_TRUE(read.mesh) << read.mesh.error().text();
  const auto field = std::ranges::find(read.mesh->fields, "float32", &MeshField::type);
  ASSERT_NE(field, read.mesh->fields.end());
  EXPECT_TRUE(std::isnan(field->values[0]) && std::isnan(field->values[1]));
  EXPECT_EQ(field->values[2], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(field->values[3], std::numeric_limits<double>::infinity());
  text.replace(text.find("5 6 7 8"), 7, "nan 6 7");
  EXPECT_FALSE(readByOurs(fileWith("no-integer.vtu", text)).mesh);
}

TEST(ReadVtu, polyhedraOfNewerFilesShareTheirFaces) {
  const fs::path old = fileWith("old.vtu", twoPieces());
  std::string text = twoPieces();
  const std::string from = text.substr(text.find("<DataArray type=\"Int64\" Name=\"faces\""));
  const std::string faces = from.substr(0, from.find("</Cells>"));
  text.replace(text.find(faces), faces.size(),
               "<DataArray type=\"Int64\" Name=\"face_connectivity\">1 2 3 0 2 3 0 1 3 0 1 2"
               "</DataArray><DataArray type=\"Int64\" Name=\"face_offsets\">3 6 9 12</DataArray>"
               "<DataArray type=\"Int64\" Name=\"polyhedron_to_faces\">3 2 1 0</DataArray>"
               "<DataArray type=\"Int64\" Name=\"polyhedron_offsets\">4</DataArray>");
  expectSame(readByOurs(fileWith("new.vtu", text)), readByOurs(old), "shared faces");
}

TEST(ReadVtu, aTimeOfTheFileIsAStepsTime) {
  const std::filesystem::path path = fileWith("time.vtu", twoPieces());
  ReadOptions options;
  options.time = "0.5";
  EXPECT_TRUE(readMesh(path, options));
  options.time = "0.25";
  const Result<ReadMesh> read = readMesh(path, options);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kNotFound);
  EXPECT_NE(read.error().message.find("it has 0.5"), std::string::npos) << read.error().text();
}

TEST(ReadVtu, dimensionsOfCellsAreThoseOfVtk) {
  for (int type = 0; type < 256; ++type) {
    const auto cell = type == VTK_EMPTY_CELL
                          ? nullptr
                          : vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
    const int vtks = cell ? cell->GetCellDimension() : type == VTK_EMPTY_CELL ? 0 : 3;
    EXPECT_EQ(dimensionOf(static_cast<std::uint8_t>(type)), vtks) << type;
  }
}

}  // namespace
}  // namespace qtet

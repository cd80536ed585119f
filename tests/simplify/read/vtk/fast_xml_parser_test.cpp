// Our ways through base64 and zlib beside VTK's own, on files of every encoding that VTK writes,
// sound and damaged.
#include "simplify/read/vtk/fast_xml_parser.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <array>
#include <fstream>
#include <random>
#include <string>

#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::Encoding;

/// `points` random points, cells between them, and a field of bytes, whose arrays' lengths so take
/// every remainder of three.
vtkNew<vtkUnstructuredGrid> randomGrid(int points) {
  std::mt19937 random(static_cast<unsigned>(points));
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> places;
  vtkNew<vtkUnsignedCharArray> bytes;
  bytes->SetName("Bytes");
  for (int i = 0; i < points; ++i) {
    const std::array place{static_cast<double>(random() % 1000),
                           static_cast<double>(random() % 1000),
                           static_cast<double>(random() % 1000)};
    places->InsertNextPoint(place.data());
    bytes->InsertNextValue(static_cast<unsigned char>(random() % 7));
  }
  grid->SetPoints(places);
  grid->GetPointData()->AddArray(bytes);
  for (int i = 0; i + 3 < points; ++i) {
    const vtkIdType ids[4] = {i, i + 1, i + 2, i + 3};
    grid->InsertNextCell(VTK_TETRA, 4, ids);
  }
  return grid;
}

/// Everything that a reader gives, as text.
template <class Reader>
std::string readBy(const std::string& file) {
  static const fs::path path = testing::freshFolder("xml-parser-read") / "read.vtu";
  std::ofstream(path, std::ios::binary | std::ios::trunc) << file;
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(path.c_str());
  reader->Update();
  std::string out = std::to_string(reader->GetErrorCode());
  vtkUnstructuredGrid* grid = reader->GetOutput();
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    for (const double x : {grid->GetPoint(i)[0], grid->GetPoint(i)[1], grid->GetPoint(i)[2]})
      out += ' ' + std::to_string(x);
    vtkDataArray* bytes = grid->GetPointData()->GetArray("Bytes");
    out += bytes && i < bytes->GetNumberOfTuples() ? ' ' + std::to_string(bytes->GetTuple1(i))
                                                   : " none";
  }
  if (!grid->GetCells()) return out;
  for (vtkDataArray* array :
       {grid->GetCells()->GetConnectivityArray(), grid->GetCells()->GetOffsetsArray()}) {
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
      out += ' ' + std::to_string(array->GetTuple1(i));
  }
  return out;
}

std::string readByVtk(const std::string& file) {
  return readBy<vtkXMLUnstructuredGridReader>(file);
}
std::string readByOurs(const std::string& file) {
  return readBy<FastXmlReader<vtkXMLUnstructuredGridReader>>(file);
}

TEST(FastXmlParser, readsWhatVtkWritesInEveryEncoding) {
  for (int points = 40; points < 46; ++points) {
    const auto grid = randomGrid(points);
    for (const int mode : {vtkXMLWriter::Appended, vtkXMLWriter::Binary, vtkXMLWriter::Ascii}) {
      for (const int compressor :
           {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA}) {
        for (const bool plain : {false, true}) {
          Encoding as{mode, compressor};
          if (plain)
            as = {mode, compressor, vtkXMLWriter::BigEndian, vtkXMLWriter::UInt64, false, 128};
          const std::string file = testing::writtenByVtk(grid, as);
          const std::string expected = readByVtk(file);
          ASSERT_GT(expected.size(), 1000u);
          EXPECT_EQ(readByOurs(file), expected)
              << points << " points, mode " << mode << ", compressor " << compressor;
        }
      }
    }
  }
}

TEST(FastXmlParser, arraysLongerThanItTakesAtOnceAreRead) {
  const auto grid = randomGrid(20000);
  for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB}) {
    const std::string file = testing::writtenByVtk(grid, {vtkXMLWriter::Appended, compressor});
    EXPECT_EQ(readByOurs(file), readByVtk(file));
  }
}

TEST(FastXmlParser, aDamagedFileGivesWhatItGivesVtk) {
  const std::string file = testing::writtenByVtk(randomGrid(2000), {}), nothing = "0";
  // characters: one block's sizes, of which damage may crash VTK, and what is less than the block
  constexpr std::size_t kHeader = 24, kBlock = 500;
  const std::size_t data = file.find('_', file.find("<AppendedData")) + 1 + kHeader;
  std::mt19937 random(7);
  int refused = 0;
  for (int copy = 0; copy < 60; ++copy) {
    std::string damaged = file;
    const std::size_t at = data + random() % kBlock;
    damaged[at] = copy % 3 == 0   ? '='
                  : copy % 3 == 1 ? '\n'
                                  : static_cast<char>('A' + random() % 26);
    const std::string ours = readByOurs(damaged);
    if (ours == nothing) ++refused;
    ASSERT_EQ(ours, readByVtk(damaged)) << "byte " << at << " of copy " << copy;
  }
  EXPECT_GT(refused, 50);
}

// VTK itself reads beyond its arrays on some of these.
TEST(FastXmlParser, damagedSizesOfBlocksAreAnErrorOrAMesh) {
  std::mt19937 random(3);
  const std::string nothing = "0";
  for (const bool raw : {false, true}) {
    for (const int order : {vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian}) {
      for (const int header : {vtkXMLWriter::UInt32, vtkXMLWriter::UInt64}) {
        const std::string file = testing::writtenByVtk(
            randomGrid(2000), {vtkXMLWriter::Appended, vtkXMLWriter::ZLIB, order, header, !raw});
        const std::size_t data = file.find('_', file.find("<AppendedData")) + 1,
                          words = header == vtkXMLWriter::UInt32 ? 12 : 24;
        int refused = 0;
        for (int copy = 0; copy < 60; ++copy) {
          std::string damaged = file;
          damaged[data + random() % (raw ? words : words / 3 * 4)] =
              raw ? static_cast<char>(random() % 256) : static_cast<char>('A' + random() % 26);
          if (readByOurs(damaged) == nothing) ++refused;
        }
        EXPECT_GT(refused, 20) << "raw " << raw << ", order " << order << ", header " << header;
      }
    }
  }
}

TEST(FastXmlParser, anArrayThatEndsTooEarlyIsRefused) {
  const std::string file =
      testing::writtenByVtk(randomGrid(41), {vtkXMLWriter::Appended, vtkXMLWriter::NONE});
  const std::size_t data = file.find('_', file.find("<AppendedData")) + 1;
  std::string damaged = file;
  damaged[data + 202] = damaged[data + 203] = '=';  // in the middle of the points or the field
  const std::string nothing = "0";
  EXPECT_EQ(readByOurs(damaged), nothing);
  EXPECT_NE(readByOurs(file), nothing);
}

}  // namespace
}  // namespace qtet

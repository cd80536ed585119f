// Damaged .vtu files end with an error or a mesh, quickly and in little memory.
#include <gtest/gtest.h>
#include <vtkCellType.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <array>
#include <string>
#include <vector>

#include "simplify/read/read_mesh.h"
#include "tests/simplify/read/vtu/vtk_written.h"
#include "tests/support/allocation_meter.h"

namespace qtet {
namespace {

using testing::Encoding;
using testing::fileWith;

/// A small file may take its bytes, inflated a thousand times.
constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

vtkNew<vtkUnstructuredGrid> smallGrid() {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> field;
  field->SetName("f");
  field->SetNumberOfComponents(2);
  for (int i = 0; i < 24; ++i) {
    points->InsertNextPoint(i % 3, i % 5, i % 7);
    field->InsertNextTuple2(i, -i);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(field);
  for (vtkIdType i = 0; i < 20; ++i) {
    const std::array<vtkIdType, 16> faces{3, i, i + 1, i + 2, 3, i,     i + 1, i + 3,
                                          3, i, i + 2, i + 3, 3, i + 1, i + 2, i + 3};
    const std::array<vtkIdType, 4> ids{i, i + 1, i + 2, i + 3};
    if (i == 9)
      grid->InsertNextCell(VTK_POLYHEDRON, 4, ids.data(), 4, faces.data());
    else
      grid->InsertNextCell(VTK_TETRA, 4, ids.data());
  }
  return grid;
}

const std::vector<Encoding>& encodings() {
  static const std::vector<Encoding> all{{vtkXMLWriter::Ascii, vtkXMLWriter::NONE},
                                         {vtkXMLWriter::Binary, vtkXMLWriter::ZLIB},
                                         {vtkXMLWriter::Appended, vtkXMLWriter::NONE,
                                          vtkXMLWriter::BigEndian, vtkXMLWriter::UInt64, false},
                                         {vtkXMLWriter::Appended, vtkXMLWriter::LZ4},
                                         {vtkXMLWriter::Appended, vtkXMLWriter::LZMA,
                                          vtkXMLWriter::LittleEndian, vtkXMLWriter::UInt64, false}};
  return all;
}

/// The error's text, or nothing; the peak is checked.
std::string endOf(const std::string& text, const std::string& what) {
  const std::filesystem::path path = fileWith("damaged.vtu", text);
  std::string out;
  const std::size_t peak = testing::peakBytesOf([&] {
    const testing::Way read = testing::readByOurs(path);
    if (!read.mesh) out = read.mesh.error().message;
  });
  EXPECT_LT(peak, kMaxBytes) << what;
  return out;
}

TEST(DamagedVtu, everyAttributeMayHaveAnyValue) {
  constexpr std::array<const char*, 12> kHostile{"-1",
                                                 "0",
                                                 "2147483647",
                                                 "2147483648",
                                                 "4294967296",
                                                 "4611686018427387904",
                                                 "9223372036854775808",
                                                 "18446744073709551615",
                                                 "",
                                                 "abc",
                                                 "NaN",
                                                 "1e9"};
  std::size_t refused = 0, files = 0;
  for (const Encoding& as : encodings()) {
    const std::string file = testing::writtenByVtk(smallGrid(), as);
    const std::size_t data = std::min(file.find("<AppendedData") + 40, file.size());
    for (std::size_t at = file.find("=\""); at < data; at = file.find("=\"", at + 1)) {
      const std::size_t end = file.find('"', at + 2);
      for (const char* value : kHostile) {
        std::string damaged = file;
        damaged.replace(at + 2, end - at - 2, value);
        ++files;
        if (!endOf(damaged, file.substr(std::max<std::size_t>(at, 20) - 20, 40) + " is " + value)
                 .empty())
          ++refused;
      }
    }
  }
  EXPECT_GT(files, 1900u);
  EXPECT_GT(refused, files / 3);
}

TEST(DamagedVtu, aFileCutAnywhereIsRefusedOrWhole) {
  for (const Encoding& as : encodings()) {
    const std::string file = testing::writtenByVtk(smallGrid(), as);
    const std::string close = "\n</VTKFile>\n";
    for (std::size_t length = 0; length + 20 < file.size(); length += 13) {
      const std::string what = "cut at " + std::to_string(length);
      if (file.find("<AppendedData") > length)
        EXPECT_NE(endOf(file.substr(0, length), what), "") << what;
      else
        endOf(file.substr(0, length) + close, what);
    }
  }
}

TEST(DamagedVtu, flippedBytesOfTheDataAreAnErrorOrAMesh) {
  for (const Encoding& as : encodings()) {
    const std::string file = testing::writtenByVtk(smallGrid(), as);
    const std::size_t data = std::min(file.find("<AppendedData"), file.find("<DataArray"));
    for (std::size_t at = data; at < file.size(); at += 7) {
      std::string damaged = file;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
      endOf(damaged, "byte " + std::to_string(at));
    }
  }
}

TEST(DamagedVtu, countsThatKilledTheToolAreRefusedWithASentence) {
  for (const Encoding& as : encodings()) {
    const std::string file = testing::writtenByVtk(smallGrid(), as);
    const auto with = [&](const std::string& attribute, const std::string& value) {
      std::string damaged = file;
      const std::size_t at = damaged.find(attribute + "=\"") + attribute.size() + 2;
      damaged.replace(at, damaged.find('"', at) - at, value);
      const Result<ReadMesh> read = readMesh(fileWith("counts.vtu", damaged));
      EXPECT_FALSE(read) << attribute;
      return read ? "" : read.error().message;
    };
    EXPECT_NE(with("NumberOfCells", "-1").find("NumberOfCells of <Piece> is '-1'"),
              std::string::npos);
    EXPECT_NE(with("NumberOfPoints", "4611686018427387904").find("counts.vtu: line "),
              std::string::npos);
    EXPECT_NE(with("NumberOfComponents", "2147483647").find("counts.vtu: line "),
              std::string::npos);
  }
}

TEST(DamagedVtu, aBlockThatPromisesMoreThanItsBytesCanHoldIsRefusedBeforeAllocating) {
  for (const Encoding& as : encodings()) {
    if (as.compressor == vtkXMLWriter::NONE || as.base64) continue;
    // raw words in front of the first array: blocks, the size of one, of the last, compressed
    for (const int compressor : {vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4}) {
      Encoding raw = as;
      raw.compressor = compressor;
      std::string file = testing::writtenByVtk(smallGrid(), raw);
      const std::size_t words = file.find('_', file.find("<AppendedData")) + 1;
      file[words + 8 + 3] = file[words + 16 + 3] = 0x7F;  // 2 GB in the one block
      EXPECT_NE(endOf(file, "block").find("inflate to"), std::string::npos);
    }
  }
}

TEST(DamagedVtu, cellsOfSixtyTwoBitsOfVerticesEachAreRefused) {
  const Result<ReadMesh> read = readMesh(fileWith(
      "long.vtu",
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">"
      "<UnstructuredGrid><Piece NumberOfPoints=\"1\" NumberOfCells=\"2\"><Points><DataArray "
      "type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points>"
      "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 0</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4611686018427387904 "
      "9223372036854775807</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
      "format=\"ascii\">10 10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput) << read.error().text();
}

TEST(DamagedVtu, entitiesAndDeepElementsAreRefused) {
  std::string text = testing::writtenByVtk(smallGrid(), encodings()[0]);
  const std::size_t root = text.find("<VTKFile");
  const auto with = [&](const std::string& front) {
    return endOf(text.substr(0, root) + front + text.substr(root), front.substr(0, 40));
  };
  EXPECT_EQ(with(""), "");
  EXPECT_NE(with("<!DOCTYPE a [<!ENTITY b \"ccc\">]>").find("document type"), std::string::npos);
  EXPECT_NE(with("<!--" + std::string(3 << 20, 'x') + "-->").find("1048576 bytes"),
            std::string::npos);
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "<a>";
  EXPECT_NE(endOf("<VTKFile>" + deep, "deep").find("nested deeper"), std::string::npos);
}

}  // namespace
}  // namespace qtet

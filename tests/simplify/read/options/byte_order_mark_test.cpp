// Byte order marks before text that other readers than ours read, and UTF-16.
#include "simplify/read/options/byte_order_mark.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "simplify/read/read_mesh.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

using testing::fileWith;

/// Files of one tetrahedron or voxel, each by another reader.
const std::vector<std::pair<std::string, std::string>> kFiles{
    {"image.vtk",
     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
     "ORIGIN 0 0 0\nSPACING 1 1 1\n"},
    {"grid.vtk",
     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
     "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"},
    {"avs.inp", "4 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n"},
    {"gmsh.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
     "$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n"},
    {"grid.vtu",
     "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
     "NumberOfCells=\"1\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
     "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray "
     "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray "
     "type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" "
     "Name=\"types\" format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"},
    {"image.vti",
     "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" "
     "Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 1\"/></ImageData></VTKFile>"},
};

/// ASCII text with two bytes a character.
std::string utf16(const std::string& text, bool isLowFirst) {
  std::string out = isLowFirst ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : text) out += isLowFirst ? std::string{c, '\0'} : std::string{'\0', c};
  return out;
}

TEST(ByteOrderMark, textBehindItIsReadAsIfItWereNotThere) {
  for (const auto& [name, text] : kFiles) {
    const Result<ReadMesh> plain = readMesh(fileWith(name, text));
    ASSERT_TRUE(plain) << plain.error().text();
    const std::filesystem::path file = fileWith(name, std::string(kUtf8Mark) + text);
    const Result<ReadMesh> marked = readMesh(file);
    ASSERT_TRUE(marked) << marked.error().text();
    EXPECT_EQ(marked->mesh.points, plain->mesh.points) << name;
    EXPECT_EQ(marked->mesh.tetrahedra, plain->mesh.tetrahedra) << name;
    EXPECT_FALSE(plain->mesh.tetrahedra.empty()) << name;
  }
}

TEST(ByteOrderMark, anErrorBehindItNamesTheFileAndNoCopy) {
  for (const std::size_t damaged : {0u, 2u}) {
    std::string text = kFiles[damaged].second;
    std::ranges::replace(text, '2', 'x');
    const std::filesystem::path file = fileWith(kFiles[damaged].first, "\xEF\xBB\xBF" + text);
    const Result<ReadMesh> read = readMesh(file);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find(file.string()), std::string::npos) << read.error().text();
    EXPECT_EQ(read.error().message.find("unmark"), std::string::npos) << read.error().text();
  }
}

TEST(ByteOrderMark, utf16IsRefusedByName) {
  std::vector<std::pair<std::string, std::string>> files = kFiles;
  files.emplace_back("run.pvd", "<VTKFile type=\"Collection\"></VTKFile>");
  files.emplace_back("mesh.mesh", "MeshVersionFormatted 2\n");
  files.emplace_back("mesh.unv", "    -1\n  2411\n");
  files.emplace_back("mesh.off", "OFF\n4 4 0\n");
  for (const auto& [name, text] : files)
    for (const bool isLowFirst : {false, true}) {
      const Result<ReadMesh> read = readMesh(fileWith(name, utf16(text, isLowFirst)));
      ASSERT_FALSE(read) << name;
      EXPECT_EQ(read.error().code, ErrorCode::kBadInput) << name;
      EXPECT_NE(read.error().message.find("UTF-16"), std::string::npos) << read.error().text();
    }
}

TEST(ByteOrderMark, numbersOfABinaryFileAreNone) {
  const std::string count{"\xFF\xFE\0\0", 4};
  EXPECT_FALSE(isUtf16(count));
  EXPECT_FALSE(isUtf16("\xFF\xFE"));
  EXPECT_TRUE(isUtf16(utf16("a", true)));
  EXPECT_TRUE(isUtf16(utf16("a", false)));
  EXPECT_EQ(withoutMark("\xEF\xBB\xBF"), "");
  EXPECT_EQ(withoutMark("\xEF\xBB"), "\xEF\xBB");
  EXPECT_FALSE(isMarked(fileWith("mark.off", "\xEF\xBB\xBF"))) << "no text follows it";
  EXPECT_TRUE(isMarked(fileWith("mark.off", "\xEF\xBB\xBF.")));
}

}  // namespace
}  // namespace qtet

// A file that is read piece by piece beside the whole of it.
#include "simplify/read/pieces/vtu_pieces.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <map>

#include "simplify/log/write_mesh.h"
#include "simplify/pieces/cleaned_pieces.h"
#include "simplify/pieces/cut_pieces.h"
#include "simplify/read/read_mesh.h"
#include "tests/simplify/read/vtu/vtk_written.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// Hexahedra, tetrahedra and triangles, with fields of points and cells.
vtkNew<vtkUnstructuredGrid> mixedGrid() {
  constexpr int kSide = 5;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) points->InsertNextPoint(x + 0.1 * y * z, y, z + 0.05 * x * x);
  grid->SetPoints(points);
  const auto at = [](int x, int y, int z) -> vtkIdType {
    return x + kSide * (y + vtkIdType{kSide} * z);
  };
  for (int z = 0; z + 1 < kSide; ++z)
    for (int y = 0; y + 1 < kSide; ++y)
      for (int x = 0; x + 1 < kSide; ++x) {
        const vtkIdType ids[8] = {
            at(x, y, z),     at(x + 1, y, z),     at(x + 1, y + 1, z),     at(x, y + 1, z),
            at(x, y, z + 1), at(x + 1, y, z + 1), at(x + 1, y + 1, z + 1), at(x, y + 1, z + 1)};
        grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
        if (x == 0) grid->InsertNextCell(VTK_TRIANGLE, 3, ids);
      }
  testing::addArray<vtkDoubleArray>(*grid->GetPointData(), "T", 1, grid->GetNumberOfPoints());
  testing::addArray<vtkDoubleArray>(*grid->GetPointData(), "U", 3, grid->GetNumberOfPoints());
  testing::addArray<vtkDoubleArray>(*grid->GetCellData(), "Q", 1, grid->GetNumberOfCells());
  return grid;
}

std::unique_ptr<VtuPieces> opened(const fs::path& path, const ReadOptions& options = {}) {
  std::string why;
  Result<std::unique_ptr<VtuPieces>> out = VtuPieces::open(path, options, why);
  EXPECT_TRUE(out) << out.error().text();
  return out ? std::move(*out) : nullptr;
}

std::string whyNot(const fs::path& path, const ReadOptions& options = {}) {
  std::string why;
  const Result<std::unique_ptr<VtuPieces>> out = VtuPieces::open(path, options, why);
  EXPECT_TRUE(out && !*out);
  return why;
}

/// The pieces as one mesh, in which points of no cell stay at the origin.
TetMesh wholeOf(VtuPieces& pieces, std::size_t pieceCells) {
  EXPECT_TRUE(pieces.begin({}, pieceCells));
  TetMesh out;
  out.points.resize(pieces.points());
  while (true) {
    Result<std::optional<InputPiece>> piece = pieces.next();
    EXPECT_TRUE(piece) << piece.error().text();
    if (!piece || !*piece) return out;
    const TetMesh& mesh = (*piece)->mesh;
    const std::vector<WholeVertex>& names = (*piece)->vertices;
    EXPECT_EQ((*piece)->firstCell, out.tetrahedra.size());
    EXPECT_TRUE(std::ranges::is_sorted(names));
    out.points.resize(std::max<std::size_t>(out.points.size(), names.back() + 1));
    out.pointType = mesh.pointType;
    if (out.fields.empty())
      for (const MeshField& field : mesh.fields) out.fields.push_back(withoutValues(field));
    for (VertexId v = 0; v < names.size(); ++v) out.points[names[v]] = mesh.points[v];
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
      const MeshField& from = mesh.fields[f];
      std::vector<double>& to = out.fields[f].values;
      if (isCellField(from)) {
        to.insert(to.end(), from.values.begin(), from.values.end());
        continue;
      }
      to.resize(out.points.size() * from.components);
      for (VertexId v = 0; v < names.size(); ++v)
        std::copy_n(&from.values[v * from.components], from.components,
                    &to[names[v] * from.components]);
    }
    for (Tetrahedron cell : mesh.tetrahedra) {
      for (VertexId& v : cell) v = static_cast<VertexId>(names[v]);
      out.tetrahedra.push_back(cell);
    }
  }
}

TEST(VtuPieces, areTheWholeFileInPieces) {
  const auto grid = mixedGrid();
  for (const int compressor : {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB}) {
    testing::Encoding as{vtkXMLWriter::Appended, compressor};
    as.block = 1600;
    const fs::path path = testing::fileWith("pieces.vtu", testing::writtenByVtk(grid, as));
    const Result<ReadMesh> whole = readMesh(path);
    ASSERT_TRUE(whole);
    for (const std::size_t cells : {3, 17, 1000}) {
      const auto pieces = opened(path);
      const TetMesh mesh = wholeOf(*pieces, cells);
      EXPECT_EQ(mesh.tetrahedra, whole->mesh.tetrahedra);
      EXPECT_EQ(mesh.points, whole->mesh.points);
      EXPECT_EQ(mesh.pointType, whole->mesh.pointType);
      ASSERT_EQ(mesh.fields.size(), whole->mesh.fields.size());
      for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
        EXPECT_EQ(mesh.fields[f].name, whole->mesh.fields[f].name);
        EXPECT_EQ(mesh.fields[f].type, whole->mesh.fields[f].type);
        EXPECT_EQ(mesh.fields[f].values, whole->mesh.fields[f].values);
      }
      EXPECT_EQ(pieces->report().ignoredCells, whole->report.ignoredCells);
      EXPECT_EQ(pieces->report().split.cells, whole->report.split.cells);
    }
  }
}

TEST(VtuPieces, takeTheFieldsThatAreAskedFor) {
  const fs::path path = testing::fileWith("fields.vtu", testing::writtenByVtk(mixedGrid(), {}));
  ReadOptions options;
  options.fields = {"Q", "U"};
  const TetMesh mesh = wholeOf(*opened(path, options), 20);
  const Result<ReadMesh> whole = readMesh(path, options);
  ASSERT_TRUE(whole && mesh.fields.size() == 2);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(mesh.fields[f].name, whole->mesh.fields[f].name);
    EXPECT_EQ(mesh.fields[f].values, whole->mesh.fields[f].values);
  }
  options.fields = {"none"};
  const auto pieces = opened(path, options);
  EXPECT_EQ(pieces->begin({}).error().code, ErrorCode::kNotFound);
}

/// A .pvtu of files with a range of the sample's cells each.
fs::path partsOf(const TetMesh& mesh, std::size_t count) {
  std::string text =
      "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\"><PUnstructuredGrid GhostLevel=\"0\">";
  const fs::path folder = testing::freshFolder("vtu-parts");
  const std::size_t cells = mesh.tetrahedra.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "part" + std::to_string(i) + ".vtu";
    const TetMesh part = cutOut(mesh, i * cells / count, (i + 1) * cells / count).mesh;
    const Bytes bytes = vtuBytes(part);
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    text += "<Piece Source=\"" + name + "\"/>";
  }
  std::ofstream(folder / "parts.pvtu") << text + "</PUnstructuredGrid></VTKFile>";
  return folder / "parts.pvtu";
}

TEST(VtuPieces, partsOfAPvtuJoinAsInTheWholeReading) {
  const fs::path path = partsOf(boxSample(), 3);
  Result<ReadMesh> whole = readMesh(path);
  ASSERT_TRUE(whole);
  const auto pieces = opened(path);
  EXPECT_EQ(pieces->parts(), 3u);
  ASSERT_TRUE(pieces->begin({}, 400));
  Result<CleanedPieces> own = CleanedPieces::of(*pieces, {});
  ASSERT_TRUE(own) << own.error().text();
  CutPieces cut(std::move(whole->mesh));
  Result<CleanedPieces> expected = CleanedPieces::of(cut, {});
  ASSERT_TRUE(expected);
  const auto joinedOf = [](CleanedPieces& some) {
    std::vector<MeshPiece> all;
    EXPECT_TRUE(some.forEach([&](GivenPiece&& piece) -> Status {
      all.push_back(std::move(piece.piece));
      return {};
    }));
    return joined(all, {some.fields(), 0, 0});
  };
  const MeshPiece a = joinedOf(*own), b = joinedOf(*expected);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.boundary.size(), b.boundary.size());
}

TEST(VtuPieces, saysWhyAFileIsReadAsAWhole) {
  const auto grid = mixedGrid();
  const fs::path binary = testing::fileWith("b.vtu", testing::writtenByVtk(grid, {}));
  const fs::path text = testing::fileWith(
      "t.vtu", testing::writtenByVtk(grid, {vtkXMLWriter::Ascii, vtkXMLWriter::NONE}));
  EXPECT_EQ(whyNot(text), "its numbers are text, of which no range can be read alone");
  EXPECT_EQ(whyNot("mesh.msh"), "only .vtu and .pvtu are read in pieces");
  ReadOptions options;
  options.weld = 0;
  EXPECT_EQ(whyNot(binary, options), "`weld` takes the whole mesh");
}

TEST(VtuPieces, cellsThatAreNoTetrahedraInSeveralPartsAreRefused) {
  const fs::path piece = testing::fileWith("hex.vtu", testing::writtenByVtk(mixedGrid(), {}));
  const fs::path list = piece.parent_path() / "hex.pvtu";
  std::ofstream(list) << "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece "
                         "Source=\"hex.vtu\"/><Piece Source=\"hex.vtu\"/></PUnstructuredGrid>"
                         "</VTKFile>";
  const auto pieces = opened(list);
  ASSERT_TRUE(pieces->begin({}));
  const auto first = pieces->next();
  ASSERT_FALSE(first);
  EXPECT_NE(first.error().message.find("no tetrahedra"), std::string::npos);
}

}  // namespace
}  // namespace qtet

// Which files of a time are fields, and in which order their components stand.
#include "simplify/read/foam/field_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/simplify/read/foam/foam_files.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using testing::writeFoamField;
using Names = std::vector<std::string>;

/// Two cells and three points, as far as fields look at them.
CellMesh twoCellsThreePoints() {
  CellMesh out;
  out.points.resize(3);
  for (int i = 0; i < 2; ++i) out.addCell(kTetrahedronCell, std::vector<VertexId>{0, 1, 2, 0});
  return out;
}

Result<CellMesh> withFields(const fs::path& folder, const FieldNames& wanted = std::nullopt,
                            std::uint64_t room = 1 << 20) {
  CellMesh mesh = twoCellsThreePoints();
  ReadReport report;
  if (Status done = addFoamFields(folder, wanted, kReadPatience, room, mesh, report); !done)
    return std::unexpected(done.error());
  mesh.otherFields.insert(mesh.otherFields.end(), report.notes.begin(), report.notes.end());
  return mesh;
}

Names namesIn(const CellMesh& mesh) {
  Names out;
  for (const MeshField& field : mesh.fields)
    out.push_back(field.association + ":" + field.name + ":" + std::to_string(field.components));
  return out;
}

TEST(FieldFiles, valuesHaveARoomThatFewBytesCannotPass) {
  const fs::path folder = testing::freshFolder("wide-field");
  writeFoamField(folder / "T", "volScalarField ", "uniform 1");
  writeFoamField(folder / "U", "volVectorField", "uniform (1 2 3)");
  constexpr std::uint64_t kBytes = 2 * (1 + 3) * sizeof(double);
  for (const std::uint64_t room : {kBytes - 1, kBytes, kBytes + 1}) {
    const Result<CellMesh> mesh = withFields(folder, std::nullopt, room);
    ASSERT_EQ(mesh.has_value(), room >= kBytes) << room;
    if (mesh) EXPECT_EQ(namesIn(*mesh), (Names{"cell:T:1", "cell:U:3"}));
  }
}

TEST(FieldFiles, anEmptyFileIsLeftOutWithANote) {
  const fs::path folder = testing::freshFolder("empty-field");
  writeFoamField(folder / "T", "volScalarField", "uniform 1");
  const std::ofstream empty(folder / "p");
  const Result<CellMesh> mesh = withFields(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(namesIn(*mesh), Names{"cell:T:1"});
  ASSERT_EQ(mesh->otherFields.size(), 1u);
  EXPECT_TRUE(mesh->otherFields[0].ends_with("p is empty (0 bytes), and was left out"));
}

TEST(FieldFiles, fieldsOfCellsAndPointsAreReadAndOtherFilesSkipped) {
  const fs::path folder = testing::freshFolder("field-files");
  writeFoamField(folder / "T", "volScalarField", "nonuniform List<scalar> 2(5 7)");
  writeFoamField(folder / "T.old", "volScalarField", "nonsense");
  writeFoamField(folder / "T_0", "volScalarField", "nonsense");
  writeFoamField(folder / "T~", "volScalarField", "nonsense");
  writeFoamField(folder / "U", "volVectorField", "uniform (1 2 3)");
  writeFoamField(folder / "S", "volSphericalTensorField", "uniform (4)");
  writeFoamField(folder / "G", "volTensorField", "uniform (1 2 3 4 5 6 7 8 9)");
  writeFoamField(folder / "I", "volScalarField::Internal", "uniform 6");
  writeFoamField(folder / "P", "pointVectorField", "uniform (1 2 3)");
  writeFoamField(folder / "phi", "surfaceScalarField", "uniform 1");
  writeFoamField(folder / "area", "areaScalarField", "uniform 1");
  writeFoamField(folder / "odd", "volLabelField", "uniform 1");
  std::ofstream(folder / "note.txt") << "no field";
  fs::create_directory(folder / "uniform");
  const Result<CellMesh> mesh = withFields(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(namesIn(*mesh),
            (Names{"cell:G:9", "cell:I:1", "point:P:3", "cell:S:1", "cell:T:1", "cell:U:3"}));
  EXPECT_EQ(mesh->fields[2].values.size(), 9u);
  EXPECT_EQ(mesh->fields[4].values, (std::vector<double>{5, 7}));
  EXPECT_EQ(mesh->fields[4].type, "float64");
  const Result<CellMesh> one = withFields(folder, Names{"cell:U", "T"});
  ASSERT_TRUE(one);
  EXPECT_EQ(namesIn(*one), (Names{"cell:T:1", "cell:U:3"}));
  EXPECT_EQ(one->otherFields, (Names{"G", "I", "P", "S"}));
}

TEST(FieldFiles, symmetricTensorsStandInVtksOrder) {
  const fs::path folder = testing::freshFolder("symmetric");
  writeFoamField(folder / "R", "volSymmTensorField",
                 "nonuniform List<symmTensor> 2((1 2 3 4 5 6) (11 12 13 14 15 16))");
  writeFoamField(folder / "V", "volSymmTensorField", "uniform (1 2 3 4 5 6)");
  const Result<CellMesh> mesh = withFields(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->fields[0].values,
            (std::vector<double>{1, 4, 6, 2, 5, 3, 11, 14, 16, 12, 15, 13}));
  EXPECT_EQ(mesh->fields[1].values, (std::vector<double>{1, 4, 6, 2, 5, 3, 1, 4, 6, 2, 5, 3}));
}

TEST(FieldFiles, aDamagedFieldIsRefusedByName) {
  for (const char* value : {"nonuniform List<scalar> 3(5 7 9)", "nonuniform List<scalar> 2(5"}) {
    const fs::path folder = testing::freshFolder("damaged-field");
    writeFoamField(folder / "T", "volScalarField", value);
    const Result<CellMesh> mesh = withFields(folder);
    ASSERT_FALSE(mesh) << value;
    EXPECT_EQ(mesh.error().code, ErrorCode::kBadInput);
    EXPECT_NE(mesh.error().message.find((folder / "T").string()), std::string::npos);
    EXPECT_TRUE(withFields(folder, Names{"U"})) << "nobody asked for it";
  }
}

TEST(FieldFiles, aDamagedGzipFileOfAnyKindIsLeftOutWithANote) {
  const fs::path folder = testing::freshFolder("damaged-gzip");
  writeFoamField(folder / "T", "volScalarField", "uniform 1");
  std::ofstream(folder / "note.gz") << "\x1f\x8b no gzip";
  const Result<CellMesh> mesh = withFields(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(namesIn(*mesh), Names{"cell:T:1"});
  EXPECT_TRUE(mesh->otherFields.at(0).contains("note.gz is damaged"));
}

TEST(FieldFiles, aFieldThatAMacroGivesIsLeftOutWithANote) {
  const fs::path folder = testing::freshFolder("macro-field");
  writeFoamField(folder / "T", "volScalarField", "uniform $hot");
  writeFoamField(folder / "p", "volScalarField", "uniform 1");
  const Result<CellMesh> mesh = withFields(folder);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(namesIn(*mesh), Names{"cell:p:1"});
  ASSERT_EQ(mesh->otherFields.size(), 1u);
  EXPECT_NE(mesh->otherFields[0].find("by a macro"), std::string::npos);
}

}  // namespace
}  // namespace qtet

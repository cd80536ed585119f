// Names that a log can hold, for fields of whatever names.
#include "simplify/read/options/select_fields.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

std::vector<std::string> namesOf(const std::vector<MeshField>& fields) {
  std::vector<std::string> out;
  for (const MeshField& field : fields) out.push_back(field.name);
  return out;
}

TEST(NameFields, aNameThatIsTakenGetsTheFirstNumberThatIsFree) {
  std::vector<MeshField> fields;
  for (const char* name : {"a", "a-2", "a", "a", "b", "a-3", "a"})
    fields.push_back({name, 1, "float64", {}, "point"});
  fields.push_back({"a", 1, "float64", {}, "cell"});
  std::vector<std::string> notes;
  nameFields(fields, notes);
  EXPECT_EQ(namesOf(fields),
            (std::vector<std::string>{"a", "a-2", "a-3", "a-4", "b", "a-3-2", "a-5", "a"}));
  EXPECT_EQ(notes.size(), 4u);
}

// Each against all before it, for each number that is tried, would take days.
TEST(NameFields, aHundredThousandFieldsOfOneNameAreNamed) {
  std::vector<MeshField> fields(100'000, {"a", 1, "float64", {}, "point"});
  std::vector<std::string> notes;
  nameFields(fields, notes);
  EXPECT_EQ(fields[1].name, "a-2");
  EXPECT_EQ(fields.back().name, "a-100000");
}

/// A mesh of as many points with fields of them.
CellMesh withFields(std::size_t points, std::vector<MeshField> fields) {
  CellMesh mesh;
  mesh.points.resize(points);
  mesh.fields = std::move(fields);
  return mesh;
}

std::vector<double> upTo(std::size_t count, double first = 0) {
  std::vector<double> out(count, first);
  for (std::size_t i = 0; i < count; ++i) out[i] += static_cast<double>(i);
  return out;
}

TEST(LeaveOutNumbers, integersThatAllDifferStayOut) {
  for (const std::size_t count : {kFewestNumbers - 1, kFewestNumbers, kFewestNumbers + 1}) {
    std::vector<double> again = upTo(count);
    again.back() = 0;
    MeshField named{"Part", 1, "int32", upTo(count), "cell"};
    named.labelNames[3] = "steel";
    CellMesh mesh = withFields(count, {{"ElementId", 1, "int64", upTo(count, 7), "cell"},
                                       {"T", 1, "float64", upTo(count), "point"},
                                       {"again", 1, "int32", again, "point"},
                                       {"pairs", 2, "int32", upTo(2 * count), "point"},
                                       named,
                                       {"ids@0.5", 1, "uint32", upTo(count), "point"}});
    std::vector<std::string> notes;
    leaveOutNumbers(std::nullopt, mesh, notes);
    if (count < kFewestNumbers) {
      EXPECT_EQ(mesh.fields.size(), 6u);
      EXPECT_TRUE(notes.empty());
      continue;
    }
    EXPECT_EQ(namesOf(mesh.fields), (std::vector<std::string>{"T", "again", "pairs", "Part"}));
    EXPECT_EQ(mesh.otherFields, (std::vector<std::string>{"ElementId", "ids@0.5"}));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0],
              "fields that only number points or cells are left out: cell:ElementId, "
              "point:ids@0.5; `fields` reads them, too");
  }
}

TEST(LeaveOutNumbers, originalsOfVtkStayOutWhateverTheirValues) {
  const std::vector<MeshField> fields{{"vtkOriginalPointIds", 1, "int64", {1, 1}, "point"},
                                      {"vtkOriginalCellIds@2", 1, "int64", {1, 1}, "cell"}};
  CellMesh mesh = withFields(2, fields);
  std::vector<std::string> notes;
  leaveOutNumbers(FieldNames({"vtkOriginalPointIds"}), mesh, notes);
  EXPECT_EQ(mesh.fields.size(), 2u);
  leaveOutNumbers(std::nullopt, mesh, notes);
  EXPECT_TRUE(mesh.fields.empty());
  EXPECT_EQ(notes.size(), 1u);
}

}  // namespace
}  // namespace qtet

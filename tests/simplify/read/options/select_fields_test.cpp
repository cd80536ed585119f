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

}  // namespace
}  // namespace qtet

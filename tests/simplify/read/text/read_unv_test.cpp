// Groups and results of universal files.
#include <gtest/gtest.h>

#include <cmath>

#include "simplify/read/text/text_readers.h"
#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

/// Two tetrahedra that share a face, numbered 10 and 20, and a triangle 30.
const std::string kTwoCells =
    "    -1\n  2411\n1 1 1 11\n0 0 0\n2 1 1 11\n1.D0 0 0\n3 1 1 11\n0 1 0\n4 1 1 11\n0 0 1\n5 1 1 "
    "11\n1 1 1\n    -1\n    -1\n  2412\n10 111 1 1 7 4\n1 2 3 4\n20 111 1 1 7 4\n2 3 4 5\n30 91 1 "
    "1 "
    "7 3\n1 2 3\n    -1\n";

Result<CellMesh> universal(const std::string& more, ReadReport& report) {
  return readUnv(testing::fileWith("two.unv", kTwoCells + more), report);
}

std::string dataset(const std::string& number, const std::string& text) {
  return "    -1\n  " + number + "\n" + text + "    -1\n";
}

std::string results(const std::string& name, const std::string& values) {
  return dataset("2414", "1\n" + name +
                             "\n1\na\nb\nc\nd\ne\n1 4 1 5 2 1\n0 0 0 0 0 0 0 0\n0 0\n0 0 0 "
                             "0 0 0\n0 0 0 0 0 0\n" +
                             values);
}

TEST(ReadUnv, groupsOfElementsAreALabelWithNames) {
  for (const char* number : {"2435", "2452", "2467", "2477"}) {
    ReadReport report;
    const auto read = universal(dataset(number,
                                        "1 0 0 0 0 0 0 2\nsteel\n8 20 0 0 8 30 0 0\n2 0 0 0 0 0 0 "
                                        "1\nair box\n8 10 0 0\n3 0 0 0 0 0 0 1\nnodes\n7 10 0 0\n"
                                        "4 0 0 0 0 0 0 0\nempty\n"),
                                report);
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->fields.size(), 1u);
    EXPECT_EQ(read->fields[0].name, "Group");
    EXPECT_EQ(read->fields[0].values, (std::vector<double>{2, 1}));
    EXPECT_EQ(read->fields[0].labelNames, (LabelNames{{1, "steel"}, {2, "air box"}}));
  }
  ReadReport report;
  const auto old = universal(dataset("752", "1 0 0 0 0 2\nsteel\n8 20 8 30\n"), report);
  ASSERT_TRUE(old) << old.error().text();
  EXPECT_EQ(old->fields[0].values, (std::vector<double>{0, 1}));
}

TEST(ReadUnv, aGroupCannotHaveMoreEntitiesThanBytesFollow) {
  ReadReport report;
  const auto read =
      universal(dataset("2467", "1 0 0 0 0 0 0 4000000000\nsteel\n8 20 0 0\n"), report);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kTruncated) << read.error().text();
}

TEST(ReadUnv, aNoteIsMadeOnce) {
  ReadReport report;
  const std::string old = dataset("55", "1\n"), other = dataset("57", "1\n"),
                    values = results("T", "1\n0\n");
  ASSERT_TRUE(universal(old + old + other + old + values + values + values, report));
  EXPECT_EQ(report.notes.size(), 3u);
}

TEST(ReadUnv, resultsAtNodesArePointFields) {
  ReadReport report;
  const auto read = universal(results("Old", "1\n0\n") + results("Temperature", "1\n0\n") +
                                  results("Temperature", "5\n2.5D0\n2\n1\n"),
                              report);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->fields.size(), 2u);
  const MeshField& field = read->fields[1];
  EXPECT_EQ(field.name, "Temperature");
  EXPECT_EQ(field.type, "float32");
  EXPECT_EQ(field.values[4], 2.5);
  EXPECT_EQ(field.values[1], 1);
  EXPECT_TRUE(std::isnan(field.values[0]));
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("last one"), std::string::npos) << report.notes[0];
}

}  // namespace
}  // namespace qtet

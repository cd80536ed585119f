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

/// Dataset 55 with the numbers of its sixth line and two lines of each kind of further numbers.
std::string results55(const std::string& kinds, const std::string& values,
                      const std::string& more = "2 7 1 4\n0. 0. 0. 0. 0. 0.\n0.\n") {
  return dataset("55", "the part\nNONE\nNONE\nNONE\nNONE\n" + kinds + "\n" + more + values);
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
  const std::string old = dataset("56", "1\n"), other = dataset("57", "1\n"),
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

TEST(ReadUnv, resultsOfDataset55AreNamedByTheirType) {
  ReadReport report;
  const auto read = universal(
      results55("1 1 2 8 2 3", "2\n-1.0E+00 2.D0 3\n5\n4 5 6\n", "6 1 1 2 3 4 5 6\n0.\n") +
          results55("2 4 1 5 2 1", "1\n7.5\n", "2 1 1 9\n0.5\n") +
          results55("1 4 1 0 2 1", "1\n8.5\n", "2 1 1 9\n0.5\n"),
      report);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->fields.size(), 3u);
  const MeshField& moved = read->fields[0];
  EXPECT_EQ(moved.name, "Displacement");
  EXPECT_EQ(moved.type, "float32");
  EXPECT_EQ(moved.components, 3u);
  EXPECT_TRUE(std::isnan(moved.values[0]));
  EXPECT_EQ(std::vector(moved.values.begin() + 3, moved.values.begin() + 6),
            (std::vector<double>{-1, 2, 3}));
  EXPECT_EQ(moved.values[14], 6);
  EXPECT_EQ(read->fields[1].name, "Temperature");
  EXPECT_EQ(read->fields[1].values[0], 7.5);
  EXPECT_EQ(read->fields[2].name, "the part") << "its type is unknown";
  EXPECT_EQ(report.notes, std::vector<std::string>());
}

TEST(ReadUnv, tensorsHaveTheOrderOfVtk) {
  ReadReport report;
  const auto read = universal(results55("1 1 4 2 2 6", "1\n11 12 22 13 23 33\n", "1 1 1\n0.\n") +
                                  results55("1 1 5 3 2 9", "1\n11 21 31 12 22 32\n13 23 33\n") +
                                  results55("1 1 3 9 2 6", "1\n1 2 3 4 5 6\n"),
                              report);
  ASSERT_TRUE(read) << read.error().text();
  ASSERT_EQ(read->fields.size(), 3u);
  const auto tuple = [&](std::size_t field, std::ptrdiff_t size) {
    const auto begin = read->fields[field].values.begin();
    return std::vector<double>(begin, begin + size);
  };
  EXPECT_EQ(read->fields[0].name, "Reaction force");
  EXPECT_EQ(tuple(0, 6), (std::vector<double>{1, 2, 3, 4, 5, 6})) << "it is no tensor";
  EXPECT_EQ(tuple(1, 9), (std::vector<double>{11, 12, 13, 21, 22, 23, 31, 32, 33}));
  EXPECT_EQ(tuple(2, 6), (std::vector<double>{11, 22, 33, 12, 23, 13}));
}

TEST(ReadUnv, resultsThatAreNotUnderstoodAreNamed) {
  const auto noteOf = [](const std::string& text) {
    ReadReport report;
    const auto read = universal(text, report);
    EXPECT_TRUE(read) << read.error().text();
    EXPECT_TRUE(read && read->fields.empty());
    EXPECT_EQ(report.notes.size(), 1u);
    return report.notes.empty() ? std::string() : report.notes[0];
  };
  EXPECT_EQ(noteOf(results55("1 2 2 8 5 3", "1\n0 0 0 0 0 0\n")),
            "the results Displacement are not read: they are no real numbers");
  EXPECT_EQ(noteOf(results55("1 1 0 11 2 17", "1\n0\n")),
            "the results Velocity are not read: they have too many numbers at a node, or none");
  std::string cells = results("Damage", "10\n1\n");
  cells.replace(cells.find("Damage\n1"), 8, "Damage\n2");
  EXPECT_EQ(noteOf(cells), "the results Damage are not read: they are not at nodes");
}

TEST(ReadUnv, theLinesBeforeValuesAreBounded) {
  for (const std::string& counts : {"10 12", "11 12", "10 13", "-1 1", "1000000000 1"}) {
    ReadReport report;
    const auto read = universal(
        results55("1 1 1 5 2 1", "1\n7\n", counts + " 0 0 0 0 0 0\n0 0 0 0\n0 0 0 0 0 0\n0\n"),
        report);
    ASSERT_EQ(read.has_value(), counts == "10 12") << counts;
    if (read)
      EXPECT_EQ(read->fields.at(0).values[0], 7);
    else
      EXPECT_NE(read.error().message.find("before its values"), std::string::npos)
          << read.error().text();
  }
}

TEST(ReadUnv, everyTruncationOfAResultIsAnErrorOrAMesh) {
  const std::string whole = kTwoCells + results55("1 1 2 8 2 3", "2\n1 2 3\n5\n4 5 6\n");
  for (std::size_t length = kTwoCells.size(); length < whole.size(); ++length) {
    ReadReport report;
    const auto read = readUnv(testing::fileWith("cut.unv", whole.substr(0, length)), report);
    EXPECT_TRUE(read || !read.error().message.empty()) << length;
    for (const MeshField& field : read ? read->fields : std::vector<MeshField>())
      EXPECT_EQ(field.values.size(), 15u);
  }
}

}  // namespace
}  // namespace qtet

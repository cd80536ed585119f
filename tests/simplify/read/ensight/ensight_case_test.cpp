#include "simplify/read/ensight/ensight_case.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

constexpr const char* kFront = "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: m.geo\n";

Result<EnSightCase> caseOf(const std::string& text) {
  return readEnSightCase(testing::fileWith("a.case", text));
}

std::string fileOf(const Result<EnSightCase>& from, const EnSightItem& item, std::uint64_t step) {
  const Result<EnSightPlace> place = from->placeOf(item, step);
  return place ? place->file.filename().string() + " " + std::to_string(place->step)
               : place.error().message;
}

TEST(EnSightCase, linesNameSetsVariablesAndFiles) {
  const Result<EnSightCase> read = caseOf(
      "# a comment\r\nFORMAT\r\ntype:  ensight gold\r\n\r\nGEOMETRY\r\nmodel: 1 m.***.geo "
      "change_coords_only 2\r\nVARIABLE\r\nscalar per node: 1 Temperature \"T of it.***\"\n"
      "vector per element: two words v.bin\ntensor symm per node: 7 s.bin\n"
      "tensor asym per element: 2 3 a a.**\nconstant per case: 1 rho 5\n"
      "complex scalar per node: 1 Z re im 5\n"
      "TIME\ntime set: 1 a name\nnumber of steps: 3\nfilename start number: 8\n"
      "filename increment: 4\ntime values: 0.5\n # between\n 1.5D0 +2\n"
      "time set: 2\nnumber of steps: 2\nfilename numbers: 5\n17\ntime values: 0 2 9\n"
      "FILE\nfile set: 3\nfilename index: 4\nnumber of steps: 2\nfilename index: 12\n"
      "number of steps: 1\n");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(read->isGold);
  EXPECT_TRUE(read->changesCoordinatesOnly);
  EXPECT_EQ(read->cellStep, 2u);
  EXPECT_EQ(read->times(), (std::vector<double>{0, 0.5, 1.5, 2}));
  ASSERT_EQ(read->variables.size(), 4u);
  EXPECT_EQ(fileOf(read, read->model, 1), "m.012.geo 0");
  EXPECT_EQ(fileOf(read, read->variables[0].item, 2), "T of it.016 0");
  EXPECT_EQ(read->variables[1].name, "two words");
  EXPECT_TRUE(read->variables[1].isOfElements);
  EXPECT_EQ(read->variables[2].name, "7");
  EXPECT_EQ(read->variables[2].components, 6u);
  const EnSightItem& inSets = read->variables[3].item;
  EXPECT_EQ(fileOf(read, inSets, 0), "a.04 0");
  EXPECT_EQ(fileOf(read, inSets, 1), "a.04 1");
  EXPECT_EQ(fileOf(read, inSets, 2), "a.12 0");
  EXPECT_NE(fileOf(read, inSets, 3).find("its file set ends before"), std::string::npos);
  ASSERT_EQ(read->notes.size(), 1u);
  EXPECT_NE(read->notes[0].find("complex scalar per node"), std::string::npos);
  EXPECT_EQ(read->timeSets.at(2).numbers, (std::vector<std::int64_t>{5, 17}));
  // the last step that is not later; the first where all are
  EXPECT_EQ(read->stepAt(read->model, 0), 0u);
  EXPECT_EQ(read->stepAt(read->model, 1.75), 1u);
  EXPECT_EQ(read->stepAt(inSets, 1.75), 0u);
  EXPECT_EQ(read->stepAt(inSets, 2), 1u);
}

TEST(EnSightCase, timesAndNumbersMayStandInFilesOfTheirOwn) {
  const std::filesystem::path path = testing::fileWith(
      "lists.case", std::string(kFront) +
                        "TIME\ntime set: 1\nnumber of steps: 2\ntime values file: times\n"
                        "filename numbers file: numbers\n");
  EXPECT_EQ(readEnSightCase(path).error().code, ErrorCode::kNotFound);
  std::ofstream(path.parent_path() / "times") << "0.25\n 4\n";
  std::ofstream(path.parent_path() / "numbers") << "3 1\n";
  const Result<EnSightCase> read = readEnSightCase(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->times(), (std::vector<double>{0.25, 4}));
  EXPECT_EQ(read->timeSets.at(1).numbers, (std::vector<std::int64_t>{3, 1}));
}

TEST(EnSightCase, casesThatSayTooLittleAreRefused) {
  const std::string set = std::string(kFront) + "TIME\ntime set: 1\n";
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"GEOMETRY\nmodel: m.geo\n", "type: ensight gold"},
           {"FORMAT\ntype: ensight silver\n", "its type is \"ensight silver\""},
           {"FORMAT\ntype: ensight\n", "no file of a model"},
           {"FORMAT\ntype: ensight\nGEOMETRY\nmodel:\n", "its model has no file"},
           {kFront + std::string("VARIABLE\nscalar per node: T\n"), "has no name and file"},
           {kFront + std::string("TIME\nnumber of steps: 1\n"), "begin with a time set"},
           {set, "has no number of steps"},
           {set + "number of steps: 0\ntime values: 1\n", "has no number of steps"},
           // one more than there are
           {set + "number of steps: 3\ntime values: 1 2\n", "3 steps, but 2 time values"},
           {set + "number of steps: 99999999999\ntime values: 0\n", "99999999999 steps, but 1"},
           {set + "number of steps: 1\ntime values: nan\n", "the time \"nan\""},
           {set + "number of steps: 2\nfilename numbers: 1\ntime values: 1 2\n",
            "2 steps, but 1 filename numbers"},
           {set + "number of steps: 1\nfilename start number: 2147483648\ntime values: 1\n",
            "none of 0 to 2147483647"},
           {set + "number of steps: 2\nfilename start number: 0\nfilename increment: -1\n"
                  "time values: 1 2\n",
            "none of 0 to 2147483647"},
           {kFront + std::string("FILE\nnumber of steps: 1\n"), "begin with a file set"},
           {kFront + std::string("FILE\nfile set: -1\n"), "is no number"},
       }) {
    const Result<EnSightCase> read = caseOf(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
  }
  EXPECT_TRUE(caseOf(set + "number of steps: 1\nfilename start number: 2147483647\n"
                           "time values: 1\n"));
}

TEST(EnSightCase, aWildcardThatNoSetFillsIsRefused) {
  const Result<EnSightCase> read = caseOf(
      "FORMAT\ntype: ensight\nGEOMETRY\nmodel: 1 m.**\nVARIABLE\nscalar per node: 1 5 T T\n");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_NE(fileOf(read, read->model, 0).find("no time set has its filename number"),
            std::string::npos);
  EXPECT_NE(fileOf(read, read->variables[0].item, 0).find("it has no file set 5"),
            std::string::npos);
}

}  // namespace
}  // namespace qtet

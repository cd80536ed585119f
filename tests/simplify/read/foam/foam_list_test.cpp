// Lists of one value for all, whose length no bytes of their file bound, and the time to read.
#include "simplify/read/foam/foam_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/simplify/read/foam/foam_files.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::seconds kNoTimeLeft{-100};
const std::string kHeader = "FoamFile\n{\n version 2.0;\n format ascii;\n class list;\n}\n";

FoamList listOf(const std::string& body) {
  return FoamList::open(testing::fileWith("list", kHeader + body)).value();
}

Status allFaces(FoamList list) {
  return list.faces([](std::span<const FoamList::Label>) { return Status{}; });
}

TEST(FoamList, oneValueForAllIsReadUpToWhatTheCallerAllows) {
  for (const std::uint64_t most : {11, 12, 13}) {
    const auto labels = listOf("12{7}\n").labels(most);
    ASSERT_EQ(labels.has_value(), most >= 12) << most;
    if (labels) {
      EXPECT_EQ(*labels, std::vector<FoamList::Label>(12, 7));
      continue;
    }
    EXPECT_EQ(labels.error().code, ErrorCode::kBadInput);
    EXPECT_NE(labels.error().message.find("line 7: a list N{VALUE} says that it has 12 labels, "
                                          "but at most 11 are possible"),
              std::string::npos)
        << labels.error().message;
  }
  EXPECT_FALSE(listOf("-1{7}\n").labels(12));
}

TEST(FoamList, facesOfOneValueHaveTogetherAtMostAsManyCornersAsTheFileHasBytes) {
  const std::size_t size = (kHeader + "2\n(\n10{1}\n3{1}\n)\n").size();
  const auto faces = [](std::size_t first, std::size_t second) {
    return allFaces(
        listOf("2\n(\n" + std::to_string(first) + "{1}\n" + std::to_string(second) + "{1}\n)\n"));
  };
  ASSERT_LT(size, 100u) << "so that it has as many digits";
  EXPECT_TRUE(faces(10, 3));
  EXPECT_TRUE(faces(size - 3, 3));
  EXPECT_FALSE(faces(size - 2, 3));
  EXPECT_FALSE(faces(16'777'216, 3));
}

TEST(FoamList, facesAfterSpentOnesMayStillNameTheirCorners) {
  const std::string body = "2\n(\n10{1}\n4(0 1 2 3)\n)\n";
  const std::size_t size = (kHeader + body).size();
  ASSERT_LT(size, 100u) << "so that it has as many digits";
  EXPECT_TRUE(allFaces(listOf("2\n(\n" + std::to_string(size) + "{1}\n4(0 1 2 3)\n)\n")));
}

TEST(FoamList, everyLabelIsReadInTime) {
  const fs::path path = testing::fileWith("list", kHeader + "2\n(\n0\n1\n)\n");
  EXPECT_TRUE(FoamList::open(path).value().labels(2));
  const auto late = FoamList::open(path, kNoTimeLeft).value().labels(2);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kBadInput);
  EXPECT_NE(late.error().message.find("`readSeconds`"), std::string::npos) << late.error().message;
}

using Values = std::vector<double>;
using testing::bytesOf;

FoamList foamFile(const std::string& header, const std::string& body) {
  return FoamList::open(testing::fileWith("values", header + body)).value();
}

struct ReadField {
  Values values;
  std::string refusal;  ///< also "a macro"
};

ReadField fieldIn(FoamList file, std::uint32_t components, std::uint64_t count) {
  const auto values = file.field("internalField", components, count);
  if (!values) {
    EXPECT_EQ(values.error().code, ErrorCode::kBadInput);
    return {{}, values.error().message};
  }
  if (!*values) return {{}, "a macro"};
  return {**values, ""};
}

ReadField textField(const std::string& value, std::uint32_t components = 1,
                    std::uint64_t count = 2) {
  return fieldIn(foamFile(kHeader, "dimensions [0 1 0 0 0 0 0];\ninternalField " + value),
                 components, count);
}

Values valuesOf(const std::string& value, std::uint32_t components = 1, std::uint64_t count = 2) {
  const ReadField read = textField(value, components, count);
  EXPECT_EQ(read.refusal, "") << value;
  return read.values;
}

TEST(FoamList, valuesAsTextAreRead) {
  EXPECT_EQ(valuesOf("uniform 1.5;"), (Values{1.5, 1.5}));
  EXPECT_EQ(valuesOf("uniform (1.5);"), (Values{1.5, 1.5}));
  EXPECT_EQ(valuesOf("uniform (1 2 -3e2);", 3), (Values{1, 2, -300, 1, 2, -300}));
  EXPECT_EQ(valuesOf("nonuniform List<scalar> 2(5 7);"), (Values{5, 7}));
  EXPECT_EQ(valuesOf("nonuniform List<scalar>\n2\n(\n5 // five\n7\n)\n;"), (Values{5, 7}));
  EXPECT_EQ(valuesOf("nonuniform 2(5 7);"), (Values{5, 7}));
  EXPECT_EQ(valuesOf("nonuniform List<vector> 2((1 2 3) (4 5 6));", 3), (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(valuesOf("nonuniform List<sphericalTensor> 2((5) (7));"), (Values{5, 7}));
  EXPECT_EQ(valuesOf("nonuniform List<scalar> 2{5};"), (Values{5, 5}));
  EXPECT_EQ(valuesOf("nonuniform List<vector> 2{(1 2 3)};", 3), (Values{1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(valuesOf("nonuniform List<scalar> 0();", 1, 0), Values{});
  EXPECT_EQ(valuesOf("nonuniform List<scalar> 2(1e-400 1e400);"),
            (Values{0, std::numeric_limits<double>::infinity()}));
  EXPECT_TRUE(std::isnan(valuesOf("uniform nan;")[0]));
}

TEST(FoamList, damagedValuesAreRefusedWithTheirLine) {
  for (const auto& [value, said] : std::initializer_list<std::pair<const char*, const char*>>{
           {"nonuniform List<scalar> 1(5);", "line 8: it has 1 values, but the mesh needs 2"},
           {"nonuniform List<scalar> 3(5 7 9);", "it has 3 values, but the mesh needs 2"},
           {"nonuniform List<scalar> 3{5};", "it has 3 values, but the mesh needs 2"},
           {"nonuniform List<scalar> -1(5);", "it has -1 values"},
           {"nonuniform List<scalar> 2(5);", "')' is not a number"},
           {"nonuniform List<scalar> 2(5 7 9);", "a list of 2 does not end there"},
           {"nonuniform List<scalar> 2{5 7};", "a list N{VALUE} does not end"},
           {"nonuniform List<scalar> 2(5 7x);", "'7x' is not a number"},
           {"nonuniform List<scalar> 2", "does not fit into the rest of the file"},
           {"nonuniform List<scalar> 2(5 7) 9;", "the entry internalField does not end there"},
           {"nonuniform List<vector> 2((1 2) (4 5));", "a tuple of 1 numbers does not end there"},
           {"uniform (1 2);", "a tuple of 1 numbers does not end there"},
           {"uniform;", "';' is not a number"},
           {"5;", "'5' is neither uniform nor nonuniform"}}) {
    const std::string refusal = textField(value).refusal;
    EXPECT_NE(refusal.find(said), std::string::npos) << value << "\n" << refusal;
  }
  EXPECT_NE(fieldIn(foamFile(kHeader, "other uniform 1;"), 1, 1)
                .refusal.find("it has no entry internalField"),
            std::string::npos);
}

TEST(FoamList, entriesBeforeTheValuesArePassed) {
  const std::string before =
      "#include \"other (\"\na { internalField uniform 7; b { c 1; } }\nd (internalField uniform "
      "8);\ne internalField;\n";
  EXPECT_EQ(fieldIn(foamFile(kHeader, before + "internalField uniform 2;"), 1, 1).values,
            Values{2});
}

TEST(FoamList, aMacroIsNoValue) {
  for (const char* value :
       {"uniform $speed;", "$internal;", "uniform ($u 0 0);", "uniform #calc \"1 + 2\";",
        "nonuniform #codeStream { code #{ #}; };", "nonuniform $other;"})
    EXPECT_EQ(textField(value, 3).refusal, "a macro") << value;
}

TEST(FoamList, binaryValuesAreReadInTheWidthOfTheHeader) {
  const auto field = [](const std::string& arch, const std::string& list) {
    FoamList file = foamFile(testing::foamHeader("volScalarField", "binary", arch),
                             "internalField nonuniform List<scalar> " + list + ";");
    EXPECT_EQ(file.realType(), arch.contains("scalar=32") ? std::string("float32") : "float64");
    return fieldIn(std::move(file), 1, 2).values;
  };
  EXPECT_EQ(field("", "\n2\n(" + bytesOf({5.5, 7.25}) + ")"), (Values{5.5, 7.25}));
  EXPECT_EQ(field("LSB;label=32;scalar=64", "2(" + bytesOf({5.5, 7.25}) + ")"),
            (Values{5.5, 7.25}));
  EXPECT_EQ(field("LSB;label=64;scalar=32", "2(" + bytesOf({5.5F, 7.25F}) + ")"),
            (Values{5.5, 7.25}));
  // every truncation is refused
  const std::string whole = "2(" + bytesOf({5.5, 7.25}) + ");";
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(fieldIn(foamFile(testing::foamHeader("volScalarField", "binary"),
                               "internalField nonuniform List<scalar> " + whole.substr(0, length)),
                      1, 2)
                  .refusal,
              "")
        << length;
}

TEST(FoamList, numbersOfOtherMachinesAreRefused) {
  const auto open = [](const std::string& format) {
    return FoamList::open(testing::fileWith(
        "foreign", testing::foamHeader("volScalarField", format, "MSB;label=32;scalar=64")));
  };
  EXPECT_TRUE(open("ascii"));
  const auto binary = open("binary");
  ASSERT_FALSE(binary);
  EXPECT_NE(binary.error().message.find("highest byte first"), std::string::npos);
}

TEST(FoamList, labelsOf64BitsAreRead) {
  const std::string header = testing::foamHeader("labelList", "binary", "LSB;label=64;scalar=64");
  EXPECT_EQ(foamFile(header, "2(" + bytesOf<std::int64_t>({7, -1}) + ")").labels(2),
            (std::vector<FoamList::Label>{7, -1}));
  EXPECT_FALSE(
      foamFile(header, "1(" + bytesOf<std::int64_t>({std::int64_t{1} << 32}) + ")").labels(2));
  EXPECT_TRUE(foamFile(header, "1(" + bytesOf<std::int64_t>({(std::int64_t{1} << 32) - 1}) + ")")
                  .labels(2));
}

TEST(FoamList, theClassOfAFileIsInItsHeader) {
  const auto classOf = [](const std::string& text) {
    return FoamList::classOf(testing::fileWith("any", text));
  };
  EXPECT_EQ(classOf("/* banner */\n" + testing::foamHeader("volScalarField") + "rest"),
            "volScalarField");
  for (const char* other : {"", "x", "/*", "#!/bin/sh\n"}) EXPECT_EQ(classOf(other), "");
  for (const char* damaged : {"FoamFile", "FoamFile { class", "FoamFile { class volScalarField;"})
    EXPECT_FALSE(classOf(damaged)) << damaged;
  // a banner of as many bytes as are read, and one byte less
  const std::string header = testing::foamHeader("volScalarField");
  for (const std::size_t more : {0, 1})
    EXPECT_EQ(
        classOf(std::string(FoamList::kMostHeaderBytes - header.size() + 1 + more, ' ') + header)
            .has_value(),
        more == 0);
}

}  // namespace
}  // namespace qtet

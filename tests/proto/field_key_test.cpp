#include "proto/field_key.h"

#include <gtest/gtest.h>

#include <string>

namespace qtet {
namespace {

struct Named {
  std::string association;
  FieldName name;
};

using Places = std::vector<std::uint32_t>;

const std::vector<Named> kFields{{"cell", "T"},       {"point", "U"},          {"point", "T"},
                                 {"point", "P@0"},    {"point", "P@0.5"},      {"cell", "P@0.5"},
                                 {"point", "cell:T"}, {"point", "inlet@left"}, {"point", "@1"}};

TEST(FieldKey, aNameMeansEveryFieldThatHasIt) {
  EXPECT_EQ(fieldsOfKey(kFields, "T"), (Places{0, 2}));
  EXPECT_EQ(fieldsOfKey(kFields, "U"), (Places{1}));
  EXPECT_EQ(fieldsOfKey(kFields, "none"), Places{});
  EXPECT_EQ(fieldsOfKey(kFields, ""), Places{});
}

TEST(FieldKey, aKindBeforeItMeansOneUnlessAFieldIsCalledSo) {
  EXPECT_EQ(fieldsOfKey(kFields, "point:T"), (Places{2}));
  EXPECT_EQ(fieldsOfKey(kFields, "cell:T"), (Places{6}));
  EXPECT_EQ(fieldsOfKey(kFields, "cell:U"), Places{});
  EXPECT_EQ(fieldsOfKey(kFields, "point:cell:T"), (Places{6}));
  EXPECT_EQ(fieldsOfKey(kFields, "point"), Places{});
  EXPECT_EQ(fieldsOfKey(kFields, "point:"), Places{});
}

TEST(FieldKey, ofASeriesANameMeansEveryStep) {
  EXPECT_EQ(fieldsOfKey(kFields, "P"), (Places{3, 4, 5}));
  EXPECT_EQ(fieldsOfKey(kFields, "point:P"), (Places{3, 4}));
  EXPECT_EQ(fieldsOfKey(kFields, "P@0.5"), (Places{4, 5}));
  EXPECT_EQ(fieldsOfKey(kFields, "cell:P@0.5"), (Places{5}));
  EXPECT_EQ(fieldsOfKey(kFields, "inlet"), Places{});
  std::vector<Named> withPlain = kFields;
  withPlain.push_back({"cell", "P"});
  EXPECT_EQ(fieldsOfKey(withPlain, "P"), (Places{9}));
}

TEST(FieldKey, whereOneIsMeantPointsComeFirstAndNoStepIsGuessed) {
  EXPECT_EQ(fieldOfKey(kFields, "T"), 2u);
  EXPECT_EQ(fieldOfKey(kFields, "U"), 1u);
  EXPECT_EQ(fieldOfKey(kFields, "P"), std::nullopt);
  EXPECT_EQ(fieldOfKey(kFields, "P@0.5"), 4u);
  EXPECT_EQ(fieldOfKey(kFields, "cell:P@0.5"), 5u);
  EXPECT_EQ(fieldOfKey(kFields, "none"), std::nullopt);
}

}  // namespace
}  // namespace qtet

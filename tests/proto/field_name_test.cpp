#include "proto/field_name.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>

namespace qtet {
namespace {

TEST(FieldName, anInstantEndsInANumber) {
  for (const auto& [text, series, time] :
       {std::tuple("T@0.5", "T", 0.5), {"T@-1e-07", "T", -1e-7}, {"a@b@3", "a@b", 3.0}}) {
    const FieldName name(text);
    ASSERT_TRUE(name.isInstant()) << text;
    EXPECT_EQ(name.instant()->series, series);
    EXPECT_EQ(name.instant()->time, time);
    EXPECT_EQ(name.withoutTime(), series);
  }
}

TEST(FieldName, anyOtherNameIsWhole) {
  for (const char* const text : {"T", "T@", "T@x", "T@1x", "@1", "", "T@nan", "T@inf", "T@1e999"}) {
    const FieldName name(text);
    EXPECT_FALSE(name.isInstant()) << text;
    EXPECT_FALSE(name.instant()) << text;
    EXPECT_EQ(name.withoutTime(), text);
  }
}

TEST(FieldName, aCopyHasPartsOfItsOwn) {
  FieldName name("T@1");
  const FieldName copy = name;
  name = "pressure";
  EXPECT_EQ(copy.withoutTime(), "T");
  EXPECT_EQ(name.withoutTime(), "pressure");
  EXPECT_FALSE(name.isInstant());
}

TEST(FieldName, namesCompareAsTheirTextsDo) {
  const std::string text = "T@1";
  EXPECT_EQ(FieldName(text), text);
  EXPECT_EQ(text, FieldName(text));
  EXPECT_NE(FieldName("T@1"), FieldName("T@1.0"));
  EXPECT_LT(FieldName("T@1"), "U");
  EXPECT_EQ((std::set<std::string, std::less<>>{"a", "T@1"}.count(FieldName("T@1"))), 1u);
  EXPECT_EQ("field " + FieldName("T@1") + ": ", "field T@1: ");
}

}  // namespace
}  // namespace qtet

#include "proto/field_list.h"

#include <gtest/gtest.h>

#include <vector>

namespace qtet {
namespace {

using Names = std::vector<std::string>;

TEST(FieldList, namesEachFieldAndEachSeriesOnce) {
  EXPECT_EQ(fieldList(Names{}), "none");
  EXPECT_EQ(fieldList(Names{"p", "T@0"}), "p, T@0");
  EXPECT_EQ(fieldList(Names{"T", "T@0", "T@4", "T@-2", "T@1", "T@3"}),
            "T, T@-2 to T@4 (5 instants)")
      << "instants lie in the order of decoding";
  EXPECT_EQ(fieldList(Names{"T@0", "U@0", "T@1", "U@1", "T@2", "cell:p"}),
            "T@0 to T@2 (3 instants), U@0 to U@1 (2 instants), cell:p");
}

TEST(FieldList, saysHowManyMoreThereAreThanItNames) {
  Names names;
  for (std::size_t i = 0; i < kMaxListedFields; ++i) names.push_back("f" + std::to_string(i));
  EXPECT_TRUE(fieldList(names).ends_with(", f29"));
  names.insert(names.end(), {"g", "h"});
  EXPECT_TRUE(fieldList(names).ends_with(", f29 and 2 more"));
}

}  // namespace
}  // namespace qtet

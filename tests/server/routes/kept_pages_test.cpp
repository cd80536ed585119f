#include "server/routes/kept_pages.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

KeptPagePointer pageOf(std::size_t bytes) {
  return std::make_shared<const KeptPage>(KeptPage{{Bytes(bytes)}});
}

const std::size_t kCost = pageOf(100)->cost();

TEST(KeptPages, aKeptPageIsFoundAsItWasKept) {
  KeptPages pages;
  const KeptPagePointer page = pageOf(100);
  EXPECT_EQ(pages.find("a"), nullptr);
  pages.keep("a", page);
  EXPECT_EQ(pages.find("a"), page);
  EXPECT_EQ(pages.find("b"), nullptr);
  EXPECT_EQ(pages.bytes(), kCost);
}

TEST(KeptPages, thePageThatWasNotUsedForLongestMakesRoom) {
  KeptPages pages(2 * kCost);
  pages.keep("a", pageOf(100));
  pages.keep("b", pageOf(100));
  EXPECT_TRUE(pages.find("a"));
  pages.keep("c", pageOf(100));
  EXPECT_TRUE(pages.find("a"));
  EXPECT_FALSE(pages.find("b"));
  EXPECT_TRUE(pages.find("c"));
  EXPECT_EQ(pages.bytes(), 2 * kCost);
}

TEST(KeptPages, theBoundIsExact) {
  for (const auto& [bound, kept] : {std::pair(kCost - 1, 0u), {kCost, 1u}, {kCost + 1, 1u}}) {
    KeptPages pages(bound);
    pages.keep("a", pageOf(100));
    EXPECT_EQ(pages.find("a") != nullptr, kept == 1) << bound;
    EXPECT_EQ(pages.bytes(), kept * kCost);
  }
}

TEST(KeptPages, aSecondPageOfAKeyIsNotKept) {
  KeptPages pages;
  const KeptPagePointer first = pageOf(100);
  pages.keep("a", first);
  pages.keep("a", pageOf(200));
  EXPECT_EQ(pages.find("a"), first);
  EXPECT_EQ(pages.bytes(), kCost);
}

}  // namespace
}  // namespace qtet

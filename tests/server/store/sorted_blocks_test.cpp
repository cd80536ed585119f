#include "server/store/sorted_blocks.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace qtet {
namespace {

struct Itself {
  std::string_view operator()(const std::string& text) const { return text; }
};
using Texts = SortedBlocks<std::string, Itself>;

std::vector<std::string> all(const Texts& texts) { return {texts.begin(), texts.end()}; }

std::string key(unsigned number) { return std::to_string(100'000 + number); }

void expectSame(const Texts& texts, const std::set<std::string>& model) {
  ASSERT_EQ(all(texts), std::vector<std::string>(model.begin(), model.end()));
  EXPECT_EQ(texts.size(), model.size());
  EXPECT_EQ(texts.empty(), model.empty());
}

TEST(SortedBlocks, behavesLikeASetWhateverIsDoneToIt) {
  std::mt19937 random(7);
  const auto below = [&](unsigned bound) { return static_cast<unsigned>(random() % bound); };
  Texts texts;
  std::set<std::string> model;
  for (int step = 0; step < 20'000; ++step) {
    const std::string text = key(below(2000));
    if (below(3) > 0) {
      texts.put(text);
      model.insert(text);
    } else {
      EXPECT_EQ(texts.remove(text), model.erase(text) == 1);
    }
    if (step % 1000 == 0) expectSame(texts, model);
  }
  expectSame(texts, model);
  for (unsigned i = 0; i < 2001; ++i) {
    const std::string text = key(i);
    EXPECT_EQ(texts.contains(text), model.contains(text)) << text;
    EXPECT_EQ(std::distance(texts.begin(), texts.lowerBound(text)),
              std::distance(model.begin(), model.lower_bound(text)));
    EXPECT_EQ(std::distance(texts.begin(), texts.upperBound(text)),
              std::distance(model.begin(), model.upper_bound(text)));
  }
  for (const std::string& text : std::set(model)) EXPECT_TRUE(texts.remove(text));
  expectSame(texts, {});
}

TEST(SortedBlocks, aCopyKeepsWhatItHad) {
  std::vector<std::string> sorted;
  for (unsigned i = 0; i < 3 * Texts::kMaxBlock + 1; ++i) sorted.push_back(key(2 * i));
  Texts texts = Texts::ofSorted(sorted);
  EXPECT_EQ(all(texts), sorted);
  const Texts before = texts;
  texts.put(key(1));
  texts.put(key(99'999));
  EXPECT_TRUE(texts.remove(key(0)));
  EXPECT_FALSE(texts.remove(key(0)));
  EXPECT_EQ(all(before), sorted);
  EXPECT_EQ(texts.size(), sorted.size() + 1);
}

struct First {
  int operator()(const std::pair<int, int>& value) const { return value.first; }
};

TEST(SortedBlocks, aValueTakesThePlaceOfTheOneWithItsKey) {
  SortedBlocks<std::pair<int, int>, First> values;
  for (const int second : {1, 2}) values.put({5, second});
  EXPECT_EQ(values.size(), 1u);
  EXPECT_EQ(values.find(5)->second, 2);
  EXPECT_EQ(values.find(4), nullptr);
}

}  // namespace
}  // namespace qtet

// Weights of instants in a prediction: the polynomial's, fitted ones, and their integers.
#include "simplify/series/time_weights.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace qtet {
namespace {

TEST(TimeWeights, thePolynomialsAreThoseOfLagrange) {
  const std::vector<double> times{0, 2, 4, 6};
  const std::vector<double> middle = polynomialWeights(times, 3);
  const std::array<double, 4> cubic{-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
  for (std::size_t i = 0; i < cubic.size(); ++i) EXPECT_NEAR(middle[i], cubic[i], 1e-12) << i;
  EXPECT_EQ(polynomialWeights(std::array{5.0}, 9), std::vector<double>{1});
}

TEST(TimeWeights, aFitFindsTheWeightsThatRowsWereMadeWith) {
  WeightFit fit(2);
  for (int i = -20; i < 20; ++i) {
    const std::array<double, 2> row{10.0 * i, static_cast<double>(i * i % 17) * 20};
    fit.add(row, 0.75 * row[0] - 0.5 * row[1]);
  }
  const std::vector<double> weights = fit.solve();
  EXPECT_NEAR(weights[0], 0.75, 1e-5);
  EXPECT_NEAR(weights[1], -0.5, 1e-5);
}

TEST(TimeWeights, aSecondFitHeedsFewLargeMissesLess) {
  const auto add = [](WeightFit& fit) {
    for (int i = 1; i <= 30; ++i)
      fit.add(std::array{20.0 * i}, i % 10 == 0 ? -300.0 * i : 10.0 * i);
    return fit.solve();
  };
  WeightFit even(1);
  const std::vector<double> first = add(even);
  EXPECT_LT(first[0], 0);
  WeightFit second(std::vector{0.4});
  EXPECT_NEAR(add(second)[0], 0.5, 0.1);
}

TEST(TimeWeights, nothingDecidesEqualInstants) {
  WeightFit fit(3);
  for (int i = 0; i < 9; ++i) fit.add(std::array{0.0, 0.0, 0.0}, 0);
  EXPECT_EQ(fit.solve(), (std::vector<double>{0, 0, 0}));
}

TEST(TimeWeights, integersAddUpToOneWhereWeightsNearlyDo) {
  EXPECT_EQ(roundedWeights(std::array{1.0 / 3, 1.0 / 3, 1.0 / 3}), (std::vector<int>{6, 5, 5}));
  EXPECT_EQ(roundedWeights(std::array{0.52, 0.5}), (std::vector<int>{8, 8}));
  EXPECT_EQ(roundedWeights(std::array{0.56, 0.5}), (std::vector<int>{9, 8}));
  EXPECT_EQ(roundedWeights(std::array{-0.5}), (std::vector<int>{-8}));
}

TEST(TimeWeights, aWeightThatLeavesItsIntegerGivesNothing) {
  EXPECT_EQ(roundedWeights(std::array{126.0 / 16}), (std::vector<int>{126}));
  EXPECT_EQ(roundedWeights(std::array{127.0 / 16}), (std::vector<int>{127}));
  EXPECT_TRUE(roundedWeights(std::array{128.0 / 16}).empty());
  EXPECT_TRUE(roundedWeights(std::array{-128.0 / 16}).empty());
  // what is left for 1 goes to the largest, which then leaves its range
  EXPECT_TRUE(roundedWeights(std::array{127.4 / 16, -55.7 / 16, -55.7 / 16}).empty());
  EXPECT_TRUE(roundedWeights(std::array{0.0 / 0.0}).empty());
}

}  // namespace
}  // namespace qtet

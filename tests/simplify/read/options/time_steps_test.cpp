#include "simplify/read/options/time_steps.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

using Steps = std::vector<std::size_t>;
const std::vector<double> kTimes{-1, 0, 0.1, 0.2, 0.30000000000000004, 5};

Result<Steps> stepsOf(const std::string& asked, const std::vector<double>& times = kTimes) {
  std::vector<std::string> notes;
  return chosenSteps(times, asked, "run.pvd", notes);
}

TEST(TimeSteps, aRangeTakesEverySoManyOfTheStepsBetweenTwoTimes) {
  EXPECT_EQ(stepsOf("0:0.3").value(), (Steps{1, 2, 3, 4}));
  EXPECT_EQ(stepsOf("0:0.3:2").value(), (Steps{1, 3}));
  EXPECT_EQ(stepsOf("0.3:").value(), (Steps{4, 5}));
  EXPECT_EQ(stepsOf(":-1").value(), (Steps{0}));
  EXPECT_EQ(stepsOf("::5").value(), (Steps{0, 5}));
  EXPECT_EQ(stepsOf("::6").value(), (Steps{0}));
  EXPECT_EQ(stepsOf(":").value(), stepsOf("all").value());
  EXPECT_EQ(stepsOf("-1e0:0.:1").value(), (Steps{0, 1}));
}

TEST(TimeSteps, wordsHaveAnyCase) {
  EXPECT_EQ(stepsOf("LAST").value(), (Steps{5}));
  EXPECT_EQ(stepsOf("First").value(), (Steps{0}));
  EXPECT_EQ(stepsOf("aLL").value().size(), kTimes.size());
  EXPECT_EQ(timeWord("Later"), "Later");
}

TEST(TimeSteps, aRangeWithoutStepsSaysWhichThereAre) {
  for (const char* asked : {"6:", "0.11:0.19", "5:0"}) {
    const auto steps = stepsOf(asked);
    ASSERT_FALSE(steps) << asked;
    EXPECT_EQ(steps.error().code, ErrorCode::kNotFound);
    EXPECT_NE(steps.error().message.find("it has -1, 0, 0.1"), std::string::npos);
  }
  EXPECT_EQ(stepsOf("0:1", {}).error().code, ErrorCode::kNotFound);
}

TEST(TimeSteps, timesBetweenCommasAreTakenInOrderAndOnce) {
  EXPECT_EQ(stepsOf("5,0.1,-1,0.1").value(), (Steps{0, 2, 5}));
  for (const char* asked : {"0,7", "0,,1", ",", "0,"}) {
    const auto steps = stepsOf(asked);
    ASSERT_FALSE(steps) << asked;
    EXPECT_EQ(steps.error().code, ErrorCode::kNotFound) << asked;
  }
  EXPECT_NE(stepsOf("0,7").error().message.find("no time step 7"), std::string::npos);
}

TEST(TimeSteps, aTildeTakesTheNearestTimeWithANote) {
  std::vector<std::string> notes;
  EXPECT_EQ(chosenSteps(kTimes, "~0.25", "run.pvd", notes).value(), (Steps{3}));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "time 0.25 is none; the nearest, 0.2, is taken, which is 0.05 earlier");
  EXPECT_EQ(stepsOf("~0.26").value(), (Steps{4}));
  EXPECT_EQ(stepsOf("~-7").value(), (Steps{0}));
  EXPECT_EQ(stepsOf("~1e9").value(), (Steps{5}));
  EXPECT_EQ(stepsOf("~0.5", {0, 1}).value(), (Steps{0})) << "of two the earlier";
  EXPECT_EQ(stepsOf("~7,0.1,~-0.9").value(), (Steps{0, 2, 5}));
  notes.clear();
  EXPECT_EQ(chosenSteps(kTimes, "~0.3", "run.pvd", notes).value(), (Steps{4}));
  EXPECT_EQ(chosenSteps({7}, "~7", "run.pvd", notes).value(), (Steps{0}));
  EXPECT_TRUE(notes.empty()) << "it is the time itself";
  EXPECT_EQ(chosenSteps({7}, "~3", "run.pvd", notes).value(), (Steps{0}));
  EXPECT_EQ(notes.back(), "time 3 is none; the nearest, 7, is taken, which is 4 later");
  for (const char* asked : {"~", "~x", "~~1", "~nan", "~inf", "0,~"})
    EXPECT_EQ(stepsOf(asked).error().code, ErrorCode::kNotFound) << asked;
  EXPECT_EQ(stepsOf("~1", {}).error().code, ErrorCode::kNotFound);
}

TEST(TimeSteps, anExactTimeIsPreferredToOneThatIsNear) {
  const std::vector<double> unix{1700000000, 1700000001, 1700000002};
  for (std::size_t step = 0; step < unix.size(); ++step) {
    const std::string time = std::to_string(static_cast<long>(unix[step]));
    EXPECT_EQ(stepsOf(time, unix).value(), Steps{step});
    EXPECT_EQ(stepsOf(time + ":" + time, unix).value(), Steps{step});
  }
  EXPECT_EQ(stepsOf("1700000001,1700000002", unix).value(), (Steps{1, 2}));
  EXPECT_EQ(stepsOf("1700000001.4", unix).value(), Steps{1}) << "the nearest";
  EXPECT_EQ(stepsOf("1700000000.6", unix).value(), Steps{1});
  EXPECT_EQ(stepsOf("1700000003.9", unix).error().code, ErrorCode::kNotFound);
}

TEST(TimeSteps, aRangeOfOtherPartsIsRefused) {
  for (const char* asked :
       {"a:", ":b", "::0", "::-1", "::1.5", "0:1:2:3", "nan:", "0 :1", "::99999999999999999999"}) {
    const auto steps = stepsOf(asked);
    ASSERT_FALSE(steps) << asked;
    EXPECT_EQ(steps.error().code, ErrorCode::kBadValue) << asked;
  }
}

}  // namespace
}  // namespace qtet

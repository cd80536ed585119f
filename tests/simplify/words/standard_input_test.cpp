// The standard input as a file: the limit on its bytes. (Its use by commands: pipes.sh.)
#include "simplify/words/standard_input.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// The reading end of a pipe that holds `text`, which ends there.
int pipeWith(const std::string& text) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ::close(ends[1]);
  return ends[0];
}

TEST(StandardInput, isAFileUpToTheLimitAndNoFurther) {
  for (const std::uint64_t most : {4u, 5u, 6u}) {
    Words words{"check", "-", "-o", "-", "--format", "vtu"};
    const int input = pipeWith("12345");
    const auto spooled = spoolStandardInput(words, "", input, most);
    ::close(input);
    ASSERT_EQ(spooled.has_value(), most >= 5);
    if (!spooled) {
      EXPECT_EQ(spooled.error().code, ErrorCode::kLimitExceeded);
      EXPECT_EQ(words[1], "-");
      continue;
    }
    std::ifstream file(words[1]);
    std::string text;
    file >> text;
    EXPECT_EQ(text, "12345");
    EXPECT_TRUE(words[1].ends_with(".vtu"));
    EXPECT_EQ(words[3], "-") << "the output is no input";
  }
}

TEST(StandardInput, aPipesNameMeansWhatItGives) {
  const std::filesystem::path pipe = testing::freshFolder("named-pipe") / "named.vtu";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "12345"; });
  Words words{"check", pipe.string(), "-o", pipe.string(), "--plot3d", pipe.string()};
  const auto spooled = spoolStandardInput(words, "", -1);
  writer.join();
  ASSERT_TRUE(spooled) << spooled.error().text();
  std::ifstream file(words[1]);
  std::string text;
  file >> text;
  EXPECT_EQ(text, "12345");
  EXPECT_TRUE(words[1].ends_with(".vtu")) << "its own name says what kind of file it is";
  EXPECT_EQ(words[3], pipe.string()) << "the output is no input";
  EXPECT_EQ(words[5], pipe.string()) << "an option's file is no input";
}

TEST(StandardInput, isNotReadWhereNobodyAsksForIt) {
  Words words{"file.vtu", "-o", "-"};
  const auto spooled = spoolStandardInput(words, "", -1);
  ASSERT_TRUE(spooled);
  EXPECT_EQ(*spooled, nullptr);
}

TEST(StandardInput, kindsThatAreNoEndingAreRefused) {
  for (const std::string kind : {"../x", "a/b", "", "."}) {
    Words words{"-", "--format", kind};
    const auto spooled = spoolStandardInput(words, "", -1);
    ASSERT_FALSE(spooled) << kind;
    EXPECT_EQ(spooled.error().code, ErrorCode::kBadInput);
  }
}

}  // namespace
}  // namespace qtet

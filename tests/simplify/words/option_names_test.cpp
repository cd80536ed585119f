#include "simplify/words/option_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

TEST(OptionNames, standForTheMembersThatTheLibraryNames) {
  EXPECT_EQ(withOptionNames("leave out `lossless` or `keepOrder`"),
            "leave out --lossless or --keep-order");
  EXPECT_EQ(withOptionNames("`regions`: the mesh"), "--preserve-regions: the mesh");
  EXPECT_EQ(withOptionNames("`file`.vtu, `weld"), "`file`.vtu, `weld");
}

TEST(OptionNames, areKnownForEveryMemberThatAMessageNames) {
  static const std::regex kLiteral(R"("(?:[^"\\]|\\.)*")"), kMember("`[a-zA-Z]+`");
  std::size_t named = 0;
  for (const char* room : {"codec", "simplify"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             std::filesystem::path(testing::kSourceFolder) / room)) {
      const std::filesystem::path folder = entry.path().parent_path().filename();
      if (entry.path().extension() != ".cpp" || folder == "commands" || folder == "publish")
        continue;  // the tool's own words
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        if (line.find_first_not_of(' ') == line.find("//")) continue;  // a comment
        for (std::sregex_iterator literal(line.begin(), line.end(), kLiteral), end; literal != end;
             ++literal) {
          const std::string text = literal->str();
          for (std::sregex_iterator member(text.begin(), text.end(), kMember); member != end;
               ++member, ++named)
            EXPECT_NE(withOptionNames(member->str()), member->str()) << entry.path() << line;
        }
      }
    }
  }
  EXPECT_GT(named, 40u);
}

}  // namespace
}  // namespace qtet

// Help, and what is said of words that are not understood.
#include "simplify/commands/commands.h"

#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

TEST_F(Tool, helpOfACommandComesEitherWay) {
  for (const char* command : {"simplify", "extract", "manual"}) {
    const Ran before = run(std::string("help ") + command);
    EXPECT_EQ(before.code, 0);
    EXPECT_TRUE(before.out.starts_with(std::string("usage: qtet ") + command)) << before.out;
    EXPECT_EQ(before.out, run(std::string(command) + " --help").out);
  }
  EXPECT_EQ(run("help").out, run("--help").out);
  expectFailure("help squash", 2, "no command 'squash'");
  expectFailure("help info simplify", 2, "'simplify' is one word too many");
}

TEST_F(Tool, anOutputWithoutItsOptionIsRefusedWithAHint) {
  expectFailure("simplify in.vtu out.qtet", 2, "name the output with -o out.qtet");
  expectFailure("sample box box.vtu", 2, "name the output with -o box.vtu");
  expectFailure("extract in.qtet out.vtu --level 0", 2, "name the output with -o out.vtu");
  const std::string beside = run("simplify a.vtu b.vtu -o out.qtet").err;
  EXPECT_EQ(beside.find("name the output"), std::string::npos) << beside;
  const std::string none = run("info a.qtet b.qtet").err;
  EXPECT_EQ(none.find("-o"), std::string::npos) << none;
}

TEST_F(Tool, aLinkGivenAsOutputStaysAndLeadsToTheNewFile) {
  namespace fs = std::filesystem;
  fs::create_directory(folder_ / "disk");
  fs::create_symlink("disk/box.vtu", folder_ / "box.vtu");
  fs::create_symlink("disk/box.qtet", folder_ / "box.qtet");
  fs::create_symlink("nowhere/box.vtu", folder_ / "lost.vtu");
  for (int time = 0; time < 2; ++time) makeBoxLog();  // makes the files, then replaces them
  for (const char* name : {"box.vtu", "box.qtet"}) {
    EXPECT_TRUE(fs::is_symlink(folder_ / name)) << name;
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / "disk" / name))) << name;
  }
  expectFailure("sample box -o lost.vtu", 1, "nowhere");
}

}  // namespace
}  // namespace qtet

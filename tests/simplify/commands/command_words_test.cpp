// Help, and what is said of words that are not understood.

#include <unistd.h>

#include <map>

#include "simplify/words/did_you_mean.h"
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

TEST(DidYouMean, namesTheClosestWordThatIsNear) {
  const std::vector<std::string> known{"field-bits", "fields", "info", "level", "to"};
  const auto meant = [&](const char* word) { return didYouMean(word, known, "--"); };
  EXPECT_EQ(meant("levle"), "; did you mean '--level'?");
  EXPECT_EQ(meant("INFO"), "; did you mean '--info'?");
  EXPECT_EQ(meant("field"), "; did you mean '--fields'?") << "the shortest that begins so";
  EXPECT_EQ(meant("field-"), "; did you mean '--field-bits'?");
  EXPECT_EQ(meant("ot"), "; did you mean '--to'?");
  EXPECT_EQ(meant("onfi"), "; did you mean '--info'?") << "two edits";
  for (const char* far : {"", "x", "colour", "lexxxl", "levelabc"})
    EXPECT_EQ(meant(far), "") << far;
  EXPECT_EQ(didYouMean(std::string(100'000, 'a'), known), "") << "too long to compare";
}

TEST_F(Tool, aWordNearToOneThatIsKnownIsAnsweredWithIt) {
  expectFailure("inof box.qtet", 2, "no command 'inof'; did you mean 'info'? There are: sample,");
  expectFailure("hlep info", 2, "did you mean 'help'?");
  expectFailure("extract a.qtet -o a.vtu --levle 1", 2, "did you mean '--level'?");
  expectFailure("simplify a.vtu -o a.qtet --target 0.1", 2, "did you mean '--target-ratio'?");
  for (const char* words : {"squash box.vtu", "info --colour", "info -x", "info --"})
    EXPECT_EQ(run(words).err.find("did you mean"), std::string::npos) << words;
}

TEST_F(Tool, aFileThatIsThereIsKeptWithNoClobber) {
  makeBoxLog();
  ASSERT_EQ(run("extract box.qtet --level 0 -o base.vtu --no-clobber").code, 0) << "nothing there";
  std::filesystem::create_directory(folder_ / "site");
  put("qtet.1", "a page");
  put("box.html", "a page");
  put("box.json", "a list");
  for (const char* words :
       {"sample box -o box.vtu", "convert base.vtu -o box.vtu", "convert box.qtet -o base.vtu",
        "simplify base.vtu -o box.qtet", "simplify base.vtu -o box.json",
        "extract box.qtet --level 1 -o base.vtu", "extract box.qtet --level 1 --to vtk -o base.vtu",
        "add-field box.qtet --from base.vtu -o box.qtet", "page base.vtu -o box.html",
        "remove-field box.qtet --fields Scalar -o box.qtet", "publish site box.qtet", "manual ."}) {
    std::map<std::string, std::string> before;
    for (const char* name : {"box.vtu", "box.qtet", "base.vtu", "box.html", "box.json", "qtet.1"})
      before[name] = contentOf(folder_ / name);
    expectFailure(std::string(words) + " --no-clobber", 1, "");
    for (const auto& [name, content] : before)
      EXPECT_EQ(contentOf(folder_ / name), content) << words;
  }
  expectFailure("sample box -o box.vtu --no-clobber", 1, "the output box.vtu exists");
  expectFailure("remove-field box.qtet --fields Scalar --no-clobber", 2, "with -o");
  EXPECT_EQ(run("extract box.qtet --level 1 -o base.vtu").code, 0);
}

/// Words before a program that take root's right to read and write everything.
std::string withoutRootsRights() {
  if (::geteuid() != 0) return "";
  return "setpriv --bounding-set=-dac_override,-dac_read_search "
         "--inh-caps=-dac_override,-dac_read_search ";
}

TEST_F(Tool, aFolderWithoutRightsIsNotCalledMissing) {
  makeBoxLog();
  // a circle of links is refused to everybody
  std::filesystem::create_symlink("circle", folder_ / "circle");
  EXPECT_NE(run("check circle/box.vtu").out.find("Too many levels of symbolic links"),
            std::string::npos);
  for (const char* words : {"sample box -o circle/box.vtu", "page circle/box.vtu -o box.html",
                            "info circle/run.json"}) {
    expectFailure(words, 1, "Too many levels of symbolic links");
    EXPECT_EQ(run(words).err.find("not exist"), std::string::npos) << words;
  }
  const std::string rights = withoutRootsRights();
  if (!rights.empty() && std::system((rights + "true").c_str()) != 0)
    GTEST_SKIP() << "root, and no setpriv(1) to give its rights up";
  namespace fs = std::filesystem;
  fs::create_directory(folder_ / "shut");
  fs::create_directory(folder_ / "shut/inside");
  fs::copy(folder_ / "box.vtu", folder_ / "shut/box.vtu");
  fs::copy(folder_ / "box.qtet", folder_ / "shut/box.qtet");
  fs::permissions(folder_ / "shut", fs::perms::none);
  for (const char* words :
       {"sample box -o shut/inside/box.vtu", "simplify box.vtu -o shut/inside/box.qtet",
        "check shut/box.vtu", "info shut/box.qtet", "verify shut/run.json",
        "page shut/box.vtu -o box.html", "publish shut/inside/site box.qtet"}) {
    const std::string command = "cd '" + folder_.string() + "' && " + rights + "'" +
                                testing::kTool + "' " + words + " >out.txt 2>err.txt";
    EXPECT_NE(std::system(command.c_str()), 0) << words;
    const std::string said = contentOf(folder_ / "out.txt") + contentOf(folder_ / "err.txt");
    EXPECT_NE(said.find("Permission denied"), std::string::npos) << words << "\n" << said;
    EXPECT_EQ(said.find("not exist"), std::string::npos) << words << "\n" << said;
  }
  fs::permissions(folder_ / "shut", fs::perms::owner_all);
}

TEST_F(Tool, anOutputWithoutItsOptionIsRefusedWithAHint) {
  expectFailure("simplify in.vtu out.qtet", 2, "name the output with -o out.qtet");
  expectFailure("sample box box.vtu", 2, "name the output with -o box.vtu");
  expectFailure("extract in.qtet out.vtu --level 0", 2, "name the output with -o out.vtu");
  const std::string beside = run("simplify a.vtu b.vtu -o out.qtet").err;
  EXPECT_EQ(beside.find("name the output"), std::string::npos) << beside;
  const std::string none = run("check a.vtu b.vtu").err;
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

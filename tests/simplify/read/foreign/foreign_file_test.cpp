#include "simplify/read/foreign/foreign_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "simplify/read/foreign/read_foreign.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// A python3 that comes first on the path and does `script`; the path is as before afterwards.
class FakePython {
 public:
  explicit FakePython(const std::string& script) {
    const fs::path program = folder_ / "python3";
    std::ofstream(program) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (folder_.string() + ":" + before_).c_str(), 1);
  }
  ~FakePython() { ::setenv("PATH", before_.c_str(), 1); }
  FakePython(const FakePython&) = delete;
  FakePython& operator=(const FakePython&) = delete;

 private:
  fs::path folder_ = testing::freshFolder("fake-python");
  std::string before_ = std::getenv("PATH");
};

/// The error of reading a file by a python3 that does `script`.
Error errorBy(const std::string& script, const ForeignInput& input) {
  const FakePython python(script);
  ReadReport report;
  const auto read = readForeign(input, {}, report);
  EXPECT_FALSE(read);
  return read ? Error{} : read.error();
}

ForeignInput beam(std::chrono::seconds patience = 60s) {
  return {.path = "beam.med", .kind = "", .patience = patience};
}

TEST(ForeignFile, aProgramThatMovesNoByteForTooLongIsGivenUp) {
  const auto start = std::chrono::steady_clock::now();
  const Error error = errorBy("exec sleep 600", beam(1s));
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_NE(error.message.find("`readSeconds`"), std::string::npos) << error.message;
  EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
}

TEST(ForeignFile, aProgramThatWritesOnIsWaitedFor) {
  const Error error =
      errorBy("for i in 1 2 3 4 5 6; do echo $i >&2; sleep 0.5; done; echo last words >&2; exit 1",
              beam(2s));
  EXPECT_NE(error.message.find("last words"), std::string::npos) << error.message;
}

TEST(ForeignFile, aByteOrderMarkIsTakenOffTheTextButNotOffXdmf) {
  const fs::path file = testing::freshFolder("marked") / "mesh.off";
  std::ofstream(file) << "\xEF\xBB\xBFOFF 4 4\n";
  for (const auto& [kind, begins] : {std::pair("", ": OFF 4 "), {"xdmf", ": \xEF\xBB\xBFOFF"}}) {
    const Error error = errorBy("head -c 6 \"$3\" >&2; exit 1", {.path = file, .kind = kind});
    EXPECT_NE(error.message.find(begins), std::string::npos) << error.message;
    EXPECT_TRUE(error.message.starts_with(file.string())) << error.message;
  }
}

TEST(ForeignFile, aProgramThatTheSystemEndsIsTold) {
  const Error error = errorBy("kill -KILL $$", beam());
  EXPECT_NE(error.message.find("it ended without a word"), std::string::npos) << error.message;
  const Error ofVtk =
      errorBy("kill -KILL $$", {.path = "a.e", .library = ForeignLibrary::kVtk, .kind = "exodus"});
  EXPECT_NE(ofVtk.message.find("VTK crashes on it"), std::string::npos) << ofVtk.message;
}

// It may be spoilt: no file outside of its folder is read for it.
TEST(ForeignFile, partsAreOfItsOwnFolderAlone) {
  const fs::path other = testing::freshFolder("other") / "secret.vtu";
  std::ofstream(other) << "<VTKFile/>";
  const Error error = errorBy(
      "echo 'times '; read number; echo 'block " + other.string() + "'; echo 'done '; read more",
      beam());
  EXPECT_NE(error.message.find("there is no file"), std::string::npos) << error.message;
}

TEST(ForeignFile, timesAndFailuresAreTakenAsTheProgramSaysThem) {
  const Error none = errorBy("echo 'times soon'", beam());
  EXPECT_NE(none.message.find("soon"), std::string::npos) << none.message;
  const Error late = errorBy(
      "printf 'note from far\\ntimes 0\\t1.5\\n'; read number; echo failed at $number", beam());
  EXPECT_EQ(late.message, "beam.med: at 1") << "the last step was asked for";
  const Error early = errorBy("echo failed soon", beam());
  EXPECT_EQ(early.message, "beam.med: soon");
}

}  // namespace
}  // namespace qtet

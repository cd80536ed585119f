// Running the tool as people and scripts do, in a folder of the test's own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "codec/files/atomic_file.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/read_mesh.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {

struct Ran {
  int code = -1;
  std::string out;
  std::string err;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Tool : public ::testing::Test {
 protected:
  /// Runs `qtet WORDS` in the test's folder.
  Ran run(const std::string& words) {
    const std::string command = "cd '" + folder_.string() + "' && '" + testing::kTool + "' " +
                                words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(folder_ / "out.txt"),
            contentOf(folder_ / "err.txt")};
  }
  /// A failure must leave every line of the diagnostics marked and the standard output empty. Words
  /// that are not understood (code 2) take two lines.
  void expectFailure(const std::string& words, int code, const std::string& word) {
    const Ran ran = run(words);
    EXPECT_EQ(ran.code, code) << words << "\n" << ran.err;
    EXPECT_TRUE(ran.out.empty()) << ran.out;
    EXPECT_NE(ran.err.find(word), std::string::npos) << words << "\n" << ran.err;
    std::istringstream lines(ran.err);
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(line.starts_with("qtet: ")) << line;
    if (code != 2) return;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 2) << ran.err;
    EXPECT_NE(ran.err.find("\nqtet: see 'qtet "), std::string::npos) << ran.err;
  }
  /// The sample box with its one field called T, which box.vtu has as Scalar.
  TetMesh boxWithT() {
    EXPECT_EQ(run("sample box -o box.vtu").code, 0);
    TetMesh mesh = readMesh(folder_ / "box.vtu").value().mesh;
    mesh.fields.resize(1);
    mesh.fields[0].name = "T";
    return mesh;
  }
  void write(const std::string& name, const TetMesh& mesh) {
    ASSERT_TRUE(writeFileAtomically(folder_ / name, vtuBytes(mesh)));
  }
  void put(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void makeBoxLog() {
    ASSERT_EQ(run("sample box -o box.vtu").code, 0);
    const Ran ran = run("simplify box.vtu -o box.qtet");
    ASSERT_EQ(ran.code, 0) << ran.err;
  }

  std::filesystem::path folder_ = testing::freshFolder(
      std::string("tool-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace qtet

// The tool as people and scripts run it: exit codes, streams, JSON, files.
#include "tests/simplify/commands/tool_run.h"

#include <bit>
#include <cmath>
#include <limits>

#include "codec/coding/float_bits.h"
#include "codec/files/atomic_file.h"
#include "proto/version.h"
#include "simplify/read/read_mesh.h"
#include "simplify/words/printable.h"
#include "tests/simplify/mesh/tet_meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

TEST_F(Tool, helpAndVersionSucceed) {
  EXPECT_EQ(run("--version").out, "qtet " + version() + "\n");
  const Ran help = run("--help");
  EXPECT_EQ(help.code, 0);
  for (const char* command :
       {"sample", "check", "convert", "simplify", "info", "extract", "add-field", "add-steps",
        "remove-field", "verify", "push", "publish", "page", "view", "completion", "manual"}) {
    EXPECT_NE(help.out.find(command), std::string::npos);
    const Ran own = run(std::string(command) + " --help");
    EXPECT_EQ(own.code, 0);
    EXPECT_NE(own.out.find("examples:"), std::string::npos);
    EXPECT_TRUE(own.err.empty());
    const Ran all = run(std::string(command) + " --help-all");
    EXPECT_EQ(all.code, 0);
    std::istringstream lines(help.out + own.out + all.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(textWidth(line), 100u) << line;
  }
  const std::string often = run("simplify --help").out, all = run("simplify --help-all").out;
  EXPECT_NE(often.find("simplify/INPUT.md"), std::string::npos);
  EXPECT_LE(std::ranges::count(often, '\n'), 50);
  EXPECT_EQ(often.find("--plot3d arg"), std::string::npos);
  for (const char* command : {"simplify", "check", "convert", "extract", "add-field", "add-steps",
                              "verify", "page", "view"})
    EXPECT_NE(run(std::string(command) + " --help").out.find("\n  --time arg"), std::string::npos)
        << command;
  for (const char* words :
       {"\ninput:\n", "\nquality and base mesh:\n", "--plot3d arg", "--fields arg"})
    EXPECT_NE(all.find(words), std::string::npos) << words;
}

TEST_F(Tool, valuesAreWithinTheErrorThatWasAskedForAndVerifyProvesIt) {
  const TetMesh mesh = boxWithT();
  write("t.vtu", mesh);
  const std::string make = "simplify t.vtu -o t.qtet --measure none --unit T=K ";
  ASSERT_EQ(run(make + "--error T=0.01K").code, 0);
  const nlohmann::json field = run("info t.qtet --json").json()["fields"][0];
  EXPECT_LE(field["largestRoundingError"], 0.01) << field;
  EXPECT_GT(field["largestRoundingError"], 0.0095) << field;
  const Ran proof = run("verify t.qtet --against t.vtu");
  EXPECT_EQ(proof.code, 0) << proof.err;
  EXPECT_NE(proof.out.find("\neach value of T is within 0.009"), std::string::npos) << proof.out;
  const nlohmann::json errors =
      run("verify t.qtet --against t.vtu --json").json()["against"]["valueErrors"]["T"];
  EXPECT_EQ(errors["bound"], field["largestRoundingError"]);
  EXPECT_LE(errors["largest"], errors["bound"]);
  EXPECT_EQ(errors["unit"], "K");
  TetMesh other = mesh;
  other.fields[0].values[5] += 0.02;
  write("other.vtu", other);
  expectFailure("verify t.qtet --against other.vtu", 1, "");

  expectFailure(make + "--error T=0.01C", 1, "--error of T is in C, and the field is in K");
  expectFailure(make + "--error p=1", 1, "not-found: --error: the mesh carries no field 'p'");
  expectFailure(make + "--error T=1e-12", 1, "field T cannot be within 1e-12: 28 bits");
  for (const char* wrong : {"T", "=1", "T=", "T=K", "T=0", "T=-1", "T=nan"})
    expectFailure(make + "--error " + wrong, 2, "write NAME=BOUND");

  ASSERT_EQ(run("add-field t.qtet --from t.vtu --replace --error all=0.5% -o u.qtet").code, 0);
  const nlohmann::json coarse = run("info u.qtet --json").json()["fields"][0];
  EXPECT_EQ(coarse["bits"], 7);
  EXPECT_NE(run("info u.qtet").out.find("  within  "), std::string::npos);
  expectFailure("add-field t.qtet --from t.vtu --replace --error T=1m -o u.qtet", 1, "is in K");
}

TEST_F(Tool, completionsAndManualPagesSayWhatHelpSays) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Ran ran = run(std::string("completion ") + shell);
    EXPECT_EQ(ran.code, 0);
    for (const char* word : {"extract", "boundary-error", "remove-field"})
      EXPECT_NE(ran.out.find(word), std::string::npos) << shell;
  }
  run("completion bash");
  const std::string ask = "cd '" + folder_.string() +
                          "' && bash -c 'set -eu; source out.txt; COMP_WORDS=(qtet extract --bou); "
                          "COMP_CWORD=2; _qtet; echo \"${COMPREPLY[@]}\"' >said.txt";
  ASSERT_EQ(std::system(ask.c_str()), 0);
  EXPECT_EQ(contentOf(folder_ / "said.txt"), "--boundary-error\n");
  expectFailure("completion csh", 2, "bash, zsh or fish");

  ASSERT_EQ(run("manual .").code, 0);
  EXPECT_NE(contentOf(folder_ / "qtet.1").find("qtet\\-extract"), std::string::npos);
  const std::string page = contentOf(folder_ / "qtet-extract.1");
  for (const char* words :
       {".TH QTET-EXTRACT 1", "\\-\\-boundary\\-error", ".SH EXAMPLES\n.nf\n  qtet extract"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  expectFailure("manual nowhere", 1, "does not exist");
}

TEST_F(Tool, quietSaysErrorsAloneAndVerboseHowLongItTook) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran quiet = run("simplify box.vtu -o box.qtet --quiet --target-ratio 0.05");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_NE(run("info -q box.qtet").out.find("3,072 tetrahedra"), std::string::npos);
  EXPECT_EQ(run("simplify box.vtu -o box.qtet -q --json").json()["tetrahedra"]["input"], 3072);
  expectFailure("extract no.qtet --level 0 -o a.vtu -q", 1, "no.qtet");
  const Ran verbose = run("simplify box.vtu -o box.qtet --verbose");
  for (const char* words : {"qtet: simplifying: ", " s\n", " MB of memory at most"})
    EXPECT_NE(verbose.err.find(words), std::string::npos) << verbose.err;
}

TEST_F(Tool, aBaseMeshThatLostMuchIsWarnedOfAlsoWhereItIsToBeQuiet) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran quiet = run("simplify box.vtu -o box.qtet --quiet --target-ratio 0.003");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(quiet.err.starts_with("qtet: warning: the base mesh has lost ")) << quiet.err;
  EXPECT_EQ(std::ranges::count(quiet.err, '\n'), 1);
  const nlohmann::json lost =
                           run("simplify box.vtu -o box.qtet --json --target-ratio 0.003").json(),
                       kept = run("simplify box.vtu -o box.qtet --json").json();
  ASSERT_EQ(lost["warnings"].size(), 1u);
  EXPECT_NE(lost["warnings"][0].get<std::string>().find("--base-cells"), std::string::npos);
  EXPECT_EQ(kept["warnings"], nlohmann::json::array());
}

/// The levels whose errors are known.
nlohmann::json measuredOf(const nlohmann::json& levels) {
  nlohmann::json out = nlohmann::json::array();
  for (const nlohmann::json& level : levels)
    if (level.contains("error")) out.push_back(level);
  return out;
}

TEST_F(Tool, infoShowsLevelsWithTheirErrorsOrAll) {
  makeBoxLog();
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  const auto levels =
      static_cast<std::ptrdiff_t>(run("info box.qtet --json").json()["levels"].size());
  ASSERT_GT(levels, 20);
  const auto measured =
      static_cast<std::ptrdiff_t>(measuredOf(run("info box.qtet --json").json()["levels"]).size());
  const Ran few = run("info box.qtet"), all = run("info box.qtet --all");
  EXPECT_GE(lines(all.out) - lines(few.out), levels - std::min<std::ptrdiff_t>(measured, 20) - 2);
  for (const Ran& ran : {few, all})
    for (const char* words : {"    0  ", "     3,072 ", "\nScalar"})
      EXPECT_NE(ran.out.find(words), std::string::npos) << ran.out;
  EXPECT_EQ(few.out.find('\033'), std::string::npos) << "colours where there is no terminal";
  const std::string onTerminal = "cd '" + folder_.string() + "' && TERM=xterm %s script -qec \"'" +
                                 testing::kTool + "' info box.qtet\" tty.txt >out.txt </dev/null";
  for (const auto& [word, coloured] :
       {std::pair{std::string("NO_COLOR="), true}, {std::string("NO_COLOR=1"), false}}) {
    if (std::system("command -v script >/dev/null") != 0)
      GTEST_SKIP() << "no script(1) to make a terminal";
    std::string command = onTerminal;
    command.replace(command.find("%s"), 2, word);
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(contentOf(folder_ / "out.txt").find("\033[1m") != std::string::npos, coloured)
        << word;
  }
}

TEST_F(Tool, infoAndVerifyOfSeveralLogsNameEachAndEndWithTheWorst) {
  makeBoxLog();
  const std::string one = run("info box.qtet").out, verified = run("verify box.qtet").out;
  std::filesystem::copy(folder_ / "box.qtet", folder_ / "two.qtet");
  EXPECT_EQ(run("info box.qtet two.qtet").out, "box.qtet:\n" + one + "\ntwo.qtet:\n" + one);
  EXPECT_EQ(run("verify box.qtet two.qtet").out,
            "box.qtet:\n" + verified + "\ntwo.qtet:\n" + verified);
  for (const std::string command : {"info", "verify"}) {
    const nlohmann::json alone = run(command + " box.qtet --json").json();
    EXPECT_TRUE(alone.is_object());
    const Ran ran = run(command + " box.qtet no.qtet two.qtet --json");
    EXPECT_EQ(ran.code, 1);
    EXPECT_NE(ran.err.find("no.qtet"), std::string::npos);
    const nlohmann::json all = ran.json();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0]["input"], "box.qtet");
    EXPECT_EQ(all[0]["digest"], alone["digest"]);
    EXPECT_EQ(all[1]["error"]["code"], "io");
    EXPECT_EQ(all[2]["digest"], alone["digest"]) << "a failure does not end the rest";
  }
  EXPECT_EQ(run("verify box.qtet two.qtet --against box.vtu").code, 0);
  put("bad.qtet", "no log");
  EXPECT_EQ(run("verify bad.qtet box.qtet").code, 1);
}

TEST_F(Tool, whatStrangersNamedReachesNoTerminal) {
  makeBoxLog();
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 "
      "1\n$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n";
  for (const char* section : {"NodeData", "ElementData"})
    text += "$" + std::string(section) + "\n1\n\"\033[31m\302\2335m" + section +
            "\"\n0\n3\n0\n1\n1\n1 7\n$End" + section + "\n";
  const std::string name = "\033]0;title\007.msh";
  put(name, text);
  for (const char* words :
       {"check *.msh", "simplify *.msh -o named.qtet",
        "simplify *.msh -o named.qtet --lossless --verbose", "info named.qtet",
        "verify named.qtet --against *.msh", "simplify *.msh -o named.qtet --fields nobody",
        "add-field box.qtet --from *.msh -o more.qtet"}) {
    const Ran ran = run(words);
    for (const std::string& said : {ran.out, ran.err}) {
      EXPECT_EQ(said.find_first_of("\033\007\r"), std::string::npos) << words << "\n" << said;
      EXPECT_EQ(said.find("\302\233"), std::string::npos) << words << "\n" << said;
    }
  }
  EXPECT_NE(run("info named.qtet").out.find("\uFFFD[31m\uFFFD5mNodeData"), std::string::npos);
  EXPECT_EQ(run("info named.qtet --json").json()["fields"][0]["name"], "\033[31m\302\2335mNodeData")
      << "programs get the name itself";
}

TEST_F(Tool, checkTellsWhatIsWrongAndEndsWithOneWhereSimplifyWouldRefuse) {
  TetMesh mesh = testing::twoCells();
  mesh.points.push_back({2, 2, 2});
  write("kept.vtu", mesh);
  const Ran kept = run("check kept.vtu --json");
  EXPECT_EQ(kept.code, 0) << kept.err;
  EXPECT_EQ(kept.json()["refused"], false);
  ASSERT_EQ(kept.json()["findings"].size(), 1u);
  EXPECT_EQ(kept.json()["findings"][0]["kind"], "unusedPoints");
  EXPECT_EQ(kept.json()["findings"][0]["verdict"], "repaired");
  EXPECT_EQ(kept.json()["findings"][0]["first"], nlohmann::json::array({5}));
  mesh.tetrahedra.push_back({1, 2, 3, 5});
  write("bad.vtu", mesh);
  const Ran bad = run("check bad.vtu");
  EXPECT_EQ(bad.code, 1);
  EXPECT_NE(
      bad.out.find("refused   faces of more than two cells: the cells overlap: 1 (tetrahedron 0)"),
      std::string::npos)
      << bad.out;
  EXPECT_EQ(run("simplify bad.vtu -o bad.qtet").code, 1);
  EXPECT_EQ(run("check missing.vtu").code, 1);
  expectFailure("check bad.vtu --curved round", 2, "give split or linear");
  expectFailure("check bad.vtu --threshold f=1", 2, "FIELD=LOW:HIGH");
  expectFailure("check bad.vtu --weld -1", 2, "--weld");
}

TEST_F(Tool, aWeldedMeshIsVerifiedWithTheSameOptions) {
  TetMesh mesh = testing::oneCell();
  for (const VertexId v : {1u, 2u, 3u}) mesh.points.push_back(mesh.points[v]);
  mesh.points.push_back({1, 1, 1});
  mesh.tetrahedra.push_back({4, 5, 6, 7});
  write("slit.vtu", mesh);
  ASSERT_EQ(run("simplify slit.vtu --weld 0 -o joined.qtet").code, 0);
  EXPECT_EQ(run("verify joined.qtet --against slit.vtu --weld 0").code, 0);
  EXPECT_EQ(run("verify joined.qtet --against slit.vtu").code, 1);
  ASSERT_EQ(run("convert slit.vtu --weld 0 -o joined.vtu").code, 0);
  EXPECT_EQ(run("verify joined.qtet --against joined.vtu").code, 0);
  expectFailure("convert slit.vtu -o slit.step", 2, "must end in one of .vtu .vtk");
}

TEST_F(Tool, wordsThatAreNotUnderstoodEndWithTwo) {
  expectFailure("", 2, "a command is missing");
  expectFailure("squash box.vtu", 2, "no command 'squash'");
  expectFailure("info", 2, "LOG is missing");
  // the parser's own word, in which its error's text would be sought for ever
  expectFailure("info --x%original_token%", 2, "--x%original_token%");
  expectFailure("simplify in.vtu", 2, "--output is missing");
  expectFailure("simplify in.vtu -o out.qtet --colour red", 2, "--colour");
  expectFailure("simplify in.vtu -o out.qtet --field 3", 2, "--field");
  expectFailure("simplify in.vtu -o out.qtet --position-bits 29", 2, "4 to 28");
  expectFailure("simplify in.vtu -o out.qtet --position-bits x", 2, "position-bits");
  expectFailure("simplify in.vtu -o out.qtet --target-ratio 1.5", 2, "0 to 1");
  expectFailure("simplify in.vtu -o out.qtet --threads 0", 2, "threads");
  expectFailure("simplify in.vtu -o out.qtet --algorithm edges", 2, "give qtet or paper");
  expectFailure("simplify in.vtu -o out.qtet --fields a,,b", 2, "empty name");
  expectFailure("simplify in.vtu -o out.vtu", 2, ".qtet");
  expectFailure("simplify a.vtu out.qtet", 2, "name the output with -o out.qtet");
  expectFailure("convert a.vtu b.vtu -o out.vtk", 2, "'b.vtu' is one word too many");
  expectFailure("extract a.qtet -o a.vtu", 2, "exactly one");
  expectFailure("extract a.qtet -o a.vtu --level 1 --tets 5", 2, "exactly one");
  expectFailure("extract a.qtet -o a.step --level 1", 2, ".vtu");
  expectFailure("sample pyramid -o a.vtu", 2, "box, fin");
}

TEST_F(Tool, filesAtFaultEndWithOne) {
  expectFailure("simplify no.vtu -o out.qtet", 1, "not-found");
  expectFailure("info no.qtet", 1, "no.qtet");
  expectFailure("verify no.qtet", 1, "no.qtet");
  expectFailure("sample box -o nowhere/box.vtu", 1, "nowhere");
  std::ofstream(folder_ / "bad.qtet") << std::string(200, 'x');
  expectFailure("info bad.qtet", 1, "bad-magic");
  std::ofstream(folder_ / "bad.vtu") << "no mesh";
  expectFailure("simplify bad.vtu -o out.qtet", 1, "bad.vtu");
  EXPECT_FALSE(fs::exists(folder_ / "out.qtet"));
}

TEST_F(Tool, whatVtkSaysIsToldInOurForm) {
  std::ofstream(folder_ / "hole.vtk") << "# vtk DataFile Version 3.0\nx\nASCII\nDATASET "
                                         "STRUCTURED_GRID\nDIMENSIONS 2 2 2\nPOINTS 8";
  expectFailure("simplify hole.vtk -o out.qtet", 1, "VTK could not read it: ");
}

TEST_F(Tool, anErrorIsAJsonObjectWhereJsonIsAsked) {
  const Ran ran = run("simplify no.vtu -o out.qtet --json");
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.json()["error"]["code"], "not-found");
}

TEST_F(Tool, theInputIsNeverOverwritten) {
  makeBoxLog();
  fs::copy(folder_ / "box.vtu", folder_ / "same.qtet");
  fs::create_symlink("same.qtet", folder_ / "link.qtet");
  const std::string before = contentOf(folder_ / "same.qtet");
  expectFailure("simplify same.qtet -o link.qtet", 1, "the input itself");
  EXPECT_EQ(contentOf(folder_ / "same.qtet"), before);
}

TEST_F(Tool, simplifyReportsWhatItDid) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran ran = run("simplify box.vtu -o box.qtet --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const nlohmann::json report = ran.json();
  EXPECT_EQ(report["tetrahedra"]["input"], 3072);
  EXPECT_EQ(report["tetrahedra"]["full"], 3072);
  EXPECT_GT(report["percentRemoved"], 80.0);
  EXPECT_GT(report["levels"], 5);
  EXPECT_EQ(report["bytes"], fs::file_size(folder_ / "box.qtet"));
  EXPECT_GT(report["bitsPerTetrahedron"]["connectivity"], 0.0);
  EXPECT_GT(report["bitsPerTetrahedron"]["fields"]["Scalar"], 0.0);
  EXPECT_EQ(report["lattice"]["bits"], 16);
  EXPECT_EQ(report["clean"]["components"], 1);
  const nlohmann::json& parts = report["bytesOf"];
  EXPECT_EQ(parts["head"].get<int>() + parts["connectivity"].get<int>() +
                parts["positions"].get<int>() + parts["fields"]["Scalar"].get<int>(),
            report["bytes"].get<int>());
}

TEST_F(Tool, theAlgorithmOfThePaperMakesAnOrdinaryLogAndTellsItsFigures) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran ran = run("simplify box.vtu -o paper.qtet --algorithm paper --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const nlohmann::json report = ran.json();
  EXPECT_EQ(report["algorithm"], "paper");
  const nlohmann::json& paper = report["paper"];
  EXPECT_EQ(paper["removed"].get<int>(), 3072 - report["tetrahedra"]["base"].get<int>());
  EXPECT_DOUBLE_EQ(paper["averageRemoved"].get<double>() * paper["fusions"].get<double>(),
                   paper["removed"].get<double>());
  EXPECT_GT(paper["interiorFusions"], 0);
  EXPECT_GT(paper["seconds"]["initialise"], 0);
  EXPECT_GT(paper["seconds"]["fuse"], 0);
  for (const char* rule : {"flip", "envelope", "topology", "few"})
    EXPECT_TRUE(paper["refused"].contains(rule)) << rule;
  EXPECT_EQ(run("verify paper.qtet --against box.vtu").code, 0);

  const nlohmann::json own = run("simplify box.vtu -o own.qtet --algorithm qtet --json").json();
  EXPECT_EQ(own["algorithm"], "qtet");
  EXPECT_FALSE(own.contains("paper"));
  EXPECT_FALSE(report.contains("boundaryWeight")) << "the paper's cost has none";
}

TEST_F(Tool, tellsTheBoundaryWeightItTookOrChose) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const double chosen = run("simplify box.vtu -o chosen.qtet --json").json()["boundaryWeight"];
  EXPECT_GT(chosen, 0.5);
  EXPECT_LT(chosen, 200);
  const nlohmann::json taken =
      run("simplify box.vtu -o taken.qtet --boundary-weight 15000 --json").json();
  EXPECT_EQ(taken["boundaryWeight"], 15000);
  EXPECT_FALSE(
      run("simplify box.vtu -o plain.qtet --fields none --json").json().contains("boundaryWeight"))
      << "nothing to weigh it against";
}

TEST_F(Tool, infoTellsEveryLevel) {
  makeBoxLog();
  const nlohmann::json info = run("info box.qtet --json").json();
  const nlohmann::json& levels = info["levels"];
  ASSERT_GT(levels.size(), 5u);
  EXPECT_EQ(levels.back()["tetrahedra"], 3072);
  EXPECT_EQ(levels.back()["vertices"], 729);
  EXPECT_EQ(levels.back()["cumulativeBytes"], fs::file_size(folder_ / "box.qtet"));
  std::uint64_t sum = 0, tetrahedra = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    EXPECT_EQ(levels[i]["level"], i);
    sum += levels[i]["bytes"].get<std::uint64_t>();
    EXPECT_EQ(levels[i]["cumulativeBytes"], sum);
    EXPECT_GE(levels[i]["tetrahedra"], tetrahedra);
    tetrahedra = levels[i]["tetrahedra"];
  }
  EXPECT_EQ(info["fields"][0]["name"], "Scalar");
  EXPECT_EQ(info["digest"].get<std::string>().size(), 64u);
}

TEST_F(Tool, extractChoosesTheLevel) {
  makeBoxLog();
  const nlohmann::json levels = run("info box.qtet --json").json()["levels"];
  const auto cellsOf = [&](const std::string& option) {
    const Ran ran = run("extract box.qtet -o level.vtu " + option);
    EXPECT_EQ(ran.code, 0) << ran.err;
    const Result<ReadMesh> read = readMesh(folder_ / "level.vtu");
    EXPECT_TRUE(read);
    return read ? read->mesh.tetrahedra.size() : 0;
  };
  EXPECT_EQ(cellsOf("--level 0"), levels[0]["tetrahedra"]);
  EXPECT_EQ(cellsOf("--level 7"), levels[7]["tetrahedra"]);
  EXPECT_EQ(cellsOf("--ratio 1"), 3072u);
  EXPECT_EQ(cellsOf("--ratio 0"), levels[0]["tetrahedra"]);
  EXPECT_EQ(cellsOf("--tets 1"), levels[0]["tetrahedra"]);
  EXPECT_EQ(cellsOf("--tets " + std::to_string(levels[9]["tetrahedra"].get<int>())),
            levels[9]["tetrahedra"]);
  EXPECT_EQ(cellsOf("--tets " + std::to_string(levels[9]["tetrahedra"].get<int>() - 1)),
            levels[8]["tetrahedra"]);
  expectFailure("extract box.qtet -o level.vtu --level 9999", 1, "no level 9999");
}

TEST_F(Tool, knownErrorsAreMeasuredAndTold) {
  makeBoxLog();
  const nlohmann::json levels = run("info box.qtet --json").json()["levels"];
  for (const nlohmann::json& level : measuredOf(levels)) {
    const nlohmann::json& error = level["error"];
    EXPECT_LT(error["volumeLost"].get<double>(), 0.05);
    EXPECT_LT(error["volumeGained"].get<double>(), 0.05);
    EXPECT_EQ(error["fields"].size(), 1u);
  }
  EXPECT_GT(levels[0]["error"]["fields"][0]["rms"], 0);
  const nlohmann::json& rounding = levels.back()["error"]["fields"][0];
  EXPECT_NEAR(rounding["max"].get<double>(), 0.5 / 4095, 0.01 / 4095);
  EXPECT_LT(rounding["rms"], rounding["max"]);
  const Ran table = run("info box.qtet");
  for (const char* words : {"boundary, %", "volume, %", "lost", "gained", "Scalar", "rms %"})
    EXPECT_NE(table.out.find(words), std::string::npos) << words;

  const Ran report = run("simplify box.vtu -o again.qtet --json");
  EXPECT_EQ(report.json()["error"]["measure"], "levels");
  EXPECT_EQ(report.json()["error"]["base"], levels[0]["error"]);
  EXPECT_GT(report.json()["seconds"]["measure"], 0);
}

TEST_F(Tool, measuringCanBeLeftOut) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran ran = run("simplify box.vtu -o bare.qtet --measure none --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["error"], nlohmann::json({{"measure", "none"}}));
  EXPECT_FALSE(run("info bare.qtet --json").json()["levels"][0].contains("error"));
  EXPECT_EQ(run("info bare.qtet").out.find("boundary, %"), std::string::npos);
  expectFailure("extract bare.qtet -o level.vtu --boundary-error 0.1", 1, "--measure levels");
  expectFailure("simplify box.vtu -o x.qtet --measure some", 2, "none, levels, all");
  expectFailure("simplify box.vtu -o x.qtet --measure none --max-boundary-error 0.1", 2,
                "leave out --measure none");
}

TEST_F(Tool, boundsEndTheSimplification) {
  makeBoxLog();
  const nlohmann::json whole = run("info box.qtet --json").json()["levels"];
  const nlohmann::json measured = measuredOf(whole);
  const double bound = measured[measured.size() / 2]["error"]["fields"][0]["rms"];
  ASSERT_EQ(
      run("simplify box.vtu -o near.qtet --max-field-error Scalar=" + std::to_string(bound)).code,
      0);
  const nlohmann::json near = run("info near.qtet --json").json()["levels"];
  EXPECT_LT(near.size(), whole.size());
  for (const auto& level : measuredOf(near))
    EXPECT_LE(level["error"]["fields"][0]["rms"], bound + 1e-6);
  EXPECT_EQ(near.back()["tetrahedra"], 3072);
  EXPECT_EQ(run("verify near.qtet --against box.vtu").code, 0);

  ASSERT_EQ(run("simplify box.vtu -o tight.qtet --max-boundary-error 0.001").code, 0);
  for (const auto& level : measuredOf(run("info tight.qtet --json").json()["levels"])) {
    EXPECT_LE(level["error"]["boundary"]["toLevel"]["max"], 0.001);
    EXPECT_LE(level["error"]["boundary"]["toOriginal"]["max"], 0.001);
  }
  EXPECT_EQ(run("verify tight.qtet --against box.vtu").code, 0);
  ASSERT_EQ(run("simplify box.vtu -o all.qtet --max-field-error Scalar=0").code, 0);
  EXPECT_EQ(run("verify all.qtet --against box.vtu").code, 0);

  expectFailure("simplify box.vtu -o x.qtet --max-field-error Warmth=0.1", 1, "Warmth");
  expectFailure("simplify box.vtu -o x.qtet --max-field-error Scalar", 2, "NAME=E");
  expectFailure("simplify box.vtu -o x.qtet --max-field-error Scalar=much", 2, "NAME=E");
  expectFailure("simplify box.vtu -o x.qtet --max-field-error Scalar=-1", 2, "NAME=E");
}

TEST_F(Tool, extractChoosesByError) {
  makeBoxLog();
  const nlohmann::json levels = run("info box.qtet --json").json()["levels"];
  const auto levelOf = [&](const std::string& option) {
    const Ran ran = run("extract box.qtet -o level.vtu " + option);
    EXPECT_EQ(ran.code, 0) << ran.err;
    const std::string marked = "level ";
    return std::stoul(ran.out.substr(ran.out.find(": " + marked) + 2 + marked.size()));
  };
  EXPECT_EQ(levelOf("--error Scalar=100"), 0u);
  EXPECT_EQ(levelOf("--boundary-error 1"), 0u);
  const auto chosen = [&](double bound, const auto& errorOf) {
    for (const nlohmann::json& level : measuredOf(levels))
      if (errorOf(level["error"]) <= bound) return level["level"].get<std::size_t>();
    return levels.size() - 1;
  };
  const auto rms = [](const nlohmann::json& error) {
    return error["fields"][0]["rms"].get<double>();
  };
  const auto distance = [](const nlohmann::json& error) {
    return std::max(error["boundary"]["toLevel"]["max"].get<double>(),
                    error["boundary"]["toOriginal"]["max"].get<double>());
  };
  EXPECT_EQ(levelOf("--error Scalar=0.01"), chosen(0.01, rms));
  EXPECT_EQ(levelOf("--boundary-error 0.01"), chosen(0.01, distance));
  EXPECT_EQ(levelOf("--error Scalar=0"), chosen(0, rms));
  expectFailure("extract box.qtet -o level.vtu --error Warmth=0.1", 1, "it has: Scalar");
  expectFailure("extract box.qtet -o level.vtu --error 0.1", 2, "NAME=E");
  expectFailure("extract box.qtet -o level.vtu --error Scalar=0.1 --level 1", 2, "exactly one");
}

TEST_F(Tool, aFieldsKeyTellsTwoOfOneNameApart) {
  std::ofstream(folder_ / "two.vtk")
      << "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 "
         "0 0 0 1 0 0 0 1 1 1 1\n"
         "CELLS 2 10\n4 0 1 2 3\n4 1 4 2 3\nCELL_TYPES 2\n10 10\nCELL_DATA 2\nSCALARS s float "
         "1\nLOOKUP_TABLE default\n1 2\n"
         "POINT_DATA 5\nSCALARS s float 1\nLOOKUP_TABLE default\n1 2 3 4 5\n";
  ASSERT_EQ(run("simplify two.vtk -o two.qtet --target-ratio 0 --max-field-error cell:s=9 "
                "--max-field-error point:s=9")
                .code,
            0);
  for (const char* key : {"s", "point:s", "cell:s"})
    EXPECT_EQ(run("extract two.qtet -o two.vtu --error " + std::string(key) + "=9").code, 0) << key;
  expectFailure("extract two.qtet -o two.vtu --error cell:t=9", 1, "it has: s, cell:s");
  expectFailure("simplify two.vtk -o x.qtet --max-field-error cell:t=9", 1, "cell:t");
}

TEST_F(Tool, extractDecodesTheFieldsThatAreAskedForAlone) {
  makeBoxLog();
  std::string log = contentOf(folder_ / "box.qtet");
  log.back() = static_cast<char>(log.back() ^ 1);  // in the last block of the field
  std::ofstream(folder_ / "damaged.qtet", std::ios::binary) << log;
  expectFailure("extract damaged.qtet --ratio 1 -o level.vtu", 1, "CRC-32C");
  const Ran ran = run("extract damaged.qtet --ratio 1 --fields none -o level.vtu");
  EXPECT_EQ(ran.code, 0) << ran.err;
}

TEST_F(Tool, verifyProvesTheMesh) {
  makeBoxLog();
  const Ran ran = run("verify box.qtet --against box.vtu --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.json()["meshDigest"].get<std::string>().size(), 64u);
  EXPECT_EQ(ran.json()["digest"], run("info box.qtet --json").json()["digest"]);
  EXPECT_TRUE(ran.json()["against"]["sameMesh"].get<bool>());
  EXPECT_LE(ran.json()["against"]["largestPositionErrorSteps"], 0.5 + 1e-9);
}

TEST_F(Tool, verifyFindsAnotherMesh) {
  makeBoxLog();
  TetMesh other = boxSample();
  other.points[400][0] += 0.001;
  write("moved.vtu", other);
  expectFailure("verify box.qtet --against moved.vtu", 1, "vertex");
  other = boxSample();
  other.fields[0].values[100] += 0.01;
  write("other.vtu", other);
  expectFailure("verify box.qtet --against other.vtu", 1, "vertex");
  other = boxSample();
  other.tetrahedra.pop_back();
  write("fewer.vtu", other);
  expectFailure("verify box.qtet --against fewer.vtu", 1, "3071 tetrahedra");
}

TEST_F(Tool, verifyFindsAFlippedByteAnywhere) {
  makeBoxLog();
  const std::string whole = contentOf(folder_ / "box.qtet");
  for (std::size_t at = 3; at < whole.size(); at += whole.size() / 40) {
    std::string text = whole;
    text[at] ^= 0x10;
    std::ofstream(folder_ / "flipped.qtet", std::ios::binary) << text;
    EXPECT_EQ(run("verify flipped.qtet").code, 1) << "byte " << at;
  }
  std::ofstream(folder_ / "cut.qtet", std::ios::binary) << whole.substr(0, whole.size() - 1);
  EXPECT_EQ(run("verify cut.qtet").code, 1);
}

TEST_F(Tool, fieldsCanBeLeftOut) {
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  ASSERT_EQ(run("simplify box.vtu -o none.qtet --fields none").code, 0);
  EXPECT_TRUE(run("info none.qtet --json").json()["fields"].empty());
  EXPECT_EQ(run("verify none.qtet --against box.vtu").code, 0);
  expectFailure("simplify box.vtu -o x.qtet --fields Speed", 1, "it has: Scalar");
}

/// The box with a label a cell under the name of its point field, and a float.
TetMesh boxWithCellFields() {
  TetMesh mesh = boxSample();
  MeshField labels{"Scalar", 1, "int32", {}, "cell"}, heights{"Height", 1, "float32", {}, "cell"};
  for (const Tetrahedron& t : mesh.tetrahedra) {
    labels.values.push_back(mesh.points[t[0]][0] > 0.5 ? 1000000 : -7);
    heights.values.push_back(static_cast<float>(mesh.points[t[1]][2]));
  }
  mesh.fields.push_back(labels);
  mesh.fields.push_back(heights);
  return mesh;
}

TEST_F(Tool, cellFieldsComeBackCellForCell) {
  const TetMesh mesh = boxWithCellFields();
  write("cells.vtu", mesh);
  const Ran made = run("simplify cells.vtu -o cells.qtet --json");
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* key : {"Scalar", "cell:Scalar", "Height"})
    EXPECT_GT(made.json()["bitsPerTetrahedron"]["fields"][key], 0.0) << key;
  const Ran verified = run("verify cells.qtet --against cells.vtu --json");
  ASSERT_EQ(verified.code, 0) << verified.err;
  EXPECT_EQ(verified.json()["against"]["largestFieldErrorSteps"]["cell:Scalar"], 0.0);
  EXPECT_LE(verified.json()["against"]["largestFieldErrorSteps"]["Height"], 0.5 + 1e-9);
  const nlohmann::json fields = run("info cells.qtet --json").json()["fields"];
  EXPECT_EQ(fields[1]["name"], "Scalar");
  EXPECT_EQ(fields[1]["association"], "cell");

  ASSERT_EQ(run("extract cells.qtet --ratio 1 -o back.vtu").code, 0);
  const Result<ReadMesh> back = readMesh(folder_ / "back.vtu");
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(std::ranges::count(back->mesh.fields[1].values, 1000000),
            std::ranges::count(mesh.fields[1].values, 1000000));
}

TEST_F(Tool, cellFieldsAreChosenByName) {
  write("cells.vtu", boxWithCellFields());
  ASSERT_EQ(run("simplify cells.vtu -o cells.qtet --fields cell:Scalar").code, 0);
  const nlohmann::json fields = run("info cells.qtet --json").json()["fields"];
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0]["association"], "cell");
  EXPECT_EQ(run("verify cells.qtet --against cells.vtu").code, 0);
}

TEST_F(Tool, verifyFindsAnotherCellValue) {
  TetMesh mesh = boxWithCellFields();
  write("cells.vtu", mesh);
  ASSERT_EQ(run("simplify cells.vtu -o cells.qtet").code, 0);
  mesh.fields[1].values[77] = mesh.fields[1].values[77] > 0 ? -7 : 1000000;
  write("other.vtu", mesh);
  expectFailure("verify cells.qtet --against other.vtu", 1,
                "with its field values is not expected");
}

TEST_F(Tool, aDirtyMeshIsCleanedReportedAndVerified) {
  TetMesh mesh = boxSample();
  mesh.tetrahedra.insert(mesh.tetrahedra.begin() + 5, {0, 0, 1, 2});
  mesh.tetrahedra.push_back(
      {mesh.tetrahedra[0][1], mesh.tetrahedra[0][0], mesh.tetrahedra[0][2], mesh.tetrahedra[0][3]});
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  mesh.points.push_back({50, 50, 50});
  mesh.fields[0].values.push_back(1000);
  write("dirty.vtu", mesh);
  const Ran ran = run("simplify dirty.vtu -o dirty.qtet --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const nlohmann::json clean = ran.json()["clean"];
  EXPECT_EQ(clean["repeatedVertexCells"]["first"][0], 5);
  EXPECT_EQ(clean["duplicateCells"]["first"][0], 3073);
  EXPECT_EQ(clean["reorientedCells"]["first"][0], 7);
  EXPECT_EQ(clean["unusedPoints"]["first"][0], 729);
  EXPECT_NE(ran.err.find("qtet: note: "), std::string::npos);
  EXPECT_EQ(run("verify dirty.qtet --against dirty.vtu").code, 0);
}

TEST_F(Tool, aCommaInAFieldsNameIsWrittenWithABackslash) {
  TetMesh mesh = boxSample();
  MeshField odd{"a,b", 1, "float64", std::vector<double>(mesh.points.size(), 1), "point"},
      plain = odd;
  plain.name = "c\\d";
  mesh.fields = {odd, plain};
  write("odd.vtu", mesh);
  ASSERT_EQ(run("simplify odd.vtu -o odd.qtet --fields 'c\\d,a\\,b'").code, 0);
  EXPECT_EQ(run("info odd.qtet --json").json()["fields"].size(), 2u);
  EXPECT_EQ(run("extract odd.qtet --ratio 1 -o a.vtu --fields 'a\\,b'").code, 0);
  const nlohmann::json left = run("check a.vtu --json").json()["fields"];
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NE(left[0].get<std::string>().find("a,b"), std::string::npos);
  expectFailure("extract odd.qtet --ratio 1 -o b.vtu --fields 'a,b'", 1, "no field 'a'");
  expectFailure("extract odd.qtet --ratio 1 -o b.vtu --fields 'a,,b'", 2, "empty name");
}

TEST_F(Tool, aLogWhereAMeshIsWantedIsToldSoAndTheOtherWayRound) {
  makeBoxLog();
  expectFailure("info box.vtu", 1, "'qtet check' tells what a mesh holds");
  expectFailure("simplify box.qtet -o again.qtet", 1, "is a log");
  const Ran checked = run("check box.qtet");
  EXPECT_EQ(checked.code, 1);
  EXPECT_NE(checked.out.find("is a log"), std::string::npos) << checked.out;
}

TEST_F(Tool, aPipeIsNotCalledByATemporaryName) {
  ASSERT_TRUE(writeFileAtomically(folder_ / "other.txt", Bytes{'n', 'o'}));
  ASSERT_EQ(run("sample box -o box.vtu").code, 0);
  const Ran checked = run("check - --format vtu <box.vtu");
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_TRUE(checked.out.starts_with("the standard input: ")) << checked.out;
  expectFailure("convert - --format vtu -o x.msh <other.txt", 1,
                "the standard input is not a VTK XML file");
  EXPECT_EQ(run("check - --format vtu --json <box.vtu").json()["input"], "the standard input");
  const Ran broken = run("info - <box.vtu");
  EXPECT_EQ(broken.code, 1);
  EXPECT_NE(broken.err.find("the standard input: this is not a qtet log"), std::string::npos)
      << broken.err;
}

TEST_F(Tool, columnsStandUnderEachOtherWhateverALetterTakesInBytes) {
  TetMesh mesh = boxSample();
  mesh.fields = {{"Wärmefluß", 1, "float64", {}, "point"}, {"T", 1, "float64", {}, "point"}};
  for (MeshField& field : mesh.fields)
    for (const auto& point : mesh.points) field.values.push_back(point[0]);
  write("named.vtu", mesh);
  ASSERT_EQ(run("simplify named.vtu -o named.qtet").code, 0);
  std::istringstream lines(run("info named.qtet").out);
  std::vector<std::size_t> widths;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("field ") || line.starts_with("Wärme") || line.starts_with("T  "))
      widths.push_back(textWidth(line));
  ASSERT_EQ(widths.size(), 3u);
  EXPECT_EQ(widths, std::vector<std::size_t>(3, widths[0]));
}

TEST_F(Tool, ofASeriesFieldsAreChosenByTheNameOfEveryStep) {
  ASSERT_EQ(run(std::string("simplify '") + testing::kSourceFolder +
                "/tests/simplify/read/meshes/run.pvd' -o run.qtet --time all --fields T")
                .code,
            0);
  EXPECT_EQ(run("info run.qtet --json").json()["fields"].size(), 2u);
  ASSERT_EQ(run("extract run.qtet --ratio 1 -o all.vtu --fields T").code, 0);
  EXPECT_EQ(run("check all.vtu --json").json()["fields"].size(), 2u);
  expectFailure("extract run.qtet --error T=0.1 -o none.vtu", 1, "no field 'T'; it has: T@");
  EXPECT_EQ(run("remove-field run.qtet --fields T -o bare.qtet").code, 0);
  EXPECT_EQ(run("info bare.qtet --json").json()["fields"].size(), 0u);
}

TEST_F(Tool, fieldsComeLaterAndGo) {
  TetMesh mesh = boxSample();
  write("box.vtu", mesh);
  MeshField late{"Late", 1, "float64", {}, "point"}, label{"Label", 1, "uint8", {}, "cell"};
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    late.values.push_back(mesh.points[i][0] + 2 * mesh.points[i][1]);
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
    label.values.push_back(static_cast<double>(i % 3));
  std::ranges::reverse(mesh.tetrahedra);
  mesh.fields = {late, label};
  write("late.vtu", mesh);
  ASSERT_EQ(run("simplify box.vtu -o box.qtet").code, 0);
  const std::string before = contentOf(folder_ / "box.qtet");

  const Ran added = run("add-field box.qtet --from late.vtu -o more.qtet");
  ASSERT_EQ(added.code, 0) << added.err;
  EXPECT_EQ(contentOf(folder_ / "box.qtet"), before);
  EXPECT_EQ(run("verify more.qtet").code, 0);
  const nlohmann::json info = run("info more.qtet --json").json();
  EXPECT_EQ(info["fields"][info["fields"].size() - 2]["name"], "Late");
  EXPECT_EQ(info["levels"].back()["error"]["fields"].size(), info["fields"].size());

  expectFailure("add-field more.qtet --from late.vtu", 1, "--replace");
  EXPECT_EQ(run("add-field more.qtet --from late.vtu --fields Late --replace --field-bits 16").code,
            0);
  EXPECT_EQ(run("info more.qtet --json").json()["fields"].back()["bits"], 16);
  expectFailure("add-field more.qtet --from late.vtu --fields None", 1, "no field 'None'");
  mesh.points[3][2] += 1e-3;
  write("other.vtu", mesh);
  expectFailure("add-field box.qtet --from other.vtu", 1, "point 3 ");

  expectFailure("remove-field more.qtet --fields Nothing", 1, "no field 'Nothing'");
  ASSERT_EQ(run("remove-field more.qtet --fields Late,cell:Label -o less.qtet").code, 0);
  EXPECT_EQ(contentOf(folder_ / "less.qtet"), before);
}

/// Numbers that no quantisation keeps, in an input whose cells are turned both ways.
TetMesh oddMesh() {
  TetMesh mesh = boxSample();
  mesh.fields.clear();
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  const std::vector<double> odd{nan, inf,    -inf,   -0.0,
                                0.0, 5e-324, -1e308, std::bit_cast<double>(0x7FF8000000ABCDEFu)};
  const std::vector<double> single{nan, inf, -inf, -0.0, 0.0, 1.401298464324817e-45, -3e38f, 0.1f};
  MeshField wide{"Wide", 2, "float64", {}, "point"}, narrow{"Narrow", 1, "float32", {}, "cell"},
      whole{"Whole", 1, "int32", {}, "cell"};
  for (std::size_t i = 0; i < 2 * mesh.points.size(); ++i)
    wide.values.push_back(i % 5 == 0 ? odd[i / 5 % odd.size()] : std::sin(static_cast<double>(i)));
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
    narrow.values.push_back(i % 3 == 0 ? single[i / 3 % single.size()]
                                       : static_cast<double>(std::sin(static_cast<float>(i)))),
        whole.values.push_back(static_cast<double>(i) * 7);
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); i += 4)
    std::swap(mesh.tetrahedra[i][0], mesh.tetrahedra[i][1]);
  for (Position& p : mesh.points) p[0] += p[1] / 3;
  for (Position& p : mesh.points)
    if (p[2] == 0) p[2] = -0.0;
  mesh.fields = {wide, narrow, whole};
  return mesh;
}

TEST_F(Tool, theInputItselfComesBack) {
  write("odd.vtu", oddMesh());
  const Ran made = run("simplify odd.vtu -o odd.qtet --keep-order --lossless");
  ASSERT_EQ(made.code, 0) << made.err;
  const Ran proof = run("verify odd.qtet --against odd.vtu --json");
  ASSERT_EQ(proof.code, 0) << proof.err;
  EXPECT_EQ(
      proof.json()["against"]["kept"],
      nlohmann::json::parse(
          R"({"order":true,"positions":true,"fields":{"point:Wide":true,"cell:Narrow":true,"cell:Whole":true}})"));
  const nlohmann::json info = run("info odd.qtet --json").json();
  ASSERT_EQ(
      run("extract odd.qtet --level " + std::to_string(info["levels"].size() - 1) + " -o back.vtu")
          .code,
      0);
  EXPECT_TRUE(contentOf(folder_ / "back.vtu") == contentOf(folder_ / "odd.vtu"));
  ASSERT_EQ(run("extract odd.qtet --level 0 -o base.vtu").code, 0);
  EXPECT_EQ(readMesh(folder_ / "base.vtu")->mesh.tetrahedra.size(),
            info["levels"][0]["tetrahedra"]);
}

TEST_F(Tool, aSignallingNanComesBackBitForBit) {
  TetMesh mesh = boxSample();
  constexpr std::uint32_t kNarrowBits = 0x7FA12345u;
  constexpr std::uint64_t kWideBits = 0x7FF4000000ABCDEFu;
  MeshField narrow{"Narrow", 1, "float32", std::vector<double>(mesh.points.size(), 1), "point"},
      wide{"Wide", 1, "float64", std::vector<double>(mesh.points.size(), 1), "point"};
  narrow.values[3] = widened(std::bit_cast<float>(kNarrowBits));
  wide.values[4] = std::bit_cast<double>(kWideBits);
  mesh.fields = {narrow, wide};
  write("odd.vtu", mesh);
  ASSERT_EQ(run("simplify odd.vtu -o odd.qtet --keep-order --lossless").code, 0);
  ASSERT_EQ(run("verify odd.qtet --against odd.vtu").code, 0);
  ASSERT_EQ(run("extract odd.qtet --ratio 1 -o back.vtu").code, 0);
  for (const char* file : {"odd.vtu", "back.vtu"}) {
    const std::string bytes = contentOf(folder_ / file);
    const auto holds = [&](const auto& bits) {
      return bytes.find(std::string(reinterpret_cast<const char*>(&bits), sizeof bits)) !=
             std::string::npos;
    };
    EXPECT_TRUE(holds(kNarrowBits)) << file;
    EXPECT_TRUE(holds(kWideBits)) << file;
  }
}

TEST_F(Tool, verifySaysWhatItsNumbersCountWithout) {
  TetMesh mesh = oddMesh();
  write("plain.vtu", mesh);
  mesh.points.insert(mesh.points.begin(), {{5, 5, 5}, {6, 6, 6}});
  for (Tetrahedron& cell : mesh.tetrahedra)
    for (VertexId& v : cell) v += 2;
  mesh.tetrahedra.insert(mesh.tetrahedra.begin() + 1, mesh.tetrahedra.front());
  for (MeshField& field : mesh.fields) {
    const std::size_t more = (isCellField(field) ? 1 : 2) * field.components;
    field.values.insert(field.values.begin(), more, 0.0);
  }
  write("dropped.vtu", mesh);
  for (const char* name : {"plain", "dropped"})
    ASSERT_EQ(run(std::string("simplify ") + name + ".vtu -o " + name + ".qtet --keep-order").code,
              0);
  EXPECT_NE(run("verify plain.qtet --against plain.vtu").out.find("are numbered as in the file\n"),
            std::string::npos);
  const Ran said = run("verify dropped.qtet --against dropped.vtu");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(said.out.find("are numbered as in the file\n"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("count without 2 points and 1 cell"), std::string::npos) << said.out;
  const nlohmann::json against =
      run("verify dropped.qtet --against dropped.vtu --json").json()["against"];
  EXPECT_EQ(against["droppedPoints"], 2);
  EXPECT_EQ(against["droppedCells"], 1);
}

TEST_F(Tool, coordinatesOfAMapKeepWhatTheLatticeKeeps) {
  TetMesh mesh = boxSample();
  mesh.pointType = "float64";
  for (Position& p : mesh.points) p = {499'999.5 + 9 * p[0], 4'600'000.25 + 9 * p[1], 100 + p[2]};
  write("map.vtu", mesh);
  ASSERT_EQ(run("simplify map.vtu -o map.qtet").code, 0);
  const std::string info = run("info map.qtet").out;
  EXPECT_NE(info.find("from (499999.5, 4600000.25, 100)"), std::string::npos) << info;
  const double step = run("info map.qtet --json").json()["lattice"]["step"];
  for (const char* ending : {"vtu", "vtk"}) {
    const std::string name = std::string("back.") + ending;
    ASSERT_EQ(run("extract map.qtet --ratio 1 -o " + name).code, 0);
    const Result<ReadMesh> back = readMesh(folder_ / name);
    ASSERT_TRUE(back) << back.error().text();
    EXPECT_EQ(back->mesh.pointType, "float64") << name;
    for (const Position& p : back->mesh.points)
      for (std::size_t k = 0; k < 2; ++k) {
        const double eighths = (p[k] - mesh.points[0][k]) / 9 * 8;
        ASSERT_NEAR(eighths, std::round(eighths), 0.51 * step / 9 * 8) << name;
      }
  }
}

TEST_F(Tool, verifyProvesWhatTheLogKeptAndNoMore) {
  TetMesh mesh = oddMesh();
  write("odd.vtu", mesh);
  ASSERT_EQ(run("simplify odd.vtu -o plain.qtet").code, 0);
  ASSERT_EQ(run("simplify odd.vtu -o order.qtet --keep-order").code, 0);
  ASSERT_EQ(run("simplify odd.vtu -o exact.qtet --lossless").code, 0);
  const auto kept = [&](const std::string& log) {
    return run("verify " + log + " --against odd.vtu --json").json()["against"]["kept"];
  };
  EXPECT_EQ(kept("plain.qtet")["order"], false);
  EXPECT_EQ(kept("order.qtet")["order"], true);
  EXPECT_EQ(kept("order.qtet")["positions"], false);
  EXPECT_EQ(kept("exact.qtet")["order"], false);
  EXPECT_EQ(kept("exact.qtet")["positions"], true);

  TetMesh changed = mesh;
  changed.points[8][0] = std::nextafter(changed.points[8][0], 2.0);
  write("odd.vtu", changed);
  EXPECT_EQ(run("verify order.qtet --against odd.vtu").code, 0);
  expectFailure("verify exact.qtet --against odd.vtu", 1, "point 8 has another coordinate x");
  changed = mesh;
  changed.fields[1].values[0] = -changed.fields[1].values[0];  // NaN of the other sign
  write("odd.vtu", changed);
  EXPECT_EQ(run("verify plain.qtet --against odd.vtu").code, 0);
  expectFailure("verify exact.qtet --against odd.vtu", 1, "Narrow has another value at cell 0");
  changed = mesh;
  std::swap(changed.tetrahedra[10], changed.tetrahedra[11]);
  for (MeshField& field : changed.fields)
    if (isCellField(field)) {
      for (std::size_t c = 0; c < field.components; ++c)
        std::swap(field.values[10 * field.components + c], field.values[11 * field.components + c]);
    }
  write("odd.vtu", changed);
  EXPECT_EQ(run("verify exact.qtet --against odd.vtu").code, 0);
  expectFailure("verify order.qtet --against odd.vtu", 1, "cell 10");
  changed = mesh;
  std::rotate(changed.tetrahedra[12].begin(), changed.tetrahedra[12].begin() + 1,
              changed.tetrahedra[12].begin() + 3);
  write("odd.vtu", changed);
  expectFailure("verify order.qtet --against odd.vtu", 1, "cell 12");
}

}  // namespace
}  // namespace qtet

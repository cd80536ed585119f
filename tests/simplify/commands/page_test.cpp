// `qtet page`: one HTML file of the viewer and a log.
#include "simplify/publish/single_page.h"

#include <cmath>

#include "simplify/samples/samples.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

class Page : public Tool {
 protected:
  void SetUp() override {
    makeBoxLog();
    fs::create_directories(folder_ / "viewer/assets");
    put("viewer/index.html",
        "<!doctype html><head><meta name=\"a\"><link rel=\"stylesheet\" href=\"./assets/a.css\">"
        "<script type=\"module\" src=\"./assets/app-1a2b.js\"></script></head><body>"
        "<!--mesh-poster--><!--mesh-name--></body>");
    put("viewer/assets/app-1a2b.js", std::string(2000, 'a') + "()");
    put("viewer/assets/a.css", "a{b:c}");
    put("viewer/single_page.js", "first()");
    put("viewer/assets/mesh_drop-1a2b.js", "drop()");
    put("viewer/viewer.json",
        R"({"policy": "default-src 'none'", "page": {"assets/app-1a2b.js": "text/javascript",)"
        R"( "assets/a.css": "text/css"}, "simplifier": ["assets/mesh_drop-1a2b.js"]})");
  }
  Ran page(const std::string& words) { return run("page --viewer viewer " + words); }
};

TEST_F(Page, holdsTheViewerTheLogAndItsPoster) {
  ASSERT_EQ(page("box.qtet -o box.html").code, 0);
  const std::string html = contentOf(folder_ / "box.html");
  for (const char* part :
       {"default-src 'none'", "<style>a{b:c}</style>",
        "<script data-parts=\"3\" data-entry=\"app-1a2b.js\">first()</script>",
        "data-name=\"assets/app-1a2b.js\"", "data-name=\"index.json\"", "data-name=\"box.qtet\"",
        "src=\"data:image/webp;base64,UklGR", "\">box"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  for (const char* other : {"mesh_drop", "<link", "href=", "http:", "https:", " src=\"./"})
    EXPECT_EQ(html.find(other), std::string::npos) << other;
  ASSERT_EQ(page("box.qtet -o again.html").code, 0);
  EXPECT_EQ(contentOf(folder_ / "again.html"), html);
  ASSERT_EQ(page("box.vtu -o mesh.html --fields none --view 'clip=x:0.5&map=\"'").code, 0);
  EXPECT_NE(contentOf(folder_ / "mesh.html").find("content=\"clip=x:0.5&amp;map=&quot;\""),
            std::string::npos);
}

TEST_F(Page, cutsTheLogToTheBytesThatAreAllowed) {
  const std::string tooSmall = page("box.qtet -o box.html --max-bytes 1").err;
  const std::size_t at = tooSmall.find("has ");
  ASSERT_NE(at, std::string::npos) << tooSmall;
  const auto least = std::stoull(tooSmall.substr(at + 4));
  EXPECT_EQ(page("box.qtet -o box.html --max-bytes " + std::to_string(least - 4)).code, 1);
  EXPECT_FALSE(fs::exists(folder_ / "box.html"));
  for (const std::uint64_t most : {least, least + 1}) {
    const Ran ran = page("box.qtet -o box.html --max-bytes " + std::to_string(most));
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find("of 3,072 tetrahedra: boundary within"), std::string::npos) << ran.out;
    EXPECT_LE(fs::file_size(folder_ / "box.html"), most);
  }
  EXPECT_EQ(page("box.qtet -o box.html --max-bytes 5M").out.find("tetrahedra"), std::string::npos);
}

/// Every second one of five instants stays, then the ends.
TEST_F(Page, instantsGoBeforeLevels) {
  TetMesh mesh = boxSample();
  mesh.fields.clear();
  for (int instant = 0; instant < 5; ++instant) {
    MeshField& field = mesh.fields.emplace_back(
        MeshField{"T@" + std::to_string(instant), 9, "float32", {}, "point"});
    for (std::size_t i = 0; i < 9 * mesh.points.size(); ++i)
      field.values.push_back(std::sin(static_cast<double>(i) * (7 + 0.37 * instant)));
  }
  write("series.vtu", mesh);
  ASSERT_EQ(run("simplify series.vtu -o series.qtet --measure none").code, 0);
  ASSERT_EQ(page("series.qtet -o all.html").code, 0);
  std::uint64_t most = fs::file_size(folder_ / "all.html");
  for (const char* held : {"3 of 5 instants", "2 of 5 instants"}) {
    const Ran ran = page("series.qtet -o some.html --max-bytes " + std::to_string(most - 1));
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.out.find(held), std::string::npos) << ran.out;
    EXPECT_EQ(ran.out.find("tetrahedra"), std::string::npos) << ran.out;
    most = fs::file_size(folder_ / "some.html");
  }
  const Ran ran = page("series.qtet -o some.html --max-bytes " + std::to_string(most - 1));
  EXPECT_NE(ran.out.find("2 of 5 instants; it holds"), std::string::npos) << ran.out << ran.err;
}

TEST_F(Page, whatItCannotTakeIsToldBeforeAnythingIsWritten) {
  for (const char* words :
       {"box.qtet -o box.htm", "box.qtet -o box.html --max-bytes 5x",
        "box.qtet -o box.html --max-bytes 0", "box.qtet -o box.html --max-bytes -1", "box.qtet"})
    EXPECT_EQ(page(words).code, 2) << words;
  put("broken.qtet", "no log");
  for (const char* words : {"nothing.vtu -o box.html", "broken.qtet -o box.html"})
    EXPECT_EQ(page(words).code, 1) << words;
  for (const char* list : {"[\"assets/a.css\"]", "{", R"({"policy": 1, "page": {}})",
                           R"({"policy": "", "page": {"a.css": 1}})"}) {
    put("viewer/viewer.json", list);
    const Ran old = page("box.qtet -o box.html");
    EXPECT_NE(old.err.find("viewer.json is of another version"), std::string::npos) << list;
  }
  fs::remove(folder_ / "viewer/single_page.js");
  const Ran old = page("box.qtet -o box.html");
  EXPECT_NE(old.err.find("single_page.js; give that of this version"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "box.html"));
}

}  // namespace
}  // namespace qtet

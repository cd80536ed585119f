// `qtet publish`: a folder that a web server can serve as it stands.
#include "simplify/publish/publish_site.h"

#include <brotli/decode.h>
#include <libdeflate.h>

#include <map>

#include "simplify/publish/site_folder.h"
#include "tests/simplify/commands/tool_run.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string unzipped(const std::string& gzip, std::size_t size) {
  std::string out(size + 1, '\0');
  std::size_t written = 0;
  auto* decompressor = libdeflate_alloc_decompressor();
  const auto done = libdeflate_gzip_decompress(decompressor, gzip.data(), gzip.size(), out.data(),
                                               out.size(), &written);
  libdeflate_free_decompressor(decompressor);
  EXPECT_EQ(done, LIBDEFLATE_SUCCESS);
  return out.substr(0, written);
}

std::string unbrotlied(const std::string& brotli, std::size_t size) {
  std::string out(size + 1, '\0');
  std::size_t written = out.size();
  EXPECT_EQ(
      BrotliDecoderDecompress(brotli.size(), reinterpret_cast<const std::uint8_t*>(brotli.data()),
                              &written, reinterpret_cast<std::uint8_t*>(out.data())),
      BROTLI_DECODER_RESULT_SUCCESS);
  return out.substr(0, written);
}

class Publish : public Tool {
 protected:
  /// box.qtet, "two words.qtet", and a viewer of three files, one of them compressed already.
  void SetUp() override {
    makeBoxLog();
    fs::copy(folder_ / "box.qtet", folder_ / "two words.qtet");
    fs::create_directories(folder_ / "viewer/assets");
    put("viewer/index.html",
        "<!doctype "
        "html><head><title>v</title></head><body><!--mesh-poster--><!--mesh-name--></body>");
    put("viewer/assets/app-1a2b.js", std::string(2000, 'a') + "()");
    put("viewer/assets/app-1a2b.js.gz", "old");
    put("viewer/assets/tiny-3c.css", "a{}");
  }
  Ran publish(const std::string& words) { return run("publish --viewer viewer " + words); }
  /// Names and contents.
  std::map<std::string, std::string> files(const std::string& site) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / site))
      if (entry.is_regular_file())
        out[entry.path().lexically_relative(folder_ / site).generic_string()] =
            contentOf(entry.path());
    return out;
  }
  /// The number of hidden folders that were left beside the site.
  std::size_t leftovers() {
    std::size_t out = 0;
    for (const auto& entry : fs::directory_iterator(folder_))
      out += entry.path().filename().native().starts_with('.');
    return out;
  }
};

TEST_F(Publish, theFolderHoldsTheViewerTheLogsAndTheirList) {
  const Ran ran = publish("site box.qtet 'two words.qtet' --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto site = files("site");
  EXPECT_EQ(ran.json()["files"], site.size());
  EXPECT_EQ(ran.json()["meshes"][1]["name"], "two words");
  EXPECT_EQ(site.at("box.qtet"), contentOf(folder_ / "box.qtet"));
  EXPECT_EQ(site.at("assets/app-1a2b.js"), contentOf(folder_ / "viewer/assets/app-1a2b.js"));
  EXPECT_NE(site.at("README.txt").find("gzip_static on;"), std::string::npos);
  EXPECT_TRUE(site.contains(".nojekyll"));

  const Json list = Json::parse(site.at("index.json")), info = run("info box.qtet --json").json();
  ASSERT_EQ(list["meshes"].size(), 2u);
  const Json& box = list["meshes"][0];
  EXPECT_EQ(box["id"], "box");
  EXPECT_EQ(box["digest"], info["digest"]);
  EXPECT_EQ(box["bytes"], info["bytes"]);
  EXPECT_EQ(box["tetrahedra"], 3072);
  EXPECT_EQ(box["fields"], Json::array({"Scalar"}));
  EXPECT_EQ(list["meshes"][1]["links"]["log"], "two%20words.qtet");
  EXPECT_EQ(list["meshes"][1]["links"]["poster"], "two%20words.webp");
  EXPECT_GT(box["firstBytes"], 0);
  EXPECT_LE(box["firstBytes"], info["levels"][0]["cumulativeBytes"]) << "the first picture's";
  for (const char* poster : {"box.webp", "two words.webp"}) {
    EXPECT_EQ(site.at(poster).substr(0, 4) + site.at(poster).substr(8, 4), "RIFFWEBP");
    EXPECT_LE(site.at(poster).size(), 6000u);
  }
  for (const auto& [name, content] : site)
    EXPECT_NE(std::ranges::find(list["files"], Json(name)), list["files"].end()) << name;
  EXPECT_NE(site.at("index.html").find("<meta name=\"qtet-src\" content=\"index.json\">"),
            std::string::npos);
  EXPECT_NE(site.at("index.html").find("data-mesh=\"box\" src=\"box.webp\">box"),
            std::string::npos);
  EXPECT_EQ(leftovers(), 0u);
  EXPECT_EQ(fs::status(folder_ / "site").permissions(),
            fs::status(folder_ / "viewer").permissions())
      << "a web server is somebody else";
}

TEST_F(Publish, whatCompressesIsThereInBothCodings) {
  ASSERT_EQ(publish("site box.qtet").code, 0);
  const auto site = files("site");
  int compressed = 0;
  for (const auto& [name, content] : site) {
    if (!site.contains(name + ".gz")) continue;
    ++compressed;
    EXPECT_EQ(unzipped(site.at(name + ".gz"), content.size()), content) << name;
    EXPECT_EQ(unbrotlied(site.at(name + ".br"), content.size()), content) << name;
    EXPECT_LT(site.at(name + ".br").size(), content.size()) << name;
  }
  EXPECT_GE(compressed, 2) << "the script and the list";
  for (const char* none : {"assets/tiny-3c.css.gz", "box.qtet.gz", "assets/app-1a2b.js.gz.gz"})
    EXPECT_FALSE(site.contains(none)) << none;
}

TEST_F(Publish, theSameInputsGiveTheSameBytes) {
  ASSERT_EQ(publish("one box.qtet").code, 0);
  ASSERT_EQ(publish("two box.qtet").code, 0);
  EXPECT_EQ(files("one"), files("two"));
}

TEST_F(Publish, anEarlierPublicationIsReplacedAsAWhole) {
  ASSERT_EQ(publish("site box.qtet").code, 0);
  fs::create_symlink("site", folder_ / "current");
  ASSERT_EQ(publish("current/ 'two words.qtet'").code, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "current"));
  EXPECT_FALSE(fs::exists(folder_ / "site/box.qtet"));
  EXPECT_TRUE(fs::exists(folder_ / "site/two words.qtet"));
  EXPECT_EQ(leftovers(), 0u);
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(publish("empty box.qtet").code, 0);
}

TEST_F(Publish, aFolderOfSomebodyElsesIsLeftAlone) {
  fs::create_directory(folder_ / "logs");
  put("logs/mine.qtet", "mine");
  expectFailure("publish --viewer viewer logs box.qtet", 1, "holds mine.qtet");
  EXPECT_EQ(contentOf(folder_ / "logs/mine.qtet"), "mine");
  ASSERT_EQ(publish("site box.qtet").code, 0);
  put("site/CNAME", "meshes.example.org");
  expectFailure("publish --viewer viewer site box.qtet", 1, "holds CNAME");
  EXPECT_TRUE(fs::exists(folder_ / "site/CNAME"));
  put("file", "");
  expectFailure("publish --viewer viewer file box.qtet", 1, "is no folder");
  expectFailure("publish --viewer viewer nowhere/site box.qtet", 1, "nowhere");
  EXPECT_EQ(leftovers(), 0u);
}

TEST_F(Publish, whatCannotBePublishedLeavesNothing) {
  std::string damaged = contentOf(folder_ / "box.qtet");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  put("damaged.qtet", damaged);
  expectFailure("publish --viewer viewer site box.qtet damaged.qtet", 1, "damaged.qtet");
  expectFailure("publish --viewer viewer site no.qtet", 1, "no.qtet");
  fs::create_directory(folder_ / "other");
  fs::copy(folder_ / "box.qtet", folder_ / "other/box.qtet");
  expectFailure("publish --viewer viewer site box.qtet other/box.qtet", 1, "two logs are called");
  expectFailure("publish --viewer other site box.qtet", 1, "holds no viewer");
  expectFailure("publish --viewer viewer site box.vtu", 2, "is no log");
  expectFailure("publish --viewer viewer site", 2, "LOG is missing");
  EXPECT_FALSE(fs::exists(folder_ / "site"));
  EXPECT_EQ(leftovers(), 0u);
}

}  // namespace
}  // namespace qtet

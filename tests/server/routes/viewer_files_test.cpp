#include "server/routes/viewer_files.h"

#include <gtest/gtest.h>

#include "server/http/http_resource.h"
#include "server/routes/viewer_limits.h"
#include "server/wire/content_coding.h"
#include "tests/server/store/synthetic_log.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

TEST(ViewerFiles, areFoundByTheirRelativePath) {
  test::TempFolder folder;
  folder.write("index.html", "page");
  folder.write("assets/a.wasm", "code");
  folder.write("sub/index.html", "other");
  const auto files = ViewerFiles::load(folder.path());
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_NE(files->find(""), nullptr);
  EXPECT_EQ(files->find("")->type, "text/html; charset=utf-8");
  EXPECT_FALSE(files->find("")->immutable);
  ASSERT_NE(files->find("assets/a.wasm"), nullptr);
  EXPECT_EQ(files->find("assets/a.wasm")->type, "application/wasm");
  EXPECT_TRUE(files->find("assets/a.wasm")->immutable);
  EXPECT_NE(files->find("sub/"), nullptr);
  EXPECT_EQ(files->find("sub"), nullptr);
  EXPECT_EQ(files->find("assets/b.wasm"), nullptr);
}

TEST(ViewerFiles, hiddenOnesAndLinksThatLeadOutAreLeftOut) {
  test::TempFolder outside;
  outside.write("secret.txt", "secret");
  test::TempFolder folder;
  folder.write("index.html", "page");
  folder.write(".env", "secret");
  folder.write(".git/config", "secret");
  folder.write("assets/.hidden", "secret");
  fs::create_symlink(outside.path() / "secret.txt", folder.path() / "leak.txt");
  fs::create_directory_symlink(outside.path(), folder.path() / "leak");
  fs::create_symlink(folder.path() / "index.html", folder.path() / "alias.html");
  const auto files = ViewerFiles::load(folder.path());
  ASSERT_TRUE(files) << files.error().message;
  for (const char* path :
       {".env", ".git/config", "assets/.hidden", "leak.txt", "leak/secret.txt", "../secret.txt"})
    EXPECT_EQ(files->find(path), nullptr) << path;
  EXPECT_NE(files->find("alias.html"), nullptr);
}

TEST(ViewerFiles, aFolderWithASiblingOfTheSameBeginningIsNotLeftThroughALink) {
  test::TempFolder parent;
  parent.write("viewer/index.html", "page");
  parent.write("viewer-private/key.txt", "secret");
  fs::create_symlink(parent.path() / "viewer-private/key.txt", parent.path() / "viewer/key.txt");
  const auto files = ViewerFiles::load(parent.path() / "viewer");
  ASSERT_TRUE(files);
  EXPECT_EQ(files->find("key.txt"), nullptr);
}

TEST(ViewerFiles, whatIsNoViewerIsRefused) {
  test::TempFolder folder;
  folder.write("readme.txt", "x");
  EXPECT_EQ(ViewerFiles::load(folder.path()).error().code, ErrorCode::kIo);
  EXPECT_EQ(ViewerFiles::load(folder.path() / "nothing").error().code, ErrorCode::kIo);
  folder.write("index.html", "x");
  EXPECT_TRUE(ViewerFiles::load(folder.path()));
  for (std::size_t i = 0; i + 2 < limits::kMaxViewerFiles; ++i)
    folder.write("f" + std::to_string(i), "x");
  EXPECT_TRUE(ViewerFiles::load(folder.path()));
  folder.write("one-more", "x");
  EXPECT_EQ(ViewerFiles::load(folder.path()).error().code, ErrorCode::kLimitExceeded);
}

class CompressedViewer : public ::testing::Test {
 protected:
  static Bytes bytesOf(const std::string& text) { return {text.begin(), text.end()}; }
  static Bytes coded(const std::string& text, ContentCoding coding) {
    return encoded(bytesOf(text), coding);
  }
  /// Loads the viewer with these two beside its page.
  ViewerFiles loaded(const Bytes& gzip, const Bytes& zstd) {
    folder_.write("index.html", page_);
    folder_.write("index.html.gz", gzip);
    folder_.write("index.html.zst", zstd);
    return std::move(ViewerFiles::load(folder_.path()).value());
  }
  static Bytes copyOf(ByteView view) { return {view.begin(), view.end()}; }

  test::TempFolder folder_;
  const std::string page_ = std::string(5000, 'p');
  const Bytes gzip_ = coded(page_, ContentCoding::kGzip),
              zstd_ = coded(page_, ContentCoding::kZstd);
};

TEST_F(CompressedViewer, whatTheBuildCompressedIsTakenAtOnce) {
  const ViewerFiles files = loaded(gzip_, zstd_);
  const Variants variants = files.variantsOf(*files.find(""));
  EXPECT_EQ(copyOf(variants.gzip), gzip_);
  EXPECT_EQ(copyOf(variants.zstd), zstd_);
  EXPECT_EQ(files.find("index.html.gz"), nullptr);
  EXPECT_EQ(files.find("index.html.zst"), nullptr);
}

TEST_F(CompressedViewer, whatIsOfAnotherFileIsNotServed) {
  std::string other = page_;
  other.back() = 'q';
  Bytes gzipAndMore = gzip_;
  gzipAndMore.push_back(0);
  const Bytes cut(zstd_.begin(), zstd_.end() - 1);
  for (const auto& [gzip, zstd] :
       {std::pair(coded(other, ContentCoding::kGzip), coded(other, ContentCoding::kZstd)),
        std::pair(coded(page_ + "p", ContentCoding::kGzip),
                  coded(page_ + "p", ContentCoding::kZstd)),
        std::pair(gzipAndMore, cut), std::pair(bytesOf(page_), Bytes())}) {
    const ViewerFiles files = loaded(gzip, zstd);
    const Variants variants = files.variantsOf(*files.find(""));
    EXPECT_TRUE(variants.gzip.empty() && variants.zstd.empty());
    EXPECT_EQ(files.find("index.html.gz"), nullptr);
    EXPECT_EQ(files.find("index.html.zst"), nullptr);
  }
}

TEST_F(CompressedViewer, whatIsMissingIsCompressedLater) {
  ViewerFiles files = loaded(Bytes(), zstd_);
  EXPECT_TRUE(files.variantsOf(*files.find("")).gzip.empty());
  files.compressRest({});
  const Variants variants = files.variantsOf(*files.find(""));
  EXPECT_EQ(copyOf(variants.gzip), gzip_);
  EXPECT_EQ(copyOf(variants.zstd), zstd_) << "that of the build";
}

TEST(ViewerFiles, anEmptyFileIsAFile) {
  test::TempFolder folder;
  folder.write("index.html", "");
  const auto files = ViewerFiles::load(folder.path());
  ASSERT_TRUE(files);
  EXPECT_TRUE(files->find("")->bytes.empty());
}

}  // namespace
}  // namespace qtet

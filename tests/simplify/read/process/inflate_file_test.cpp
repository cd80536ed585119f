// Compressed files: what inflates to too much, or not at all.
#include "simplify/read/process/inflate_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <string>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

fs::path gzipOf(const std::string& text) {
  const fs::path path = testing::freshFolder("inflate") / "mesh.vtu.gz";
  gzFile file = ::gzopen(path.c_str(), "wb9");
  EXPECT_EQ(::gzwrite(file, text.data(), static_cast<unsigned>(text.size())),
            static_cast<int>(text.size()));
  ::gzclose(file);
  return path;
}

TEST(InflateFile, isAFileUpToTheLimitAndNoFurther) {
  const fs::path path = gzipOf(std::string(5'000'000, 'x'));
  EXPECT_LT(fs::file_size(path), 10'000u);
  for (const std::uint64_t most : {4'999'999u, 5'000'000u, 5'000'001u}) {
    fs::path file;
    const Status done = inflated(
        path,
        [&](const fs::path& plain) -> Status {
          file = plain;
          EXPECT_EQ(plain.filename(), "mesh.vtu");
          EXPECT_EQ(fs::file_size(plain), 5'000'000u);
          return {};
        },
        most);
    ASSERT_EQ(done.has_value(), most >= 5'000'000u);
    if (done)
      EXPECT_FALSE(fs::exists(file)) << "it goes when it has been used";
    else
      EXPECT_EQ(done.error().code, ErrorCode::kLimitExceeded);
  }
  EXPECT_GT(maxInflatedBytes(), std::uint64_t{1} << 20);
}

TEST(InflateFile, everyTruncationIsAnErrorAndDamageIsRefused) {
  std::string text;
  for (int i = 0; i < 60; ++i) text += std::to_string(i * i);
  const fs::path path = gzipOf(text);
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const auto none = [](const fs::path&) -> Status { return {}; };
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
    EXPECT_FALSE(inflated(path, none)) << length;
  }
  std::string damaged = whole;
  damaged[damaged.size() - 6] ^= 1;  // in the checksum
  std::ofstream(path, std::ios::binary | std::ios::trunc) << damaged;
  const Status done = inflated(path, none);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kBadInput);
}

TEST(InflateFile, theBeginningIsThatOfTheText) {
  const fs::path path = gzipOf("one two"), plain = path.parent_path() / "plain";
  std::ofstream(plain) << "one two";
  for (const fs::path& file : {path, plain}) {
    EXPECT_EQ(beginningOf(file, 3), "one");
    EXPECT_EQ(beginningOf(file, 7), "one two");
    EXPECT_EQ(beginningOf(file, 8), "one two");
  }
  EXPECT_FALSE(beginningOf(path.parent_path() / "none", 3));
  std::ofstream(path, std::ios::binary | std::ios::in | std::ios::ate).seekp(10) << "\xff\xff\xff";
  EXPECT_FALSE(beginningOf(path, 3));
}

TEST(InflateFile, anErrorNamesTheCompressedFile) {
  const fs::path path = gzipOf("text");
  const Status done = inflated(path, [](const fs::path& plain) -> Status {
    return fail(ErrorCode::kBadInput, plain.string() + " is wrong");
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, path.string() + " is wrong");
}

}  // namespace
}  // namespace qtet

#include "server/wire/request_target.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

using Segments = std::vector<std::string>;

TEST(RequestTarget, isSplitBeforeItIsDecoded) {
  EXPECT_EQ(parseTarget("/")->segments, (Segments{""}));
  EXPECT_EQ(parseTarget("/v1/meshes")->segments, (Segments{"v1", "meshes"}));
  EXPECT_EQ(parseTarget("/v1/meshes/")->segments, (Segments{"v1", "meshes", ""}));
  EXPECT_EQ(parseTarget("/a%2Fb/c%20d")->segments, (Segments{"a/b", "c d"}));
  EXPECT_EQ(parseTarget("/%252e")->segments, (Segments{"%2e"}));
  EXPECT_EQ(parseTarget("//a")->segments, (Segments{"", "a"}));
  EXPECT_EQ(parseTarget("http://host:80/a/b")->segments, (Segments{"a", "b"}));
  EXPECT_EQ(parseTarget("http://host")->segments, (Segments{""}));
}

TEST(RequestTarget, whatIsNoPathIsRefused) {
  for (const std::string& target :
       {std::string(""), std::string("a"), std::string("*"), std::string("/%"), std::string("/%2"),
        std::string("/%zz"), std::string("/%00"), std::string("/a b"), std::string("/a\x01"),
        std::string("/\xC3\xA9"), std::string("/a#b"), std::string("file:///etc/passwd"),
        std::string("/\x7F")})
    EXPECT_FALSE(parseTarget(target)) << target;
}

TEST(RequestTarget, aParameterIsFoundByItsWholeName) {
  const auto target = parseTarget("/log?digests=1&digest=a%20b&digest=c&flag");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->parameter("digest"), "a b");
  EXPECT_EQ(target->parameter("flag"), "");
  EXPECT_EQ(target->parameter("dig"), std::nullopt);
  EXPECT_EQ(parseTarget("/log")->parameter("digest"), std::nullopt);
  EXPECT_EQ(parseTarget("/log?")->parameter("digest"), std::nullopt);
}

TEST(RequestTarget, aPlusIsASpaceInTheQueryAlone) {
  const auto target = parseTarget("/a+b?field=wall+shear%2B&a+b=1");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->segments, (Segments{"a+b"}));
  EXPECT_EQ(target->parameter("field"), "wall shear+");
  EXPECT_EQ(target->parameter("a b"), "1");
}

TEST(RequestTarget, aParameterGivenTwiceIsNamed) {
  EXPECT_EQ(parseTarget("/?a=1&b=2&a=1")->repeatedParameter(), "a");
  EXPECT_EQ(parseTarget("/?a&%61=1")->repeatedParameter(), "a");
  for (const char* once : {"/", "/?", "/?a=1&b=1", "/?a=1&&&", "/?a=b&b=a", "/?=1&=2"})
    EXPECT_EQ(parseTarget(once)->repeatedParameter(), std::nullopt) << once;
}

TEST(RequestTarget, everyByteSurvivesEncodingButNul) {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  const auto target = parseTarget("/" + percentEncode(all));
  ASSERT_TRUE(target);
  EXPECT_EQ(target->segments, (Segments{all}));
}

}  // namespace
}  // namespace qtet

// Paths by which elements of an XML document name one another.
#include "simplify/read/parts/xml_tree.h"

#include <gtest/gtest.h>

#include "tests/simplify/mesh/tet_meshes.h"

namespace qtet {
namespace {

std::unique_ptr<XmlElement> treeOf(const std::string& text) {
  Result<std::unique_ptr<XmlElement>> root = readXml(testing::fileWith("tree.xml", text));
  EXPECT_TRUE(root) << root.error().message;
  return root ? std::move(*root) : nullptr;
}

TEST(XmlTree, aPathMeansTheFirstElementThatFits) {
  const auto root =
      treeOf("<r><a n='1'/><b><a n='2' k='x'/><a n='3'/></b><b><a n='4' k='x'/></b></r>");
  ASSERT_TRUE(root);
  const auto at = [&](const std::string& path) {
    const XmlElement* const found = firstAt(*root, path);
    return found ? std::string(found->attribute("n")) : "none";
  };
  EXPECT_EQ(at("/r/a"), "1");
  EXPECT_EQ(at("//a"), "1");
  EXPECT_EQ(at("/r/b/a[2]"), "3");
  EXPECT_EQ(at("//b[2]//a[@k='x']"), "4");
  EXPECT_EQ(at("//a[@k='x']"), "2");
  EXPECT_EQ(at("/r/c/a"), "none");
  EXPECT_EQ(at("a"), "none");
}

TEST(XmlTree, elementsWithinOneAnotherAreMetOnceAPart) {
  std::string opened, closed, path;
  for (int i = 0; i < 60; ++i) opened += "<a>", closed += "</a>";
  for (int i = 0; i < 30; ++i) path += "//a";
  const auto root = treeOf("<r>" + opened + "<b n='here'/>" + closed + "</r>");
  ASSERT_TRUE(root);
  const XmlElement* const found = firstAt(*root, path + "/b");
  ASSERT_NE(found, nullptr) << "and not after 10^17 ways to it";
  EXPECT_EQ(found->attribute("n"), "here");
  EXPECT_EQ(firstAt(*root, path + path + "//a/b"), nullptr) << "there are 60";
}

}  // namespace
}  // namespace qtet

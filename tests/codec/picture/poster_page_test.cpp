#include "codec/picture/poster_page.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

TEST(PosterPage, theMarksGiveWayToNameAndPoster) {
  EXPECT_EQ(
      pageOfMesh("<main><!--mesh-poster--><h1><!--mesh-name--></h1></main>", "fin", "fin.webp"),
      "<main><img slot=\"poster\" alt=\"\" fetchpriority=\"high\" data-mesh=\"fin\" "
      "src=\"fin.webp\"><h1>fin</h1></main>");
  EXPECT_EQ(pageOfMesh("<main></main>", "fin", "fin.webp"), "<main></main>");
}

TEST(PosterPage, aNameIsNeverMarkup) {
  const std::string page = pageOfMesh("<!--mesh-poster--><!--mesh-name-->",
                                      "<script>\"'&<!--mesh-name-->", "a.webp\" onload=\"x");
  EXPECT_EQ(page.find("<script"), page.npos);
  EXPECT_EQ(page.find("\" onload"), page.npos);
  EXPECT_NE(page.find("&lt;script&gt;&quot;&#39;&amp;&lt;!--mesh-name--&gt;"), page.npos);
}

}  // namespace
}  // namespace qtet

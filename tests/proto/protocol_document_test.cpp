#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/proto/document_examples.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

using test::faultsOfExamples;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Both pages, one after the other.
std::string protocolDocument() {
  std::string both;
  for (const char* page : {"/proto/PROTOCOL.md", "/proto/STREAM.md", "/proto/SESSION.md"}) {
    std::ifstream file(std::string(testing::kSourceFolder) + page);
    both.append(std::istreambuf_iterator<char>(file), {});
  }
  return both;
}

/// The document with `from`, which stands in it, made `to` where it stands first.
std::string changed(const std::string& from, const std::string& to) {
  std::string document = protocolDocument();
  const std::size_t at = document.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? document : document.replace(at, from.size(), to);
}

TEST(ProtocolDocument, theProtocolDocumentsExamplesAreUnderstood) {
  EXPECT_THAT(faultsOfExamples(protocolDocument()), IsEmpty());
}

TEST(ProtocolDocument, aBlockOfNoKindIsAFault) {
  EXPECT_THAT(faultsOfExamples(changed("```json client", "```json")),
              AllOf(Contains(HasSubstr("what is a block of 'json'?")),
                    Contains(HasSubstr("is judged by nobody"))));
  EXPECT_THAT(faultsOfExamples(changed("```text transcript", "```text")),
              Contains(HasSubstr("JSON in a block of 'text'")));
}

TEST(ProtocolDocument, aKindWithoutAnExampleIsAFault) {
  for (const char* kind :
       {"json client", "json server", "json have", "json target", "json time", "json list",
        "json mesh", "json manifest", "json series", "text transcript"})
    EXPECT_THAT(faultsOfExamples(changed("```" + std::string(kind), "```elsewhere")),
                Contains(HasSubstr("no example is '" + std::string(kind) + "'")));
}

TEST(ProtocolDocument, anExampleThatItsParserRefusesIsAFault) {
  for (const auto& [from, to] :
       {std::pair{R"("bytes": 12345)", R"("bytes": -1)"},
        std::pair{R"({"type": "done", "stream": 1})", R"({"type": "done"})"},
        std::pair{R"({"Density": 3, "Velocity": 7})", R"({"Density": 8})"},
        std::pair{R"({"level": 3})", R"({"level": "3"})"}, std::pair{R"("vertices": 37825,)", ""},
        std::pair{R"("headBytes": 2037)", R"("headBytes": 3)"},
        std::pair{R"("source": "comb.vtu",)", ""},
        std::pair{R"("tetrahedron": 4711)", R"("tetrahedron": -1)"},
        std::pair{"< frame 1 0 head 2669", "< frame 1 0 head"},
        std::pair{R"("credit":60000})", R"("credit":-1})"}})
    EXPECT_THAT(faultsOfExamples(changed(from, to)), Not(IsEmpty())) << to;
}

/// A parser ignores what it does not know, so an example might name a member wrongly for ever.
TEST(ProtocolDocument, aMemberThatNoParserKnowsIsAFault) {
  for (const auto& [from, to] :
       {std::pair{R"("target": {"level": 40})", R"("goal": {"level": 40})"},
        std::pair{R"("planned": 420000})", R"("planned": 420000, "views": 1})"},
        std::pair{R"("cumulativeBytes": 11016,)", R"("cumulativeBytes": 11016, "sum": 1,)"}})
    EXPECT_THAT(faultsOfExamples(changed(from, to)), Not(IsEmpty())) << to;
}

}  // namespace
}  // namespace qtet

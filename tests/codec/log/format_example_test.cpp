// The worked example of EXAMPLE.md, read from the page itself: its bytes are a log, and hold what
// the page says.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "codec/log/log_index.h"
#include "codec/log/value_block.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "tests/support/paths/test_paths.h"

namespace qtet {
namespace {

std::string section(const std::string& title) {
  std::ifstream file(testing::kSourceFolder + std::string("/codec/EXAMPLE.md"));
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  const std::size_t first = page.find("## " + title);
  EXPECT_NE(first, std::string::npos);
  return page.substr(std::min(first, page.size()), page.find("\n## ", first) - first);
}

Bytes dumped(const std::string& text) {
  Bytes bytes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, std::regex("([0-9a-f]{4})  ((?:[0-9a-f]{2} ?)+)"))) continue;
    EXPECT_EQ(std::stoul(match[1], nullptr, 16), bytes.size()) << line;
    std::istringstream pairs(match[2]);
    for (std::string pair; pairs >> pair;)
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(pair, nullptr, 16)));
  }
  return bytes;
}

/// All "(a, b, c)" of the text.
template <std::size_t N>
std::vector<std::array<std::int32_t, N>> tuplesIn(const std::string& text) {
  const std::regex tuple("\\((-?[0-9]+(?:, -?[0-9]+)*)\\)");
  std::vector<std::array<std::int32_t, N>> out;
  for (std::sregex_iterator i(text.begin(), text.end(), tuple), end; i != end; ++i) {
    std::istringstream numbers((*i)[1]);
    std::vector<std::int32_t> values;
    for (std::string number; std::getline(numbers, number, ',');)
      values.push_back(std::stoi(number));
    if (values.size() != N) continue;
    std::copy(values.begin(), values.end(), out.emplace_back().begin());
  }
  return out;
}

/// The cells of one column of the page's table of slots, 0 = slots.
std::string column(const std::string& text, std::size_t wanted) {
  std::string out;
  std::istringstream lines(text.substr(text.find("| slot |")));
  for (std::string line; std::getline(lines, line) && line.starts_with("|");) {
    std::istringstream cells(line.substr(1));
    std::string cell;
    for (std::size_t i = 0; i <= wanted; ++i) std::getline(cells, cell, '|');
    out += cell + "\n";
  }
  return out;
}

template <class Tuples, std::size_t N>
void expectSame(const Tuples& tuples, const std::vector<std::array<std::int32_t, N>>& told) {
  ASSERT_EQ(tuples.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i)
    for (std::size_t a = 0; a < N; ++a)
      EXPECT_EQ(static_cast<std::int32_t>(tuples[i][a]), told[i][a]) << "slot " << i;
}

TEST(FormatExample, isTheLogThatThePageDescribes) {
  const std::string text = section("A worked example");
  const auto log = LogFile::fromBytes(dumped(text));
  ASSERT_TRUE(log) << log.error().text();
  ASSERT_EQ(log->index().chunks.size(), 2u);
  const auto values = [&](std::uint32_t chunk) {
    return *decodeValueBlock(log->block(chunk, kPositionsPart), 3,
                             log->index().tuples(chunk, kPositionsPart), CodecId::kDraco);
  };

  const auto told = [&](const std::string& from, const std::string& to) {
    const std::size_t first = text.find(from);
    EXPECT_NE(first, std::string::npos) << from;
    return tuplesIn<3>(text.substr(first, text.find(to, first) - first));
  };
  const auto flat = [](const std::vector<std::array<std::int32_t, 3>>& tuples) {
    std::vector<std::int32_t> out;
    for (const auto& t : tuples) out.insert(out.end(), t.begin(), t.end());
    return out;
  };
  EXPECT_EQ(values(0), flat(told("The values of chunk 0", ", each the difference")));
  EXPECT_EQ(values(1), flat(told("The values of chunk 1", "\n\n")));

  Refiner refiner(log->index());
  ASSERT_TRUE(applyChunk(*log, refiner, 0, {}));
  expectSame(refiner.points(), told(": vertices (15", ", the cell"));
  expectSame(refiner.boundary(), told("the boundary triangles (1, 2, 3)", "."));
  ASSERT_TRUE(applyChunk(*log, refiner, 1, {}));
  expectSame(refiner.points(), tuplesIn<3>(column(text, 1)));
  expectSame(refiner.tetrahedra(), tuplesIn<4>(column(text, 2)));
  expectSame(refiner.boundary(), tuplesIn<3>(column(text, 3)));
  std::string digest;
  for (const std::uint8_t byte : refiner.digest()) {
    constexpr const char* kDigits = "0123456789abcdef";
    digest += kDigits[byte >> 4];
    digest += kDigits[byte & 15];
  }
  EXPECT_NE(text.find("`" + digest + "`"), std::string::npos) << digest;
}

TEST(FormatExample, hasTheLiftedBlocksThatThePageDescribes) {
  const std::string text = section("A lifted block");
  const auto log = LogFile::fromBytes(dumped(text));
  ASSERT_TRUE(log) << log.error().text();
  EXPECT_EQ(log->index().chunks.size(), 2u);
  const auto block = [&](std::uint32_t chunk) { return log->block(chunk, kFirstFieldPart); };
  EXPECT_EQ(block(0).size(), 8u);
  EXPECT_EQ(block(1).size(), 10u);
  Refiner refiner(log->index());
  for (std::uint32_t chunk = 0; chunk < 2; ++chunk)
    ASSERT_TRUE(applyChunk(*log, refiner, chunk, std::array{0u}));
  const auto told = tuplesIn<7>(text);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(refiner.fieldValues(0), told[0]));
}

}  // namespace
}  // namespace qtet

#include "simplify/read/options/check_avs.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace qtet {
namespace {

constexpr std::string_view kBlanks = " \t\r,";

/// The first byte of a binary file.
constexpr char kBinary = 7;

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

/// The third word of a cell's line is its kind: tet, hex and so on. A point's may be "nan".
bool isCell(const std::vector<std::string_view>& words) {
  if (words.size() < 4 || !std::isalpha(static_cast<unsigned char>(words[2].front()))) return false;
  const char first = static_cast<char>(std::tolower(static_cast<unsigned char>(words[2].front())));
  return first != 'n' && first != 'i';  // not nan, not inf; no kind begins so
}

class AvsLines {
 public:
  explicit AvsLines(const std::filesystem::path& path) : path_(path), file_(path) {}

  Status check() {
    do {
      if (!std::getline(file_, line_)) break;
      ++number_;
    } while (line_.empty() || line_[0] == '#');
    if (!line_.empty() && line_[0] == kBinary) return {};
    std::istringstream header(line_);
    std::uint64_t points = 0, cells = 0, pointData = 0, cellData = 0, modelData = 0;
    if (!(header >> points >> cells >> pointData >> cellData))
      return fail(ErrorCode::kBadInput, path_.string() +
                                            " is no AVS UCD file: its first line is not the "
                                            "numbers of points, cells and data; export the mesh "
                                            "again");
    header >> modelData;
    for (std::uint64_t i = 0; i < points; ++i)
      if (Status done = expect("point", i, points, !next() || (count() >= 4 && !isCell(words_)));
          !done)
        return done;
    for (std::uint64_t i = 0; i < cells; ++i)
      if (Status done = expect("cell", i, cells, !next() || isCell(words_)); !done) return done;
    if (Status done = checkData("point", points, pointData); !done) return done;
    if (Status done = checkData("cell", cells, cellData); !done) return done;
    if (modelData > 0 || !next()) return {};
    return bad("stands behind the last value that the first line announces");
  }

 private:
  /// Sizes of the components, a name for each, and a tuple for each point or cell.
  Status checkData(const std::string& whose, std::uint64_t tuples, std::uint64_t width) {
    if (width == 0) return {};
    if (!next()) return ended(whose + " data");
    std::uint64_t components = 0, sum = 0, size = 0;
    std::istringstream sizes(line_);
    bool isSound = static_cast<bool>(sizes >> components) && components <= width;
    for (std::uint64_t i = 0; isSound && i < components; ++i) {
      isSound = static_cast<bool>(sizes >> size) && size <= width;
      sum += size;
    }
    if (!isSound || sum != width)
      return bad("is not the sizes of " + whose + " data whose sum is " + std::to_string(width));
    for (std::uint64_t i = 0; i < components; ++i)
      if (!next()) return ended(whose + " data");
    for (std::uint64_t i = 0; i < tuples; ++i)
      if (Status done = expect(whose + " tuple", i, tuples, !next() || count() > width); !done)
        return done;
    return {};
  }

  /// Goes to the next line with words; false: there is none.
  bool next() {
    while (std::getline(file_, line_)) {
      ++number_;
      words_ = wordsOf(line_);
      if (!words_.empty()) return true;
    }
    hasEnded_ = true;
    return false;
  }

  [[nodiscard]] std::uint64_t count() const { return words_.size(); }

  Status expect(const std::string& what, std::uint64_t at, std::uint64_t of, bool isSound) const {
    const std::string which = what + " " + std::to_string(at + 1) + " of " + std::to_string(of);
    if (hasEnded_) return ended(which);
    return isSound ? Status{} : bad("is not " + which);
  }

  [[nodiscard]] std::unexpected<Error> ended(const std::string& before) const {
    return fail(ErrorCode::kTruncated,
                path_.string() + " ends before " + before +
                    ", which its first line announces: the file was cut off, or its counts are "
                    "wrong; copy or export it again");
  }

  [[nodiscard]] std::unexpected<Error> bad(const std::string& why) const {
    return fail(ErrorCode::kBadInput, path_.string() + ": line " + std::to_string(number_) + " " +
                                          why +
                                          "; a count in the first line is wrong, or lines "
                                          "are missing; export the mesh again");
  }

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::string line_;
  std::vector<std::string_view> words_;
  std::uint64_t number_ = 0;
  bool hasEnded_ = false;
};

}  // namespace

Status checkAvs(const std::filesystem::path& path) { return AvsLines(path).check(); }

}  // namespace qtet

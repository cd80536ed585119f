#include "simplify/read/options/check_avs.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "simplify/read/options/byte_order_mark.h"

namespace qtet {
namespace {

constexpr std::string_view kLineBlanks = " \t\r";

/// The first byte of a binary file.
constexpr char kBinary = 7;

/// The third word of a cell's line is its kind: tet, hex and so on. A point's may be "nan".
bool isCell(const std::vector<std::string_view>& words) {
  if (words.size() < 4) return false;
  const auto first = static_cast<unsigned char>(words[2].front());
  const int small = std::tolower(first);
  return std::isalpha(first) && small != 'n' && small != 'i';  // not nan, not inf
}

class AvsLines {
 public:
  explicit AvsLines(const std::filesystem::path& path) : path_(path), file_(path) {
    passMark(file_);
  }

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
    const auto isPoint = [&] { return words_.size() >= 4 && !isCell(words_); };
    if (Status done = checkLines("point", points, isPoint); !done) return done;
    if (Status done = checkLines("cell", cells, [&] { return isCell(words_); }); !done) return done;
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
    return checkLines(whose + " tuple", tuples, [&] { return words_.size() > width; });
  }

  /// One line for each of `count`, which `isSound` looks at in words_.
  Status checkLines(const std::string& what, std::uint64_t count, auto isSound) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const bool isThere = next();
      if (isThere && isSound()) continue;
      const std::string which = what + " " + std::to_string(i + 1) + " of " + std::to_string(count);
      return isThere ? bad("is not " + which) : ended(which);
    }
    return {};
  }

  /// Goes to the next line with words; false: there is none.
  bool next() {
    while (std::getline(file_, line_)) {
      ++number_;
      splitLine();
      if (!words_.empty()) return true;
    }
    return false;
  }

  void splitLine() {
    const std::string_view line = line_;
    words_.clear();
    for (std::size_t at = line.find_first_not_of(kLineBlanks); at != line.npos;) {
      const std::size_t end = std::min(line.find_first_of(kLineBlanks, at), line.size());
      words_.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(kLineBlanks, end);
    }
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
  /// Those of line_.
  std::vector<std::string_view> words_;
  std::uint64_t number_ = 0;
};

}  // namespace

Status checkAvs(const std::filesystem::path& path) { return AvsLines(path).check(); }

}  // namespace qtet

#include "simplify/read/text/mesh_scanner.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>

#include "simplify/read/options/byte_order_mark.h"

namespace qtet {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

constexpr std::size_t kShownOfAWord = 24;

}  // namespace

void MeshScanner::skipBlanks() {
  while (place_ < text_.size()) {
    if (comment_ && text_[place_] == comment_) {
      while (place_ < text_.size() && text_[place_] != '\n') ++place_;
    } else if (isBlank(text_[place_])) {
      ++place_;
    } else {
      return;
    }
  }
}

void MeshScanner::look() {
  untilLook_ = kReadsBetweenLooks;
  if (time_.isOver()) fail(ErrorCode::kBadInput, time_.text());
}

std::string_view MeshScanner::word() {
  if (--untilLook_ == 0) look();
  if (failed()) return {};
  skipBlanks();
  const std::size_t begin = place_;
  while (place_ < text_.size() && !isBlank(text_[place_]) &&
         !(comment_ && text_[place_] == comment_))
    ++place_;
  return text_.substr(begin, place_ - begin);
}

std::string_view MeshScanner::line() {
  if (--untilLook_ == 0) look();
  if (failed()) return {};
  const std::size_t end = std::min(text_.find('\n', place_), text_.size());
  std::string_view out = text_.substr(place_, end - place_);
  place_ = std::min(end + 1, text_.size());
  while (!out.empty() && isBlank(out.front())) out.remove_prefix(1);
  while (!out.empty() && isBlank(out.back())) out.remove_suffix(1);
  return out;
}

std::string_view MeshScanner::rest() {
  if (--untilLook_ == 0) look();
  if (failed()) return {};
  skipBlanks();
  return text_.substr(place_);
}

bool MeshScanner::atEnd() {
  skipBlanks();
  return failed() || place_ >= text_.size();
}

void MeshScanner::endsList(std::uint64_t count, const char* what) {
  if (atEnd()) return;
  const char next = text_[place_];
  if ((next >= '0' && next <= '9') || next == '-' || next == '+' || next == '.')
    fail(ErrorCode::kBadInput, "a number follows the " + std::to_string(count) + " " + what +
                                   " that are announced: the count is wrong, or lines are too "
                                   "long; export the file again");
}

bool MeshScanner::fits(std::uint64_t count, std::uint64_t bytesEach, const char* what) {
  if (failed()) return false;
  if (count <= remaining() / bytesEach) return true;
  fail(ErrorCode::kTruncated,
       std::to_string(count) + " " + what + " are announced, but only " +
           std::to_string(remaining()) +
           " bytes follow: the file was cut off, or its count is wrong; copy or export it again");
  return false;
}

void MeshScanner::skipLine() {
  while (!failed() && place_ < text_.size() && text_[place_++] != '\n') {
  }
}

void MeshScanner::seek(std::uint64_t place) {
  if (failed()) return;
  if (place > text_.size())
    return fail(ErrorCode::kTruncated,
                "the file refers to byte " + std::to_string(place) +
                    ", where it has ended: it was cut off; copy or export it again");
  place_ = static_cast<std::size_t>(place);
}

void MeshScanner::fail(ErrorCode code, const std::string& what) {
  if (failed()) return;
  const auto lineNumber =
      1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(place_), '\n');
  const std::string where =
      bytes_ ? "byte " + std::to_string(place_) : "line " + std::to_string(lineNumber);
  error_ = Error{code, path_.string() + ", " + where + ": " + what, Error::kNoOffset};
}

/// The value of a number that no double comes near: too large, unless its exponent is negative, or
/// it has none and begins with 0.
double MeshScanner::beyondRange(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE"), digit = number.find_first_not_of("+-");
  const bool small = exponent != std::string_view::npos
                         ? number.substr(exponent + 1).starts_with('-')
                         : number[digit] == '0' || number[digit] == '.';
  return small ? 0 : std::numeric_limits<double>::infinity();
}

void MeshScanner::refuse(std::size_t place, std::string_view found, const char* what) {
  if (failed()) return;
  if (found.empty()) return endsWithin(what);
  place_ = place;
  skipBlanks();
  std::string shown(found.substr(0, kShownOfAWord));
  for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
  fail(ErrorCode::kBadInput,
       "'" + shown + "' is where " + what + " should be; the file is damaged, export it again");
}

void MeshScanner::endsWithin(const char* what) {
  fail(ErrorCode::kTruncated, std::string("the file ends where ") + what +
                                  " should be: it was cut off; copy or export it again");
}

Result<std::string> wholeFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0)
    return qtet::fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + std::strerror(errno));
  std::string text(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  if (!file.read(text.data(), size))
    return qtet::fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + std::strerror(errno));
  if (isUtf16(text)) return utf16Refused(path);
  text.erase(0, text.size() - withoutMark(text).size());
  return text;
}

}  // namespace qtet

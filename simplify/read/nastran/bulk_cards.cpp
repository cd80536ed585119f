#include "simplify/read/nastran/bulk_cards.h"

#include <algorithm>
#include <utility>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/read/text/plain_words.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLinesBetweenLooks = 1 << 12;
/// Columns of the name, of a small and of a large field, and of the data of a line.
constexpr std::size_t kNameColumns = 8, kSmallField = 8, kLargeField = 16, kDataColumns = 64;
/// A line with a comma this early is in free field.
constexpr std::size_t kLastCommaOfAName = 9;
constexpr std::size_t kFieldsOfALine = 8;

/// In capitals, with one blank between words.
std::string words(std::string_view text) {
  std::string out;
  for (const char c : capitals(trimmed(text))) {
    const bool isBlank = kBlanks.find(c) != std::string_view::npos;
    if (!isBlank)
      out += c;
    else if (!out.ends_with(' '))
      out += ' ';
  }
  return out;
}

enum class BulkBegin : std::uint8_t { kNone, kBulk, kPart };

/// Whether bulk data begin behind the line, or those of one part among several.
BulkBegin bulkBegin(std::string_view line) {
  const std::string text = words(line);
  if (!text.starts_with("BEGIN ")) return BulkBegin::kNone;
  const auto has = [&](std::string_view word) { return text.find(word) != std::string::npos; };
  if (has("SUPER") || has("MODULE") || has("MODEL")) return BulkBegin::kPart;
  return has("BULK") ? BulkBegin::kBulk : BulkBegin::kNone;
}

}  // namespace

BulkCards::BulkCards(const fs::path& path, std::chrono::seconds patience)
    : root_(path), time_(patience, 0) {
  open(path);
  skipToBulk();
}

void BulkCards::open(const fs::path& path) {
  if (!seen_.insert(path.lexically_normal()).second)
    return fail(path.string() + " is included twice; include it once");
  Result<std::string> text = wholeFile(path);
  if (!text) return fail(text.error().code, text.error().message);
  time_.addFile(text->size());
  untilLook_ = 1;
  files_.push_back({path, std::move(*text)});
}

/// Before bulk data stand commands to the program, if there is a line between them.
void BulkCards::skipToBulk() {
  if (failed()) return;
  OpenText& file = files_.back();
  while (!failed() && rawLine())
    if (const BulkBegin begin = bulkBegin(line_); begin != BulkBegin::kNone)
      return begin == BulkBegin::kPart ? refuseParts() : void();
  file.place = 0;
  file.line = 0;
}

bool BulkCards::rawLine() {
  OpenText& file = files_.back();
  if (file.place >= file.text.size()) return false;
  if (--untilLook_ == 0) {
    untilLook_ = kLinesBetweenLooks;
    if (time_.isOver()) fail(time_.text());
  }
  const std::size_t end = std::min(file.text.find('\n', file.place), file.text.size());
  std::string_view text = std::string_view(file.text).substr(file.place, end - file.place);
  file.place = end + 1;
  ++file.line;
  text = text.substr(0, text.find('$'));
  line_.clear();
  for (const char c : text) {
    if (c == '\r') continue;
    line_ += c == '\t' ? ' ' : c;
    while (c == '\t' && line_.size() % kSmallField != 0) line_ += ' ';
  }
  return !failed();
}

bool BulkCards::nextLine() {
  while (!failed() && !files_.empty()) {
    if (!rawLine()) {
      if (files_.size() == 1) break;  // the root stays, so that an error has a place
      files_.pop_back();
      continue;
    }
    const std::string_view text = trimmed(line_);
    if (text.empty()) continue;
    const std::string begin = words(text.substr(0, 32));
    if (begin.starts_with("ENDDATA") || begin.starts_with("END BULK")) break;
    if (begin.starts_with("INCLUDE")) {
      include();
      continue;
    }
    switch (bulkBegin(text)) {
      case BulkBegin::kNone: return true;
      case BulkBegin::kBulk: break;
      case BulkBegin::kPart: refuseParts();
    }
  }
  return false;
}

void BulkCards::refuseParts() {
  cardFile_ = files_.back().path.string();
  cardLine_ = files_.back().line;
  fail("'" + shownField(trimmed(line_)) +
       "' begins the bulk data of one part among several, whose numbers may be the same; export "
       "the parts as files of their own");
}

/// INCLUDE 'FILE', where the name may go on over lines up to its closing quote.
void BulkCards::include() {
  std::string name(trimmed(trimmed(line_).substr(std::string_view("INCLUDE").size())));
  if (!name.empty() && (name[0] == '\'' || name[0] == '"')) {
    const char quote = name[0];
    while (name.find(quote, 1) == std::string::npos && rawLine()) name += trimmed(line_);
    const std::size_t end = name.find(quote, 1);
    name = end == std::string::npos ? "" : name.substr(1, end - 1);
  }
  if (failed()) return;
  std::error_code code;
  fs::path path = files_.back().path.parent_path() / name;
  if (!fs::is_regular_file(path, code)) path = root_.parent_path() / name;
  const auto refuse = [&](ErrorCode why, const std::string& what) {
    cardFile_ = files_.back().path.string();
    cardLine_ = files_.back().line;
    fail(why, what);
  };
  if (name.empty() || !fs::is_regular_file(path, code))
    return refuse(ErrorCode::kNotFound,
                  name.empty() ? "INCLUDE names no file between quotes; correct the line"
                               : "the included file '" + shownField(name) +
                                     "' is not there; put it beside this file");
  if (files_.size() > kMaxDepth)
    return refuse(ErrorCode::kLimitExceeded, "files are included more than " +
                                                 std::to_string(kMaxDepth) +
                                                 " deep; join them to one file");
  open(path);
}

/// Whether the line goes on with the card before it: it has no name.
bool BulkCards::continues() const {
  const char first = line_.front();
  if (first == '+' || first == '*' || first == ',') return true;
  return trimmed(std::string_view(line_).substr(0, std::min(kNameColumns, line_.find(','))))
      .empty();
}

bool BulkCards::next() {
  if (!hasLine_) hasLine_ = !ended_ && nextLine();
  if (!hasLine_ || failed()) {
    ended_ = true;
    return false;
  }
  cardFile_ = files_.back().path.string();
  cardLine_ = files_.back().line;
  fields_.clear();
  if (continues()) {
    fail("the line continues no card: its first field is empty; export the file again");
    return false;
  }
  startCard();
  while ((hasLine_ = nextLine()) && continues()) addFields();
  return !failed();
}

void BulkCards::startCard() {
  const std::string_view text(line_);
  const std::size_t comma = text.find(',');
  name_ = capitals(trimmed(
      text.substr(0, comma <= kLastCommaOfAName ? comma : std::min(kNameColumns, text.size()))));
  addFields();
  std::erase(name_, '*');
}

void BulkCards::addFields() {
  const std::string_view text(line_);
  const std::size_t comma = text.find(',');
  const bool isFree = comma <= kLastCommaOfAName;
  const bool isLarge = text.substr(0, isFree ? comma : kNameColumns).find('*') != text.npos;
  if (isFree)
    addFree(isLarge ? kFieldsOfALine / 2 : kFieldsOfALine);
  else
    addFixed(isLarge ? kLargeField : kSmallField);
}

/// Commas stand between the fields. Behind the last one may be the mark of the line that continues
/// this one.
void BulkCards::addFree(std::size_t perLine) {
  std::string_view text(line_);
  text.remove_prefix(text.find(',') + 1);
  for (std::size_t i = 0; i < perLine; ++i) {
    const std::size_t end = std::min(text.find(','), text.size());
    std::string_view field = trimmed(text.substr(0, end));
    const bool isMark = end == text.size() && (field == "+" || field == "*");
    if (fields_.size() < kMaxFields) fields_.emplace_back(isMark ? std::string_view() : field);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const std::size_t more = text.find(',');
  if (more != std::string_view::npos && !trimmed(text.substr(more + 1)).empty())
    fail("the line has more than " + std::to_string(perLine + 2) +
         " fields between commas; export the file again");
}

/// Some programs write "10.0000-1" into a field of 8 columns, and all behind it moves on by one. No
/// number ends with a sign, so that digit belongs to it. True: each field is where it should be
/// then, since the line ends with a whole one.
bool BulkCards::addOverfull() {
  const std::string_view text = std::string_view(line_).substr(0, line_.find_last_not_of(' ') + 1);
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::vector<std::string_view> found;
  std::size_t moved = 0;
  for (std::size_t at = kNameColumns; at < text.size(); at += kSmallField) {
    const std::size_t end = at + kSmallField;
    const bool isOverfull = end < text.size() && (text[end - 1] == '-' || text[end - 1] == '+') &&
                            (isDigit(text[end - 2]) || text[end - 2] == '.') && isDigit(text[end]);
    found.push_back(trimmed(text.substr(at, kSmallField + (isOverfull ? 1 : 0))));
    if (isOverfull) ++moved, ++at;
  }
  const bool endsWhole = (text.size() - moved) % kSmallField == 0;
  if (moved == 0 || !endsWhole || found.size() > kFieldsOfALine) return false;
  found.resize(kFieldsOfALine);
  for (const std::string_view field : found)
    if (fields_.size() < kMaxFields) fields_.emplace_back(field);
  return true;
}

void BulkCards::addFixed(std::size_t width) {
  if (width == kSmallField && addOverfull()) return;
  const std::string_view text(line_);
  for (std::size_t at = kNameColumns; at < kNameColumns + kDataColumns; at += width)
    if (fields_.size() < kMaxFields)
      fields_.emplace_back(at < text.size() ? trimmed(text.substr(at, width)) : std::string_view());
}

std::uint32_t BulkCards::id(std::size_t i, const char* what) {
  if (failed() || field(i).empty()) return 0;
  if (const std::optional<std::uint32_t> value = plainId(field(i))) return *value;
  fail(misplacedField(field(i), what));
  return 0;
}

double BulkCards::real(std::size_t i, const char* what) {
  if (failed() || field(i).empty()) return 0;
  if (const std::optional<double> value = fortranReal(field(i))) return *value;
  fail(misplacedField(field(i), what));
  return 0;
}

void BulkCards::fail(ErrorCode code, const std::string& what) {
  if (failed()) return;
  const std::string file = cardFile_.empty() ? root_.string() : cardFile_;
  error_ = Error{
      code, (cardLine_ > 0 ? file + ", line " + std::to_string(cardLine_) : file) + ": " + what,
      Error::kNoOffset};
}

}  // namespace qtet

#include "simplify/read/abaqus/abaqus_lines.h"

#include <algorithm>
#include <utility>

#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/plain_numbers.h"
#include "simplify/read/text/plain_words.h"

namespace qtet {
namespace {

constexpr std::uint32_t kLinesBetweenLooks = 1 << 12;

bool isLetter(char c) { return capital(c) >= 'A' && capital(c) <= 'Z'; }

bool isComment(std::string_view line) { return line.starts_with("**"); }

bool isQuote(char c) { return c == '"' || c == '\''; }

/// The place of the first comma from `begin` on that is not within quotes, or the end. A quote
/// opens a name: it stands first, or behind one of ",=.".
std::size_t commaIn(std::string_view text, std::size_t begin) {
  char before = ',';
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == ',') return i;
    if (isQuote(text[i]) && (before == ',' || before == '=' || before == '.')) {
      const std::size_t close = text.find(text[i], i + 1);
      if (close != std::string_view::npos) i = close;
    }
    if (kBlanks.find(text[i]) == std::string_view::npos) before = text[i];
  }
  return text.size();
}

std::string_view unquoted(std::string_view text) {
  if (text.size() >= 2 && isQuote(text[0]) && text.find(text[0], 1) == text.size() - 1)
    return text.substr(1, text.size() - 2);
  return text;
}

}  // namespace

std::string abaqusName(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (!isQuote(c) && kBlanks.find(c) == std::string_view::npos) out += capital(c);
  return out;
}

const std::string* AbaqusKeyword::find(std::string_view parameter) const {
  const auto at = std::ranges::find(parameters, parameter, &Parameter::name);
  return at == parameters.end() ? nullptr : &at->value;
}

AbaqusLines::AbaqusLines(const std::filesystem::path& path, std::chrono::seconds patience)
    : root_(path), time_(patience, 0) {
  open(path);
}

bool AbaqusLines::open(const std::filesystem::path& path) {
  Result<std::string> text = wholeFile(path);
  if (!text) {
    fail(text.error().code, text.error().message);
    return false;
  }
  if (seen_.insert(path.lexically_normal()).second) {
    bytes_ += text->size();
    time_.addFile(text->size());
  } else {
    bytesAgain_ += text->size();
  }
  if (bytesAgain_ > kMaxBytesAgain + kMaxTimesAgain * bytes_) {
    fail(ErrorCode::kLimitExceeded,
         "files that are included again have " + std::to_string(bytesAgain_) +
             " bytes together, which is too much; give one part instances in place of that");
    return false;
  }
  untilLook_ = 1;
  files_.push_back({path, std::move(*text)});
  return true;
}

void AbaqusLines::look() {
  untilLook_ = kLinesBetweenLooks;
  if (time_.isOver()) fail(time_.text());
}

std::optional<std::string_view> AbaqusLines::lineOf(OpenText& file) {
  while (file.place < file.text.size()) {
    if (--untilLook_ == 0) look();
    if (failed()) return std::nullopt;
    const std::size_t end = std::min(file.text.find('\n', file.place), file.text.size());
    const std::string_view line =
        trimmed(std::string_view(file.text).substr(file.place, end - file.place));
    file.place = end + 1;
    ++file.line;
    if (!line.empty() && !isComment(line)) return line;
  }
  return std::nullopt;
}

std::optional<std::string_view> AbaqusLines::rawLine() {
  while (!files_.empty() && !failed()) {
    if (const std::optional<std::string_view> line = lineOf(files_.back())) return line;
    // the root stays, so that an error has a place
    if (files_.size() == 1 || failed()) break;
    files_.pop_back();
  }
  return std::nullopt;
}

bool AbaqusLines::next() {
  while (!failed()) {
    const std::optional<std::string_view> line = rawLine();
    if (!line) break;
    isKeyword_ = line->front() == '*';
    if (!isKeyword_) {
      readFields(*line);
      return true;
    }
    readKeyword(*line);
    if (keyword_.name == "INCLUDE")
      includeParameter();
    else if (!failed())
      return true;
  }
  ended_ = true;
  return false;
}

void AbaqusLines::readFields(std::string_view line) {
  fields_.clear();
  goesOn_ = line.back() == ',';
  const bool hasQuotes =
      line.find('"') != std::string_view::npos || line.find('\'') != std::string_view::npos;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end =
        hasQuotes ? commaIn(line, begin) : std::min(line.find(',', begin), line.size());
    fields_.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
}

void AbaqusLines::readKeyword(std::string_view line) {
  std::string whole(line.substr(1));
  // A line that ends in a comma goes on where a parameter follows; some programs write such a comma
  // also before data. That line is in the same file, which stays open.
  while (whole.ends_with(',')) {
    OpenText& file = files_.back();
    const std::size_t place = file.place;
    const std::uint64_t number = file.line;
    const std::optional<std::string_view> more = lineOf(file);
    if (!more || !isLetter(more->front())) {
      file.place = place;
      file.line = number;
      break;
    }
    whole += *more;
  }
  keyword_ = {};
  const std::string_view text = whole;
  std::size_t begin = std::min(text.find(','), text.size());
  keyword_.name = abaqusName(text.substr(0, begin));
  while (begin < text.size()) {
    const std::size_t end = commaIn(text, begin + 1);
    const std::string_view parameter = text.substr(begin + 1, end - begin - 1);
    const std::size_t equals = std::min(parameter.find('='), parameter.size());
    begin = end;
    if (trimmed(parameter).empty()) continue;
    keyword_.parameters.push_back(
        {abaqusName(parameter.substr(0, equals)),
         std::string(unquoted(trimmed(parameter.substr(std::min(equals + 1, parameter.size())))))});
  }
}

void AbaqusLines::includeParameter() {
  const std::string* input = keyword_.find("INPUT");
  if (!input || input->empty()) return fail("*INCLUDE names no file: INPUT=FILE is missing");
  include(*input);
}

void AbaqusLines::include(const std::string& name) {
  if (failed()) return;
  namespace fs = std::filesystem;
  std::error_code code;
  fs::path path = files_.back().path.parent_path() / name;
  // Abaqus looks beside the first file.
  if (!fs::is_regular_file(path, code)) {
    const fs::path beside = root_.parent_path() / name;
    if (!fs::is_regular_file(beside, code))
      return fail(ErrorCode::kNotFound, "the included file '" + shownField(name) +
                                            "' is not there; put it beside this file");
    path = beside;
  }
  if (std::ranges::any_of(files_, [&](const OpenText& file) { return file.path == path; }))
    return fail("'" + shownField(name) + "' is included within itself");
  if (files_.size() > kMaxDepth || ++opened_ > kMaxFiles)
    return fail(ErrorCode::kLimitExceeded, "files are included " + std::to_string(kMaxDepth) +
                                               " deep, or more than " + std::to_string(kMaxFiles) +
                                               " times; join them to one file");
  open(path);
}

std::uint32_t AbaqusLines::id(std::size_t field, const char* what) {
  if (failed() || field >= fields_.size() || fields_[field].empty()) return 0;
  if (const std::optional<std::uint32_t> value = plainId(fields_[field])) return *value;
  fail(misplacedField(fields_[field], what));
  return 0;
}

double AbaqusLines::real(std::size_t field, const char* what) {
  if (failed() || field >= fields_.size() || fields_[field].empty()) return 0;
  if (const std::optional<double> value = fortranReal(fields_[field])) return *value;
  fail(misplacedField(fields_[field], what));
  return 0;
}

void AbaqusLines::fail(ErrorCode code, const std::string& what) {
  if (failed()) return;
  const std::string place = files_.empty() ? ""
                                           : files_.back().path.string() + ", line " +
                                                 std::to_string(files_.back().line) + ": ";
  error_ = Error{code, place + what, Error::kNoOffset};
}

}  // namespace qtet

#include "simplify/read/foam/foam_list.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <system_error>

#include "simplify/read/process/inflate_file.h"
#include "simplify/read/text/mesh_scanner.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr FoamList::Label kMaxLabel = (FoamList::Label{1} << 32) - 1;

fs::path compressed(const fs::path& path) { return path.string() + ".gz"; }

bool isFile(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path, code);
}

bool isBlank(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

bool isSign(char c) { return c == '(' || c == ')' || c == '{' || c == '}' || c == ';'; }

}  // namespace

bool FoamList::isThere(const fs::path& path) { return isFile(path) || isFile(compressed(path)); }

Result<std::string> FoamList::classOf(const fs::path& path) {
  Result<std::string> text = beginningOf(path, kMostHeaderBytes);
  if (!text) return text;
  FoamList out(path, std::move(*text), kReadPatience);
  if (out.word() != "FoamFile") return "";
  out.at_ = 0;
  if (Status done = out.readHeader(); !done) return std::unexpected(done.error());
  return out.class_;
}

Result<FoamList> FoamList::open(const fs::path& path, std::chrono::seconds patience) {
  Result<std::string> text = std::string();
  if (isFile(path)) {
    text = wholeFile(path);
  } else if (isFile(compressed(path))) {
    const Status done = inflated(compressed(path), [&](const fs::path& file) -> Status {
      text = wholeFile(file);
      return text ? Status{} : Status(std::unexpected(text.error()));
    });
    if (!done) return std::unexpected(done.error());
  } else {
    return fail(ErrorCode::kNotFound, "the case has no file " + path.string() + "; copy it whole");
  }
  if (!text) return std::unexpected(text.error());
  FoamList out(path, std::move(*text), patience);
  if (Status done = out.readHeader(); !done) return std::unexpected(done.error());
  return out;
}

std::unexpected<Error> FoamList::bad(const std::string& what) const {
  return fail(ErrorCode::kBadInput, path_.string() + ": " + what + "; write the case again");
}

std::unexpected<Error> FoamList::badHere(const std::string& what) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
  const std::string place =
      isBinary_ ? "byte " + std::to_string(at_)
                : "line " + std::to_string(1 + std::count(text_.begin(), end, '\n'));
  return fail(ErrorCode::kBadInput,
              path_.string() + ", " + place + ": " + what + "; write the case again");
}

std::string FoamList::shown(std::string_view word) {
  constexpr std::size_t kMostShown = 20;
  return "'" + std::string(word.substr(0, kMostShown)) + "'";
}

void FoamList::skipBlanks() {
  for (;;) {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    if (at_ >= text_.size() || text_[at_] != '/') return;
    const std::string_view rest = std::string_view(text_).substr(at_);
    std::size_t end = 0;
    if (rest.starts_with("//"))
      end = rest.find('\n');
    else if (rest.starts_with("/*"))
      end = std::min(rest.find("*/"), rest.size() - 2) + 2;
    else
      return;
    at_ += std::min(end, rest.size());
  }
}

bool FoamList::take(char sign) {
  skipBlanks();
  if (at_ >= text_.size() || text_[at_] != sign) return false;
  ++at_;
  return true;
}

/// The signs up to a blank or one that ends a word; one such sign by itself.
std::string_view FoamList::word() {
  skipBlanks();
  const std::size_t begin = at_;
  while (at_ < text_.size() && !isBlank(text_[at_]) && !isSign(text_[at_])) ++at_;
  if (at_ == begin && at_ < text_.size()) ++at_;
  return std::string_view(text_).substr(begin, at_ - begin);
}

/// "FoamFile { version 2.0; format binary; class faceCompactList; arch "LSB;label=64;scalar=64"; }"
Status FoamList::readHeader() {
  if (word() != "FoamFile" || !take('{')) return bad("it does not begin with FoamFile");
  bool isForeign = false;
  while (!take('}')) {
    const std::string key(word());
    skipBlanks();
    std::size_t end = at_;
    for (bool isQuoted = false; end < text_.size() && (isQuoted || text_[end] != ';'); ++end)
      if (text_[end] == '"') isQuoted = !isQuoted;
    if (key.empty() || end >= text_.size()) return bad("its header does not end");
    const std::string value = text_.substr(at_, end - at_);
    at_ = end + 1;
    if (key == "format") isBinary_ = value.starts_with("binary");
    if (key == "class") class_ = value.substr(0, value.find_first_of(" \t\r\n"));
    if (key != "arch") continue;
    if (value.contains("label=64")) labelBytes_ = 8;
    if (value.contains("scalar=32")) realBytes_ = 4;
    isForeign = value.contains("MSB");
  }
  if (isForeign && isBinary_)
    return bad("its numbers have their highest byte first, which is not read");
  return {};
}

Result<FoamList::Label> FoamList::label() {
  if (isLate()) return badHere(time_.text());
  const std::string_view found = word();
  Label value = 0;
  const auto read = std::from_chars(found.data(), found.data() + found.size(), value);
  if (found.empty() || read.ec != std::errc{} || read.ptr != found.data() + found.size() ||
      value < -1 || value > kMaxLabel) {
    at_ -= found.size();
    return badHere(shown(found) + " is not an index from 0 on");
  }
  return value;
}

/// The count before a list, each of whose things takes at least so many bytes.
Result<std::uint64_t> FoamList::count(std::uint64_t bytesEach) {
  const Result<Label> told = label();
  if (!told) return std::unexpected(told.error());
  const auto count = static_cast<std::uint64_t>(*told);
  if (*told < 0 || count > (text_.size() - at_) / bytesEach)
    return badHere("a list of " + std::to_string(*told) +
                   " does not fit into the rest of the file");
  return count;
}

Result<std::uint64_t> FoamList::faceCount() {
  const std::size_t begin = at_;
  const Result<std::uint64_t> told = count(1);
  at_ = begin;
  if (!told || !isCompact()) return told;
  return *told == 0 ? 0 : *told - 1;  // where each begins, and where the last one ends
}

Result<std::vector<FoamList::Label>> FoamList::uniformLabels(Label count, std::uint64_t most) {
  const Result<Label> value = label();
  if (!value) return std::unexpected(value.error());
  if (!take('}')) return badHere("a list N{VALUE} does not end");
  if (count < 0 || std::cmp_greater(count, most))
    return badHere("a list N{VALUE} says that it has " + std::to_string(count) +
                   " labels, but at most " + std::to_string(most) + " are possible");
  return std::vector<Label>(static_cast<std::size_t>(count), *value);
}

Result<std::vector<FoamList::Label>> FoamList::labels(std::uint64_t mostUniform) {
  const std::size_t begin = at_;
  const Result<Label> first = label();
  if (!first) return std::unexpected(first.error());
  if (take('{')) return uniformLabels(*first, mostUniform);
  at_ = begin;
  const Result<std::uint64_t> told = count(isBinary_ ? labelBytes_ : 2);
  if (!told) return std::unexpected(told.error());
  if (isBinary_) return binaryLabels(*told);
  if (!take('(')) return badHere("a list does not begin with (");
  std::vector<Label> out;
  out.reserve(*told);
  for (std::uint64_t i = 0; i < *told; ++i) {
    const Result<Label> value = label();
    if (!value) return std::unexpected(value.error());
    out.push_back(*value);
  }
  if (!take(')')) return badHere("a list of " + std::to_string(*told) + " does not end there");
  return out;
}

Result<std::vector<FoamList::Label>> FoamList::binaryLabels(std::uint64_t count) {
  std::vector<Label> out(count);
  if (count == 0) {  // without or with parentheses
    if (take('(') && !take(')')) return badHere("an empty list does not end");
    return out;
  }
  if (!take('(')) return badHere("a list does not begin with (");
  if (count > (text_.size() - at_) / labelBytes_) return badHere("a list is cut off");
  for (Label& value : out) {
    std::int32_t narrow = 0;
    if (labelBytes_ == 8)
      std::memcpy(&value, text_.data() + at_, 8);
    else
      std::memcpy(&narrow, text_.data() + at_, 4), value = narrow;
    if (value < -1 || value > kMaxLabel)
      return badHere(std::to_string(value) + " is not an index from 0 on");
    at_ += labelBytes_;
  }
  if (!take(')')) return badHere("a list of " + std::to_string(count) + " does not end there");
  return out;
}

Status FoamList::faces(const std::function<Status(std::span<const Label>)>& give) {
  if (isCompact()) return compactFaces(give);
  constexpr std::uint64_t kMinFaceBytes = 4;  // of a face: "0()" and a blank
  const Result<std::uint64_t> told = count(kMinFaceBytes);
  if (!told) return std::unexpected(told.error());
  if (!take('(')) return badHere("a list does not begin with (");
  // work stays in proportion to the file: a mesh has no face whose corners are all the same
  std::uint64_t uniformLeft = text_.size();
  for (std::uint64_t i = 0; i < *told; ++i) {
    const Result<std::vector<Label>> corners = labels(uniformLeft);
    if (!corners) return std::unexpected(corners.error());
    uniformLeft -= std::min<std::uint64_t>(uniformLeft, corners->size());
    if (Status done = give(*corners); !done) return done;
  }
  if (!take(')')) return badHere("a list of " + std::to_string(*told) + " does not end there");
  return {};
}

Status FoamList::compactFaces(const std::function<Status(std::span<const Label>)>& give) {
  const Result<std::vector<Label>> begins = labels(text_.size());
  if (!begins) return std::unexpected(begins.error());
  const Result<std::vector<Label>> corners = labels(text_.size());
  if (!corners) return std::unexpected(corners.error());
  for (std::size_t i = 0; i + 1 < begins->size(); ++i) {
    const Label begin = (*begins)[i], end = (*begins)[i + 1];
    if (begin < 0 || end < begin || std::cmp_greater(end, corners->size()))
      return bad("face " + std::to_string(i) + " has corners outside of their list");
    if (Status done = give(std::span(*corners).subspan(static_cast<std::size_t>(begin),
                                                       static_cast<std::size_t>(end - begin)));
        !done)
      return done;
  }
  return {};
}

Status FoamList::zones(
    std::uint64_t mostUniform,
    const std::function<Status(std::string_view, std::span<const Label>)>& give) {
  constexpr std::uint64_t kMinZoneBytes = 4;  // "a{}" and a blank
  const Result<std::uint64_t> told = count(kMinZoneBytes);
  if (!told) return std::unexpected(told.error());
  if (!take('(')) return badHere("a list does not begin with (");
  for (std::uint64_t i = 0; i < *told; ++i) {
    std::string_view name = word();
    if (name.size() > 1 && name.front() == '"' && name.back() == '"')
      name = name.substr(1, name.size() - 2);
    if (name.empty() || !take('{')) return badHere("a zone has no name with { behind it");
    const Result<std::vector<Label>> labels = zoneLabels(mostUniform);
    if (!labels) return std::unexpected(labels.error());
    mostUniform -= std::min<std::uint64_t>(mostUniform, labels->size());
    if (Status done = give(name, *labels); !done) return done;
  }
  if (!take(')')) return badHere("a list of " + std::to_string(*told) + " does not end there");
  return {};
}

/// "type cellZone; cellLabels List<label> 2(0 1);}"
Result<std::vector<FoamList::Label>> FoamList::zoneLabels(std::uint64_t mostUniform) {
  std::vector<Label> out;
  while (!take('}')) {
    if (word() == "cellLabels") {
      skipBlanks();
      // "List<label>" may stand before
      if (at_ < text_.size() && text_[at_] == 'L') static_cast<void>(word());
      Result<std::vector<Label>> read = labels(mostUniform);
      if (!read) return read;
      out = std::move(*read);
    }
    while (!take(';'))
      if (word().empty()) return badHere("an entry of a zone does not end");
  }
  return out;
}

Result<std::uint64_t> FoamList::patchFaces() {
  const Result<std::uint64_t> told = count(1);
  if (!told) return std::unexpected(told.error());
  std::uint64_t patches = 0, sum = 0;
  for (std::string_view found = word(); !found.empty(); found = word()) {
    if (found != "nFaces") continue;
    const Result<Label> faces = label();
    if (!faces) return std::unexpected(faces.error());
    if (*faces < 0) return badHere("a patch has -1 faces");
    sum += static_cast<std::uint64_t>(*faces);
    ++patches;
  }
  if (patches != *told)
    return bad("it has " + std::to_string(patches) + " patches with nFaces, but says " +
               std::to_string(*told));
  return sum;
}

}  // namespace qtet

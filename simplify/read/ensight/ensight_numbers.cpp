#include "simplify/read/ensight/ensight_numbers.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <span>

#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/mesh_format.h"
#include "simplify/read/vtu/vtu_file.h"

namespace qtet {
namespace {

constexpr std::string_view kBegin = "BEGIN TIME STEP", kEnd = "END TIME STEP";
/// A line of a binary file, and the length of a record of Fortran.
constexpr std::size_t kLineBytes = 80, kMarkBytes = 4;
/// A file of several steps says so within so many bytes: its kind may stand before.
constexpr std::uint64_t kFrontOfSteps = 512;
/// Bytes that are searched at once for the beginnings of steps.
constexpr std::uint64_t kSearched = 1 << 20;

std::uint32_t wordAt(std::string_view bytes, std::size_t at, std::endian order) {
  assert(at + sizeof(std::uint32_t) <= bytes.size());
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return order == std::endian::native ? value : std::byteswap(value);
}

Result<std::string> rangeOf(const VtuFile& file, std::uint64_t begin, std::uint64_t end) {
  assert(begin <= end && end <= file.size());
  std::string out(static_cast<std::size_t>(end - begin), '\0');
  if (Status done = file.read(begin, std::as_writable_bytes(std::span(out))); !done)
    return std::unexpected(done.error());
  return out;
}

Result<VtuFile> openedFile(const std::filesystem::path& path, std::chrono::seconds patience) {
  if (Status checked = checkMeshFile(path, MeshFormat::kOther); !checked)
    return std::unexpected(checked.error());
  return VtuFile::open(path, patience);
}

/// A record that is longer than 2^31 bytes has several parts; the lengths of all but the last are
/// negative.
std::uint32_t recordLength(std::string_view bytes, std::size_t at, std::endian order) {
  const auto length = static_cast<std::int32_t>(wordAt(bytes, at, order));
  return length < 0 ? 0U - static_cast<std::uint32_t>(length) : static_cast<std::uint32_t>(length);
}

/// Moves the records together. Errors: truncated (one goes beyond the end, or its two lengths
/// differ).
Status withoutRecordMarks(std::string& bytes, const std::filesystem::path& file,
                          std::endian order) {
  std::size_t to = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const std::uint64_t length = left < kMarkBytes ? 0 : recordLength(bytes, at, order);
    if (left < 2 * kMarkBytes || length > left - 2 * kMarkBytes ||
        recordLength(bytes, at + kMarkBytes + length, order) != length)
      return fail(ErrorCode::kTruncated,
                  file.string() + ": its record at byte " + std::to_string(at) + " should have " +
                      std::to_string(length) + " bytes, but does not end there, and " +
                      std::to_string(left) +
                      " follow: the file was cut off; copy or export it "
                      "again",
                  at);
    assert(to <= at);
    std::memmove(bytes.data() + to, bytes.data() + at + kMarkBytes, length);
    to += length;
    at += length + 2 * kMarkBytes;
  }
  bytes.resize(to);
  return {};
}

}  // namespace

Result<EnSightEncoding> encodingOf(const std::filesystem::path& file, bool isGold) {
  const Result<VtuFile> opened = openedFile(file, kReadPatience);
  if (!opened) return std::unexpected(opened.error());
  const auto front =
      rangeOf(*opened, 0, std::min<std::uint64_t>(opened->size(), kMarkBytes + kLineBytes));
  if (!front) return std::unexpected(front.error());
  EnSightEncoding out;
  out.isGold = isGold;
  if (front->starts_with("C Binary")) out.kind = EnSightEncoding::kC;
  if (front->substr(std::min(kMarkBytes, front->size())).starts_with("Fortran Binary")) {
    out.kind = EnSightEncoding::kFortran;
    out.order = wordAt(*front, 0, std::endian::little) == kLineBytes ? std::endian::little
                                                                     : std::endian::big;
  }
  return out;
}

Result<const std::vector<EnSightFiles::Range>*> EnSightFiles::stepsOf(
    const std::filesystem::path& path, const EnSightEncoding& encoding) {
  if (const auto known = steps_.find(path); known != steps_.end()) return &known->second;
  const Result<VtuFile> file = openedFile(path, patience_);
  if (!file) return std::unexpected(file.error());
  std::vector<Range> out;
  const auto front = rangeOf(*file, 0, std::min(file->size(), kFrontOfSteps));
  if (!front) return std::unexpected(front.error());
  bool isWithin = false;
  const bool isFortran = encoding.kind == EnSightEncoding::kFortran;
  const std::uint64_t mark = isFortran ? kMarkBytes : 0;
  std::string some;  // of the file from byte `from` on
  std::uint64_t from = 0;
  for (std::uint64_t at = front->contains(kBegin) ? 0 : file->size(); at < file->size();) {
    const std::string_view sought = isWithin ? kEnd : kBegin;
    const std::size_t known = at < from + some.size() ? at - from : some.size();
    const std::size_t place = some.find(sought, known);
    if (place == std::string::npos) {
      if (from + some.size() == file->size() && !some.empty()) break;
      // it may go beyond the end of what was searched
      if (!some.empty() && at < from + some.size())
        at = std::max(at, from + some.size() - std::min(some.size(), sought.size()));
      auto next = rangeOf(*file, at, std::min(file->size(), at + kSearched));
      if (!next) return std::unexpected(next.error());
      some = std::move(*next), from = at;
      continue;
    }
    const std::size_t found = place - (at - from);
    if (isWithin) {
      out.back().end = std::max(out.back().begin, at + found - mark);
      at += found + sought.size();
    } else {
      const bool isText = encoding.kind == EnSightEncoding::kText;
      const std::uint64_t begin = at + found + (isText ? sought.size() : kLineBytes + mark);
      out.push_back({std::min(begin, file->size()), file->size()});
      at = out.back().begin;
    }
    isWithin = !isWithin;
  }
  return &(steps_[path] = std::move(out));
}

Result<std::string> EnSightFiles::read(const EnSightPlace& place, const EnSightEncoding& encoding) {
  const auto steps = stepsOf(place.file, encoding);
  if (!steps) return std::unexpected(steps.error());
  const Result<VtuFile> file = openedFile(place.file, patience_);
  if (!file) return std::unexpected(file.error());
  Range range{0, file->size()};
  if (!(*steps)->empty()) {
    if (place.step >= (*steps)->size())
      return badFile(place.file, "it holds " + std::to_string((*steps)->size()) +
                                     " steps, but step " + std::to_string(place.step) +
                                     " (from 0) should be there: it was cut off; export the case "
                                     "again");
    range = (**steps)[place.step];
  }
  Result<std::string> out = rangeOf(*file, range.begin, range.end);
  if (out && encoding.kind == EnSightEncoding::kText && !(*steps)->empty())
    out->erase(0, out->find('\n') + 1);  // the rest of the line of BEGIN TIME STEP
  if (out && encoding.kind == EnSightEncoding::kFortran)
    if (Status done = withoutRecordMarks(*out, place.file, *encoding.order); !done)
      return std::unexpected(done.error());
  return out;
}

std::int64_t ensightPartNumber(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_of("0123456789"), line.size()));
  std::int64_t number = 0;
  std::from_chars(line.data(), line.data() + line.size(), number);
  return number;
}

EnSightNumbers::EnSightNumbers(std::string_view bytes, const std::filesystem::path& file,
                               const EnSightEncoding& encoding, std::chrono::seconds patience)
    : bytes_(bytes), encoding_(encoding), in_(bytes, file) {
  in_.giveUpAfter(patience);
  in_.readsBytes(!isText());
}

void EnSightNumbers::endLine() {
  if (isWithinLine_) in_.line();
  isWithinLine_ = false;
}

bool EnSightNumbers::atEnd() { return isText() ? in_.atEnd() : failed() || in_.remaining() == 0; }

std::string_view EnSightNumbers::line() {
  if (isText()) {
    endLine();
    return in_.line();
  }
  const std::uint64_t at = in_.place();
  if (in_.remaining() < kLineBytes) {
    in_.fail(ErrorCode::kTruncated,
             "the file ends within a line of 80 bytes: it was cut off; copy "
             "or export it again");
    return {};
  }
  in_.seek(at + kLineBytes);
  if (failed()) return {};
  std::string_view out = bytes_.substr(at, kLineBytes);
  out = out.substr(0, out.find('\0'));
  out.remove_prefix(std::min(out.find_first_not_of(" \t\r\n"), out.size()));
  return out.substr(0, out.find_last_not_of(" \t\r\n") + 1);
}

std::string_view EnSightNumbers::keyword() {
  if (!isText()) {
    if (atEnd()) return {};
    const std::string_view found = line();
    if (found.empty())
      fail(
          "nothing is where a heading should be: the file is damaged, or has more numbers than the "
          "mesh");
    return found;
  }
  endLine();
  while (!atEnd())
    if (const std::string_view found = in_.line(); !found.empty() && found.front() != '#')
      return found;
  return {};
}

std::uint32_t EnSightNumbers::word(const char* what, bool isInteger) {
  const auto value = in_.raw<std::uint32_t>(what);
  if (isInteger && !encoding_.order && value != std::byteswap(value)) {
    constexpr std::endian kOther =
        std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
    encoding_.order = value < std::byteswap(value) ? std::endian::native : kOther;
  }
  return encoding_.order.value_or(std::endian::native) == std::endian::native
             ? value
             : std::byteswap(value);
}

/// The next integer's digits. Integers that fill their columns stand side by side.
std::string_view EnSightNumbers::digitsHere() {
  const std::string_view rest = in_.rest();
  const std::size_t sign = rest.starts_with('-') || rest.starts_with('+') ? 1 : 0;
  const std::size_t end = std::min(rest.find_first_not_of("0123456789", sign), rest.size());
  const std::size_t columns = encoding_.isGold ? 10 : 8;
  const std::size_t length = end > columns ? (end - 1) % columns + 1 : end;
  return rest.substr(0, length);
}

std::int64_t EnSightNumbers::integer(const char* what) {
  if (!isText()) return static_cast<std::int32_t>(word(what, true));
  std::string_view text = digitsHere();
  const std::size_t length = text.size();
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) {
    in_.number<std::int64_t>(what);  // which refuses it
    return 0;
  }
  in_.seek(in_.place() + length);
  isWithinLine_ = true;
  return value;
}

float EnSightNumbers::real(const char* what) {
  if (!isText()) return std::bit_cast<float>(word(what, false));
  std::string_view text = in_.rest();
  const std::size_t sign = text.starts_with('+') ? 1 : 0;
  text.remove_prefix(sign);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) {
    value = in_.number<double>(what);  // which refuses it, or takes it for 0 or infinite
    isWithinLine_ = true;
    return static_cast<float>(value);
  }
  in_.seek(in_.place() + sign + static_cast<std::size_t>(end - text.data()));
  isWithinLine_ = true;
  return static_cast<float>(value);
}

void EnSightNumbers::skipIntegers(std::uint64_t count) {
  if (!isText()) return in_.seek(in_.place() + count * bytesEach());
  for (std::uint64_t i = 0; i < count && !failed(); ++i) integer("an integer");
}

void EnSightNumbers::skipReals(std::uint64_t count) {
  if (!isText()) return in_.seek(in_.place() + count * bytesEach());
  for (std::uint64_t i = 0; i < count && !failed(); ++i) real("a number");
}

std::uint64_t EnSightNumbers::count(const char* what) {
  const std::int64_t value = integer(what);
  if (failed()) return 0;
  if (value < 0) {
    fail(std::to_string(value) + " is where " + what +
         " should be; the file is damaged, export it again");
    return 0;
  }
  return fits(static_cast<std::uint64_t>(value), what) ? static_cast<std::uint64_t>(value) : 0;
}

void EnSightNumbers::findOrder(std::uint64_t numbersEach) {
  if (isText() || encoding_.order || in_.remaining() < sizeof(std::uint32_t)) return;
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::uint64_t nodes = wordAt(bytes_, in_.place(), order), each = 4 * numbersEach;
    const std::uint64_t behind = in_.remaining() - sizeof(std::uint32_t);
    if (nodes == 0) return;  // in either order: what comes next decides
    if (nodes <= behind / each &&
        bytes_.substr(in_.place() + sizeof(std::uint32_t) + nodes * each).starts_with("part"))
      encoding_.order = order;
  }
}

}  // namespace qtet

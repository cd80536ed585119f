#include "simplify/read/vtu/vtu_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/coding/float_bits.h"
#include "simplify/read/vtu/array_bytes.h"

namespace qtet {
namespace {

/// Numbers that are decoded at once.
constexpr std::size_t kBatch = 8192;
/// Bytes of text that are read at once.
constexpr std::size_t kTextBytes = std::size_t{1} << 16;
/// A word of more characters is no number: a double's exact digits are 767 at most.
constexpr std::size_t kMaxWord = 1024;
/// Characters of a name or word that a message shows.
constexpr std::size_t kShown = 40;

template <class To, class From>
To converted(From value) {
  if constexpr (std::same_as<To, double> && std::same_as<From, float>) {
    return widened(value);
  } else if constexpr (std::floating_point<From> && std::integral<To>) {
    constexpr From kEnd = 9223372036854775808.0;  // 2^63
    return value >= -kEnd && value < kEnd ? static_cast<To>(value) : To{-1};
  } else {
    return static_cast<To>(value);
  }
}

/// Calls visit(T{}) with the type that the file's numbers have.
template <class Visit>
Status visitType(VtuNumber type, const Visit& visit) {
  switch (type) {
    case VtuNumber::kInt8: return visit(std::int8_t{});
    case VtuNumber::kBit:  // as text
    case VtuNumber::kUInt8: return visit(std::uint8_t{});
    case VtuNumber::kInt16: return visit(std::int16_t{});
    case VtuNumber::kUInt16: return visit(std::uint16_t{});
    case VtuNumber::kInt32: return visit(std::int32_t{});
    case VtuNumber::kUInt32: return visit(std::uint32_t{});
    case VtuNumber::kInt64: return visit(std::int64_t{});
    case VtuNumber::kUInt64: return visit(std::uint64_t{});
    case VtuNumber::kFloat32: return visit(float{});
    default: assert(type == VtuNumber::kFloat64); return visit(double{});
  }
}

template <class T>
T swapped(T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

/// Words between blanks in a range of the file, which ends where markup begins.
class Words {
 public:
  Words(const VtuFile& file, std::uint64_t begin, std::uint64_t end)
      : file_(file), at_(begin), end_(end) {}

  /// The next word, which lasts until the next call; empty: the end, or an error (status). One of
  /// more than kMaxWord characters is cut.
  std::string_view next() {
    word_.clear();
    while (true) {
      if (used_ == chunk_.size() && !refill()) return word_;
      const auto* const from = chunk_.data() + used_;
      const auto* const to = chunk_.data() + chunk_.size();
      if (word_.empty()) {
        const auto* const begin = std::find_if(from, to, [](char c) { return !isBlank(c); });
        used_ += static_cast<std::size_t>(begin - from);
        if (begin == to) continue;
        if (*begin == '<') return {};
        const auto* const end = std::find_if(begin, to, endsWord);
        used_ += static_cast<std::size_t>(end - begin);
        if (end != to) return {begin, end};
        word_.assign(begin, end);
      } else {
        const auto* const end = std::find_if(from, to, endsWord);
        used_ += static_cast<std::size_t>(end - from);
        if (word_.size() < kMaxWord) word_.append(from, end);
        if (end != to) return word_;
      }
    }
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  static bool isBlank(char c) { return static_cast<unsigned char>(c) <= ' '; }
  static bool endsWord(char c) { return isBlank(c) || c == '<'; }

  bool refill() {
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(kTextBytes, end_ - at_));
    if (bytes == 0 || !status_) return false;
    chunk_.resize(bytes);
    used_ = 0;
    status_ = file_.read(at_, std::as_writable_bytes(std::span(chunk_)));
    at_ += bytes;
    if (!status_) chunk_.clear();
    return status_.has_value();
  }

  const VtuFile& file_;
  std::uint64_t at_, end_;
  std::vector<char> chunk_;
  std::size_t used_ = 0;
  std::string word_;
  Status status_;
};

/// The word's number; nullopt: it is none of this type.
template <class T>
std::optional<T> numberOf(std::string_view word) {
  if (word.size() > kMaxWord) return std::nullopt;
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  // from_chars takes a second sign for none; nan, inf and infinity it knows, in either case
  if constexpr (std::integral<T>) {
    const std::size_t first = word.starts_with('-') ? 1 : 0;
    if (word.size() == first || word[first] < '0' || word[first] > '9') return std::nullopt;
  }
  T value{};
  const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
  if (read.ptr != word.data() + word.size()) return std::nullopt;
  if (read.ec == std::errc()) return value;
  if constexpr (std::floating_point<T>) {
    if (read.ec != std::errc::result_out_of_range) return std::nullopt;
    const double wide = std::strtod(std::string(word).c_str(), nullptr);
    if (std::abs(wide) < 1) return static_cast<T>(wide);  // too small
  }
  return std::nullopt;
}

class ArrayNumbers {
 public:
  ArrayNumbers(const VtuFile& file, const VtuDocument& document, const VtuArray& array)
      : file_(file), document_(document), array_(array) {}

  Result<std::uint64_t> certain(std::uint64_t told) {
    if (array_.type == VtuNumber::kText)
      return bad("holds no numbers where numbers are needed; export the mesh again");
    if (array_.place == VtuArray::Place::kAscii) {
      const std::uint64_t most = (array_.end - array_.begin + 1) / 2;
      return std::min(told, most);  // what is missing is counted as it is read
    }
    if (told == 0) return 0;
    Result<ArrayBytes> bytes = ArrayBytes::open(file_, document_, array_);
    if (!bytes) return std::unexpected(bytes.error());
    const std::uint64_t held = numbersIn(bytes->size());
    if (held < told)
      return bad("has " + std::to_string(held) + " numbers, but the file's counts say " +
                 std::to_string(told) + "; the file is damaged, export it again");
    return std::min(told, numbersIn(bytes->certain()));
  }

  template <class To>
  Status read(const NumberRange& range, const TakeNumbers<To>& take) {
    assert(range.first <= range.told && range.count <= range.told - range.first);
    if (const auto certainly = certain(range.told); !certainly)
      return std::unexpected(certainly.error());
    if (array_.type == VtuNumber::kBit && array_.place != VtuArray::Place::kAscii)
      return readBits<To>(range, take);
    return visitType(array_.type, [&]<class T>(T) {
      return array_.place == VtuArray::Place::kAscii ? readText<To, T>(range, take)
                                                     : readBytes<To, T>(range, take);
    });
  }

 private:
  [[nodiscard]] std::unexpected<Error> bad(const std::string& what) const {
    return file_.bad(array_.called() + " " + what, array_.begin);
  }

  /// How many numbers so many bytes hold.
  [[nodiscard]] std::uint64_t numbersIn(std::uint64_t bytes) const {
    if (array_.type != VtuNumber::kBit) return bytes / bytesOf(array_.type);
    return std::min(bytes, ~std::uint64_t{0} / 8) * 8;
  }

  /// Eight a byte, the highest first.
  template <class To>
  Status readBits(const NumberRange& range, const TakeNumbers<To>& take) {
    if (range.count == 0) return {};
    Result<ArrayBytes> bytes = ArrayBytes::open(file_, document_, array_);
    if (!bytes) return std::unexpected(bytes.error());
    std::vector<std::uint8_t> eights;
    std::vector<To> out;
    for (std::uint64_t at = range.first, end = at + range.count; at < end;) {
      const std::uint64_t last = std::min<std::uint64_t>(end, (at / 8 + kBatch / 8) * 8);
      eights.resize((last + 7) / 8 - at / 8);
      if (Status read = bytes->read(at / 8, std::as_writable_bytes(std::span(eights))); !read)
        return read;
      out.clear();
      for (const std::uint64_t begin = at / 8 * 8; at < last; ++at)
        out.push_back(static_cast<To>(eights[(at - begin) / 8] >> (7 - at % 8) & 1));
      take(out);
    }
    return {};
  }

  template <class To, class T>
  Status readBytes(const NumberRange& range, const TakeNumbers<To>& take) {
    if (range.count == 0) return {};
    Result<ArrayBytes> bytes = ArrayBytes::open(file_, document_, array_);
    if (!bytes) return std::unexpected(bytes.error());
    const bool isForeign = document_.isBigEndian != (std::endian::native == std::endian::big);
    std::vector<T> numbers;
    std::vector<To> out;
    for (std::uint64_t done = 0; done < range.count;) {
      const auto batch =
          static_cast<std::size_t>(std::min<std::uint64_t>(kBatch, range.count - done));
      numbers.resize(batch);
      if (Status read = bytes->read((range.first + done) * sizeof(T),
                                    std::as_writable_bytes(std::span(numbers)));
          !read)
        return read;
      if (isForeign) std::ranges::transform(numbers, numbers.begin(), swapped<T>);
      out.resize(batch);
      std::ranges::transform(numbers, out.begin(), converted<To, T>);
      take(out);
      done += batch;
    }
    return {};
  }

  /// Reads to the text's end, so that too many numbers are seen too.
  template <class To, class T>
  Status readText(const NumberRange& range, const TakeNumbers<To>& take) {
    Words words(file_, array_.begin, array_.end);
    std::vector<To> out;
    std::uint64_t numbers = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++numbers) {
      const std::optional<T> value = numberOf<T>(word);
      if (!value) return noNumber(word, numbers);
      if (numbers < range.first || numbers - range.first >= range.count) continue;
      out.push_back(converted<To>(*value));
      if (out.size() < kBatch) continue;
      take(out);
      out.clear();
    }
    if (!words.status()) return words.status();
    if (numbers != range.told)
      return badText("has " + std::to_string(numbers) + " numbers, but the file's counts say " +
                     std::to_string(range.told) + "; export the mesh again");
    take(out);
    return {};
  }

  [[nodiscard]] Status noNumber(std::string_view word, std::uint64_t before) const {
    return badText(
        "has '" + std::string(word.substr(0, kShown)) + "' behind its first " +
        std::to_string(before) +
        " numbers, which is no number of its type; correct it, or export the mesh again");
  }
  [[nodiscard]] std::unexpected<Error> badText(const std::string& what) const {
    return file_.bad("line " + std::to_string(array_.line) + ": the ascii array " +
                         array_.shortName().substr(0, kShown) + " " + what,
                     array_.begin);
  }

  const VtuFile& file_;
  const VtuDocument& document_;
  const VtuArray& array_;
};

}  // namespace

Result<std::uint64_t> certainNumbers(const VtuFile& file, const VtuDocument& document,
                                     const VtuArray& array, std::uint64_t told) {
  return ArrayNumbers(file, document, array).certain(told);
}

Status readReals(const VtuFile& file, const VtuDocument& document, const VtuArray& array,
                 const NumberRange& range, const TakeNumbers<double>& take) {
  return ArrayNumbers(file, document, array).read<double>(range, take);
}

Status readIntegers(const VtuFile& file, const VtuDocument& document, const VtuArray& array,
                    const NumberRange& range, const TakeNumbers<std::int64_t>& take) {
  return ArrayNumbers(file, document, array).read<std::int64_t>(range, take);
}

}  // namespace qtet

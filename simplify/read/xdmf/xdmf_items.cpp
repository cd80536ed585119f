#include "simplify/read/xdmf/xdmf_items.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "simplify/read/text/plain_numbers.h"

namespace qtet {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";
/// An item that refers to one within itself would have no end.
constexpr int kMaxItemDepth = 4;
/// A hyperslab has its first indices, steps and counts.
constexpr std::size_t kSlabRows = 3;

template <class T>
std::optional<T> numberAt(std::string_view text) {
  T value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc{} || read.ptr != text.data() + text.size())
    return std::nullopt;
  return value;
}

/// Cuts the first word off.
std::string_view wordOf(std::string_view& text) {
  text = xdmfTrimmed(text);
  const std::size_t end = std::min(text.find_first_of(kXmlBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

/// As MeshField's; by default XDMF's numbers are floats of four bytes.
std::string typeOf(const XmlElement& item) {
  std::string_view kind = item.attribute("NumberType");
  if (kind.empty()) kind = item.attribute("DataType");
  const std::string name = xdmfLower(kind);
  const std::uint64_t bytes =
      numberAt<std::uint64_t>(xdmfTrimmed(item.attribute("Precision"))).value_or(4);
  if (name == "char") return "int8";
  if (name == "uchar") return "uint8";
  if (name == "int" || name == "uint") {
    const bool isSize = bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
    return name + std::to_string(isSize ? 8 * bytes : 64);
  }
  return bytes == 8 ? "float64" : "float32";
}

/// "uniform" where the item says nothing. Older files have Type in place of ItemType.
std::string kindOf(const XmlElement& item) {
  std::string kind = xdmfLower(item.attribute("ItemType"));
  if (kind.empty() && xdmfLower(item.attribute("Type")) == "hyperslab") kind = "hyperslab";
  return kind.empty() ? "uniform" : kind;
}

/// Dimensions="12 3". Empty: no counts, or more than kMaxRank.
std::vector<std::uint64_t> dimensionsOf(const XmlElement& item) {
  std::vector<std::uint64_t> out;
  std::string_view text = item.attribute("Dimensions");
  for (std::string_view word = wordOf(text); !word.empty(); word = wordOf(text)) {
    const auto count = numberAt<std::uint64_t>(word);
    if (!count || out.size() == XdmfItems::kMaxRank) return {};
    out.push_back(*count);
  }
  return out;
}

bool isHdf(const XmlElement& item) { return xdmfLower(item.attribute("Format")) == "hdf"; }

/// The numbers that a hyperslab takes of an array, along each of its dimensions.
struct Slab {
  std::vector<std::uint64_t> first, step, count, of;

  [[nodiscard]] bool fits() const {
    for (std::size_t k = 0; k < of.size(); ++k) {
      std::uint64_t last = 0;
      if (count[k] == 0 || __builtin_mul_overflow(count[k] - 1, step[k], &last) ||
          __builtin_add_overflow(last, first[k], &last) || last >= of[k] ||
          (step[k] == 0 && count[k] > 1))
        return false;
    }
    return !of.empty();
  }
};

/// REQUIRES: slab.fits(), as many values as the product of slab.of says.
std::vector<double> taken(const Slab& slab, std::span<const double> values) {
  std::vector<double> out;
  std::vector<std::uint64_t> at(slab.of.size());
  for (;;) {
    std::uint64_t place = 0;
    for (std::size_t k = 0; k < at.size(); ++k)
      place = place * slab.of[k] + slab.first[k] + at[k] * slab.step[k];
    out.push_back(values[place]);
    std::size_t k = at.size();
    while (k > 0 && ++at[k - 1] == slab.count[k - 1]) at[--k] = 0;
    if (k == 0) return out;
  }
}

}  // namespace

std::string xdmfLower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string_view xdmfTrimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kXmlBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kXmlBlanks) - begin + 1);
}

std::unexpected<Error> XdmfItems::bad(const std::string& what) const {
  return fail(ErrorCode::kBadInput, path_.string() + ": " + what + "; export the mesh again");
}

const XmlElement* XdmfItems::resolved(const XmlElement& element) const {
  const std::string_view reference = element.attribute("Reference");
  if (reference.empty()) return &element;
  return firstAt(*root_, reference == "XML" ? xdmfTrimmed(element.text) : reference);
}

std::vector<const XmlElement*> XdmfItems::itemsOf(const XmlElement& element) const {
  std::vector<const XmlElement*> out;
  for (const auto& child : element.children)
    if (child->name == "DataItem") out.push_back(resolved(*child));
  return out;
}

bool XdmfItems::isReadable(const XmlElement* item, int depth) const {
  if (!item || depth == kMaxItemDepth) return false;
  const std::string kind = kindOf(*item), format = xdmfLower(item->attribute("Format"));
  if (kind == "hyperslab") {
    const auto within = itemsOf(*item);
    return within.size() == 2 && isReadable(within[0], depth + 1) && !isHdf(*within[0]) &&
           isReadable(within[1], depth + 1);
  }
  return kind == "uniform" && (format.empty() || format == "xml" || format == "hdf");
}

std::string XdmfItems::refusalOf(const XmlElement* item) const {
  if (!item) return "a Reference that leads nowhere";
  if (isReadable(item)) return {};
  if (const std::string kind = kindOf(*item); kind != "uniform")
    return "a DataItem of type " + kind.substr(0, 40);
  const std::string_view seek = xdmfTrimmed(item->attribute("Seek"));
  if (xdmfLower(item->attribute("Endian")) == "big" || (!seek.empty() && seek != "0"))
    return "a binary DataItem with Seek or big Endian";
  return {};
}

Result<XdmfNumbers> XdmfItems::fromHdf(std::string_view place, const Rows* rows,
                                       std::uint64_t ofRows) {
  place = xdmfTrimmed(place);
  const std::size_t colon = place.rfind(':');
  if (colon == std::string_view::npos)
    return bad("a DataItem names '" + std::string(place.substr(0, 80)) +
               "', which is no FILE.h5:ARRAY");
  const std::filesystem::path path = path_.parent_path() / place.substr(0, colon);
  auto file = files_.find(path);
  if (file == files_.end()) {
    std::error_code code;
    if (!std::filesystem::exists(path, code))
      return fail(ErrorCode::kNotFound, path_.string() + " names " + path.string() +
                                            ", which is not there; copy both files together");
    Result<HdfFile> opened = HdfFile::open(path);
    if (!opened) return std::unexpected(opened.error());
    file = files_.emplace(path, std::move(*opened)).first;
  }
  std::string name(place.substr(colon + 1));
  name.erase(0, name.find_first_not_of('/'));
  const auto array = file->second.array(name);
  if (!array) return std::unexpected(array.error());
  if (rows && array->rows != ofRows)
    return bad("the array " + name + " has " + std::to_string(array->rows) +
               " rows, but its DataItem says " + std::to_string(ofRows));
  const std::uint64_t first = rows ? rows->first : 0, count = rows ? rows->count : array->rows;
  Result<std::vector<double>> values = file->second.reals(*array, first, count);
  if (!values) return std::unexpected(values.error());
  return XdmfNumbers{std::move(*values), array->type, count, array->columns};
}

Result<XdmfNumbers> XdmfItems::fromText(const XmlElement& item) const {
  XdmfNumbers out;
  out.type = typeOf(item);
  std::string_view text = item.text;
  for (std::string_view word = wordOf(text); !word.empty(); word = wordOf(text)) {
    const std::optional<double> value = fortranReal(word);
    if (!value) return bad("'" + std::string(word.substr(0, 20)) + "' in a DataItem is no number");
    out.values.push_back(*value);
  }
  // Dimensions="12 3": the rows are the first
  const std::string_view dimensions = xdmfTrimmed(item.attribute("Dimensions"));
  const auto rows = numberAt<std::uint64_t>(dimensions.substr(0, dimensions.find(' ')));
  if (!rows || (*rows == 0) != out.values.empty() || (*rows > 0 && out.values.size() % *rows != 0))
    return bad("a DataItem with Dimensions '" + std::string(dimensions.substr(0, 40)) + "' has " +
               std::to_string(out.values.size()) + " numbers");
  out.rows = *rows;
  out.columns = *rows > 0 ? out.values.size() / *rows : 1;
  return out;
}

/// First an item of three rows: the first index, the step and the count of each dimension. Then the
/// array. Rows before and behind the slab are not read.
Result<XdmfNumbers> XdmfItems::slabOf(const XmlElement& item) {
  const auto within = itemsOf(item);
  const Result<XdmfNumbers> which = fromText(*within[0]);
  if (!which) return std::unexpected(which.error());
  const XmlElement& source = *within[1];
  const std::vector<double>& numbers = which->values;
  Slab slab;
  slab.of = dimensionsOf(source);
  const std::size_t rank = slab.of.size();
  const bool areIndices = std::ranges::all_of(
      numbers, [](double x) { return x >= 0 && x < 0x1p53 && x == std::floor(x); });
  if (rank == 0 || numbers.size() != kSlabRows * rank || !areIndices)
    return bad("a hyperslab has " + std::to_string(numbers.size()) +
               " indices, steps and counts, which are not three for each of the " +
               std::to_string(rank) + " Dimensions of its array");
  for (std::size_t k = 0; k < rank; ++k) {
    slab.first.push_back(static_cast<std::uint64_t>(numbers[k]));
    slab.step.push_back(static_cast<std::uint64_t>(numbers[rank + k]));
    slab.count.push_back(static_cast<std::uint64_t>(numbers[2 * rank + k]));
  }
  if (!slab.fits()) return bad("a hyperslab goes beyond its array, or takes nothing of it");
  Result<XdmfNumbers> from = XdmfNumbers{};
  if (isHdf(source) && kindOf(source) == "uniform") {
    const Rows rows{slab.first[0], (slab.count[0] - 1) * slab.step[0] + 1};
    from = fromHdf(source.text, &rows, slab.of[0]);
    slab.first[0] = 0;
    slab.of[0] = rows.count;
  } else {
    from = numbersOf(source);
  }
  if (!from) return from;
  std::uint64_t all = 1;
  bool fits = true;
  for (const std::uint64_t count : slab.of)
    fits = fits && !__builtin_mul_overflow(all, count, &all);
  if (!fits || all != from->values.size())
    return bad("the array of a hyperslab has other Dimensions than numbers");
  XdmfNumbers out{taken(slab, from->values), from->type, 0, 1};
  const std::vector<std::uint64_t> shape = dimensionsOf(item);
  out.rows = shape.empty() ? out.values.size() : shape[0];
  if (out.rows == 0 || out.values.size() % out.rows != 0)
    return bad("a hyperslab of " + std::to_string(out.values.size()) +
               " numbers has Dimensions that are none of it");
  out.columns = out.values.size() / out.rows;
  return out;
}

Result<XdmfNumbers> XdmfItems::numbersOf(const XmlElement& item) {
  if (kindOf(item) == "hyperslab") return slabOf(item);
  return isHdf(item) ? fromHdf(item.text, nullptr, 0) : fromText(item);
}

}  // namespace qtet

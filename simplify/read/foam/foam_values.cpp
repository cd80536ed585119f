// The numbers in a file of OpenFOAM: lists of tuples, and values of fields.
#include <algorithm>
#include <charconv>
#include <cstring>
#include <system_error>

#include "codec/coding/float_bits.h"
#include "simplify/read/foam/foam_list.h"
#include "simplify/read/text/mesh_scanner.h"

namespace qtet {

/// "(1 2 3)", or one number with or without parentheses.
Status FoamList::readTuple(std::span<double> out) {
  if (isLate()) return badHere(time_.text());
  const bool isOpen = take('(');
  if (!isOpen && out.size() != 1) return badHere("a tuple does not begin with (");
  for (double& value : out) {
    const std::string_view found = word();
    const auto read = std::from_chars(found.data(), found.data() + found.size(), value);
    if (read.ec == std::errc::result_out_of_range) value = MeshScanner::beyondRange(found);
    if (!found.empty() && read.ec != std::errc::invalid_argument &&
        read.ptr == found.data() + found.size())
      continue;
    at_ -= found.size();
    return badHere(shown(found) + " is not a number");
  }
  if (isOpen && !take(')'))
    return badHere("a tuple of " + std::to_string(out.size()) + " numbers does not end there");
  return {};
}

Status FoamList::readReals(std::span<double> out, std::uint32_t components) {
  if (!isBinary_) {
    for (std::size_t i = 0; i < out.size(); i += components)
      if (Status done = readTuple(out.subspan(i, components)); !done) return done;
    return {};
  }
  if (out.size() > (text_.size() - at_) / realBytes_) return badHere("a list is cut off");
  for (double& value : out) {
    float narrow = 0;
    if (realBytes_ == 8)
      std::memcpy(&value, text_.data() + at_, 8);
    else
      std::memcpy(&narrow, text_.data() + at_, 4), value = widened(narrow);
    at_ += realBytes_;
  }
  return {};
}

Result<std::vector<double>> FoamList::tuples(std::uint32_t components,
                                             std::optional<std::uint64_t> wanted) {
  const Result<Label> told = label();
  if (!told) return std::unexpected(told.error());
  const bool isUniform = take('{');
  const std::uint64_t bytesEach = isBinary_ ? components * realBytes_ : 2 * components;
  if (*told < 0 || (wanted && std::cmp_not_equal(*told, *wanted)))
    return badHere("it has " + std::to_string(*told) + " values" +
                   (wanted ? ", but the mesh needs " + std::to_string(*wanted) : ""));
  const auto values = static_cast<std::uint64_t>(*told);
  if (!(isUniform && wanted) && values > (text_.size() - at_) / bytesEach)
    return badHere("a list of " + std::to_string(values) +
                   " does not fit into the rest of the file");
  std::vector<double> out(values * components);
  if (isUniform) {
    std::vector<double> one(components);
    if (Status done = readTuple(one); !done) return std::unexpected(done.error());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = one[i % components];
    if (!take('}')) return badHere("a list N{VALUE} does not end");
    return out;
  }
  const bool isOpen = take('(');
  if (!isOpen && values > 0) return badHere("a list does not begin with (");
  if (Status done = readReals(out, components); !done) return std::unexpected(done.error());
  if (isOpen && !take(')'))
    return badHere("a list of " + std::to_string(values) + " does not end there");
  return out;
}

/// Passes the entries of the file up to the value of this one.
bool FoamList::find(std::string_view key) {
  std::size_t depth = 0;
  bool isFirst = true;  // of an entry
  for (std::string_view found = word(); !found.empty(); found = word()) {
    if (isFirst && depth == 0 && found == key) return true;
    if (found == "{" || found == "(") ++depth;
    if ((found == "}" || found == ")") && depth > 0) --depth;
    isFirst = found == ";" || found == "}";
    // an entry such as #include ends with its line
    if (found.starts_with('#')) {
      at_ = std::min(text_.find('\n', at_), text_.size());
      isFirst = true;
    }
    if (isLate()) return false;
  }
  return false;
}

Result<std::optional<std::vector<double>>> FoamList::field(std::string_view key,
                                                           std::uint32_t components,
                                                           std::uint64_t count) {
  if (!find(key)) return bad(time_.isOver() ? time_.text() : "it has no entry " + std::string(key));
  const std::size_t begin = at_;
  const std::string kind(word());
  std::vector<double> out;
  const std::size_t end =
      kind == "nonuniform" ? text_.find_first_not_of(" \t\r\n", at_) + 1 : text_.find(';', begin);
  if (std::string_view(text_).substr(begin, end - begin).find_first_of("$#") !=
      std::string_view::npos)
    return std::nullopt;
  if (kind == "uniform") {
    std::vector<double> one(components);
    if (Status done = readTuple(one); !done) return std::unexpected(done.error());
    out.resize(count * components);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = one[i % components];
  } else if (kind == "nonuniform") {
    const std::size_t list = at_;
    if (!word().starts_with("List<")) at_ = list;
    Result<std::vector<double>> values = tuples(components, count);
    if (!values) return std::unexpected(values.error());
    out = std::move(*values);
  } else {
    return badHere(shown(kind) + " is neither uniform nor nonuniform");
  }
  if (!take(';')) return badHere("the entry " + std::string(key) + " does not end there");
  return out;
}

}  // namespace qtet

#include "simplify/read/ensight/ensight_values.h"

#include <array>
#include <limits>

#include "codec/coding/float_bits.h"

namespace qtet {
namespace {

/// A symmetric tensor's components in the file (11, 22, 33, 12, 13, 23) have these places in VTK's
/// order, in which fields have them: xx, yy, zz, xy, yz, xz.
constexpr std::array<std::uint64_t, 6> kSymmetricOrder{0, 1, 2, 3, 5, 4};

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

class ValueReader {
 public:
  ValueReader(std::string_view bytes, const std::filesystem::path& file,
              const EnSightVariable& variable, const EnSightGeometry& geometry,
              EnSightBounds& bounds)
      : in_(bytes, file, geometry.encoding, bounds.patience),
        variable_(variable),
        geometry_(geometry),
        room_(bounds.room),
        values_(geometry.blocks.size()) {}

  Result<std::vector<std::vector<double>>> read() {
    in_.line();  // its description
    if (!in_.failed() && !geometry_.encoding.isGold && !variable_.isOfElements) {
      // in EnSight 6 those of the nodes that all parts share come first, and have no heading
      if (const std::uint64_t nodes = geometry_.blocks.front().mesh.points.size(); nodes > 0)
        take("", 0, {0, nodes}, "the nodes of all parts");
    }
    std::string_view next = in_.failed() ? "" : in_.keyword();
    while (!in_.failed() && !next.empty()) {
      if (!next.starts_with("part")) {
        refuse(next, "\"part\"");
        break;
      }
      next = part(next);
    }
    if (in_.failed()) return in_.error();
    if (!isTaken_) in_.fail("it has no values: it was cut off, or is of another mesh");
    if (in_.failed()) return in_.error();
    return std::move(values_);
  }

 private:
  void refuse(std::string_view found, const std::string& what) {
    std::string shown(found.substr(0, kShown));
    for (char& c : shown) c = c < ' ' || c > '~' ? '?' : c;
    in_.fail("'" + shown + "' is where " + what +
             " should be: it is damaged, or has more values than the mesh");
  }

  /// Reads the values of a part behind its keyword. Gives the keyword behind them.
  std::string_view part(std::string_view keyword) {
    const std::int64_t number =
        geometry_.encoding.isGold ? in_.integer("a part's number") : ensightPartNumber(keyword);
    if (in_.failed()) return {};
    const auto at = geometry_.parts.find(number);
    const std::string which = "part " + std::to_string(number);
    if (at == geometry_.parts.end()) {
      in_.fail("it has values of " + which + ", which the geometry has not");
      return {};
    }
    std::string_view next = in_.keyword();
    while (!in_.failed() && !next.empty() && !next.starts_with("part")) {
      const std::string line(next);
      const std::string kind = line.substr(0, line.find_first_of(" \t"));
      const EnSightPart& of = at->second;
      if (variable_.isOfElements) {
        const auto elements = of.elements.find(kind);
        if (elements == of.elements.end()) {
          refuse(line, "a kind of elements that " + which + " has");
        } else {
          take(line, of.block, elements->second, kind + " of " + which);
        }
      } else if (kind == (of.isGrid ? "block" : "coordinates")) {
        take(line, of.block, {0, geometry_.blocks[of.block].mesh.points.size()},
             "the nodes of " + which);
      } else {
        refuse(line, of.isGrid ? "\"block\"" : "\"coordinates\"");
      }
      if (!in_.failed()) next = in_.keyword();
    }
    return next;
  }

  /// The values behind a heading such as "tetra4" or "coordinates undef".
  void take(const std::string& heading, std::size_t block, const EnSightElements& rows,
            const std::string& whose) {
    const bool hasUndefined = heading.contains(" undef"), isPartial = heading.contains(" partial");
    const float undefined = hasUndefined ? in_.real("the undefined value") : 0;
    std::vector<std::uint64_t> listed;
    if (isPartial) listed = list(rows.count, whose);
    const std::uint64_t tuples = isPartial ? listed.size() : rows.count, n = variable_.components;
    if (in_.failed() || !areThere(tuples * n, whose)) return;
    isTaken_ = true;
    const CellMesh& mesh = geometry_.blocks[block].mesh;
    if (mesh.cells() == 0) return in_.skipReals(tuples * n);
    std::vector<double>& to = values_[block];
    if (to.empty() && !makeRoom(to, block)) return;
    const bool isInterleaved = !geometry_.encoding.isGold && !heading.starts_with("block");
    std::uint64_t done = 0;
    const auto put = [&](std::uint64_t tuple, std::uint64_t component) {
      if (in_.isText() && in_.atEnd()) cutOff(done, tuples * n, whose);
      const float value = in_.real("a value");
      const std::uint64_t row = rows.firstRow + (isPartial ? listed[tuple] : tuple);
      const std::uint64_t place = n == 6 ? kSymmetricOrder[component] : component;
      to[row * n + place] = hasUndefined && value == undefined ? kMissing : widened(value);
      ++done;
    };
    const std::uint64_t outer = isInterleaved ? tuples : n, inner = isInterleaved ? n : tuples;
    for (std::uint64_t i = 0; i < outer; ++i)
      for (std::uint64_t j = 0; j < inner && !in_.failed(); ++j)
        isInterleaved ? put(i, j) : put(j, i);
  }

  std::vector<std::uint64_t> list(std::uint64_t count, const std::string& whose) {
    std::vector<std::uint64_t> out(in_.count("the number of values"));
    for (std::uint64_t& place : out) {
      const std::int64_t number = in_.integer("the number of a value");
      if (!in_.failed() && (number < 1 || static_cast<std::uint64_t>(number) > count))
        in_.fail("it has a value of number " + std::to_string(number) + " of the " +
                 std::to_string(count) + " of " + whose);
      place = static_cast<std::uint64_t>(number) - 1;
      if (in_.failed()) return out;
    }
    return out;
  }

  bool areThere(std::uint64_t count, const std::string& whose) {
    if (in_.isText() || count <= in_.room()) return true;
    cutOff(in_.room(), count, whose);
    return false;
  }

  void cutOff(std::uint64_t found, std::uint64_t count, const std::string& whose) {
    in_.fail("it has " + std::to_string(found) + " of the " + std::to_string(count) +
             " values of " + whose + ": it was cut off, or is of another mesh");
  }

  bool makeRoom(std::vector<double>& to, std::size_t block) {
    const EnSightBlock& from = geometry_.blocks[block];
    const std::uint64_t count =
        (variable_.isOfElements ? from.elements : from.mesh.points.size()) * variable_.components;
    if (count > room_ / sizeof(double)) {
      in_.fail(
          "the variables' values do not fit in this machine's memory; name those that are "
          "needed by `fields`");
      return false;
    }
    room_ -= count * sizeof(double);
    to.assign(count, kMissing);
    return true;
  }

  static constexpr std::size_t kShown = 40;  ///< characters of the file that an error quotes

  EnSightNumbers in_;
  const EnSightVariable& variable_;
  const EnSightGeometry& geometry_;
  std::uint64_t& room_;
  bool isTaken_ = false;  ///< some values were there, if only of parts without volumes
  std::vector<std::vector<double>> values_;
};

}  // namespace

Result<std::vector<std::vector<double>>> readEnSightValues(std::string_view bytes,
                                                           const std::filesystem::path& file,
                                                           const EnSightVariable& variable,
                                                           const EnSightGeometry& geometry,
                                                           EnSightBounds& bounds) {
  return ValueReader(bytes, file, variable, geometry, bounds).read();
}

}  // namespace qtet

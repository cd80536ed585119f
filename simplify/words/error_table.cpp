#include "simplify/words/error_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "simplify/words/columns.h"
#include "simplify/words/printable.h"

namespace qtet {
namespace {

constexpr int kLevelWidth = 5, kCountWidth = 12, kPercentWidth = 8;
/// Below this many per cent, zeros behind the point would hide how small it is.
constexpr double kMinPlain = 0.001;

/// A heading over two columns of figures, at the right like them.
void heading(std::ostream& out, const std::string& text, std::size_t width) {
  const std::string name = printable(text);
  out << std::string(width - std::min(width, textWidth(name)), ' ') << name;
}

/// Two columns, wider where the field's name needs it.
std::size_t fieldWidth(const ManifestField& field) {
  return std::max<std::size_t>(2 * kPercentWidth, textWidth(printable(field.name)) + 2);
}

bool isKnown(const ManifestLevel& level) { return level.error.has_value(); }

/// Numbers of the levels to show, ascending. Some of them are such with a known error, if any is.
std::vector<std::size_t> shownLevels(const Manifest& manifest, std::size_t most) {
  std::vector<std::size_t> out;
  const bool hasErrors = std::ranges::any_of(manifest.levels, isKnown);
  const std::size_t count = manifest.levels.size();
  const auto scale = [&](std::size_t level) {
    return std::log2(1.0 + manifest.levels[level].tetrahedra);
  };
  const double low = scale(0),
               step = most > 1 ? (scale(count - 1) - low) / static_cast<double>(most - 1) : 0;
  for (std::size_t level = 0; level < count; ++level)
    if (count <= most || level + 1 == count ||
        (scale(level) >= low + step * static_cast<double>(out.size()) &&
         isKnown(manifest.levels[level]) == hasErrors))
      out.push_back(level);
  return out;
}

/// The columns of fields [first, last) of the levels' errors.
class FieldColumns {
 public:
  FieldColumns(const Manifest& manifest, std::size_t first, std::size_t last)
      : manifest_(manifest), first_(first), last_(last) {}

  void names(std::ostream& out) const {
    each([&](std::size_t f, std::size_t width) { heading(out, manifest_.fields[f].name, width); });
  }
  void kinds(std::ostream& out) const {
    each([&](std::size_t f, std::size_t width) {
      if (labelNamesOf(manifest_, f))
        pair(out, width, "wrong %", "");
      else
        pair(out, width, "rms %", "max %");
    });
  }
  void values(std::ostream& out, const LevelError& error) const {
    each([&](std::size_t f, std::size_t width) {
      pair(out, width, percentCell(error.fields[f].rms),
           labelNamesOf(manifest_, f) ? "" : percentCell(error.fields[f].max));
    });
  }

 private:
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t f = first_; f < last_; ++f) visit(f, fieldWidth(manifest_.fields[f]));
  }
  static void pair(std::ostream& out, std::size_t width, const std::string& a,
                   const std::string& b) {
    out << std::setw(static_cast<int>(width) - kPercentWidth) << a << std::setw(kPercentWidth) << b;
  }

  const Manifest& manifest_;
  std::size_t first_, last_;
};

/// The field behind the last for which `room` columns are left; one at least if `atLeastOne`.
std::size_t lastThatFits(const Manifest& manifest, std::size_t first, std::size_t end,
                         std::size_t used, bool atLeastOne) {
  std::size_t last = first;
  for (; last < end; ++last) {
    used += fieldWidth(manifest.fields[last]);
    if (used > kLineColumns && !(atLeastOne && last == first)) break;
  }
  return last;
}

}  // namespace

std::string percentCell(double fraction) {
  const double percent = 100 * fraction;
  std::ostringstream out;
  if (percent != 0 && percent < kMinPlain) {
    out << std::scientific << std::setprecision(1) << percent;
    return out.str();
  }
  if (percent == 0) return "0";
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(percent))), 0, 5);
  out << std::fixed << std::setprecision(decimals) << percent;
  return out.str();
}

std::string levelTable(const Manifest& manifest, const nlohmann::ordered_json& levels,
                       std::size_t most, std::size_t mostFields) {
  const bool hasErrors = std::ranges::any_of(manifest.levels, isKnown);
  const std::size_t end = std::min(mostFields, manifest.fields.size());
  const std::vector<std::size_t> rows = shownLevels(manifest, most);
  std::ostringstream out;
  std::size_t shown =
      lastThatFits(manifest, 0, end, kLevelWidth + 4 * kCountWidth + 4 * kPercentWidth, false);
  const FieldColumns beside(manifest, 0, shown);
  if (hasErrors) {
    out << std::string(kLevelWidth + 4 * kCountWidth, ' ');
    heading(out, "boundary, %", 2 * kPercentWidth);
    heading(out, "volume, %", 2 * kPercentWidth);
    beside.names(out);
    out << "\n";
  }
  out << "level" << std::setw(kCountWidth) << "tetrahedra" << std::setw(kCountWidth) << "vertices"
      << std::setw(kCountWidth) << "bytes" << std::setw(kCountWidth) << "cumulative";
  if (hasErrors) {
    out << std::setw(kPercentWidth) << "mean" << std::setw(kPercentWidth) << "max"
        << std::setw(kPercentWidth) << "lost" << std::setw(kPercentWidth) << "gained";
    beside.kinds(out);
  }
  out << "\n";
  std::uint64_t before = 0;
  for (const std::size_t row : rows) {
    const ManifestLevel& level = manifest.levels[row];
    const auto cumulative = levels[level.level]["cumulativeBytes"].get<std::uint64_t>();
    out << std::setw(kLevelWidth) << level.level << std::setw(kCountWidth)
        << grouped(level.tetrahedra) << std::setw(kCountWidth) << grouped(level.vertices)
        << std::setw(kCountWidth) << grouped(cumulative - std::exchange(before, cumulative))
        << std::setw(kCountWidth) << grouped(cumulative);
    if (level.error) {
      out << std::setw(kPercentWidth) << percentCell(level.error->boundaryMean())
          << std::setw(kPercentWidth) << percentCell(level.error->boundaryDistance())
          << std::setw(kPercentWidth) << percentCell(level.error->volumeLost)
          << std::setw(kPercentWidth) << percentCell(level.error->volumeGained);
      beside.values(out, *level.error);
    }
    out << "\n";
  }
  while (hasErrors && shown < end) {
    const std::size_t first = shown;
    shown = lastThatFits(manifest, first, end, kLevelWidth, true);
    const FieldColumns fields(manifest, first, shown);
    out << "\n" << std::string(kLevelWidth, ' ');
    fields.names(out);
    out << "\nlevel";
    fields.kinds(out);
    out << "\n";
    for (const std::size_t row : rows) {
      const ManifestLevel& level = manifest.levels[row];
      if (!level.error) continue;
      out << std::setw(kLevelWidth) << level.level;
      fields.values(out, *level.error);
      out << "\n";
    }
  }
  return out.str();
}

}  // namespace qtet

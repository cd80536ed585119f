#include "simplify/commands/error_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "simplify/commands/printable.h"

namespace qtet {
namespace {

constexpr int kCountWidth = 12, kPercentWidth = 10;
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

/// Numbers of the levels to show, ascending.
std::vector<std::size_t> shownLevels(const Manifest& manifest, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = manifest.levels.size();
  const auto scale = [&](std::size_t level) {
    return std::log2(1.0 + manifest.levels[level].tetrahedra);
  };
  const double low = scale(0),
               step = most > 1 ? (scale(count - 1) - low) / static_cast<double>(most - 1) : 0;
  for (std::size_t level = 0; level < count; ++level)
    if (count <= most || level + 1 == count ||
        scale(level) >= low + step * static_cast<double>(out.size()))
      out.push_back(level);
  return out;
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
                       std::size_t most) {
  const bool hasErrors = std::ranges::any_of(
      manifest.levels, [](const ManifestLevel& level) { return level.error.has_value(); });
  std::ostringstream out;
  if (hasErrors) {
    out << std::string(5 + 4 * kCountWidth, ' ');
    heading(out, "boundary, %", 2 * kPercentWidth);
    heading(out, "volume", kPercentWidth);
    for (const ManifestField& field : manifest.fields) heading(out, field.name, fieldWidth(field));
    out << "\n";
  }
  out << "level" << std::setw(kCountWidth) << "tetrahedra" << std::setw(kCountWidth) << "vertices"
      << std::setw(kCountWidth) << "bytes" << std::setw(kCountWidth) << "cumulative";
  if (hasErrors) {
    out << std::setw(kPercentWidth) << "mean" << std::setw(kPercentWidth) << "max"
        << std::setw(kPercentWidth) << "%";
    for (const ManifestField& field : manifest.fields)
      out << std::setw(static_cast<int>(fieldWidth(field)) - kPercentWidth) << "rms %"
          << std::setw(kPercentWidth) << "max %";
  }
  out << "\n";
  std::uint64_t before = 0;
  for (const std::size_t shown : shownLevels(manifest, most)) {
    const ManifestLevel& level = manifest.levels[shown];
    const auto cumulative = levels[level.level]["cumulativeBytes"].get<std::uint64_t>();
    out << std::setw(5) << level.level << std::setw(kCountWidth) << grouped(level.tetrahedra)
        << std::setw(kCountWidth) << grouped(level.vertices) << std::setw(kCountWidth)
        << grouped(cumulative - std::exchange(before, cumulative)) << std::setw(kCountWidth)
        << grouped(cumulative);
    if (level.error) {
      out << std::setw(kPercentWidth) << percentCell(level.error->boundaryMean())
          << std::setw(kPercentWidth) << percentCell(level.error->boundaryDistance())
          << std::setw(kPercentWidth) << std::fixed << std::setprecision(3)
          << 100 * level.error->volumeKept;
      for (std::size_t f = 0; f < manifest.fields.size(); ++f)
        out << std::setw(static_cast<int>(fieldWidth(manifest.fields[f])) - kPercentWidth)
            << percentCell(level.error->fields[f].rms) << std::setw(kPercentWidth)
            << percentCell(level.error->fields[f].max);
    }
    out << "\n";
  }
  return out.str();
}

}  // namespace qtet

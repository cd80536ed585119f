#include "tests/bench/parts/error_plot.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "codec/files/file_names.h"

namespace qtet {
namespace {

// All lengths in pixels of the picture.
constexpr double kLeft = 76, kTop = 56, kPlotWidth = 560, kPlotHeight = 320,
                 kLegendX = kLeft + kPlotWidth + 24, kLegendStroke = 34, kCharacter = 7.5,
                 kRow = 22, kBelow = 60;

/// Middle tones, apart from one another on white and on black, also for most who see few colours
/// (after Okabe & Ito).
constexpr std::array kColours = {"#e69f00", "#3a9bdc", "#00a37a", "#d55e00",
                                 "#c774a8", "#8a7fd8", "#a59a10"};
/// Errors this far below the largest are not worth the room that a logarithmic axis gives them.
constexpr double kShown = 1e-5;

/// If there are more curves than colours, the strokes change.
constexpr std::array kDashes = {"none", "7 3", "2 3", "9 3 2 3"};

/// Part of a logarithmic axis: whole decades, or the 1-2-5 steps round what is shown where that is
/// less than two.
struct LogAxis {
  double low = 1, high = 10;

  static LogAxis around(double least, double most) {
    LogAxis axis;
    axis.low = std::pow(10, std::floor(std::log10(least)));
    axis.high = std::pow(10, std::ceil(std::log10(most)));
    if (!(axis.high > axis.low)) axis.high = axis.low * 10;
    for (const double step : {5.0, 2.0}) {
      if (axis.high / axis.low > 1000) break;
      if (axis.low * step <= least) axis.low *= step;
      if (axis.high / step >= most && axis.high / step > axis.low) axis.high /= step;
    }
    return axis;
  }
  [[nodiscard]] double part(double value) const {
    return std::log10(value / low) / std::log10(high / low);
  }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> out;
    const bool isLong = high / low > 1000;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high * 1.001;
         decade *= 10)
      for (const double step : {1.0, 2.0, 5.0})
        if (const double tick = decade * step;
            tick >= low * 0.999 && tick <= high * 1.001 && (step == 1 || !isLong))
          out.push_back(tick);
    return out;
  }
};

std::string number(double value) {
  std::ostringstream out;
  out << std::setprecision(5) << value;
  return out.str();
}

std::string bytesText(double bytes) {
  if (bytes < 1e3) return number(bytes) + " B";
  if (bytes < 1e6) return number(bytes / 1e3) + " kB";
  if (bytes < 1e9) return number(bytes / 1e6) + " MB";
  return number(bytes / 1e9) + " GB";
}

class ErrorPlot {
 public:
  explicit ErrorPlot(const std::vector<ErrorCurve>& curves) : curves_(curves) {
    double leastX = HUGE_VAL, mostX = 0, leastY = HUGE_VAL, mostY = 0;
    for (const ErrorCurve& curve : curves)
      for (const ErrorPlotPoint& p : curve.points) {
        longest_ = std::max(longest_, curve.name.size());
        leastX = std::min(leastX, p.bytes), mostX = std::max(mostX, p.bytes);
        if (p.error > 0) leastY = std::min(leastY, p.error), mostY = std::max(mostY, p.error);
      }
    x_ = LogAxis::around(leastX, mostX);
    y_ = mostY > 0 ? LogAxis::around(std::max(leastY, mostY * kShown), mostY) : LogAxis{0.001, 1};
  }

  std::string svg(const std::string& title) {
    const double plotBottom = kTop + kPlotHeight,
                 legendBottom = kTop + kRow * static_cast<double>(curves_.size());
    const double width =
                     kLegendX + kLegendStroke + kCharacter * static_cast<double>(longest_) + kRow,
                 height = std::max(plotBottom, legendBottom) + kBelow;
    out_ << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" << width << " " << height
         << R"(" width=")" << width << R"(" height=")" << height << R"(" role="img">
<title>)" << xmlText(title)
         << R"(</title>
<style>
  svg { color: #24292f; font: 12px system-ui, "DejaVu Sans", sans-serif; }
  .ground { fill: #fff; }
  text { fill: currentColor; }
  .quiet { fill-opacity: .7; }
  .title { font-size: 15px; font-weight: 600; }
  .grid { stroke: currentColor; stroke-opacity: .13; }
  .frame { fill: none; stroke: currentColor; stroke-opacity: .5; }
  .curve { fill: none; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
  .boundary { stroke: currentColor; }
  @media (prefers-color-scheme: dark) { svg { color: #e6e6e6; } .ground { fill: #16181c; } }
</style>
<rect class="ground" width="100%" height="100%"/>
)";
    text(kLeft, kTop - 28, "title", "start", title);
    text(kLeft, kTop - 10, "quiet", "start",
         "error against the original (log), over the bytes read (log)");
    axes();
    for (std::size_t i = 0; i < curves_.size(); ++i) curve(i);
    out_ << "</svg>\n";
    return out_.str();
  }

 private:
  [[nodiscard]] double xOf(double bytes) const { return kLeft + kPlotWidth * x_.part(bytes); }
  /// A value that is too small for the axis, above all 0, lies on the axis' end.
  [[nodiscard]] double yOf(double error) const {
    return kTop + kPlotHeight * (1 - y_.part(std::max(error, y_.low)));
  }

  void text(double x, double y, const char* kind, const char* anchor, const std::string& words) {
    out_ << "<text class=\"" << kind << "\" x=\"" << number(x) << "\" y=\"" << number(y)
         << "\" text-anchor=\"" << anchor << "\">" << xmlText(words) << "</text>\n";
  }

  void line(double x1, double y1, double x2, double y2) {
    out_ << "<path class=\"grid\" d=\"M" << number(x1) << " " << number(y1) << "L" << number(x2)
         << " " << number(y2) << "\"/>\n";
  }

  void axes() {
    for (const double tick : x_.ticks()) {
      line(xOf(tick), kTop, xOf(tick), kTop + kPlotHeight);
      text(xOf(tick), kTop + kPlotHeight + 18, "quiet", "middle", bytesText(tick));
    }
    for (const double tick : y_.ticks()) {
      line(kLeft, yOf(tick), kLeft + kPlotWidth, yOf(tick));
      text(kLeft - 8, yOf(tick) + 4, "quiet", "end", number(100 * tick) + " %");
    }
    out_ << "<rect class=\"frame\" x=\"" << kLeft << "\" y=\"" << kTop << "\" width=\""
         << kPlotWidth << "\" height=\"" << kPlotHeight << "\"/>\n";
    text(kLeft + kPlotWidth / 2, kTop + kPlotHeight + 40, "quiet", "middle", "bytes read");
  }

  /// The boundary in the colour of the text, fields in colours, each with its line in the legend.
  void curve(std::size_t index) {
    const ErrorCurve& curve = curves_[index];
    std::ostringstream style;
    if (curve.isBoundary) {
      style << "class=\"curve boundary\" stroke-dasharray=\"" << (plain_++ == 0 ? "none" : "5 4")
            << "\"";
    } else {
      const std::size_t field = coloured_++;
      style << "class=\"curve\" stroke=\"" << kColours[field % kColours.size()]
            << "\" stroke-dasharray=\"" << kDashes[field / kColours.size() % kDashes.size()]
            << "\"";
    }
    out_ << "<path " << style.str() << " d=\"";
    for (std::size_t i = 0; i < curve.points.size();
         ++i) {  // steps: a level stands until the bytes of a finer one are there
      const ErrorPlotPoint& p = curve.points[i];
      if (i == 0)
        out_ << "M" << number(xOf(p.bytes)) << " " << number(yOf(p.error));
      else
        out_ << "H" << number(xOf(p.bytes)) << "V" << number(yOf(p.error));
    }
    const double y = kTop + kRow * (static_cast<double>(index) + 0.5);
    out_ << "\"/>\n<path " << style.str() << " d=\"M" << kLegendX << " " << y << "h26\"/>\n";
    text(kLegendX + kLegendStroke, y + 4, "name", "start", curve.name);
  }

  const std::vector<ErrorCurve>& curves_;
  LogAxis x_, y_;
  std::size_t coloured_ = 0, plain_ = 0, longest_ = 0;
  std::ostringstream out_;
};

}  // namespace

std::string errorPlotSvg(const std::string& title, const std::vector<ErrorCurve>& curves) {
  assert(!curves.empty());
  return ErrorPlot(curves).svg(title);
}

}  // namespace qtet

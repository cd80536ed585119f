#include "simplify/words/progress.h"

#include <algorithm>
#include <cmath>

namespace qtet {
namespace {

constexpr std::chrono::milliseconds kSilence{1000};
constexpr std::chrono::milliseconds kRedraw{100};
/// Between two lines where there is no terminal.
constexpr std::chrono::seconds kLineInterval{2};
constexpr int kBarCells = 30;
/// The fraction of a stage that must be done before its end is foretold.
constexpr double kEnoughToSay = 0.05;

}  // namespace

Progress::Progress(const Console& console)
    : out_(console.err),
      onTerminal_(console.errIsTerminal),
      quiet_(console.quiet),
      verbose_(console.verbose) {}

Progress::~Progress() {
  clear();
  endStage();
}

void Progress::endStage() {
  if (!verbose_ || stage_.empty()) return;
  clear();
  const auto spent =
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - stageStart_);
  out_ << "qtet: " << stage_ << ": " << static_cast<double>(spent.count()) / 1000 << " s\n"
       << std::flush;
}

void Progress::stage(std::string_view name) {
  endStage();
  stage_ = printable(name);
  stageStart_ = Clock::now();
  if (onTerminal_) lastDrawn_ = {};
  update(0);
}

bool Progress::isDue() {
  const Clock::time_point now = Clock::now();
  if (quiet_ || now - start_ < kSilence) return false;
  if (now - lastDrawn_ < (onTerminal_ ? Clock::duration(kRedraw) : Clock::duration(kLineInterval)))
    return false;
  lastDrawn_ = now;
  return true;
}

void Progress::update(double fraction) {
  if (!isDue()) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (onTerminal_) return drawBar(fraction);
  out_ << "qtet: " << stage_ << ": " << static_cast<int>(fraction * 100) << " %"
       << timeLeft(fraction) << "\n"
       << std::flush;
}

void Progress::working() {
  if (!isDue()) return;
  const std::string line =
      stage_ + ": " +
      std::to_string(
          std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - stageStart_).count()) +
      " s";
  if (onTerminal_) return draw(line);
  out_ << "qtet: " << line << "\n" << std::flush;
}

/// The time that the stage still takes if it goes on as it did; empty while too little of it is
/// done to say.
std::string Progress::timeLeft(double fraction) const {
  const double spent = std::chrono::duration<double>(Clock::now() - stageStart_).count();
  if (fraction < kEnoughToSay || fraction >= 1) return {};
  return ", about " + std::to_string(std::lround(spent * (1 - fraction) / fraction + 0.5)) +
         " s left";
}

void Progress::drawBar(double fraction) {
  const int full = static_cast<int>(std::lround(fraction * kBarCells));
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count();
  std::string line = stage_ + " [" + std::string(static_cast<std::size_t>(full), '#') +
                     std::string(static_cast<std::size_t>(kBarCells - full), '.') + "] " +
                     std::to_string(static_cast<int>(fraction * 100)) + " %  " +
                     std::to_string(seconds) + " s" + timeLeft(fraction);
  draw(std::move(line));
}

void Progress::draw(std::string line) {
  const std::size_t length = line.size();
  if (length < barLength_) line.append(barLength_ - length, ' ');
  barLength_ = length;
  out_ << '\r' << line << std::flush;
}

void Progress::clear() {
  if (barLength_ == 0) return;
  out_ << '\r' << std::string(barLength_, ' ') << '\r' << std::flush;
  barLength_ = 0;
}

}  // namespace qtet

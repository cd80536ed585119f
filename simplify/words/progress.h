// Shows how far a long command has come, for the person who waits. It is a bar on a terminal, a
// line now and then in a log file.
#pragma once

#include <chrono>
#include <ostream>
#include <string>

#include "simplify/words/console.h"

namespace qtet {

/// Writes to `out` only, and nothing at all in the first second: quick commands stay silent.
class Progress {
 public:
  /// Draws a bar where the console's `err` is a terminal, nothing if it is quiet. If it is verbose,
  /// reports how long each stage took.
  explicit Progress(const Console& console);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Starts a stage such as "simplifying"; the one before it is over.
  void stage(std::string_view name);
  /// 0..1 of the stage; cheap enough to be called often.
  void update(double fraction);
  /// The same where the share of the stage that is done is unknown.
  void working();
  /// Takes the bar away, so that other lines can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  /// Whether it is time for something to be seen.
  bool isDue();
  void draw(std::string line);
  void drawBar(double fraction);
  [[nodiscard]] std::string timeLeft(double fraction) const;

  void endStage();

  std::ostream& out_;
  bool onTerminal_, quiet_, verbose_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point lastDrawn_{}, stageStart_{};
  std::string stage_;
  std::size_t barLength_ = 0;
};

}  // namespace qtet

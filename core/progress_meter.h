// How fast a task goes and how long it takes yet, from what was done. The caller gives the instants.
#pragma once

#include <deque>
#include <optional>
#include <string>

namespace understudy {

/// What the whole task counts: {"machines", 200}. Without a count it goes by per cent.
struct ProgressUnit {
  std::string name;
  double count = 0;
};

class ProgressMeter {
 public:
  /// `now` [s] of any clock that does not run backwards: the instant when the work begins.
  explicit ProgressMeter(double now, ProgressUnit unit = {});

  /// `share` of the task is done, 0..1. A smaller share than before begins a new task.
  void update(double share, const std::string& what, double now);
  /// Share a second over the last half minute; nothing until half a second of work was seen.
  std::optional<double> rate() const;
  /// [s] until all is done at this rate.
  std::optional<double> left() const;
  /// "42 % printing, 3.1 %/s, 0:19 left"; without what is not known yet.
  std::string text() const;

 private:
  struct Sample {
    double now, share;
  };

  ProgressUnit unit_;
  Sample began_;
  std::deque<Sample> window_;
  std::string what_;
};

/// When a line is to be shown, and what: on a terminal as often as an eye follows, else every ten seconds.
class ProgressPace {
 public:
  enum class To { terminal, pipe };

  ProgressPace(To to, double now, ProgressUnit unit = {});
  /// The text to show now, if any.
  std::optional<std::string> update(double share, const std::string& what, double now);

 private:
  ProgressMeter meter_;
  To to_;
  double next_;
  std::string shown_;
};

}  // namespace understudy

#include "core/progress_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace understudy {
namespace {

constexpr double kWindow = 30;     // [s] long enough for an even rate, short enough to follow a change
constexpr double kTooEarly = 0.5;  // [s] what is done by then is reading, or was done by an earlier run
constexpr double kTerminalPause = 0.1, kPipePause = 10;  // [s]
constexpr double kMinute = 60, kHour = 3600, kDay = 24 * kHour;

/// In the largest unit of time in which it is at least one.
std::string rate_text(double a_second, const std::string& unit) {
  if (a_second >= 1) return fmt::format("{:.1f} {}/s", a_second, unit);
  if (a_second * kMinute >= 1) return fmt::format("{:.1f} {}/min", a_second * kMinute, unit);
  return fmt::format("{:.1f} {}/h", a_second * kHour, unit);
}

std::string duration_text(double seconds) {
  if (seconds >= 99 * kDay) return "over 99 days";
  const long whole = std::lround(seconds);
  const long hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02d}:{:02d}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02d}", minutes, whole % 60);
}

}  // namespace

ProgressMeter::ProgressMeter(double now, ProgressUnit unit)
    : unit_(std::move(unit)), began_{now, 0}, window_{began_} {}

void ProgressMeter::update(double share, const std::string& what, double now) {
  what_ = what;
  const Sample sample{now, std::clamp(share, 0., 1.)};
  if (sample.share < window_.back().share) {
    began_ = sample;
    window_.clear();
  } else if (now - began_.now < kTooEarly) {
    window_.clear();
  }
  window_.push_back(sample);
  while (window_.size() > 2 && now - window_[1].now >= kWindow) window_.pop_front();
}

std::optional<double> ProgressMeter::rate() const {
  const double time = window_.back().now - window_.front().now;
  const double done = window_.back().share - window_.front().share;
  if (time < kTooEarly || !(done > 0)) return std::nullopt;
  return done / time;
}

std::optional<double> ProgressMeter::left() const {
  const auto a_second = rate();
  if (!a_second) return std::nullopt;
  return (1 - window_.back().share) / *a_second;
}

std::string ProgressMeter::text() const {
  std::string text = fmt::format("{:3d} % {}", static_cast<int>(100 * window_.back().share), what_);
  const auto a_second = rate();
  if (!a_second) return text;
  const bool counts = unit_.count > 0;
  return text + fmt::format(", {}, {} left",
                            rate_text(*a_second * (counts ? unit_.count : 100), counts ? unit_.name : "%"),
                            duration_text(*left()));
}

ProgressPace::ProgressPace(To to, double now, ProgressUnit unit)
    : meter_(now, std::move(unit)), to_(to), next_(to == To::terminal ? now : now + kPipePause) {}

std::optional<std::string> ProgressPace::update(double share, const std::string& what, double now) {
  meter_.update(share, what, now);
  if (now < next_) return std::nullopt;
  std::string text = meter_.text();
  if (to_ == To::terminal && text == shown_) return std::nullopt;
  shown_ = text;
  next_ = now + (to_ == To::terminal ? kTerminalPause : kPipePause);
  return text;
}

}  // namespace understudy

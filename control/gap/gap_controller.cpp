#include "control/gap/gap_controller.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "control/gap/confidence.h"
#include "control/gap/gap_response.h"
#include "control/gap/gap_sensor.h"
#include "control/gap/sensor_uncertainty.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"

namespace understudy::control {

using machine::Status;

namespace {

constexpr double kUnmodelled = 20e-6;  // [m]: surface roughness and facets, as-built curvature of the motion
constexpr double kJump = 10e-6;  // [m], beyond noise: the mechanism has moved, older samples do not count
constexpr int kStallsMax = 2;
constexpr double kProbe = 0.1e-3;   // [m], a step while no reading has followed one yet
constexpr double kBlind = 0.25e-3;  // [m], in all until then: two such steps, and noise
constexpr double kLift = 1e-3;      // [m], upwards, where steps down have proved nothing: many plays long
constexpr double kTakeUp = 0.2e-3;  // [m], down again before the sample: plays lie as after a step down
constexpr double kStepMin = 1e-6;   // [m], about two microsteps: less is no motion

/// Gap minus commanded height, averaged over the last samples: motion along the axis changes both alike, so
/// samples at different heights add up.
class GapEstimate {
 public:
  explicit GapEstimate(int window) : window_(static_cast<std::size_t>(std::max(1, window))) {}

  /// A sample that is not to be averaged stands alone until the next.
  void add(double height, const GapReading& reading, bool averaged) {
    const double offset = reading.gap - height;
    const double scatter = std::hypot(reading.sigma, sigma_);
    if (!averaging_ || !averaged || std::abs(offset - offset_) > kSafeSigmas * scatter + kJump)
      samples_.clear();
    averaging_ = averaged;
    samples_.push_back({offset, reading.sigma});
    if (samples_.size() > window_) samples_.pop_front();
    update();
  }
  double gap(double height) const { return height + offset_; }
  double sigma() const { return sigma_; }
  bool full() const { return averaging_ && samples_.size() == window_; }
  int missing() const { return static_cast<int>(window_ - samples_.size()); }

 private:
  struct Sample {
    double offset, sigma;
  };
  void update() {
    double weights = 0, sum = 0;
    for (const Sample& sample : samples_) {
      const double weight = 1 / std::max(sample.sigma * sample.sigma, 1e-18);
      weights += weight;
      sum += weight * sample.offset;
    }
    offset_ = sum / weights;
    sigma_ = 1 / std::sqrt(weights);
  }

  std::size_t window_;
  std::deque<Sample> samples_;
  bool averaging_ = false;
  double offset_ = 0, sigma_ = 0;
};

double asked_aim(const machine::MachineDescription& machine, const GapControllerOptions& options) {
  const double aim = options.aim > 0 ? options.aim : machine.gap.aim;
  const machine::GapLimits& limits = machine.gap;
  if (aim <= limits.accepted_min || aim >= limits.accepted_max)
    throw InputError(
        fmt::format("the gap aimed at is {:.3f} mm, not between {:.3f} and {:.3f} mm, the accepted gaps",
                    to_mm(aim), to_mm(limits.accepted_min), to_mm(limits.accepted_max)));
  return aim;
}

class Approach {
 public:
  Approach(const machine::MachineDescription& machine, const LocalSurface& surface, const Pose& X_WT_start,
           double standoff, GapMotion& motion, const GapControllerOptions& options)
      : limits_(machine.gap),
        X_WT_start_(X_WT_start),
        standoff_(standoff),
        motion_(motion),
        options_(options),
        safe_(safe_aim(machine, surface, asked_aim(machine, options))),
        aim_(safe_.gap),
        play_(machine.tip_play()),
        floor_(limits_.accepted_min / 2 + kSafeSigmas * safe_.sigma),
        response_(floor_, kBlind),
        sensor_(machine, surface, options, motion.port()),
        height_(standoff) {}

  GapOutcome run() {
    outcome_.calibration_sigma = safe_.sigma;
    GapStop stop = safe_.fits ? descend() : stop_for(GapStop::uncertain, too_uncertain(limits_, safe_.sigma));
    if (stop == GapStop::too_close) stop = try_again_from_above();
    outcome_.stop = stop;
    if (stop != GapStop::none) retreat();
    outcome_.offset_W = height_ * tool_axis(X_WT_start_);
    return std::move(outcome_);
  }

 private:
  GapStop descend();
  GapStop take_sample(GapEstimate& estimate, std::optional<Expectation>& expected);
  GapStop judge(const GapEstimate& estimate);
  bool without_response(const GapEstimate& estimate) const;
  GapStop lift(GapEstimate& estimate);
  bool reached(const GapEstimate& estimate) const;
  double next_step(const GapEstimate& estimate) const;
  GapStop try_again_from_above();
  GapStop move_to(double height);
  void retreat();
  GapStop stop_for(GapStop reason, std::string why) {
    outcome_.why = std::move(why);
    return reason;
  }

  const machine::GapLimits limits_;
  const Pose X_WT_start_;
  const double standoff_;
  GapMotion& motion_;
  const GapControllerOptions& options_;
  const SafeAim safe_;
  const double aim_;
  const double play_;
  const double floor_;  // [m], of the gap that is proved
  ApproachResponseTest response_;
  GapSensor sensor_;
  double height_;  ///< [m], commanded tip above S along the tool axis
  bool lifted_ = false;
  GapOutcome outcome_;
};

GapStop Approach::descend() {
  GapEstimate estimate(options_.frames_averaged);
  std::optional<Expectation> expected;
  for (int stops = 0; stops < options_.stops_max; ++stops) {
    stop_if_interrupted();
    if (const GapStop s = take_sample(estimate, expected); s != GapStop::none) return s;
    const double gap = estimate.gap(height_);
    outcome_.gap = gap;
    outcome_.sigma = estimate.sigma();
    if (!lifted_ && without_response(estimate)) {
      if (const GapStop s = lift(estimate); s != GapStop::none) return s;
      expected.reset();
      continue;
    }
    if (const GapStop s = judge(estimate); s != GapStop::none) return s;
    if (reached(estimate)) return GapStop::none;

    const double step = next_step(estimate);
    if (step < kStepMin) {
      expected = Expectation{gap, kUnmodelled};
      continue;
    }
    if (const GapStop s = move_to(height_ - step); s != GapStop::none) return s;
    expected = Expectation{gap - step, kScaleError * step + play_ + kUnmodelled};
  }
  return stop_for(
      GapStop::no_progress,
      fmt::format("{} stops did not reach the gap of {:.3f} mm: it reads {:.3f} mm, 1 sigma {:.3f} mm",
                  options_.stops_max, to_mm(aim_), to_mm(outcome_.gap), to_mm(outcome_.sigma)));
}

GapStop Approach::take_sample(GapEstimate& estimate, std::optional<Expectation>& expected) {
  machine::MachinePort& port = motion_.port();
  if (port.wait_until(port.now() + options_.settle_time) != Status::ok)
    return stop_for(GapStop::port_failed,
                    fmt::format("the machine failed: {}", to_string(port.state().fault)));
  GapSample sample;
  const GapStop s = sensor_.take(expected, sample);
  std::string why = sample.why;
  if (s == GapStop::none) {
    response_.add(height_, sample.reading.gap, sample.reading.sigma);
    estimate.add(height_, sample.reading, sample.reading.gap - aim_ <= options_.slow_zone);
  }
  outcome_.samples.push_back(std::move(sample));
  return s == GapStop::none ? s : stop_for(s, std::move(why));
}

bool Approach::reached(const GapEstimate& estimate) const {
  return estimate.full() && estimate.gap(height_) - aim_ <= options_.tolerance;
}

/// Readings have not followed the steps down, so far as these were told from play.
bool Approach::without_response(const GapEstimate& estimate) const {
  return response_.stalls() >= kStallsMax || (!reached(estimate) && response_.room(height_) < kStepMin);
}

/// A step down is as short as a play, which can take all of it up. Upwards the tool may go farther: the dot
/// follows that, and what stands still in the picture does not.
GapStop Approach::lift(GapEstimate& estimate) {
  lifted_ = true;
  const double top = height_ + kLift, end = height_ + play_ + kUnmodelled;
  const double read = outcome_.gap;
  response_.restart();
  const auto unanswered = [&](const char* how) {
    return stop_for(
        GapStop::no_progress,
        fmt::format("the gap read {:.3f} mm, and has not followed {}: what shines may not be the dot",
                    to_mm(read), how));
  };
  const GapStop up = move_to(top + kTakeUp);
  if (up == GapStop::unreachable) return unanswered("the steps down; the tool cannot rise to ask again");
  if (up != GapStop::none) return up;
  for (const double height : {top, end}) {
    if (const GapStop s = move_to(height); s != GapStop::none) return s;
    std::optional<Expectation> anywhere;
    if (const GapStop s = take_sample(estimate, anywhere); s != GapStop::none) return s;
  }
  return response_.proved() ? GapStop::none : unanswered("the tool as it rose and came down again");
}

GapStop Approach::judge(const GapEstimate& estimate) {
  const double gap = estimate.gap(height_), sigma = estimate.sigma();
  if (gap < limits_.accepted_min)
    return stop_for(GapStop::too_close, fmt::format("the gap reads {:.3f} mm, less than {:.3f} mm",
                                                    to_mm(gap), to_mm(limits_.accepted_min)));
  const double depth = gap - aim_ - height_;  // how far below S the tip would have to go
  if (depth > options_.depth_max)
    return stop_for(
        GapStop::too_far,
        fmt::format("the gap reads {:.3f} mm at {:.3f} mm above the start: the surface is {:.3f} mm lower "
                    "than programmed, at most {:.3f} mm are allowed",
                    to_mm(gap), to_mm(height_), to_mm(depth), to_mm(options_.depth_max)));
  if (response_.stalls() >= kStallsMax)
    return stop_for(GapStop::no_progress, fmt::format("the gap still reads {:.3f} mm after {} steps down",
                                                      to_mm(gap), response_.stalls()));
  if (!reached(estimate) && response_.room(height_) < kStepMin)
    return stop_for(
        GapStop::no_progress,
        fmt::format("the gap reads {:.3f} mm, but by the steps since a reading last followed one {:.3f} mm "
                    "are sure: what shines may not be the dot",
                    to_mm(gap), to_mm(response_.room(height_) + floor_)));
  const double total = std::hypot(sigma, safe_.sigma);
  if (reached(estimate) && kSafeSigmas * total > aim_ - limits_.accepted_min)
    return stop_for(
        GapStop::implausible,
        fmt::format("the gap of {:.3f} mm is known to {:.3f} mm only (1 sigma), too little to stay above "
                    "{:.3f} mm",
                    to_mm(gap), to_mm(total), to_mm(limits_.accepted_min)));
  return GapStop::none;
}

/// Far away a fraction of what is left. In the slow zone what is left is shared between the samples still to
/// be averaged, and no step uses up more than half of the way to the accepted band's end. Never farther than
/// is proved, never upwards.
double Approach::next_step(const GapEstimate& estimate) const {
  const double gap = estimate.gap(height_), left = gap - aim_, room = response_.room(height_);
  if (left > options_.slow_zone)
    return std::min(options_.step_fraction * left, response_.proved() ? room : std::min(room, kProbe));
  const double share = left / std::max(1, estimate.missing());
  const double safe = gap - kSafeSigmas * estimate.sigma() - limits_.accepted_min;
  return std::max(0.0, std::min({share, safe, (gap - limits_.accepted_min) / 2, room}));
}

GapStop Approach::try_again_from_above() {
  const std::string first = outcome_.why;
  response_.restart();
  const double height = std::max(standoff_, height_ + options_.retreat);
  if (const GapStop s = move_to(height); s != GapStop::none) return s;
  const GapStop s = descend();
  if (s != GapStop::none) outcome_.why = fmt::format("{} (before, {})", outcome_.why, first);
  return s;
}

GapStop Approach::move_to(double height) {
  Pose X_WT = X_WT_start_;
  X_WT.translation() += height * tool_axis(X_WT_start_);
  try {
    const Status s = motion_.move_to(X_WT);
    if (s == Status::ok) {
      height_ = height;
      return GapStop::none;
    }
    std::string why = fmt::format("the machine did not move: {}", to_string(s));
    if (s == Status::faulted) why += fmt::format(" ({})", to_string(motion_.port().state().fault));
    return stop_for(GapStop::port_failed, std::move(why));
  } catch (const InputError& error) {
    return stop_for(GapStop::unreachable, error.what());
  }
}

/// Upwards from wherever the last command went: a move that failed on the way down has ended above that.
void Approach::retreat() {
  const GapStop reason = outcome_.stop;
  const std::string why = outcome_.why;
  const double from = height_;
  const GapStop failed = move_to(from + options_.retreat);
  const std::string end = failed == GapStop::none
                              ? fmt::format("; retreated by {:.3f} mm", to_mm(options_.retreat))
                              : fmt::format("; could not retreat: {}", outcome_.why);
  outcome_.stop = reason;
  outcome_.why = why + end;
}

}  // namespace

GapControllerOptions gap_controller_options(const machine::MachineDescription& machine) {
  return {machine.control.gap.approach, 0};
}

GapOutcome close_gap(const machine::MachineDescription& machine, const LocalSurface& surface,
                     const Pose& X_WT_start, double standoff, GapMotion& motion,
                     const GapControllerOptions& options) {
  return Approach(machine, surface, X_WT_start, standoff, motion, options).run();
}

}  // namespace understudy::control

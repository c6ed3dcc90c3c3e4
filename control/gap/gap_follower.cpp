#include "control/gap/gap_follower.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "control/gap/confidence.h"

namespace understudy::control {
namespace {

constexpr int kRepeatsMax = 3;          // readings equal to the last bit: a camera's noise forbids one
constexpr double kSpeckleShare = 0.01;  // of a new pattern that a sample from the same place is worth
// Noise puts one reading in 16 000 beyond the gate; a crossing of a bead is one run, or two with its edges.
constexpr int kMixedOff = 6, kMixedRuns = 4;
// Of the correction's rate and acceleration, while the tool is excited: the correction has the rest.
constexpr double kExcitedShare = 0.6;

GapExcitationOptions excitation_options(const GapFollowerOptions& options) {
  GapExcitationOptions excitation;
  excitation.amplitude = options.excitation;
  excitation.rate_max = kExcitedShare * options.rate_max;
  excitation.acceleration_max = kExcitedShare * options.acceleration_max;
  return excitation;
}

}  // namespace

GapFollowerOptions gap_follower_options(const machine::MachineDescription& machine) {
  GapFollowerOptions options;
  static_cast<machine::GapFollowingSettings&>(options) = machine.control.gap.following;
  options.line = machine.control.gap.line;
  options.aim = machine.gap.aim;
  options.speckle_length = machine.laser.waist_diameter;
  options.floor = options.step_max = machine.gap.accepted_min / 2;
  options.unproved_max = (options.aim - options.floor) / 2;
  options.excitation = (machine.gap.accepted_max - options.aim) / 3;
  return options;
}

GapFollower::GapFollower(const GapFollowerOptions& options)
    : options_(options),
      line_(options.line),
      step_({options.step_max, options.gate, options.step_samples}),
      step_from_rest_(step_),
      excitation_(excitation_options(options)) {}

void GapFollower::aim_at(double aim, double calibration_sigma) {
  options_.aim = aim;
  calibration_sigma_ = calibration_sigma;
}

double GapFollower::sigma() const { return std::sqrt(std::max(0.0, line_.covariance().height)); }

void GapFollower::start(double time, double path, double gap, double sigma) {
  start_unknown(time, path);
  known_ = true;
  line_.set_height(time, path, gap, sigma * sigma + options_.unmodelled * options_.unmodelled);
  stood_ = gap;
}

void GapFollower::start_unknown(double time, double path) {
  const GapFollowerOptions options = options_;
  *this = GapFollower(options);
  line_.begin(time, path);
  advanced_path_ = path;
  used_path_ = path - options_.speckle_length;
  resume(time, path);
}

void GapFollower::resume(double time, double path) {
  seen_time_ = time;
  seen_path_ = path;
  missed_ = 0;
  reasons_.fill(0);
}

/// No farther beyond the last good reading than the line can be trusted.
double GapFollower::predicted_error(double path) const { return line_.height_at(path, line_end()); }

double GapFollower::predicted_sigma(double time, double path) const {
  return std::sqrt(std::max(0.0, line_.variance_at(time, path)));
}

GapVerdict GapFollower::observe(const GapObservation& o) {
  if (!std::isfinite(o.gap) || !(o.sigma >= 0) || !std::isfinite(o.correction + o.path + o.time + o.sigma)) {
    const bool placed = std::isfinite(o.time + o.path);
    miss(placed ? o.time : seen_time_, placed ? o.path : seen_path_, GapStop::implausible);
    return GapVerdict::jump;
  }
  same_readings_ = o.gap == last_reading_ ? same_readings_ + 1 : 0;
  last_reading_ = o.gap;
  if (same_readings_ >= kRepeatsMax - 1) {
    miss(o.time, o.path, GapStop::stale_frame);
    return GapVerdict::repeated;
  }
  judge_excitation(o);
  if (!known_) {
    begin(o);
    judge(o);
    return known_ ? GapVerdict::used : GapVerdict::not_yet;
  }
  line_.predict(o.time, o.path, line_end());
  // From the same place the same speckle: such samples hardly add.
  const double fresh = std::clamp((o.path - used_path_) / options_.speckle_length, kSpeckleShare, 1.0);
  const double variance = o.sigma * o.sigma / fresh + options_.unmodelled * options_.unmodelled;
  const double innovation = o.gap - o.correction - line_.height();
  if (o.path - used_path_ > options_.extrapolated_max) response_.forget();
  const double spread = std::sqrt(line_.covariance().height + o.sigma * o.sigma) + options_.unmodelled;
  const bool off = std::abs(innovation) > options_.gate * spread;
  frames_.add(GapStop::none);
  if (off && !lasting_step(innovation, o.sigma * o.sigma)) {
    pass_over(o.time, o.path, GapStop::implausible);
    judge_mixture(true);
    return GapVerdict::jump;
  }
  judge_mixture(false);
  if (off) {
    response_.forget();
  } else {
    const bool follows =
        response_.observe(o.gap - o.still, variance, innovation, line_.covariance().height + variance);
    line_.correct(innovation, variance);
    if (follows) prove(o);
  }
  step_.clear();
  step_from_rest_.clear();
  use(o);
  judge(o);
  return GapVerdict::used;
}

/// A bead or an edge is off for a part of the path, a step of the machine for good. What is off again and
/// again, among readings that are not, is a second spot, and nothing tells which of the two is the dot.
void GapFollower::judge_mixture(bool jump) {
  jumps_ = (jumps_ << 1 | (jump ? 1U : 0U)) & ((1U << kMixedReadings) - 1);
  const int off = std::popcount(jumps_), runs = std::popcount(jumps_ & ~(jumps_ << 1));
  if (!jump || off < kMixedOff || runs < kMixedRuns) return;
  if (stop_ == GapStop::none) mixed_ = off;
  raise(GapStop::implausible);
}

/// Of the line as it goes on, or as it stood: a slope that the step itself has spoilt leads away from what
/// the readings agree on.
bool GapFollower::lasting_step(double innovation, double variance) {
  const double gone_on = line_.height() - stood_;
  const double spread = variance + options_.unmodelled * options_.unmodelled;
  const bool from_line = step_.add(innovation, spread),
             from_rest = step_from_rest_.add(innovation + gone_on, spread);
  if (!from_line && !from_rest) return false;
  const double by = from_line ? step_.mean() : step_from_rest_.mean() - gone_on;
  line_.step(by, variance / options_.step_samples);
  stood_ = line_.height();
  jumps_ &= jumps_ + 1;  // the last run of them was the step
  return true;
}

/// The mean of the first readings that agree.
void GapFollower::begin(const GapObservation& o) {
  const double error = o.gap - o.correction;
  const double mean = begun_ > 0 ? begun_sum_ / begun_ : error;
  if (std::abs(error - mean) > options_.gate * o.sigma + options_.step_max) {
    begun_ = 0;
    begun_sum_ = 0;
  }
  if (begun_ == 0) begun_path_ = o.path;
  ++begun_;
  begun_sum_ += error;
  if (begun_ < options_.step_samples) return;
  known_ = true;
  const double variance =
      o.sigma * o.sigma / begun_ + std::pow(options_.line.slope_sigma * (o.path - begun_path_), 2);
  line_.set_height(o.time, o.path, begun_sum_ / begun_, variance);
  use(o);
}

/// The line has taken a reading up. One alone between others that are off may have met it by chance.
void GapFollower::use(const GapObservation& o) {
  constexpr std::uint32_t kLastTwo = 3;
  used_path_ = o.path;
  if ((jumps_ & kLastTwo) == 0) stood_ = line_.height();
  resume(o.time, o.path);
}

void GapFollower::pass(double dt, double way) {
  seen_time_ += dt;
  seen_path_ += way;
  held_time_ += dt;
  asked_time_ += dt;
  held_path_ += way;
}

void GapFollower::miss(double time, double path, GapStop why) {
  frames_.add(why);
  pass_over(time, path, why);
}

void GapFollower::pass_over(double time, double path, GapStop why) {
  ++missed_;
  ++reasons_[static_cast<std::size_t>(why)];
  const double blind = time - seen_time_;
  const bool far = path - seen_path_ >= options_.blind_path;
  if ((blind >= options_.blind_time && far) || blind >= options_.blind_time_max)
    raise(static_cast<GapStop>(std::max_element(reasons_.begin(), reasons_.end()) - reasons_.begin()));
}

void GapFollower::judge(const GapObservation& o) {
  if (!known_) return;
  if (gap(o.correction) - kSafeSigmas * std::hypot(sigma(), calibration_sigma_) < options_.floor)
    raise(GapStop::too_close);
  // What nobody has seen follow the tool says nothing about the surface.
  if (std::abs(wanted()) > options_.travel_max + kSafeSigmas * sigma()) {
    const bool unseen = excitation_.available() && excitation_due(o.path);
    if (unseen) unanswered_ = std::max(0.0, o.correction);
    raise(unseen ? GapStop::no_progress : GapStop::too_far);
  }
  judge_proof(o);
}

/// The part's own dot would have come down with the tool, or risen while the tool waits.
void GapFollower::judge_proof(const GapObservation& o) {
  const bool held = wanted() < lowest() - options_.unproved_max / 2 - kSafeSigmas * sigma();
  if (held && !held_) {
    held_time_ = o.time;
    held_path_ = o.path;
  }
  held_ = held;
  if (held && o.time - held_time_ >= options_.blind_time && o.path - held_path_ >= options_.blind_path)
    raise_unproved();
}

/// Nothing shows that the readings follow the tool: because they do not, or because most frames gave none.
void GapFollower::raise_unproved() {
  if (frames_.blind() && stop_ == GapStop::none) prevented_ = frames_.missed();
  raise(frames_.blind() ? frames_.reason() : GapStop::no_progress);
}

/// The correction that is proved to be safe. A bead's first excitation is waited for: what shines may have
/// come with the bead.
double GapFollower::lowest() const {
  if (excitation_.available() && !proved_ && excitation_.running()) return std::max(0.0, correction_.value);
  return std::max(-options_.travel_max, response_.highest() - options_.unproved_max);
}

/// The line as it was when readings last followed says where the gap may be by now.
bool GapFollower::excitation_due(double path) const {
  if (!proved_) return true;
  const double variance =
      proved_line_.height_ahead(std::max(0.0, path - proved_path_), options_.line.slope_walk);
  return kSafeSigmas * std::sqrt(std::max(0.0, variance)) > options_.aim - options_.floor;
}

void GapFollower::prove(const GapObservation& o) {
  response_.restart(o.correction - o.excitation);
  proved_ = true;
  asked_ = false;
  proved_path_ = o.path;
  proved_line_ = line_.covariance();
}

void GapFollower::judge_excitation(const GapObservation& o) {
  if (!excitation_.available()) return;
  const double variance = o.sigma * o.sigma + options_.unmodelled * options_.unmodelled;
  switch (excitation_.observe({o.path, o.correction, o.gap, o.still, variance})) {
    case GapExcitation::Answer::open:
      judge_silence(o);
      return;
    case GapExcitation::Answer::follows:
      prove(o);
      return;
    case GapExcitation::Answer::stands_still:
      unanswered_ = excitation_.value();
      raise_unproved();
  }
}

/// Readings that tell neither a part from a spot nor a spot from a part.
void GapFollower::judge_silence(const GapObservation& o) {
  if (!excitation_.running()) return;
  if (!asked_) asked_time_ = o.time;
  asked_ = true;
  if (o.time - asked_time_ < options_.silent_time_max) return;
  unanswered_ = options_.excitation;
  raise_unproved();
}

void GapFollower::excite(double dt, double path, bool follow) {
  if (!excitation_.available()) return;
  const bool may = follow && known_ && stop_ == GapStop::none;
  if (!follow) asked_ = false;
  if (!follow && (excitation_.running() || excitation_.rate() != 0)) excitation_.abandon();
  const bool slow = std::abs(correction_.rate) <= (1 - kExcitedShare) * options_.rate_max;
  if (may && slow && !excitation_.running() && excitation_.rate() == 0) {
    if (excitation_due(path)) {
      excitation_.begin(line_.slope(), std::sqrt(std::max(0.0, line_.covariance().slope)));
    } else if (!excitation_.lowered())
      excitation_.lower();
  }
  excitation_.advance(dt);
}

/// Rate and acceleration are limited; what is left is taken over within settle_time, and the line's own climb
/// at once.
GapFollower::Correction GapFollower::advance(double dt, double path, bool follow) {
  const double climb = std::max(0.0, path - advanced_path_);
  advanced_path_ = std::max(advanced_path_, path);
  const bool moved = excitation_.rate() != 0;  // the share of the cycle in which it comes to rest, too
  excite(dt, path, follow);
  const bool excited = moved || excitation_.running() || excitation_.rate() != 0;
  const double rate_max = options_.rate_max * (excited ? 1 - kExcitedShare : 1);
  const double acceleration_max = options_.acceleration_max * (excited ? 1 - kExcitedShare : 1);
  double rate = 0;
  // Readings that disagree with the line do not move it, but they do forbid to go on along it.
  if (follow && known_ && !contradicted() && !excitation_.suspects()) {
    const double wanted = options_.aim - predicted_error(path);
    const double target = std::clamp(wanted, lowest(), options_.travel_max);
    const double left = target - correction_.value;
    const bool on_line = path > line_.path() && path < line_end() && wanted == target;
    const double line_rate = on_line ? -line_.slope() * climb / dt : 0;
    // Half of the acceleration: the other half is there for the target to move meanwhile.
    const double reach =
        std::min(std::abs(left) / options_.settle_time, std::sqrt(acceleration_max * std::abs(left)));
    rate = std::clamp(line_rate + std::copysign(reach, left), -rate_max, rate_max);
  }
  const double change = acceleration_max * dt;
  const double next = correction_.rate + std::clamp(rate - correction_.rate, -change, change);
  correction_.value += 0.5 * (correction_.rate + next) * dt;
  correction_.rate = next;
  response_.reach(correction_.value);
  return {correction_.value + excitation_.value(), correction_.rate + excitation_.rate(),
          excitation_.value()};
}

}  // namespace understudy::control

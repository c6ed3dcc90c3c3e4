#include "control/gap/gap_excitation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::control {
namespace {

constexpr std::size_t kBefore = 4;       // readings that show the tool before it moves
constexpr std::size_t kReadingsMin = 5;  // with fewer, a line explains everything
constexpr double kAgrees = 1;  // [nats] of the second look alone, for what its first readings say as well
constexpr int kLate = 6;       // readings after an arrival: three are on their way, three show it

// What shines has changed since the first of the readings: an edge, or a thread that came.
constexpr double kChanged = 2.0 / 3;  // of the amplitude, root mean square

}  // namespace

void ExcitationMotion::go_to(double height, double rate_max, double acceleration_max) {
  target_ = height;
  rate_max_ = rate_max;
  acceleration_max_ = acceleration_max;
  brake(acceleration_max);
  turning_ = rate_ != 0;
  if (!turning_) start();
}

void ExcitationMotion::start() {
  const double way = target_ - value_, length = std::abs(way);
  time_ = braking_ = 0;
  turning_ = false;
  // The peaks of half a cosine over `length` in T: pi length / 2 T, and pi^2 length / 2 T^2.
  duration_ =
      std::numbers::pi * std::max(length / (2 * rate_max_), std::sqrt(length / (2 * acceleration_max_)));
  peak_ = length > 0 ? std::numbers::pi * way / (2 * duration_) : 0;
}

void ExcitationMotion::brake(double acceleration_max) {
  braking_ = acceleration_max;
  turning_ = false;
  duration_ = 0;
}

void ExcitationMotion::advance(double dt) {
  if (turning_ && rate_ == 0) start();
  time_ = std::min(time_ + dt, duration_);
  double next = arrived() ? 0 : peak_ * std::sin(std::numbers::pi * time_ / duration_);
  if (braking_ > 0) next = std::copysign(std::max(0.0, std::abs(rate_) - braking_ * dt), rate_);
  value_ += 0.5 * (rate_ + next) * dt;
  rate_ = next;
}

void ExcitationTest::begin(std::size_t kept) {
  if (filled_ <= kept) return;
  const auto last = readings_.begin() + static_cast<std::ptrdiff_t>(filled_);
  std::copy(last - static_cast<std::ptrdiff_t>(kept), last, readings_.begin());
  filled_ = kept;
}

void ExcitationTest::add(const ExcitedReading& reading) {
  if (filled_ == readings_.size()) begin(filled_ - 1);
  readings_[filled_++] = reading;
}

/// The least sum of squares, in variances, of level and slope over the path.
double ExcitationTest::misfit(bool follows, double slope, double slope_sigma) const {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0;
  const double origin = readings_[0].path, level = readings_[0].gap;
  for (std::size_t i = 0; i < filled_; ++i) {
    const ExcitedReading& r = readings_[i];
    const double weight = 1 / r.variance, x = r.path - origin;
    const double y = r.gap - level - (follows ? r.correction + slope * x : r.still);
    w += weight;
    wx += weight * x;
    wy += weight * y;
    wxx += weight * x * x;
    wxy += weight * x * y;
    wyy += weight * y * y;
  }
  const double sxx = wxx - wx * wx / w + 1 / (slope_sigma * slope_sigma), sxy = wxy - wx * wy / w;
  return std::max(0.0, wyy - wy * wy / w - sxy * sxy / sxx);
}

ExcitationTest::Result ExcitationTest::result(double slope, double slope_sigma) const {
  if (filled_ < kReadingsMin) return {};
  const double part = misfit(true, slope, slope_sigma), spot = misfit(false, slope, slope_sigma);
  const double left = std::min(part, spot) / static_cast<double>(filled_ - 2);
  return {0.5 * (spot - part) / std::max(1.0, left), left * readings_[filled_ - 1].variance};
}

void GapExcitation::begin(double slope, double slope_sigma) {
  slope_ = slope;
  slope_sigma_ = slope_sigma;
  if (!undecided_) test_.begin(kBefore);
  undecided_ = true;
  phase_ = suspected_ ? Phase::second : Phase::first;
  after_ = 0;
  go_to((suspected_ ? 2 : 1) * options_.amplitude);
}

void GapExcitation::abandon() {
  phase_ = Phase::idle;
  undecided_ = suspected_ = false;
  test_.clear();
  motion_.brake(options_.acceleration_max);
}

GapExcitation::Answer GapExcitation::finish(Answer answer) {
  phase_ = Phase::idle;
  undecided_ = answer == Answer::open;
  suspected_ = suspected_ && undecided_;
  if (answer != Answer::stands_still && !lowered()) lower();
  return answer;
}

GapExcitation::Answer GapExcitation::observe(const ExcitedReading& reading) {
  if (!std::isfinite(reading.still)) {
    test_.clear();
    return Answer::open;
  }
  test_.add(reading);
  if (phase_ == Phase::idle) return Answer::open;
  if (motion_.arrived()) ++after_;
  const auto [evidence, scatter] = test_.result(slope_, slope_sigma_);
  if (scatter > std::pow(kChanged * options_.amplitude, 2)) test_.begin(kBefore);
  double second_look = 0;
  if (suspected_) {
    second_look_.add(reading);
    second_look = second_look_.result(slope_, slope_sigma_).evidence;
  }
  if (std::max(evidence, second_look) >= options_.decided) return finish(Answer::follows);
  if (suspected_) {
    if (evidence <= -options_.decided && second_look < -kAgrees) return finish(Answer::stands_still);
  } else if (evidence <= -options_.suspected) {
    suspected_ = true;
    phase_ = Phase::second;
    after_ = 0;
    test_.begin(kBefore);
    second_look_.clear();
    go_to(2 * options_.amplitude);
    return Answer::open;
  }
  if (after_ < kLate) return Answer::open;
  after_ = 0;
  if (phase_ == Phase::returning) return finish(Answer::open);
  phase_ = Phase::returning;
  lower();
  return Answer::open;
}

}  // namespace understudy::control

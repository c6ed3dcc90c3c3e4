#include "rehearsal/compensation/smoothed_play.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::rehearsal {
namespace {

constexpr int kTaps = 10;        // on each side: a reach of 4 mm is looked at every 0.4 mm
constexpr double kGain = 0.5;    // towards the newest prediction
constexpr double kNoWay = 1e-9;  // [m]

}  // namespace

SmoothedPlay::SmoothedPlay(const toolpath::Program& original, const Pose& X_WT_home, double reach)
    : reach_(reach) {
  Vec3 at = X_WT_home.translation();
  for (const toolpath::Step& step : original.steps) {
    const bool moves = toolpath::moves(step);
    lengths_.push_back(moves ? (step.X_WT.translation() - at).norm() : 0);
    if (moves) at = step.X_WT.translation();
  }
}

void SmoothedPlay::add(PlayAlongPath play) { plays_.push_back(std::move(play)); }

Twist SmoothedPlay::at(std::size_t step, double fraction) const {
  Twist sum = Twist::Zero();
  double weight = 1;
  for (std::size_t k = plays_.size(); k-- > 0;) {
    sum += (k == 0 ? weight : weight * kGain) * averaged(plays_[k], step, fraction);
    weight *= 1 - kGain;
  }
  return sum;
}

Twist SmoothedPlay::averaged(const PlayAlongPath& play, std::size_t step, double fraction) const {
  if (lengths_[step] < kNoWay) return play.at(step, fraction);
  Twist sum = Twist::Zero();
  double weights = 0;
  for (int i = -kTaps; i <= kTaps; ++i) {
    const double weight = 1 + std::cos(std::numbers::pi * i / (kTaps + 1));
    const double beside = fraction + reach_ * i / kTaps / lengths_[step];
    sum += weight * play.at(step, std::clamp(beside, 0.0, 1.0));
    weights += weight;
  }
  return sum / weights;
}

}  // namespace understudy::rehearsal

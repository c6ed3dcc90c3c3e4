#include "rehearsal/compensation/smoothed_play.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::rehearsal {
namespace {

constexpr int kTaps = 10;          // on each side: a reach of 4 mm is looked at every 0.4 mm
constexpr double kGain = 0.5;      // towards the newest prediction
constexpr double kSmooth = 0.866;  // cosine of the corner that ends a run
constexpr double kNoWay = 1e-9;    // [m]

}  // namespace

SmoothedPlay::SmoothedPlay(const toolpath::Program& original, const Pose& X_WT_home, double reach)
    : reach_(reach) {
  Vec3 at = X_WT_home.translation(), direction = Vec3::Zero();
  double path = 0;
  auto kind = toolpath::StepKind::end;
  for (const toolpath::Step& step : original.steps) {
    const Vec3 way = toolpath::moves(step) ? Vec3(step.X_WT.translation() - at) : Vec3::Zero();
    const double length = way.norm();
    const bool goes_on = length < kNoWay || (step.kind == kind && way.dot(direction) > kSmooth * length);
    if (runs_.empty() || !goes_on) runs_.push_back({path, path, step.kind == toolpath::StepKind::print});
    begins_.push_back(path);
    lengths_.push_back(length);
    run_.push_back(runs_.size() - 1);
    runs_.back().end = path += length;
    if (length < kNoWay) continue;
    direction = way / length;
    kind = step.kind;
    at = step.X_WT.translation();
  }
  leads_to_.resize(runs_.size());
  for (std::size_t k = runs_.size(); k-- > 0;)
    leads_to_[k] = runs_[k].prints || k + 1 == runs_.size() ? k : leads_to_[k + 1];
}

void SmoothedPlay::add(PlayAlongPath play) { plays_.push_back(std::move(play)); }

Twist SmoothedPlay::at(std::size_t step, double fraction, std::size_t predictions) const {
  Twist sum = Twist::Zero();
  double weight = 1;
  for (std::size_t k = predictions; k-- > 0;) {
    sum += (k == 0 ? weight : weight * kGain) * averaged(plays_[k], step, fraction);
    weight *= 1 - kGain;
  }
  return sum;
}

Twist SmoothedPlay::averaged(const PlayAlongPath& play, std::size_t step, double fraction) const {
  const Run& run = runs_[this->run(step)];
  if (lengths_[step] < kNoWay && run_[step] == this->run(step)) return play.at(step, fraction);
  const double path = std::max(run.begin, begins_[step] + fraction * lengths_[step]);
  Twist sum = Twist::Zero();
  double weights = 0;
  for (int i = -kTaps; i <= kTaps; ++i) {
    const double weight = 1 + std::cos(std::numbers::pi * i / (kTaps + 1));
    sum += weight * at_path(play, std::clamp(path + reach_ * i / kTaps, run.begin, run.end));
    weights += weight;
  }
  return sum / weights;
}

Twist SmoothedPlay::at_path(const PlayAlongPath& play, double path) const {
  const auto next = std::ranges::upper_bound(begins_, path);
  const auto step = static_cast<std::size_t>(next - begins_.begin()) - 1;
  const double fraction = lengths_[step] < kNoWay ? 1 : (path - begins_[step]) / lengths_[step];
  return play.at(step, std::min(fraction, 1.0));
}

}  // namespace understudy::rehearsal

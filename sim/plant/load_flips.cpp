#include "sim/plant/load_flips.h"

namespace understudy::sim {
namespace {

constexpr double kRounding = 1e-9;  // [s], of instants that are told as multiples of a step

}  // namespace

LoadFlips::LoadFlips(int axes) : axes_(static_cast<std::size_t>(axes)) {}

void LoadFlips::add(double time, const kinematics::AxisVector& load) {
  window_.push_back({time, load});
  for (std::size_t i = 0; i < axes_; ++i) sum_[i] += load[i];
  while (time - window_.front().time > kWindow - kRounding) {
    for (std::size_t i = 0; i < axes_; ++i) sum_[i] -= window_.front().load[i];
    window_.pop_front();
  }
  for (std::size_t i = 0; i < axes_; ++i) {
    const double mean = sum_[i] / static_cast<double>(window_.size());
    const int now = mean > kThreshold ? 1 : mean < -kThreshold ? -1 : side_[i];
    if (side_[i] != 0 && now != side_[i]) {
      ++count_;
      if (flips_.size() < kMost) flips_.push_back({time, static_cast<int>(i)});
    }
    side_[i] = now;
  }
}

}  // namespace understudy::sim

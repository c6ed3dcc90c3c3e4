#include "calibration/pose_choice.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "calibration/residual_covariance.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

constexpr double kPrior = 0.01;    // [m]
constexpr double kGainMin = 1e-6;  // of log det: rounding is far below
constexpr int kPassesMax = 100;

/// A pose's six equations, whitened: its information is rows^T rows.
using Whitened = ParameterRows<6>;

std::vector<Whitened> whitened_rows(const DesignSetting& setting, std::span<const Pose> poses) {
  std::vector<Whitened> all;
  PoseSample sample;
  sample.covariance = setting.covariance;
  sample.approach.fill(Approach::unknown);
  for (const Pose& X_BT : poses) {
    StrutLinearisation at;
    Whitened rows = Whitened::Zero(6, setting.unknowns.count());
    sample.X_BT = X_BT;
    if (linearise(setting.machine, sample, X_BT, at)) {
      const Eigen::LLT<Mat6> factors(residual_covariance(at, sample));
      rows = factors.matrixL().solve(dense_rows(at, setting.unknowns));
    }
    all.push_back(rows);
  }
  return all;
}

ParameterMatrix prior(const DesignSetting& setting) {
  const Eigen::Index n = setting.unknowns.count();
  return ParameterMatrix::Identity(n, n) / (kPrior * kPrior);
}

double log_det(const ParameterMatrix& H) {
  const Eigen::LLT<ParameterMatrix> factors(H);
  return 2 * factors.matrixLLT().diagonal().array().log().sum();
}

/// log det (1 + rows C rows^T): what a pose adds to log det of the information whose inverse is C.
double gain(const Whitened& rows, const ParameterMatrix& inverse) {
  const Mat6 added = Mat6::Identity() + rows * inverse * rows.transpose();
  return 2 * Eigen::LLT<Mat6>(added).matrixLLT().diagonal().array().log().sum();
}

class Exchange {
 public:
  Exchange(const std::vector<Whitened>& rows, const ParameterMatrix& weak, std::vector<std::size_t> design)
      : rows_(rows), design_(std::move(design)), chosen_(rows.size(), false), H_(weak) {
    for (const std::size_t j : design_) {
      chosen_[j] = true;
      H_ += rows_[j].transpose() * rows_[j];
    }
  }

  void run() {
    for (int pass = 0; pass < kPassesMax; ++pass) {
      bool any = false;
      for (std::size_t& place : design_) any = improve(place) || any;
      if (!any) return;
    }
  }
  double value() const { return log_det(H_); }
  const std::vector<std::size_t>& design() const { return design_; }

 private:
  /// Puts the best pose not yet chosen in this one's place, if it is better.
  bool improve(std::size_t& place) {
    const ParameterMatrix without = H_ - rows_[place].transpose() * rows_[place];
    const ParameterMatrix inverse = without.llt().solve(ParameterMatrix::Identity(H_.rows(), H_.cols()));
    double best = gain(rows_[place], inverse) + kGainMin;
    std::size_t best_pose = place;
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      if (chosen_[j]) continue;
      const double with = gain(rows_[j], inverse);
      if (with > best) best = with, best_pose = j;
    }
    if (best_pose == place) return false;
    chosen_[place] = false, chosen_[best_pose] = true;
    H_ = without + rows_[best_pose].transpose() * rows_[best_pose];
    place = best_pose;
    return true;
  }

  const std::vector<Whitened>& rows_;
  std::vector<std::size_t> design_;
  std::vector<bool> chosen_;
  ParameterMatrix H_;
};

}  // namespace

PoseRegion reference_region(const Pose& X_BT_home) {
  PoseRegion region;
  region.centre_B = X_BT_home.translation();
  region.tilt_max = from_deg(20);
  region.yaw_max = from_deg(15);
  return region;
}

std::vector<Pose> random_reachable_poses(const kinematics::Mechanism& mechanism, const PoseRegion& region,
                                         std::size_t count, Random& random) {
  // At least a ten-thousandth of the region must be reachable. Where far less is, the search ends early: with
  // a ten-thousandth there is no pose after kTriesForNext tries with a probability of 1 %.
  constexpr std::size_t kTriesPerPose = 10'000, kTriesForNext = 46'000;
  std::vector<Pose> poses;
  kinematics::AxisVector axes{};
  const auto n = static_cast<std::size_t>(mechanism.axis_count());
  const std::span<double> used(axes.data(), n);
  std::vector<kinematics::LimitViolation> violations;
  for (std::size_t tries = 0; poses.size() < count; ++tries) {
    if (tries >= std::min(kTriesPerPose * count, kTriesForNext * (poses.size() + 1)))
      throw InputError("pose region: " + std::to_string(poses.size()) + " of " + std::to_string(tries) +
                       " random poses are within the machine's limits, too few to choose " +
                       std::to_string(count) + " from: make the region smaller or tilt less");
    Vec3 p = region.centre_B;
    for (Eigen::Index k = 0; k < 3; ++k) p[k] += random.uniform(-1, 1) * region.half_size[k];
    const double azimuth = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double tilt = random.uniform(0, region.tilt_max);
    const double yaw = random.uniform(-region.yaw_max, region.yaw_max);
    const Mat3 R = exp_rotation(tilt * Vec3(std::cos(azimuth), std::sin(azimuth), 0)) *
                   exp_rotation(yaw * Vec3::UnitZ()) * mechanism.home().linear();
    const Pose X_BT = make_pose(R, p);
    if (mechanism.inverse(X_BT, {}, used) != kinematics::SolveStatus::ok) continue;
    violations.clear();
    mechanism.check(X_BT, used, violations);
    if (violations.empty()) poses.push_back(X_BT);
  }
  return poses;
}

double log_det_information(const DesignSetting& setting, std::span<const Pose> poses) {
  ParameterMatrix H = prior(setting);
  for (const Whitened& rows : whitened_rows(setting, poses)) H += rows.transpose() * rows;
  return log_det(H);
}

std::vector<std::size_t> d_optimal(const DesignSetting& setting, std::span<const Pose> candidates,
                                   std::size_t count, Random& random, int starts) {
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  if (candidates.size() <= count) return order;
  const std::vector<Whitened> rows = whitened_rows(setting, candidates);
  const ParameterMatrix weak = prior(setting);
  std::vector<std::size_t> best;
  double best_value = -std::numeric_limits<double>::infinity();
  for (int start = 0; start < starts; ++start) {
    for (std::size_t n = 0; n < count; ++n) {
      const auto left = static_cast<double>(order.size() - n);
      std::swap(order[n], order[n + static_cast<std::size_t>(random.uniform() * left)]);
    }
    Exchange exchange(rows, weak, {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count)});
    exchange.run();
    if (exchange.value() > best_value) best_value = exchange.value(), best = exchange.design();
  }
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace understudy::calibration

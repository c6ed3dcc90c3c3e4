// A machine built beside its drawing, driven to random poses and measured there with noise: without a twin.
#pragma once

#include <cmath>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/machine/measurement_table.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "core/random.h"
#include "machine/description.h"

namespace understudy::calibration {

/// Parameters of the hexapod are off by 0.5 mm, of a chain by 0.3 mm and 2 mrad, 1 sigma each.
class BuiltMachine {
 public:
  BuiltMachine(const machine::MachineDescription& drawn, std::uint64_t seed) : seed_(seed) {
    Random random(seed, "built machine");
    if (!drawn.is_chain()) {
      hexapod_.geometry = perturbed(drawn.hexapod().geometry, 0.5e-3, random);
      return;
    }
    const ChainParameters nominal{drawn.chain().kinematics.chain, {}};
    Eigen::VectorXd by(static_cast<Eigen::Index>(chain_parameter_names(nominal.chain).size()));
    const auto names = chain_parameter_names(nominal.chain);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const bool length = names[k].find("shift") != std::string::npos || names[k].ends_with(" x") ||
                          names[k].ends_with(" y") || names[k].ends_with(" z");
      const bool turn = names[k].find("turn") != std::string::npos;
      by[static_cast<Eigen::Index>(k)] = (length && !turn ? 0.3e-3 : 2e-3) * random.normal();
    }
    chain_ = moved(nominal, by);
  }

  /// Where axes that a controller of `known` commands really put the tool. False where it cannot be.
  bool reached(const machine::MachineDescription& known, const std::vector<double>& axes,
               const Pose& X_BT_asked, Pose& X_BT) const {
    if (known.is_chain()) {
      X_BT = forward(chain_, axes);
      return true;
    }
    PoseSample sample;
    kinematics::StrutLengths lengths{};
    std::copy_n(axes.begin(), lengths.size(), lengths.begin());
    sample.displacement = displacements(known.hexapod().geometry, lengths);
    const auto found = kinematics::forward(hexapod_.geometry, strut_lengths(hexapod_, sample), X_BT_asked);
    X_BT = found.X_BT;
    return found.status == kinematics::SolveStatus::ok;
  }

  /// `count` poses near home, measured to 20 um and 0.2 mrad.
  Measurements measured(const machine::MachineDescription& known, std::size_t count) const {
    const auto mechanism = known.make_mechanism();
    PoseRegion region = reference_region(known.X_BT_home);
    if (known.is_chain()) region.tilt_max = 0.7, region.yaw_max = 1.5, region.half_size = Vec3::Constant(0.1);
    Random poses(seed_, "measured poses"), noise(seed_, "measurement noise");
    Measurements table;
    table.noise_given = true;
    for (const Pose& X_BT : random_reachable_poses(*mechanism, region, count, poses)) {
      MeasuredPose pose;
      pose.axes.resize(static_cast<std::size_t>(mechanism->axis_count()));
      if (mechanism->inverse(X_BT, {}, pose.axes) != kinematics::SolveStatus::ok) continue;
      PoseSample sample;
      if (!reached(known, pose.axes, X_BT, sample.X_BT)) continue;
      sample.X_BT = known.X_WB * sample.X_BT;
      sample.covariance = kReferenceNoise.covariance();
      pose.X_WT = calibration::measured(sample, noise).X_BT;
      pose.covariance = sample.covariance;
      table.poses.push_back(pose);
    }
    return table;
  }

  /// RMS distance [m] between asked and true tip at poses that were not measured.
  double open_loop_rms(const machine::MachineDescription& known) const {
    const auto mechanism = known.make_mechanism();
    Random random(99, "held-out poses");
    double squares = 0;
    int count = 0;
    for (const Pose& X : random_reachable_poses(*mechanism, reference_region(known.X_BT_home), 60, random)) {
      std::vector<double> axes(static_cast<std::size_t>(mechanism->axis_count()));
      Pose X_BT;
      if (mechanism->inverse(X, {}, axes) != kinematics::SolveStatus::ok) continue;
      if (!reached(known, axes, X, X_BT)) continue;
      squares += (X_BT.translation() - X.translation()).squaredNorm();
      ++count;
    }
    return std::sqrt(squares / count);
  }

 private:
  std::uint64_t seed_;
  HexapodParameters hexapod_;
  ChainParameters chain_;
};

}  // namespace understudy::calibration

// The nominal machine of models/hexapod and synthetic calibrations of machines built about it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "calibration/bound.h"
#include "calibration/estimators/estimator.h"
#include "calibration/pose_choice.h"
#include "calibration/synthetic.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::calibration {

struct Rig {
  machine::MachineDescription machine = machine::load_machine("hexapod");
  std::unique_ptr<kinematics::Mechanism> mechanism = machine.make_mechanism();
  const HexapodGeometry& nominal = machine.hexapod().geometry;
  PoseRegion region = reference_region(machine.X_BT_home);

  std::vector<Pose> poses(std::size_t count, Random& random) const {
    return random_reachable_poses(*mechanism, region, count, random);
  }
};

inline const Rig& rig() {
  static const Rig shared;
  return shared;
}

/// A built machine, its exact samples and poses held out.
struct Case {
  HexapodParameters truth;
  std::vector<PoseSample> exact;
  std::vector<Pose> held_out;

  Problem problem() const { return {{rig().nominal, {}}, exact}; }
  Problem noisy(Random& random) const {
    Problem p{{rig().nominal, {}}, {}};
    for (const PoseSample& sample : exact) p.samples.push_back(measured(sample, random));
    return p;
  }
  /// [m], of the tip at the held-out poses, ascending.
  std::vector<double> tip_errors(const HexapodParameters& model) const {
    std::vector<double> errors;
    Twist e;
    for (const Pose& X_BT : held_out)
      errors.push_back(driven_error(truth, model, X_BT, e) ? e.head<3>().norm() : 1);
    std::sort(errors.begin(), errors.end());
    return errors;
  }
  double median_tip_error(const HexapodParameters& model) const {
    return tip_errors(model)[held_out.size() / 2];
  }
};

/// Displacements by the truth's inverse kinematics at the poses themselves: exact to rounding.
inline Case make_case(std::uint64_t seed, std::size_t poses, double deviation = -1) {
  Random random(seed, "calibration case");
  Case c;
  c.truth.geometry = perturbed(rig().nominal, 0.5e-3, random);
  if (deviation >= 0) c.truth.geometry.deviation = deviation;
  for (const Pose& X_BT : rig().poses(poses, random)) {
    PoseSample sample;
    sample.X_BT = X_BT;
    sample.covariance = kReferenceNoise.covariance();
    StrutLengths lengths;
    if (inverse(c.truth.geometry, X_BT, lengths) != kinematics::SolveStatus::ok) continue;
    sample.displacement = displacements(c.truth.geometry, lengths);
    c.exact.push_back(sample);
  }
  c.held_out = rig().poses(60, random);
  return c;
}

inline double largest_error(const HexapodGeometry& a, const HexapodGeometry& b) {
  double worst = 0;
  for (std::size_t i = 0; i < kStruts; ++i)
    worst = std::max({worst, (a.base_joint[i] - b.base_joint[i]).cwiseAbs().maxCoeff(),
                      (a.platform_joint[i] - b.platform_joint[i]).cwiseAbs().maxCoeff(),
                      std::abs(a.length_offset[i] - b.length_offset[i])});
  return worst;
}

}  // namespace understudy::calibration

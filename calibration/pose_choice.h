// Which poses to measure: drawn at random where the machine can go, or the D-optimal ones of such a draw.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibration/problem.h"
#include "core/random.h"

namespace understudy::calibration {

/// Tip positions in a box, orientations relative to home: tilted about a horizontal axis, then turned about
/// the tool's. All uniform.
struct PoseRegion {
  Vec3 centre_B = Vec3::Zero();      ///< [m]
  Vec3 half_size{0.05, 0.05, 0.05};  ///< [m]
  double tilt_max = 0;               ///< [rad]
  double yaw_max = 0;                ///< [rad], both ways
};

/// The region of docs/reference.md#calibration-figures about the machine's home: a 100 mm cube, tilt to 20,
/// yaw to 15 deg.
PoseRegion reference_region(const Pose& X_BT_home);

/// `count` poses that break no limit of the mechanism. Throws InputError when hardly any of the region is
/// reachable.
std::vector<Pose> random_reachable_poses(const kinematics::Mechanism& mechanism, const PoseRegion& region,
                                         std::size_t count, Random& random);

/// What a design is made for: the machine as far as it is known, and the noise of every measured pose.
struct DesignSetting {
  HexapodParameters machine;
  Mat6 covariance = Mat6::Identity();
  Unknowns unknowns;
};

/// Log of det of the information of these poses, with a prior so weak (10 mm on every parameter) that it
/// matters only where poses do not tell a parameter at all.
double log_det_information(const DesignSetting& setting, std::span<const Pose> poses);

/// Indices into `candidates`, in ascending order, of `count` different poses whose det of information no
/// single exchange raises (Fedorov 1972, exchanges in the order of Cook and Nachtsheim 1980). From the best
/// of `starts` random designs; all candidates where there are no more than `count`.
std::vector<std::size_t> d_optimal(const DesignSetting& setting, std::span<const Pose> candidates,
                                   std::size_t count, Random& random, int starts = 3);

}  // namespace understudy::calibration

// Machines and measurements whose truth is known, by seed.
#pragma once

#include "calibration/problem.h"
#include "core/random.h"

namespace understudy::calibration {

/// 1 sigma per axis of a measured pose.
struct MeasurementNoise {
  double position = 0;  ///< [m]
  double rotation = 0;  ///< [rad]
  Mat6 covariance() const;
};
/// docs/reference.md#calibration-figures: 20 um and 0.2 mrad.
constexpr MeasurementNoise kReferenceNoise{20e-6, 0.2e-3};

/// Every one of the 42 parameters off by normal numbers of this standard deviation [m].
HexapodGeometry perturbed(const HexapodGeometry& nominal, double sigma, Random& random);

/// What the truth makes of a pose asked for through the nominal model, measured without noise. The noise's
/// covariance is told all the same. False where either has no answer.
bool true_sample(const HexapodParameters& truth, const HexapodGeometry& nominal, const Pose& X_BT_asked,
                 const MeasurementNoise& noise, const kinematics::PerStrut<Approach>& approach,
                 PoseSample& sample);

/// With noise of its own covariance added.
PoseSample measured(const PoseSample& true_sample, Random& random);

}  // namespace understudy::calibration

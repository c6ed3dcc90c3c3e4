// What the best unbiased estimator can reach: the Cramer-Rao bound of the parameters for given poses, noise
// and machine, and what it means at the tip.
#pragma once

#include <span>

#include "calibration/strut_model.h"

namespace understudy::calibration {

/// Fisher information of samples whose X_BT are the true poses: sum of G^T (J S J^T)^-1 G.
ParameterMatrix information(const HexapodParameters& machine, std::span<const PoseSample> samples,
                            const Unknowns& unknowns);

/// Covariance that no unbiased estimator can be below. Empty where the poses do not tell all unknowns apart.
ParameterMatrix parameter_bound(const HexapodParameters& machine, std::span<const PoseSample> samples,
                                const Unknowns& unknowns);

/// How a covariance of parameters moves the tip of a machine that is driven by them. Also the uncertainty of
/// a calibration over the work space.
struct TipUncertainty {
  double rms = 0;                 ///< [m], of the 3D error over the poses
  std::vector<Mat3> covariances;  ///< [m^2], in B, one a pose
};
TipUncertainty tip_uncertainty(const HexapodParameters& machine, const ParameterMatrix& covariance,
                               const Unknowns& unknowns, std::span<const Pose> poses);

/// Where `truth` goes when `model` computes the displacements for X_BT: the pose error (reached less asked).
/// False where either has no answer.
bool driven_error(const HexapodParameters& truth, const HexapodParameters& model, const Pose& X_BT,
                  Twist& error);

}  // namespace understudy::calibration

// What a calibration's covariance means at the tip, over the work space.
#pragma once

#include <functional>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/machine/measuring_frame.h"
#include "calibration/problem.h"
#include "machine/description.h"

namespace understudy::calibration {

/// 3D uncertainty of the tip, 1 sigma, that is left by the calibration and by the measuring frame.
struct TipMap {
  double median = 0, worst = 0, rms = 0;     ///< [m], over poses drawn from the work space
  double moved_median = 0, moved_worst = 0;  ///< [m], of the same poses between old and new model
  int poses = 0;
  /// At home's orientation: upright planes through home, across y and across z. NaN: cannot be reached.
  struct Slice {
    char u = 'x', v = 'y';
    double u0 = 0, v0 = 0, step = 0;  ///< [m], first point in W
    int columns = 0, rows = 0;
    std::vector<double> sigma;  ///< [m], row by row
  };
  std::vector<Slice> slices;
};

/// Covariance of the tip [m^2] at a pose that the calibrated machine is driven to; false where it cannot go.
using TipCovariance = std::function<bool(const Pose& X_BT, Mat3& covariance)>;

/// `before` knows the machine as it was known, `after` as it is known now. Throws InputError where that one
/// reaches next to nothing of the work space.
TipMap tip_map(const machine::MachineDescription& before, const machine::MachineDescription& after,
               const TipCovariance& covariance, const Progress& progress = {});

TipCovariance hexapod_tip(const machine::MachineDescription& machine, const Calibration& calibration,
                          const Unknowns& unknowns);
TipCovariance chain_tip(const machine::MachineDescription& machine, const ChainCalibration& calibration);

/// With the share of the frame in which the tips were measured; their middle is at `middle_W`.
TipCovariance in_frame(const TipCovariance& covariance, const MeasuringFrame& frame, const Vec3& middle_W,
                       const Pose& X_WB);

}  // namespace understudy::calibration

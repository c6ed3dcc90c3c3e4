// What the calibration of laser and microscope leaves of the gap that the sensor reads: an error that all
// readings of a place share, so that no averaging takes it away (docs/gap-sensor-calibration.md).
#pragma once

#include <string>

#include "control/gap/local_surface.h"
#include "machine/description.h"

namespace understudy::control {

/// 1 sigma [m] of a reading of this gap over this surface: the covariance of the mounting, through the
/// reading's first derivatives. 0 where the machine file has no `gap_sensor`; infinite where no dot is seen.
/// Does not allocate.
double calibration_sigma(const machine::MachineDescription& machine, const LocalSurface& surface, double gap);

/// Error of a reading of this gap for each freedom of the mounting [m/m], [m/rad] and [m]. False where no dot
/// is seen. Does not allocate.
bool reading_derivatives(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                         machine::MountingVector& derivatives);

/// A gap to aim at with such a sensor.
struct SafeAim {
  double gap = 0;    ///< [m]
  double sigma = 0;  ///< [m], calibration_sigma() there
  bool fits = true;  ///< 3 sigma on both sides stay within the accepted gaps
};

/// Why a print stops whose aim does not fit, for the operator.
std::string too_uncertain(const machine::GapLimits& limits, double sigma);

/// `aim` [m], or as far inside the accepted gaps as three standard deviations of calibration and noise need;
/// their middle where they do not fit. Without a `gap_sensor` it is `aim`. Does not allocate.
SafeAim safe_aim(const machine::MachineDescription& machine, const LocalSurface& surface, double aim);

}  // namespace understudy::control

// Finds the clamped part: the gap sensor looks at it from places all over, and the part is where its readings
// fit best (docs/registration.md).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/gap/gap_controller.h"
#include "control/registration/part_fit.h"
#include "control/registration/pattern.h"
#include "control/stop.h"

namespace understudy::control {

struct RegistrationTask {
  std::shared_ptr<const geometry::Mesh> part;  ///< as drawn, in W
  std::vector<ProbingPlace> places;            ///< in the order in which they are wanted
  int wanted = kPlacesDefault;  ///< readings; what is left of `places` takes the place of failed ones
  PartTolerance tolerance;      ///< of how the part is clamped
  /// [m], 1 sigma of a place beside the reading's noise: waviness of the part, what the machine's calibration
  /// leaves of the tip from place to place, repeatability.
  double place_sigma = 10e-6;
  std::optional<GapControllerOptions> gap;  ///< nothing: gap_controller_options() of the machine
};

/// One place, as it was measured.
struct PlaceReading {
  ProbingPlace place;
  GapOutcome outcome;
  Pose X_WT_end = Pose::Identity();  ///< commanded, where the gap was read last
  MeasuredPoint point;               ///< where `measured`
  double reading_sigma = 0;          ///< [m], of the reading's noise along the normal
  bool measured = false;
  std::string why;      ///< not measured: one line
  double residual = 0;  ///< [m], off the part where it was found
};

struct Registration {
  std::vector<PlaceReading> places;  ///< in the order of measuring
  std::optional<PartFit> fit;
  Stop stop;            ///< the machine failed
  std::string refused;  ///< why the part is not where the program may be printed; empty: `fit` holds
  double duration = 0;  ///< [s], port clock

  bool good() const { return fit.has_value() && refused.empty() && !stop; }
  int measured() const;
};

/// What the sensor's calibration leaves of a reading, as `MeasuredPoint::common`: of the machine file's
/// `gap_sensor`, else of its tolerances of mounting, else nothing.
Eigen::VectorXd common_errors(const machine::MachineDescription& machine, const LocalSurface& surface,
                              double gap, double normal_share);

/// Looks at the places one after the other, from above all of the part each time, and ends at home. A place
/// whose reading fails is left out and named. Without six readings, and where the readings do not fit the
/// drawn part, it is refused. Throws Interrupted.
Registration register_part(const RegistrationTask& task, const machine::MachineDescription& machine,
                           machine::MachinePort& port);

}  // namespace understudy::control

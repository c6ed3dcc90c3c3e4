// From tables of measured pixels to a calibrated hexapod (docs/calibration-data.md#all-pictures-at-once).
#pragma once

#include <string>

#include "calibration/bundle/bundle_adjustment.h"
#include "calibration/machine/machine_calibration.h"
#include "machine/default_machine.h"

namespace understudy::calibration {

struct BundleRequest {
  std::string machine = machine::kDefaultMachine;  ///< name or path
  std::string rig;                                 ///< the measuring set-up's file
  std::string corners;                             ///< CSV of `understudy measure board`
  std::string targets;                             ///< CSV of `understudy measure targets`
  std::string commanded;                           ///< CSV: a row for each pose from 1, as it was commanded
  double warming = 0;   ///< [m], growth of the struts during the session that is thought possible; 0: none
  std::string command;  ///< for the record: how a user repeats this
};

/// The plays are unknown where `commanded` has the columns a1..a6; else half of the nominal play counts as
/// noise of each length. `dev` and the leads are unknown within the machine file's tolerances. A pose of
/// which not all targets were found is left out with a warning. Throws InputError with file and line for
/// what a table lacks, for a chain, and for data that cannot be adjusted.
MachineCalibration calibrate_bundle(const BundleRequest& request);

/// What a controller knows of its drives before any picture: of the machine file's tolerances.
DriveTolerance drive_tolerance(const machine::MachineDescription& machine, bool play_unknown);

}  // namespace understudy::calibration

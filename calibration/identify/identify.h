// What a port record tells of the machine that wrote it (docs/identify.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/identify/axis_fit.h"
#include "machine/calibrated_parameters.h"
#include "machine/default_machine.h"
#include "machine/record/recorded_motion.h"

namespace understudy::calibration {

struct IdentifyRequest {
  std::string record;                               ///< path of a port record
  std::string machine = machine::kDefaultMachine;   ///< name or path
  std::optional<double> noise_length, noise_angle;  ///< [m], [rad], 1 sigma of a reading; else of its count
  std::string command;                              ///< for the record: how a user repeats this
};

struct IdentifiedAxis {
  std::string name;
  bool angle = false;
  double noise = 0;             ///< [m] or [rad], of a reading behind the play, that was reckoned with
  double play_before = 0;       ///< [m] or [rad], of the machine file
  AxisFit drive;                ///< by the drives' own readings: only the lag is of use
  std::optional<AxisFit> load;  ///< by encoders behind the play
};

struct Identification {
  machine::MachineDescription machine;  ///< with what was found, as far as its file has a place for it
  machine::CalibratedParameters stored;
  bool geometry_written = false;  ///< of a hexapod without a calibration: its zero offsets are in `machine`
  std::string record, record_sha256, command;
  double seconds = 0;  ///< of the record
  std::vector<IdentifiedAxis> axes;
  std::vector<std::string> untold;    ///< parameters that stay as they were, and why
  std::vector<std::string> warnings;  ///< chi-square, a record that was cut short
};

/// Throws InputError for a record that cannot be used: of another machine, or too short to tell anything.
Identification identify(const IdentifyRequest& request);

/// An as-built file (docs/scenarios.md) of the machine that was found: a twin built by it follows the record.
std::string as_built_text(const Identification& found);

}  // namespace understudy::calibration

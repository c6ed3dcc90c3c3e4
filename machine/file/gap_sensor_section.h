// The optional section `gap_sensor` of machine.yaml: laser and microscope as a calibration found them, which
// the controller uses in place of the drawn ones.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {

/// Farther from the drawing, a device belongs to another machine.
constexpr double kMountingFar = 5e-3;      // [m]
constexpr double kMountingTurned = 0.17;   // [rad], 10 deg
constexpr double kMountingScaleOff = 0.2;  // of the drawn scale
constexpr double kWaistOff = 0.5;          // of the drawn waist

/// Where the file has one; after laser and microscope. Throws InputError for a part that is missing or far
/// from what is drawn, and for a covariance that is none.
void read_gap_sensor(YamlMap& root, MachineDescription& machine);

/// The section for `machine`, whose laser, microscope and record are the calibrated ones.
std::string gap_sensor_section(const MachineDescription& machine);

}  // namespace understudy::machine

// The optional section `calibration` of machine.yaml: a measured geometry that the controller uses in place
// of the drawn one.
#pragma once

#include <string>

#include "core/yaml/yaml_map.h"
#include "machine/calibrated_parameters.h"
#include "machine/description.h"
#include "machine/file/section_text.h"

namespace understudy::machine {

/// Farther from the drawing, a joint or an axis belongs to another machine, or its file to other units.
constexpr double kFarFromDrawing = 25e-3;    // [m]
constexpr double kTurnedFromDrawing = 0.17;  // [rad], 10 deg
/// What the zeros of a chain's axes turn: at zero the tool and the axes are off by that much of the reach
/// too.
constexpr double kZeroFromDrawing = 0.1;  // [rad], 6 deg

/// Throws InputError for a machine whose inverse kinematics cannot follow measured axes.
void require_calibratable(const MachineDescription& machine);

/// Where the file has one; after the geometry and the axes. Throws InputError for a part that is missing,
/// told twice, or far from what is drawn, and for a covariance that is none.
void read_calibration(YamlMap& root, MachineDescription& machine, CalibratedParameters& parameters);

/// The keys `play_um` and `covariance_mm_rad` of the section; `machine` has its axes already.
CalibratedParameters read_calibrated_parameters(YamlMap& map, const MachineDescription& machine);
std::string calibrated_parameters_text(const MachineDescription& machine,
                                       const CalibratedParameters& parameters);

/// The section for `machine`, whose geometry (or chain) and calibration record are the calibrated ones.
std::string calibration_section(const MachineDescription& machine,
                                const CalibratedParameters& parameters = {});

/// Writes the machine file at `path`: that of `machine` with the section above, as write_with_section() does.
void write_calibrated(const MachineDescription& machine, const std::filesystem::path& path,
                      const CalibratedParameters& parameters = {});

}  // namespace understudy::machine

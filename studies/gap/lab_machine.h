// A machine as a lab has it before its first print: built within its manufacturing tolerances, then its
// geometry calibrated from measured poses and its gap sensor from pictures over a flat.
#pragma once

#include <cstdint>
#include <string>

#include "machine/calibrated_parameters.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"

namespace understudy::studies {

struct LabMachine {
  machine::MachineDescription machine;  ///< calibrated: what the controller holds
  machine::CalibratedParameters calibrated;
  sim::AsBuilt built;                 ///< what stands there, with its clamped part
  machine::MachineDescription truth;  ///< sim::true_description() of both
};

/// Its geometry alone.
struct CalibratedGeometry {
  machine::MachineDescription machine;  ///< calibrated
  machine::CalibratedParameters calibrated;
};

/// How a lab calibrates the geometry; the defaults are those of `sample-poses` and `calibrate`.
struct LabCalibration {
  std::string engine;  ///< plant that the machine is driven on to be measured; empty: it has no play there
  std::string estimator = "maximum_likelihood";
  int poses = 24;
};

/// The drawn machine built with this seed, and calibrated.
CalibratedGeometry calibrate_lab_geometry(const machine::MachineDescription& drawn, std::uint64_t seed,
                                          const LabCalibration& how = {});

/// The drawn machine built with this seed and calibrated with the defaults of `sample-poses`, `calibrate`,
/// `sample-gaps` and `calibrate gap-sensor` (bench/print/built_machines.py), with no file between them.
/// Throws InputError for a machine without tolerances, microscope or mounting tolerances.
LabMachine make_lab_machine(const machine::MachineDescription& drawn, std::uint64_t seed);

}  // namespace understudy::studies

// How warm a bead still is after some time: what the next one is laid on.
#pragma once

#include <vector>

#include "machine/description.h"
#include "machine/material.h"
#include "sim/deposition/cooling.h"

namespace understudy::sim {

/// A bead as wide as a strand that leaves the nozzle freely, cooled by air alone: what it gives to the
/// material below makes it colder, so an interface is reported too warm rather than too cold in the first
/// second and is at ambient on both counts later. The fan counts as it is now, in tenths.
class BeadTemperature {
 public:
  BeadTemperature(const machine::MachineDescription& machine, const machine::Material& material);
  double operator()(double age, double fan) const;  ///< [K]

 private:
  std::vector<CoolingCurve> curves_;  // by tenths of the fan
};

/// [m] of a strand that leaves the machine's nozzle freely.
double free_strand_diameter(const machine::MachineDescription& machine);

}  // namespace understudy::sim

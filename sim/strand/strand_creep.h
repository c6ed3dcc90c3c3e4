// What the temperature of a strand's section means for its mechanics: how far it creeps between two ages.
#pragma once

#include "machine/material.h"
#include "sim/deposition/cooling.h"

namespace understudy::sim {

class StrandCreep {
 public:
  /// Throws InputError where the strand does not start above the glass transition or never falls below it.
  StrandCreep(const machine::Material& material, double diameter, double start_temperature,
              const Surroundings& surroundings);

  /// [1/Pa], integral of 1/(3 eta) over the ages [s] from..to; 0 below the glass transition.
  double between(double from, double to) const;
  double time_to_solid() const { return time_to_solid_; }  ///< [s], of age
  /// [s], age at which the temperature is that share of the way from the nozzle's to the glass transition.
  double time_at_share(double share) const;

 private:
  machine::Material material_;
  CoolingCurve cooling_;
  double time_to_solid_;
};

}  // namespace understudy::sim

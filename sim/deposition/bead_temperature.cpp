#include "sim/deposition/bead_temperature.h"

#include <algorithm>
#include <cmath>

namespace understudy::sim {
namespace {

constexpr double kSwell = 1.2;  // of the bore: Ishak 2018 draws 0.48 mm struts from a 0.4 mm nozzle
constexpr int kFanSteps = 10;

}  // namespace

double free_strand_diameter(const machine::MachineDescription& machine) {
  const double described = machine.process.free_strand_diameter;
  return described > 0 ? described : kSwell * machine.tool.nozzle_diameter;
}

BeadTemperature::BeadTemperature(const machine::MachineDescription& machine,
                                 const machine::Material& material) {
  for (int k = 0; k <= kFanSteps; ++k) {
    Surroundings air;
    air.temperature = machine.process.ambient_temperature;
    air.air_speed = machine.process.fan_air_speed * k / kFanSteps;
    curves_.emplace_back(material, free_strand_diameter(machine), material.nozzle_temperature, air);
  }
}

double BeadTemperature::operator()(double age, double fan) const {
  const auto k = static_cast<std::size_t>(std::lround(std::clamp(fan, 0.0, 1.0) * kFanSteps));
  return curves_[k].temperature(age);
}

}  // namespace understudy::sim

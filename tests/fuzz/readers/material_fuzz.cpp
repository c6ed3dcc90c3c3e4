// Bytes as a material file.
#include "machine/material.h"
#include "tests/fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  static const fuzz::InputFile input("material.yaml");
  const std::string file = input.fill(fuzz::text_of(data, size)).string();
  machine::Material m;
  if (!fuzz::accepts(size, file, [&] { m = machine::load_material(file); })) return 0;
  fuzz::require_finite(std::vector{m.density, m.specific_heat, m.conductivity, m.emissivity, m.youngs_modulus,
                                   m.poisson_ratio, m.glass_transition, m.wlf_c1, m.wlf_c2,
                                   m.nozzle_temperature, m.nozzle_temperature_min, m.nozzle_temperature_max},
                       "a number of the material");
  // What was accepted can be extruded at its own temperatures, and flows there.
  for (const double at : {m.nozzle_temperature, m.nozzle_temperature_min, m.nozzle_temperature_max}) {
    machine::check_nozzle_temperature(m, at);
    const double viscosity = machine::viscosity(m, at);
    fuzz::require(viscosity > 0 && viscosity <= 1e12, "a viscosity that is none");
  }
  return 0;
}

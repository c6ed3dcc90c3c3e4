// Filament materials: one YAML file each under models/materials (docs/materials.md explains every key).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace understudy::machine {

struct Material {
  std::string name;
  double density = 0;           ///< [kg/m^3]
  double specific_heat = 0;     ///< [J/(kg K)]
  double conductivity = 0;      ///< [W/(m K)]
  double emissivity = 0;        ///< of the strand's surface, 0..1
  double youngs_modulus = 0;    ///< [Pa], below the glass transition
  double poisson_ratio = 0;     ///< below the glass transition
  double glass_transition = 0;  ///< [K]
  double wlf_c1 = 0;
  double wlf_c2 = 0;                                              ///< [K]
  double nozzle_temperature = 0;                                  ///< [K], where a program sets none
  double nozzle_temperature_min = 0, nozzle_temperature_max = 0;  ///< [K], outside: refused
};

/// `name_or_path` is a name under models_folder()/materials or a path of a file, and may change its
/// values: `abs{glass_transition_c: 95}`. Throws InputError naming the known materials, or file, line, key,
/// value and limit.
Material load_material(const std::string& name_or_path);

/// Its file. Throws InputError naming the known materials.
std::filesystem::path find_material(const std::string& name_or_path);

/// Names of the shipped materials, sorted.
std::vector<std::string> material_names();

/// [Pa s] of shear, at T [K]: 10^(12 - C1 (T - Tg)/(C2 + T - Tg)) (Williams, Landel and Ferry 1955, with
/// 10^12 Pa s at the glass transition); infinity below the glass transition, where the material is elastic.
double viscosity(const Material& material, double temperature);

/// Throws InputError when `temperature` [K] is not one that this material may be extruded at.
void check_nozzle_temperature(const Material& material, double temperature);

}  // namespace understudy::machine

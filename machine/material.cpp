#include "machine/material.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/file_cache.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "machine/description.h"
#include "machine/model_files.h"

namespace understudy::machine {
namespace fs = std::filesystem;
namespace {

/// A models folder of the user's own need not hold materials: the shipped ones serve then.
fs::path materials_folder() {
  std::error_code error;
  const fs::path own = models_folder() / "materials";
  return fs::is_directory(own, error) ? own : shipped_models_folder() / "materials";
}

}  // namespace

fs::path find_material(const std::string& name_or_path) {
  if (name_or_path.empty()) throw InputError("the material has no name");
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".yaml") ||
      name_or_path.ends_with(".yml"))
    return name_or_path;
  const std::vector<std::string> names = material_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return materials_folder() / (name_or_path + ".yaml");
  if (names.empty())
    throw InputError(fmt::format("unknown material '{}': no material is described in {}", name_or_path,
                                 materials_folder().string()));
  const std::string near = nearest_word(name_or_path, names);
  throw InputError(fmt::format("unknown material '{}'{}; known materials: {}", name_or_path,
                               near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                               fmt::join(names, ", ")));
}

namespace {

double celsius(YamlMap& map, const std::string& key, Bounds bounds, const char* about) {
  return kCelsiusZero + map.quantity(key, bounds, about);
}

void check_temperatures(const YamlMap& map, const Material& m) {
  const auto in_c = [](double kelvin) { return kelvin - kCelsiusZero; };
  if (m.nozzle_temperature_min <= m.glass_transition)
    throw InputError(map.place("nozzle_min_c"),
                     fmt::format("nozzle_min_c is {:.1f} C, not above the glass transition at {:.1f} C",
                                 in_c(m.nozzle_temperature_min), in_c(m.glass_transition)));
  if (m.nozzle_temperature_max < m.nozzle_temperature_min)
    throw InputError(map.place("nozzle_max_c"),
                     fmt::format("nozzle_max_c is {:.1f} C, below nozzle_min_c of {:.1f} C",
                                 in_c(m.nozzle_temperature_max), in_c(m.nozzle_temperature_min)));
  if (m.nozzle_temperature < m.nozzle_temperature_min || m.nozzle_temperature > m.nozzle_temperature_max)
    throw InputError(
        map.place("nozzle_c"),
        fmt::format("nozzle_c is {:.1f} C, outside nozzle_min_c to nozzle_max_c, {:.1f} to {:.1f} C",
                    in_c(m.nozzle_temperature), in_c(m.nozzle_temperature_min),
                    in_c(m.nozzle_temperature_max)));
}

void read_material(YamlMap& map, Material& m) {
  m.name = map.text("name", "shown in reports");
  m.density = map.quantity("density_kg_per_m3", {100, 20000}, "of the solid");
  m.specific_heat = map.quantity("specific_heat_j_per_kg_k", {100, 10000}, "of the solid");
  m.conductivity = map.quantity("conductivity_w_per_m_k", {0.01, 500}, "of heat");
  m.emissivity = map.quantity("emissivity", {0, 1}, "of the surface");
  m.youngs_modulus = map.quantity("youngs_modulus_gpa", {0.001, 500}, "below the glass transition");
  m.poisson_ratio = map.quantity("poisson_ratio", {0, 0.5}, "below the glass transition");
  m.glass_transition = celsius(map, "glass_transition_c", {-100, 400}, "where it hardens");
  m.wlf_c1 = map.quantity("wlf_c1", {1, 40}, "Williams-Landel-Ferry, first constant");
  m.wlf_c2 = map.quantity("wlf_c2_k", {1, 500}, "Williams-Landel-Ferry, second constant");
  m.nozzle_temperature = celsius(map, "nozzle_c", {20, 500}, "usual nozzle temperature");
  m.nozzle_temperature_min = celsius(map, "nozzle_min_c", {20, 500}, "lowest nozzle temperature");
  m.nozzle_temperature_max = celsius(map, "nozzle_max_c", {20, 500}, "highest nozzle temperature");
  if (map.complete()) check_temperatures(map, m);
}

}  // namespace

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(materials_folder(), error)) {
    std::error_code ignored;
    if (entry.path().extension() == ".yaml" && fs::is_regular_file(entry.path(), ignored))
      names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

namespace {
Material read_file_of(const std::string& name_or_path) {
  const ChangedFile changed = changed_file(name_or_path);
  const fs::path path = find_material(changed.file);
  Material material;
  YamlMap::read_text(read_file(path), path.string() + changed.braces(),
                     [&](YamlMap& map) { read_material(map, material); });
  return material;
}
}  // namespace

Material load_material(const std::string& name_or_path) {
  return *cached<Material>(name_or_path, [&] { return read_file_of(name_or_path); });
}

MapSchema material_schema() {
  return YamlMap::schema([](YamlMap& map) {
    Material material;
    read_material(map, material);
  });
}

double viscosity(const Material& material, double temperature) {
  const double above = temperature - material.glass_transition;
  if (!(above >= 0)) return std::numeric_limits<double>::infinity();
  return std::pow(10.0, 12 - material.wlf_c1 * above / (material.wlf_c2 + above));
}

void check_nozzle_temperature(const Material& material, double temperature) {
  if (temperature >= material.nozzle_temperature_min && temperature <= material.nozzle_temperature_max)
    return;
  throw InputError(fmt::format("nozzle temperature is {:.1f} C, outside {:.1f} to {:.1f} C of material {}{}",
                               temperature - kCelsiusZero, material.nozzle_temperature_min - kCelsiusZero,
                               material.nozzle_temperature_max - kCelsiusZero, material.name,
                               temperature <= material.glass_transition
                                   ? fmt::format(" and not above its glass transition at {:.1f} C",
                                                 material.glass_transition - kCelsiusZero)
                                   : ""));
}

}  // namespace understudy::machine

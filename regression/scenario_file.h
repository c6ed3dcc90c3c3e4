// Scenario files: reading them, and finding them in folders.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/yaml/map_schema.h"
#include "regression/scenario.h"

namespace understudy::regression {

/// Paths in the file are relative to it; here they are not any more. Throws InputError with file and line for
/// an unknown key or word (naming the nearest known one), a missing key, a wrong type, a file that is not
/// there, an expectation without a bound, and a unit that is not the metric's. Takes its golden file in,
/// where there is one. The word may change values of the file: `bottle.yaml{turn_deg: 3}`.
Scenario load_scenario(const std::filesystem::path& path);

/// The keys of a scenario file, as load_scenario() asks for them.
MapSchema scenario_schema();

/// Scenario files among `paths`: files as they are, folders by their *.yaml, sorted. Throws InputError for a
/// path that does not exist and a folder without scenarios.
std::vector<std::filesystem::path> find_scenarios(std::span<const std::filesystem::path> paths);

}  // namespace understudy::regression

// Golden files: the figures of a run that was accepted, so that a later one shows any change.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/yaml/map_schema.h"
#include "regression/expectation_keys.h"
#include "regression/scenario.h"

namespace understudy::regression {

/// `golden/NAME.yaml` in the folder of the scenario `NAME.yaml`.
std::filesystem::path golden_file_of(const std::filesystem::path& scenario);

/// Figures that must be equal but for their tolerances. Throws InputError with file and line, also for a file
/// of another version of the form.
std::vector<Expectation> load_golden(const std::filesystem::path& path, FiguresOf of = FiguresOf::run);
MapSchema golden_schema();

/// A golden file of `run`. Figures and tolerances are those of `before`, the file that there was; without
/// one, all that do not depend on the computer, each with the tolerance of its unit: 1 um, 0.1 mrad, 0.01
/// deg, 0.1 mm3, 0.01 s, 0.001 of a share, and none of counts and words.
std::string golden_text(const Scenario& scenario, const Metrics& run, const std::vector<Expectation>& before);

}  // namespace understudy::regression

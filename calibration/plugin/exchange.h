// A calibration problem as JSON for a plug-in, and its answer (docs/calibration-plugins.md).
#pragma once

#include <string>

#include "calibration/plugin/plugin.h"
#include "calibration/problem.h"

namespace understudy::rehearsal {

/// One line of JSON, schema "understudy.calibration-problem/1".
std::string problem_json(const calibration::Problem& problem);

struct PluginAnswer {
  bool ok = false;
  std::string failure;  ///< one line; empty when ok
  calibration::HexapodParameters parameters;
};

/// Reads schema "understudy.calibration-answer/1": what it does not tell stays as in `nominal`. Never throws:
/// nonsense is a failure that says what is wrong.
PluginAnswer read_answer(const std::string& text, const calibration::HexapodParameters& nominal);

/// The whole exchange. `seconds`: the plug-in's wall time.
PluginAnswer ask_plugin(const std::string& command, const calibration::Problem& problem,
                        const PluginLimits& limits, double& seconds);

}  // namespace understudy::rehearsal

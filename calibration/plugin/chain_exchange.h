// A calibration problem of an open chain as JSON for a plug-in, and its answer (docs/calibration-plugins.md).
#pragma once

#include <string>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/plugin/plugin.h"

namespace understudy::rehearsal {

/// One line of JSON, schema "understudy.chain-calibration-problem/1".
std::string chain_problem_json(const calibration::ChainParameters& nominal,
                               const std::vector<calibration::ChainSample>& samples);

struct ChainPluginAnswer {
  bool ok = false;
  std::string failure;  ///< one line; empty when ok
  calibration::ChainParameters parameters;
};

/// Reads schema "understudy.chain-calibration-answer/1": what it does not tell stays as in `nominal`. Never
/// throws: nonsense is a failure that says what is wrong.
ChainPluginAnswer read_chain_answer(const std::string& text, const calibration::ChainParameters& nominal);

/// The whole exchange. `seconds`: the plug-in's wall time.
ChainPluginAnswer ask_chain_plugin(const std::string& command, const calibration::ChainParameters& nominal,
                                   const std::vector<calibration::ChainSample>& samples,
                                   const PluginLimits& limits, double& seconds);

}  // namespace understudy::rehearsal

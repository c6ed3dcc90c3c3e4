// A calibration problem as JSON for a plug-in, and its answer (docs/calibration-plugins.md).
#pragma once

#include <string>

#include "calibration/estimators/estimator.h"

namespace understudy::calibration {

/// One line of JSON, schema "understudy.calibration-problem/2".
std::string problem_json(const Problem& problem);
std::string problem_json(const ChainProblem& problem);

/// Reads schema "understudy.calibration-answer/2" into `parameters`: what it does not tell stays as it is.
/// Never throws: returns one line that says what is wrong, and then leaves `parameters` alone; empty when all
/// is read.
std::string read_answer(const std::string& text, HexapodParameters& parameters);
std::string read_answer(const std::string& text, ChainParameters& parameters);

}  // namespace understudy::calibration

// Runs a scenario and judges it.
#pragma once

#include <functional>

#include "core/progress.h"
#include "regression/scenario_outcome.h"
#include "regression/sweep.h"
#include "rehearsal/rehearse.h"

namespace understudy::regression {

/// Name of the program that a plan makes.
inline constexpr const char* kPlannedProgram = "planned.gcode";

rehearsal::RehearsalRequest request_of(const Scenario& scenario);

/// Metrics of one machine of a series: those of its record, and `approach.min_gap_mm`.
Metrics metrics_of(const SweepRow& row);

/// Takes the record of the scenario's own run, to write it as files. What it throws is told of the run.
using RecordSink = std::function<void(const rehearsal::Record&)>;

/// Writes the program of a scenario that has a plan; what it throws is told of the run.
using Planner = std::function<void(const Scenario&, const std::filesystem::path& output)>;

/// Runs the command of a scenario and says what it wrote; what it throws is told of the run.
using CommandRunner = std::function<Metrics(const Scenario&)>;

struct ScenarioRun {
  int threads = 1;  ///< of the series; the result does not depend on it
  RecordSink sink;  ///< may be empty; then no scene is kept
  Progress progress;
  Planner plan;           ///< may be empty where no scenario has a plan
  CommandRunner command;  ///< may be empty where no scenario has a command
};

/// One rehearsal, and one for each machine of the series; or the scenario's command. A rehearsal that throws
/// is judged by its exit status (2 bad input, 3 engine), so that a scenario can expect a refusal. Interrupted
/// passes through.
ScenarioOutcome run_scenario(const Scenario& scenario, const ScenarioRun& run);

}  // namespace understudy::regression

// Runs a scenario and judges it.
#pragma once

#include <filesystem>

#include "regression/junit.h"
#include "regression/scenario.h"
#include "regression/sweep.h"
#include "rehearsal/rehearse.h"

namespace understudy::rehearsal {

RehearsalRequest request_of(const Scenario& scenario);

/// Metrics of one machine of a series: those of its summary, and `approach.min_gap_mm`.
Metrics metrics_of(const SweepRow& row);

/// One rehearsal, and one for each machine of the series on `threads` threads. A rehearsal that throws is
/// judged by its exit status (2 bad input, 3 engine), so that a scenario can expect a refusal. With
/// `results` set, the run's files go to that folder. Interrupted passes through.
ScenarioResult run_scenario(const Scenario& scenario, int threads, const std::filesystem::path& results,
                            const Progress& progress = {});

}  // namespace understudy::rehearsal

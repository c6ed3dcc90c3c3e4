#include "regression/run_scenario.h"

#include <chrono>

#include "core/error.h"
#include "core/error_context.h"
#include "core/file/scratch_folder.h"

namespace understudy::regression {
namespace {

constexpr double kShareOfOneRun = 0.1;  // of the progress shown when a series follows

/// `outcome` says why there are no figures, when there are none. An error without a place, such as an unknown
/// name, gets the scenario's file.
Metrics figures_or_failure(const std::filesystem::path& scenario, const std::function<Metrics()>& figures,
                           ScenarioOutcome& outcome) {
  const auto fail = [&](const std::exception& error, int status) {
    outcome.error = error.what();
    outcome.error_status = status;
    return failed_run(status);
  };
  try {
    return in_context_of(scenario.string(), figures);
  } catch (const InputError& e) {
    return fail(e, 2);
  } catch (const MachineError& e) {
    return fail(e, 3);
  }
}

/// A refusal that the scenario expects is no error.
bool expects_refusal(const Scenario& scenario) {
  for (const auto& e : scenario.expect)
    if (e.metric == "exit_status" && e.equals && std::holds_alternative<double>(*e.equals) &&
        std::get<double>(*e.equals) >= 2)
      return true;
  return false;
}

}  // namespace

rehearsal::RehearsalRequest request_of(const Scenario& scenario) {
  rehearsal::RehearsalRequest request;
  request.program = scenario.program.string();
  request.machine = scenario.machine;
  request.engine = scenario.engine;
  request.fixture = scenario.fixture;
  request.as_built = scenario.as_built;
  request.seed = scenario.seed;
  request.gap_control = scenario.gap_control;
  request.tip_tolerance_mm = scenario.tip_tolerance_mm;
  request.orientation_tolerance_deg = scenario.orientation_tolerance_deg;
  request.material = scenario.material;
  request.dialect = scenario.dialect;
  request.surface = scenario.surface;
  request.registration = scenario.registration;
  request.part_pose = scenario.part_pose;
  request.faults = scenario.faults;
  request.camera_faults = scenario.camera_faults;
  request.command = "understudy scenario run " + scenario.file.filename().string();
  return request;
}

Metrics metrics_of(const SweepRow& row) {
  Metrics metrics = row.metrics;
  if (row.printed) metrics["approach.min_gap_mm"] = row.approach_min_mm;
  return metrics;
}

ScenarioOutcome run_scenario(const Scenario& described, const ScenarioRun& run) {
  const auto begin = std::chrono::steady_clock::now();
  Scenario scenario = described;
  std::optional<ScratchFolder> planned;
  const auto plan = [&] {
    if (scenario.plan.empty()) return;
    planned.emplace("plan");
    scenario.program = planned->path() / kPlannedProgram;
    run.plan(scenario, scenario.program);
  };
  ScenarioOutcome outcome;
  const double one = scenario.machines ? kShareOfOneRun : 1.0;
  const auto report = [&](double share, const std::string& what) {
    if (run.progress) run.progress(share, what);
  };
  outcome.run = figures_or_failure(
      scenario.file,
      [&] {
        if (!scenario.command.empty()) return run.command(scenario);
        plan();
        rehearsal::RehearsalRequest request = request_of(scenario);
        request.keep_scene = static_cast<bool>(run.sink);
        const rehearsal::Record record =
            rehearsal::rehearse(request, [&](double s, const std::string& what) { report(one * s, what); });
        if (run.sink) run.sink(record);
        return metrics_of(record);
      },
      outcome);
  const auto timed = [&] {
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
  };
  if (!outcome.error.empty()) {
    if (!expects_refusal(scenario)) return timed();
    outcome.error.clear(), outcome.error_status = 0;
  }
  if (scenario.machines) {
    const auto& series = *scenario.machines;
    const auto rows =
        sweep(request_of(scenario), series.seed_first, static_cast<int>(series.count()), run.threads,
              [&](double s, const std::string& what) { report(one + (1 - one) * s, what); });
    for (const auto& row : rows) outcome.machines.push_back(metrics_of(row));
  }
  return timed();
}

}  // namespace understudy::regression

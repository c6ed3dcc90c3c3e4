#include "regression/run_scenario.h"

#include "core/error.h"
#include "core/file/scratch_folder.h"

namespace understudy::regression {
namespace {

constexpr double kShareOfOneRun = 0.1;  // of the progress shown when a series follows

/// `result` says why there is no summary, when there is none.
Metrics run_once(const Scenario& scenario, const std::function<void()>& plan, const RecordSink& sink,
                 const Progress& progress, ScenarioResult& result) {
  const auto fail = [&](const std::exception& error, int status) {
    result.error = error.what();
    result.error_status = status;
    return failed_run(status);
  };
  try {
    plan();
    rehearsal::RehearsalRequest request = request_of(scenario);
    request.keep_scene = static_cast<bool>(sink);
    const rehearsal::Record record = rehearsal::rehearse(request, progress);
    if (sink) sink(record);
    return metrics_of(record);
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

ScenarioResult run_scenario(const Scenario& described, const ScenarioRun& run) {
  Scenario scenario = described;
  std::optional<ScratchFolder> planned;
  const auto plan = [&] {
    if (scenario.plan.empty()) return;
    planned.emplace("plan");
    scenario.program = planned->path() / kPlannedProgram;
    run.plan(scenario, scenario.program);
  };
  ScenarioResult result;
  result.name = scenario.name;
  result.file = scenario.file.string();
  const double one = scenario.machines ? kShareOfOneRun : 1.0;
  const auto report = [&](double share, const std::string& what) {
    if (run.progress) run.progress(share, what);
  };
  const Metrics own = run_once(
      scenario, plan, run.sink, [&](double s, const std::string& what) { report(one * s, what); }, result);
  if (!result.error.empty()) {
    if (!expects_refusal(scenario)) return result;
    result.error.clear(), result.error_status = 0;
  }
  std::vector<Metrics> machines;
  if (scenario.machines) {
    const auto& series = *scenario.machines;
    const auto rows =
        sweep(request_of(scenario), series.seed_first, static_cast<int>(series.count()), run.threads,
              [&](double s, const std::string& what) { report(one + (1 - one) * s, what); });
    for (const auto& row : rows) machines.push_back(metrics_of(row));
  }
  result.checks = evaluate(scenario, own, machines);
  return result;
}

}  // namespace understudy::regression

#include "regression/run_scenario.h"

#include "core/error.h"
#include "core/output_file.h"
#include "report/report.h"

namespace understudy::rehearsal {
namespace {

constexpr double kShareOfOneRun = 0.1;  // of the progress shown when a series follows

/// `error` says why there is no summary, when there is none.
Metrics run_once(const Scenario& scenario, const std::filesystem::path& results, const Progress& progress,
                 std::string& error) {
  try {
    RehearsalRequest request = request_of(scenario);
    request.pictures = !results.empty();
    const Record record = rehearse(request, progress);
    if (!results.empty()) {
      OutputFolder out(results, "summary.json");
      write_results(record, out.path());
      out.commit();
    }
    return flatten(summary_json(record));
  } catch (const InputError& e) {
    error = e.what();
    return failed_run(2);
  } catch (const MachineError& e) {
    error = e.what();
    return failed_run(3);
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

RehearsalRequest request_of(const Scenario& scenario) {
  RehearsalRequest request;
  request.program = scenario.program.string();
  request.machine = scenario.machine;
  request.engine = scenario.engine;
  request.fixture = scenario.fixture;
  request.as_built = scenario.as_built;
  request.seed = scenario.seed;
  request.gap_control = scenario.gap_control;
  request.material = scenario.material;
  request.dialect = scenario.dialect;
  request.surface = scenario.surface;
  request.faults = scenario.faults;
  request.command = "understudy scenario run " + scenario.file.filename().string();
  return request;
}

Metrics metrics_of(const SweepRow& row) {
  Metrics metrics = flatten(row.summary);
  if (row.printed) metrics["approach.min_gap_mm"] = row.approach_min_mm;
  return metrics;
}

ScenarioResult run_scenario(const Scenario& scenario, int threads, const std::filesystem::path& results,
                            const Progress& progress) {
  ScenarioResult result;
  result.name = scenario.name;
  result.file = scenario.file.string();
  const double one = scenario.machines ? kShareOfOneRun : 1.0;
  const auto report = [&](double share, const std::string& what) {
    if (progress) progress(share, what);
  };
  std::string error;
  const Metrics run = run_once(
      scenario, results, [&](double s, const std::string& what) { report(one * s, what); }, error);
  if (!error.empty() && !expects_refusal(scenario)) {
    result.error = error;
    return result;
  }
  std::vector<Metrics> machines;
  if (scenario.machines) {
    const auto& series = *scenario.machines;
    const auto rows =
        sweep(request_of(scenario), series.seed_first, static_cast<int>(series.count()), threads,
              [&](double s, const std::string& what) { report(one + (1 - one) * s, what); });
    for (const auto& row : rows) machines.push_back(metrics_of(row));
  }
  result.checks = evaluate(scenario, run, machines);
  return result;
}

}  // namespace understudy::rehearsal

// The calibration benchmark: machines x noise levels x pose counts x disturbances x estimators, on problems
// whose truth is known (docs/calibration-benchmark.md).
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "calibration/plugin/child_process.h"
#include "machine/default_machine.h"
#include "studies/calibration/calibration_trial.h"

namespace understudy::studies {

enum class MeasuredFrom { poses, pixels };

struct CalibrationBenchmarkRequest {
  std::string machine = machine::kDefaultMachine;
  int trials = 20;                      ///< built machines, of seeds seed, seed + 1 ...
  std::vector<std::string> estimators;  ///< empty: all that the machine has
  std::vector<std::string> plugins;     ///< commands
  std::vector<Method> own;              ///< of the caller; with one, `estimators` empty is none
  calibration::ProcessLimits plugin_limits;
  MeasuredFrom from = MeasuredFrom::poses;
  /// From pixels: the plant that machines are driven on (session_engines()); empty: poses by forward
  /// kinematics.
  std::string engine;
  StandOptions stand;  ///< from pixels; its seed is the benchmark's
  std::vector<std::size_t> poses{8, 12, 24};
  std::vector<calibration::MeasurementNoise> noise{calibration::kReferenceNoise};
  std::vector<Disturbance> disturbances;  ///< empty: all that the machine can have
  PoseChoice choice = PoseChoice::random;
  std::uint64_t seed = 1;
  int threads = 1;
  std::string command;  ///< how it was called, for the record
};

/// Errors over all machines against what was stated of them.
struct StatedScore {
  double median = 0, worst = 0;  ///< [m]
  double median_worst = 0;       ///< [m], the worst machine's median
  double ratio = 0;              ///< RMS of the errors over that of the stated ones; NaN: none were stated
  double chi_square = 0;         ///< mean of e^T C^-1 e over its three degrees of freedom; NaN likewise
  double coverage = 0;           ///< share of the tips within their ellipsoid of 95 %; NaN likewise
};

/// An entrant under one condition, over all machines.
struct EntrantScore {
  int runs = 0, failures = 0;
  std::map<std::string, int> reasons;   ///< of failures
  double median = 0, p95 = 0, rms = 0;  ///< [m], of solved problems; NaN where there are none
  double efficiency = 0;                ///< bound^2 / mean squared error; NaN where there is no bound
  double relative = 0;  ///< median with failures counted as no calibration, over the best entrant's
  double seconds = 0;   ///< median wall time of a run
  StatedScore in_frame, registered;  ///< on the plant
  double misfit = 0;                 ///< of a bundle adjustment, median; 0: none
};

struct ConditionScore {
  Condition condition;
  double bound = 0;         ///< [m], median over machines of the bound's RMS; 0: none
  double uncalibrated = 0;  ///< [m], median
  int lost_poses = 0;
  double beyond = 0;                    ///< [m]
  std::vector<EntrantScore> scores;     ///< in the order of entrants
  std::vector<double> machine_medians;  ///< [m], of the best entrant, one a machine; NaN where it failed
  std::size_t best = 0;
};

struct Standing {
  std::size_t entrant = 0;
  double score = 0;  ///< geometric mean of `relative` over conditions: 1 is the best everywhere
  int runs = 0, failures = 0;
};

struct CalibrationBenchmark {
  CalibrationBenchmarkRequest request;
  std::string machine_name, machine_sha256;
  std::vector<Method> entrants;
  std::vector<ConditionScore> conditions;
  std::vector<Standing> ranking;  ///< best first
};

/// Equal requests give equal results but for wall times, whatever `threads` is. Throws InputError for what
/// the machine cannot have, Interrupted.
CalibrationBenchmark run_benchmark(const CalibrationBenchmarkRequest& request,
                                   const std::function<void(double, const std::string&)>& progress = {});

/// Names of the entrants that solved no problem at all.
std::vector<std::string> without_answer(const CalibrationBenchmark& benchmark);

/// "8 poses, 20 um and 0.2 mrad, outliers".
std::string to_string(const Condition& condition, MeasuredFrom from);

}  // namespace understudy::studies

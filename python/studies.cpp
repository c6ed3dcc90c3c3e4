// Algorithms against each other on worlds whose truth is known.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/pose_array.h"
#include "python/arrays.h"
#include "python/long_work.h"
#include "python/machine.h"
#include "python/module.h"
#include "python/script_estimator.h"
#include "report/page/gap_benchmark_page.h"
#include "report/study/calibration_benchmark_report.h"
#include "studies/calibration/calibration_benchmark.h"
#include "studies/calibration/sample_poses.h"
#include "studies/gap/gap_benchmark.h"

namespace understudy::python {
namespace {

using Noise = std::pair<double, double>;

py::object parsed(const std::string& json) { return py::module_::import("json").attr("loads")(json); }

void check_count(const char* name, long count, long most) {
  if (count < 1 || count > most) throw InputError(fmt::format("{} {} is outside 1..{}", name, count, most));
}

/// Names go to `request.estimators`, objects are entrants of the caller's own.
void enter(const py::object& estimators, studies::CalibrationBenchmarkRequest& request) {
  if (estimators.is_none()) return;
  if (py::isinstance<py::str>(estimators)) throw InputError("estimators: a str; expected several, in a list");
  for (const py::handle& one : estimators) {
    const auto entrant = py::reinterpret_borrow<py::object>(one);
    if (py::isinstance<py::str>(entrant)) {
      request.estimators.push_back(entrant.cast<std::string>());
      continue;
    }
    const py::object named = py::hasattr(entrant, "__name__") ? entrant : py::object(py::type::of(entrant));
    request.own.push_back(
        {std::string(py::str(named.attr("__name__"))), false, estimator_of_script(entrant)});
  }
}

py::object benchmark_calibration(const std::string& machine, const py::object& estimators, int trials,
                                 const std::vector<int>& poses, const std::vector<Noise>& noise,
                                 const std::vector<std::string>& disturbances, std::uint64_t seed,
                                 int threads, const py::object& progress) {
  studies::CalibrationBenchmarkRequest request;
  request.machine = machine;
  enter(estimators, request);
  check_count("trials", trials, 100000);
  check_count("threads", threads, 1024);
  request.trials = trials;
  request.poses.clear();
  for (const int count : poses) {
    check_count("poses", count, 1000);
    request.poses.push_back(static_cast<std::size_t>(count));
  }
  request.noise.clear();
  for (const auto& [position, rotation] : noise) {
    if (!(position >= 1e-9 && position <= 1e-2 && rotation >= 1e-7 && rotation <= 1))
      throw InputError(
          fmt::format("noise {:g} m, {:g} rad is outside 1e-9..0.01 m and 1e-7..1 rad", position, rotation));
    request.noise.push_back({position, rotation});
  }
  for (const std::string& word : disturbances)
    request.disturbances.push_back(studies::disturbance_named(word));
  request.seed = seed;
  request.threads = threads;
  request.command = "understudy.benchmark_calibration()";
  studies::CalibrationBenchmark benchmark;
  const Progress tell = told_to(progress);
  run_long([&] { benchmark = studies::run_benchmark(request, tell); });
  return parsed(report::benchmark_json(benchmark));
}

py::object benchmark_gap(const std::string& machine, const std::vector<std::string>& parts, int trials,
                         int machines, const std::vector<std::string>& plants, std::uint64_t seed,
                         int threads, const std::string& program, const py::object& progress) {
  studies::GapBenchmarkRequest request;
  request.machine = machine;
  request.parts = parts;
  check_count("trials", trials, 1000000);
  check_count("machines", machines, 1000000);
  check_count("threads", threads, 1024);
  request.trials = trials;
  request.machines = machines;
  request.plants.clear();
  for (const std::string& words : plants) request.plants.push_back(studies::plant_choice(words));
  request.seed = seed;
  request.threads = threads;
  request.program = program;
  if (program.empty())
    request.program = (machine::models_folder().parent_path() / "scenarios" / "song-bottle.gcode").string();
  request.command = "understudy.benchmark_gap()";
  studies::GapBenchmark benchmark;
  const Progress tell = told_to(progress);
  run_long([&] { benchmark = studies::run_gap_benchmark(request, tell); });
  return parsed(report::gap_benchmark_json(benchmark));
}

/// Where to drive a machine to have it calibrated, and what a twin would measure there.
py::tuple sample_poses(const Machine& machine, int count, const std::string& design,
                       const std::optional<std::string>& as_built, const Noise& noise, std::uint64_t seed) {
  check_count("count", count, 100000);
  studies::SamplePosesRequest request;
  request.machine = machine.word;
  request.count = count;
  request.design = design;
  request.as_built = as_built;
  request.noise = {noise.first, noise.second};
  request.seed = seed;
  calibration::Measurements measured;
  run_long([&] { measured = studies::sample_poses(request, machine.description); });
  const auto n = static_cast<py::ssize_t>(machine.mechanism->axis_count());
  std::vector<double> axes, poses(machine::kPoseNumbers * measured.poses.size());
  for (std::size_t j = 0; j < measured.poses.size(); ++j) {
    axes.insert(axes.end(), measured.poses[j].axes.begin(), measured.poses[j].axes.end());
    kinematics::write_pose(measured.poses[j].X_WT, &poses[machine::kPoseNumbers * j]);
  }
  return py::make_tuple(copied(axes, n), copied(poses, static_cast<py::ssize_t>(machine::kPoseNumbers)));
}

}  // namespace

void add_studies(py::module_& module) {
  module.def(
      "benchmark_calibration", &benchmark_calibration, py::arg("machine") = machine::kDefaultMachine,
      py::arg("estimators") = py::none(), py::kw_only(), py::arg("trials") = 20,
      py::arg("poses") = std::vector<int>{8, 12, 24}, py::arg("noise") = std::vector<Noise>{{20e-6, 0.2e-3}},
      py::arg("disturbances") = std::vector<std::string>{}, py::arg("seed") = 1, py::arg("threads") = 1,
      py::arg("progress") = py::none(),
      "Estimators on built machines whose truth is known; the dict of benchmark.json. estimators: names, "
      "and objects with calibrate(problem) or functions of a problem; None: all of ours. noise: (position "
      "[m], rotation [rad]) each. disturbances: words of the command; empty: all.");
  module.def(
      "benchmark_gap", &benchmark_gap, py::arg("machine") = machine::kDefaultMachine, py::kw_only(),
      py::arg("parts") = studies::GapBenchmarkRequest().parts, py::arg("trials") = 10,
      py::arg("machines") = 20, py::arg("plants") = std::vector<std::string>{"quasistatic"},
      py::arg("seed") = 1, py::arg("threads") = 1, py::arg("program") = "", py::arg("progress") = py::none(),
      "How well the gap is measured, closed and followed; the dict of gap.json. program: of the bottle's "
      "line; scenarios/song-bottle.gcode without one.");
  module.def("sample_poses", &sample_poses, py::arg("machine"), py::arg("count") = 24, py::kw_only(),
             py::arg("design") = "d-optimal", py::arg("as_built") = py::none(),
             py::arg("noise") = Noise{20e-6, 0.2e-3}, py::arg("seed") = 1,
             "(axes, poses): where to drive a machine to have it calibrated, and, with as_built, what a twin "
             "built so would measure there with this noise (position [m], rotation [rad]).");
}

}  // namespace understudy::python

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/options/jobs_option.h"
#include "cli/options/machine_option.h"
#include "cli/options/output_options.h"
#include "cli/options/plugin_box.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "report/page/calibration_benchmark_page.h"
#include "report/study/calibration_benchmark_report.h"
#include "studies/calibration/calibration_benchmark.h"
#include "studies/calibration/camera_study.h"
#include "studies/calibration/estimator_study_tables.h"

namespace understudy::cli {
namespace {

struct BenchmarkCall {
  studies::CalibrationBenchmarkRequest request;
  std::string folder, from = "poses", choice = "random", method = "pinhole";
  std::vector<std::string> disturbances, noise{"20um:0.2mrad"};
  std::vector<int> poses{8, 12, 24};
  double board_offset_mm = 0.02, board_rotation_mrad = 0.2, board_print_permille = 0, board_flatness_um = 0;
  bool tables = false;
  OutputOptions told;
};

[[noreturn]] void refuse(const std::string& option, const std::string& word, const std::string& known) {
  throw InputError(fmt::format("{} '{}' is not known (known: {})", option, word, known));
}

/// "20um:0.2mrad", the units in full so that they cannot be mistaken.
calibration::MeasurementNoise noise_of(const std::string& word) {
  double um = 0, mrad = 0;
  int end = -1;
  if (std::sscanf(word.c_str(), "%lfum:%lfmrad%n", &um, &mrad, &end) != 2 ||
      end != static_cast<int>(word.size()))
    throw InputError(fmt::format("--noise '{}' does not read like 20um:0.2mrad", word));
  if (!(um >= 1e-3 && um <= 1e4) || !(mrad >= 1e-4 && mrad <= 1e3))
    throw InputError(fmt::format("--noise '{}' is outside 0.001um..10000um and 0.0001mrad..1000mrad", word));
  return {from_mm(um * 1e-3), mrad * 1e-3};
}

vision::ViewRayMethod method_of(const std::string& word) {
  if (word == "polyline") return vision::ViewRayMethod::layer_polyline;
  if (word == "line") return vision::ViewRayMethod::layer_line;
  if (word == "pinhole") return vision::ViewRayMethod::pinhole;
  refuse("--method", word, "polyline line pinhole");
}

void check_ranges(const BenchmarkCall& call) {
  const auto& request = call.request;
  if (request.trials < 1 || request.trials > 100000)
    throw InputError(fmt::format("--trials {} is outside 1..100000", request.trials));
  check_jobs(request.threads);
  if (!(request.plugin_limits.time >= 0.01 && request.plugin_limits.time <= 3600))
    throw InputError(fmt::format("--plugin-timeout {} is outside 0.01..3600 s", request.plugin_limits.time));
  if (!(call.board_offset_mm >= 0 && call.board_offset_mm <= 2))
    throw InputError(fmt::format("--board-offset {} is outside 0..2 mm", call.board_offset_mm));
  if (!(call.board_rotation_mrad >= 0 && call.board_rotation_mrad <= 50))
    throw InputError(fmt::format("--board-rotation {} is outside 0..50 mrad", call.board_rotation_mrad));
  if (!(call.board_print_permille >= 0 && call.board_print_permille <= 50))
    throw InputError(fmt::format("--board-print {} is outside 0..50 permille", call.board_print_permille));
  if (!(call.board_flatness_um >= 0 && call.board_flatness_um <= 1000))
    throw InputError(fmt::format("--board-flatness {} is outside 0..1000 um", call.board_flatness_um));
  for (const int n : call.poses)
    if (n < 1 || n > 1000) throw InputError(fmt::format("--poses {} is outside 1..1000", n));
}

studies::CalibrationBenchmarkRequest request_of(const BenchmarkCall& call) {
  check_ranges(call);
  studies::CalibrationBenchmarkRequest request = call.request;
  if (call.from != "poses" && call.from != "pixels") refuse("--from", call.from, "poses pixels");
  if (call.from == "pixels") request.from = studies::MeasuredFrom::pixels;
  if (call.choice != "random" && call.choice != "d-optimal")
    refuse("--choice", call.choice, "random d-optimal");
  if (call.choice == "d-optimal") request.choice = studies::PoseChoice::d_optimal;
  request.stand.method = method_of(call.method);
  request.stand.boards = {from_mm(call.board_offset_mm), 1e-3 * call.board_rotation_mrad, 0,
                          1e-3 * call.board_print_permille, kMicrometre * call.board_flatness_um};
  request.poses.assign(call.poses.begin(), call.poses.end());
  request.noise.clear();
  for (const std::string& word : call.noise) request.noise.push_back(noise_of(word));
  for (const std::string& word : call.disturbances)
    request.disturbances.push_back(studies::disturbance_named(word));
  request.command = command_line();
  return request;
}

int run_tables(const BenchmarkCall& call) {
  const machine::MachineDescription machine = machine::load_machine(call.request.machine);
  if (machine.is_chain())
    throw InputError(fmt::format("--tables prints figures of the hexapod, not of {}", machine.name));
  const auto mechanism = machine.make_mechanism();
  studies::StudySetting setting;
  setting.nominal = machine.hexapod().geometry;
  setting.mechanism = mechanism.get();
  setting.region = calibration::reference_region(machine.X_BT_home);
  const auto line = [](const std::string& text) {
    stop_if_interrupted();
    fmt::print("{}\n", text);
    std::fflush(stdout);
  };
  studies::study_tables(setting, {}, line);
  line("");
  // The boards' mean offsets of a draw make most of the error: 400 draws know its RMS to 3 %.
  studies::camera_study_table(400, call.request.threads, line);
  return kGood;
}

int run_calibration(const BenchmarkCall& call) {
  if (call.tables) return run_tables(call);
  const studies::CalibrationBenchmarkRequest request = request_of(call);
  const std::string folder = call.folder.empty() ? "out/benchmark-calibration" : call.folder;
  OutputFolder out(folder);
  warn_of_box(!request.plugins.empty());
  studies::CalibrationBenchmark benchmark;
  {
    ProgressLine line(!call.told.quiet);
    benchmark = studies::run_benchmark(request, line.teller());
  }
  const std::string json = report::benchmark_json(benchmark);
  write_file(out.path() / "benchmark.json", json);
  write_file(out.path() / "report.html", report::benchmark_page(benchmark));
  stop_if_interrupted();
  out.commit();
  const std::filesystem::path written(folder);
  const std::string files =
      fmt::format("{}\n{}\n", (written / "benchmark.json").string(), (written / "report.html").string());
  print_answer(call.told, {report::benchmark_table(benchmark) + "\n" + files, files, json});
  const std::vector<std::string> silent = studies::without_answer(benchmark);
  for (const std::string& name : silent) fmt::print(stderr, "{}: solved no problem at all\n", name);
  return silent.empty() ? kGood : kNo;
}

void add_condition_options(CLI::App& command, BenchmarkCall& call) {
  command.add_option("--poses", call.poses, "counts of poses")->delimiter(',')->capture_default_str();
  command.add_option("--noise", call.noise, "1 sigma per axis of a measured pose, as 20um:0.2mrad")
      ->delimiter(',')
      ->capture_default_str();
  command
      .add_option("--disturbances", call.disturbances,
                  "none, outliers, boards, play, deviation, drift; else all that the machine can have")
      ->delimiter(',');
  command.add_option("--choice", call.choice, "of poses: random, d-optimal")->capture_default_str();
  command.add_option("--from", call.from, "measured poses: poses (with noise) or pixels (rendered pictures)")
      ->capture_default_str();
  command.add_option("--method", call.method, "of the cameras, from pixels: polyline, line, pinhole")
      ->capture_default_str();
  command
      .add_option("--board-offset", call.board_offset_mm, "from pixels: placement of a board, 1 sigma, mm")
      ->capture_default_str();
  command.add_option("--board-rotation", call.board_rotation_mrad, "from pixels: of a board, 1 sigma, mrad")
      ->capture_default_str();
  command
      .add_option("--board-print", call.board_print_permille,
                  "from pixels: scale of each camera's print, 1 sigma, permille")
      ->capture_default_str();
  command
      .add_option("--board-flatness", call.board_flatness_um, "from pixels: bow of each print, 1 sigma, um")
      ->capture_default_str();
  command.add_option("--engine", call.request.engine,
                     "from pixels: drive every machine on this plant, quasistatic or mujoco, each before "
                     "boards of its own; else poses are computed");
}

}  // namespace

void add_benchmark_calibration(CLI::App& benchmark, Action& action) {
  auto call = std::make_shared<BenchmarkCall>();
  auto* command = benchmark.add_subcommand("calibration",
                                           "Estimators and plug-ins on built machines whose truth is known");
  add_machine_option(*command, call->request.machine);
  command->add_option("--trials", call->request.trials, "built machines")->capture_default_str();
  command->add_option("--estimators", call->request.estimators, "names, separated by commas; else all")
      ->delimiter(',');
  command
      ->add_option(
          "--plugin", call->request.plugins,
          "command that reads one problem and writes one answer, JSON (docs/calibration-plugins.md); "
          "may be given again")
      ->allow_extra_args(false);
  command->add_option("--plugin-timeout", call->request.plugin_limits.time, "of one problem, s")
      ->capture_default_str();
  add_condition_options(*command, *call);
  command->add_option("--seed", call->request.seed, "of all that is drawn")
      ->check(seed_check())
      ->capture_default_str();
  add_jobs(*command, call->request.threads);
  command->add_option("--out", call->folder, "folder of results; else out/benchmark-calibration");
  command->add_flag("--tables", call->tables,
                    "print the tables of the literature's set-up beside their figures, and no more");
  add_output_options(*command, call->told, "the names of the files alone", "benchmark.json");
  command->callback([=, &action] { action = [=] { return run_calibration(*call); }; });
}

}  // namespace understudy::cli

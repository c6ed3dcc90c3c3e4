#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calibration/machine/calibrate.h"
#include "calibration/machine/calibrate_poses.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/output_file.h"
#include "core/units.h"
#include "machine/calibration_section.h"

namespace understudy::cli {
namespace {

struct CalibrateCall {
  rehearsal::CalibrateRequest request;
  std::vector<double> noise;
  std::string output, report;
};

struct SampleCall {
  rehearsal::SamplePosesRequest request;
  std::vector<double> noise;
  std::string as_built, output, from = "noise";
};

std::optional<calibration::MeasurementNoise> noise_of(const std::vector<double>& um_mrad) {
  if (um_mrad.empty()) return std::nullopt;
  for (const double v : um_mrad)
    if (!(v > 0) || v > 1e5)
      throw InputError(fmt::format("--noise {:g} is outside 0 (not included) to 1e5", v));
  return calibration::MeasurementNoise{um_mrad[0] * kMicrometre, um_mrad[1] * 1e-3};
}

/// Both results or none.
int run_calibrate(const CalibrateCall& call) {
  rehearsal::CalibrateRequest request = call.request;
  request.noise = noise_of(call.noise);
  request.command = command_line();
  const rehearsal::CalibrateResult result = rehearsal::calibrate(request);
  std::optional<OutputFolder> report;
  if (!call.report.empty()) {
    report.emplace(call.report, "summary.json");
    write_file(report->path() / "summary.json", rehearsal::calibration_json(result));
    write_file(report->path() / "report.html", rehearsal::calibration_html(result));
  }
  stop_if_interrupted();
  machine::write_calibrated(result.machine, call.output);
  if (report) report->commit();
  fmt::print("{}machine: {}\n", rehearsal::calibration_text(result), call.output);
  if (report) fmt::print("report: {}\n", (std::filesystem::path(call.report) / "report.html").string());
  return kGood;
}

int run_sample(const SampleCall& call) {
  rehearsal::SamplePosesRequest request = call.request;
  if (const auto noise = noise_of(call.noise)) request.noise = *noise;
  if (!call.as_built.empty()) request.as_built = call.as_built;
  request.from_pixels = call.from == "pixels";
  const auto machine = machine::load_machine(request.machine);
  rehearsal::Measurements sample;
  {
    ProgressLine line;
    sample = rehearsal::sample_poses(request, machine,
                                     [&](double share) { line.show(share, "photographing boards"); });
  }
  stop_if_interrupted();
  write_file(call.output, rehearsal::measurements_csv(sample, machine, "by: " + command_line()));
  fmt::print("{}: {} poses{}\n", call.output, sample.poses.size(),
             request.as_built ? ", measured on the twin" : "; replace them by the measured ones");
  return kGood;
}

void add_sample(CLI::App& app, Action& action) {
  auto call = std::make_shared<SampleCall>();
  auto* command = app.add_subcommand("sample-poses", "Where to drive a machine to calibrate it");
  command->add_option("--machine", call->request.machine, "name under models/ or a machine.yaml")
      ->capture_default_str();
  command->add_option("--count", call->request.count, "poses")->capture_default_str();
  command->add_option("--design", call->request.design, "d-optimal: the poses that tell most; or random")
      ->capture_default_str();
  command
      ->add_option("--candidates", call->request.candidates,
                   "random poses that d-optimal ones are chosen from")
      ->capture_default_str();
  command->add_option(
      "--as-built", call->as_built,
      "measure a twin there: nominal, sampled, manufactured, or a file of as-built parameters");
  command
      ->add_option(
          "--from", call->from,
          "how the twin is measured: noise, drawn; or pixels, pictures of the targets by two cameras "
          "that pictures of chessboards have calibrated")
      ->check(CLI::IsMember({"noise", "pixels"}))
      ->capture_default_str();
  command->add_option("--noise", call->noise, "um,mrad: 1 sigma of a measured pose on each axis; else 20,0.2")
      ->delimiter(',')
      ->expected(2);
  command->add_option("--seed", call->request.seed, "of poses, twin and noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "CSV (docs/calibration-data.md)")->required();
  command->callback([=, &action] { action = [=] { return run_sample(*call); }; });
}

}  // namespace

void add_calibrate(CLI::App& app, Action& action) {
  auto call = std::make_shared<CalibrateCall>();
  auto* command = app.add_subcommand("calibrate", "Find a machine's parameters from measured poses");
  command
      ->add_option("measurements", call->request.measurements,
                   "CSV of measured poses (docs/calibration-data.md)")
      ->required();
  command->add_option("--machine", call->request.machine, "name under models/ or a machine.yaml")
      ->capture_default_str();
  command->add_option(
      "--estimator", call->request.estimator,
      "maximum_likelihood (without the option), robust; of hexapods also whitened, ik_residual, "
      "with_deviation, with_play");
  command
      ->add_option("--noise", call->noise,
                   "um,mrad: 1 sigma of a measured pose on each axis, where the file has no columns for it")
      ->delimiter(',')
      ->expected(2);
  command->add_option("-o,--output", call->output, "calibrated machine file, a .yaml")->required();
  command->add_option("--report", call->report, "folder for report.html and summary.json");
  command->callback([=, &action] { action = [=] { return run_calibrate(*call); }; });
  add_sample(app, action);
}

}  // namespace understudy::cli

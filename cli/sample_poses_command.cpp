#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/machine_option.h"
#include "cli/noise_option.h"
#include "cli/progress.h"
#include "core/interrupt.h"
#include "core/output_file.h"
#include "studies/calibration/sample_poses.h"

namespace understudy::cli {
namespace {

struct SampleCall {
  studies::SamplePosesRequest request;
  std::vector<double> noise;
  std::string as_built, output, from = "noise";
};

int run_sample(const SampleCall& call) {
  studies::SamplePosesRequest request = call.request;
  if (const auto noise = noise_of(call.noise)) request.noise = *noise;
  if (!call.as_built.empty()) request.as_built = call.as_built;
  request.from_pixels = call.from == "pixels";
  const auto machine = machine::load_machine(request.machine);
  calibration::Measurements sample;
  {
    ProgressLine line;
    sample = studies::sample_poses(request, machine,
                                   [&](double share) { line.show(share, "photographing boards"); });
  }
  stop_if_interrupted();
  write_file(call.output, calibration::measurements_csv(sample, machine, "by: " + command_line()));
  fmt::print("{}: {} poses{}\n", call.output, sample.poses.size(),
             request.as_built ? ", measured on the twin" : "; replace them by the measured ones");
  return kGood;
}

}  // namespace

void add_sample_poses(CLI::App& app, Action& action) {
  auto call = std::make_shared<SampleCall>();
  auto* command = app.add_subcommand("sample-poses", "Where to drive a machine to calibrate it");
  add_machine_option(*command, call->request.machine);
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

}  // namespace understudy::cli

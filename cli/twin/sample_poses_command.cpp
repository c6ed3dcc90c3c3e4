#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/options/machine_option.h"
#include "cli/options/noise_option.h"
#include "cli/options/output_options.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "core/file/staged_file.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "report/picture/png.h"
#include "studies/calibration/sample_poses.h"

namespace understudy::cli {
namespace {

struct SampleCall {
  studies::SamplePosesRequest request;
  std::vector<double> noise;
  std::string as_built, output, pictures, from = "noise";
  double board_offset_mm = 0.02, board_rotation_mrad = 0.2, board_print_permille = 0, board_flatness_um = 0;
  OutputOptions told;
};

/// The pictures, what is believed, and under truth/ what is.
void write_record(const std::filesystem::path& folder, const studies::PictureRecord& record,
                  const machine::MachineDescription& machine) {
  const std::string by = "by: " + command_line();
  write_file(folder / "rig.yaml", vision::rig_yaml(record.rig, "the designed measuring set-up, " + by));
  write_file(folder / "commanded.csv", calibration::measurements_csv(record.commanded, machine, by));
  vision::RigDescription built = record.rig;
  built.rig.cameras = record.built.cameras;
  write_file(folder / "truth/rig.yaml", vision::rig_yaml(built, "the cameras as they were built, " + by));
  write_file(folder / "truth/poses.csv", calibration::measurements_csv(record.truth, machine, by));
}

int run_sample(const SampleCall& call) {
  check_writable(call.output);
  studies::SamplePosesRequest request = call.request;
  if (const auto noise = noise_of(call.noise)) request.noise = *noise;
  if (!call.as_built.empty()) request.as_built = call.as_built;
  request.from_pixels = call.from == "pixels";
  request.boards = {from_mm(call.board_offset_mm), 1e-3 * call.board_rotation_mrad, 0,
                    1e-3 * call.board_print_permille, kMicrometre * call.board_flatness_um};
  const auto machine = machine::load_machine(request.machine);
  if (!call.pictures.empty() && !request.from_pixels)
    throw InputError("--pictures needs --from pixels: drawn noise has no pictures");
  std::optional<OutputFolder> folder;
  studies::PictureRecord record;
  if (!call.pictures.empty()) {
    folder.emplace(call.pictures);
    for (const char* inner : {"boards", "poses", "truth"})
      std::filesystem::create_directories(folder->path() / inner);
    record.keep = [&](const std::string& name, const Image& picture) {
      stop_if_interrupted();
      write_file(folder->path() / name, report::encode_png(picture));
    };
  }
  calibration::Measurements sample;
  {
    ProgressLine line(!call.told.quiet);
    sample = studies::sample_poses(
        request, machine, [&](double share) { line.show(share, "photographing boards"); }, &record);
  }
  stop_if_interrupted();
  if (folder) write_record(folder->path(), record, machine);
  StagedFile poses(call.output, calibration::measurements_csv(sample, machine, "by: " + command_line()));
  if (folder) folder->commit();
  poses.commit();
  fmt::print("{}: {} poses{}\n", call.output, sample.poses.size(),
             request.as_built ? ", measured on the twin" : "; replace them by the measured ones");
  if (folder) fmt::print("pictures: {}\n", call.pictures);
  return kGood;
}

void add_plant_options(CLI::App& command, SampleCall& call) {
  command.add_option("--engine", call.request.engine,
                     "drive the twin there on this plant, with play, gravity and microsteps: quasistatic or "
                     "mujoco; else poses are computed");
  command
      .add_option("--warming", call.request.warming, "K by which the screws warm meanwhile, with --engine")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command
      .add_option("--board-offset", call.board_offset_mm, "from pixels: placement of a board, 1 sigma, mm")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  command.add_option("--board-rotation", call.board_rotation_mrad, "from pixels: of a board, 1 sigma, mrad")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  command
      .add_option("--board-print", call.board_print_permille,
                  "from pixels: scale of each camera's print, 1 sigma, permille")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  command
      .add_option("--board-flatness", call.board_flatness_um, "from pixels: bow of each print, 1 sigma, um")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
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
      "measure a twin there: nominal, sampled, manufactured, calibrated, or a file of as-built parameters");
  command
      ->add_option(
          "--from", call->from,
          "how the twin is measured: noise, drawn; or pixels, pictures of the targets by two cameras "
          "that pictures of chessboards have calibrated")
      ->check(CLI::IsMember({"noise", "pixels"}))
      ->capture_default_str();
  command->add_option(
      "--pictures", call->pictures,
      "folder for the pictures, whole, with rig.yaml and commanded.csv as `understudy measure` takes "
      "them, and the truth beside them; with --from pixels");
  command->add_option("--noise", call->noise, "um,mrad: 1 sigma of a measured pose on each axis; else 20,0.2")
      ->delimiter(',')
      ->expected(2);
  add_plant_options(*command, *call);
  command->add_option("--seed", call->request.seed, "of poses, twin and noise")
      ->check(seed_check())
      ->capture_default_str();
  command->add_option("-o,--output", call->output, "CSV (docs/calibration-data.md)")->required();
  add_quiet_option(*command, call->told, "no progress");
  command->callback([=, &action] { action = [=] { return run_sample(*call); }; });
}

}  // namespace understudy::cli

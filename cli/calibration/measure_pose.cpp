#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calibration/machine/camera_poses.h"
#include "cli/calibration/measure_command.h"
#include "cli/options/seed_option.h"
#include "cli/progress.h"
#include "core/cut_image.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "vision/boards/rig_pictures.h"
#include "vision/picture/picture_file.h"

namespace understudy::cli {
namespace {

using PicturePair = std::array<vision::PosePicture, 2>;

/// From the pictures of boards that the rig names.
vision::StereoModel calibrate_cameras(const vision::RigDescription& rig, std::uint64_t seed,
                                      ProgressLine& line) {
  const auto pictures = vision::board_pictures(rig, {});
  const auto boards = vision::measure_boards(rig, pictures, [&](std::size_t done) {
    stop_if_interrupted();
    line.show(static_cast<double>(done) / static_cast<double>(pictures.size()), "measuring boards");
  });
  for (const auto& [picture, seen] : boards)
    if (seen.status != vision::BoardStatus::ok) report_left_out(picture.file, to_string(seen.status));
  vision::CalibrationUncertainty uncertainty = rig.uncertainty;
  uncertainty.seed = seed;
  return vision::calibrate_rig(rig.rig, vision::seen_boards(boards), vision::ViewRayMethod::pinhole,
                               uncertainty);
}

calibration::CameraPose measure_pair(const vision::RigDescription& rig, const vision::StereoModel& model,
                                     const PicturePair& pair, const Pose& X_WT_commanded) {
  std::array<vision::TargetsMeasurement, 2> seen;
  for (int camera = 0; camera < 2; ++camera) {
    const auto k = static_cast<std::size_t>(camera);
    const Image image = vision::read_rig_picture(rig, camera, pair[k].file);
    seen[k] = vision::find_targets(rig.rig, camera, X_WT_commanded,
                                   [&](const Region& region) { return cut(image, region); });
  }
  const vision::PoseMeasurement measured = vision::measure_pose(model, rig.rig.targets, seen);
  const calibration::CameraPose pose = calibration::camera_pose(measured);
  if (!pose.ok())
    report_left_out(pair[static_cast<std::size_t>(std::max(measured.camera, 0))].file,
                    fmt::format("pose {}, {}", pair[0].pose, pose.failure));
  return pose;
}

int run_pose(const MeasureCall& call) {
  check_output(call);
  const vision::RigDescription rig = vision::load_rig(call.rig);
  const calibration::Measurements commanded = read_commanded(call);
  const auto pairs = vision::pose_picture_pairs(rig, call.pictures);
  calibration::Measurements rows = commanded;
  rows.poses.clear();
  for (const PicturePair& pair : pairs)
    rows.poses.push_back(row_of_pose(commanded, pair[0].pose, pair[0].file));
  std::vector<calibration::CameraPose> poses;
  {
    ProgressLine line(!call.told.quiet);
    const vision::StereoModel model = calibrate_cameras(rig, call.seed, line);
    for (const PicturePair& pair : pairs) {
      stop_if_interrupted();
      poses.push_back(measure_pair(rig, model, pair, rows.poses[poses.size()].X_WT));
      line.show(static_cast<double>(poses.size()) / static_cast<double>(pairs.size()), "measuring poses");
    }
  }
  const calibration::Measurements measured = calibration::measured_table(rows, poses);
  double beyond = 0;
  for (const calibration::CameraPose& pose : poses) beyond = std::max(beyond, pose.beyond);
  const std::string summary =
      fmt::format("{} of {} poses; targets up to {:.0f} mm outside of the boards' depths\n",
                  measured.poses.size(), pairs.size(), to_mm(beyond));
  return write_table(
      call,
      calibration::measurements_csv(measured, machine::load_machine(call.machine), "by: " + command_line()),
      measured.poses.size(), summary);
}

}  // namespace

void add_measure_pose(CLI::App& measure, Action& action) {
  auto call = std::make_shared<MeasureCall>();
  auto* command = measure.add_subcommand("pose", "Poses of the tool, as understudy calibrate takes them");
  command
      ->add_option("pictures", call->pictures,
                   "pictures of poses, one of each camera, named by pose_pictures of the rig")
      ->required();
  add_measure_options(*command, call);
  add_commanded_options(*command, call);
  command
      ->add_option("--seed", call->seed,
                   "of the perturbed calibrations that the cameras' uncertainty comes from")
      ->check(seed_check())
      ->capture_default_str();
  command->footer(
      "The pictures of boards that the rig names calibrate the cameras. One row a pose, with its covariance "
      "and the axes "
      "of --commanded (docs/calibration-data.md). A board or a pose that cannot be measured is named with "
      "the reason and "
      "left out; where no pose is left, exit status 1. A picture without its partner, of another size than "
      "the rig's or "
      "unreadable: exit status 2, nothing written.");
  command->callback([=, &action] { action = [=] { return run_pose(*call); }; });
}

}  // namespace understudy::cli

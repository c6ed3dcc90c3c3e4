#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/calibration/measure_command.h"
#include "cli/progress.h"
#include "core/cut_image.h"
#include "core/interrupt.h"
#include "vision/boards/rig_pictures.h"
#include "vision/picture/picture_file.h"

namespace understudy::cli {
namespace {

int run_targets(const MeasureCall& call) {
  check_output(call);
  const vision::RigDescription rig = vision::load_rig(call.rig);
  const calibration::Measurements commanded = read_commanded(call);
  const auto pictures = vision::pose_pictures(rig, call.pictures);
  for (const vision::PosePicture& picture : pictures) row_of_pose(commanded, picture.pose, picture.file);
  std::string table = "picture,pose,camera,target,u_px,v_px,c11_px2,c12_px2,c22_px2,radius_px\n";
  std::size_t rows = 0, done = 0;
  {
    ProgressLine line(!call.told.quiet, {"pictures", static_cast<double>(pictures.size())});
    for (const vision::PosePicture& picture : pictures) {
      stop_if_interrupted();
      const Image image = vision::read_rig_picture(rig, picture.camera, picture.file);
      const auto seen = vision::find_targets(rig.rig, picture.camera,
                                             row_of_pose(commanded, picture.pose, picture.file).X_WT,
                                             [&](const Region& region) { return cut(image, region); });
      for (std::size_t k = 0; k < seen.targets.size(); ++k) {
        const vision::TargetMeasurement& target = seen.targets[k];
        if (target.status != vision::TargetStatus::ok) {
          report_left_out(picture.file, fmt::format("target {}: {}", k, to_string(target.status)));
          continue;
        }
        const Eigen::Matrix2d& c = target.covariance_px2;
        table += fmt::format("{},{},{},{},{:.4f},{:.4f},{:.6g},{:.6g},{:.6g},{:.4f}\n",
                             csv_cell(picture.file), picture.pose, picture.camera, k, target.centre_px.x(),
                             target.centre_px.y(), c(0, 0), c(0, 1), c(1, 1), target.radius_px);
        ++rows;
      }
      line.show(static_cast<double>(++done) / static_cast<double>(pictures.size()), "measuring targets");
    }
  }
  return write_table(
      call, table, rows,
      fmt::format("{} of {} targets in {} pictures\n", rows, 3 * pictures.size(), pictures.size()));
}

}  // namespace

void add_measure_targets(CLI::App& measure, Action& action) {
  auto call = std::make_shared<MeasureCall>();
  auto* command = measure.add_subcommand("targets", "Centres of the three spheres on the tool");
  command->add_option("pictures", call->pictures, "pictures of poses, named by pose_pictures of the rig")
      ->required();
  add_measure_options(*command, call);
  add_commanded_options(*command, call);
  command->footer(
      "One row a target: picture, pose, camera, target, u_px, v_px of the projected centre, its covariance "
      "c11_px2, "
      "c12_px2, c22_px2, and the outline's radius_px. A target that cannot be measured is named with the "
      "reason and left "
      "out; where all are, exit status 1.");
  command->callback([=, &action] { action = [=] { return run_targets(*call); }; });
}

}  // namespace understudy::cli

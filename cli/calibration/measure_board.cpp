#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/calibration/measure_command.h"
#include "cli/progress.h"
#include "core/interrupt.h"
#include "core/quantile.h"
#include "vision/boards/rig_pictures.h"

namespace understudy::cli {
namespace {

constexpr std::size_t kLeastLayers = 2;  // of which a camera is calibrated

/// "camera 0: 11 of 11 boards, corners 0.031 px (1 sigma); calibrated, residual 0.045 px"
std::string summary_of(int camera, const vision::RigDescription& rig,
                       const std::vector<vision::MeasuredBoardPicture>& boards) {
  std::size_t given = 0;
  std::vector<double> scatter;
  for (const auto& board : boards) {
    if (board.picture.camera != camera) continue;
    ++given;
    if (board.seen.status == vision::BoardStatus::ok) scatter.push_back(board.seen.scatter_px);
  }
  if (given == 0) return fmt::format("camera {}: no pictures\n", camera);
  std::string text = fmt::format("camera {}: {} of {} boards", camera, scatter.size(), given);
  if (!scatter.empty()) text += fmt::format(", corners {:.3f} px (1 sigma)", quantile(scatter, 0.5));
  if (scatter.size() < kLeastLayers) return text + "; a calibration needs 2 or more\n";
  vision::CalibrationUncertainty uncertainty = rig.uncertainty;
  uncertainty.replicas = 0;
  const auto model = vision::calibrate_view_rays(
      vision::ViewRayMethod::pinhole, vision::camera_layers(rig.rig, vision::seen_boards(boards), camera),
      uncertainty);
  return text + fmt::format("; calibrated, residual {:.3f} px\n", model->residual_px());
}

int run_board(const MeasureCall& call) {
  check_output(call);
  const vision::RigDescription rig = vision::load_rig(call.rig);
  const auto pictures = vision::board_pictures(rig, call.pictures);
  std::vector<vision::MeasuredBoardPicture> boards;
  {
    ProgressLine line(!call.told.quiet, {"pictures", static_cast<double>(pictures.size())});
    boards = vision::measure_boards(rig, pictures, [&](std::size_t done) {
      stop_if_interrupted();
      line.show(static_cast<double>(done) / static_cast<double>(pictures.size()), "measuring boards");
    });
  }
  std::string table = "picture,camera,layer,column,row,u_px,v_px,sigma_px\n";
  std::size_t rows = 0;
  for (const auto& [picture, seen] : boards) {
    if (seen.status != vision::BoardStatus::ok) {
      report_left_out(picture.file, to_string(seen.status));
      continue;
    }
    for (int i = 0; i < rig.rig.board.corners(); ++i, ++rows) {
      const Vec2& corner = seen.corners_px[static_cast<std::size_t>(i)];
      table += fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f}\n", csv_cell(picture.file), picture.camera,
                           picture.layer, i % rig.rig.board.columns, i / rig.rig.board.columns, corner.x(),
                           corner.y(), seen.scatter_px);
    }
  }
  const std::string summary = summary_of(0, rig, boards) + summary_of(1, rig, boards);
  return write_table(call, table, rows, summary);
}

}  // namespace

void add_measure_board(CLI::App& measure, Action& action) {
  auto call = std::make_shared<MeasureCall>();
  auto* command =
      measure.add_subcommand("board", "Corners of the chessboards, and how well they calibrate the cameras");
  command->add_option(
      "pictures", call->pictures,
      "pictures of boards, named by board_pictures of the rig; without any, all that the rig names");
  add_measure_options(*command, call);
  command->footer(
      "One row a corner: picture, camera, layer, column, row, u_px, v_px, and sigma_px, 1 sigma in u and in "
      "v. A "
      "picture whose board cannot be measured is named with the reason and left out; where all are, exit "
      "status 1.");
  command->callback([=, &action] { action = [=] { return run_board(*call); }; });
}

}  // namespace understudy::cli

#include "studies/calibration/camera_study.h"

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "core/parallel.h"
#include "core/units.h"
#include "vision/boards/stereo_pose.h"

namespace understudy::studies {
namespace {

using vision::BoardPlacement;
using vision::CalibrationRig;
using vision::MountedCamera;
using vision::ViewRayMethod;

constexpr ViewRayMethod kMethods[] = {ViewRayMethod::layer_polyline, ViewRayMethod::layer_line,
                                      ViewRayMethod::pinhole};
constexpr double kAxisKnown = 0.1;  // [px], 1 sigma of the principal point

struct ReferenceRow {
  const char* name;
  double pixel;
  vision::BoardTolerance boards;
  double expected_um[3];  // in the order of kMethods; 0: not told
};
const ReferenceRow kReference[] = {
    {"0.1 px", 0.1, {}, {15.9, 14.3, 15.5}},
    {"0.3 px", 0.3, {}, {48, 46, 0}},
    {"+ boards 0.1 mm, 1 mrad", 0.1, {0.1e-3, 1e-3, 0}, {147, 67, 45}},
    {"+ 0.2 mm, 2 mrad, 0.2 %", 0.1, {0.2e-3, 2e-3, 2e-3}, {254, 141, 145}},
    {"+ 0.3 mm, 5 mrad, 0.5 %", 0.1, {0.3e-3, 5e-3, 5e-3}, {436, 206, 176}},
};

std::array<MountedCamera, 2> built_cameras(const CalibrationRig& designed) {
  std::array<MountedCamera, 2> built = designed.cameras;
  Camera& a = built[0].camera;
  Camera& b = built[1].camera;
  a.k1 = -0.12, a.k2 = 0.15, a.p1 = 4e-4, a.p2 = -3e-4, a.focal_px *= 1.004;
  b.k1 = 0.08, b.p1 = -2e-4, b.p2 = 5e-4, b.focal_px *= 0.997;
  for (MountedCamera& camera : built)
    camera.X_WC =
        camera.X_WC * make_pose(exp_rotation(Vec3(2e-3, -1e-3, 3e-3)), Vec3(0.4e-3, -0.3e-3, 0.5e-3));
  return built;
}

Vec2 seen(const MountedCamera& camera, const Vec3& p_W, double sigma, Random& random) {
  const Vec2 exact = camera.camera.project(camera.X_WC.inverse() * p_W).value();
  const double u = random.normal(), v = random.normal();
  return exact + sigma * Vec2(u, v);
}

vision::CameraLayers layers_of(const CalibrationRig& designed, int camera, const MountedCamera& built,
                               const CameraStudySetting& setting, Random& random) {
  vision::CameraLayers all{designed.cameras[static_cast<std::size_t>(camera)], designed.board, {}};
  for (int layer = 0; layer < designed.layers; ++layer) {
    const BoardPlacement placement = sample_placement(setting.boards, random);
    vision::BoardLayer board{designed.X_WG(camera, layer), {}};
    for (int row = 0; row < designed.board.rows; ++row)
      for (int column = 0; column < designed.board.columns; ++column)
        board.corners_px.push_back(seen(
            built, board.X_WG * placement.moved(designed.board.corner(column, row)), setting.pixel, random));
    all.layers.push_back(board);
  }
  return all;
}

}  // namespace

double camera_study(const CameraStudySetting& setting, ViewRayMethod method, int threads) {
  const CalibrationRig designed = vision::default_calibration_rig(Vec3(0, 0, 0.1));
  const auto built = built_cameras(designed);
  const Vec3 middle = designed.cameras[0].X_WC * Vec3(0, 0, designed.middle_distance);
  const vision::CalibrationUncertainty uncertainty{
      .boards = setting.boards, .corner_px = setting.pixel, .principal_px = kAxisKnown, .replicas = 0};
  std::vector<double> squares(static_cast<std::size_t>(setting.draws), 0.0);
  in_parallel(squares.size(), threads, [&](std::size_t d) {
    Random random(d, "camera study");
    std::array<vision::CameraLayers, 2> layers;
    for (int i = 0; i < 2; ++i) {
      const auto k = static_cast<std::size_t>(i);
      layers[k] = layers_of(designed, i, built[k], setting, random);
    }
    const auto model = vision::calibrate_stereo(method, layers, uncertainty);
    for (int n = 0; n < setting.points; ++n) {
      Vec3 p_W = middle;
      for (Eigen::Index k = 0; k < 3; ++k) p_W[k] += random.uniform(-25e-3, 25e-3);
      std::array<vision::PixelPoint, 2> pixels;
      for (std::size_t i = 0; i < 2; ++i) pixels[i].pixel = seen(built[i], p_W, setting.pixel, random);
      squares[d] += (vision::locate(model, pixels).place.point - p_W).squaredNorm();
    }
  });
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  return std::sqrt(sum / (setting.draws * setting.points));
}

void camera_study_table(int draws, int threads, const std::function<void(const std::string&)>& line) {
  line(fmt::format(
      "two cameras, 3D RMS within 25 mm of the middle [um], {} draws of boards and noise (reference)",
      draws));
  line(fmt::format("{:<26}{:>20}{:>20}{:>20}", "corners and targets", vision::to_string(kMethods[0]),
                   vision::to_string(kMethods[1]), vision::to_string(kMethods[2])));
  for (const ReferenceRow& row : kReference) {
    std::string text = fmt::format("{:<26}", row.name);
    for (std::size_t m = 0; m < 3; ++m) {
      const double rms = camera_study({row.pixel, row.boards, draws, 60}, kMethods[m], threads);
      const std::string known = row.expected_um[m] > 0 ? fmt::format("({:g})", row.expected_um[m]) : "";
      text += fmt::format("{:>12.1f} {:>7}", to_um(rms), known);
    }
    line(text);
  }
}

}  // namespace understudy::studies

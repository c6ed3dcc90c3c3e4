#include "studies/calibration/rig_scenes.h"

#include <fmt/format.h>

#include "core/random_vector.h"

namespace understudy::studies {
BuiltRig built_as_designed(const vision::CalibrationRig& designed) {
  BuiltRig built;
  built.cameras = designed.cameras;
  for (auto& boards : built.boards) boards.resize(static_cast<std::size_t>(designed.layers));
  return built;
}

BuiltRig sample_built_rig(const vision::CalibrationRig& designed, const vision::BoardTolerance& boards,
                          double principal_px, std::uint64_t seed) {
  BuiltRig built = built_as_designed(designed);
  for (std::size_t i = 0; i < 2; ++i) {
    Random random(seed, fmt::format("measuring stand/camera {}", i + 1));
    Camera& camera = built.cameras[i].camera;
    camera.focal_px *= 1 + 3e-3 * random.normal();
    camera.centre_px += principal_px * normal_vec2(random);
    camera.k1 = random.uniform(-0.12, 0.12);
    camera.k2 = random.uniform(-0.15, 0.15);
    camera.p1 = random.uniform(-5e-4, 5e-4);
    camera.p2 = random.uniform(-5e-4, 5e-4);
    const Vec3 turn = 2e-3 * normal_vec3(random), shift = 0.3e-3 * normal_vec3(random);
    built.cameras[i].X_WC = built.cameras[i].X_WC * make_pose(exp_rotation(turn), shift);
    for (std::size_t layer = 0; layer < built.boards[i].size(); ++layer) {
      Random of_board(seed, fmt::format("measuring stand/board {}/{}", i + 1, layer + 1));
      built.boards[i][layer] = sample_placement(boards, of_board);
    }
    Random of_print(seed, fmt::format("measuring stand/print {}", i + 1));
    built.prints[i] = sample_print(boards, of_print);
  }
  return built;
}

renderer::BoardScene board_scene(const vision::CalibrationRig& designed, const BuiltRig& built, int camera,
                                 int layer) {
  const auto k = static_cast<std::size_t>(camera);
  const vision::BoardPlacement& placement = built.boards[k][static_cast<std::size_t>(layer)];
  renderer::BoardScene scene;
  scene.camera = built.cameras[k].camera;
  scene.columns = designed.board.columns;
  scene.rows = designed.board.rows;
  const vision::PrintError& print = built.prints[k];
  const double scale = (1 + placement.scale) * (1 + print.scale);
  scene.square = scale * designed.board.square;
  scene.margin = scale * designed.board.margin;
  scene.bow = (1 + placement.scale) * print.bow;
  scene.X_CG = built.cameras[k].X_WC.inverse() * designed.X_WG(camera, layer) *
               make_pose(exp_rotation(placement.rotation), placement.offset);
  return scene;
}

renderer::TargetScene target_scene(const vision::CalibrationRig& designed, const BuiltRig& built, int camera,
                                   const Pose& X_WT) {
  const vision::MountedCamera& mounted = built.cameras[static_cast<std::size_t>(camera)];
  renderer::TargetScene scene;
  scene.camera = mounted.camera;
  scene.radius = designed.target_radius;
  const Pose X_CT = mounted.X_WC.inverse() * X_WT;
  for (const Vec3& p_T : designed.targets) scene.centres_C.push_back(X_CT * p_T);
  return scene;
}

}  // namespace understudy::studies

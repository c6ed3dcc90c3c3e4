#include "vision/boards/rig_measurement.h"

#include <gtest/gtest.h>

#include "tests/vision/boards/drawn_picture.h"
#include "tests/vision/boards/two_cameras.h"

namespace understudy::vision {
namespace {

const Pose kHome = make_pose(Quat::Identity(), Vec3(0, 0, 0.1));

/// What a camera without distortion sees of spheres at 400 mm, as discs; `shift` [px] is the machine's error.
Image discs_of(const CalibrationRig& rig, int camera, const Vec2& shift) {
  const MountedCamera& mounted = rig.cameras[static_cast<std::size_t>(camera)];
  const int width = mounted.camera.width, height = mounted.camera.height;
  constexpr int kPatch = 120;  // [px]: the rest is paper
  Image image{{0, 0, width, height}, {}};
  image.pixels.assign(static_cast<std::size_t>(width * height), static_cast<std::uint8_t>(kPaper));
  for (const Vec3& p_T : rig.targets) {
    const Vec2 centre = mounted.camera.project(mounted.X_WC.inverse() * kHome * p_T).value() + shift;
    const int left = static_cast<int>(centre.x()) - kPatch / 2,
              top = static_cast<int>(centre.y()) - kPatch / 2;
    const Image patch = drawn_discs(kPatch, kPatch, {{centre - Vec2(left, top), 53}});
    for (int y = 0; y < kPatch; ++y)
      for (int x = 0; x < kPatch; ++x)
        image.pixels[static_cast<std::size_t>((top + y) * width + left + x)] = patch.at(x, y);
  }
  return image;
}

TEST(RigMeasurement, LayersAreInOrderAndOfTheirCamera) {
  const CalibrationRig rig = reference_rig();
  const std::vector<Vec2> corners(static_cast<std::size_t>(rig.board.corners()), Vec2(1, 2));
  const CameraLayers layers = camera_layers(rig, {{1, 7, corners}, {0, 3, corners}, {1, 2, corners}}, 1);
  ASSERT_EQ(layers.layers.size(), 2u);
  EXPECT_TRUE(layers.layers[0].X_WG.isApprox(rig.X_WG(1, 2)));
  EXPECT_TRUE(layers.layers[1].X_WG.isApprox(rig.X_WG(1, 7)));
  EXPECT_TRUE(layers.camera.X_WC.isApprox(rig.cameras[1].X_WC));
}

// 5 mm at 400 mm and 4267 px: 53.3 px. Camera 0 looks along +X, its picture's right is -Y and its down -Z;
// the middle of the triangle is in the middle of the picture.
TEST(RigMeasurement, TargetsAreExpectedWhereThePinholeSeesThem) {
  const CalibrationRig rig = reference_rig();
  EXPECT_NEAR(target_radius_px(rig, 0), 53.3, 0.05);
  const double third = 60 / std::sqrt(2.0) / 3;  // [mm]
  const Vec2 tip = expected_targets(rig, 0, kHome)[0];
  const double scale = 4267 / (400 - third);  // px/mm: the tip is nearer than the middle
  EXPECT_NEAR(tip.x(), 799.5 + scale * third, 1e-6);
  EXPECT_NEAR(tip.y(), 599.5 + scale * 2 * third, 1e-6);
  const Pose behind = make_pose(Quat::Identity(), Vec3(-10, 0, 0.1));
  EXPECT_LT(expected_targets(rig, 0, behind)[0].x(), -1e4);
}

TEST(RigMeasurement, AWellPlacedToolIsInViewAndOneAtThePicturesEdgeIsNot) {
  const CalibrationRig rig = reference_rig();
  EXPECT_TRUE(targets_in_view(rig, kHome));
  for (const Vec3& away : {Vec3(50e-3, 0, 0), Vec3(0, 50e-3, 0), Vec3(0, 0, -30e-3), Vec3(0, 0, 40e-3)})
    EXPECT_FALSE(targets_in_view(rig, make_pose(Quat::Identity(), Vec3(kHome.translation() + away)))) << away;
}

// 40 px are found in the first look, 140 px in the second, 200 px in none.
TEST(RigMeasurement, TargetsAreFoundWhereTheMachineMissesAndAWiderLookIsTheSecond) {
  const CalibrationRig rig = reference_rig();
  for (const auto& [miss, looks, status] : {std::tuple(40.0, 1, TargetStatus::ok),
                                            {140.0, 2, TargetStatus::ok},
                                            {200.0, 2, TargetStatus::missing}}) {
    const Image picture = discs_of(rig, 0, Vec2(-miss, 0));
    int asked = 0;
    const auto seen = find_targets(rig, 0, kHome, [&](const Region& region) {
      ++asked;
      Image part{region, {}};
      for (int y = region.y; y < region.y + region.height; ++y)
        for (int x = region.x; x < region.x + region.width; ++x) part.pixels.push_back(picture.at(x, y));
      return part;
    });
    EXPECT_EQ(seen.status, status) << miss << ' ' << to_string(seen.status);
    EXPECT_EQ(asked, looks) << miss;
    if (status != TargetStatus::ok) continue;
    const auto expected = expected_targets(rig, 0, kHome);
    for (std::size_t k = 0; k < 3;
         ++k)  // a disc's centre is its outline's; the sphere's is up to 0.1 px inwards
      EXPECT_LE((seen.targets[k].outline_px - expected[k] - Vec2(-miss, 0)).norm(), 0.05);
  }
}

}  // namespace
}  // namespace understudy::vision
